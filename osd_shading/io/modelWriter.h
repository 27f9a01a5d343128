// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "osd_shading/export.h"
#include "osd_shading/io/model.h"

namespace osd_shading {
inline namespace v1 {
namespace io {

/// Writes a control mesh as Wavefront OBJ: `v`, `vt`, `vn` and `f`, and all else in OpenSubdiv's `t` tags.
/// `ReadObj` reads the same model back, but for its name, lines and warnings.
///
/// ERRORS: WriteError; nothing is then left.
OSD_SHADING_API void WriteModel(std::string const& path, Model const& model);

/// Writes the sharpness of all edges as a `.sharp` file: one `fs` line per face, as `ApplySharpFile` reads them.
/// Sharpness of vertices has no place in it.
///
/// ERRORS: WriteError; nothing is then left.
OSD_SHADING_API void WriteSharpFile(std::string const& path, Model const& model);

}  // namespace io
}  // namespace v1
}  // namespace osd_shading
