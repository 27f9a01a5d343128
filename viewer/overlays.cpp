// SPDX-License-Identifier: Apache-2.0
#include "overlays.h"

#include <cstddef>

#include "colors.h"

namespace osd_shading::viewer {

namespace {

constexpr float kArrowLength = 0.25F;  // of the scene's radius

std::array<std::uint8_t, 4> Bytes(glm::vec3 const& color, float alpha = 1) {
    glm::vec4 const bytes = glm::round(glm::clamp(glm::vec4(color, alpha), 0.0F, 1.0F) * 255.0F);
    return {static_cast<std::uint8_t>(bytes.x), static_cast<std::uint8_t>(bytes.y),
            static_cast<std::uint8_t>(bytes.z), static_cast<std::uint8_t>(bytes.w)};
}

}  // namespace

std::vector<OverlayItem> WireItems(Scene const& scene) {
    std::vector<OverlayItem> items;
    items.reserve(scene.topology->wires.size());
    auto const color = Bytes(glm::vec3(0.05F), 0.55F);
    for (auto const& wire : scene.topology->wires) items.push_back({wire, color});
    return items;
}

std::vector<OverlayItem> CageItems(Scene const& scene) {
    std::vector<OverlayItem> items;
    for (auto const& edge : scene.cage.edges) items.push_back({edge, Bytes(glm::vec3(0.10F, 0.35F, 0.75F))});
    return items;
}

std::vector<OverlayItem> CreaseItems(Scene const& scene) {
    SurfaceTopology const& topology = *scene.topology;
    std::vector<OverlayItem> items;
    for (CreaseEdge const& edge : topology.creaseEdges) {
        if (topology.IsIsolated(edge.vertices[0]) || topology.IsIsolated(edge.vertices[1])) continue;
        glm::vec3 const color =
            edge.isBoundary ? kBoundaryColor : ColorAt(kSharpnessScale, edge.controlSharpness / 10);
        items.push_back(
            {{topology.FirstValue(edge.vertices[0]), topology.FirstValue(edge.vertices[1])}, Bytes(color)});
    }
    return items;
}

std::vector<OverlayItem> MarkItems(Scene const& scene, std::uint32_t overlays) {
    SurfaceTopology const& topology = *scene.topology;
    std::vector<OverlayItem> items;
    for (int vertex = 0; vertex < topology.NumVertices(); ++vertex) {
        VertexTag const& tag = topology.vertexTags[static_cast<std::size_t>(vertex)];
        if (topology.IsIsolated(vertex)) continue;
        int const value = topology.FirstValue(vertex);
        if (tag.kind == VertexKind::Dart && (overlays & kDarts)) {
            items.push_back({{value, tag.valence}, Bytes(kDartColor)});
        } else if (tag.kind == VertexKind::Corner && (overlays & kCorners)) {
            items.push_back({{value, tag.valence}, Bytes(kCornerColor)});
        } else if (tag.isExtraordinary && (overlays & kEv)) {
            bool const isSharp = tag.kind >= VertexKind::Crease;
            items.push_back({{value, tag.valence}, Bytes(isSharp ? kRegularSharpColor : kEvColor)});
        }
    }
    return items;
}

std::vector<OverlayItem> SelectionItems(Scene const& scene, Selection const& selection) {
    SurfaceTopology const& topology = *scene.topology;
    std::vector<OverlayItem> items;
    auto const add = [&](int index, glm::vec3 const& color, float alpha) {
        ControlCurve const& curve = topology.curves[static_cast<std::size_t>(index)];
        for (std::size_t i = curve.first; i + 1 < curve.first + curve.count; ++i) {
            items.push_back({{topology.curveValues[i], topology.curveValues[i + 1]}, Bytes(color, alpha)});
        }
    };
    if (selection.hoverCurve >= 0) add(selection.hoverCurve, kSelectionColor, 0.5F);
    for (int curve : selection.curves) add(curve, kSelectionColor, 1);
    return items;
}

std::vector<OverlayItem> SelectionMarks(Scene const& scene, Selection const& selection) {
    std::vector<OverlayItem> items;
    auto const add = [&](int vertex, glm::vec3 const& color) {
        items.push_back({{scene.topology->FirstValue(vertex), -1}, Bytes(color)});
    };
    if (selection.hoverVertex >= 0) add(selection.hoverVertex, glm::mix(kSelectionColor, glm::vec3(1), 0.5F));
    for (int vertex : selection.vertices) add(vertex, kSelectionColor);
    return items;
}

ArrowShape RegionArrows(Scene const& scene, RegionShape const& regions) {
    ArrowShape arrows;
    for (int value : regions.values) {
        SurfaceVertex const& vertex = scene.vertices[static_cast<std::size_t>(value)];
        auto const add = [&](glm::vec3 const& normal, glm::vec3 const& color, float length) {
            if (glm::dot(normal, normal) == 0) return;
            auto const first = static_cast<int>(arrows.points.size());
            arrows.points.push_back(vertex.position);
            arrows.points.push_back(vertex.position + normal * (length * kArrowLength * scene.bounds.radius));
            arrows.items.push_back({{first, first + 1}, Bytes(color)});
        };
        // Of three lengths, so that equal ones don't hide each other.
        add(vertex.limitNormal, kLimitNormalColor, 1.3F);
        add(vertex.subdividedNormal, kSubdividedNormalColor, 1.15F);
        add(vertex.blendedNormal, kBlendedNormalColor, 1);
    }
    return arrows;
}

}  // namespace osd_shading::viewer
