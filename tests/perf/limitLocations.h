// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opensubdiv/far/topologyRefiner.h>

#include <cstddef>
#include <vector>

namespace perf {

namespace Far = OpenSubdiv::OPENSUBDIV_VERSION::Far;

/// Places on the limit surface, as Far::LimitStencilTableFactory takes them.
struct LimitLocations {
    std::vector<int> ptexFaces;  ///< ascending
    std::vector<float> u, v;

    std::size_t Size() const { return u.size(); }
};

/// Those of the vertices of the uniform mesh at level `level`, each once.
///
/// A vertex on the border of control faces is placed on the first of them.
///
/// REQUIRES: a Catmull-Clark or Loop refiner, refined or not; `level` >= 1 where there are n-gons; no holes.
LimitLocations UniformLocations(Far::TopologyRefiner const& refiner, int level);

}  // namespace perf
