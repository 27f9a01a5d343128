// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/shadingTable.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "osd_shading/backToBack.h"
#include "osd_shading/oneShotShading.h"
#include "osd_shading/subdivisionShading.h"
#include "osd_shading/tables/tableData.h"
#include "osd_shading/tables/tableEstimate.h"

namespace osd_shading {
inline namespace v1 {

namespace {

using tables::TableData;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// What a table can't hold, in words.
void checkOptions(ShadingOptions const& options, ValueOrder order) {
    if (order != ValueOrder::Tiles && order != ValueOrder::OpenSubdiv) {
        throw InvalidOptions("order is " + std::to_string(static_cast<int>(order)) + ", none that there is");
    }
    if (options.subdividedNormals.averaging != NormalAveraging::Linear) {
        throw InvalidOptions("a table holds linear averaging of normals only; use ShadeSubdivision for the others");
    }
}

/// Refuses what int can't number, before any work. `numFaceCorners`: of the control mesh.
void checkSize(std::int64_t numFaces, std::int64_t numFaceCorners, Sdc::SchemeType scheme, int level) {
    double const first = static_cast<double>(scheme == Sdc::SCHEME_CATMARK ? numFaceCorners : 4 * numFaces);
    double const count = level == 0 ? static_cast<double>(numFaces) : first * std::pow(4.0, level - 1);
    if (count <= std::numeric_limits<int>::max()) return;
    throw MemoryLimitExceeded(
        "level " + std::to_string(level) + " has more faces than 32-bit indices can number; use a lower level",
        static_cast<std::uint64_t>(count) * 4 * sizeof(int));
}

/// `base`: level 0 alone; `options` are resolved.
std::shared_ptr<TableData const> build(RefinedTopology const& base, ShadingOptions const& options,
                                       ValueOrder order) {
    // A table looks at a tile's surroundings alone from level 3 on.
    if (!base.IsCatmark() && options.level >= 3) {
        RefuseBackToBack(base.Level(0), "which tables of Loop subdivision hold up to level 2 only");
    }
    tables::CheckTableMemory(base, options, order);
    RefinedTopology const topology(base.Refiner(), options.startNormals.level);
    return tables::BuildTable(topology, options, order, true);
}

/// The values of each tile's whole grid, of its own and its neighbours'.
class TileGrids {
public:
    explicit TileGrids(TableData const& data) : _data(data) {
        for (std::size_t f = 0; f < data.tiles.size(); ++f) {
            std::size_t const numPoints = pitch(f) * pitch(f) * numGrids(f);
            _offsets.push_back(_offsets.back() + numPoints);
        }
        _values.assign(_offsets.back(), -1);
        for (std::size_t f = 0; f < data.tiles.size(); ++f) {
            int value = data.tiles[f].firstValue;
            for (tables::GridPoint const& p : FindTilePoints(data.dictionary, data.tiles[f])) {
                at(f, p.child, p.row, p.column) = value++;
            }
        }
        for (std::size_t f = 0; f < data.tiles.size(); ++f) {
            if (isNgon(f)) {
                joinChildren(f);
            }
        }
        for (std::size_t f = 0; f < data.tiles.size(); ++f) takeFromNeighbors(f);
        for (std::size_t f = 0; f < data.tiles.size(); ++f) {
            if (isNgon(f)) joinChildren(f);
        }
    }

    bool isNgon(std::size_t f) const { return tileClass(f).isNgon; }
    std::size_t numGrids(std::size_t f) const { return isNgon(f) ? index(tileClass(f).size) : 1; }
    std::size_t pitch(std::size_t f) const {
        return (std::size_t{1} << (isNgon(f) ? _data.options.level - 1 : _data.options.level)) + 1;
    }
    int& at(std::size_t f, int child, int row, int column) {
        return _values[_offsets[f] + (index(child) * pitch(f) + index(row)) * pitch(f) + index(column)];
    }

private:
    tables::TileClass const& tileClass(std::size_t f) const {
        return _data.dictionary.classes[index(_data.tiles[f].tileClass)];
    }

    /// The value at step `i` along edge `edge` of face f, of 2^level steps.
    int& onEdge(std::size_t f, int edge, int i) {
        int const side = static_cast<int>(pitch(f)) - 1;
        if (isNgon(f)) {
            int const size = tileClass(f).size;
            // The first half belongs to the child at its start, the second to the next one's last edge.
            return i <= side ? at(f, edge, 0, i) : at(f, (edge + 1) % size, 2 * side - i, 0);
        }
        if (_data.mesh.rules.scheme == Sdc::SCHEME_LOOP) {
            if (edge == 0) return at(f, 0, 0, i);
            if (edge == 1) return at(f, 0, i, side - i);
            return at(f, 0, side - i, 0);
        }
        if (edge == 0) return at(f, 0, 0, i);
        if (edge == 1) return at(f, 0, i, side);
        if (edge == 2) return at(f, 0, side, side - i);
        return at(f, 0, side - i, 0);
    }

    /// Inside an n-gon, children share points.
    void joinChildren(std::size_t f) {
        int const size = tileClass(f).size, side = static_cast<int>(pitch(f)) - 1;
        auto const join = [](int& a, int& b) {
            if (a < 0) a = b;
            if (b < 0) b = a;
        };
        for (int child = 0; child < size; ++child) {
            int const next = (child + 1) % size;
            for (int i = 0; i <= side; ++i) join(at(f, child, i, side), at(f, next, side, i));
        }
        int const center = at(f, 0, side, side);
        for (int child = 0; child < size; ++child) at(f, child, side, side) = center;
    }

    void takeFromNeighbors(std::size_t f) {
        std::vector<int> const& offsets = _data.mesh.faceOffsets;
        int const first = offsets[f], size = _data.mesh.FaceSize(static_cast<int>(f));
        int const numSteps = 1 << _data.options.level;
        auto const faceOf = [&](int corner) {
            return static_cast<std::size_t>(std::upper_bound(offsets.begin(), offsets.end(), corner) -
                                            offsets.begin() - 1);
        };
        for (int i = 0; i < size; ++i) {
            int& corner = onEdge(f, i, 0);
            if (corner < 0) {
                int const owner = _data.cornerOwners[index(first + i)];
                std::size_t const face = faceOf(owner);
                corner = onEdge(face, owner - offsets[face], 0);
            }
            // An n-gon's corner stands in one child only; a quad's is the end of the edge before too, the same
            // place.
            int const owner = _data.edgeTwins[index(first + i)];
            std::size_t const face = faceOf(owner);
            int const edge = owner - offsets[face];
            for (int step = 1; step < numSteps; ++step) {
                int& value = onEdge(f, i, step);
                if (value < 0) value = onEdge(face, edge, numSteps - step);
                if (isNgon(f) && step == numSteps / 2) {
                    // The middle stands in two children.
                    int const side = static_cast<int>(pitch(f)) - 1;
                    at(f, (i + 1) % size, side, 0) = value;
                }
            }
        }
    }

    TableData const& _data;
    std::vector<std::size_t> _offsets{0};
    std::vector<int> _values;
};

}  // namespace

ShadingTable::ShadingTable(ControlMesh const& mesh, ShadingOptions const& options, ValueOrder order) {
    CheckVertexMemory(mesh, options.execution.memoryLimit);
    ValidateControlMesh(mesh);
    ShadingOptions const resolved = ResolveOptions(options, mesh);
    checkOptions(resolved, order);
    checkSize(static_cast<std::int64_t>(mesh.faceSizes.size()), static_cast<std::int64_t>(mesh.faceVertices.size()),
              mesh.rules.scheme, resolved.level);
    _data = build(RefinedTopology(mesh, 0), resolved, order);
}

ShadingTable::ShadingTable(Far::TopologyRefiner const& refiner, ShadingOptions const& options, ValueOrder order) {
    ValidateRefiner(refiner);
    ShadingOptions const resolved = ResolveOptions(options, refiner);
    checkOptions(resolved, order);
    Far::TopologyLevel const base = refiner.GetLevel(0);
    checkSize(base.GetNumFaces(), base.GetNumFaceVertices(), refiner.GetSchemeType(), resolved.level);
    _data = build(RefinedTopology(refiner, 0), resolved, order);
}

ShadingOptions const& ShadingTable::Options() const { return _data->options; }
ValueOrder ShadingTable::Order() const { return _data->order; }
int ShadingTable::NumControlVertices() const { return _data->mesh.numVertices; }
int ShadingTable::NumControlFaceCorners() const { return static_cast<int>(_data->mesh.faceVertices.size()); }
int ShadingTable::NumValues() const { return _data->numValues; }
int ShadingTable::NumFaces() const { return _data->numFaces; }
int ShadingTable::FaceSize() const { return _data->mesh.rules.scheme == Sdc::SCHEME_LOOP ? 3 : 4; }
ShadingTableStats const& ShadingTable::Stats() const { return _data->stats; }

std::vector<int> ShadingTable::FaceValues() const {
    TileGrids grids(*_data);
    std::vector<int> indices;
    indices.reserve(index(FaceSize()) * index(NumFaces()));
    auto const numbered = [&](int value) {
        return _data->orderOfValues.empty() ? value : _data->orderOfValues[index(value)];
    };
    std::vector<int> const& holes = _data->mesh.holes;
    for (std::size_t f = 0; f < _data->tiles.size(); ++f) {
        if (std::binary_search(holes.begin(), holes.end(), static_cast<int>(f))) continue;
        int const side = static_cast<int>(grids.pitch(f)) - 1;
        for (int child = 0; child < static_cast<int>(grids.numGrids(f)); ++child) {
            auto const at = [&](int row, int column) { return numbered(grids.at(f, child, row, column)); };
            for (int row = 0; row < side; ++row) {
                if (FaceSize() == 4) {
                    for (int c = 0; c < side; ++c) {
                        indices.insert(indices.end(),
                                       {at(row, c), at(row, c + 1), at(row + 1, c + 1), at(row + 1, c)});
                    }
                    continue;
                }
                for (int c = 0; c < side - row; ++c) {
                    indices.insert(indices.end(), {at(row, c), at(row, c + 1), at(row + 1, c)});
                    if (row + c + 2 > side) continue;
                    indices.insert(indices.end(), {at(row, c + 1), at(row + 1, c + 1), at(row + 1, c)});
                }
            }
        }
    }
    return indices;
}

std::vector<int> ShadingTable::TriangleValues() const {
    std::vector<int> faces = FaceValues();
    if (FaceSize() == 3) return faces;
    std::vector<int> triangles;
    triangles.reserve(faces.size() / 2 * 3);
    for (std::size_t i = 0; i < faces.size(); i += 4) {
        triangles.insert(triangles.end(),
                         {faces[i], faces[i + 1], faces[i + 2], faces[i], faces[i + 2], faces[i + 3]});
    }
    return triangles;
}

std::vector<int> ShadingTable::BaseFaces() const {
    std::vector<int> faces;
    faces.reserve(index(NumFaces()));
    std::vector<int> const& holes = _data->mesh.holes;
    int const level = _data->options.level;
    for (int f = 0; f < _data->mesh.NumFaces(); ++f) {
        if (std::binary_search(holes.begin(), holes.end(), f)) continue;
        int const size = _data->mesh.FaceSize(f);
        bool const isNgon = FaceSize() == 4 && size != 4;
        std::size_t const count = isNgon ? index(size) << (2 * (level - 1)) : std::size_t{1} << (2 * level);
        faces.insert(faces.end(), count, f);
    }
    return faces;
}

namespace {

/// Calls `visit(value, corner)` for every value, `corner` being one of a face of the last level of `topology`.
template <typename Visit>
void forEachValue(TableData const& data, RefinedTopology const& topology, Visit const& visit) {
    std::vector<tables::FaceCorner> const corners = tables::FindValueCorners(data, topology);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        visit(data.orderOfValues.empty() ? i : index(data.orderOfValues[i]), corners[i]);
    }
}

RefinedTopology refineAgain(TableData const& data) {
    std::vector<int> sizes;
    sizes.reserve(index(data.mesh.NumFaces()));
    for (int f = 0; f < data.mesh.NumFaces(); ++f) sizes.push_back(data.mesh.FaceSize(f));
    ControlMesh mesh;
    mesh.numVertices = data.mesh.numVertices;
    mesh.faceSizes = sizes;
    mesh.faceVertices = data.mesh.faceVertices;
    mesh.creaseVertices = data.mesh.creaseVertices;
    mesh.creaseSharpness = data.mesh.creaseSharpness;
    mesh.cornerVertices = data.mesh.cornerVertices;
    mesh.cornerSharpness = data.mesh.cornerSharpness;
    mesh.holes = data.mesh.holes;
    mesh.rules = data.mesh.rules;
    return RefinedTopology(mesh, data.options.level);
}

}  // namespace

std::vector<int> ShadingTable::ResultValues() const {
    std::vector<int> values(index(NumValues()));
    if (_data->order == ValueOrder::OpenSubdiv) {
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<int>(i);
        return values;
    }
    RefinedTopology const topology = refineAgain(*_data);
    CreaseRegions const regions(topology, _data->options.level, 1);
    forEachValue(*_data, topology, [&](std::size_t value, tables::FaceCorner const& at) {
        values[value] = regions.CornerValue(at.face, at.corner);
    });
    return values;
}

std::vector<int> ShadingTable::RefinedVertices() const {
    std::vector<int> vertices(index(NumValues()));
    RefinedTopology const topology = refineAgain(*_data);
    Far::TopologyLevel const& last = topology.Level(_data->options.level);
    forEachValue(*_data, topology,
                 [&](std::size_t value, tables::FaceCorner const& at) { vertices[value] = VertexAt(last, at); });
    return vertices;
}

std::vector<float> ShadingTable::BlendWeights() const {
    std::vector<float> weights(index(NumValues()));
    for (tables::Tile const& tile : _data->tiles) {
        std::size_t value = index(tile.firstValue);
        tables::ForEachLeafBlend(
            *_data, tile, [&](int numPoints, tables::LeafBlend blend, std::size_t firstWeight) {
                std::vector<float> const& all =
                    _data->blendWeights.empty() ? _data->blendPowers : _data->blendWeights;
                for (int i = 0; i < numPoints; ++i, ++value) {
                    float const b = blend == tables::LeafBlend::Mixed ? all[firstWeight + index(i)]
                                    : blend == tables::LeafBlend::One ? 1.0f
                                                                      : 0.0f;
                    weights[_data->orderOfValues.empty() ? value : index(_data->orderOfValues[value])] = b;
                }
            });
    }
    return weights;
}

}  // namespace v1
}  // namespace osd_shading
