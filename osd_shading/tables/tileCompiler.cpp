// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/tables/tileCompiler.h"

#include <algorithm>
#include <utility>

namespace osd_shading {
inline namespace v1 {
namespace tables {

namespace {

/// The largest k of an irregular tile that is a matrix: larger ones split.
constexpr int kLargestDense = 3;
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
                 bytesOf(c.normalIndices) + bytesOf(c.plans) + bytesOf(c.gridPoints) + bytesOf(c.children) +
                 bytesOf(c.averages.normals) + bytesOf(c.averages.faces) + bytesOf(c.averages.offsets) +
                 bytesOf(c.averages.sources) + bytesOf(c.averages.weights);
        for (ChildTile const& child : c.children)
            bytes += bytesOf(child.pointIndices) + bytesOf(child.normalIndices);
    }
    for (auto const* list : {&bases.limits, &bases.positions, &bases.grids}) {
        for (auto const& windows : *list) bytes += bytesOf(windows);
    }
    return bytes;
}

std::uint64_t HashOf(void const* data, std::size_t size) {
    std::uint64_t hash = 14695981039346656037u;
    auto const* bytes = static_cast<unsigned char const*>(data);
    for (std::size_t i = 0; i < size; ++i) hash = (hash ^ bytes[i]) * 1099511628211u;
    return hash;
}

std::size_t TileCompiler::KeyHash::operator()(std::vector<std::int32_t> const& key) const {
    return static_cast<std::size_t>(HashOf(key.data(), key.size() * sizeof key[0]));
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
        MadeClass made;
        if (isNgon || k > largest) {
            made = makeSplit(levels, level, face, ring, tile.rotation, k, q, turned);
        } else {
            RefinedTopology const topology(ring.Mesh(_contents.rules), k);
            RegionLevels ringLevels(topology);
            made = makeDense(ringLevels, 0, ring.tileFace, k, q, turned, false);
        }
        tile.tileClass = addClass(std::move(made));
        _classOfKey.emplace(std::move(key), tile.tileClass);
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
        for (auto const i : own) composed.push_back(indices[i]);
        indices.swap(composed);
    };
    // An average's rows name all sources, not those of the matrix.
    if (!leaf.averages.normals.empty()) return;
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
    for (std::size_t i = 0; i < dictionary.matrices.size(); ++i) {
        dictionary.matrices[i].weights =
            dictionary.weights.empty() ? nullptr : dictionary.weights[0].v + _weightOffsets[i] * kDenseBlock;
    }
    return dictionary;
}

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
