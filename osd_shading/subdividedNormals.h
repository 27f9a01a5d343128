// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <vector>

#include "osd_shading/fieldRefiner.h"
#include "osd_shading/limitMasks.h"
#include "osd_shading/shadingOptions.h"

namespace osd_shading {
inline namespace v1 {

/// N_S of the values of the last level that `marks` asks for (empty: all), before normalising; others are zero.
///
/// `start` holds the normals of level `startLevel`, at which `levels` begins or before. Only what the marked values
/// need is refined.   [ZBK23] Sec. 2.2, 3.2; spherical averaging [AB08]
template <typename Real>
std::vector<Vec3<Real>> ComputeSubdividedNormals(SubdividedNormalOptions const& options,
                                                 FieldLevels<Real> const& levels, int startLevel,
                                                 LimitStep<Real> const& limit, std::vector<Vec3<Real>> start,
                                                 ValueMarks const& marks, int numThreads);

}  // namespace v1
}  // namespace osd_shading
