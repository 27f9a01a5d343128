// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace perf {

/// Processor time of the calling thread in seconds: other programs disturb it less than wall time.
double ThreadSeconds();

/// Wall time in seconds, from some moment.
double WallSeconds();

/// REQUIRES: `values` isn't empty.
double Median(std::vector<double> values);

/// Which clock counts: wall time where several threads work.
enum class Clock { Thread, Wall };

/// Something that is run again and again: `frame` once is one frame.
struct Contender {
    std::function<void()> frame;
    Clock clock = Clock::Thread;
};

/// Seconds per frame of each contender: medians over turns, in which each runs for some milliseconds, so that all
/// meet the same disturbances. At the start of its turn each runs one frame off the clock, unless that is longer
/// than the turn: the caches are then its own.
///
/// `seconds` is about how long all of it takes; each has 5 turns at least.
std::vector<double> SecondsPerFrame(std::vector<Contender> const& contenders, double seconds);

/// Median processor time of `numRuns` runs; what `run` returns is destroyed off the clock.
template <typename Run>
double MedianSeconds(int numRuns, Run const& run) {
    std::vector<double> seconds;
    for (int i = 0; i < numRuns; ++i) {
        double const start = ThreadSeconds();
        auto const result = run();
        seconds.push_back(ThreadSeconds() - start);
    }
    return Median(seconds);
}

}  // namespace perf
