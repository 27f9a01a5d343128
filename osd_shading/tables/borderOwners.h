// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <vector>

#include "osd_shading/tables/tableData.h"
#include "osd_shading/tables/tileOwnership.h"
#include "osd_shading/tables/tileRing.h"

namespace osd_shading {
inline namespace v1 {
namespace tables {

/// Whether Chaikin's rule leaves open what becomes of some edge: then every level must be refined.
bool NeedsAllLevels(Far::TopologyRefiner const& refiner);

/// Shares out the values at the control mesh's vertices and along its edges among the tiles.
class BorderOwners {
public:
    /// Fills `data.cornerOwners` and `data.edgeTwins`, of which the mesh and options are known. `all` has every
    /// level where NeedsAllLevels. All arguments must outlive this object.
    BorderOwners(RefinedTopology const& topology, RefinedTopology const& all, TableData& data);

    /// What the tile of a control face writes on its border.
    TileOwnership Of(int face) const;

private:
    RefinedTopology const& _topology;
    RefinedTopology const& _all;
    TableData const& _data;
    std::vector<bool> _ownsMiddle;  // by face corner: the middle of the edge after it
};

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
