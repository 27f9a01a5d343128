// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "camera.h"
#include "scene.h"

namespace osd_shading::viewer {

/// What lies under the cursor.
struct Pick {
    int controlVertex = -1;  ///< -1: none near enough
    int curve = -1;          ///< of SurfaceTopology; -1: none near enough, or a control vertex is
    int vertex = -1;         ///< of the last level, nearest to the surface point; -1: the cursor misses the surface
    std::optional<glm::vec3> point;  ///< on the surface
};

/// Looks at pixel `cursor`, from the upper left corner of a view of `size` pixels; takes edges and vertices up to
/// `reach` pixels away that the surface does not hide.
///
/// COST: linear in the triangles.
Pick PickAt(Scene const& scene, Camera const& camera, glm::vec2 size, glm::vec2 cursor, float reach);

/// Where `point` is seen, in pixels from the upper left corner, and its distance along the view; nothing behind the
/// eye.
std::optional<glm::vec3> Project(Camera const& camera, Sphere const& bounds, glm::vec2 size,
                                 glm::vec3 const& point);

}  // namespace osd_shading::viewer
