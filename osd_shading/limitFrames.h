// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <cstdint>
#include <vector>

#include "osd_shading/faceNormals.h"
#include "osd_shading/limitMasks.h"

namespace osd_shading {
inline namespace v1 {

/// N_L of every value of a level.
template <typename Real>
struct LimitNormals {
    std::vector<Vec3<Real>> normals;  ///< unit length; zero for those in `missing`
    std::vector<int> missing;         ///< values that only N_S can give a normal; ascending
    std::int64_t numFallbacks = 0;    ///< values whose tangents were degenerate
    std::int64_t numAverages = 0;     ///< values without tangent plane, as far as the masks know: averages of faces
};

/// One-sided limit normals by the step's tangent masks, over each region's own faces:
///
///     smooth, dart            the ring's mask
///     crease, boundary        the crease mask over the region
///     corner of one face      its two edges
///     corner of several       no limit normal exists: the region's uniform average of unit face normals
///
/// With exact masks that average also serves the crease fans, darts and rings that have no tangent plane.
///
/// Degenerate tangents (|t1 x t2| <= eps s1 s2, s = sum |w| |p - v|) fall back to that average.
///
/// COST: one pass over the rings.   [Sdc::Scheme::ComputeVertexLimitMask]
template <typename Real>
LimitNormals<Real> ComputeLimitNormals(LimitStep<Real> const& step, std::vector<Vec3<Real>> const& points,
                                       int numThreads);

/// N_L by the face averages of the level instead (ZBK's tool).
template <typename Real>
LimitNormals<Real> ComputeFaceAverageNormals(LimitStep<Real> const& step, std::vector<Vec3<Real>> const& points,
                                             FaceWeight weight, int numThreads);

/// How N_L of one value is made of its level's points, for those who turn it into rows.
template <typename Real>
struct LimitFrame {
    int value = 0;
    bool isAverage = false;                ///< no tangents: the uniform average of the unit normals of fan.faces
    std::vector<int> vertices;             ///< the vertex itself, then its neighbours; empty with isAverage
    std::vector<Real> tangent1, tangent2;  ///< weights of `vertices`, each adding to zero; N_L points along
                                           ///< tangent1 x tangent2
    RegionFan fan;                         ///< the region's faces, in the order of the masks
};

/// The frames of each value of `vertex`, in their order, before any fallback. Reuses the memory of `frames`.
template <typename Real>
void FindLimitFrames(LimitStep<Real> const& step, int vertex, std::vector<LimitFrame<Real>>& frames);

}  // namespace v1
}  // namespace osd_shading
