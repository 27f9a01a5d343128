// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include "osd_shading/refinedTopology.h"
#include "osd_shading/shadingResult.h"

namespace osd_shading {
inline namespace v1 {

/// The kind of vertex that OpenSubdiv's rule makes.
VertexKind KindOf(Sdc::Crease::Rule rule);

/// What a vertex of a level is.
VertexTag TagOf(bool isCatmark, Far::TopologyLevel const& level, int vertex);

/// Adds a vertex with that tag to the counts.
void CountTag(VertexTag const& tag, ShadingReport& report);

}  // namespace v1
}  // namespace osd_shading
