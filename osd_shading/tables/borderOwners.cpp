// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/tables/borderOwners.h"

#include <algorithm>
#include <utility>

namespace osd_shading {
inline namespace v1 {
namespace tables {

namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// Where the control edges are sharp at the last level: whole edges by uniform creasing, some of the children of
/// one by Chaikin's.
class LastSharpness {
public:
    LastSharpness(RefinedTopology const& topology, int lastLevel) : _topology(topology), _lastLevel(lastLevel) {
        _isUniform = topology.Refiner().GetSchemeOptions().GetCreasingMethod() == Sdc::Options::CREASE_UNIFORM;
    }

    /// By child of the edge at the last level, from the end `first` on; one entry for all that are alike.
    std::vector<bool> Of(int edge, int first) const {
        Far::TopologyLevel const& base = _topology.Level(0);
        float const sharpness = base.GetEdgeSharpness(edge);
        if (!(sharpness > 0)) return {false};
        if (StaysSharp(sharpness, _lastLevel, _isUniform)) return {true};
        if (_isUniform) return {false};
        std::vector<int> edges{edge}, children;
        int start = first;
        for (int level = 0; level < _lastLevel; ++level) {
            // The order of the two children follows the ends of the parent.
            Far::TopologyLevel const& here = _topology.Level(level);
            children.clear();
            for (int const parent : edges) {
                Far::ConstIndexArray const pair = here.GetEdgeChildEdges(parent);
                bool const isForward = here.GetEdgeVertices(parent)[0] == start;
                children.push_back(pair[isForward ? 0 : 1]);
                children.push_back(pair[isForward ? 1 : 0]);
                start = here.GetEdgeVertices(parent)[isForward ? 1 : 0];
            }
            edges.swap(children);
            start = here.GetVertexChildVertex(first);
            first = start;
        }
        std::vector<bool> isSharp;
        isSharp.reserve(edges.size());
        for (int const child : edges) isSharp.push_back(IsSharpEdge(_topology.Level(_lastLevel), child));
        return isSharp;
    }
    bool AtEnd(int edge, int end) const { return Of(edge, end).front(); }

private:
    RefinedTopology const& _topology;
    int _lastLevel;
    bool _isUniform;
};

}  // namespace

bool NeedsAllLevels(Far::TopologyRefiner const& refiner) {
    if (refiner.GetSchemeOptions().GetCreasingMethod() == Sdc::Options::CREASE_UNIFORM) return false;
    Far::TopologyLevel const base = refiner.GetLevel(0);
    for (int e = 0; e < base.GetNumEdges(); ++e) {
        float const sharpness = base.GetEdgeSharpness(e);
        if (sharpness > 0 && sharpness < Sdc::Crease::SHARPNESS_INFINITE) return true;
    }
    return false;
}

BorderOwners::BorderOwners(RefinedTopology const& topology, RefinedTopology const& all, TableData& data)
    : _topology(topology), _all(all), _data(data) {
    LastSharpness const last(_all, data.options.level);
    std::vector<bool>& ownsMiddle = _ownsMiddle;
    Far::TopologyLevel const& base = topology.Level(0);
    std::vector<int> const& offsets = data.mesh.faceOffsets;
    data.cornerOwners.resize(data.mesh.faceVertices.size());
    data.edgeTwins.resize(data.mesh.faceVertices.size());
    ownsMiddle.assign(data.mesh.faceVertices.size(), false);

    // One owner for each region, at the last level, of each vertex.
    std::vector<int> group;
    for (int v = 0; v < base.GetNumVertices(); ++v) {
        Far::ConstIndexArray const faces = base.GetVertexFaces(v);
        Far::ConstLocalIndexArray const corners = base.GetVertexFaceLocalIndices(v);
        int const numFaces = faces.size();
        auto const cornerAt = [&](int i) { return offsets[index(faces[i])] + corners[i]; };
        group.assign(index(numFaces), -1);
        bool isWhole = !base.IsVertexNonManifold(v);
        for (int const edge : base.GetVertexEdges(v)) isWhole &= !IsSharpEdge(base, edge);
        if (isWhole) {
            std::fill(group.begin(), group.end(), 0);
        } else {
            // Spread from each face over edges that are not sharp.
            std::vector<int> open;
            for (int first = 0; first < numFaces; ++first) {
                if (group[index(first)] >= 0) continue;
                group[index(first)] = first;
                open.assign(1, first);
                while (!open.empty()) {
                    int const i = open.back();
                    open.pop_back();
                    Far::ConstIndexArray const edges = base.GetFaceEdges(faces[i]);
                    int const size = edges.size();
                    for (int const edge : {edges[corners[i]], edges[(corners[i] + size - 1) % size]}) {
                        if (last.AtEnd(edge, v)) continue;
                        for (int j = 0; j < numFaces; ++j) {
                            if (group[index(j)] >= 0 || base.GetFaceEdges(faces[j]).FindIndex(edge) < 0) continue;
                            group[index(j)] = first;
                            open.push_back(j);
                        }
                    }
                }
            }
        }
        for (int i = 0; i < numFaces; ++i) data.cornerOwners[index(cornerAt(i))] = cornerAt(group[index(i)]);
    }

    // Of an edge between two faces each writes the half at whose end the edge leaves a vertex in its own order:
    // equal neighbourhoods then write equal points. The middle is the extraordinary end's, or the first face's.
    int const regular = topology.IsCatmark() ? 4 : 6;
    auto const isPlain = [&](int v) {
        return base.GetVertexRule(v) == Sdc::Crease::RULE_SMOOTH && !base.IsVertexBoundary(v) &&
               base.GetVertexFaces(v).size() == regular;
    };
    for (int e = 0; e < base.GetNumEdges(); ++e) {
        Far::ConstIndexArray const faces = base.GetEdgeFaces(e);
        auto const cornerOf = [&](int face) { return offsets[index(face)] + base.GetFaceEdges(face).FindIndex(e); };
        bool const isShared = faces.size() == 2;
        for (int i = 0; i < faces.size(); ++i) {
            data.edgeTwins[index(cornerOf(faces[i]))] = cornerOf(faces[isShared ? 1 - i : i]);
        }
        if (!isShared) continue;
        // Each side of what is sharp all along writes for itself.
        int const first = cornerOf(faces[0]), second = cornerOf(faces[1]);
        int const start = data.mesh.faceVertices[index(first)];
        std::vector<bool> const isSharp = last.Of(e, start);
        if (std::find(isSharp.begin(), isSharp.end(), false) == isSharp.end()) {
            data.edgeTwins[index(first)] = first;
            data.edgeTwins[index(second)] = second;
            continue;
        }
        bool const isSecond = isPlain(start) && !isPlain(data.mesh.faceVertices[index(second)]);
        (isSecond ? ownsMiddle[index(second)] : ownsMiddle[index(first)]) = true;
    }
}

TileOwnership BorderOwners::Of(int face) const {
    LastSharpness const last(_all, _data.options.level);
    Far::TopologyLevel const& base = _topology.Level(0);
    int const size = _data.mesh.FaceSize(face), offset = _data.mesh.faceOffsets[index(face)];
    int const k = _data.options.level;
    TileOwnership own(index(size));
    for (int i = 0; i < size; ++i) {
        int const corner = offset + i;
        own.corners[index(i)] = _data.cornerOwners[index(corner)] == corner;
        EdgeOwnership& edge = own.edges[index(i)];
        if (_data.edgeTwins[index(corner)] == corner) {
            edge = EdgeOwnership::All();
            continue;
        }
        edge = _ownsMiddle[index(corner)] ? EdgeOwnership::HalfAndMiddle() : EdgeOwnership::Half();
        // Where children of an edge differ, points between two sharp ones have a value on this side too.
        std::vector<bool> const isSharp = last.Of(base.GetFaceEdges(face)[i], base.GetFaceVertices(face)[i]);
        if (isSharp.size() == 1) continue;
        std::vector<bool> points;
        for (std::size_t j = 1; j < isSharp.size(); ++j) {
            points.push_back((isSharp[j - 1] && isSharp[j]) || edge.Has(static_cast<int>(j) - 1, k));
        }
        edge = EdgeOwnership::Of(std::move(points));
    }
    return own;
}

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
