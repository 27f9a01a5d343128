// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <vector>

#include "osd_shading/fieldRefiner.h"
#include "osd_shading/limitMasks.h"
#include "osd_shading/shadingOptions.h"

namespace osd_shading {
inline namespace v1 {

/// The blend weight b of each value of the last level: its limit, in [0, 1].
///
/// At every level from the start level on, b is refined and eligible values are seeded. Eligible are extraordinary
/// vertices, by variant and dart rule:
///
///     variant A     all
///     variant B     those that are not sharp
///     variant C     smooth ones; darts; regions of creases and corners whose number of faces is not the regular
///     one
///                   and that stay creases or corners up to the last level
///
/// `levels` begins at the start level or before; `limit` is the last level's.
/// COST: one pass over vertices and masks of each level.   [ZBK23] Sec. 3.1-3.3
template <typename Real>
std::vector<Real> ComputeBlendWeights(BlendWeightOptions const& options, RefinedTopology const& topology,
                                      FieldLevels<Real> const& levels, LimitStep<Real> const& limit,
                                      int numThreads);

/// b on the meshes of all levels from the start level on, as seeded and before any limit.
template <typename Real>
struct WeightHistory {
    std::vector<std::vector<Real>> weights;  ///< by level from the start level on, per value
    std::vector<ValueMarks> changed;         ///< likewise: whether seeding changed what refining had given
};

/// Where `topology` is only some of the levels that weights go through.
template <typename Real>
struct WeightLevels {
    /// b of the start level, as seeded there, where levels above have given it. Null: it starts there, from zero.
    std::vector<Real> const* given = nullptr;
    int numBelow = 0;  ///< levels below the last: up to those vertices have to stay sharp that variant C seeds
};

/// REQUIRES: a scheme that seeds, other than One.
template <typename Real>
WeightHistory<Real> ComputeWeightHistory(BlendWeightOptions const& options, RefinedTopology const& topology,
                                         FieldLevels<Real> const& levels, WeightLevels<Real> const& part,
                                         int numThreads);

/// Sets b = 1 on the rings of eligible vertices of a level, or of their regions.
template <typename Real>
void SeedRings(BlendWeightOptions const& options, Far::TopologyLevel const& level, CreaseRegions const& regions,
               ValueMarks const& eligible, std::vector<Real>& weights);

/// Whether a vertex of this kind is a sharp one to b.
inline bool CountsAsSharp(BlendWeightOptions const& options, VertexKind kind) {
    return kind >= VertexKind::Crease || (kind == VertexKind::Dart && options.darts == DartWeight::LikeSharp);
}

/// Whether a region of a crease vertex has the regular number of faces.
inline bool IsRegularCreaseRegion(bool isCatmark, std::size_t numFaces) {
    return isCatmark ? numFaces == 2 : numFaces == 1 || numFaces == 3;
}

}  // namespace v1
}  // namespace osd_shading
