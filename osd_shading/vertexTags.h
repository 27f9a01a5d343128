// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include "osd_shading/refinedTopology.h"
#include "osd_shading/shadingResult.h"

namespace osd_shading {
inline namespace v1 {

/// The kind of vertex that OpenSubdiv's rule makes.
VertexKind KindOf(Sdc::Crease::Rule rule);

/// The kind of the child of a vertex `numLevels` further down, by the sharpness that is left there.
VertexKind KindBelow(RefinedTopology const& topology, int level, int vertex, int numLevels);

/// What a vertex of a level is.
VertexTag TagOf(bool isCatmark, Far::TopologyLevel const& level, int vertex);

/// Adds a vertex with that tag to the counts.
void CountTag(VertexTag const& tag, ShadingReport& report);

}  // namespace v1
}  // namespace osd_shading
