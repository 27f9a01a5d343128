// SPDX-License-Identifier: Apache-2.0
#include "stopwatch.h"

#include <algorithm>
#include <chrono>
#include <ctime>

namespace perf {

namespace {

constexpr double kTurnSeconds = 4e-3;
constexpr int kLeastTurns = 5, kMostTurns = 200;

double now(Clock clock) { return clock == Clock::Thread ? ThreadSeconds() : WallSeconds(); }

/// Runs `numFrames` frames and returns the time of one.
double timeFrames(Contender const& contender, int numFrames) {
    double const start = now(contender.clock);
    for (int i = 0; i < numFrames; ++i) contender.frame();
    return (now(contender.clock) - start) / numFrames;
}

}  // namespace

double ThreadSeconds() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double WallSeconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double Median(std::vector<double> values) {
    auto const middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

std::vector<double> SecondsPerFrame(std::vector<Contender> const& contenders, double seconds) {
    // The first frames find cold memory; they only tell how many fit into a turn.
    std::vector<int> numFrames;
    double turnSeconds = 0;
    for (Contender const& contender : contenders) {
        contender.frame();
        double const once = std::max(timeFrames(contender, 1), 1e-9);
        numFrames.push_back(std::clamp(static_cast<int>(kTurnSeconds / once), 1, 10'000));
        turnSeconds += once * (numFrames.back() + (once < kTurnSeconds ? 1 : 0));
    }

    int const numTurns = std::clamp(static_cast<int>(seconds / turnSeconds), kLeastTurns, kMostTurns);
    std::vector<std::vector<double>> times(contenders.size());
    for (int turn = 0; turn < numTurns; ++turn) {
        for (std::size_t i = 0; i < contenders.size(); ++i) {
            if (numFrames[i] > 1) contenders[i].frame();
            times[i].push_back(timeFrames(contenders[i], numFrames[i]));
        }
    }
    std::vector<double> medians;
    medians.reserve(times.size());
    for (auto const& series : times) medians.push_back(Median(series));
    return medians;
}

}  // namespace perf
