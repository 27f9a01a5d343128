// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <cstdint>
#include <vector>

#include "osd_shading/limitFrames.h"
#include "osd_shading/shadingOptions.h"

namespace osd_shading {
inline namespace v1 {

/// One normal per value of the start level.
template <typename Real>
struct StartNormals {
    std::vector<Vec3<Real>> normals;  ///< unit length, or zero where a sum vanished
    std::int64_t numZero = 0;
};

/// Start normals from the points of the start level itself. `kind` is not User.   [ZBK23] Sec. 2.2
template <typename Real>
StartNormals<Real> ComputeStartNormals(StartNormalKind kind, RefinedTopology const& topology, int level,
                                       CreaseRegions const& regions, std::vector<Vec3<Real>> const& points,
                                       int numThreads);

/// The values whose limit normals are smoothed (StartNormalKind::LimitSmoothed): those of extraordinary vertices
/// that are not sharp, and of all vertices that are not sharp of the faces round them.
template <typename Real>
ValueMarks MarkSmoothed(LimitStep<Real> const& step);

/// The caller's normals, one per vertex of level 0 or one per face corner, summed per region.
template <typename Real>
StartNormals<Real> GatherUserNormals(RefinedTopology const& topology, CreaseRegions const& regions,
                                     PointView<Real> vertexNormals, PointView<Real> faceVaryingNormals);

/// The face weight that a kind of start normal stands for; uniform for those that use none.
FaceWeight FaceWeightOf(StartNormalKind kind);

}  // namespace v1
}  // namespace osd_shading
