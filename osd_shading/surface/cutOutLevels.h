// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "osd_shading/blendWeights.h"
#include "osd_shading/limitFrames.h"
#include "osd_shading/shadingOptions.h"
#include "osd_shading/tables/neededRows.h"

namespace osd_shading {
inline namespace v1 {
namespace surface {

/// How faces are compiled.
struct FaceClassOptions {
    ShadingOptions shading;  ///< resolved
    SubdivisionRules rules;
};

/// Some levels of a control face's cut-out, with b: all of them from level 0 on, or, further down, of what still
/// fades alone. Levels are counted from its first one, 0.
class CutOutLevels {
public:
    /// The first levels, down to the surface's level `lastLevel`.
    CutOutLevels(FaceClassOptions const& options, tables::TileRing const& cutOut, int lastLevel);
    /// Further levels down to `lastLevel`, of `faces` of the last level of `above` with `numRings` rings round
    /// them; `facesHere` takes their numbers.
    CutOutLevels(CutOutLevels& above, std::vector<int> const& faces, int numRings, int lastLevel,
                 std::vector<int>& facesHere);
    CutOutLevels(CutOutLevels const&) = delete;
    CutOutLevels& operator=(CutOutLevels const&) = delete;

    RefinedTopology const& Topology() const { return _topology; }
    tables::RegionLevels& Levels() { return _levels; }
    Far::TopologyLevel const& Level(int level) const { return _topology.Level(level); }
    int LastLevel() const { return _topology.LastLevel(); }
    /// Of the surface's levels.
    int NumLevelsBelow() const { return _options.shading.level - _firstLevel - LastLevel(); }

    bool HasWeights() const { return _hasWeights; }
    /// b of a value, before any limit.
    double WeightOf(int level, int value) const;
    /// Whether normals are refined, not started, on a level.
    bool HasNormals(int level) const { return _firstLevel + level >= _options.shading.startNormals.level; }

    /// Whether nothing fades or is seeded any more on a face of a level above the last.
    bool IsSettled(int level, int face);
    /// Whether the limits at a face's vertices are the same taken at any level: where the masks are exact, and
    /// there is a tangent plane.
    bool HasExactCorners(int level, int face);
    LimitStep<double> const& LimitOf(int level);

    /// Whether faces of the last level, cut out, are refined as they are here: round non-manifold creases they are
    /// not (tables::IsRefinedAlike).
    bool CanBeCut(std::vector<int> const& faces);

    /// Appends the sums over the control cut-out's vertices that vertices of a level are, one row each.
    void AppendPositions(int level, std::vector<int> const& vertices, tables::FlatRows& rows);
    /// Appends the sums over the start level's values that normals of values of a level are, one row each.
    /// `values`: each with its vertex.   REQUIRES: HasNormals(level)
    void AppendNormals(int level, std::vector<std::pair<int, int>> const& values, tables::FlatRows& rows);

private:
    void findWeights(std::vector<double> const* given);
    template <typename IsIt>
    bool anyRound(int level, int face, int at, IsIt const& isIt) const;
    void appendRows(tables::ElementKind kind, int fromLevel, int level,
                    std::vector<std::pair<int, int>> const& wanted, tables::FlatRows const& first,
                    tables::FlatRows& rows);
    bool usesOne() const { return _options.shading.weights.scheme == WeightScheme::One; }
    bool hasWeight(int level, int face);
    bool isSeeded(int level, int face);
    int firstWeights() const { return std::max(0, _options.shading.weights.level - _firstLevel); }

    FaceClassOptions const& _options;
    int _firstLevel;  // of the surface's levels
    tables::TileRing _ring;
    RefinedTopology _topology;
    mutable tables::RegionLevels _levels;
    std::vector<std::unique_ptr<LimitStep<double>>> _limits;  // by level
    WeightHistory<double> _history;
    std::vector<bool> _isChanged;  // by its levels
    bool _hasWeights = false;
    tables::FlatRows _positionRows, _normalRows;  // of the first level's vertices and values; empty at level 0
};

}  // namespace surface
}  // namespace v1
}  // namespace osd_shading
