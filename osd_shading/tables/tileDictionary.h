// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "osd_shading/faceNormals.h"
#include "osd_shading/tables/patchKernels.h"

namespace osd_shading {
inline namespace v1 {
namespace tables {

/// Sums over local points, appended to them in order: a row may name results of rows before it.
struct LocalRows {
    std::vector<std::uint32_t> offsets{0};
    std::vector<std::uint16_t> sources;
    std::vector<float> weights;

    int NumRows() const { return static_cast<int>(offsets.size()) - 1; }
};

/// A value whose N_L is an average of face normals of the last level.
struct AverageNormal {
    int point = 0;      ///< of the leaf, in the order of its output
    int firstFace = 0;  ///< in AverageNormals::faces; up to the next one's
};
struct AverageFace {
    int size = 0;      ///< 3 or 4
    int rows[4] = {};  ///< points of the last level, counter-clockwise
    int corner = 0;    ///< of the value's vertex
};
struct AverageNormals {
    FaceWeight weight = FaceWeight::Uniform;
    std::vector<AverageNormal> normals;
    std::vector<AverageFace> faces;
    std::vector<std::uint32_t> offsets{0};  ///< rows: points of the last level, from the leaf's sources
    std::vector<std::uint16_t> sources;
    std::vector<double> weights;
};

/// What a tile is evaluated by.
enum class TileKind : std::uint8_t {
    Spline,  ///< a bicubic B-spline patch
    Dense,   ///< a matrix
    Split    ///< its children
};

/// A child of a split tile.
struct ChildTile {
    /// A leaf without rows reads the parent's points where they are: its indices below stand for those of its
    /// class.
    bool isInPlace = false;
    int tileClass = 0;
    int rotation = 0;  ///< which of the child's corners, in OpenSubdiv's order, its class begins with
    std::vector<std::uint16_t> pointIndices;   ///< its sources among the parent's local points
    std::vector<std::uint16_t> normalIndices;  ///< the same for normals
};

/// All tiles of one neighbourhood. A tile's local points are its sources, then the results of its rows.
struct TileClass {
    TileKind kind = TileKind::Dense;
    std::uint8_t k = 0;                ///< 2^k faces along a side
    std::uint8_t numNormalLevels = 0;  ///< q: levels from the tile's own to that of its normal sources
    bool isNgon = false;               ///< a split n-gon of level 0: its children have 2^(k-1) faces along a side
    int size = 4;                      ///< corners of its face
    int numPoints = 0;                 ///< that it writes
    int numLeaves = 0;                 ///< in the order in which they are evaluated
    int numSources = 0, numNormalSources = 0;
    LocalRows pointRows, normalRows;

    /// Spline: control points (4 x 4) and normals ((2^q + 3)^2) among the local ones. Dense: the matrix's columns.
    std::vector<std::uint16_t> pointIndices, normalIndices;
    std::vector<int> plans;  ///< Spline: by window, row by row

    /// Dense. Where both are one, normals are summed with the weights of its field 0, and `normalIndices` are in
    /// the order of its columns.
    int frameMatrix = -1, normalMatrix = -1;
    float tangentSums[2] = {0, 0};                   ///< Dense: largest sum of a row's weights, without signs
    std::shared_ptr<AverageNormals const> averages;  ///< Dense; null: none
    std::vector<std::uint16_t> gridPoints;           ///< Dense: row * 32 + column, by point
    std::vector<ChildTile> children;                 ///< Split
};

/// A window of a patch with 2^k faces along a side: at most kLeafSide of them.
inline int NumWindows(int k) { return k > 4 ? 1 << (k - 4) : 1; }

/// The bases of splines, by exponent k and window.
struct SplineBases {
    std::vector<std::vector<SplineBasis>> limits;  ///< [k][window]
    std::vector<std::vector<SplineBasis>>
        positions;                                ///< [k][window]; those of the refined mesh where they are asked
    std::vector<std::vector<SplineBasis>> grids;  ///< [log2 of the grid's side][k]: at most kLeafSide parameters

    /// The basis of a window's normals, q levels below the patch, and the first control point that it names.
    SplineBasis const& ForNormals(int k, int q, int window, int& firstPoint) const;
};

struct alignas(64) WeightLine {
    float v[kDenseBlock];
};

/// The classes of a table's tiles, and what they share.
struct TileDictionary {
    std::vector<TileClass> classes;
    std::vector<DenseMatrix> matrices;
    std::vector<WeightLine> weights;
    std::vector<RowPlan> plans;
    std::vector<RowSegment> segments;
    SplineBases bases;

    std::size_t NumBytes() const;
};

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
