// SPDX-License-Identifier: Apache-2.0

// Which points a tile writes, and in which order.

#include <algorithm>

#include "osd_shading/tables/tableData.h"

namespace osd_shading {
inline namespace v1 {
namespace tables {

namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// Turns a point of a class's grid into one of the face whose corner `rotation` the class begins with.
GridPoint turnBack(GridPoint point, int rotation, int side, bool isTriangle) {
    if (isTriangle) {
        int const own[3] = {side - point.row - point.column, point.column, point.row};
        int face[3];
        for (int i = 0; i < 3; ++i) face[(i + rotation) % 3] = own[i];
        return {point.child, face[2], face[1]};
    }
    for (int i = 0; i < rotation; ++i) {
        int const row = point.row;
        point.row = point.column;
        point.column = side - row;
    }
    return point;
}

void appendPoints(TileDictionary const& dictionary, int tileClass, std::vector<GridPoint>& points) {
    TileClass const& c = dictionary.classes[index(tileClass)];
    if (c.kind == TileKind::Spline) {
        int const windows = NumWindows(c.k), side = 1 << std::min<int>(c.k, 4);
        for (std::size_t window = 0; window < c.plans.size(); ++window) {
            RowPlan const& plan = dictionary.plans[index(c.plans[window])];
            int const row = static_cast<int>(window) / windows * side,
                      column = static_cast<int>(window) % windows * side;
            for (int s = 0; s < plan.numSegments; ++s) {
                RowSegment const& segment = plan.segments[s];
                for (int i = 0; i < segment.count; ++i)
                    points.push_back({0, row + segment.row, column + segment.first + i});
            }
        }
    } else if (c.kind == TileKind::Dense) {
        for (auto const at : c.gridPoints) points.push_back({0, at / 32, at % 32});
    } else {
        bool const isTriangle = c.size == 3 && !c.isNgon;
        int const half = 1 << (c.k - 1);
        for (std::size_t i = 0; i < c.children.size(); ++i) {
            std::size_t const first = points.size();
            appendPoints(dictionary, c.children[i].tileClass, points);
            for (std::size_t p = first; p < points.size(); ++p) {
                GridPoint point = turnBack(points[p], c.children[i].rotation, half, isTriangle);
                if (c.isNgon) {
                    point.child = static_cast<int>(i);
                } else if (isTriangle) {
                    int const sign = i == 3 ? -1 : 1;
                    point.row = sign * point.row + (i >= 2 ? half : 0);
                    point.column = sign * point.column + (i % 2 == 1 ? half : 0);
                } else {
                    point.row += i >= 2 ? half : 0;
                    point.column += i == 1 || i == 2 ? half : 0;
                }
                points[p] = point;
            }
        }
    }
}

}  // namespace

void AppendLeafSizes(TileDictionary const& dictionary, int tileClass, std::vector<int>& sizes) {
    TileClass const& c = dictionary.classes[index(tileClass)];
    switch (c.kind) {
        case TileKind::Spline:
            for (int const plan : c.plans) sizes.push_back(dictionary.plans[index(plan)].numPoints);
            break;
        case TileKind::Dense:
            sizes.push_back(c.numPoints);
            break;
        case TileKind::Split:
            for (ChildTile const& child : c.children) AppendLeafSizes(dictionary, child.tileClass, sizes);
            break;
    }
}

std::vector<GridPoint> FindTilePoints(TileDictionary const& dictionary, Tile const& tile) {
    std::vector<GridPoint> points;
    TileClass const& c = dictionary.classes[index(tile.tileClass)];
    points.reserve(index(c.numPoints));
    appendPoints(dictionary, tile.tileClass, points);
    for (GridPoint& point : points) {
        if (c.isNgon) {
            point.child = (point.child + tile.rotation) % c.size;
        } else {
            point = turnBack(point, tile.rotation, 1 << c.k, c.size == 3);
        }
    }
    return points;
}

std::vector<FaceCorner> FindValueCorners(TableData const& data, RefinedTopology const& topology) {
    std::vector<FaceCorner> corners;
    corners.reserve(index(data.numValues));
    int const lastLevel = data.options.level;
    for (std::size_t f = 0; f < data.tiles.size(); ++f) {
        bool const isNgon = data.dictionary.classes[index(data.tiles[f].tileClass)].isNgon;
        int const side = 1 << (isNgon ? lastLevel - 1 : lastLevel);
        int filled = -1;
        std::vector<FaceCorner> grid;
        for (GridPoint const& point : FindTilePoints(data.dictionary, data.tiles[f])) {
            if (point.child != filled) {
                filled = point.child;
                int const face = static_cast<int>(f);
                grid = isNgon
                           ? FindFaceGrid(topology, 1, topology.Level(0).GetFaceChildFaces(face)[filled], lastLevel)
                           : FindFaceGrid(topology, 0, face, lastLevel);
            }
            corners.push_back(grid[index(point.row * (side + 1) + point.column)]);
        }
    }
    return corners;
}

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
