// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <chrono>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "osd_shading/refinedTopology.h"
#include "osd_shading/shadingInput.h"
#include "osd_shading/shadingResult.h"

namespace osd_shading {
inline namespace v1 {

/// Times the stages of a run and tells the caller how far it is.
class StageClock {
public:
    explicit StageClock(std::function<bool(double)> const& progress) : _progress(progress) {}

    /// Ends the stage `name`; `done` is the share of the whole run that is behind. Throws Cancelled.
    void End(char const* name, double done);

    std::vector<std::pair<std::string, double>> const& Seconds() const { return _seconds; }

private:
    std::function<bool(double)> const& _progress;
    std::chrono::steady_clock::time_point _start = std::chrono::steady_clock::now();
    std::vector<std::pair<std::string, double>> _seconds;
};

/// `options` with start levels and thread count in place of their defaults; throws InvalidOptions.
ShadingOptions ResolveOptions(ShadingOptions options, bool hasIrregularFaces, Sdc::SchemeType scheme);
ShadingOptions ResolveOptions(ShadingOptions const& options, ControlMesh const& mesh);
ShadingOptions ResolveOptions(ShadingOptions const& options, Far::TopologyRefiner const& refiner);

/// The whole method once, level by level: the reference for everything faster. `options` are resolved, `input` and
/// its counts are valid.   [ZBK23] Sec. 2 and 3
template <typename Real>
ShadingResult<Real> ShadeOnce(RefinedTopology const& topology, ShadingInput<Real> const& input,
                              ShadingOptions const& options, StageClock& clock);

}  // namespace v1
}  // namespace osd_shading
