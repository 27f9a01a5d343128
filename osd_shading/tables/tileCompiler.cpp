// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/tables/tileCompiler.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <string>
#include <utility>

#include "osd_shading/errors.h"
#include "osd_shading/limitFrames.h"
#include "osd_shading/tables/splineBasis.h"

namespace osd_shading {
inline namespace v1 {
namespace tables {

namespace {

using Row = std::vector<std::pair<int, double>>;

/// The largest k of an irregular tile that is a matrix: larger ones split.
constexpr int kLargestDense = 2;
/// The same of a regular triangle, whose matrix all share.
constexpr int kLargestDenseTriangle = 4;
/// The same where small tiles can't be made from meshes of their own: what a leaf holds.
constexpr int kLargestWhole = 4;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// Adds rows up, one term per source.
class RowSum {
public:
    explicit RowSum(std::size_t numSources) : _weights(numSources, 0), _isUsed(numSources, 0) {}

    void Add(int source, double weight) {
        auto const i = static_cast<std::size_t>(source);
        if (!std::exchange(_isUsed[i], 1)) _used.push_back(source);
        _weights[i] += weight;
    }
    void Add(Row const& row, double weight) {
        for (auto const& [source, w] : row) Add(source, weight * w);
    }
    /// The sum, and back to zero.
    Row Take() {
        std::sort(_used.begin(), _used.end());
        Row row;
        for (int const source : _used) {
            auto const i = static_cast<std::size_t>(source);
            if (_weights[i] != 0) row.emplace_back(source, _weights[i]);
            _weights[i] = 0;
            _isUsed[i] = 0;
        }
        _used.clear();
        return row;
    }

private:
    std::vector<double> _weights;
    std::vector<unsigned char> _isUsed;
    std::vector<int> _used;
};

/// Rows over the sources of a first level, for those elements of the last level that `last` names.
///
/// `termsOf(level, element, terms)` gives an element's terms over the elements of the level before.
template <typename TermsOf>
std::vector<Row> refineRows(int firstLevel, int lastLevel, std::vector<std::size_t> const& numElements,
                            std::vector<int> const& last, TermsOf const& termsOf) {
    // What each level needs of the one before.
    std::vector<std::vector<Row>> terms(numElements.size());
    std::vector<std::vector<int>> needed(numElements.size());
    needed[static_cast<std::size_t>(lastLevel)] = last;
    for (int level = lastLevel; level > firstLevel; --level) {
        auto const l = static_cast<std::size_t>(level);
        std::vector<unsigned char> isNeeded(numElements[l - 1], 0);
        terms[l].resize(needed[l].size());
        for (std::size_t i = 0; i < needed[l].size(); ++i) {
            termsOf(level, needed[l][i], terms[l][i]);
            for (auto const& [source, weight] : terms[l][i]) isNeeded[static_cast<std::size_t>(source)] = 1;
        }
        for (std::size_t i = 0; i < isNeeded.size(); ++i) {
            if (isNeeded[i]) needed[l - 1].push_back(static_cast<int>(i));
        }
    }

    auto const first = static_cast<std::size_t>(firstLevel);
    std::vector<Row> rows(numElements[first]);
    for (int const element : needed[first]) rows[static_cast<std::size_t>(element)] = {{element, 1.0}};
    RowSum sum(numElements[first]);
    for (std::size_t l = first + 1; l <= static_cast<std::size_t>(lastLevel); ++l) {
        std::vector<Row> next(numElements[l]);
        for (std::size_t i = 0; i < needed[l].size(); ++i) {
            for (auto const& [source, weight] : terms[l][i])
                sum.Add(rows[static_cast<std::size_t>(source)], weight);
            next[static_cast<std::size_t>(needed[l][i])] = sum.Take();
        }
        rows.swap(next);
    }
    return rows;
}

std::uint16_t localIndex(std::size_t index) {
    if (index > 65535) {
        throw MemoryLimitExceeded(
            "a face's neighbourhood has more than 65535 points: tables take memory with the square of a vertex's "
            "number of faces; use ShadeSubdivision for this mesh",
            std::uint64_t{65536} * 65536 * sizeof(int));
    }
    return static_cast<std::uint16_t>(index);
}

void appendRow(LocalRows& rows, Row const& terms) {
    for (auto const& [source, weight] : terms) {
        rows.sources.push_back(localIndex(static_cast<std::size_t>(source)));
        rows.weights.push_back(static_cast<float>(weight));
    }
    rows.offsets.push_back(static_cast<std::uint32_t>(rows.sources.size()));
}

NormalLocator locate(RefinedTopology const& topology, int level, FaceCorner const& at) {
    return {FindFacePath(topology, level, at.face, 0), at.corner};
}

/// The corner that `locator` names round the ring `ring` of a face of `level`.
FaceCorner find(RefinedTopology const& topology, int level, TileRing const& ring, NormalLocator const& locator) {
    auto const f = static_cast<std::size_t>(locator.path.face);
    int const size = ring.faceSizes[f], first = ring.firstCorners[f];
    FacePath path = locator.path;
    path.face = ring.faces[f];
    int corner = locator.corner;
    bool const isNgon = size != (topology.IsCatmark() ? 4 : 3);
    auto const turn = [&](int& i) {
        if (i < size) i = (i + first) % size;  // a triangle's child 3 is its middle, but turned
    };
    if (!path.children.empty() && isNgon) {
        turn(path.children[0]);  // its children are turned no further
    } else {
        for (int& child : path.children) turn(child);
        turn(corner);
    }
    return {FollowFacePath(topology, level, path), corner};
}

std::uint64_t hashOf(void const* data, std::size_t size, std::uint64_t hash = 14695981039346656037u) {
    auto const* bytes = static_cast<unsigned char const*>(data);
    for (std::size_t i = 0; i < size; ++i) hash = (hash ^ bytes[i]) * 1099511628211u;
    return hash;
}

/// Limit tangents at a point of a tile, turned so that they run along its columns (u) and rows (v), and scaled so
/// that on a regular grid they are derivatives.
class TangentRows {
public:
    TangentRows(RegionLevels& levels, LimitStep<double> const& limit, int level,
                std::vector<FaceCorner> const& grid)
        : _levels(levels),
          _limit(limit),
          _level(level),
          _grid(grid),
          _isCatmark(levels.Topology().IsCatmark()),
          _side(static_cast<int>(std::lround(std::sqrt(static_cast<double>(grid.size())))) - 1) {}

    /// The frame of the value at a point, from which `tangent1` and `tangent2` are turned.
    LimitFrame<double> Find(int row, int column) {
        FaceCorner const at = _grid[index(row, column)];
        FindLimitFrames(_limit, VertexAt(_levels.Level(_level), at), _frames);
        int const value = _levels.ValueAt(_level, at);
        auto const found = std::find_if(_frames.begin(), _frames.end(),
                                        [&](auto const& candidate) { return candidate.value == value; });
        assert(found != _frames.end());
        LimitFrame<double> frame = std::move(*found);
        if (!frame.isAverage) orient(row, column, frame);
        return frame;
    }

private:
    std::size_t index(int row, int column) const { return static_cast<std::size_t>(row * (_side + 1) + column); }

    void orient(int row, int column, LimitFrame<double>& frame) const {
        constexpr double kPi = 3.14159265358979323846;
        Far::TopologyLevel const& level = _levels.Level(_level);
        RegionFan const& fan = frame.fan;
        int const vertex = frame.vertices[0], numFaces = static_cast<int>(fan.faces.size());
        VertexKind const kind = _limit.Regions().Kind(vertex);

        if (kind == VertexKind::Corner) {
            // Of one face: its two edges, as the tile sees them.
            int const corner = row == 0 && column == 0       ? 0
                               : column == _side && row == 0 ? 1
                               : row == _side && column == 0 ? (_isCatmark ? 3 : 2)
                                                             : 2;
            std::vector<double> const after = frame.tangent1, before = frame.tangent2;
            for (std::size_t i = 0; i < after.size(); ++i) {
                double const a = after[i], b = before[i];
                double u = a, v = b;
                if (_isCatmark) {
                    if (corner == 1) u = -b, v = a;
                    if (corner == 2) u = -a, v = -b;
                    if (corner == 3) u = b, v = -a;
                } else {
                    if (corner == 1) u = -b, v = a - b;
                    if (corner == 2) u = b - a, v = -a;
                }
                frame.tangent1[i] = _side * u;
                frame.tangent2[i] = _side * v;
            }
            return;
        }

        // Where the mask's directions lie: edge j of a ring at 2 pi j / n, of a fan at pi j / m.
        bool const isRing = kind <= VertexKind::Dart;
        int const numEdges = isRing ? numFaces : numFaces + 1;
        double const step = (isRing ? 2 * kPi : kPi) / numFaces;
        auto const farEnd = [&](int j) {
            int const face = fan.faces[static_cast<std::size_t>(j < numFaces ? j : j - 1)];
            int const corner = fan.corners[static_cast<std::size_t>(j < numFaces ? j : j - 1)];
            Far::ConstIndexArray const vertices = level.GetFaceVertices(face);
            int const size = vertices.size();
            return vertices[(corner + (j < numFaces ? 1 : size - 1)) % size];
        };
        auto const angleTo = [&](int toRow, int toColumn) {
            int const neighbor = VertexAt(level, _grid[index(toRow, toColumn)]);
            for (int j = 0; j < numEdges; ++j) {
                if (farEnd(j) == neighbor) return step * j;
            }
            return 0.0;  // a vertex met twice round its own ring: any direction will do
        };
        bool const hasNext = column < _side && (_isCatmark || row + column < _side);
        double const u = hasNext      ? angleTo(row, column + 1)
                         : column > 0 ? angleTo(row, column - 1) + kPi
                                      : angleTo(row - 1, column + 1) + kPi / 3;
        bool const isRegularTriangle = !_isCatmark && numFaces == (isRing ? 6 : 3);
        double const v = u + (isRegularTriangle ? kPi / 3 : kPi / 2);

        // The lengths that the mask gives an even layout of edges of length 1.
        double length1 = 0, length2 = 0;
        auto const measure = [&](std::size_t term, double x, double y) {
            length1 += frame.tangent1[term] * x;
            length2 += frame.tangent2[term] * y;
        };
        std::size_t term = 1;
        for (int j = 0; _isCatmark && j < numFaces; ++j, ++term) {
            measure(term, std::cos(step * j) + std::cos(step * (j + 1)),
                    std::sin(step * j) + std::sin(step * (j + 1)));
        }
        for (int j = 0; j < numEdges; ++j, ++term) measure(term, std::cos(step * j), std::sin(step * j));
        constexpr double kTiny = 1e-9;
        double const scale1 = _side / (std::fabs(length1) > kTiny ? length1 : 1);
        double const scale2 = _side / (std::fabs(length2) > kTiny ? length2 : 1);
        for (std::size_t i = 0; i < frame.tangent1.size(); ++i) {
            double const t1 = scale1 * frame.tangent1[i], t2 = scale2 * frame.tangent2[i];
            frame.tangent1[i] = std::cos(u) * t1 + std::sin(u) * t2;
            frame.tangent2[i] = std::cos(v) * t1 + std::sin(v) * t2;
        }
    }

    RegionLevels& _levels;
    LimitStep<double> const& _limit;
    int _level;
    std::vector<FaceCorner> const& _grid;
    bool _isCatmark;
    int _side;
    std::vector<LimitFrame<double>> _frames;
};

}  // namespace

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

std::size_t TileDictionary::NumBytes() const {
    auto const bytesOf = [](auto const& v) { return v.capacity() * sizeof(v[0]); };
    auto const bytesOfRows = [&](LocalRows const& rows) {
        return bytesOf(rows.offsets) + bytesOf(rows.sources) + bytesOf(rows.weights);
    };
    std::size_t bytes =
        bytesOf(classes) + bytesOf(matrices) + bytesOf(weights) + bytesOf(plans) + bytesOf(segments);
    for (TileClass const& c : classes) {
        bytes += bytesOfRows(c.pointRows) + bytesOfRows(c.normalRows) + bytesOf(c.ringVertices) +
                 bytesOf(c.pointIndices) + bytesOf(c.normalIndices) + bytesOf(c.plans) + bytesOf(c.gridPoints) +
                 bytesOf(c.children) + bytesOf(c.normalLocators) + bytesOf(c.averages.normals) +
                 bytesOf(c.averages.faces) + bytesOf(c.averages.offsets) + bytesOf(c.averages.sources) +
                 bytesOf(c.averages.weights);
        for (ChildTile const& child : c.children)
            bytes += bytesOf(child.pointIndices) + bytesOf(child.normalIndices);
        for (NormalLocator const& locator : c.normalLocators) bytes += bytesOf(locator.path.children);
    }
    for (auto const* list : {&bases.limits, &bases.positions, &bases.grids}) {
        for (auto const& windows : *list) bytes += bytesOf(windows);
    }
    return bytes;
}

std::size_t TileCompiler::KeyHash::operator()(std::vector<std::int32_t> const& key) const {
    return static_cast<std::size_t>(hashOf(key.data(), key.size() * sizeof key[0]));
}

std::optional<unsigned> TileCompiler::findSharpSides(RegionLevels& levels, int levelIndex, int face, int k) const {
    Far::TopologyLevel const& level = levels.Level(levelIndex);
    Far::ConstIndexArray const vertices = level.GetFaceVertices(face), edges = level.GetFaceEdges(face);
    if (vertices.size() != 4) return std::nullopt;
    bool const isUniform = _contents.rules.creasing == Sdc::Options::CREASE_UNIFORM;
    auto const stays = [&](int edge) { return StaysSharp(level.GetEdgeSharpness(edge), k, isUniform); };

    CreaseRegions const& regions = levels.Regions(levelIndex);
    unsigned sides = 0;
    for (int i = 0; i < 4; ++i) {
        if (!IsSharpEdge(level, edges[i])) continue;
        if (!stays(edges[i])) return std::nullopt;
        sides |= 1u << i;
    }
    for (int i = 0; i < 4; ++i) {
        int const v = vertices[i];
        if (level.IsVertexNonManifold(v)) return std::nullopt;
        Far::ConstIndexArray const faces = level.GetVertexFaces(v);
        if (levels.Topology().HasIrregularFaces(levelIndex)) {
            for (int const f : faces) {
                if (level.GetFaceVertices(f).size() != 4) return std::nullopt;
            }
        }
        bool const isAfter = (sides & (1u << i)) != 0, isBefore = (sides & (1u << ((i + 3) % 4))) != 0;
        VertexKind const kind = regions.Kind(v);
        if (!isAfter && !isBefore) {
            if (kind != VertexKind::Smooth || level.IsVertexBoundary(v) || faces.size() != 4) return std::nullopt;
            continue;
        }
        // A sharp vertex must stay what it is, and its region have the regular number of faces.
        bool const isCorner = isAfter && isBefore;
        if (kind != (isCorner ? VertexKind::Corner : VertexKind::Crease)) return std::nullopt;
        Far::ConstIndexArray const around = level.GetVertexEdges(v);
        int numStaying = 0;
        for (int const edge : around) {
            if (!IsSharpEdge(level, edge)) continue;
            if (!stays(edge)) return std::nullopt;
            ++numStaying;
        }
        if (isCorner && numStaying < 3 && !StaysSharp(level.GetVertexSharpness(v), k, isUniform))
            return std::nullopt;
        Far::ConstLocalIndexArray const corners = level.GetVertexFaceLocalIndices(v);
        int const value = regions.CornerValue(face, i);
        int numFaces = 0;
        for (int j = 0; j < faces.size(); ++j) numFaces += regions.CornerValue(faces[j], corners[j]) == value;
        if (numFaces != (isCorner ? 1 : 2)) return std::nullopt;
    }
    return sides;
}

bool TileCompiler::isRegularTriangle(RegionLevels& levels, int levelIndex, int face) const {
    Far::TopologyLevel const& level = levels.Level(levelIndex);
    for (int const v : level.GetFaceVertices(face)) {
        if (level.IsVertexNonManifold(v) || level.IsVertexBoundary(v) || level.GetVertexFaces(v).size() != 6 ||
            levels.Regions(levelIndex).Kind(v) != VertexKind::Smooth) {
            return false;
        }
    }
    return true;
}

CompiledTile TileCompiler::Compile(RegionLevels& levels, int level, int face, int k, int q,
                                   TileOwnership const& own) {
    if (isCatmark() && _contents.normals == LimitNormalKind::Limit) {
        if (auto const sides = findSharpSides(levels, level, face, k)) {
            return compileSpline(levels, level, face, k, q, *sides, own);
        }
    }

    // The same neighbourhood may be seen from any corner: take the one with the smallest key.
    int const size = static_cast<int>(own.corners.size());
    bool const isRegular = !isCatmark() && isRegularTriangle(levels, level, face);
    CompiledTile tile;
    TileRing ring;
    std::vector<std::int32_t> key;
    constexpr int kMostRotations = 8;
    for (int rotation = 0; rotation < (size <= kMostRotations ? size : 1); ++rotation) {
        TileRing candidate = levels.Rings(level).Find(face, rotation, k);
        std::vector<std::int32_t> candidateKey{1, k, q};
        candidate.AppendKey(candidateKey);
        own.Rotated(rotation).AppendKey(candidateKey);
        if (rotation == 0 || candidateKey < key) {
            key.swap(candidateKey);
            ring = std::move(candidate);
            tile.rotation = rotation;
        }
        if (ring.isInLevelOrder) break;
    }

    auto const known = _classOfKey.find(key);
    if (known != _classOfKey.end()) {
        tile.tileClass = known->second;
    } else {
        int const largest = isRegular && q <= 1 ? kLargestDenseTriangle : kLargestDense;
        bool const isNgon = isCatmark() && size != 4;
        TileOwnership const turned = own.Rotated(tile.rotation);
        TileClass made;
        if (isNgon || k > largest) {
            made = makeSplit(ring, k, q, turned);
        } else {
            RefinedTopology const topology(ring.Mesh(_contents.rules), k);
            RegionLevels ringLevels(topology);
            made = makeDense(ringLevels, 0, ring.tileFace, k, q, turned, false);
        }
        tile.tileClass = static_cast<int>(_dictionary.classes.size());
        _dictionary.classes.push_back(std::move(made));
        _classOfKey.emplace(std::move(key), tile.tileClass);
    }

    TileClass const& tileClass = _dictionary.classes[static_cast<std::size_t>(tile.tileClass)];
    for (auto const v : tileClass.ringVertices) tile.vertices.push_back(ring.vertices[v]);
    for (NormalLocator const& locator : tileClass.normalLocators) {
        tile.normals.push_back(find(levels.Topology(), level, ring, locator));
    }
    return tile;
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
        tile.tileClass = static_cast<int>(_dictionary.classes.size());
        _dictionary.classes.push_back(makeSpline(points, normals, k, q, sharpSides, own));
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
        indices[i] = localIndex(static_cast<std::size_t>(numSources++));
        isKnown[i] = 1;
    }
    int numPoints = numSources;
    auto const mirror = [&](int target, int at, int inside) {
        auto const t = static_cast<std::size_t>(target), a = static_cast<std::size_t>(at),
                   b = static_cast<std::size_t>(inside);
        if (isKnown[t] || !isKnown[a] || !isKnown[b]) return;
        appendRow(rows, {{indices[a], 2.0}, {indices[b], -1.0}});
        indices[t] = localIndex(static_cast<std::size_t>(numPoints++));
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
    std::uint64_t const hash = hashOf(segments.data(), segments.size() * sizeof(RowSegment));
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
    int const index = static_cast<int>(_dictionary.plans.size());
    _planOffsets.push_back(_dictionary.segments.size());
    _dictionary.segments.insert(_dictionary.segments.end(), segments.begin(), segments.end());
    _dictionary.plans.push_back(plan);
    _planOfHash.emplace(hash, index);
    return index;
}

int TileCompiler::addMatrix(int numPoints, int numFields, std::vector<Row> const& rows,
                            std::vector<std::uint16_t>& columns) {
    // Columns: the sources that any row names.
    std::vector<int> used;
    for (Row const& row : rows) {
        for (auto const& [source, weight] : row) used.push_back(source);
    }
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    columns.clear();
    for (int const source : used) columns.push_back(localIndex(static_cast<std::size_t>(source)));

    int const numBlocks = (numPoints + kDenseBlock - 1) / kDenseBlock, numColumns = static_cast<int>(used.size());
    std::vector<WeightLine> lines(static_cast<std::size_t>(numBlocks * numColumns * numFields));
    for (WeightLine& line : lines) std::fill(std::begin(line.v), std::end(line.v), 0.0f);
    for (int point = 0; point < numPoints; ++point) {
        for (int field = 0; field < numFields; ++field) {
            for (auto const& [source, weight] : rows[static_cast<std::size_t>(point * numFields + field)]) {
                auto const column = std::lower_bound(used.begin(), used.end(), source) - used.begin();
                auto const line = static_cast<std::size_t>(
                    ((point / kDenseBlock) * numColumns + static_cast<int>(column)) * numFields + field);
                lines[line].v[point % kDenseBlock] = static_cast<float>(weight);
            }
        }
    }

    std::uint64_t const hash = hashOf(lines.data(), lines.size() * sizeof(WeightLine));
    auto const [begin, end] = _matrixOfHash.equal_range(hash);
    for (auto it = begin; it != end; ++it) {
        auto const m = static_cast<std::size_t>(it->second);
        DenseMatrix const& other = _dictionary.matrices[m];
        if (other.numPoints == numPoints && other.numColumns == numColumns && other.numFields == numFields &&
            (lines.empty() || std::memcmp(_dictionary.weights.data() + _weightOffsets[m], lines.data(),
                                          lines.size() * sizeof(WeightLine)) == 0)) {
            return it->second;
        }
    }
    int const index = static_cast<int>(_dictionary.matrices.size());
    _weightOffsets.push_back(_dictionary.weights.size());
    _dictionary.weights.insert(_dictionary.weights.end(), lines.begin(), lines.end());
    _dictionary.matrices.push_back({numPoints, numColumns, numFields, nullptr});
    _matrixOfHash.emplace(hash, index);
    return index;
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

TileClass TileCompiler::makeSpline(std::vector<FaceCorner> const& points, std::vector<FaceCorner> const& normals,
                                   int k, int q, unsigned sharpSides, TileOwnership const& own) {
    TileClass made;
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
    return made;
}

TileClass TileCompiler::makeSplit(TileRing const& ring, int k, int q, TileOwnership const& own) {
    int const numLevels = std::max(1, q);
    RefinedTopology const topology(ring.Mesh(_contents.rules), numLevels);
    RegionLevels levels(topology);
    Far::TopologyLevel const& base = levels.Level(0);
    int const normalLevel = std::max(1, q);  // where the children's normals are found
    Far::ConstIndexArray const childFaces = base.GetFaceChildFaces(ring.tileFace);

    // A mesh made anew from the next level is refined as that level was: but not at non-manifold creases, whose
    // vertices OpenSubdiv would make corners.
    bool const isAsRefined = std::all_of(childFaces.begin(), childFaces.end(),
                                         [&](int child) { return IsRefinedAlike(levels, 1, child); });
    if (!isAsRefined) {
        RefinedTopology const all(ring.Mesh(_contents.rules), k);
        RegionLevels allLevels(all);
        TileClass whole = makeWhole(allLevels, 0, ring.tileFace, k, q, own);
        for (int v = 0; v < ring.numVertices; ++v) whole.ringVertices.push_back(localIndex(index(v)));
        if (_contents.hasSubdividedNormals) {
            Far::TopologyLevel const& start = allLevels.Level(q);
            whole.normalLocators.resize(index(whole.numNormalSources));
            for (int f = 0; f < start.GetNumFaces(); ++f) {
                for (int corner = 0; corner < start.GetFaceVertices(f).size(); ++corner) {
                    NormalLocator& locator = whole.normalLocators[index(allLevels.ValueAt(q, {f, corner}))];
                    if (locator.path.face < 0) locator = locate(all, q, {f, corner});
                }
            }
        }
        return whole;
    }

    TileClass made;
    made.kind = TileKind::Split;
    made.size = static_cast<int>(own.corners.size());
    made.k = static_cast<std::uint8_t>(k);
    made.numNormalLevels = static_cast<std::uint8_t>(q);
    made.isNgon = isCatmark() && own.corners.size() != 4;

    // The children, and what they need of the next level.
    std::vector<CompiledTile> children;
    std::vector<unsigned char> needsVertex(static_cast<std::size_t>(levels.Level(1).GetNumVertices()), 0);
    std::vector<int> valueVertex;  // of the children's level, by needed value; -1: not needed
    if (_contents.hasSubdividedNormals) {
        valueVertex.assign(static_cast<std::size_t>(levels.Regions(normalLevel).NumValues()), -1);
    }
    std::vector<FaceCorner> cornerOfValue(valueVertex.size());
    for (int i = 0; i < childFaces.size(); ++i) {
        CompiledTile child =
            Compile(levels, 1, childFaces[i], k - 1, std::max(0, q - 1), own.OfChild(i, k, isCatmark()));
        for (int const v : child.vertices) needsVertex[static_cast<std::size_t>(v)] = 1;
        for (FaceCorner const& at : child.normals) {
            auto const value = static_cast<std::size_t>(levels.ValueAt(normalLevel, at));
            valueVertex[value] = VertexAt(levels.Level(normalLevel), at);
            if (!cornerOfValue[value].IsFound()) cornerOfValue[value] = at;
        }
        TileClass const& childClass = _dictionary.classes[static_cast<std::size_t>(child.tileClass)];
        made.numPoints += childClass.numPoints;
        made.numLeaves += childClass.numLeaves;
        children.push_back(std::move(child));
    }

    // Their points: face points first, other masks refer to them.
    LevelMasks<double> const masks = topology.RecordMasks<double>(1);
    int const firstFaceChild = topology.FirstFaceChild(0);
    auto const termsOf = [&](int vertex, auto const& visit) {
        auto const row = static_cast<std::size_t>(masks.Row(vertex));
        for (auto t = static_cast<std::size_t>(masks.offsets[row]);
             t < static_cast<std::size_t>(masks.offsets[row + 1]); ++t) {
            visit(masks.terms[t], masks.weights[t]);
        }
    };
    for (int v = 0; v < levels.Level(1).GetNumVertices(); ++v) {
        if (!needsVertex[static_cast<std::size_t>(v)]) continue;
        termsOf(v, [&](int term, double) {
            if (term < 0) needsVertex[static_cast<std::size_t>(~term)] = 1;
        });
    }
    std::vector<unsigned char> usesVertex(static_cast<std::size_t>(base.GetNumVertices()), 0);
    for (std::size_t v = 0; v < needsVertex.size(); ++v) {
        if (!needsVertex[v]) continue;
        termsOf(static_cast<int>(v), [&](int term, double) {
            if (term >= 0) usesVertex[static_cast<std::size_t>(term)] = 1;
        });
    }
    std::vector<int> localOfBase(usesVertex.size(), -1), localOfChild(needsVertex.size(), -1);
    for (std::size_t v = 0; v < usesVertex.size(); ++v) {
        if (!usesVertex[v]) continue;
        localOfBase[v] = made.numSources++;
        made.ringVertices.push_back(localIndex(v));
    }
    auto const addPoints = [&](int first, int last) {
        for (int v = first; v < last; ++v) {
            if (!needsVertex[static_cast<std::size_t>(v)]) continue;
            Row row;
            termsOf(v, [&](int term, double weight) {
                row.emplace_back(term >= 0 ? localOfBase[static_cast<std::size_t>(term)]
                                           : localOfChild[static_cast<std::size_t>(~term)],
                                 weight);
            });
            localOfChild[static_cast<std::size_t>(v)] = made.numSources + made.pointRows.NumRows();
            appendRow(made.pointRows, row);
        }
    };
    addPoints(firstFaceChild, firstFaceChild + masks.numFaceChildren);
    addPoints(0, firstFaceChild);
    addPoints(firstFaceChild + masks.numFaceChildren, levels.Level(1).GetNumVertices());

    // Their normals: sources themselves where they start further down, refined by region where they have started.
    std::vector<int> localOfValue(valueVertex.size(), -1);
    if (_contents.hasSubdividedNormals && q > 0) {
        for (std::size_t value = 0; value < valueVertex.size(); ++value) {
            if (valueVertex[value] < 0) continue;
            localOfValue[value] = made.numNormalSources++;
            made.normalLocators.push_back(locate(topology, normalLevel, cornerOfValue[value]));
        }
    } else if (_contents.hasSubdividedNormals) {
        FieldLevels<double> const fields(topology, 0, 1);
        CreaseRegions const& regions = levels.Regions(0);
        std::vector<Row> rows(valueVertex.size());
        std::vector<int> localOfSource(static_cast<std::size_t>(regions.NumValues()), -1);
        RowSum sum(localOfSource.size());
        for (std::size_t value = 0; value < valueVertex.size(); ++value) {
            if (valueVertex[value] < 0) continue;
            Row terms;
            fields.Step(1).AppendTerms(valueVertex[value], static_cast<int>(value), terms);
            sum.Add(terms, 1);
            rows[value] = sum.Take();
            for (auto const& [source, weight] : rows[value]) localOfSource[static_cast<std::size_t>(source)] = 0;
        }
        std::vector<unsigned char> isLocated(localOfSource.size(), 0);
        for (int f = 0; f < base.GetNumFaces(); ++f) {
            for (int corner = 0; corner < base.GetFaceVertices(f).size(); ++corner) {
                auto const source = static_cast<std::size_t>(regions.CornerValue(f, corner));
                if (localOfSource[source] < 0 || std::exchange(isLocated[source], 1)) continue;
                localOfSource[source] = made.numNormalSources++;
                made.normalLocators.push_back(locate(topology, 0, {f, corner}));
            }
        }
        for (std::size_t value = 0; value < valueVertex.size(); ++value) {
            if (valueVertex[value] < 0) continue;
            for (auto& term : rows[value]) term.first = localOfSource[static_cast<std::size_t>(term.first)];
            localOfValue[value] = made.numNormalSources + made.normalRows.NumRows();
            appendRow(made.normalRows, rows[value]);
        }
    }

    for (CompiledTile const& child : children) {
        ChildTile entry;
        entry.tileClass = child.tileClass;
        entry.rotation = child.rotation;
        for (int const v : child.vertices) {
            entry.pointIndices.push_back(
                localIndex(static_cast<std::size_t>(localOfChild[static_cast<std::size_t>(v)])));
        }
        for (FaceCorner const& at : child.normals) {
            auto const value = static_cast<std::size_t>(levels.ValueAt(normalLevel, at));
            entry.normalIndices.push_back(localIndex(static_cast<std::size_t>(localOfValue[value])));
        }
        made.children.push_back(std::move(entry));
    }
    return made;
}

TileClass TileCompiler::makeWhole(RegionLevels& levels, int level, int face, int k, int q,
                                  TileOwnership const& own) {
    bool const isNgon = isCatmark() && own.corners.size() != 4;
    if (k <= kLargestWhole && !isNgon) return makeDense(levels, level, face, k, q, own, true);
    TileClass made;
    made.kind = TileKind::Split;
    made.k = static_cast<std::uint8_t>(k);
    made.numNormalLevels = static_cast<std::uint8_t>(q);
    made.isNgon = isNgon;
    made.size = static_cast<int>(own.corners.size());
    made.numSources = levels.Level(0).GetNumVertices();
    made.numNormalSources = _contents.hasSubdividedNormals ? levels.Regions(q).NumValues() : 0;
    Far::ConstIndexArray const childFaces = levels.Level(level).GetFaceChildFaces(face);
    for (int i = 0; i < childFaces.size(); ++i) {
        TileClass child = makeWhole(levels, level + 1, childFaces[i], k - 1, q, own.OfChild(i, k, isCatmark()));
        made.numPoints += child.numPoints;
        made.numLeaves += child.numLeaves;
        ChildTile entry;
        entry.tileClass = static_cast<int>(_dictionary.classes.size());
        for (int j = 0; j < made.numSources; ++j) entry.pointIndices.push_back(localIndex(index(j)));
        for (int j = 0; j < made.numNormalSources; ++j) entry.normalIndices.push_back(localIndex(index(j)));
        _dictionary.classes.push_back(std::move(child));
        made.children.push_back(std::move(entry));
    }
    return made;
}

TileClass TileCompiler::makeDense(RegionLevels& levels, int tileLevel, int face, int k, int q,
                                  TileOwnership const& own, bool takesAll) {
    RefinedTopology const& topology = levels.Topology();
    int const lastLevel = tileLevel + k;
    Far::TopologyLevel const& last = levels.Level(lastLevel);
    FieldLevels<double> const fields(topology, 0, 1);
    LimitStep<double> const limit(topology, lastLevel, fields.Regions(lastLevel), 1);
    std::vector<FaceCorner> const grid = FindFaceGrid(topology, tileLevel, face, lastLevel);
    int const side = 1 << k;

    TileClass made;
    made.kind = TileKind::Dense;
    made.k = static_cast<std::uint8_t>(k);
    made.numNormalLevels = static_cast<std::uint8_t>(q);
    made.numLeaves = 1;
    made.size = static_cast<int>(own.corners.size());

    // The points that it writes, and the rows of each over vertices and values of the last level.
    struct Point {
        Row position, tangent1, tangent2, normal;
    };
    std::vector<Point> points;
    std::vector<unsigned char> needsVertex(static_cast<std::size_t>(last.GetNumVertices()), 0);
    std::vector<int> averageVertices;
    bool const isAverageOnly = _contents.normals == LimitNormalKind::FaceAverage;
    if (isAverageOnly) made.averages.weight = _contents.faceWeight;
    TangentRows tangents(levels, limit, lastLevel, grid);
    for (int row = 0; row <= side; ++row) {
        for (int column = 0; column <= side; ++column) {
            if ((!isCatmark() && row + column > side) || !own.Has(row, column, k, isCatmark())) continue;
            FaceCorner const at = grid[static_cast<std::size_t>(row * (side + 1) + column)];
            int const v = VertexAt(last, at);
            Point point;
            if (_contents.positions == PositionKind::Limit) {
                limit.AppendPointTerms(v, point.position);
            } else {
                point.position = {{v, 1.0}};
            }
            LimitFrame<double> const frame = tangents.Find(row, column);
            if (frame.isAverage || isAverageOnly) {
                made.averages.normals.push_back(
                    {static_cast<int>(points.size()), static_cast<int>(made.averages.faces.size())});
                for (std::size_t i = 0; i < frame.fan.faces.size(); ++i) {
                    Far::ConstIndexArray const vertices = last.GetFaceVertices(frame.fan.faces[i]);
                    AverageFace averaged;
                    averaged.size = vertices.size();
                    averaged.corner = frame.fan.corners[i];
                    for (int j = 0; j < averaged.size && j < 4; ++j) {
                        needsVertex[static_cast<std::size_t>(vertices[j])] = 1;
                        averaged.rows[j] = vertices[j];  // numbered below
                    }
                    // A face of other size is met at level 0 only, where limits need quads.
                    assert(averaged.size <= 4);
                    made.averages.faces.push_back(averaged);
                }
            } else {
                for (std::size_t i = 0; i < frame.vertices.size(); ++i) {
                    point.tangent1.emplace_back(frame.vertices[i], frame.tangent1[i]);
                    point.tangent2.emplace_back(frame.vertices[i], frame.tangent2[i]);
                }
            }
            if (_contents.hasSubdividedNormals) {
                limit.AppendTerms(v, fields.Regions(lastLevel).CornerValue(at.face, at.corner), point.normal);
            }
            for (Row const* terms : {&point.position, &point.tangent1, &point.tangent2}) {
                for (auto const& [vertex, weight] : *terms) needsVertex[static_cast<std::size_t>(vertex)] = 1;
            }
            points.push_back(std::move(point));
            made.gridPoints.push_back(static_cast<std::uint16_t>(row * 32 + column));
        }
    }
    made.numPoints = static_cast<int>(points.size());

    // Vertices of the last level from those of the ring.
    std::vector<std::size_t> numVertices, numValues;
    for (int l = 0; l <= lastLevel; ++l) {
        numVertices.push_back(static_cast<std::size_t>(levels.Level(l).GetNumVertices()));
        numValues.push_back(static_cast<std::size_t>(fields.Regions(l).NumValues()));
    }
    std::vector<int> neededVertices;
    for (std::size_t v = 0; v < needsVertex.size(); ++v) {
        if (needsVertex[v]) neededVertices.push_back(static_cast<int>(v));
    }
    std::vector<Row> const vertexRows =
        refineRows(0, lastLevel, numVertices, neededVertices, [&](int level, int vertex, Row& terms) {
            LevelMasks<double> const& masks = fields.Masks(level);
            auto const row = static_cast<std::size_t>(masks.Row(vertex));
            int const firstFaceChild = topology.FirstFaceChild(level - 1);
            for (auto t = static_cast<std::size_t>(masks.offsets[row]);
                 t < static_cast<std::size_t>(masks.offsets[row + 1]); ++t) {
                if (masks.terms[t] >= 0) {
                    terms.emplace_back(masks.terms[t], masks.weights[t]);
                    continue;
                }
                Far::ConstIndexArray const corners =
                    levels.Level(level - 1).GetFaceVertices(~masks.terms[t] - firstFaceChild);
                for (int const corner : corners) terms.emplace_back(corner, masks.weights[t] / corners.size());
            }
        });

    std::vector<unsigned char> usesVertex(numVertices[0], takesAll);
    for (int const v : neededVertices) {
        for (auto const& [source, weight] : vertexRows[static_cast<std::size_t>(v)]) {
            usesVertex[static_cast<std::size_t>(source)] = 1;
        }
    }
    std::vector<int> localOfVertex(numVertices[0], -1);
    for (std::size_t v = 0; v < usesVertex.size(); ++v) {
        if (!usesVertex[v]) continue;
        localOfVertex[v] = made.numSources++;
        if (!takesAll) made.ringVertices.push_back(localIndex(v));
    }
    RowSum sum(static_cast<std::size_t>(made.numSources));
    auto const compose = [&](Row const& terms) {
        for (auto const& [vertex, weight] : terms) {
            for (auto const& [source, w] : vertexRows[static_cast<std::size_t>(vertex)]) {
                sum.Add(localOfVertex[static_cast<std::size_t>(source)], weight * w);
            }
        }
        return sum.Take();
    };
    std::vector<Row> frameRows;
    for (Point const& point : points) {
        frameRows.push_back(compose(point.position));
        int field = 0;
        for (Row const* terms : {&point.tangent1, &point.tangent2}) {
            frameRows.push_back(compose(*terms));
            double added = 0;
            for (auto const& [source, weight] : frameRows.back()) added += std::fabs(weight);
            made.tangentSums[field] = std::max(made.tangentSums[field], static_cast<float>(added));
            ++field;
        }
    }
    made.frameMatrix = addMatrix(made.numPoints, 3, frameRows, made.pointIndices);

    // Points of the faces whose normals are averaged.
    if (!made.averages.normals.empty()) {
        std::vector<int> rowOfVertex(numVertices.back(), -1);
        int numRows = 0;
        for (AverageFace& averaged : made.averages.faces) {
            for (int j = 0; j < averaged.size; ++j) {
                int& row = rowOfVertex[static_cast<std::size_t>(averaged.rows[j])];
                if (row < 0) {
                    row = numRows++;
                    for (auto const& [source, weight] : compose({{averaged.rows[j], 1.0}})) {
                        made.averages.sources.push_back(localIndex(static_cast<std::size_t>(source)));
                        made.averages.weights.push_back(weight);
                    }
                    made.averages.offsets.push_back(static_cast<std::uint32_t>(made.averages.sources.size()));
                }
                averaged.rows[j] = row;
            }
        }
    }

    // Normals: from values of level q.
    if (_contents.hasSubdividedNormals) {
        auto const first = static_cast<std::size_t>(q);
        std::vector<unsigned char> needsValue(numValues.back(), 0);
        for (Point const& point : points) {
            for (auto const& [value, weight] : point.normal) needsValue[static_cast<std::size_t>(value)] = 1;
        }
        std::vector<int> neededValues;
        for (std::size_t value = 0; value < needsValue.size(); ++value) {
            if (needsValue[value]) neededValues.push_back(static_cast<int>(value));
        }
        std::vector<std::vector<int>> vertexOfValue(numVertices.size());
        for (int l = q; l <= lastLevel; ++l) {
            CreaseRegions const& regions = fields.Regions(l);
            auto& list = vertexOfValue[static_cast<std::size_t>(l)];
            list.resize(numValues[static_cast<std::size_t>(l)]);
            for (int v = 0; v < regions.NumVertices(); ++v) {
                std::fill(list.begin() + regions.FirstValue(v), list.begin() + regions.FirstValue(v + 1), v);
            }
        }
        std::vector<Row> const valueRows =
            refineRows(q, lastLevel, numValues, neededValues, [&](int level, int value, Row& terms) {
                int const vertex = vertexOfValue[static_cast<std::size_t>(level)][static_cast<std::size_t>(value)];
                fields.Step(level).AppendTerms(vertex, value, terms);
            });
        std::vector<unsigned char> usesValue(numValues[first], takesAll);
        for (int const value : neededValues) {
            for (auto const& [source, weight] : valueRows[static_cast<std::size_t>(value)]) {
                usesValue[static_cast<std::size_t>(source)] = 1;
            }
        }
        std::vector<int> localOfValue(numValues[first], -1);
        Far::TopologyLevel const& startLevel = levels.Level(q);
        for (int f = 0; f < startLevel.GetNumFaces(); ++f) {
            for (int corner = 0; corner < startLevel.GetFaceVertices(f).size(); ++corner) {
                auto const value = static_cast<std::size_t>(fields.Regions(q).CornerValue(f, corner));
                if (takesAll) localOfValue[value] = static_cast<int>(value);
                if (!usesValue[value] || localOfValue[value] >= 0) continue;
                localOfValue[value] = made.numNormalSources++;
                made.normalLocators.push_back(locate(topology, q, {f, corner}));
            }
        }
        if (takesAll) made.numNormalSources = static_cast<int>(numValues[first]);
        RowSum valueSum(static_cast<std::size_t>(made.numNormalSources));
        std::vector<Row> normalRows;
        for (Point const& point : points) {
            for (auto const& [value, weight] : point.normal) {
                for (auto const& [source, w] : valueRows[static_cast<std::size_t>(value)]) {
                    valueSum.Add(localOfValue[static_cast<std::size_t>(source)], weight * w);
                }
            }
            normalRows.push_back(valueSum.Take());
        }
        made.normalMatrix = addMatrix(made.numPoints, 1, normalRows, made.normalIndices);
    }
    return made;
}

TileDictionary TileCompiler::Take() {
    TileDictionary dictionary = std::move(_dictionary);
    dictionary.classes.shrink_to_fit();
    dictionary.weights.shrink_to_fit();
    dictionary.segments.shrink_to_fit();
    for (std::size_t i = 0; i < dictionary.plans.size(); ++i) {
        dictionary.plans[i].segments = dictionary.segments.data() + _planOffsets[i];
    }
    for (std::size_t i = 0; i < dictionary.matrices.size(); ++i) {
        dictionary.matrices[i].weights =
            dictionary.weights.empty() ? nullptr : dictionary.weights[0].v + _weightOffsets[i] * kDenseBlock;
    }
    return dictionary;
}

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
