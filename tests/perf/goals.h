// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "accuracy.h"
#include "meshCase.h"
#include "osd_shading/shadingTable.h"
#include "scaling.h"

namespace perf {

/// All that was measured; what is missing makes rows without a verdict.
struct Measurements {
    std::vector<CaseFigures> cases;
    std::vector<ScalingFigures> scalingByLevel, scalingSeries;
    std::vector<std::pair<std::string, Accuracy>> accuracy;       ///< by mesh, level 4
    std::vector<osd_shading::ShadingTableStats> randomSharpness;  ///< tables of levels 4 and up
    std::map<std::string, double> instructions;                   ///< "MESH KIND" -> per value
};

enum class Verdict { Met, Missed, NotMeasured };

/// A line of the goals' table.
struct GoalRow {
    std::string what, goal, have;
    Verdict verdict = Verdict::NotMeasured;
};

std::vector<GoalRow> CompareWithGoals(Measurements const& measured);

}  // namespace perf
