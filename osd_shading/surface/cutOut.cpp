// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/surface/cutOut.h"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>

namespace osd_shading {
inline namespace v1 {
namespace surface {

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

    tables::AppendInnerCreases(
        base, [&](int edge) { return base.GetEdgeSharpness(edge); }, ring);
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
