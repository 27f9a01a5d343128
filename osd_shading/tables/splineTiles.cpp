// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/tables/tileCompiler.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <utility>

#include "osd_shading/tables/localRows.h"
#include "osd_shading/tables/splineBasis.h"

namespace osd_shading {
inline namespace v1 {
namespace tables {

SplineBasis const& SplineBases::ForNormals(int k, int q, int window, int& firstPoint) const {
    int const inFace = k - q, inWindow = std::min(k, 4);
    if (inFace >= inWindow) {
        int const windowsPerFace = NumWindows(inFace);
        firstPoint = window / windowsPerFace;
        return limits[static_cast<std::size_t>(inFace)][static_cast<std::size_t>(window % windowsPerFace)];
    }
    firstPoint = window << (inWindow - inFace);
    return grids[static_cast<std::size_t>(inWindow - inFace)][static_cast<std::size_t>(inFace)];
}

CompiledTile TileCompiler::compileSpline(RegionLevels& levels, int level, int face, int k, int q,
                                         unsigned sharpSides, TileOwnership const& own) {
    std::vector<FaceCorner> const points = FindControlGrid(levels.Topology(), level, face, level, sharpSides);
    std::vector<FaceCorner> normals;
    if (_contents.hasSubdividedNormals) {
        normals = q == 0 ? points : FindControlGrid(levels.Topology(), level, face, level + q, sharpSides);
    }
    std::vector<std::int32_t> key{0, k, q, static_cast<std::int32_t>(sharpSides)};
    own.AppendKey(key);

    CompiledTile tile;
    auto const known = _classOfKey.find(key);
    if (known != _classOfKey.end()) {
        tile.tileClass = known->second;
    } else {
        tile.tileClass = addClass(makeSpline(points, normals, k, q, sharpSides, own));
        _classOfKey.emplace(std::move(key), tile.tileClass);
    }
    for (FaceCorner const& at : points) {
        if (at.IsFound()) tile.vertices.push_back(VertexAt(levels.Level(level), at));
    }
    for (FaceCorner const& at : normals) {
        if (at.IsFound()) tile.normals.push_back(at);
    }
    return tile;
}

namespace {

/// Numbers the control points that are found, and extrapolates those beyond sharp sides: there the surface ends as
/// a spline does whose outer control points are the mirror images of the inner ones.
std::vector<std::uint16_t> extrapolate(std::vector<FaceCorner> const& grid, int side, unsigned sharpSides,
                                       int& numSources, LocalRows& rows) {
    int const pitch = side + 3;
    std::vector<std::uint16_t> indices(grid.size(), 0);
    std::vector<unsigned char> isKnown(grid.size(), 0);
    numSources = 0;
    for (std::size_t i = 0; i < grid.size(); ++i) {
        if (!grid[i].IsFound()) continue;
        indices[i] = LocalIndex(static_cast<std::size_t>(numSources++));
        isKnown[i] = 1;
    }
    int numPoints = numSources;
    auto const mirror = [&](int target, int at, int inside) {
        auto const t = static_cast<std::size_t>(target), a = static_cast<std::size_t>(at),
                   b = static_cast<std::size_t>(inside);
        if (isKnown[t] || !isKnown[a] || !isKnown[b]) return;
        AppendTerm(rows, indices[a], 2);
        AppendTerm(rows, indices[b], -1);
        EndRow(rows);
        indices[t] = LocalIndex(static_cast<std::size_t>(numPoints++));
        isKnown[t] = 1;
    };
    for (int i = 0; i < pitch; ++i) {
        if (sharpSides & 1u) mirror(i, pitch + i, 2 * pitch + i);
        if (sharpSides & 4u) mirror((pitch - 1) * pitch + i, (pitch - 2) * pitch + i, (pitch - 3) * pitch + i);
    }
    for (int i = 0; i < pitch; ++i) {
        if (sharpSides & 8u) mirror(i * pitch, i * pitch + 1, i * pitch + 2);
        if (sharpSides & 2u) mirror(i * pitch + pitch - 1, i * pitch + pitch - 2, i * pitch + pitch - 3);
    }
    assert(std::find(isKnown.begin(), isKnown.end(), 0) == isKnown.end());
    return indices;
}

/// The segments of the points of a window that are written; `has(row, column)` counts in the window.
template <typename Has>
std::vector<RowSegment> findSegments(int side, Has const& has) {
    std::vector<RowSegment> segments;
    for (int row = 0; row <= side; ++row) {
        for (int column = 0; column <= side; ++column) {
            if (!has(row, column)) continue;
            int const first = column;
            while (column < side && has(row, column + 1)) ++column;
            segments.push_back({static_cast<std::uint8_t>(row), static_cast<std::uint8_t>(first),
                                static_cast<std::uint8_t>(column - first + 1)});
        }
    }
    return segments;
}

int countPoints(std::vector<RowSegment> const& segments) {
    int count = 0;
    for (RowSegment const& segment : segments) count += segment.count;
    return count;
}

}  // namespace

int TileCompiler::addPlan(std::vector<RowSegment> const& segments) {
    std::uint64_t const hash = HashOf(segments.data(), segments.size() * sizeof(RowSegment));
    auto const isSame = [&](int plan) {
        auto const p = static_cast<std::size_t>(plan);
        return _dictionary.plans[p].numSegments == static_cast<int>(segments.size()) &&
               (segments.empty() || std::memcmp(_dictionary.segments.data() + _planOffsets[p], segments.data(),
                                                segments.size() * sizeof(RowSegment)) == 0);
    };
    auto const [begin, end] = _planOfHash.equal_range(hash);
    for (auto it = begin; it != end; ++it) {
        if (isSame(it->second)) return it->second;
    }
    RowPlan plan{};
    plan.numSegments = static_cast<int>(segments.size());
    plan.numPoints = countPoints(segments);
    plan.firstColumn = kLeafSide;
    for (RowSegment const& segment : segments) {
        plan.firstColumn = std::min<int>(plan.firstColumn, segment.first);
        plan.lastColumn = std::max<int>(plan.lastColumn, segment.first + segment.count - 1);
    }
    int const added = static_cast<int>(_dictionary.plans.size());
    _planOffsets.push_back(_dictionary.segments.size());
    _dictionary.segments.insert(_dictionary.segments.end(), segments.begin(), segments.end());
    _dictionary.plans.push_back(plan);
    _planOfHash.emplace(hash, added);
    return added;
}

void TileCompiler::useBases(int k, int q) {
    auto const makeWindows = [](auto& list, int exponent, auto const& make) {
        auto const e = static_cast<std::size_t>(exponent);
        if (list.size() <= e) list.resize(e + 1);
        if (!list[e].empty()) return;
        int const count = 1 << std::min(exponent, 4);
        for (int window = 0; window < NumWindows(exponent); ++window) {
            list[e].push_back(make(ParameterWindow{exponent, window * count, count + 1}));
        }
    };
    makeWindows(_dictionary.bases.limits, k, MakeFaceBasis);
    if (_contents.positions == PositionKind::Refined) {
        makeWindows(_dictionary.bases.positions, k, MakeRefinedFaceBasis);
    }
    if (q == 0) return;
    int const inFace = k - q, grid = std::min(k, 4) - inFace;
    if (grid <= 0) {
        makeWindows(_dictionary.bases.limits, inFace, MakeFaceBasis);
        return;
    }
    auto& grids = _dictionary.bases.grids;
    auto const g = static_cast<std::size_t>(grid), f = static_cast<std::size_t>(inFace);
    if (grids.size() <= g) grids.resize(g + 1);
    while (grids[g].size() <= f) grids[g].push_back(MakeGridBasis(1 << grid, static_cast<int>(grids[g].size())));
}

MadeClass TileCompiler::makeSpline(std::vector<FaceCorner> const& points, std::vector<FaceCorner> const& normals,
                                   int k, int q, unsigned sharpSides, TileOwnership const& own) {
    MadeClass result;
    result.field.sharpSides = sharpSides;
    TileClass& made = result.tileClass;
    made.kind = TileKind::Spline;
    made.k = static_cast<std::uint8_t>(k);
    made.numNormalLevels = static_cast<std::uint8_t>(q);
    made.pointIndices = extrapolate(points, 1, sharpSides, made.numSources, made.pointRows);
    if (!normals.empty()) {
        made.normalIndices = extrapolate(normals, 1 << q, sharpSides, made.numNormalSources, made.normalRows);
    }
    int const windows = NumWindows(k), side = 1 << std::min(k, 4);
    for (int row = 0; row < windows; ++row) {
        for (int column = 0; column < windows; ++column) {
            // Between windows the one before writes.
            auto const has = [&](int r, int c) {
                if ((r == 0 && row > 0) || (c == 0 && column > 0)) return false;
                return own.Has(row * side + r, column * side + c, k, true);
            };
            made.plans.push_back(addPlan(findSegments(side, has)));
            made.numPoints += _dictionary.plans[static_cast<std::size_t>(made.plans.back())].numPoints;
        }
    }
    made.numLeaves = windows * windows;
    useBases(k, made.normalIndices.empty() ? 0 : q);
    return result;
}

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
