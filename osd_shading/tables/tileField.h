// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <cstdint>
#include <vector>

#include "osd_shading/tables/neededRows.h"

namespace osd_shading {
inline namespace v1 {
namespace tables {

/// The step of b in a tile's neighbourhood from the values of one level to those of the next: kept in double, and
/// by level, as b is seeded at every level.
struct FieldStage {
    std::vector<std::size_t> offsets{0};
    std::vector<int> terms;  ///< values of the level before; < 0: complement of an earlier one of this level
    std::vector<double> weights;

    /// Per value: those of the level before whose vertices have this value's vertex in their ring, and itself.
    std::vector<std::size_t> seedOffsets{0};
    std::vector<int> seeds;
    /// Whether the middle of a face that is no quad has its vertex in its ring, and whether it has its region.
    std::vector<unsigned char> isVertexNearNgon, isNearNgon;
    std::vector<VertexKind> kinds;          ///< of its vertex
    static constexpr int kNew = -1, kNgonCenter = -2;
    std::vector<int> origins;  ///< the value of the level before whose vertex became this one's; or one of those

    std::size_t Size() const { return kinds.size(); }
};

/// How b is refined in all tiles of a class.
struct TileField {
    std::vector<FieldStage> stages;  ///< Split: one at most; Dense: down to the last level
    FlatRows limits;                 ///< Dense: per point, from the last level
    unsigned sharpSides = 0;         ///< Spline: bit i: no value is found beyond edge i

    /// Split: each child's sources, among the values of the stage, or the tile's own where it has none.
    std::vector<std::vector<int>> children;
};

/// The stage from the needed values of `level - 1` to those of `level`.
FieldStage MakeFieldStage(RegionLevels& levels, NeededRows const& values, int level);

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
