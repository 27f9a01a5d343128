// SPDX-License-Identifier: Apache-2.0
#pragma once

/// \file
/// The program osd_shade, run as people run it.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <string>
#include <vector>

#include "tests/ioFiles.h"

namespace toolProgram {

using Words = std::vector<std::string>;

inline std::string ModelPath(std::string const& name) {
    return std::string(OSD_SHADING_MODELS) + "/" + name + ".obj";
}

inline std::string Quoted(std::string const& word) {
    std::string quoted = "'";
    for (char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return quoted + "'";
}

inline std::string CommandOf(Words const& words) {
    std::string command = Quoted(OSD_SHADE_PROGRAM);
    for (std::string const& word : words) command += " " + Quoted(word);
    return command;
}

struct Outcome {
    int status = -1;  ///< exit status; -1: ended by a signal
    std::string out, error;

    std::size_t NumErrorLines() const {
        return static_cast<std::size_t>(std::count(error.begin(), error.end(), '\n'));
    }
};

inline Outcome RunShell(std::string const& command) {
    ioFiles::TemporaryFolder const folder;
    int const status = std::system(
        ("{ " + command + "; } > " + Quoted(folder.File("out")) + " 2> " + Quoted(folder.File("error"))).c_str());
    Outcome outcome;
    outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    outcome.out = ioFiles::ReadBytes(folder.File("out"));
    outcome.error = ioFiles::ReadBytes(folder.File("error"));
    return outcome;
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
