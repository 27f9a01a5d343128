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

class Walk {
public:
    explicit Walk(Far::TopologyLevel const& level) : _level(level) {}

    void Add(int face) {
        if (!_isInRing.insert(face).second) return;
        Far::ConstIndexArray const vertices = _level.GetFaceVertices(face);
        _ring.faces.push_back(face);
        _ring.firstCorners.push_back(0);
        _ring.faceSizes.push_back(vertices.size());
        for (int const v : vertices) {
            auto const [known, isNew] = _numberOfVertex.emplace(v, _ring.numVertices);
            if (isNew) {
                ++_ring.numVertices;
                _ring.vertices.push_back(v);
            }
            _ring.faceVertices.push_back(known->second);
        }
    }

    void AddRings(int numRings) {
        std::size_t seen = 0;
        for (int round = 0; round < numRings; ++round) {
            std::size_t const end = _ring.vertices.size();
            for (; seen < end; ++seen) {
                Far::ConstIndexArray const around = _level.GetVertexFaces(_ring.vertices[seen]);
                // From a face that is there already on, so that the walk does not depend on the mesh's own order.
                int start = 0;
                while (_isInRing.count(around[start]) == 0) ++start;
                for (int k = 0; k < around.size(); ++k) Add(around[(start + k) % around.size()]);
            }
        }
    }

    /// OpenSubdiv's limit tangents at an interior vertex of two quads depend on which of them comes first.
    bool NeedsOrder() const {
        return std::any_of(_ring.vertices.begin(), _ring.vertices.end(), [&](int v) {
            return _level.GetVertexEdges(v).size() == 2 && _level.GetVertexFaces(v).size() == 2;
        });
    }

    /// Numbers all anew.
    void TakeOrder() {
        std::vector<int> faces;
        faces.swap(_ring.faces);
        std::sort(faces.begin(), faces.end());
        _ring = {};
        _numberOfVertex.clear();
        _isInRing.clear();
        for (int const f : faces) Add(f);
        _ring.isInLevelOrder = true;
    }

    tables::TileRing Finish(int tileFace) {
        auto const found = std::find(_ring.faces.begin(), _ring.faces.end(), tileFace);
        _ring.tileFace = static_cast<int>(found - _ring.faces.begin());
        tables::AppendInnerCreases(
            _level, [&](int edge) { return _level.GetEdgeSharpness(edge); }, _ring);
        for (std::size_t v = 0; v < _ring.vertices.size(); ++v) {
            float const sharpness = _level.GetVertexSharpness(_ring.vertices[v]);
            if (!(sharpness > 0)) continue;
            _ring.cornerVertices.push_back(static_cast<int>(v));
            _ring.cornerSharpness.push_back(sharpness);
        }
        return std::move(_ring);
    }

private:
    Far::TopologyLevel const& _level;
    tables::TileRing _ring;
    std::unordered_map<int, int> _numberOfVertex;
    std::unordered_set<int> _isInRing;
};

}  // namespace

tables::TileRing FindCutOut(Far::TopologyLevel const& level, int face, int numRings) {
    Walk walk(level);
    walk.Add(face);
    walk.AddRings(numRings);
    if (walk.NeedsOrder()) walk.TakeOrder();
    return walk.Finish(face);
}

tables::TileRing FindCutOut(Far::TopologyLevel const& level, std::vector<int> const& faces, int numRings) {
    Walk walk(level);
    for (int const face : faces) walk.Add(face);
    walk.AddRings(numRings);
    walk.TakeOrder();
    return walk.Finish(faces.front());
}

}  // namespace surface
}  // namespace v1
}  // namespace osd_shading
