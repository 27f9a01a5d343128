// SPDX-License-Identifier: Apache-2.0

// Tiles that are their children.

#include <algorithm>
#include <cassert>
#include <memory>
#include <numeric>
#include <utility>

#include "osd_shading/tables/localRows.h"
#include "osd_shading/tables/tileCompiler.h"

namespace osd_shading {
inline namespace v1 {
namespace tables {

namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// The ring as the mesh of its own that it makes sees it.
TileRing ringOfItself(TileRing const& ring) {
    TileRing own = ring;
    std::iota(own.vertices.begin(), own.vertices.end(), 0);
    std::iota(own.faces.begin(), own.faces.end(), 0);
    std::fill(own.firstCorners.begin(), own.firstCorners.end(), 0);
    return own;
}

/// Numbers by vertex of a level, of those in a ring.
class RingNumbers {
public:
    explicit RingNumbers(TileRing const& ring) {
        for (std::size_t i = 0; i < ring.vertices.size(); ++i) {
            _numbers.emplace_back(ring.vertices[i], static_cast<int>(i));
        }
        std::sort(_numbers.begin(), _numbers.end());
    }
    int Of(int vertex) const {
        auto const found = std::lower_bound(_numbers.begin(), _numbers.end(), std::make_pair(vertex, 0));
        assert(found != _numbers.end() && found->first == vertex);
        return found->second;
    }

private:
    std::vector<std::pair<int, int>> _numbers;
};

/// The rows of a level's needed elements, after `numSources` sources: those of the level before.
LocalRows makeRows(NeededLevel const& needed, int numSources) {
    LocalRows rows;
    rows.offsets.reserve(needed.Size() + 1);
    rows.sources.reserve(needed.terms.size());
    rows.weights.reserve(needed.terms.size());
    for (std::size_t i = 0; i < needed.Size(); ++i) {
        for (std::size_t t = needed.offsets[i]; t < needed.offsets[i + 1]; ++t) {
            int const term = needed.terms[t];
            AppendTerm(rows, index(term >= 0 ? term : numSources + ~term), needed.weights[t]);
        }
        EndRow(rows);
    }
    return rows;
}

}  // namespace

MadeClass TileCompiler::makeSplit(RegionLevels& outer, int outerLevel, int outerFace, TileRing const& ring,
                                  int rotation, int k, int q, TileOwnership const& own) {
    // The levels that the tile is in have what is needed, or those of its ring as a mesh of its own do.
    std::unique_ptr<RefinedTopology> ownTopology;
    std::unique_ptr<RegionLevels> ownLevels;
    TileRing ownRing;
    int level = outerLevel, face = outerFace, turned = rotation;
    if (outer.Topology().LastLevel() < outerLevel + std::max(1, q)) {
        ownTopology = std::make_unique<RefinedTopology>(ring.Mesh(_contents.rules), std::max(1, q));
        ownLevels = std::make_unique<RegionLevels>(*ownTopology);
        ownRing = ringOfItself(ring);
        level = turned = 0;
        face = ring.tileFace;
    }
    RegionLevels& levels = ownLevels ? *ownLevels : outer;
    TileRing const& here = ownLevels ? ownRing : ring;
    RefinedTopology const& topology = levels.Topology();
    Far::ConstIndexArray const childFaces = levels.Level(level).GetFaceChildFaces(face);
    bool const hasNormals = _contents.hasSubdividedNormals;
    bool const isNgon = isCatmark() && own.corners.size() != 4;

    // A mesh made anew from the next level is refined as that level was: but not at non-manifold creases, whose
    // vertices OpenSubdiv would make corners.
    bool const isAsRefined = std::all_of(childFaces.begin(), childFaces.begin() + childFaces.size(),
                                         [&](int child) { return IsRefinedAlike(levels, level + 1, child); });
    if (!isAsRefined) return makeWholeOfRing(ring, k, q, own);

    MadeClass result;
    TileClass& made = result.tileClass;
    made.kind = TileKind::Split;
    made.size = static_cast<int>(own.corners.size());
    made.k = static_cast<std::uint8_t>(k);
    made.numNormalLevels = static_cast<std::uint8_t>(q);
    made.isNgon = isNgon;

    // The children, in the order in which the class sees them.
    std::vector<CompiledTile> children;
    made.children.reserve(index(childFaces.size()));
    for (ChildFace const& child : findChildren(levels, level, face, turned, k, own)) {
        CompiledTile compiled = compile(levels, level + 1, child.face, k - 1, std::max(0, q - 1), child.own);
        compiled.rotation = (compiled.rotation + child.size - child.turned) % child.size;
        TileClass const& childClass = _dictionary.classes[index(compiled.tileClass)];
        made.numPoints += childClass.numPoints;
        made.numLeaves += childClass.numLeaves;
        ChildTile entry;
        entry.tileClass = compiled.tileClass;
        entry.rotation = compiled.rotation;
        made.children.push_back(std::move(entry));
        children.push_back(std::move(compiled));
    }

    // Their points.
    {
        std::vector<std::pair<int, int>> wanted;
        std::vector<int>& isWanted = levels.Slots(level + 1);
        for (CompiledTile const& child : children) {
            for (int const v : child.vertices) {
                if (isWanted[index(v)] >= 0) continue;
                isWanted[index(v)] = 0;
                wanted.emplace_back(v, v);
            }
        }
        for (auto const& [v, vertex] : wanted) isWanted[index(v)] = -1;
        NeededRows const needed(levels, ElementKind::Vertex, level, level + 1, wanted);
        RingNumbers const numbers(here);
        for (int const v : needed.Level(level).elements) {
            result.sources.ringVertices.push_back(LocalIndex(numbers.Of(v)));
        }
        made.numSources = static_cast<int>(needed.Level(level).Size());
        made.pointRows = makeRows(needed.Level(level + 1), made.numSources);
        for (std::size_t i = 0; i < children.size(); ++i) {
            made.children[i].pointIndices.reserve(children[i].vertices.size());
            made.children[i].normalIndices.reserve(children[i].normals.size());
            for (int const v : children[i].vertices) {
                made.children[i].pointIndices.push_back(LocalIndex(made.numSources + needed.IndexOf(level + 1, v)));
            }
        }
    }
    if (!hasNormals) return result;

    // Their normals: sources themselves where they start further down, refined by region where they have started.
    int const normalLevel = level + std::max(1, q);
    result.field.children.resize(children.size());
    std::vector<std::pair<int, int>> wanted;
    std::vector<FaceCorner> corners;
    std::vector<int>& slots = levels.Slots(normalLevel);
    for (CompiledTile const& child : children) {
        for (FaceCorner const& at : child.normals) {
            int const value = levels.ValueAt(normalLevel, at);
            if (slots[index(value)] >= 0) continue;
            slots[index(value)] = static_cast<int>(wanted.size());
            wanted.emplace_back(value, VertexAt(levels.Level(normalLevel), at));
            corners.push_back(at);
        }
    }
    if (q > 0) {
        made.numNormalSources = static_cast<int>(wanted.size());
        for (FaceCorner const& at : corners) {
            result.sources.normalLocators.push_back(LocateNormal(topology, level, here, normalLevel, at));
        }
        for (std::size_t i = 0; i < children.size(); ++i) {
            for (FaceCorner const& at : children[i].normals) {
                int const source = slots[index(levels.ValueAt(normalLevel, at))];
                made.children[i].normalIndices.push_back(LocalIndex(source));
                result.field.children[i].push_back(source);
            }
        }
        for (auto const& [value, vertex] : wanted) slots[index(value)] = -1;
        return result;
    }
    for (auto const& [value, vertex] : wanted) slots[index(value)] = -1;
    NeededRows const needed(levels, ElementKind::Value, level, level + 1, wanted);
    NeededLevel const& first = needed.Level(level);
    made.numNormalSources = static_cast<int>(first.Size());
    for (std::size_t i = 0; i < first.Size(); ++i) {
        result.sources.normalLocators.push_back(
            LocateValue(levels, level, here, first.elements[i], first.vertices[i]));
    }
    made.normalRows = makeRows(needed.Level(level + 1), made.numNormalSources);
    for (std::size_t i = 0; i < children.size(); ++i) {
        for (FaceCorner const& at : children[i].normals) {
            int const value = needed.IndexOf(level + 1, levels.ValueAt(level + 1, at));
            made.children[i].normalIndices.push_back(LocalIndex(made.numNormalSources + value));
            result.field.children[i].push_back(value);
        }
    }
    if (_contents.needsFields) result.field.stages.push_back(MakeFieldStage(levels, needed, level + 1));
    return result;
}

MadeClass TileCompiler::makeWholeOfRing(TileRing const& ring, int k, int q, TileOwnership const& own) {
    RefinedTopology const topology(ring.Mesh(_contents.rules), k);
    RegionLevels levels(topology);
    MadeClass whole = makeWhole(levels, 0, ring.tileFace, k, q, own);
    for (int v = 0; v < ring.numVertices; ++v) whole.sources.ringVertices.push_back(LocalIndex(v));
    if (!_contents.hasSubdividedNormals) return whole;
    Far::TopologyLevel const& start = levels.Level(q);
    whole.sources.normalLocators.resize(index(whole.tileClass.numNormalSources));
    for (int f = 0; f < start.GetNumFaces(); ++f) {
        for (int corner = 0; corner < start.GetFaceVertices(f).size(); ++corner) {
            NormalLocator& locator = whole.sources.normalLocators[index(levels.ValueAt(q, {f, corner}))];
            if (locator.path.face < 0) locator = {FindFacePath(topology, q, f, 0), corner};
        }
    }
    return whole;
}

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
