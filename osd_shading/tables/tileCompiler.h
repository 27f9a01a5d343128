// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <functional>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "osd_shading/shadingOptions.h"
#include "osd_shading/tables/normalLocator.h"
#include "osd_shading/tables/tileDictionary.h"
#include "osd_shading/tables/tileField.h"
#include "osd_shading/tables/tileOwnership.h"

namespace osd_shading {
inline namespace v1 {
namespace tables {

/// What a table's tiles hold.
struct TileContents {
    SubdivisionRules rules;
    PositionKind positions = PositionKind::Limit;
    LimitNormalKind normals = LimitNormalKind::Limit;
    FaceWeight faceWeight = FaceWeight::Uniform;  ///< of LimitNormalKind::FaceAverage
    bool hasSubdividedNormals = true;
    bool needsFields = false;  ///< how b is refined, for those who want to know (not round non-manifold creases)
};

/// A face and what it is evaluated by and from.
struct CompiledTile {
    int tileClass = 0;
    int rotation = 0;                 ///< the corner of the face that its class begins with
    std::vector<int> vertices;        ///< of the face's level
    std::vector<FaceCorner> normals;  ///< of the level q further down
};

/// Where the sources of a class are found round a tile.
struct ClassSources {
    std::vector<std::uint16_t> ringVertices;    ///< Dense and Split: among the ring's vertices
    std::vector<NormalLocator> normalLocators;  ///< the same for normals
};

struct MadeClass {
    TileClass tileClass;
    ClassSources sources;
    TileField field;
};

/// Finds the class of a face's neighbourhood, or makes it: with OpenSubdiv's own masks, in double precision.
class TileCompiler {
public:
    explicit TileCompiler(TileContents const& contents) : _contents(contents) {}

    /// The tiles of all faces of level 0: each has 2^k faces along a side in the end (a face that is no quad: its
    /// children 2^(k-1)), and normals that start q levels further down. `ownershipOf`: by face; `tell`: called with
    /// the share that is done, may throw.
    std::vector<CompiledTile> CompileAll(RegionLevels& levels, int k, int q,
                                         std::function<TileOwnership(int)> const& ownershipOf,
                                         std::function<void(double)> const& tell);

    /// How b is refined, by class; asked for before `Take`.
    std::vector<TileField> TakeFields() { return std::move(_fields); }

    /// Ends the compiler.
    TileDictionary Take();

private:
    using ClassMap = std::unordered_map<std::vector<std::int32_t>, int, KeyHash>;

    bool isCatmark() const { return _contents.rules.scheme == Sdc::SCHEME_CATMARK; }
    /// A tile's ring as its class sees it.
    struct Neighborhood {
        TileRing ring;
        std::vector<std::int32_t> key;
        int rotation = 0;
    };
    Neighborhood identify(RegionLevels& levels, int level, int face, int k, int q, TileOwnership const& own) const;
    /// The same, once more for what `countUses` has looked at.
    Neighborhood recall(RegionLevels& levels, int level, int face, int k, int q, TileOwnership const& own);
    CompiledTile compile(RegionLevels& levels, int level, int face, int k, int q, TileOwnership const& own);
    /// Counts how often each class that may be a matrix will be used, as far as `levels` go.
    void countUses(RegionLevels& levels, int k, int q, std::function<TileOwnership(int)> const& ownershipOf,
                   std::function<void(double)> const& tell);
    int addClass(MadeClass&& made);

    // Splines.
    CompiledTile compileSpline(RegionLevels& levels, int level, int face, int k, int q, unsigned sharpSides,
                               TileOwnership const& own);
    MadeClass makeSpline(std::vector<FaceCorner> const& points, std::vector<FaceCorner> const& normals, int k,
                         int q, unsigned sharpSides, TileOwnership const& own);
    int addPlan(std::vector<RowSegment> const& segments);
    void useBases(int k, int q);

    // Tiles that split.
    /// A child of a face; its corner `turned` is the first as the parent's class sees it.
    struct ChildFace {
        int face = 0, size = 4, turned = 0;
        TileOwnership own;  ///< from its corner 0 on
    };
    /// In the order in which the class sees them, from corner `rotation` of the face on; so does `own`.
    std::vector<ChildFace> findChildren(RegionLevels& levels, int level, int face, int rotation, int k,
                                        TileOwnership const& own) const;
    MadeClass makeSplit(RegionLevels& levels, int level, int face, TileRing const& ring, int rotation, int k, int q,
                        TileOwnership const& own);

    // Matrices.
    bool isRegularTriangle(RegionLevels& levels, int level, int face) const;
    MadeClass makeDense(RegionLevels& levels, int level, int face, int k, int q, TileOwnership const& own,
                        bool takesAll);
    MadeClass makeWhole(RegionLevels& levels, int level, int face, int k, int q, TileOwnership const& own);
    MadeClass makeWholeOfRing(TileRing const& ring, int k, int q, TileOwnership const& own);
    int addMatrix(int numPoints, int numFields, int numSources, FlatRows const& rows,
                  std::vector<std::uint16_t>& columns);

    TileContents _contents;
    TileDictionary _dictionary;
    std::vector<ClassSources> _sources;  // by class
    std::vector<TileField> _fields;      // by class
    ClassMap _classOfKey, _usesOfKey;
    RegionLevels* _counted = nullptr;                           // what countUses has looked at
    std::unordered_map<std::uint64_t, Neighborhood> _recalled;  // of its faces, by level and face; some alone
    std::vector<std::size_t> _planOffsets, _weightOffsets;
    std::unordered_multimap<std::uint64_t, int> _planOfHash, _matrixOfHash;
};

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
