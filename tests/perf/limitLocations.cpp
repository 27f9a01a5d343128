// SPDX-License-Identifier: Apache-2.0
#include "limitLocations.h"

#include <opensubdiv/far/ptexIndices.h>

namespace perf {

namespace {

namespace Sdc = OpenSubdiv::OPENSUBDIV_VERSION::Sdc;

/// Places the vertices in and on one control face after another; those on its border only where it is the first
/// face that has them.
class Locator {
public:
    Locator(Far::TopologyRefiner const& refiner, int level)
        : _base(refiner.GetLevel(0)), _ptexIndices(refiner), _numSegments(1 << level) {}

    LimitLocations Locate(Sdc::SchemeType scheme) {
        for (int face = 0; face < _base.GetNumFaces(); ++face) {
            _ptexFace = _ptexIndices.GetFaceId(face);
            if (scheme == Sdc::SCHEME_LOOP) {
                addTriangle(face);
            } else if (_base.GetFaceVertices(face).size() == 4) {
                addQuad(face);
            } else {
                addNgon(face);
            }
        }
        return std::move(_locations);
    }

private:
    bool ownsVertex(int face, int corner) const {
        return _base.GetVertexFaces(_base.GetFaceVertices(face)[corner])[0] == face;
    }
    bool ownsEdge(int face, int edge) const {
        return _base.GetEdgeFaces(_base.GetFaceEdges(face)[edge])[0] == face;
    }
    void add(int i, int j, int numSegments) {
        _locations.ptexFaces.push_back(_ptexFace);
        _locations.u.push_back(static_cast<float>(i) / static_cast<float>(numSegments));
        _locations.v.push_back(static_cast<float>(j) / static_cast<float>(numSegments));
    }
    void addTriangle(int face) {
        int const n = _numSegments;
        int const corners[3][2] = {{0, 0}, {n, 0}, {0, n}};
        addBorder(face, 3, corners);
        for (int i = 1; i < n; ++i) {
            for (int j = 1; i + j < n; ++j) add(i, j, n);
        }
    }
    void addQuad(int face) {
        int const n = _numSegments;
        int const corners[4][2] = {{0, 0}, {n, 0}, {n, n}, {0, n}};
        addBorder(face, 4, corners);
        for (int i = 1; i < n; ++i) {
            for (int j = 1; j < n; ++j) add(i, j, n);
        }
    }
    void addBorder(int face, int numCorners, int const (*corners)[2]) {
        int const n = _numSegments;
        for (int k = 0; k < numCorners; ++k) {
            int const *from = corners[k], *to = corners[(k + 1) % numCorners];
            if (ownsVertex(face, k)) add(from[0], from[1], n);
            if (!ownsEdge(face, k)) continue;
            for (int i = 1; i < n; ++i) {
                add(from[0] + (to[0] - from[0]) / n * i, from[1] + (to[1] - from[1]) / n * i, n);
            }
        }
    }
    /// An n-gon is a ring of quads, one for each corner: u runs along its edge to the edge's middle, v to the
    /// middle of the edge before.
    void addNgon(int face) {
        int const numCorners = _base.GetFaceVertices(face).size(), n = _numSegments / 2;
        for (int k = 0; k < numCorners; ++k) {
            int const before = (k + numCorners - 1) % numCorners;
            if (ownsVertex(face, k)) add(0, 0, n);
            for (int i = 1; ownsEdge(face, k) && i <= n; ++i) add(i, 0, n);
            for (int j = 1; ownsEdge(face, before) && j < n; ++j) add(0, j, n);
            // Its inside, and the border to the next quad.
            for (int i = 1; i <= n; ++i) {
                for (int j = 1; j < n; ++j) add(i, j, n);
            }
            if (k == 0) add(n, n, n);
            ++_ptexFace;
        }
    }

    Far::TopologyLevel const& _base;
    Far::PtexIndices const _ptexIndices;
    int _numSegments;
    int _ptexFace = 0;
    LimitLocations _locations;
};

}  // namespace

LimitLocations UniformLocations(Far::TopologyRefiner const& refiner, int level) {
    return Locator(refiner, level).Locate(refiner.GetSchemeType());
}

}  // namespace perf
