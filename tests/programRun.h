// SPDX-License-Identifier: Apache-2.0
#pragma once

/// \file
/// Programs run as people run them, through a shell.

#include <sys/wait.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <string>
#include <vector>

#include "tests/ioFiles.h"

namespace programRun {

using Words = std::vector<std::string>;

inline std::string ModelPath(std::string const& name) {
    return std::string(OSD_SHADING_MODELS) + "/" + name + ".obj";
}

inline std::string Quoted(std::string const& word) {
    std::string quoted = "'";
    for (char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return quoted + "'";
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

}  // namespace programRun
