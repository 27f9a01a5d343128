// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "osd_shading/export.h"
#include "osd_shading/shadingResult.h"

namespace osd_shading {
inline namespace v1 {
namespace io {

/// Writes `result` as Wavefront OBJ: `v` per vertex, `vt` per UV value (when there are UVs), `vn` the blended
/// normal of each (vertex, region) value, `f v/vt/vn` or `f v//vn`, all in the result's order.
///
/// All numbers read back as the same bits in the result's own precision. Weights have no place in this format.
///
/// ERRORS: WriteError; nothing is then left.
template <typename Real>
void WriteObj(std::string const& path, ShadingResult<Real> const& result);

extern template OSD_SHADING_API void WriteObj(std::string const&, ShadingResult<float> const&);
extern template OSD_SHADING_API void WriteObj(std::string const&, ShadingResult<double> const&);

}  // namespace io
}  // namespace v1
}  // namespace osd_shading
