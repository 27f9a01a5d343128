// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include "osd_shading/refinedTopology.h"

namespace osd_shading {
inline namespace v1 {

/// Whether a vertex's number of edges is not the regular one, sharp or not.
///
///     Catmull-Clark   interior 4, boundary 3
///     Loop            interior 6, boundary 4
///
/// A boundary vertex of one face is regular where it follows the corner rule; isolated vertices are not
/// extraordinary.
inline bool IsExtraordinary(bool isCatmark, Far::TopologyLevel const& level, int vertex) {
    int const numFaces = level.GetVertexFaces(vertex).size();
    if (numFaces == 0) return false;
    bool const isBoundary = level.IsVertexBoundary(vertex);
    if (isBoundary && numFaces == 1 && level.GetVertexRule(vertex) == Sdc::Crease::RULE_CORNER) return false;
    int const regular = isCatmark ? (isBoundary ? 3 : 4) : (isBoundary ? 4 : 6);
    return level.GetVertexEdges(vertex).size() != regular;
}
inline bool IsExtraordinary(RefinedTopology const& topology, Far::TopologyLevel const& level, int vertex) {
    return IsExtraordinary(topology.IsCatmark(), level, vertex);
}

}  // namespace v1
}  // namespace osd_shading
