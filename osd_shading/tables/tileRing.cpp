// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/tables/tileRing.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace osd_shading {
inline namespace v1 {
namespace tables {

namespace {

std::int32_t bitsOf(float number) {
    std::int32_t bits;
    std::memcpy(&bits, &number, sizeof bits);
    return bits;
}

}  // namespace

RegionLevels::RegionLevels(RefinedTopology const& topology)
    : _topology(&topology),
      _regions(static_cast<std::size_t>(topology.LastLevel()) + 1),
      _rings(_regions.size()),
      _masks(_regions.size()),
      _steps(_regions.size()),
      _slots(_regions.size()) {}

CreaseRegions const& RegionLevels::Regions(int level) {
    auto& regions = _regions[static_cast<std::size_t>(level)];
    if (!regions) regions = std::make_unique<CreaseRegions>(*_topology, level, 1);
    return *regions;
}

TileRings& RegionLevels::Rings(int level) {
    auto& rings = _rings[static_cast<std::size_t>(level)];
    if (!rings) rings = std::make_unique<TileRings>(*_topology, level);
    return *rings;
}

LevelMasks<double> const& RegionLevels::Masks(int level) {
    auto& masks = _masks[static_cast<std::size_t>(level)];
    if (!masks) masks = std::make_unique<LevelMasks<double>>(_topology->RecordMasks<double>(level));
    return *masks;
}

FieldStep<double> const& RegionLevels::Step(int level) {
    auto& step = _steps[static_cast<std::size_t>(level)];
    if (!step) {
        step = std::make_unique<FieldStep<double>>(*_topology, level, Masks(level), Regions(level - 1),
                                                   Regions(level), 1);
    }
    return *step;
}

bool RegionLevels::HasOneValuePerVertex(int lastLevel) {
    for (int level = 0; level <= lastLevel; ++level) {
        if (!Regions(level).HasOneValuePerVertex()) return false;
    }
    return true;
}

std::vector<int>& RegionLevels::Slots(int level) {
    auto& slots = _slots[static_cast<std::size_t>(level)];
    auto const size = static_cast<std::size_t>(std::max(Level(level).GetNumVertices(), Regions(level).NumValues()));
    if (slots.size() < size) slots.assign(size, -1);
    return slots;
}

SubdivisionRules RulesOf(Far::TopologyRefiner const& refiner) {
    Sdc::Options const options = refiner.GetSchemeOptions();
    SubdivisionRules rules;
    rules.scheme = refiner.GetSchemeType();
    rules.boundary = options.GetVtxBoundaryInterpolation();
    rules.faceVarying = options.GetFVarLinearInterpolation();
    rules.creasing = options.GetCreasingMethod();
    rules.triangles = options.GetTriangleSubdivision();
    return rules;
}

ControlMesh TileRing::Mesh(SubdivisionRules const& rules) const {
    ControlMesh mesh;
    mesh.numVertices = numVertices;
    mesh.faceSizes = faceSizes;
    mesh.faceVertices = faceVertices;
    mesh.creaseVertices = creaseVertices;
    mesh.creaseSharpness = creaseSharpness;
    mesh.cornerVertices = cornerVertices;
    mesh.cornerSharpness = cornerSharpness;
    mesh.rules = rules;
    return mesh;
}

std::uint64_t HashOf(void const* data, std::size_t size) {
    std::uint64_t hash = 14695981039346656037u;
    auto const* bytes = static_cast<unsigned char const*>(data);
    for (std::size_t i = 0; i < size; ++i) hash = (hash ^ bytes[i]) * 1099511628211u;
    return hash;
}

std::size_t KeyHash::operator()(std::vector<std::int32_t> const& key) const {
    return static_cast<std::size_t>(HashOf(key.data(), key.size() * sizeof key[0]));
}

void TileRing::AppendKey(std::vector<std::int32_t>& key) const {
    key.push_back(tileFace);
    key.push_back(static_cast<std::int32_t>(faceSizes.size()));
    key.insert(key.end(), faceSizes.begin(), faceSizes.end());
    key.insert(key.end(), faceVertices.begin(), faceVertices.end());
    key.push_back(static_cast<std::int32_t>(creaseSharpness.size()));
    key.insert(key.end(), creaseVertices.begin(), creaseVertices.end());
    for (float const s : creaseSharpness) key.push_back(bitsOf(s));
    key.push_back(static_cast<std::int32_t>(cornerSharpness.size()));
    key.insert(key.end(), cornerVertices.begin(), cornerVertices.end());
    for (float const s : cornerSharpness) key.push_back(bitsOf(s));
}

std::size_t TileRing::NumBytes() const {
    return sizeof(int) *
               (faceSizes.capacity() + faceVertices.capacity() + creaseVertices.capacity() +
                cornerVertices.capacity() + vertices.capacity() + faces.capacity() + firstCorners.capacity()) +
           sizeof(float) * (creaseSharpness.capacity() + cornerSharpness.capacity());
}

TileRings::TileRings(RefinedTopology const& topology, int level)
    : _topology(&topology),
      _level(&topology.Level(level)),
      _isUniform(topology.Refiner().GetSchemeOptions().GetCreasingMethod() == Sdc::Options::CREASE_UNIFORM),
      _numberOfVertex(static_cast<std::size_t>(_level->GetNumVertices()), -1),
      _isFaceInRing(static_cast<std::size_t>(_level->GetNumFaces()), 0) {}

void TileRings::add(TileRing& ring, int face, int firstCorner) {
    if (std::exchange(_isFaceInRing[static_cast<std::size_t>(face)], 1)) return;
    Far::ConstIndexArray const vertices = _level->GetFaceVertices(face);
    int const size = vertices.size();
    ring.faces.push_back(face);
    ring.firstCorners.push_back(firstCorner);
    ring.faceSizes.push_back(size);
    for (int i = 0; i < size; ++i) {
        int const vertex = vertices[firstCorner + i < size ? firstCorner + i : firstCorner + i - size];
        int& number = _numberOfVertex[static_cast<std::size_t>(vertex)];
        if (number < 0) {
            number = ring.numVertices++;
            ring.vertices.push_back(vertex);
        }
        ring.faceVertices.push_back(number);
    }
}

TileRing TileRings::Find(int face, int rotation, int numLevels) {
    Far::ConstIndexArray const corners = _level->GetFaceVertices(face);
    int const size = corners.size();

    // OpenSubdiv's limit tangents at an interior vertex of two quads depend on which of them comes first.
    bool needsOrder = false;
    for (int i = 0; i < size && _topology->IsCatmark(); ++i) {
        needsOrder |=
            _level->GetVertexEdges(corners[i]).size() == 2 && _level->GetVertexFaces(corners[i]).size() == 2;
    }

    TileRing ring;
    ring.isInLevelOrder = needsOrder;
    if (needsOrder) {
        std::vector<int> faces;
        for (int const v : corners) {
            Far::ConstIndexArray const around = _level->GetVertexFaces(v);
            faces.insert(faces.end(), around.begin(), around.end());
        }
        std::sort(faces.begin(), faces.end());
        for (int const f : faces) add(ring, f, 0);
        ring.tileFace =
            static_cast<int>(std::find(ring.faces.begin(), ring.faces.end(), face) - ring.faces.begin());
    } else {
        add(ring, face, rotation);
        for (int i = 0; i < size; ++i) {
            int const v = corners[(rotation + i) % size];
            Far::ConstIndexArray const around = _level->GetVertexFaces(v);
            Far::ConstLocalIndexArray const at = _level->GetVertexFaceLocalIndices(v);
            int const begin = around.FindIndex(face);
            for (int k = 1; k < around.size(); ++k) {
                int const next = begin + k < around.size() ? begin + k : begin + k - around.size();
                add(ring, around[next], at[next]);
            }
        }
    }
    if (!_isUniform && hasFadingEdges(ring)) {
        // By Chaikin's rule how an edge fades depends on all edges at both its ends.
        std::vector<int> const vertices = ring.vertices;
        for (int const v : vertices) {
            Far::ConstIndexArray const around = _level->GetVertexFaces(v);
            Far::ConstLocalIndexArray const at = _level->GetVertexFaceLocalIndices(v);
            for (int k = 0; k < around.size(); ++k) add(ring, around[k], needsOrder ? 0 : at[k]);
        }
    }
    addSharpness(ring, face, rotation, numLevels);
    for (int const v : ring.vertices) _numberOfVertex[static_cast<std::size_t>(v)] = -1;
    for (int const f : ring.faces) _isFaceInRing[static_cast<std::size_t>(f)] = 0;
    return ring;
}

bool TileRings::hasFadingEdges(TileRing const& ring) const {
    for (int const face : ring.faces) {
        for (int const edge : _level->GetFaceEdges(face)) {
            float const sharpness = _level->GetEdgeSharpness(edge);
            if (sharpness > 0 && sharpness < Sdc::Crease::SHARPNESS_INFINITE) return true;
        }
    }
    return false;
}

void AppendInnerCreases(Far::TopologyLevel const& level, std::function<float(int)> const& sharpnessOf,
                        TileRing& ring) {
    std::vector<std::pair<int, std::pair<int, int>>> edges;  // edge, its ends in the ring
    std::size_t offset = 0;
    for (std::size_t f = 0; f < ring.faces.size(); ++f) {
        Far::ConstIndexArray const faceEdges = level.GetFaceEdges(ring.faces[f]);
        int const faceSize = ring.faceSizes[f];
        for (int i = 0; i < faceSize; ++i) {
            int const edge = faceEdges[(ring.firstCorners[f] + i) % faceSize];
            if (!IsSharpEdge(level, edge)) continue;
            int const a = ring.faceVertices[offset + static_cast<std::size_t>(i)];
            int const b = ring.faceVertices[offset + static_cast<std::size_t>((i + 1) % faceSize)];
            edges.push_back({edge, std::minmax(a, b)});
        }
        offset += static_cast<std::size_t>(faceSize);
    }
    std::stable_sort(edges.begin(), edges.end(), [](auto const& a, auto const& b) { return a.first < b.first; });
    std::vector<std::pair<std::pair<int, int>, float>> creases;
    for (std::size_t i = 1; i < edges.size(); ++i) {
        bool const isSecond =
            edges[i].first == edges[i - 1].first && (i < 2 || edges[i].first != edges[i - 2].first);
        if (isSecond) creases.emplace_back(edges[i].second, sharpnessOf(edges[i].first));
    }
    std::sort(creases.begin(), creases.end());
    for (auto const& [ends, sharpness] : creases) {
        ring.creaseVertices.insert(ring.creaseVertices.end(), {ends.first, ends.second});
        ring.creaseSharpness.push_back(sharpness);
    }
}

void TileRings::addSharpness(TileRing& ring, int face, int rotation, int numLevels) const {
    auto const canonical = [&](float sharpness) {
        return StaysSharp(sharpness, numLevels, _isUniform) ? Sdc::Crease::SHARPNESS_INFINITE : sharpness;
    };

    AppendInnerCreases(
        *_level, [&](int edge) { return canonical(_level->GetEdgeSharpness(edge)); }, ring);

    Far::ConstIndexArray const corners = _level->GetFaceVertices(face);
    for (int i = 0; i < corners.size(); ++i) {
        int const v = corners[(rotation + i) % corners.size()];
        float const sharpness = _level->GetVertexSharpness(v);
        if (!(sharpness > 0)) continue;
        ring.cornerVertices.push_back(_numberOfVertex[static_cast<std::size_t>(v)]);
        ring.cornerSharpness.push_back(canonical(sharpness));
    }
}

bool IsRefinedAlike(RegionLevels& levels, int level, int face) {
    for (int const v : levels.Level(level).GetFaceVertices(face)) {
        if (levels.Level(level).IsVertexNonManifold(v) && levels.Regions(level).Kind(v) != VertexKind::Corner) {
            return false;
        }
    }
    return true;
}

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
