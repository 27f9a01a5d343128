// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/creaseRegions.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "osd_shading/parallel.h"
#include "osd_shading/vertexTags.h"

namespace osd_shading {
inline namespace v1 {

namespace {

int edgeAfter(Far::TopologyLevel const& level, int face, int corner) { return level.GetFaceEdges(face)[corner]; }

int edgeBefore(Far::TopologyLevel const& level, int face, int corner) {
    Far::ConstIndexArray const edges = level.GetFaceEdges(face);
    return edges[corner == 0 ? edges.size() - 1 : corner - 1];
}

/// Numbers the regions round a manifold vertex, whose rings OpenSubdiv orders: face i lies between edges i and i
/// + 1.
int numberOrderedRegions(Far::TopologyLevel const& level, int vertex, std::vector<int>& regionOfFace) {
    Far::ConstIndexArray const faces = level.GetVertexFaces(vertex);
    Far::ConstIndexArray const edges = level.GetVertexEdges(vertex);
    int region = 0;
    for (int i = 0; i < faces.size(); ++i) {
        if (i > 0 && IsSharpEdge(level, edges[i])) ++region;
        regionOfFace[static_cast<std::size_t>(i)] = region;
    }
    bool const isRing = edges.size() == faces.size();
    if (isRing && region > 0 && !IsSharpEdge(level, edges[0])) {
        // The run across the ring's arbitrary start is one region.
        for (int i = faces.size(); i-- > 0 && regionOfFace[static_cast<std::size_t>(i)] == region;) {
            regionOfFace[static_cast<std::size_t>(i)] = 0;
        }
        --region;
    }
    return region + 1;
}

/// The same for any vertex: joins its faces over shared edges that are not sharp.
int numberJoinedRegions(Far::TopologyLevel const& level, int vertex, std::vector<int>& regionOfFace) {
    Far::ConstIndexArray const faces = level.GetVertexFaces(vertex);
    Far::ConstLocalIndexArray const corners = level.GetVertexFaceLocalIndices(vertex);

    std::vector<std::pair<int, int>> sides;  // edge, local face
    for (int i = 0; i < faces.size(); ++i) {
        for (int const edge : {edgeAfter(level, faces[i], corners[i]), edgeBefore(level, faces[i], corners[i])}) {
            if (!IsSharpEdge(level, edge)) sides.emplace_back(edge, i);
        }
    }
    std::sort(sides.begin(), sides.end());

    std::vector<int> parent(static_cast<std::size_t>(faces.size()));
    std::iota(parent.begin(), parent.end(), 0);
    auto const root = [&](int i) {
        while (parent[static_cast<std::size_t>(i)] != i) {
            int& up = parent[static_cast<std::size_t>(i)];
            up = parent[static_cast<std::size_t>(up)];
            i = up;
        }
        return i;
    };
    for (std::size_t i = 1; i < sides.size(); ++i) {
        if (sides[i].first != sides[i - 1].first) continue;
        int const a = root(sides[i - 1].second), b = root(sides[i].second);
        parent[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
    }
    int numRegions = 0;
    for (int i = 0; i < faces.size(); ++i) {
        int const r = root(i);  // never greater than i
        regionOfFace[static_cast<std::size_t>(i)] =
            r == i ? numRegions++ : regionOfFace[static_cast<std::size_t>(r)];
    }
    return numRegions;
}

int numberRegions(Far::TopologyLevel const& level, int vertex, std::vector<int>& regionOfFace) {
    auto const numFaces = static_cast<std::size_t>(level.GetVertexFaces(vertex).size());
    if (regionOfFace.size() < numFaces) regionOfFace.resize(numFaces);
    return level.IsVertexNonManifold(vertex) ? numberJoinedRegions(level, vertex, regionOfFace)
                                             : numberOrderedRegions(level, vertex, regionOfFace);
}

}  // namespace

CreaseRegions::CreaseRegions(RefinedTopology const& topology, int levelIndex, int numThreads) {
    Far::TopologyLevel const& level = topology.Level(levelIndex);
    int const numVertices = level.GetNumVertices(), numFaces = level.GetNumFaces();
    _kinds.resize(static_cast<std::size_t>(numVertices));
    _firstValues.resize(static_cast<std::size_t>(numVertices) + 1);
    _faceSize = topology.IsCatmark() ? 4 : 3;

    // Count the regions of each vertex; only vertices with two sharp edges and more, or out of order, can have
    // several.
    std::vector<std::vector<int>> splitOfChunk(static_cast<std::size_t>(NumChunks(numVertices)));
    ParallelFor(numVertices, numThreads, [&](int begin, int end, int chunk) {
        std::vector<int> regionOfFace;
        for (int v = begin; v < end; ++v) {
            VertexKind const kind = KindOf(level.GetVertexRule(v));
            _kinds[static_cast<std::size_t>(v)] = kind;
            bool const isOneRegion = kind <= VertexKind::Dart && !level.IsVertexNonManifold(v);
            int const numRegions = level.GetVertexFaces(v).size() == 0 ? 0
                                   : isOneRegion                       ? 1
                                                                       : numberRegions(level, v, regionOfFace);
            _firstValues[static_cast<std::size_t>(v) + 1] = numRegions;
            if (numRegions > 1) splitOfChunk[static_cast<std::size_t>(chunk)].push_back(v);
        }
    });
    for (std::size_t v = 0; v < static_cast<std::size_t>(numVertices); ++v) _firstValues[v + 1] += _firstValues[v];

    // Give every corner the first value of its vertex.
    if (topology.HasIrregularFaces(levelIndex)) {
        _faceOffsets.resize(static_cast<std::size_t>(numFaces));
        int offset = 0;
        for (int f = 0; f < numFaces; ++f) {
            _faceOffsets[static_cast<std::size_t>(f)] = offset;
            offset += level.GetFaceVertices(f).size();
        }
    }
    _cornerValues.resize(static_cast<std::size_t>(level.GetNumFaceVertices()));
    ParallelFor(numFaces, numThreads, [&](int begin, int end, int) {
        for (int f = begin; f < end; ++f) {
            int* const values = _cornerValues.data() + cornerOffset(f);
            Far::ConstIndexArray const vertices = level.GetFaceVertices(f);
            for (int i = 0; i < vertices.size(); ++i) values[i] = FirstValue(vertices[i]);
        }
    });

    // Then set apart the corners of vertices with several regions.
    std::vector<int> regionOfFace;
    for (std::vector<int> const& split : splitOfChunk) {
        if (!split.empty()) _plainFaces.resize(static_cast<std::size_t>(numFaces), 1);
        for (int const v : split) {
            numberRegions(level, v, regionOfFace);
            Far::ConstIndexArray const faces = level.GetVertexFaces(v);
            Far::ConstLocalIndexArray const corners = level.GetVertexFaceLocalIndices(v);
            for (int i = 0; i < faces.size(); ++i) {
                _cornerValues[cornerOffset(faces[i]) + corners[i]] =
                    FirstValue(v) + regionOfFace[static_cast<std::size_t>(i)];
                _plainFaces[static_cast<std::size_t>(faces[i])] = 0;
            }
        }
    }
}

namespace {

/// Orders the faces of a region of a non-manifold vertex by walking from edge to edge; gives up where they do not
/// make one run from a sharp edge to a sharp edge.
void orderFan(Far::TopologyLevel const& level, RegionFan& fan) {
    std::size_t const count = fan.faces.size();
    std::vector<std::pair<int, std::size_t>> leading;  // edge that leads a face, face
    for (std::size_t i = 0; i < count; ++i) leading.emplace_back(edgeAfter(level, fan.faces[i], fan.corners[i]), i);
    std::sort(leading.begin(), leading.end());
    auto const first = std::find_if(leading.begin(), leading.end(),
                                    [&](auto const& side) { return IsSharpEdge(level, side.first); });
    if (first == leading.end()) return;

    std::vector<int> faces, corners;
    for (auto next = first; faces.size() < count;) {
        std::size_t const i = next->second;
        faces.push_back(fan.faces[i]);
        corners.push_back(fan.corners[i]);
        int const edge = edgeBefore(level, fan.faces[i], fan.corners[i]);
        if (IsSharpEdge(level, edge)) {
            fan.isOrdered = faces.size() == count;
            break;
        }
        next = std::lower_bound(leading.begin(), leading.end(), std::make_pair(edge, std::size_t{0}));
        if (next == leading.end() || next->first != edge) break;
    }
    if (fan.isOrdered) {
        fan.faces.swap(faces);
        fan.corners.swap(corners);
    }
}

}  // namespace

void FindRegionFaces(Far::TopologyLevel const& level, CreaseRegions const& regions, int vertex,
                     std::vector<std::vector<int>>& facesOfRegion) {
    auto const numRegions = static_cast<std::size_t>(regions.NumVertexValues(vertex));
    if (facesOfRegion.size() < numRegions) facesOfRegion.resize(numRegions);
    for (std::size_t i = 0; i < numRegions; ++i) facesOfRegion[i].clear();
    Far::ConstIndexArray const faces = level.GetVertexFaces(vertex);
    Far::ConstLocalIndexArray const corners = level.GetVertexFaceLocalIndices(vertex);
    for (int i = 0; i < faces.size(); ++i) {
        int const region = regions.CornerValue(faces[i], corners[i]) - regions.FirstValue(vertex);
        facesOfRegion[static_cast<std::size_t>(region)].push_back(faces[i]);
    }
}

void FindRegionFans(Far::TopologyLevel const& level, CreaseRegions const& regions, int vertex,
                    std::vector<RegionFan>& fans) {
    Far::ConstIndexArray const faces = level.GetVertexFaces(vertex);
    Far::ConstLocalIndexArray const corners = level.GetVertexFaceLocalIndices(vertex);
    bool const isManifold = !level.IsVertexNonManifold(vertex);
    int const numFaces = faces.size();

    fans.resize(static_cast<std::size_t>(regions.NumVertexValues(vertex)));
    for (std::size_t i = 0; i < fans.size(); ++i) {
        fans[i].value = regions.FirstValue(vertex) + static_cast<int>(i);
        fans[i].faces.clear();
        fans[i].corners.clear();
        fans[i].isOrdered = isManifold;
        fans[i].isClosed = false;
    }
    // Start where a region starts, so that a run across the ring's own start stays in one piece.
    int start = 0;
    if (isManifold && level.GetVertexEdges(vertex).size() == numFaces) {
        Far::ConstIndexArray const edges = level.GetVertexEdges(vertex);
        // One sharp edge (a dart) bounds nothing: the ring is a full one, as without any.
        fans[0].isClosed = fans.size() == 1;
        while (!fans[0].isClosed && !IsSharpEdge(level, edges[start])) ++start;
    }
    for (int i = 0; i < numFaces; ++i) {
        int const local = start + i < numFaces ? start + i : start + i - numFaces;
        int const region = regions.CornerValue(faces[local], corners[local]) - regions.FirstValue(vertex);
        fans[static_cast<std::size_t>(region)].faces.push_back(faces[local]);
        fans[static_cast<std::size_t>(region)].corners.push_back(corners[local]);
    }
    if (isManifold) return;
    for (RegionFan& fan : fans) orderFan(level, fan);
}

}  // namespace v1
}  // namespace osd_shading
