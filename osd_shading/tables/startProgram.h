// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <vector>

#include "osd_shading/tables/tableData.h"
#include "osd_shading/tables/tileRing.h"

namespace osd_shading {
inline namespace v1 {
namespace tables {

/// Start normals that are averages of faces, or the caller's.
class StartBuilder {
public:
    /// All arguments must outlive this object.
    StartBuilder(RegionLevels& levels, int level, StartNormalKind kind, StartProgram& program)
        : _levels(levels),
          _level(level),
          _kind(kind),
          _program(program),
          _normalOfValue(static_cast<std::size_t>(levels.Regions(level).NumValues()), -1) {}

    /// The number of a value's start normal.
    int Use(int value);
    /// What those that are used are made of.
    void Finish();

private:
    void addPoints(std::vector<int> const& faces);

    RegionLevels& _levels;
    int _level;
    StartNormalKind _kind;
    StartProgram& _program;
    std::vector<int> _normalOfValue;
};

/// Start normals that are limit normals: a table of their level gives them. Returns each value's number.
std::vector<int> MakeLimitStart(RefinedTopology const& topology, RegionLevels& levels,
                                ShadingOptions const& options, StartProgram& program);

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
