// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "commandLine.h"
#include "frameTimes.h"
#include "osd_shading/geometryCheck.h"
#include "osd_shading/shadingResult.h"
#include "osd_shading/shadingTable.h"

namespace osd_shading::tool {

/// What a run has to tell, whatever its precision.
struct RunSummary {
    ShadingOptions options;  ///< as resolved by the library
    SubdivisionRules rules;  ///< as resolved from command line and tags
    ShadingReport shading;

    int maxAngleVertex = -1;  ///< where N_B departs most from N_L; -1: there is no value
    Vec3<double> maxAnglePosition;

    std::optional<GeometryCheck> check;
    std::optional<ShadingTableStats> table;  ///< with --frames and --stats
    std::optional<FrameTimes> frames;
    std::vector<std::pair<std::string, double>> seconds;  ///< wall time of each stage, in order
    std::uint64_t peakBytes = 0;
};

/// The short table for people; ends with a newline.
std::string TableText(CommandLine const& line, RunSummary const& run);

/// The same, and what was asked for, as JSON; ends with a newline.
std::string JsonText(CommandLine const& line, RunSummary const& run);

}  // namespace osd_shading::tool
