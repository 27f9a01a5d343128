// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <vector>

#include "osd_shading/tables/tileRing.h"

namespace osd_shading {
inline namespace v1 {
namespace surface {

using tables::FaceCorner;
using tables::RegionLevels;
using tables::TileRing;

/// A face with the faces of its own region at each of its vertices, as a mesh of its own in which what is sharp is
/// infinitely sharp: all that the limit surface over the face depends on, this side of sharp edges. Its tile face
/// is face 0. What lies across a sharp edge, a non-manifold one too, is there only where that ends in a dart.
TileRing FindRegionRing(RegionLevels& levels, int level, int face);

/// A vertex where the two edges that stay sharp are not the borders of each of its regions: one region begins and
/// ends at the same edge, a non-manifold one. OpenSubdiv's limit of the vertex lies along both; fields of the
/// region follow its one edge, so that they and the points are not refined by the same rows. `edge` is that edge;
/// -1: there is none.
struct OneBorder {
    int vertex = -1, edge = -1;
};
OneBorder FindOneBorder(Far::TopologyLevel const& level);

/// The rules by which a region ring is refined.
SubdivisionRules RulesOfRings(Sdc::SchemeType scheme);

/// Whether all that is sharp at a face's vertices stays so for `numLevels` levels more.
bool StaysAsItIs(RegionLevels& levels, int level, int face, int numLevels);

/// A control point of a regular patch: found on the mesh, or 2 or 3 others': a phantom beyond a sharp edge.
struct PatchPoint {
    FaceCorner at;
    struct Term {
        int point;  ///< of the patch; found ones, or phantoms before this one
        double weight;
    };
    std::vector<Term> terms;  ///< empty where it was found
};

/// The control points of a region ring's tile face in the order of the patch bases, phantoms' order in `order`;
/// empty where the surface over it is no regular patch.
struct RegularPatch {
    std::vector<PatchPoint> points;
    std::vector<int> order;  ///< of phantoms
    bool IsFound() const { return !points.empty(); }
};
RegularPatch FindRegularPatch(RegionLevels& levels, int level, int face);

}  // namespace surface
}  // namespace v1
}  // namespace osd_shading
