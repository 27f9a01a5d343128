// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include "osd_shading/tables/tileRing.h"

namespace osd_shading {
inline namespace v1 {
namespace tables {

/// Where a source of a tile's normals is found: a corner of a face of the start level (or of the tile's own, where
/// that is later), by the face of the tile's ring that it came from.
struct NormalLocator {
    FacePath path;  ///< `face` counts the ring's faces; corners and children count from the ring's first corners
    int corner = 0;
};

/// The locator of a corner of a face of `atLevel` that came from one of the faces of `ring`, the ring of a face of
/// `level`.
NormalLocator LocateNormal(RefinedTopology const& topology, int level, TileRing const& ring, int atLevel,
                           FaceCorner const& at);

/// The locator of a value of `level`, one of `vertex`, that a corner of a face of `ring` has.
NormalLocator LocateValue(RegionLevels& levels, int level, TileRing const& ring, int value, int vertex);

/// The corner that `locator` names round the ring `ring` of a face of `level`.
FaceCorner FindNormal(RefinedTopology const& topology, int level, TileRing const& ring,
                      NormalLocator const& locator);

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
