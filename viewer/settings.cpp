// SPDX-License-Identifier: Apache-2.0
#include "settings.h"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <system_error>
#include <type_traits>

#include "osd_shading/io/errors.h"
#include "osd_shading/io/textFile.h"

namespace osd_shading::viewer {

namespace {

/// Collects lines of "name value".
class SettingsWriter {
public:
    void Add(std::string_view name, std::string_view value) {
        _text.append(name).append(" ").append(value).append("\n");
    }
    template <typename T>
    void AddNumber(std::string_view name, T value) {
        char digits[32];
        auto const end = std::to_chars(digits, digits + sizeof(digits), value).ptr;
        Add(name, std::string_view(digits, static_cast<std::size_t>(end - digits)));
    }
    template <typename T>
    void AddNumber(std::string_view name, std::optional<T> const& value) {
        if (value) AddNumber(name, *value);
    }
    template <typename T, std::size_t N>
    void AddChoice(std::string_view name, std::optional<T> const& value, OptionNames<T, N> const& names) {
        if (value) Add(name, tool::NameOf(names, *value));
    }
    std::string const& Text() const { return _text; }

private:
    std::string _text;
};

void AddMethod(Settings const& settings, SettingsWriter& text) {
    tool::MeshOptions const& mesh = settings.mesh;
    text.AddChoice("scheme", mesh.scheme, tool::kSchemeNames);
    if (!mesh.sharpnessFile.empty()) text.Add("sharpness", mesh.sharpnessFile);
    text.AddNumber("crease-angle", mesh.creaseAngle);
    text.AddNumber("crease-scale", mesh.creaseScale);
    text.AddChoice("boundary", mesh.boundary, tool::kBoundaryNames);
    text.AddChoice("creasing", mesh.creasing, tool::kCreasingNames);
    text.AddChoice("triangles", mesh.triangles, tool::kTriangleNames);

    tool::ShadingChoice const& shading = settings.shading;
    text.AddNumber("level", shading.level);
    text.AddChoice("preset", shading.smoothPreset, tool::kPresetNames);
    text.AddChoice("start-normals", shading.startNormals, tool::kStartNormalNames);
    text.AddNumber("normals-from", shading.normalsFrom);
    text.AddChoice("weights", shading.weights, tool::kWeightNames);
    text.AddNumber("weights-from", shading.weightsFrom);
    text.AddChoice("sharp-vertices", shading.sharpVertices, tool::kSharpVertexNames);
    text.AddChoice("darts", shading.darts, tool::kDartNames);
    text.AddNumber("exponent", shading.exponent);
    text.AddChoice("averaging", shading.averaging, tool::kAveragingNames);
    text.AddNumber("spherical-steps", shading.sphericalSteps);
    text.AddChoice("limit-normals", shading.limitNormals, tool::kLimitNormalNames);
    text.AddChoice("positions", shading.positions, tool::kPositionNames);
    if (settings.tessellation.rate) {
        text.AddNumber("tessellate", settings.tessellation.rate);
    } else {
        text.AddChoice("tessellate", settings.tessellation.kind, tool::kTessellationNames);
    }
    text.AddNumber("max-angle", settings.tessellation.maxAngle);
    text.AddNumber("max-pixels", settings.tessellation.maxPixels);
    text.AddChoice("precision", settings.run.precision, tool::kPrecisionNames);
    text.AddNumber("threads", settings.run.threads);
    text.AddNumber("memory-limit", settings.run.memoryLimit);
}

void AddView(Settings const& settings, SettingsWriter& text) {
    ViewOptions const& view = settings.view;
    text.Add("shading", tool::NameOf(kShadingNames, view.shading));
    text.Add("normals", tool::NameOf(kNormalNames, view.normals));
    text.Add("split", std::string(tool::NameOf(kNormalNames, view.left)) + ',' +
                          std::string(tool::NameOf(kNormalNames, view.right)));
    text.Add("split-kind", tool::NameOf(kSplitNames, view.split));
    text.AddNumber("split-line", view.splitPosition);
    std::string overlays;
    for (auto const& [name, overlay] : kOverlayNames) {
        if (view.Has(overlay)) overlays += (overlays.empty() ? "" : ",") + std::string(name);
    }
    text.Add("overlay", overlays.empty() ? "none" : overlays);
    text.AddNumber("lines", view.lineCount);
    text.AddNumber("line-angle", view.lineAngle);
    text.AddNumber("roughness", view.roughness);
    text.AddNumber("range", view.range);
    text.AddNumber("vertex", view.vertex);
    text.Add("background", tool::NameOf(kBackgroundNames, view.background));
    text.Add("legend", tool::NameOf(kSwitchNames, view.legend));
    if (!view.caption.empty()) text.Add("caption", view.caption);
    text.Add("camera", settings.camera.Text());
    text.Add("deform", tool::NameOf(kDeformationNames, settings.deformation.kind));
    text.AddNumber("phase", settings.deformation.phase);
    text.AddNumber("amount", settings.deformation.amount);
    text.AddNumber("screenshot-multiple", settings.screenshotMultiple);
}

std::string_view Trimmed(std::string_view text) {
    std::size_t const first = text.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

}  // namespace

std::string SettingsText(Settings const& settings) {
    SettingsWriter text;
    if (!settings.modelFile.empty()) text.Add("model", settings.modelFile);
    AddMethod(settings, text);
    AddView(settings, text);
    return "# Settings of osd_shading_viewer: options of its command line, one a line.\n" + text.Text();
}

std::vector<std::string> ReadSettingsFile(std::string const& file) {
    std::vector<std::string> words;
    std::string const text = io::ReadTextFile(file);
    std::string_view rest = text;
    for (std::int64_t number = 1; !rest.empty(); ++number) {
        std::size_t const end = std::min(rest.find('\n'), rest.size());
        std::string_view const line = Trimmed(rest.substr(0, end));
        rest.remove_prefix(std::min(end + 1, rest.size()));
        if (line.empty() || line.front() == '#') continue;
        std::size_t const space = std::min(line.find_first_of(" \t"), line.size());
        std::string_view const value = Trimmed(line.substr(space));
        std::string const name(line.substr(0, space));
        bool const isOption = name.find_first_not_of("abcdefghijklmnopqrstuvwxyz-") == std::string::npos &&
                              name.front() != '-' && name != "settings" && !value.empty();
        if (!isOption) throw io::ParseError(file, number, "expected the name of an option, a space, and its value");
        words.push_back("--" + name + "=" + std::string(value));
    }
    return words;
}

}  // namespace osd_shading::viewer
