// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "osd_shading/export.h"
#include "osd_shading/shadingResult.h"

namespace osd_shading {
inline namespace v1 {
namespace io {

/// The two forms of PLY.
enum class PlyFormat {
    Binary,  ///< in the machine's byte order, which the header names (default)
    Ascii    ///< text
};

/// How a PLY file is written.
struct PlyOptions {
    PlyFormat format = PlyFormat::Binary;  ///< binary or text
};

/// Writes `result` as PLY: a vertex for each (vertex, region) value, in their order.
///
///     float x y z                     position
///     float nx ny nz                  blended normal
///     float blend_weight              limit of b
///     float limit_nx ..ny ..nz        limit normal
///     float subdivided_nx ..ny ..nz   subdivided normal, 0 where the weight is 0
///     int vertex                      OpenSubdiv's index at the last level
///     int region                      counts from 0 at each vertex
///     float s t                       when there are UVs
///     face: list uchar int vertex_indices, in the result's order
///
/// Where the corners of a value have different UVs, it has the first, and a further PLY vertex for each other one
/// stands after those of all values; so PLY vertex i is value i, with UVs or without. Values without a face have
/// UV 0 0; isolated vertices have no value, and are left out.
///
/// ERRORS: WriteError, also for positions too large for float; nothing is then left.
template <typename Real>
void WritePly(std::string const& path, ShadingResult<Real> const& result, PlyOptions const& options = {});

extern template OSD_SHADING_API void WritePly(std::string const&, ShadingResult<float> const&, PlyOptions const&);
extern template OSD_SHADING_API void WritePly(std::string const&, ShadingResult<double> const&, PlyOptions const&);

}  // namespace io
}  // namespace v1
}  // namespace osd_shading
