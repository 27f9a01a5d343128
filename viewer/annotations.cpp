// SPDX-License-Identifier: Apache-2.0
#include "annotations.h"

#include <imgui.h>

#include <array>
#include <cstdio>

#include "colors.h"

namespace osd_shading::viewer {

namespace {

ImU32 ToImGui(glm::vec3 const& color, float alpha = 1) {
    return ImGui::GetColorU32({color.r, color.g, color.b, alpha});
}

template <typename... Arguments>
std::string Format(char const* format, Arguments... arguments) {
    std::array<char, 200> text{};
    std::snprintf(text.data(), text.size(), format, arguments...);
    return text.data();
}

// Text on a ground of its own, so that it can be read over the surface.
void AddGroundedText(ImDrawList& list, ViewOptions const& view, float scale, ImVec2 at, std::string const& text) {
    ImVec2 const extent = ImGui::CalcTextSize(text.c_str());
    float const margin = 3 * scale;
    list.AddRectFilled({at.x - margin, at.y - margin / 2}, {at.x + extent.x + margin, at.y + extent.y + margin / 2},
                       ToImGui(BackgroundColor(view.background), 0.75F));
    list.AddText(at, ToImGui(TextColor(view.background)), text.c_str());
}

/// Writes legends from the lower left corner upwards.
class Legend {
public:
    Legend(ImDrawList& list, ViewOptions const& view, glm::ivec2 size, float scale)
        : _list(list), _view(view), _scale(scale), _bottom(static_cast<float>(size.y) - 10 * scale) {
        // The caption stands below.
        if (!view.caption.empty()) _bottom -= ImGui::GetTextLineHeight() + 6 * scale;
    }

    void AddScale(ColorScale const& colors, std::string const& low, std::string const& high,
                  std::string const& title) {
        constexpr int kSteps = 64;
        float const left = 10 * _scale, width = 160 * _scale, height = 10 * _scale,
                    line = ImGui::GetTextLineHeight();
        _bottom -= line;
        text({left, _bottom}, low);
        text({left + width - ImGui::CalcTextSize(high.c_str()).x, _bottom}, high);
        _bottom -= height + 2 * _scale;
        for (int i = 0; i < kSteps; ++i) {
            float const x = left + width * static_cast<float>(i) / kSteps;
            _list.AddRectFilled({x, _bottom}, {x + width / kSteps + 0.5F, _bottom + height},
                                ToImGui(ColorAt(colors, static_cast<float>(i) / (kSteps - 1))));
        }
        _bottom -= line + 2 * _scale;
        text({left, _bottom}, title);
        _bottom -= 6 * _scale;
    }

    void AddColor(glm::vec3 const& color, std::string const& title) {
        float const left = 10 * _scale, line = ImGui::GetTextLineHeight();
        _bottom -= line + 3 * _scale;
        _list.AddRectFilled({left, _bottom + 2 * _scale}, {left + 14 * _scale, _bottom + line - 1 * _scale},
                            ToImGui(color));
        text({left + 20 * _scale, _bottom}, title);
    }

private:
    void text(ImVec2 at, std::string const& words) { AddGroundedText(_list, _view, _scale, at, words); }

