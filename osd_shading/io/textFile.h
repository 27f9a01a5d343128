// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "osd_shading/export.h"

namespace osd_shading {
inline namespace v1 {
namespace io {

/// Returns the bytes of the file at `path`, whatever they are; pipes are read to their end.
///
/// ERRORS: ReadError, also for a folder.
OSD_SHADING_API std::string ReadTextFile(std::string const& path);

}  // namespace io
}  // namespace v1
}  // namespace osd_shading
