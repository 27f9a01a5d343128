// SPDX-License-Identifier: Apache-2.0
#include "commandLine.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <utility>

#include "builtInModels.h"

namespace osd_shading::viewer {

namespace {

using tool::AddChoice;
using tool::AddNumber;
using tool::ParseNumber;
using tool::Refuse;
using tool::Replace;
using tool::UsageError;

constexpr int kMaxPixels = 16384;

/// Options of which one decides how another is meant.
struct GivenOptions {
    std::optional<ShadingMode> shading;
    std::optional<NormalChoice> normals;
    std::optional<std::pair<NormalChoice, NormalChoice>> pair;
    std::optional<SplitKind> split;
    std::optional<double> splitPosition, roughness, lineAngle, range, scale, phase, amount;
    std::optional<int> lines, vertex, screenshotMultiple;
    std::optional<Background> background;
    std::optional<bool> legend;
    std::optional<DeformationKind> deformation;
};

template <typename T, std::size_t N>
T ParseWord(std::string const& option, std::string_view text, OptionNames<T, N> const& names) {
    std::string words;
    for (auto const& [name, value] : names) {
        if (name == text) return value;
        words += (words.empty() ? "" : "|") + std::string(name);
    }
    Refuse(option, "'" + std::string(text) + "' is not one of " + words);
}

template <typename T, std::size_t N>
std::string Words(OptionNames<T, N> const& names, char const* separator) {
    std::string words;
    for (auto const& [name, value] : names) words += (words.empty() ? "" : separator) + std::string(name);
    return words;
}

glm::ivec2 ParseSize(std::string const& text) {
    std::size_t const x = text.find('x');
    std::optional<int> width, height;
    if (x != std::string::npos) {
        width = ParseNumber<int>(std::string_view(text).substr(0, x));
        height = ParseNumber<int>(std::string_view(text).substr(x + 1));
    }
    auto const isAllowed = [](std::optional<int> side) { return side && *side >= 1 && *side <= kMaxPixels; };
    if (!isAllowed(width) || !isAllowed(height)) {
        Refuse("--size", "'" + text + "' is not a size of 1 to 16384 pixels, such as 1280x800");
    }
    return {*width, *height};
}

std::pair<NormalChoice, NormalChoice> ParsePair(std::string const& text) {
    std::size_t const comma = text.find(',');
    if (comma == std::string::npos) Refuse("--split", "'" + text + "' is not a pair such as limit,blended");
    return {ParseWord("--split", std::string_view(text).substr(0, comma), kNormalNames),
            ParseWord("--split", std::string_view(text).substr(comma + 1), kNormalNames)};
}

std::uint32_t ParseOverlays(std::string_view text) {
    std::uint32_t overlays = 0;
    if (text == "none") return overlays;
    for (;;) {
        std::size_t const comma = std::min(text.find(','), text.size());
        overlays |= ParseWord("--overlay", text.substr(0, comma), kOverlayNames);
        if (comma == text.size()) return overlays;
        text.remove_prefix(comma + 1);
    }
}

void AddFileOptions(CLI::App& app, CommandLine& line) {
    app.add_option("MODEL,--model", line.settings.modelFile,
                   "Control mesh: an OBJ file, or one of the built-in models")
        ->type_name("FILE");
    app.add_option("--image", line.imageFile, "Write a picture as PNG, without a window or display")
        ->type_name("FILE");
    app.add_option_function<std::string>(
           "--size", [&line](std::string const& text) { line.size = ParseSize(text); },
           "Pixels of the picture or window (default 1280x800)")
        ->type_name("WxH");
    // Expanded before this parser sees the words.
    app.add_option("--settings", "Options from a file, as the window saves them; those given here win")
        ->type_name("FILE");
    app.add_option("--figures", line.figuresFolder, "Write the paper's figures, made anew, as PNGs into a folder")
        ->type_name("FOLDER");
    app.add_option("--extra-models", line.extraModels, "Folder with the paper's own models, for --figures")
        ->type_name("FOLDER");
}

void AddViewOptions(CLI::App& app, CommandLine& line, GivenOptions& given) {
    static constexpr char kGroup[] = "View";
    ViewOptions& view = line.settings.view;
    AddChoice(app, "--shading", given.shading, kShadingNames, "What colours say (default highlight)")
        ->group(kGroup);
    AddChoice(app, "--normals", given.normals, kNormalNames, "Normals to shade with (default blended)")
        ->group(kGroup);
    app.add_option_function<std::string>(
           "--split", [&given](std::string const& text) { given.pair = ParsePair(text); },
           "Two views with one camera, or the normals of the difference: limit,blended")
        ->type_name("LEFT,RIGHT")
        ->group(kGroup);
    AddChoice(app, "--split-kind", given.split, kSplitNames, "How views are split (default side-by-side)")
        ->group(kGroup);
    AddNumber(
        app, "--split-line", given.splitPosition, "a number from 0 to 1", [](double x) { return x >= 0 && x <= 1; },
        "One view, divided at this share of its width")
        ->group(kGroup);
    app.add_option_function<std::string>(
           "--overlay", [&view](std::string const& text) { view.overlays = ParseOverlays(text); },
           "Drawn over the surface: " + Words(kOverlayNames, ",") + " or none")
        ->type_name("LIST")
        ->group(kGroup);
    app.add_option_function<std::string>(
           "--camera",
           [&line](std::string const& text) {
               std::optional<CameraChoice> const camera = ParseCamera(text);
               if (!camera) {
                   Refuse("--camera",
                          "'" + text +
                              "' is not front, back, left, right, top, bottom, corner or a text such as "
                              "orbit?yaw=35&pitch=22 (with distance and target, or neither)");
               }
               line.settings.camera = *camera;
           },
           "A standard view, or a view as the window prints it")
        ->type_name("VIEW")
        ->group(kGroup);
    AddNumber(
        app, "--lines", given.lines, "a whole number from 1 to 500", [](int x) { return x >= 1 && x <= 500; },
        "Number of highlight lines, isophotes or rings (default 24)")
        ->group(kGroup);
    AddNumber(
        app, "--line-angle", given.lineAngle, "an angle from -180 to 180 degrees",
        [](double x) { return std::abs(x) <= 180; }, "Direction of the highlight lines (default 0: level)")
        ->group(kGroup);
    AddNumber(
        app, "--roughness", given.roughness, "a number from 0 to 1", [](double x) { return x >= 0 && x <= 1; },
        "Of the lit surface (default 0.35)")
        ->group(kGroup);
    AddNumber(
        app, "--range", given.range, "a finite number above 0", [](double x) { return std::isfinite(x) && x > 0; },
        "End of the colour scale of difference (degrees) and curvature (default: by the model)")
        ->group(kGroup);
    AddNumber(
        app, "--vertex", given.vertex, "a whole number, 0 or more", [](int x) { return x >= 0; },
        "Vertex of the last level whose regions are drawn (default: one with many)")
        ->group(kGroup);
    AddChoice(app, "--background", given.background, kBackgroundNames, "White (default) or dark")->group(kGroup);
    AddChoice(app, "--legend", given.legend, kSwitchNames, "Colour scales in the picture (default on)")
        ->group(kGroup);
    app.add_option("--caption", view.caption, "A line of text in the picture")->type_name("TEXT")->group(kGroup);
    app.add_flag("--hud", line.hasHud, "Counts and times in the picture")->group(kGroup);
    AddNumber(
        app, "--scale", given.scale, "a number from 0.5 to 8", [](double x) { return x >= 0.5 && x <= 8; },
        "Size of letters and lines in a picture (default 1)")
        ->group(kGroup);
    AddNumber(
        app, "--screenshot-multiple", given.screenshotMultiple, "a whole number from 1 to 8",
        [](int x) { return x >= 1 && x <= kMaxScreenshotMultiple; },
        "Size of the window's screenshots, times that of its scene (default 1)")
        ->group(kGroup);
}

void AddMotionOptions(CLI::App& app, GivenOptions& given) {
    static constexpr char kGroup[] = "Motion";
    AddChoice(app, "--deform", given.deformation, kDeformationNames, "A built-in movement (default none)")
        ->group(kGroup);
    AddNumber(
        app, "--phase", given.phase, "a number from 0 to 1", [](double x) { return x >= 0 && x <= 1; },
        "Time in the movement's period (default 0)")
        ->group(kGroup);
    AddNumber(
        app, "--amount", given.amount, "a number from 0 to 3", [](double x) { return x >= 0 && x <= 3; },
        "Strength of the movement (default 1)")
        ->group(kGroup);
}

template <typename T>
void ReplaceNumber(T& value, std::optional<double> const& given) {
    if (given) value = static_cast<float>(*given);
}

void Resolve(GivenOptions const& given, CommandLine& line) {
    ViewOptions& view = line.settings.view;
    Replace(view.shading, given.shading);
    Replace(view.normals, given.normals);
    if (given.pair) {
        std::tie(view.left, view.right) = *given.pair;
        view.split = SplitKind::SideBySide;
    }
    if (given.splitPosition) view.split = SplitKind::Line;
    Replace(view.split, given.split);
    ReplaceNumber(view.splitPosition, given.splitPosition);
    Replace(view.lineCount, given.lines);
    ReplaceNumber(view.lineAngle, given.lineAngle);
    ReplaceNumber(view.roughness, given.roughness);
    ReplaceNumber(view.range, given.range);
    if (given.vertex) view.vertex = given.vertex;
    Replace(view.background, given.background);
    Replace(view.legend, given.legend);
    ReplaceNumber(line.scale, given.scale);
    Deformation& deformation = line.settings.deformation;
    Replace(deformation.kind, given.deformation);
    ReplaceNumber(deformation.phase, given.phase);
    ReplaceNumber(deformation.amount, given.amount);
    Replace(line.settings.screenshotMultiple, given.screenshotMultiple);

    // A window without a word about the view begins with the artefact beside its cure.
    bool const saysNothing =
        !given.shading && !given.normals && !given.pair && !given.split && !given.splitPosition;
    if (saysNothing && line.imageFile.empty()) view.split = SplitKind::SideBySide;
}

// Puts the words of settings files before all others, so that those win.
std::vector<std::string> Expanded(std::vector<std::string> const& words) {
    std::vector<std::string> settings, others;
    static constexpr std::string_view kName = "--settings";
    for (std::size_t i = 0; i < words.size(); ++i) {
        std::string_view const word = words[i];
        bool const isApart = word == kName && i + 1 < words.size();
        bool const isJoined = word.starts_with(kName) && word.substr(kName.size()).starts_with('=');
        if (!isApart && !isJoined) {
            others.push_back(words[i]);
            continue;
        }
        std::string const file = isApart ? words[++i] : std::string(word.substr(kName.size() + 1));
        std::vector<std::string> const read = ReadSettingsFile(file);
        settings.insert(settings.end(), read.begin(), read.end());
    }
    settings.insert(settings.end(), others.begin(), others.end());
    return settings;
}

}  // namespace

std::optional<CommandLine> ParseCommandLine(std::vector<std::string> const& words) {
    CLI::App app("Shows subdivision surfaces with semi-sharp creases, and compares and edits their shading.",
                 "osd_shading_viewer");
    app.set_help_flag("--help,-h", "Print this and exit");
    app.set_version_flag("--version", "osd_shading_viewer " OSD_SHADING_VERSION, "Print the version and exit");
    std::string names;
    for (BuiltInModel const& model : BuiltInModels()) names += (names.empty() ? "" : " ") + std::string(model.name);
    app.footer(
        "Built-in models: " + names +
        ".\nWithout --image or --figures a window opens; H lists its keys.\nExit status: 0, or 2 (bad usage or "
        "input, or a picture that can't be made).");
    app.get_formatter()->column_width(40);
    app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);

