// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include "osd_shading/tables/tileRing.h"

namespace osd_shading {
inline namespace v1 {
namespace surface {

/// A control face with the faces up to `numRings` rings round it, as a mesh of its own, numbered by a walk from the
/// face outwards, so that equal neighbourhoods give equal meshes (in the level's order where that matters). Faces
/// keep their first corners. REQUIRES: nothing; `base` is only read.   COST: that of looking at those faces.
tables::TileRing FindCutOut(Far::TopologyLevel const& base, int face, int numRings);

}  // namespace surface
}  // namespace v1
}  // namespace osd_shading
