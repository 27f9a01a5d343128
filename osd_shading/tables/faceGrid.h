// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <vector>

#include "osd_shading/creaseRegions.h"

namespace osd_shading {
inline namespace v1 {
namespace tables {

/// A corner of a face of some level: names a vertex and, with the level's regions, one value.
struct FaceCorner {
    int face = -1, corner = 0;

    bool IsFound() const { return face >= 0; }
};

inline int VertexAt(Far::TopologyLevel const& level, FaceCorner const& at) {
    return level.GetFaceVertices(at.face)[at.corner];
}

/// The points that refining face `face` of `level` down to `lastLevel` makes of it, each as a corner of a face that
/// came from it: point (row, column) at [row * (2^k + 1) + column], k = lastLevel - level.
///
/// The face's edge 0 runs along the columns, its last edge along the rows (downwards to row 0). In Loop only
/// row + column <= 2^k is found. A face other than a quad in Catmull-Clark has no such grid, but its children have.
std::vector<FaceCorner> FindFaceGrid(RefinedTopology const& topology, int level, int face, int lastLevel);

/// How a face of a level is found from one some levels higher.
struct FacePath {
    int face = -1;              ///< of the higher level
    std::vector<int> children;  ///< by index among the children, downwards
};
FacePath FindFacePath(RefinedTopology const& topology, int level, int face, int higherLevel);
/// The face at the end of a path that begins at level `level`.
int FollowFacePath(RefinedTopology const& topology, int level, FacePath const& path);

/// The control grid of a regular Catmull-Clark face: its own grid at `lastLevel` (2^q faces along a side), and a
/// row of vertices round it: (2^q + 3)^2 corners, row by row from (-1, -1) on. Beyond a sharp side, whose bit i is
/// set in `sharpSides` for the face's edge i, none is found.
///
/// REQUIRES: the face is regular but for those sides, where the regions end.
std::vector<FaceCorner> FindControlGrid(RefinedTopology const& topology, int level, int face, int lastLevel,
                                        unsigned sharpSides);

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
