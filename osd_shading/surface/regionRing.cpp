// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/surface/regionRing.h"

#include <algorithm>
#include <array>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "osd_shading/surface/patchBasis.h"
#include "osd_shading/tables/faceGrid.h"
#include "osd_shading/tables/sharpSides.h"

namespace osd_shading {
inline namespace v1 {
namespace surface {

namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// The region at corner `corner` of a face.
RegionFan fanAt(RegionLevels& levels, int level, int face, int corner, std::vector<RegionFan>& fans) {
    CreaseRegions const& regions = levels.Regions(level);
    int const vertex = levels.Level(level).GetFaceVertices(face)[corner];
    FindRegionFans(levels.Level(level), regions, vertex, fans);
    return fans[index(regions.CornerValue(face, corner) - regions.FirstValue(vertex))];
}

RegularPatch quadPatch(RegionLevels& levels, int level, int face) {
    RegularPatch patch;
    std::optional<unsigned> const sides = tables::FindSharpSides(levels, level, face, 0);
    if (!sides) return patch;
    patch.points.resize(kQuadPoints);
    std::vector<FaceCorner> const grid = tables::FindControlGrid(levels.Topology(), level, face, level, *sides);
    for (std::size_t i = 0; i < grid.size(); ++i) patch.points[i].at = grid[i];
    auto const isKnown = [&](int i) {
        return patch.points[index(i)].at.IsFound() || !patch.points[index(i)].terms.empty();
    };
    auto const mirror = [&](int target, int at, int inside) {
        if (isKnown(target) || !isKnown(at) || !isKnown(inside)) return;
        patch.points[index(target)].terms = {{at, 2}, {inside, -1}};
        patch.order.push_back(target);
    };
    for (int i = 0; i < 4; ++i) {
        if (*sides & 1u) mirror(i, 4 + i, 8 + i);
        if (*sides & 4u) mirror(12 + i, 8 + i, 4 + i);
    }
    for (int i = 0; i < 4; ++i) {
        if (*sides & 8u) mirror(4 * i, 4 * i + 1, 4 * i + 2);
        if (*sides & 2u) mirror(4 * i + 3, 4 * i + 2, 4 * i + 1);
    }
    return patch;
}

/// The six lattice points round a triangle's corner, counter-clockwise, from the next corner on.
constexpr LatticePoint kAround[6] = {{1, 0}, {0, 1}, {-1, 1}, {-1, 0}, {0, -1}, {1, -1}};
/// The direction of the edge from corner i to the next corner, in kAround.
constexpr int kFirstDirection[3] = {0, 2, 4};

int latticeIndex(LatticePoint const& p) {
    for (int i = 0; i < kTrianglePoints; ++i) {
        if (kTriangleLattice[i].column == p.column && kTriangleLattice[i].row == p.row) return i;
    }
    return -1;
}

RegularPatch trianglePatch(RegionLevels& levels, int level, int face) {
    Far::TopologyLevel const& here = levels.Level(level);
    CreaseRegions const& regions = levels.Regions(level);
    RegularPatch patch;
    patch.points.resize(kTrianglePoints);
    std::vector<RegionFan> fans;
    struct Phantom {
        int point, at, along, inside;
    };
    std::vector<Phantom> phantoms;
    for (int corner = 0; corner < 3; ++corner) {
        int const vertex = here.GetFaceVertices(face)[corner];
        VertexKind const kind = regions.Kind(vertex);
        RegionFan const fan = fanAt(levels, level, face, corner, fans);
        int const numFaces = static_cast<int>(fan.faces.size());
        bool const isRegular =
            fan.isOrdered && (kind == VertexKind::Smooth ? fan.isClosed && numFaces == 6
                                                         : kind == VertexKind::Crease && numFaces == 3);
        if (!isRegular) return {};
        int const own = static_cast<int>(std::find(fan.faces.begin(), fan.faces.end(), face) - fan.faces.begin());
        auto const around = [&](int direction) {
            LatticePoint const center = kTriangleLattice[corner], step = kAround[(direction % 6 + 6) % 6];
            return latticeIndex({center.column + step.column, center.row + step.row});
        };
        // Edge j of the fan: the one that leads its face j, and the last one's other edge.
        int const numEdges = numFaces == 6 ? 6 : 4, first = kFirstDirection[corner] - own;
        patch.points[index(corner)].at = {face, corner};
        for (int j = 0; j < numEdges; ++j) {
            int const last = numFaces - 1;
            FaceCorner const at = j <= last
                                      ? FaceCorner{fan.faces[index(j)], (fan.corners[index(j)] + 1) % 3}
                                      : FaceCorner{fan.faces[index(last)], (fan.corners[index(last)] + 2) % 3};
            PatchPoint& point = patch.points[index(around(first + j))];
            if (!point.at.IsFound()) point.at = at;
        }
        if (numFaces == 3) {
            phantoms.push_back({around(first + 4), corner, around(first + 3), around(first + 2)});
            phantoms.push_back({around(first + 5), corner, around(first), around(first + 1)});
        }
    }
    for (Phantom const& phantom : phantoms) {
        PatchPoint& point = patch.points[index(phantom.point)];
        if (point.at.IsFound() || !point.terms.empty()) continue;
        point.terms = {{phantom.at, 1}, {phantom.along, 1}, {phantom.inside, -1}};
        patch.order.push_back(phantom.point);
    }
    return patch;
}

}  // namespace

OneBorder FindOneBorder(Far::TopologyLevel const& level) {
    auto const staysSharp = [&](int edge) {
        return level.GetEdgeSharpness(edge) >= Sdc::Crease::SHARPNESS_INFINITE;
    };
    for (int v = 0; v < level.GetNumVertices(); ++v) {
        bool const isCorner = level.GetVertexSharpness(v) >= Sdc::Crease::SHARPNESS_INFINITE;
        if (isCorner || !level.IsVertexNonManifold(v)) continue;
        Far::ConstIndexArray const faces = level.GetVertexFaces(v), edges = level.GetVertexEdges(v);
        if (std::count_if(edges.begin(), edges.end(), staysSharp) != 2) continue;
        Far::ConstLocalIndexArray const corners = level.GetVertexFaceLocalIndices(v);
        auto const sideOf = [&](int i, int side) {
            Far::ConstIndexArray const faceEdges = level.GetFaceEdges(faces[i]);
            return faceEdges[(corners[i] + (side == 0 ? 0 : faceEdges.size() - 1)) % faceEdges.size()];
        };
        // From each side of a face on an edge that stays, across the others to the next that does.
        for (int i = 0; i < faces.size(); ++i) {
            for (int side = 0; side < 2; ++side) {
                int const begin = sideOf(i, side);
                if (!staysSharp(begin)) continue;
                int at = i, edge = sideOf(i, 1 - side);
                for (int step = 0; step < faces.size() && !staysSharp(edge); ++step) {
                    int next = -1;
                    for (int j = 0; j < faces.size() && next < 0; ++j) {
                        if (j != at && (sideOf(j, 0) == edge || sideOf(j, 1) == edge)) next = j;
                    }
                    if (next < 0) break;
                    edge = sideOf(next, 0) == edge ? sideOf(next, 1) : sideOf(next, 0);
                    at = next;
                }
                if (edge == begin && at != i) return {v, edge};
            }
        }
    }
    return {};
}

SubdivisionRules RulesOfRings(Sdc::SchemeType scheme) {
    SubdivisionRules rules;
    rules.scheme = scheme;
    rules.boundary = Sdc::Options::VTX_BOUNDARY_EDGE_ONLY;
    return rules;
}

TileRing FindRegionRing(RegionLevels& levels, int levelIndex, int face) {
    Far::TopologyLevel const& level = levels.Level(levelIndex);
    CreaseRegions const& regions = levels.Regions(levelIndex);
    Far::ConstIndexArray const corners = level.GetFaceVertices(face);
    // Its vertices are values, so that sharp edges, non-manifold and double ones too, become boundaries; but where
    // one sharp edge ends both its sides are needed: its other end is one vertex, and so are those that follow.
    std::vector<int> whole;
    auto const sharpNeighbors = [&](int v) {
        std::vector<int> neighbors;
        for (int const edge : level.GetVertexEdges(v)) {
            Far::ConstIndexArray const ends = level.GetEdgeVertices(edge);
            if (IsSharpEdge(level, edge)) neighbors.push_back(ends[0] == v ? ends[1] : ends[0]);
        }
        return neighbors;
    };
    for (int const v : corners) {
        std::vector<int> const neighbors = sharpNeighbors(v);
        if (neighbors.size() != 1) continue;
        whole.push_back(neighbors[0]);
        for (int const next : sharpNeighbors(neighbors[0])) whole.push_back(next);
    }
    TileRing ring;
    std::unordered_map<int, int> numberOfValue;
    std::unordered_set<int> isInRing;
    auto const add = [&](int f, int firstCorner) {
        if (!isInRing.insert(f).second) return;
        Far::ConstIndexArray const vertices = level.GetFaceVertices(f);
        int const size = vertices.size();
        ring.faces.push_back(f);
        ring.firstCorners.push_back(firstCorner);
        ring.faceSizes.push_back(size);
        for (int i = 0; i < size; ++i) {
            int const corner = (firstCorner + i) % size;
            bool const isWhole = std::find(whole.begin(), whole.end(), vertices[corner]) != whole.end();
            int const value = isWhole ? regions.FirstValue(vertices[corner]) : regions.CornerValue(f, corner);
            auto const [known, isNew] = numberOfValue.emplace(value, ring.numVertices);
            if (isNew) {
                ++ring.numVertices;
                ring.vertices.push_back(vertices[corner]);
            }
            ring.faceVertices.push_back(known->second);
        }
    };
    add(face, 0);
    std::vector<RegionFan> fans;
    for (int i = 0; i < corners.size(); ++i) {
        RegionFan const fan = fanAt(levels, levelIndex, face, i, fans);
        std::size_t const count = fan.faces.size();
        auto const own =
            static_cast<std::size_t>(std::find(fan.faces.begin(), fan.faces.end(), face) - fan.faces.begin());
        for (std::size_t k = 1; k < count; ++k) {
            std::size_t const next = (own + k) % count;
            add(fan.faces[next], fan.corners[next]);
        }
    }
    // There the faces across it are in the ring: then all of their region at its other end, which would be a corner
    // otherwise.
    for (std::size_t before = 0; !whole.empty() && before != ring.faces.size();) {
        before = ring.faces.size();
        for (int const v : corners) {
            if (std::find(whole.begin(), whole.end(), v) == whole.end()) continue;
            FindRegionFans(level, regions, v, fans);
            for (RegionFan const& fan : fans) {
                bool const isThere =
                    std::any_of(fan.faces.begin(), fan.faces.end(), [&](int f) { return isInRing.count(f) > 0; });
                for (std::size_t k = 0; k < fan.faces.size() && isThere; ++k) add(fan.faces[k], fan.corners[k]);
            }
        }
    }

    tables::AppendInnerCreases(
        level, [](int) { return Sdc::Crease::SHARPNESS_INFINITE; }, ring);
    std::vector<int> sharpCorners;
    for (int i = 0; i < corners.size(); ++i) {
        // The face itself is the first in the ring.
        if (regions.Kind(corners[i]) == VertexKind::Corner) sharpCorners.push_back(ring.faceVertices[index(i)]);
    }
    std::sort(sharpCorners.begin(), sharpCorners.end());
    ring.cornerVertices = sharpCorners;
    ring.cornerSharpness.assign(sharpCorners.size(), Sdc::Crease::SHARPNESS_INFINITE);
    return ring;
}

bool StaysAsItIs(RegionLevels& levels, int levelIndex, int face, int numLevels) {
    Far::TopologyLevel const& level = levels.Level(levelIndex);
    bool const isUniform =
        levels.Topology().Refiner().GetSchemeOptions().GetCreasingMethod() == Sdc::Options::CREASE_UNIFORM;
    auto const stays = [&](float sharpness) {
        return !(sharpness > 0) || tables::StaysSharp(sharpness, numLevels, isUniform);
    };
    for (int const v : level.GetFaceVertices(face)) {
        if (!stays(level.GetVertexSharpness(v))) return false;
        for (int const edge : level.GetVertexEdges(v)) {
            if (!stays(level.GetEdgeSharpness(edge))) return false;
        }
    }
    return true;
}

RegularPatch FindRegularPatch(RegionLevels& levels, int level, int face) {
    return levels.Topology().IsCatmark() ? quadPatch(levels, level, face) : trianglePatch(levels, level, face);
}

}  // namespace surface
}  // namespace v1
}  // namespace osd_shading
