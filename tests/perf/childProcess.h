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

/// What a run finds in the heap. Left alone, the smaller of two alternating runs gets the other's memory for
/// nothing, and whether it does depends on the sizes.
enum class HeapState {
    Cold,  ///< nothing: each run takes fresh pages from the system, as in a program that shades once
    Warm   ///< all it needs: the cost of computing alone
};

/// Gives the heap's free pages back to the system (glibc; elsewhere nothing).
void ReturnFreedMemory();
/// From now on the heap keeps what is freed (glibc; elsewhere nothing).
void KeepFreedMemory();

}  // namespace perf
