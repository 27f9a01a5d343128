// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <optional>

#include "osd_shading/tables/tileRing.h"

namespace osd_shading {
inline namespace v1 {
namespace tables {

/// The sharp edges of a quad over which the surface is one bicubic patch for `numLevels` levels more: bit i for its
/// edge i. None where it is not.
std::optional<unsigned> FindSharpSides(RegionLevels& levels, int level, int face, int numLevels);

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
