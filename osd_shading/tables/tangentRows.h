// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <cmath>
#include <vector>

#include "osd_shading/limitFrames.h"
#include "osd_shading/tables/tileRing.h"

namespace osd_shading {
inline namespace v1 {
namespace tables {

/// Limit tangents at a point of a tile, turned so that they run along its columns (u) and rows (v), and scaled so
/// that on a regular grid they are derivatives.
class TangentRows {
public:
    TangentRows(RegionLevels& levels, LimitStep<double> const& limit, int level,
                std::vector<FaceCorner> const& grid)
        : _levels(levels),
          _limit(limit),
          _level(level),
          _grid(grid),
          _isCatmark(levels.Topology().IsCatmark()),
          _side(static_cast<int>(std::lround(std::sqrt(static_cast<double>(grid.size())))) - 1) {}

    /// The frame of the value at a point, from which `tangent1` and `tangent2` are turned.
    LimitFrame<double> Find(int row, int column);

private:
    std::size_t index(int row, int column) const { return static_cast<std::size_t>(row * (_side + 1) + column); }
    void orient(int row, int column, LimitFrame<double>& frame) const;

    RegionLevels& _levels;
    LimitStep<double> const& _limit;
    int _level;
    std::vector<FaceCorner> const& _grid;
    bool _isCatmark;
    int _side;
    std::vector<LimitFrame<double>> _frames;
};

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
