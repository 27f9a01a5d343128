// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <cstdint>
#include <memory>
#include <vector>

#include "osd_shading/shadingTable.h"
#include "osd_shading/tables/faceGrid.h"
#include "osd_shading/tables/tileDictionary.h"

namespace osd_shading {
inline namespace v1 {
namespace tables {

/// The level-0 mesh, as plain arrays.
struct TableMesh {
    SubdivisionRules rules;
    int numVertices = 0;
    std::vector<int> faceOffsets{0}, faceVertices;
    std::vector<int> creaseVertices, cornerVertices, holes;
    std::vector<float> creaseSharpness, cornerSharpness;

    int NumFaces() const { return static_cast<int>(faceOffsets.size()) - 1; }
    int FaceSize(int face) const {
        return faceOffsets[static_cast<std::size_t>(face) + 1] - faceOffsets[static_cast<std::size_t>(face)];
    }
};

/// How b looks in a leaf.
enum class LeafBlend : std::uint8_t { Zero, Mixed, One };

/// b at the points of a tile; tiles share equal ones.
struct BlendPattern {
    std::size_t firstLeaf = 0;    ///< in TableData::leafBlends
    std::size_t firstWeight = 0;  ///< in TableData::blendPowers, those of the mixed leaves
};

/// Tiles whose b is 1 at every point, and 0.
constexpr int kOneEverywhere = -2, kZeroEverywhere = -1;

struct Tile {
    int tileClass = 0;
    int pattern = kZeroEverywhere;  ///< or one of TableData::patterns
    int firstValue = 0;
    int rotation = 0;
    std::size_t firstVertex = 0;  ///< in TableData::vertices
    std::size_t firstNormal = 0;  ///< in TableData::normals, where b is not 0 everywhere
};

/// What start normals are made of.
struct StartProgram {
    /// Start normals: as many as the frame computes. Face averages and the caller's: a list of corners each.
    int numNormals = 0;
    std::vector<int> valueOffsets{0};
    std::vector<int> valueFaces;             ///< of `faceOffsets`; User: a face corner of the control mesh
    std::vector<std::uint8_t> valueCorners;  ///< of the value in each face: where faces are weighted

    /// Points of the start level: the control points, then a row for each further point.
    std::vector<std::uint32_t> pointOffsets{0};
    std::vector<int> pointSources;
    std::vector<double> pointWeights;
    std::vector<int> rowSegments{0};  ///< rows from one bound to the next do not name each other
    std::vector<int> faceOffsets{0}, facePoints;

    /// Limit normals: those of a table of the start level, then the smoothed ones.
    std::shared_ptr<TableData const> limitTable;
    std::vector<int> smoothed;  ///< start normals that are replaced
    std::vector<std::uint32_t> smoothOffsets{0};
    std::vector<int> smoothSources;
    std::vector<float> smoothWeights;
};

struct TableData {
    ShadingOptions options;
    ValueOrder order = ValueOrder::Tiles;
    ShadingTableStats stats;
    TableMesh mesh;
    TileDictionary dictionary;
    std::vector<Tile> tiles;    ///< by face of the control mesh
    std::vector<int> vertices;  ///< sources of tiles: control vertices
    std::vector<int> normals;   ///< sources of tiles: start normals
    std::vector<BlendPattern> patterns;
    std::vector<LeafBlend> leafBlends;
    std::vector<float> blendPowers;   ///< b^p
    std::vector<float> blendWeights;  ///< b; empty where p is 1
    StartProgram start;
    std::vector<int> cornerOwners;  ///< by control face corner: the face corner that writes its value
    /// By control face corner: that of the edge after it in the other face, which writes what this one does not;
    /// itself where there is none.
    std::vector<int> edgeTwins;
    std::vector<int> orderOfValues;  ///< ValueOrder::OpenSubdiv: where each value goes
    int numValues = 0, numFaces = 0;
    std::size_t numLocalPoints = 0;  ///< the most that a tile and those inside it hold at one time
};

/// A point of a tile, in the grid of its face or, in an n-gon, of one of its children.
struct GridPoint {
    int child = 0, row = 0, column = 0;
};

/// The points that a tile writes, in order, as its face sees them.
std::vector<GridPoint> FindTilePoints(TileDictionary const& dictionary, Tile const& tile);

/// The number of points of each leaf of a tile of class `tileClass`, in order, appended to `sizes`.
void AppendLeafSizes(TileDictionary const& dictionary, int tileClass, std::vector<int>& sizes);

/// Calls `visit(numPoints, blend, firstWeight)` for each leaf of a tile, in order.
template <typename Visit>
void ForEachLeafBlend(TableData const& data, Tile const& tile, Visit const& visit) {
    std::vector<int> sizes;
    AppendLeafSizes(data.dictionary, tile.tileClass, sizes);
    BlendPattern const none,
        &pattern = tile.pattern < 0 ? none : data.patterns[static_cast<std::size_t>(tile.pattern)];
    std::size_t leaf = pattern.firstLeaf, weight = pattern.firstWeight;
    for (int const size : sizes) {
        LeafBlend const blend = tile.pattern == kZeroEverywhere  ? LeafBlend::Zero
                                : tile.pattern == kOneEverywhere ? LeafBlend::One
                                                                 : data.leafBlends[leaf++];
        visit(size, blend, weight);
        if (blend == LeafBlend::Mixed) weight += static_cast<std::size_t>(size);
    }
}

/// Per value of the table in Tiles order: a corner of a face of the last level. `topology` has every level.
std::vector<FaceCorner> FindValueCorners(TableData const& data, RefinedTopology const& topology);

/// Builds all of it from a mesh at `topology`'s level 0, which has at least the levels that start normals need.
std::shared_ptr<TableData const> BuildTable(RefinedTopology const& topology, ShadingOptions const& options,
                                            ValueOrder order, bool hasSubdividedNormals);

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
