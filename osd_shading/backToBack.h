// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <string>

#include "osd_shading/refinedTopology.h"

namespace osd_shading {
inline namespace v1 {

/// Refuses two triangles that share two edges, and so all vertices. From level 1 on edges between them join the
/// same two vertices, and are one edge to whoever makes a mesh of their faces anew. `why` goes on after "share two
/// edges, ".
///
/// ERRORS: InvalidControlMesh.
void RefuseBackToBack(Far::TopologyLevel const& level, std::string const& why);

}  // namespace v1
}  // namespace osd_shading
