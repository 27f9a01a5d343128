// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <map>
#include <vector>

namespace osd_shading {
inline namespace v1 {
namespace tables {

/// One direction of the control grid of a regular face: points from -1 to `numCells` + 1, but none beyond a sharp
/// end.
struct GridAxis {
    int numCells;
    bool isSharpAtStart, isSharpAtEnd;

    int First() const { return isSharpAtStart ? 0 : -1; }
    int Last() const { return isSharpAtEnd ? numCells : numCells + 1; }
    int Size() const { return Last() - First() + 1; }
    bool IsOnSharpEnd(int i) const { return (isSharpAtStart && i == 0) || (isSharpAtEnd && i == numCells); }
    GridAxis Refined() const { return {2 * numCells, isSharpAtStart, isSharpAtEnd}; }
};

/// Sums over the points of an axis: row i has up to 4 terms, from source firsts[i] on.
struct AxisRows {
    struct Row {
        int first, size;
        double weights[4];
    };
    std::vector<Row> rows;

    std::size_t Size() const { return rows.size(); }
};

/// Makes them once for each kind of axis. All weights are positive.
class AxisRules {
public:
    /// The points of the refined axis.
    AxisRows const& Refinement(GridAxis const& axis);
    /// The limits at the parameters of the last level, of which a cell has 2^`k`.
    AxisRows const& Limits(GridAxis const& axis, int k);

private:
    std::map<std::vector<int>, AxisRows> _known;
};

/// Values on a grid, row by row, times the rows of both directions.
std::vector<double> ApplyAxes(std::vector<double> const& grid, int numColumns, AxisRows const& u,
                              AxisRows const& v);

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