    CommandLine line;
    GivenOptions given;
    AddFileOptions(app, line);
    tool::AddMeshOptions(app, line.settings.mesh);
    tool::AddShadingOptions(app, line.settings.shading);
    tool::AddTessellationOptions(app, line.settings.tessellation);
    AddViewOptions(app, line, given);
    AddMotionOptions(app, given);
    tool::AddRunOptions(app, line.settings.run, "float, for files that the window saves double");
    app.add_flag("--report-state", line.reportsState, "Print the window's state as JSON whenever it changes")
        ->group("Run");
    try {
        std::vector<std::string> reversed = Expanded(words);
        std::reverse(reversed.begin(), reversed.end());  // as CLI11 takes them
        app.parse(std::move(reversed));
    } catch (CLI::Success const& success) {
        app.exit(success);
        return std::nullopt;
    } catch (CLI::ParseError const& error) {
        throw UsageError(std::string(error.what()) + " (see osd_shading_viewer --help)");
    }
    Resolve(given, line);
    (void)line.settings.ResolveShading();  // contradictions are usage errors
    (void)line.settings.tessellation.Resolve();
    if (!line.imageFile.empty() && !line.figuresFolder.empty())
        Refuse("--image", "and --figures exclude each other");
    if (app.count("--image") > 0 && line.imageFile.empty()) Refuse("--image", "the name is empty");
    if (app.count("--figures") > 0 && line.figuresFolder.empty()) Refuse("--figures", "the name is empty");
    return line;
}

}  // namespace osd_shading::viewer
