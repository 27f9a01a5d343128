// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <utility>
#include <vector>

#include "osd_shading/refinedTopology.h"

namespace osd_shading {
inline namespace v1 {

/// Pairs of triangles that share two edges, and so all vertices. From level 1 on edges between them join the same
/// two vertices, and are one edge to whoever makes a mesh of their faces anew.
std::vector<std::pair<int, int>> FindBackToBack(Far::TopologyLevel const& level);

}  // namespace v1
}  // namespace osd_shading
