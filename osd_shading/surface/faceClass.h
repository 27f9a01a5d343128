// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <cstdint>
#include <memory>
#include <vector>

#include "osd_shading/fieldRefiner.h"
#include "osd_shading/shadingOptions.h"
#include "osd_shading/surface/cutOutLevels.h"
#include "osd_shading/surface/limitClasses.h"
#include "osd_shading/tables/neededRows.h"

namespace osd_shading {
inline namespace v1 {
namespace surface {

/// A quarter of a face, and so on downwards.
struct FaceNode {
    enum class Kind : std::uint8_t { Patch, Split, Deep };
    Kind kind = Kind::Patch;
    bool hasWeight = false;      ///< b is not zero everywhere on it
    std::uint16_t phantoms = 0;  ///< Patch: of its class
    std::uint32_t first = 0;     ///< Patch, Deep: its lines, in `indices`; Split: the first of its 4 children
    std::int32_t corners = -1;   ///< Split, the uppermost irregular ones: the first of its corners
    LimitClass const* limitClass = nullptr;  ///< Deep
};

/// A corner of an irregular face, where no patch reaches: what its limits are sums of.
struct FaceCornerRows {
    struct Term {
        std::uint32_t line;
        double limit, tangent1, tangent2;
    };
    std::vector<Term> terms;
    std::uint32_t vertexLine = 0;
    bool isAverage = false;
    std::vector<std::vector<std::uint32_t>> faces;  ///< lines, from the corner on, of the faces of its region
};

/// The start level's mesh of a cut-out: start normals are made of its points.
struct StartMesh {
    RefinedTopology topology;
    CreaseRegions regions;
    std::vector<LevelMasks<double>> masks;
};

/// Where on a face which lines are taken.
struct FacePatches {
    std::vector<FaceNode> nodes;
    std::vector<std::uint32_t> indices;
    std::vector<std::uint32_t> roots;  ///< per sub-face of an n-gon; one otherwise
};

/// All control faces of one neighbourhood. Lines hold a position, a normal and a weight each: first those of values
/// of the cut-out's levels, then the results of rows.
struct FaceClass {
    bool isCatmark = true;
    std::shared_ptr<FacePatches> patches = std::make_shared<FacePatches>();
    tables::FlatRows positionRows;  ///< per first line, from the cut-out's vertices
    tables::FlatRows
        normalRows;  ///< per first line, from the values `normalSources` of the start level; may be empty
    std::vector<int> normalSources;
    LineRows rows;
    std::vector<double> weights;  ///< b per line, before any limit
    std::vector<FaceCornerRows> corners;
    std::unique_ptr<StartMesh> start;  ///< null where b is zero all over, or normals are given at level 0

    std::size_t NumFirstLines() const { return positionRows.Size(); }
    std::size_t NumLines() const { return weights.size(); }
    bool HasWeights() const { return !normalRows.sources.empty(); }
    /// Of its arrays, nearly.
    std::size_t NumBytes() const;
};

/// The rings that a face's fields depend on, at most.
int NumRingsOf(FaceClassOptions const& options);

/// `cutOut`: of NumRingsOf rings.
std::unique_ptr<FaceClass> MakeFaceClass(FaceClassOptions const& options, tables::TileRing const& cutOut,
                                         LimitClasses& limitClasses);

}  // namespace surface
}  // namespace v1
}  // namespace osd_shading
