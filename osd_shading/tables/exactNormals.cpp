// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/tables/exactNormals.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "osd_shading/limitFrames.h"

namespace osd_shading {
inline namespace v1 {
namespace tables {

namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

std::vector<Vec3<double>> pointsOf(std::vector<int> const& vertices, std::vector<Vec3<double>> const& points) {
    std::vector<Vec3<double>> picked;
    picked.reserve(vertices.size());
    for (int const v : vertices) picked.push_back(points[index(v)]);
    return picked;
}

}  // namespace

ExactNormals::ExactNormals(TableData const& data) : _data(data) {
    TableMesh const& mesh = data.mesh;
    _vertexFaceOffsets.assign(index(mesh.numVertices) + 1, 0);
    for (int const v : mesh.faceVertices) ++_vertexFaceOffsets[index(v) + 1];
    for (int v = 0; v < mesh.numVertices; ++v) _vertexFaceOffsets[index(v) + 1] += _vertexFaceOffsets[index(v)];
    _vertexFaces.resize(mesh.faceVertices.size());
    std::vector<int> next = _vertexFaceOffsets;
    for (int f = 0; f < mesh.NumFaces(); ++f) {
        for (int i = mesh.faceOffsets[index(f)]; i < mesh.faceOffsets[index(f) + 1]; ++i) {
            _vertexFaces[index(next[index(mesh.faceVertices[index(i)])]++)] = f;
        }
    }
}

Vec3<double> ExactNormals::Find(int tile, GridPoint const& at, PointView<float> controlPoints) const {
    // The control faces that share a vertex with the tile's, in their order.
    TableMesh const& mesh = _data.mesh;
    std::vector<int> faces{tile};
    auto const addRound = [&] {
        std::vector<int> const inner = faces;
        for (int const f : inner) {
            for (int i = mesh.faceOffsets[index(f)]; i < mesh.faceOffsets[index(f) + 1]; ++i) {
                int const v = mesh.faceVertices[index(i)];
                faces.insert(faces.end(), _vertexFaces.begin() + _vertexFaceOffsets[index(v)],
                             _vertexFaces.begin() + _vertexFaceOffsets[index(v) + 1]);
            }
        }
        std::sort(faces.begin(), faces.end());
        faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    };
    addRound();
    if (mesh.rules.creasing == Sdc::Options::CREASE_CHAIKIN) addRound();  // as in TileRings
    TileRing ring;
    std::vector<int> vertices;
    for (int const f : faces) {
        ring.faceSizes.push_back(mesh.FaceSize(f));
        for (int i = mesh.faceOffsets[index(f)]; i < mesh.faceOffsets[index(f) + 1]; ++i) {
            vertices.push_back(mesh.faceVertices[index(i)]);
        }
    }
    ring.faceVertices = vertices;
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    auto const number = [&](int v) {
        auto const found = std::lower_bound(vertices.begin(), vertices.end(), v);
        return found != vertices.end() && *found == v ? static_cast<int>(found - vertices.begin()) : -1;
    };
    for (int& v : ring.faceVertices) v = number(v);
    ring.numVertices = static_cast<int>(vertices.size());
    ring.tileFace = static_cast<int>(std::lower_bound(faces.begin(), faces.end(), tile) - faces.begin());

    std::vector<std::pair<int, int>> edges;
    for (std::size_t f = 0, offset = 0; f < ring.faceSizes.size(); offset += index(ring.faceSizes[f++])) {
        for (std::size_t i = 0, size = index(ring.faceSizes[f]); i < size; ++i) {
            edges.push_back(std::minmax(ring.faceVertices[offset + i], ring.faceVertices[offset + (i + 1) % size]));
        }
    }
    std::sort(edges.begin(), edges.end());
    for (std::size_t e = 0; e < mesh.creaseSharpness.size(); ++e) {
        int const a = number(mesh.creaseVertices[2 * e]), b = number(mesh.creaseVertices[2 * e + 1]);
        if (a < 0 || b < 0 ||
            !std::binary_search(edges.begin(), edges.end(), std::pair<int, int>(std::minmax(a, b)))) {
            continue;
        }
        ring.creaseVertices.insert(ring.creaseVertices.end(), {a, b});
        ring.creaseSharpness.push_back(mesh.creaseSharpness[e]);
    }
    for (std::size_t i = 0; i < mesh.cornerSharpness.size(); ++i) {
        int const v = number(mesh.cornerVertices[i]);
        if (v < 0) continue;
        ring.cornerVertices.push_back(v);
        ring.cornerSharpness.push_back(mesh.cornerSharpness[i]);
    }
    std::vector<Vec3<double>> points;
    for (int const v : vertices) {
        Vec3<float> const p = controlPoints[index(v)];
        points.push_back({double{p.x}, double{p.y}, double{p.z}});
    }

    // Go down to a small face at the point.
    bool const isCatmark = mesh.rules.scheme == Sdc::SCHEME_CATMARK;
    int k = _data.options.level, row = at.row, column = at.column;
    bool isNgon = isCatmark && mesh.FaceSize(tile) != 4;
    constexpr int kSmall = 2;
    while (k > kSmall || (isNgon && k > 0)) {
        RefinedTopology const topology(ring.Mesh(mesh.rules), 1);
        int const half = 1 << (k - 1);
        int child, nextRow = row, nextColumn = column;
        if (isNgon) {
            child = at.child;
        } else if (isCatmark) {
            bool const isHighRow = row >= half, isHigh = column >= half;
            child = isHighRow ? (isHigh ? 2 : 3) : (isHigh ? 1 : 0);
            nextRow -= isHighRow ? half : 0;
            nextColumn -= isHigh ? half : 0;
        } else if (column >= half) {
            child = 1;
            nextColumn -= half;
        } else if (row >= half) {
            child = 2;
            nextRow -= half;
        } else if (row + column <= half) {
            child = 0;
        } else {
            child = 3;
            nextRow = half - row;
            nextColumn = half - column;
        }
        RegionLevels levels(topology);
        int const childFace = topology.Level(0).GetFaceChildFaces(ring.tileFace)[child];
        if (!IsRefinedAlike(levels, 1, childFace)) break;
        points = RefinePoints(topology.RecordMasks<double>(1), points, 1);
        TileRing next = TileRings(topology, 1).Find(childFace, 0, k - 1);
        points = pointsOf(next.vertices, points);
        ring = std::move(next);
        row = nextRow;
        column = nextColumn;
        isNgon = false;
        --k;
    }

    RefinedTopology const topology(ring.Mesh(mesh.rules), k);
    for (int level = 1; level <= k; ++level) points = RefinePoints(topology.RecordMasks<double>(level), points, 1);
    CreaseRegions const regions(topology, k, 1);
    LimitStep<double> const step(topology, k, regions, 1);
    LimitNormals<double> const limits = ComputeLimitNormals(step, points, 1);
    int const gridFace = isNgon ? topology.Level(0).GetFaceChildFaces(ring.tileFace)[at.child] : ring.tileFace;
    int const side = 1 << (isNgon ? k - 1 : k);
    FaceCorner const corner = FindFaceGrid(topology, isNgon ? 1 : 0, gridFace, k)[index(row * (side + 1) + column)];
    return limits.normals[index(regions.CornerValue(corner.face, corner.corner))];
}

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
