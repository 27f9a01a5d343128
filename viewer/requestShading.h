// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <glm/glm.hpp>
#include <vector>

#include "camera.h"
#include "osd_shading/shadingInput.h"
#include "osd_shading/shadingResult.h"
#include "sceneRequest.h"

namespace osd_shading::viewer {

/// The middle of the model's box. Single precision shows a model anywhere as well as at the origin.
glm::dvec3 OriginOf(io::Model const& model);

/// The smallest sphere about the middle of the box of all `positionOf(point)`; of radius 1 where they are all in
/// one.
template <typename Point, typename PositionOf>
Sphere SphereAround(std::vector<Point> const& points, PositionOf const& positionOf) {
    if (points.empty()) return {};
    glm::vec3 low = positionOf(points[0]), high = low;
    for (Point const& point : points) {
        low = glm::min(low, positionOf(point));
        high = glm::max(high, positionOf(point));
    }
    Sphere sphere{(low + high) / 2.0F, 0};
    for (Point const& point : points) {
        sphere.radius = std::max(sphere.radius, glm::distance(positionOf(point), sphere.center));
    }
    if (!(sphere.radius > 0)) sphere.radius = 1;
    return sphere;
}

/// What `request` shows, of a model with `input`: a uniform level or triangles of the limit surface. `options`: the
/// request's, with what the run adds. `origin`: of the request's camera, in the coordinates of `input`.
///
/// ERRORS: those of the library; io::ParseError where the mesh is at fault.
template <typename Real>
ShadingResult<Real> ShadeRequest(SceneRequest const& request, ShadingInput<Real> const& input,
                                 ShadingOptions const& options, glm::dvec3 const& origin);

}  // namespace osd_shading::viewer
