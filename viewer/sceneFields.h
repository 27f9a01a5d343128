// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "scene.h"

namespace osd_shading::viewer {

// Fields that only some pictures need.

/// Unit normal of each face (its vector area), and 0: four floats, as texture buffers have them.
std::vector<glm::vec4> FaceNormals(Scene const& scene);

/// Per value: the mean curvature of the field that `choice` names, half the divergence of the normal along the
/// surface, times the radius of the scene: 1 on a sphere. Averages over the triangles at the value, by area. Zero
/// for `Face`.
std::vector<float> NormalFieldCurvature(Scene const& scene, NormalChoice choice);

/// Angles in degrees between two normals, over the values.
struct AngleStatistics {
    double mean = 0, max = 0;
    int maxValue = -1;  ///< -1: there is no value where both exist
};
AngleStatistics CompareNormals(Scene const& scene, NormalChoice left, NormalChoice right);

/// Faces of a region, each as its faceSize values, in groups by value of the vertex.
struct RegionShape {
    std::vector<std::vector<std::uint32_t>> triangles;  ///< per region
    std::vector<int> values;                            ///< per region: the value of the vertex
};

/// The regions of `vertex` at the last level. Of a control vertex, whole control faces belong to a region: those of
/// the last level are too small to be seen.
RegionShape RegionsOf(Scene const& scene, int vertex);

/// The vertex that shows regions best: a sharp extraordinary one with the most regions, else any with the most.
int InterestingVertex(Scene const& scene);

}  // namespace osd_shading::viewer
