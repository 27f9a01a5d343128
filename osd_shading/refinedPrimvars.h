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

/// A face-varying primvar of channel `channel`, for the faces of the last level that are no holes.
template <typename Real>
RefinedFaceVarying<Real> RefineFaceVaryingData(RefinedTopology const& topology, int channel,
                                               PrimvarView<Real> const& control, PositionKind positions);

}  // namespace v1
}  // namespace osd_shading
