// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <thread>
#include <vector>

namespace osd_shading {
inline namespace v1 {

/// Items of one chunk: fixed, so that what is gathered chunk by chunk does not depend on the threads.
constexpr int kChunkSize = 4096;

inline int NumChunks(int numItems) {
    return static_cast<int>((static_cast<std::int64_t>(numItems) + kChunkSize - 1) / kChunkSize);
}

/// Calls `body(item)` for each item of [0, numItems), one by one, on `numThreads` threads at most. When all threads
/// have ended, an exception of one of them is rethrown.
template <typename Body>
void ParallelForEach(int numItems, int numThreads, Body const& body) {
    numThreads = std::min(numThreads, numItems);
    if (numThreads <= 1) {
        for (int item = 0; item < numItems; ++item) body(item);
        return;
    }
    std::atomic<int> next{0};
    std::vector<std::exception_ptr> failures(static_cast<std::size_t>(numThreads));
    auto const work = [&](std::size_t thread) {
        try {
            for (int item = next++; item < numItems; item = next++) body(item);
        } catch (...) {
            failures[thread] = std::current_exception();
            next = numItems;
        }
    };
    std::vector<std::thread> threads;
    threads.reserve(failures.size());
    try {
        for (std::size_t i = 1; i < failures.size(); ++i) threads.emplace_back(work, i);
    } catch (...) {
        // A system that is short of threads or memory gets the same result from fewer threads.
    }
    work(0);
    for (std::thread& thread : threads) thread.join();
    for (std::exception_ptr const& failure : failures) {
        if (failure) std::rethrow_exception(failure);
    }
}

/// Calls `body(begin, end, chunk)` for every chunk of [0, numItems), likewise.
template <typename Body>
void ParallelFor(int numItems, int numThreads, Body const& body) {
    ParallelForEach(NumChunks(numItems), numThreads, [&](int chunk) {
        int const begin = chunk * kChunkSize;
        body(begin, std::min(numItems - begin, kChunkSize) + begin, chunk);
    });
}

}  // namespace v1
}  // namespace osd_shading
