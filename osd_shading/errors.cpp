// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/errors.h"

namespace osd_shading {
inline namespace v1 {

// Out of line, so that each type has one vtable and is caught across a shared library's border.
Error::~Error() = default;
InvalidControlMesh::~InvalidControlMesh() = default;
InvalidOptions::~InvalidOptions() = default;
MemoryLimitExceeded::~MemoryLimitExceeded() = default;
Cancelled::~Cancelled() = default;

}  // namespace v1
}  // namespace osd_shading
