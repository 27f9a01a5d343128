// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/tables/frameThreads.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace {

using osd_shading::tables::FrameThreads;

TEST(FrameThreads, CallEachChunkOnceAndOneAtATimePerThread) {
    for (int const numThreads : {1, 2, 3, 8}) {
        FrameThreads threads(numThreads);
        ASSERT_GE(threads.NumThreads(), 1);
        ASSERT_LE(threads.NumThreads(), numThreads);
        auto const count = static_cast<std::size_t>(threads.NumThreads());
        for (int const numChunks : {0, 1, 2, 7, 500}) {
            std::vector<std::atomic<int>> calls(static_cast<std::size_t>(numChunks)), busy(count);
            std::atomic<int> numWrong{0};
            threads.Run(numChunks, [&](int chunk, int thread) {
                if (thread < 0 || thread >= threads.NumThreads()) {
                    ++numWrong;
                    return;
                }
                auto& mine = busy[static_cast<std::size_t>(thread)];
                if (++mine != 1) ++numWrong;
                ++calls[static_cast<std::size_t>(chunk)];
                std::this_thread::yield();
                --mine;
            });
            EXPECT_EQ(numWrong, 0);
            for (auto const& n : calls) EXPECT_EQ(n, 1);
        }
    }
}

TEST(FrameThreads, ANumberThatIsAMistakeTakesNotAllThreadsOfTheSystem) {
    FrameThreads threads(std::numeric_limits<int>::max());
    EXPECT_GE(threads.NumThreads(), 1);
    EXPECT_LE(threads.NumThreads(), static_cast<int>(std::max(256U, std::thread::hardware_concurrency())));
    std::atomic<int> numCalls{0};
    threads.Run(1000, [&](int, int) { ++numCalls; });
    EXPECT_EQ(numCalls, 1000);
}

TEST(FrameThreads, RunAgainAtOnceManyTimes) {
    FrameThreads threads(4);
    std::int64_t sum = 0;
    for (int run = 0; run < 2000; ++run) {
        std::atomic<std::int64_t> own{0};
        threads.Run(9, [&](int chunk, int) { own += chunk; });
        sum += own;
    }
    EXPECT_EQ(sum, 2000 * 36);
}

TEST(FrameThreads, RethrowWhatAChunkThrowsAndGoOnAfterwards) {
    for (int const numThreads : {1, 4}) {
        FrameThreads threads(numThreads);
        for (int round = 0; round < 20; ++round) {
            std::string text;
            try {
                threads.Run(50, [&](int chunk, int) {
                    if (chunk == 20) throw std::runtime_error("chunk 20");
                });
            } catch (std::runtime_error const& error) {
                text = error.what();
            }
            EXPECT_EQ(text, "chunk 20");
            std::atomic<int> numCalls{0};
            threads.Run(50, [&](int, int) { ++numCalls; });
            EXPECT_EQ(numCalls, 50);
        }
    }
}

TEST(FrameThreads, OfSeveralOwnersRunSideBySideAndInsideEachOther) {
    std::atomic<int> numCalls{0};
    std::vector<std::thread> owners;
    for (int i = 0; i < 3; ++i) {
        owners.emplace_back([&] {
            FrameThreads own(3);
            for (int run = 0; run < 50; ++run) own.Run(10, [&](int, int) { ++numCalls; });
        });
    }
    for (std::thread& owner : owners) owner.join();
    EXPECT_EQ(numCalls, 3 * 50 * 10);

    FrameThreads outer(3);
    outer.Run(4, [&](int, int) {
        FrameThreads inner(2);
        inner.Run(5, [&](int, int) { ++numCalls; });
    });
    EXPECT_EQ(numCalls, 3 * 50 * 10 + 20);
}

}  // namespace
