// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "goals.h"

namespace perf {

void PrintCases(std::vector<CaseFigures> const& cases);
void PrintScaling(std::vector<ScalingFigures> const& series);
void PrintGoals(std::vector<GoalRow> const& rows);

/// Throws std::runtime_error where `file` can't be written.
void WriteJson(std::string const& file, Measurements const& measured, std::vector<GoalRow> const& rows);

}  // namespace perf
