// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/tables/tileCompiler.h"

#include <algorithm>
#include <utility>

#include "osd_shading/tables/sharpSides.h"

namespace osd_shading {
inline namespace v1 {
namespace tables {

namespace {

/// The largest k of an irregular tile that is a matrix: larger ones split.
constexpr int kLargestDense = 3;
/// The same of one that few tiles use, and how many are few: the matrix of 64 points takes as much as some 15
/// bytes for each value of so many tiles.
constexpr int kLargestRare = 2, kFewUses = 12;
/// The share of compiling that counting takes, for those who wait.
constexpr double kCounting = 0.2;
/// The most neighbourhoods that are kept between counting and compiling: some kilobytes each.
constexpr std::size_t kMostRecalled = 4096;

std::uint64_t faceKey(int level, int face) {
    return static_cast<std::uint64_t>(level) << 32 | static_cast<std::uint32_t>(face);
}
/// The same of a regular triangle, whose matrix all share.
constexpr int kLargestDenseTriangle = 4;

}  // namespace

std::size_t TileDictionary::NumBytes() const {
    auto const bytesOf = [](auto const& v) { return v.capacity() * sizeof(v[0]); };
    auto const bytesOfRows = [&](LocalRows const& rows) {
        return bytesOf(rows.offsets) + bytesOf(rows.sources) + bytesOf(rows.weights);
    };
    std::size_t bytes =
        bytesOf(classes) + bytesOf(matrices) + bytesOf(weights) + bytesOf(plans) + bytesOf(segments);
    for (TileClass const& c : classes) {
        bytes += bytesOfRows(c.pointRows) + bytesOfRows(c.normalRows) + bytesOf(c.pointIndices) +
                 bytesOf(c.normalIndices) + bytesOf(c.plans) + bytesOf(c.gridPoints) + bytesOf(c.children);
        if (AverageNormals const* const averages = c.averages.get()) {
            bytes += sizeof *averages + bytesOf(averages->normals) + bytesOf(averages->faces) +
                     bytesOf(averages->offsets) + bytesOf(averages->sources) + bytesOf(averages->weights);
        }
        for (ChildTile const& child : c.children)
            bytes += bytesOf(child.pointIndices) + bytesOf(child.normalIndices);
    }
    for (auto const* list : {&bases.limits, &bases.positions, &bases.grids}) {
        for (auto const& windows : *list) bytes += bytesOf(windows);
    }
    return bytes;
}

int TileCompiler::addClass(MadeClass&& made) {
    _dictionary.classes.push_back(std::move(made.tileClass));
    _sources.push_back(std::move(made.sources));
    _fields.push_back(std::move(made.field));
    return static_cast<int>(_dictionary.classes.size()) - 1;
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

TileCompiler::Neighborhood TileCompiler::identify(RegionLevels& levels, int levelIndex, int face, int k, int q,
                                                  TileOwnership const& own) const {
    // The same neighbourhood may be seen from any corner: from that with the smallest signs, and if there are
    // several, from that which gives the smallest key.
    Far::TopologyLevel const& level = levels.Level(levelIndex);
    Far::ConstIndexArray const vertices = level.GetFaceVertices(face), edges = level.GetFaceEdges(face);
    int const size = vertices.size();
    std::vector<std::uint32_t> signs;
    for (int i = 0; i < size; ++i) {
        int const v = vertices[i];
        auto const numEdges = static_cast<std::uint32_t>(level.GetVertexEdges(v).size());
        auto const kind = static_cast<std::uint32_t>(levels.Regions(levelIndex).Kind(v));
        signs.push_back(numEdges << 8 | kind << 5 | (IsSharpEdge(level, edges[i]) ? 16u : 0u) |
                        static_cast<std::uint32_t>(own.edges[static_cast<std::size_t>(i)].Sign()) << 1 |
                        (own.corners[static_cast<std::size_t>(i)] ? 1u : 0u));
    }
    auto const isBefore = [&](int a, int b) {
        for (int i = 0; i < size; ++i) {
            auto const x = signs[static_cast<std::size_t>((a + i) % size)],
                       y = signs[static_cast<std::size_t>((b + i) % size)];
            if (x != y) return x < y;
        }
        return false;
    };
    constexpr int kMostRotations = 8;
    int const numRotations = size <= kMostRotations ? size : 1;
    int first = 0;
    for (int rotation = 1; rotation < numRotations; ++rotation) {
        if (isBefore(rotation, first)) first = rotation;
    }

    Neighborhood found;
    for (int rotation = first; rotation < numRotations; ++rotation) {
        if (isBefore(first, rotation)) continue;
        TileRing candidate = levels.Rings(levelIndex).Find(face, rotation, k);
        if (candidate.isInLevelOrder && rotation != 0) {
            // Its order is not ours to choose.
            rotation = first = 0;
            candidate = levels.Rings(levelIndex).Find(face, 0, k);
        }
        std::vector<std::int32_t> candidateKey{1, k, q};
        candidate.AppendKey(candidateKey);
        own.Rotated(rotation).AppendKey(candidateKey);
        if (rotation == first || candidateKey < found.key) {
            found.key.swap(candidateKey);
            found.ring = std::move(candidate);
            found.rotation = rotation;
        }
        if (found.ring.isInLevelOrder) break;
    }
    return found;
}

TileCompiler::Neighborhood TileCompiler::recall(RegionLevels& levels, int level, int face, int k, int q,
                                                TileOwnership const& own) {
    if (&levels == _counted) {
        auto const kept = _recalled.find(faceKey(level, face));
        if (kept != _recalled.end()) {
            Neighborhood neighborhood = std::move(kept->second);
            _recalled.erase(kept);
            return neighborhood;
        }
    }
    return identify(levels, level, face, k, q, own);
}

std::vector<TileCompiler::ChildFace> TileCompiler::findChildren(RegionLevels& levels, int level, int face,
                                                                int rotation, int k,
                                                                TileOwnership const& own) const {
    Far::ConstIndexArray const childFaces = levels.Level(level).GetFaceChildFaces(face);
    int const size = static_cast<int>(own.corners.size());
    std::vector<ChildFace> children;
    for (int i = 0; i < childFaces.size(); ++i) {
        ChildFace child;
        child.face = childFaces[i < size ? (i + rotation) % size : i];  // a triangle's last child is its middle
        child.size = isCatmark() ? 4 : 3;
        child.turned = isCatmark() && size != 4 ? 0 : rotation;
        child.own = own.OfChild(i, k, isCatmark()).Rotated((child.size - child.turned) % child.size);
        children.push_back(std::move(child));
    }
    return children;
}

void TileCompiler::countUses(RegionLevels& levels, int k, int q,
                             std::function<TileOwnership(int)> const& ownershipOf,
                             std::function<void(double)> const& tell) {
    // Of tiles that may be matrices, and of those whose children may; each kind of these is looked at once.
    if (k != kLargestDense && k != kLargestDense + 1) return;
    struct Parent {
        int face, rotation, uses;
        TileOwnership own;
    };
    std::vector<Parent> parents;
    ClassMap parentOfKey;
    bool const isLimit = isCatmark() && _contents.normals != LimitNormalKind::FaceAverage;
    int const numFaces = levels.Level(0).GetNumFaces();
    _counted = &levels;
    auto const keep = [&](int level, int face, Neighborhood&& neighborhood) {
        if (_recalled.size() < kMostRecalled) _recalled.emplace(faceKey(level, face), std::move(neighborhood));
    };
    for (int f = 0; f < numFaces; ++f) {
        tell(kCounting * f / numFaces);
        if (isLimit && FindSharpSides(levels, 0, f, k)) continue;
        TileOwnership const own = ownershipOf(f);
        Neighborhood neighborhood = identify(levels, 0, f, k, q, own);
        if (k == kLargestDense) {
            ++_usesOfKey[neighborhood.key];
        } else {
            auto const [known, isNew] = parentOfKey.emplace(neighborhood.key, static_cast<int>(parents.size()));
            int const rotation = neighborhood.rotation;
            if (isNew) parents.push_back({f, rotation, 0, own.Rotated(rotation)});
            ++parents[static_cast<std::size_t>(known->second)].uses;
        }
        keep(0, f, std::move(neighborhood));
    }
    if (levels.Topology().LastLevel() < 1) return;
    for (Parent const& parent : parents) {
        for (ChildFace const& child : findChildren(levels, 0, parent.face, parent.rotation, k, parent.own)) {
            if (isLimit && FindSharpSides(levels, 1, child.face, k - 1)) continue;
            Neighborhood neighborhood = identify(levels, 1, child.face, k - 1, std::max(0, q - 1), child.own);
            _usesOfKey[neighborhood.key] += parent.uses;
            keep(1, child.face, std::move(neighborhood));
        }
    }
}

std::vector<CompiledTile> TileCompiler::CompileAll(RegionLevels& levels, int k, int q,
                                                   std::function<TileOwnership(int)> const& ownershipOf,
                                                   std::function<void(double)> const& tell) {
    countUses(levels, k, q, ownershipOf, tell);
    std::vector<CompiledTile> tiles;
    int const numFaces = levels.Level(0).GetNumFaces();
    tiles.reserve(static_cast<std::size_t>(numFaces));
    for (int f = 0; f < numFaces; ++f) {
        tell(kCounting + (1 - kCounting) * f / numFaces);
        tiles.push_back(compile(levels, 0, f, k, q, ownershipOf(f)));
    }
    return tiles;
}

CompiledTile TileCompiler::compile(RegionLevels& levels, int level, int face, int k, int q,
                                   TileOwnership const& own) {
    if (isCatmark() && _contents.normals != LimitNormalKind::FaceAverage) {
        if (auto const sides = FindSharpSides(levels, level, face, k)) {
            return compileSpline(levels, level, face, k, q, *sides, own);
        }
    }

    Neighborhood neighborhood = recall(levels, level, face, k, q, own);
    TileRing const& ring = neighborhood.ring;
    CompiledTile tile;
    tile.rotation = neighborhood.rotation;
    auto const known = _classOfKey.find(neighborhood.key);
    if (known != _classOfKey.end()) {
        tile.tileClass = known->second;
    } else {
        bool const isRegular = !isCatmark() && isRegularTriangle(levels, level, face);
        auto const uses = _usesOfKey.find(neighborhood.key);
        bool const isRare = uses != _usesOfKey.end() && uses->second < kFewUses;
        int const largest = isRegular && q <= 1 ? kLargestDenseTriangle : isRare ? kLargestRare : kLargestDense;
        bool const isNgon = isCatmark() && own.corners.size() != 4;
        TileOwnership const turned = own.Rotated(tile.rotation);
        MadeClass made;
        if (isNgon || k > largest) {
            made = makeSplit(levels, level, face, ring, tile.rotation, k, q, turned);
        } else {
            RefinedTopology const topology(ring.Mesh(_contents.rules), k);
            RegionLevels ringLevels(topology);
            made = makeDense(ringLevels, 0, ring.tileFace, k, q, turned, false);
        }
        tile.tileClass = addClass(std::move(made));
        _classOfKey.emplace(std::move(neighborhood.key), tile.tileClass);
    }

    ClassSources const& sources = _sources[static_cast<std::size_t>(tile.tileClass)];
    for (auto const v : sources.ringVertices) tile.vertices.push_back(ring.vertices[v]);
    for (NormalLocator const& locator : sources.normalLocators) {
        tile.normals.push_back(FindNormal(levels.Topology(), level, ring, locator));
    }
    return tile;
}

namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

void placeLeaf(TileClass const& leaf, ChildTile& child) {
    if (leaf.kind == TileKind::Split || leaf.pointRows.NumRows() > 0 || leaf.normalRows.NumRows() > 0) return;
    auto const compose = [](std::vector<std::uint16_t>& indices, std::vector<std::uint16_t> const& own) {
        std::vector<std::uint16_t> composed;
        composed.reserve(own.size());
        for (auto const i : own) composed.push_back(indices[i]);
        indices.swap(composed);
    };
    // An average's rows name all sources, not those of the matrix.
    if (leaf.averages) return;
    compose(child.pointIndices, leaf.pointIndices);
    if (!child.normalIndices.empty()) compose(child.normalIndices, leaf.normalIndices);
    child.isInPlace = true;
}

}  // namespace

TileDictionary TileCompiler::Take() {
    TileDictionary dictionary = std::move(_dictionary);
    for (TileClass& parent : dictionary.classes) {
        for (ChildTile& child : parent.children) placeLeaf(dictionary.classes[index(child.tileClass)], child);
    }
    dictionary.classes.shrink_to_fit();
    dictionary.weights.shrink_to_fit();
    dictionary.segments.shrink_to_fit();
    for (std::size_t i = 0; i < dictionary.plans.size(); ++i) {
        dictionary.plans[i].segments = dictionary.segments.data() + _planOffsets[i];
    }
    // Of all blocks: one block's own array ends before the next.
    auto const* const weights = reinterpret_cast<float const*>(dictionary.weights.data());
    for (std::size_t i = 0; i < dictionary.matrices.size(); ++i) {
        dictionary.matrices[i].weights =
            dictionary.weights.empty() ? nullptr : weights + _weightOffsets[i] * kDenseBlock;
    }
    return dictionary;
}

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
