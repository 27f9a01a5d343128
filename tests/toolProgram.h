// SPDX-License-Identifier: Apache-2.0
#pragma once

/// \file
/// The program osd_shade, run as people run it.

#include <gtest/gtest.h>

#include <string>

#include "tests/programRun.h"

namespace toolProgram {

using programRun::ModelPath;
using programRun::Outcome;
using programRun::Quoted;
using programRun::RunShell;
using programRun::Words;

inline std::string CommandOf(Words const& words) {
    std::string command = Quoted(OSD_SHADE_PROGRAM);
    for (std::string const& word : words) command += " " + Quoted(word);
    return command;
}

inline Outcome RunTool(Words const& words) { return RunShell(CommandOf(words)); }

/// Expects one line of error that has `part`.
inline void ExpectRefused(Words const& words, std::string const& part) {
    Outcome const outcome = RunTool(words);
    EXPECT_EQ(outcome.status, 2) << CommandOf(words);
    EXPECT_EQ(outcome.NumErrorLines(), 1U) << outcome.error;
    EXPECT_EQ(outcome.error.rfind("osd_shade: error: ", 0), 0U) << outcome.error;
    EXPECT_NE(outcome.error.find(part), std::string::npos) << "'" << part << "' is not in: " << outcome.error;
    EXPECT_EQ(outcome.out, "");
}

}  // namespace toolProgram
