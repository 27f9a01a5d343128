// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <vector>

#include "osd_shading/tables/tileRing.h"

namespace osd_shading {
inline namespace v1 {
namespace surface {

/// A face with the faces up to `numRings` rings round it, as a mesh of its own, numbered by a walk from the
/// face outwards, so that equal neighbourhoods give equal meshes (in the level's order where that matters). Faces
/// keep their first corners. REQUIRES: nothing; `level` is only read.   COST: that of looking at those faces.
tables::TileRing FindCutOut(Far::TopologyLevel const& level, int face, int numRings);

/// The same of several faces, numbered in the level's order; its tile face is the first.
tables::TileRing FindCutOut(Far::TopologyLevel const& level, std::vector<int> const& faces, int numRings);

}  // namespace surface
}  // namespace v1
}  // namespace osd_shading
