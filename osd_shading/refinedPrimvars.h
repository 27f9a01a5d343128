// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include "osd_shading/refinedTopology.h"
#include "osd_shading/shadingResult.h"

namespace osd_shading {
inline namespace v1 {

/// A vertex primvar at the last level, by OpenSubdiv's `PrimvarRefiner`: its limit or its refined values.
template <typename Real>
RefinedPrimvar<Real> RefineVertexData(RefinedTopology const& topology, PrimvarView<Real> const& control,
                                      PositionKind positions);

/// Whether `PrimvarRefiner::LimitFaceVarying` can be asked: not at level 0, where (in 3.5 and 3.6) it looks up a
/// value's rule by the value's number, as if values were numbered by their vertices, and reads past the end of its
/// arrays.
inline bool HasFaceVaryingLimit(RefinedTopology const& topology) { return topology.LastLevel() > 0; }

/// A face-varying primvar of channel `channel`, for the faces of the last level that are no holes. At level 0
/// values stay what they are.
template <typename Real>
RefinedFaceVarying<Real> RefineFaceVaryingData(RefinedTopology const& topology, int channel,
                                               PrimvarView<Real> const& control, PositionKind positions);

}  // namespace v1
}  // namespace osd_shading
