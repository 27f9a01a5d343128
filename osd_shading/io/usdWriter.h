// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "osd_shading/controlMesh.h"
#include "osd_shading/export.h"
#include "osd_shading/shadingResult.h"
#include "osd_shading/subdivisionShading.h"
#include "osd_shading/views.h"

namespace osd_shading {
inline namespace v1 {
namespace io {

/// What a USD file has beside the shaded mesh; views over the caller's memory.
struct UsdOptions {
    ControlMesh const* cage = nullptr;  ///< default: no control cage in the file
    PointView<double> cagePositions;    ///< one per vertex of the cage
    FaceVaryingView<double> cageUvs;    ///< of width 2, a valid index per face corner; empty: none
};

/// Writes `result` as USD text: an Xform named for the file, the default prim, with the Mesh `shaded` and, when
/// `options` has a cage, the Mesh `cage`, whose purpose is `guide` (shown on demand, and not rendered twice).
///
/// `shaded` is no subdivision surface any more: points and faces of the result, blended normals and `st` per face
/// corner, the blend weight as the primvar `blendWeight` per (vertex, region) value. `cage` is one: scheme,
/// creases, corners, holes and rules as in `options.cage`; where entries name one edge or vertex twice the higher
/// sharpness is written, since USD's readers take the last. Chaikin creasing has no place in USD's schema: it
/// stands as the custom attribute `osd_shading:creasingMethod`.
///
/// USD's meshes are in single precision: positions of double results are rounded. Y is up, the unit a metre: OBJ
/// says neither.
///
/// ERRORS: WriteError, also for positions too large for float; InvalidControlMesh when the arrays of the cage don't
/// fit together. Nothing is then left.
template <typename Real>
void WriteUsd(std::string const& path, ShadingResult<Real> const& result, UsdOptions const& options = {});

extern template OSD_SHADING_API void WriteUsd(std::string const&, ShadingResult<float> const&, UsdOptions const&);
extern template OSD_SHADING_API void WriteUsd(std::string const&, ShadingResult<double> const&, UsdOptions const&);

}  // namespace io
}  // namespace v1
}  // namespace osd_shading
