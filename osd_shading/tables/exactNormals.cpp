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

/// How many values a table keeps the exact normals of.
constexpr std::size_t kMostKept = 4096;

}  // namespace

ExactNormal::ExactNormal(TileRing ring, SubdivisionRules const& rules, LimitNormalKind kind, int k,
                         GridPoint const& at)
    : _vertices(ring.vertices), _rows(ring.vertices.size() * ring.vertices.size(), 0) {
    for (std::size_t i = 0; i < _vertices.size(); ++i) _rows[i * _vertices.size() + i] = 1;

    // Go down to a small face at the point, as far as meshes made anew are refined alike.
    bool const isCatmark = rules.scheme == Sdc::SCHEME_CATMARK;
    int row = at.row, column = at.column;
    bool isNgon = isCatmark && ring.faceSizes[index(ring.tileFace)] != 4;
    while (k > 0) {
        RefinedTopology const topology(ring.Mesh(rules), 1);
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
        TileRing next = levels.Rings(1).Find(childFace, 0, k - 1);
        refine(topology, 1, next.vertices);
        ring = std::move(next);
        row = nextRow;
        column = nextColumn;
        isNgon = false;
        --k;
    }

    _topology = std::make_unique<RefinedTopology>(ring.Mesh(rules), k);
    for (int level = 1; level <= k; ++level) refine(*_topology, level, {});
    _regions = std::make_unique<CreaseRegions>(*_topology, k, 1);
    _step = std::make_unique<LimitStep<double>>(*_topology, k, *_regions, 1, kind);
    int const gridFace = isNgon ? _topology->Level(0).GetFaceChildFaces(ring.tileFace)[at.child] : ring.tileFace;
    int const side = 1 << (isNgon ? k - 1 : k);
    FaceCorner const corner =
        FindFaceGrid(*_topology, isNgon ? 1 : 0, gridFace, k)[index(row * (side + 1) + column)];
    _value = _regions->CornerValue(corner.face, corner.corner);
}

/// Takes the rows a level down; `picked` are kept of its vertices, all where it is empty.
void ExactNormal::refine(RefinedTopology const& topology, int level, std::vector<int> const& picked) {
    // Three columns at a time, as if they were points.
    std::size_t const numColumns = _vertices.size(), numRows = _rows.size() / numColumns;
    LevelMasks<double> const masks = topology.RecordMasks<double>(level);
    std::size_t const numNext = picked.empty() ? index(masks.numChildVertices) : picked.size();
    std::vector<double> next(numNext * numColumns);
    std::vector<Vec3<double>> columns(numRows);
    for (std::size_t first = 0; first < numColumns; first += 3) {
        auto const entry = [&](std::vector<double>& rows, std::size_t row, std::size_t i) -> double* {
            return first + i < numColumns ? &rows[row * numColumns + first + i] : nullptr;
        };
        for (std::size_t row = 0; row < numRows; ++row) {
            double const* const y = entry(_rows, row, 1);
            double const* const z = entry(_rows, row, 2);
            columns[row] = {*entry(_rows, row, 0), y ? *y : 0, z ? *z : 0};
        }
        std::vector<Vec3<double>> const refined = RefinePoints(masks, columns, 1);
        for (std::size_t row = 0; row < numNext; ++row) {
            Vec3<double> const& r = refined[picked.empty() ? row : index(picked[row])];
            double const values[3] = {r.x, r.y, r.z};
            for (std::size_t i = 0; i < 3; ++i) {
                if (double* const target = entry(next, row, i)) *target = values[i];
            }
        }
    }
    _rows.swap(next);
}

Vec3<double> ExactNormal::Find(PointView<float> controlPoints) const {
    // Relative to one of them: what a distant origin would round away stays.
    std::size_t const numColumns = _vertices.size();
    Vec3<float> const origin = controlPoints[index(_vertices[0])];
    std::vector<Vec3<double>> sides(numColumns), points(_rows.size() / numColumns);
    for (std::size_t i = 0; i < numColumns; ++i) {
        Vec3<float> const p = controlPoints[index(_vertices[i])];
        sides[i] = {double{p.x} - double{origin.x}, double{p.y} - double{origin.y}, double{p.z} - double{origin.z}};
    }
    for (std::size_t row = 0; row < points.size(); ++row) {
        for (std::size_t i = 0; i < numColumns; ++i) points[row] += _rows[row * numColumns + i] * sides[i];
    }
    return ComputeLimitNormals(*_step, points, 1).normals[index(_value)];
}

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

TileRing ExactNormals::findRing(int tile) const {
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
    ring.vertices = std::move(vertices);
    return ring;
}

Vec3<double> ExactNormals::Find(int tileIndex, int value, PointView<float> controlPoints) {
    ExactNormal const* known = nullptr;
    {
        std::lock_guard<std::mutex> const lock(_mutex);
        auto const found = _known.find(value);
        if (found != _known.end()) known = found->second.get();
    }
    if (known) return known->Find(controlPoints);
    Tile const& tile = _data.tiles[index(tileIndex)];
    GridPoint const point = FindTilePoints(_data.dictionary, tile)[index(value - tile.firstValue)];
    ShadingOptions const& options = _data.options;
    auto made = std::make_unique<ExactNormal const>(findRing(tileIndex), _data.mesh.rules, options.limits.normals,
                                                    options.level, point);
    Vec3<double> const normal = made->Find(controlPoints);
    std::lock_guard<std::mutex> const lock(_mutex);
    if (_known.size() < kMostKept) _known.emplace(value, std::move(made));
    return normal;
}

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