    ImDrawList& _list;
    ViewOptions const& _view;
    float _scale, _bottom;
};

// A label whose upper middle is `middle`.
void AddLabel(ImDrawList& list, ViewOptions const& view, float scale, ImVec2 middle, std::string const& label) {
    AddGroundedText(list, view, scale, {middle.x - ImGui::CalcTextSize(label.c_str()).x / 2, middle.y}, label);
}

void AddLegends(Legend& legend, ViewOptions const& view, ViewFacts const& facts) {
    double const range = static_cast<double>(facts.range);
    if (view.shading == ShadingMode::Difference) {
        legend.AddScale(kAngleScale, "0", Format("%.3g deg", range),
                        NormalLabel(view.left) + " to " + NormalLabel(view.right) +
                            Format(": mean %.3g, max %.3g deg", facts.angles.mean, facts.angles.max));
    } else if (view.shading == ShadingMode::Weight) {
        legend.AddScale(kWeightScale, "0", "1", "blend weight b");
    } else if (view.shading == ShadingMode::Curvature) {
        legend.AddScale(kCurvatureScale, Format("%.3g", -range), Format("%.3g", range),
                        "mean curvature of the normals, sphere = 1");
    } else if (view.shading == ShadingMode::Facing) {
        legend.AddColor({0.85F, 0.05F, 0.55F}, "normal points away");
        legend.AddColor({0.93F, 0.58F, 0.25F}, "back");
        legend.AddColor({0.45F, 0.62F, 0.80F}, "front");
    }
    if (view.Has(kCreases)) {
        legend.AddColor(kBoundaryColor, "boundary");
        legend.AddScale(kSharpnessScale, "0", "10 = infinite", "sharpness");
    }
    if (view.Has(kEv)) {
        legend.AddColor(kRegularSharpColor, "extraordinary, sharp");
        legend.AddColor(kEvColor, "extraordinary");
    }
    if (view.Has(kDarts)) legend.AddColor(kDartColor, "dart");
    if (view.Has(kCorners)) legend.AddColor(kCornerColor, "corner");
    if (facts.regionVertex >= 0) {
        legend.AddColor(kBlendedNormalColor, "N_B");
        legend.AddColor(kSubdividedNormalColor, "N_S");
        legend.AddColor(kLimitNormalColor, Format("N_L   (regions of vertex %d)", facts.regionVertex));
    }
}

void AddSplit(ImDrawList& list, ViewOptions const& view, glm::ivec2 size, float scale) {
    std::vector<Viewport> const viewports = ViewportsOf(view, size);
    if (viewports.size() < 2) return;
    auto const height = static_cast<float>(size.y), middle = static_cast<float>(viewports[1].cutCorner.x);
    list.AddLine({middle, 0}, {middle, height}, ToImGui(TextColor(view.background), 0.6F), 1.5F * scale);
    for (Viewport const& viewport : viewports) {
        std::string const label = NormalLabel(viewport.normals);
        float const width = ImGui::CalcTextSize(label.c_str()).x;
        if (static_cast<float>(viewport.cutSize.x) < width + 12 * scale) continue;
        float const center = static_cast<float>(viewport.cutCorner.x) + static_cast<float>(viewport.cutSize.x) / 2;
        AddLabel(list, view, scale, {center, 8 * scale}, label);
    }
}

}  // namespace

std::string NormalLabel(NormalChoice choice) {
    switch (choice) {
        case NormalChoice::Limit:
            return "N_L";
        case NormalChoice::Subdivided:
            return "N_S";
        case NormalChoice::Blended:
            return "N_B";
        case NormalChoice::Face:
            break;
    }
    return "faces";
}

std::vector<std::string> SceneLines(Scene const& scene) {
    ShadingReport const& report = scene.report;
    auto const number = [](std::int64_t x) { return static_cast<long long>(x); };
    std::vector<std::string> lines;
    lines.push_back(Format("level %d: %lld faces, %lld vertices, %lld values", scene.options.level,
                           number(report.faces), number(report.vertices), number(report.values)));
    auto const addCounts = [&](std::map<int, std::int64_t> const& counts, char const* title) {
        if (counts.empty()) return;
        std::string line = title;
        for (auto const& [valence, count] : counts) line += Format("  %d: %lld", valence, number(count));
        lines.push_back(line);
    };
    addCounts(report.extraordinary, "EVs by valence");
    addCounts(report.boundaryExtraordinary, "EVs on boundaries");
    lines.push_back(Format("sharp %lld, darts %lld, boundary %lld", number(report.sharpVertices),
                           number(report.darts), number(report.boundaryVertices)));
    lines.push_back(Format("%lld vertices need N_S", number(report.verticesWithWeight)));
    lines.push_back(Format("N_L to N_B: mean %.3g, largest %.3g deg", report.meanAngle, report.maxAngle));
    lines.push_back(Format("shaded in %.1f ms", scene.seconds * 1e3));
    return lines;
}

void Annotate(ImDrawList& list, ViewOptions const& view, ViewFacts const& facts, glm::ivec2 size, float scale,
              std::vector<std::string> const& lines) {
    AddSplit(list, view, size, scale);
    if (view.legend) {
        Legend legend(list, view, size, scale);
        AddLegends(legend, view, facts);
    }
    bool const hasLabels = ViewportsOf(view, size).size() > 1;
    float y = 8 * scale + (hasLabels ? ImGui::GetTextLineHeight() + 6 * scale : 0);
    for (std::string const& line : lines) {
        list.AddText({10 * scale, y}, ToImGui(TextColor(view.background)), line.c_str());
        y += ImGui::GetTextLineHeight() + 2 * scale;
    }
    if (!view.caption.empty()) {
        float const top = static_cast<float>(size.y) - ImGui::GetTextLineHeight() - 6 * scale;
        AddLabel(list, view, scale, {static_cast<float>(size.x) / 2, top}, view.caption);
    }
}

}  // namespace osd_shading::viewer
