// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/surface/cutOut.h"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>
#include <utility>

namespace osd_shading {
inline namespace v1 {
namespace surface {

namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

}  // namespace

tables::TileRing FindCutOut(Far::TopologyLevel const& base, int face, int numRings) {
    tables::TileRing ring;
    std::unordered_map<int, int> numberOfVertex;
    std::unordered_set<int> isInRing;
    auto const add = [&](int f) {
        if (!isInRing.insert(f).second) return;
        Far::ConstIndexArray const vertices = base.GetFaceVertices(f);
        ring.faces.push_back(f);
        ring.firstCorners.push_back(0);
        ring.faceSizes.push_back(vertices.size());
        for (int const v : vertices) {
            auto const [known, isNew] = numberOfVertex.emplace(v, ring.numVertices);
            if (isNew) {
                ++ring.numVertices;
                ring.vertices.push_back(v);
            }
            ring.faceVertices.push_back(known->second);
        }
    };
    add(face);
    std::size_t seen = 0;
    for (int round = 0; round < numRings; ++round) {
        std::size_t const end = ring.vertices.size();
        for (; seen < end; ++seen) {
            Far::ConstIndexArray const around = base.GetVertexFaces(ring.vertices[seen]);
            // From a face that is there already on, so that the walk does not depend on the mesh's own order.
            int start = 0;
            while (isInRing.count(around[start]) == 0) ++start;
            for (int k = 0; k < around.size(); ++k) add(around[(start + k) % around.size()]);
        }
    }

    // OpenSubdiv's limit tangents at an interior vertex of two quads depend on which of them comes first.
    bool const needsOrder = std::any_of(ring.vertices.begin(), ring.vertices.end(), [&](int v) {
        return base.GetVertexEdges(v).size() == 2 && base.GetVertexFaces(v).size() == 2;
    });
    if (needsOrder) {
        std::vector<int> faces;
        faces.swap(ring.faces);
        std::sort(faces.begin(), faces.end());
        ring = {};
        numberOfVertex.clear();
        isInRing.clear();
        for (int const f : faces) add(f);
        ring.isInLevelOrder = true;
        ring.tileFace = static_cast<int>(std::lower_bound(faces.begin(), faces.end(), face) - faces.begin());
    }

    // What is sharp in it; edges of one face alone are boundaries here as there, or lie at the rim.
    std::vector<std::pair<int, std::pair<int, int>>> edges;
    std::size_t offset = 0;
    for (std::size_t f = 0; f < ring.faces.size(); ++f) {
        Far::ConstIndexArray const faceEdges = base.GetFaceEdges(ring.faces[f]);
        int const size = ring.faceSizes[f];
        for (int i = 0; i < size; ++i) {
            if (!IsSharpEdge(base, faceEdges[i])) continue;
            edges.push_back({faceEdges[i], std::minmax(ring.faceVertices[offset + index(i)],
                                                       ring.faceVertices[offset + index((i + 1) % size)])});
        }
        offset += index(size);
    }
    std::stable_sort(edges.begin(), edges.end(), [](auto const& a, auto const& b) { return a.first < b.first; });
    std::vector<std::pair<std::pair<int, int>, float>> creases;
    for (std::size_t i = 1; i < edges.size(); ++i) {
        bool const isSecond =
            edges[i].first == edges[i - 1].first && (i < 2 || edges[i].first != edges[i - 2].first);
        if (isSecond) creases.emplace_back(edges[i].second, base.GetEdgeSharpness(edges[i].first));
    }
    std::sort(creases.begin(), creases.end());
    for (auto const& [ends, sharpness] : creases) {
        ring.creaseVertices.insert(ring.creaseVertices.end(), {ends.first, ends.second});
        ring.creaseSharpness.push_back(sharpness);
    }
    for (std::size_t v = 0; v < ring.vertices.size(); ++v) {
        float const sharpness = base.GetVertexSharpness(ring.vertices[v]);
        if (!(sharpness > 0)) continue;
        ring.cornerVertices.push_back(static_cast<int>(v));
        ring.cornerSharpness.push_back(sharpness);
    }
    return ring;
}

}  // namespace surface
}  // namespace v1
}  // namespace osd_shading
