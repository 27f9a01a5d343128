// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <optional>
#include <unordered_map>
#include <vector>

#include "osd_shading/shadingOptions.h"
#include "osd_shading/tables/tileDictionary.h"
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
};

/// A face and what it is evaluated by and from.
struct CompiledTile {
    int tileClass = 0;
    int rotation = 0;                 ///< the corner of the face that its class begins with
    std::vector<int> vertices;        ///< of the face's level
    std::vector<FaceCorner> normals;  ///< of the level q further down
};

/// Finds the class of a face's neighbourhood, or makes it: with OpenSubdiv's own masks, in double precision.
class TileCompiler {
public:
    explicit TileCompiler(TileContents const& contents) : _contents(contents) {}

    /// The tile of face `face` of `level`: it has 2^k faces along a side in the end (a face that is no quad: its
    /// children 2^(k-1)), and normals that start q levels further down.
    CompiledTile Compile(RegionLevels& levels, int level, int face, int k, int q, TileOwnership const& own);

    /// Ends the compiler.
    TileDictionary Take();

private:
    struct KeyHash {
        std::size_t operator()(std::vector<std::int32_t> const& key) const;
    };
    using ClassMap = std::unordered_map<std::vector<std::int32_t>, int, KeyHash>;

    bool isCatmark() const { return _contents.rules.scheme == Sdc::SCHEME_CATMARK; }
    std::optional<unsigned> findSharpSides(RegionLevels& levels, int level, int face, int k) const;
    bool isRegularTriangle(RegionLevels& levels, int level, int face) const;
    CompiledTile compileSpline(RegionLevels& levels, int level, int face, int k, int q, unsigned sharpSides,
                               TileOwnership const& own);
    TileClass makeSpline(std::vector<FaceCorner> const& points, std::vector<FaceCorner> const& normals, int k,
                         int q, unsigned sharpSides, TileOwnership const& own);
    TileClass makeSplit(TileRing const& ring, int k, int q, TileOwnership const& own);
    TileClass makeWhole(RegionLevels& levels, int level, int face, int k, int q, TileOwnership const& own);
    TileClass makeDense(RegionLevels& levels, int level, int face, int k, int q, TileOwnership const& own,
                        bool takesAll);
    int addPlan(std::vector<RowSegment> const& segments);
    int addMatrix(int numPoints, int numFields, std::vector<std::vector<std::pair<int, double>>> const& rows,
                  std::vector<std::uint16_t>& columns);
    void useBases(int k, int q);

    TileContents _contents;
    TileDictionary _dictionary;
    ClassMap _classOfKey;
    std::vector<std::size_t> _planOffsets, _weightOffsets;
    std::unordered_multimap<std::uint64_t, int> _planOfHash, _matrixOfHash;
};

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
