// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "osd_shading/export.h"
#include "osd_shading/io/model.h"

namespace osd_shading {
inline namespace v1 {
namespace io {

/// Replaces all edge sharpness of `model`, whatever it came from, by that of a `.sharp` file: the `fs` and `as`
/// lines of [ZBK23]'s tool, by the same rule as in an OBJ. The sharpness of vertices stays.
///
/// An empty file makes every edge smooth; lines that are neither are skipped with one warning in `model`.
///
/// ERRORS: ReadError, ParseError (also for a file that has words but no such line); `model` is then unchanged.
OSD_SHADING_API void ApplySharpFile(std::string const& path, Model& model);

/// The same from a text that is already in memory; `fileName` is what errors and warnings call it.
OSD_SHADING_API void ApplySharpText(std::string_view text, std::string const& fileName, Model& model);

}  // namespace io
}  // namespace v1
}  // namespace osd_shading
