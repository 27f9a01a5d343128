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
};

/// One-sided limit normals by OpenSubdiv's tangent masks, over each region's own faces:
///
///     smooth, dart            the ring's mask
///     crease, boundary        the crease mask over the region
///     corner of one face      its two edges
///     corner of several       no limit normal exists: the region's uniform average of unit face normals
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

}  // namespace v1
}  // namespace osd_shading
