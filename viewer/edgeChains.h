// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "document.h"

namespace osd_shading::viewer {

/// The edges that belong with `start`: along a crease, where it is sharp, as far as just two sharp edges meet at
/// each vertex; otherwise along the loop that goes straight on at each vertex inside the mesh with an even number
/// of edges. `start` is the first of them; one alone where it is no edge of the model.
///
/// COST: linear in the faces.
std::vector<EdgeKey> ChainOf(io::Model const& model, Creases const& creases, EdgeKey const& start);

}  // namespace osd_shading::viewer
