// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace perf {

/// What a child process left behind.
struct ChildOutcome {
    bool succeeded = false;
    std::int64_t peakBytes = 0;  ///< largest resident size, what the child inherited included
    std::string text;            ///< what `work` returned, or the error that it threw
};

/// Runs `work` in a forked process, so that neither its memory nor its heap's state reaches another measurement.
ChildOutcome RunInChild(std::function<std::string()> const& work);

/// Bytes that the system can give without swapping.
std::uint64_t AvailableBytes();

/// Processor time of this process in seconds, all threads: other processes disturb it less than they do wall time.
double ProcessorSeconds();

}  // namespace perf
