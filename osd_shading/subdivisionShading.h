// SPDX-License-Identifier: Apache-2.0
#pragma once

/// \file
/// The front door: everything that most users need.

#include <opensubdiv/far/topologyRefiner.h>

#include <cstdint>
#include <vector>

#include "osd_shading/controlMesh.h"
#include "osd_shading/errors.h"
#include "osd_shading/export.h"
#include "osd_shading/shadingInput.h"
#include "osd_shading/shadingOptions.h"
#include "osd_shading/shadingResult.h"
#include "osd_shading/views.h"

namespace osd_shading {
inline namespace v1 {

namespace Far = OpenSubdiv::OPENSUBDIV_VERSION::Far;

/// Shades a control mesh once, level by level.
///
///     ShadingInput<float> input;
///     input.positions = {points.data(), points.size() / 3};
///     ShadingResult<float> shaded = ShadeSubdivision(mesh, input, PaperPreset(4));
///
/// Deterministic: the same bits whatever the number of threads. Reentrant; nothing is kept between calls.
///
/// ERRORS: InvalidControlMesh, InvalidOptions, MemoryLimitExceeded, Cancelled; nothing else but std::bad_alloc.
/// COST: about twice OpenSubdiv's own refining, interpolating and limits, linear in the faces of the last level.
template <typename Real>
ShadingResult<Real> ShadeSubdivision(ControlMesh const& mesh, ShadingInput<Real> const& input,
                                     ShadingOptions const& options = {});

/// The same from an existing refiner, whose level 0, scheme and options are used. It may be refined or not; it is
/// not modified and must only live as long as the call.
template <typename Real>
ShadingResult<Real> ShadeSubdivision(Far::TopologyRefiner const& refiner, ShadingInput<Real> const& input,
                                     ShadingOptions const& options = {});

/// What the memory of a run depends on, besides level and precision: counts of the control mesh.
struct MeshSize {
    Sdc::SchemeType scheme = Sdc::SCHEME_CATMARK;  ///< Catmull-Clark or Loop
    std::int64_t numVertices = 0;                  ///< also isolated ones
    std::int64_t numFaces = 0;                     ///< also holes
    std::int64_t numFaceCorners = 0;               ///< the sum of the faces' sizes
    std::int64_t numCreases = 0;                   ///< interior edges with a sharpness
    std::int64_t numNgonTerms = 0;      ///< squares of the sizes of n-gons, where fields start at level 0
    std::int64_t numFaceVarying = 0;    ///< face-varying channels
    std::int64_t faceVaryingWidth = 0;  ///< numbers per value, over all of them
    std::int64_t vertexDataWidth = 0;   ///< numbers per vertex, over all vertex primvars
};

/// Bytes that `ShadeSubdivision` takes at most, with numbers of `realSize` bytes: an estimate from above, some 5 to
/// 30% over what was measured. Grows with the faces of the last level; saturates.
OSD_SHADING_API std::uint64_t EstimateShadingBytes(MeshSize const& size, int level, std::size_t realSize);

#define OSD_SHADING_DECLARE(Real)                                              \
    extern template OSD_SHADING_API ShadingResult<Real> ShadeSubdivision(      \
        ControlMesh const&, ShadingInput<Real> const&, ShadingOptions const&); \
    extern template OSD_SHADING_API ShadingResult<Real> ShadeSubdivision(      \
        Far::TopologyRefiner const&, ShadingInput<Real> const&, ShadingOptions const&);
OSD_SHADING_DECLARE(float)
OSD_SHADING_DECLARE(double)
#undef OSD_SHADING_DECLARE

}  // namespace v1
}  // namespace osd_shading
