// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "osd_shading/io/model.h"

namespace perf {

/// A solid made of columns: quads in the plane, each filled from one layer to another. Its surface has quads only,
/// and extraordinary vertices where those of a milled part are: at corners, junctions, bosses and holes.
///
/// REQUIRES: columns meet in whole edges, and no two of them in a corner or along one upright edge alone.
class ExtrudedSolid {
public:
    using Point = std::array<double, 2>;

    struct Column {
        std::array<int, 4> corners;  ///< counter-clockwise
        int bottom, top;             ///< layers; nothing where they are equal
    };

    std::vector<Point> points;
    std::vector<Column> columns;

    int AddPoint(double x, double y);

    /// Adds `numX` by `numY` columns from layer 0 to `top`; corner (i, j) is point `corner(i, j)`.
    void AddGrid(int numX, int numY, int top, std::function<int(int, int)> const& corner);

    /// Puts a ring of columns round those chosen, which shrink to `share` of their size: as a round boss or hole
    /// sits in a rectangular mesh. `isChosen` tells by a column's middle; the ring has the layers of the column
    /// chosen that it touches.
    void InsertRing(std::function<bool(Point const&)> const& isChosen, double share);

    /// Sets the layers of the columns whose middle is chosen.
    void SetLayers(std::function<bool(Point const&)> const& isChosen, int bottom, int top);

    Point Middle(Column const& column) const;

    /// The surface; `place` gives the position of a point of the plane at a layer.
    osd_shading::io::Model Surface(std::function<std::array<double, 3>(Point const&, int)> const& place) const;
};

}  // namespace perf
