// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace perf {

/// Runs frames of level 4 for callgrind to count, which is told to collect in `CountedFrames` alone
/// (`instructions.sh`), and prints "VALUES FRAMES" on standard output.
///
/// `mesh`: fandisk, rockerarm, spot or the name of one of our models. `kind`: shaded, limit, smooth or openSubdiv.
/// `instructionSet`: best, portable, sse2, avx2 or avx512. Returns the program's exit status; 3 where the mesh or
/// the instruction set is not there.
int RunCallgrindBody(std::string const& mesh, std::string const& kind, std::string const& instructionSet,
                     std::string const& extraModels);

}  // namespace perf
