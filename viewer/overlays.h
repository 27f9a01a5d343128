// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "scene.h"
#include "sceneFields.h"

namespace osd_shading::viewer {

/// What is picked: curves of SurfaceTopology and control vertices.
struct Selection {
    std::vector<int> curves, vertices;
    int hoverCurve = -1, hoverVertex = -1;  ///< under the cursor

    bool IsEmpty() const { return curves.empty() && vertices.empty(); }
    bool operator==(Selection const&) const = default;
};

/// A line between two points, or a mark: a point and the number on it (-1: none).
struct OverlayItem {
    std::array<int, 2> ends;
    std::array<std::uint8_t, 4> color;
};

/// Edges of the result.
std::vector<OverlayItem> WireItems(Scene const& scene);
/// Edges of the control mesh, as its vertices.
std::vector<OverlayItem> CageItems(Scene const& scene);
/// Sharp edges by the sharpness of the control edge they lie on.
std::vector<OverlayItem> CreaseItems(Scene const& scene);
/// Extraordinary vertices, darts and corners, as `overlays` say.
std::vector<OverlayItem> MarkItems(Scene const& scene, std::uint32_t overlays);
std::vector<OverlayItem> SelectionItems(Scene const& scene, Selection const& selection);
std::vector<OverlayItem> SelectionMarks(Scene const& scene, Selection const& selection);

/// Arrows of the three normals of each region.
struct ArrowShape {
    std::vector<glm::vec3> points;
    std::vector<OverlayItem> items;
};
ArrowShape RegionArrows(Scene const& scene, RegionShape const& regions);

}  // namespace osd_shading::viewer
