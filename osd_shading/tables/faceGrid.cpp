// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/tables/faceGrid.h"

#include <algorithm>
#include <cassert>

namespace osd_shading {
inline namespace v1 {
namespace tables {

namespace {

/// Fills the grid of a face that lies at `row`, `column` and whose columns and rows run in direction `sign`.
struct GridFiller {
    RefinedTopology const& topology;
    int lastLevel;
    std::size_t pitch;
    std::vector<FaceCorner>& grid;

    void fill(int level, int face, int row, int column, int sign) {
        int const side = 1 << (lastLevel - level);
        auto const set = [&](int r, int c, int corner) {
            FaceCorner& at = grid[static_cast<std::size_t>(row + sign * r) * pitch +
                                  static_cast<std::size_t>(column + sign * c)];
            if (!at.IsFound()) at = {face, corner};
        };
        if (level == lastLevel) {
            set(0, 0, 0);
            set(0, 1, 1);
            if (topology.IsCatmark()) {
                set(1, 1, 2);
                set(1, 0, 3);
            } else {
                set(1, 0, 2);
            }
            return;
        }
        Far::ConstIndexArray const children = topology.Level(level).GetFaceChildFaces(face);
        int const half = sign * side / 2;
        if (topology.IsCatmark()) {
            fill(level + 1, children[0], row, column, sign);
            fill(level + 1, children[1], row, column + half, sign);
            fill(level + 1, children[2], row + half, column + half, sign);
            fill(level + 1, children[3], row + half, column, sign);
        } else {
            fill(level + 1, children[0], row, column, sign);
            fill(level + 1, children[1], row, column + half, sign);
            fill(level + 1, children[2], row + half, column, sign);
            fill(level + 1, children[3], row + half, column + half, -sign);  // lies the other way round
        }
    }
};

/// The corner at the other side of the edge that leaves `at` in its face's order: there the edge leaves its far
/// end.
FaceCorner acrossEdge(Far::TopologyLevel const& level, FaceCorner const& at) {
    int const edge = level.GetFaceEdges(at.face)[at.corner];
    Far::ConstIndexArray const faces = level.GetEdgeFaces(edge);
    assert(faces.size() == 2);
    int const other = faces[0] == at.face ? faces[1] : faces[0];
    return {other, level.GetFaceEdges(other).FindIndex(edge)};
}

FaceCorner turned(FaceCorner const& at, int steps) { return {at.face, (at.corner + steps) % 4}; }

}  // namespace

std::vector<FaceCorner> FindFaceGrid(RefinedTopology const& topology, int level, int face, int lastLevel) {
    std::size_t const pitch = (std::size_t{1} << (lastLevel - level)) + 1;
    std::vector<FaceCorner> grid(pitch * pitch);
    GridFiller{topology, lastLevel, pitch, grid}.fill(level, face, 0, 0, 1);
    return grid;
}

FacePath FindFacePath(RefinedTopology const& topology, int level, int face, int higherLevel) {
    FacePath path;
    for (; level > higherLevel; --level) {
        int const parent = topology.Level(level).GetFaceParentFace(face);
        path.children.push_back(topology.Level(level - 1).GetFaceChildFaces(parent).FindIndex(face));
        face = parent;
    }
    path.face = face;
    std::reverse(path.children.begin(), path.children.end());
    return path;
}

int FollowFacePath(RefinedTopology const& topology, int level, FacePath const& path) {
    int face = path.face;
    for (int const child : path.children) face = topology.Level(level++).GetFaceChildFaces(face)[child];
    return face;
}

std::vector<FaceCorner> FindControlGrid(RefinedTopology const& topology, int level, int face, int lastLevel,
                                        unsigned sharpSides) {
    Far::TopologyLevel const& last = topology.Level(lastLevel);
    std::vector<FaceCorner> const inside = FindFaceGrid(topology, level, face, lastLevel);
    int const side = 1 << (lastLevel - level), pitch = side + 3;
    std::vector<FaceCorner> grid(static_cast<std::size_t>(pitch * pitch));
    auto const at = [&](int row, int column) -> FaceCorner& {
        return grid[static_cast<std::size_t>((row + 1) * pitch + column + 1)];
    };
    for (int row = 0; row <= side; ++row) {
        for (int column = 0; column <= side; ++column) {
            at(row, column) = inside[static_cast<std::size_t>(row * (side + 1) + column)];
        }
    }

    // Corner `corner` (in the order of the whole face) of the small face at (row, column).
    std::vector<int> faces(static_cast<std::size_t>(side * side));
    for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column) {
            // Its corner 0 is a corner of up to four faces: the grid may name another. Go by the path.
            FacePath path;
            path.face = face;
            for (int half = side / 2, r = row, c = column; half > 0; half /= 2) {
                bool const isHighRow = r >= half, isHigh = c >= half;
                path.children.push_back(isHighRow ? (isHigh ? 2 : 3) : (isHigh ? 1 : 0));
                r -= isHighRow ? half : 0;
                c -= isHigh ? half : 0;
            }
            faces[static_cast<std::size_t>(row * side + column)] = FollowFacePath(topology, level, path);
        }
    }
    auto const smallFace = [&](int row, int column) {
        return faces[static_cast<std::size_t>(row * side + column)];
    };

    // Along each side that is not sharp, look across; edge i of the whole face is edge i of the small ones.
    for (int edge = 0; edge < 4; ++edge) {
        if (sharpSides & (1u << edge)) continue;
        for (int i = 0; i < side; ++i) {
            // The i-th small face along the edge, and the place beyond its edge's start.
            int const small = edge == 0   ? smallFace(0, i)
                              : edge == 1 ? smallFace(i, side - 1)
                              : edge == 2 ? smallFace(side - 1, side - 1 - i)
                                          : smallFace(side - 1 - i, 0);
            FaceCorner const beyond = acrossEdge(last, {small, edge});  // at the edge's end, turning outwards next
            // Around the face beyond: edge's end, edge's start, beyond the start, beyond the end.
            FaceCorner const beyondStart = turned(beyond, 2), beyondEnd = turned(beyond, 3);
            auto const outside = [&](int along) -> FaceCorner& {
                return edge == 0   ? at(-1, along)
                       : edge == 1 ? at(along, side + 1)
                       : edge == 2 ? at(side + 1, side - along)
                                   : at(side - along, -1);
            };
            outside(i) = beyondStart;
            outside(i + 1) = beyondEnd;
            // At the corner between two smooth sides: the face opposite.
            bool const isBeforeSharp = (sharpSides & (1u << ((edge + 3) % 4))) != 0;
            if (i == 0 && !isBeforeSharp) {
                // The edge from the corner to beyondStart, seen from the face beyond, leaves the edge's start.
                outside(-1) = turned(acrossEdge(last, turned(beyond, 1)), 3);
            }
        }
    }
    // Along a sharp side its neighbours' rows end: the outer points in line with it were found from those sides.
    return grid;
}

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
