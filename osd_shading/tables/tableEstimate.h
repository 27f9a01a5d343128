// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <cstdint>
#include <functional>

#include "osd_shading/refinedTopology.h"
#include "osd_shading/shadingTable.h"

namespace osd_shading {
inline namespace v1 {
namespace tables {

/// Bytes that building a table takes at most, the table included: an estimate from above, from level 0 alone. Each
/// irregular face counts as if no other were like it, so it is 2 to 3 times what meshes take that are made to have
/// no like faces, and 4 to 20 times what others do. Saturates.
std::uint64_t EstimateTableBytes(RefinedTopology const& base, ShadingOptions const& options, ValueOrder order);

/// Throws MemoryLimitExceeded where that is more than `options.execution.memoryLimit`, or where levels that must be
/// refined as a whole have more elements than 32-bit indices can number.
void CheckTableMemory(RefinedTopology const& base, ShadingOptions const& options, ValueOrder order);

/// Tells the caller's function how much is done, and throws Cancelled where it has had enough.
class BuildProgress {
public:
    /// `progress` may be empty, and must outlive this object.
    explicit BuildProgress(std::function<bool(double)> const& progress) : _progress(progress) {}

    /// What is told from now on is a share of [`begin`, `end`] of the whole.
    void Enter(double begin, double end);
    /// The share of the present part that is done; passed on when there is something to tell.
    void Tell(double share);

private:
    std::function<bool(double)> const& _progress;
    double _begin = 0, _end = 1, _told = -1;
};

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
