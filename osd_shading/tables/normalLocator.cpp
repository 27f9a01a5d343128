// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/tables/normalLocator.h"

#include <algorithm>
#include <cassert>

namespace osd_shading {
inline namespace v1 {
namespace tables {

namespace {

/// Turns the children and the corner of a path by `steps` corners of its face, which has `size` of them.
void turn(FacePath& path, int& corner, int size, int steps, bool isNgon) {
    auto const turnOne = [&](int& i) {
        if (i < size) i = (i + steps) % size;  // a triangle's child 3 is its middle, but turned
    };
    if (!path.children.empty() && isNgon) {
        turnOne(path.children[0]);  // its children are turned no further
    } else {
        for (int& child : path.children) turnOne(child);
        turnOne(corner);
    }
}

}  // namespace

NormalLocator LocateNormal(RefinedTopology const& topology, int level, TileRing const& ring, int atLevel,
                           FaceCorner const& at) {
    NormalLocator locator{FindFacePath(topology, atLevel, at.face, level), at.corner};
    auto const found = std::find(ring.faces.begin(), ring.faces.end(), locator.path.face);
    assert(found != ring.faces.end());
    auto const f = static_cast<std::size_t>(found - ring.faces.begin());
    int const size = ring.faceSizes[f];
    turn(locator.path, locator.corner, size, size - ring.firstCorners[f], size != (topology.IsCatmark() ? 4 : 3));
    locator.path.face = static_cast<int>(f);
    return locator;
}

NormalLocator LocateValue(RegionLevels& levels, int levelIndex, TileRing const& ring, int value, int vertex) {
    Far::TopologyLevel const& level = levels.Level(levelIndex);
    Far::ConstIndexArray const faces = level.GetVertexFaces(vertex);
    Far::ConstLocalIndexArray const corners = level.GetVertexFaceLocalIndices(vertex);
    for (int i = 0; i < faces.size(); ++i) {
        if (levels.Regions(levelIndex).CornerValue(faces[i], corners[i]) != value) continue;
        if (std::find(ring.faces.begin(), ring.faces.end(), faces[i]) == ring.faces.end()) continue;
        return LocateNormal(levels.Topology(), levelIndex, ring, levelIndex, {faces[i], corners[i]});
    }
    assert(false);
    return {};
}

FaceCorner FindNormal(RefinedTopology const& topology, int level, TileRing const& ring,
                      NormalLocator const& locator) {
    auto const f = static_cast<std::size_t>(locator.path.face);
    int const size = ring.faceSizes[f];
    FacePath path = locator.path;
    int corner = locator.corner;
    path.face = ring.faces[f];
    turn(path, corner, size, ring.firstCorners[f], size != (topology.IsCatmark() ? 4 : 3));
    return {FollowFacePath(topology, level, path), corner};
}

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
