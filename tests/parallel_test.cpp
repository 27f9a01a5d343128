// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace osd_shading;

TEST(Parallel, ChunksAreCountedUpToTheLastIndex) {
    EXPECT_EQ(NumChunks(0), 0);
    EXPECT_EQ(NumChunks(1), 1);
    EXPECT_EQ(NumChunks(4096), 1);
    EXPECT_EQ(NumChunks(4097), 2);
    EXPECT_EQ(NumChunks(std::numeric_limits<int>::max()), 524288);  // 2^31 / 2^12
}

TEST(Parallel, EveryItemIsVisitedOnceInTheSameChunkWhateverTheThreads) {
    int const numItems = 5 * kChunkSize + 17;
    for (int const numThreads : {-1, 0, 1, 2, 3, 64}) {
        std::vector<int> chunks(static_cast<std::size_t>(numItems), -1);
        std::atomic<int> numVisits{0};
        ParallelFor(numItems, numThreads, [&](int begin, int end, int chunk) {
            for (int i = begin; i < end; ++i) chunks[static_cast<std::size_t>(i)] = chunk;
            numVisits += end - begin;
        });
        EXPECT_EQ(numVisits, numItems);
        for (int i = 0; i < numItems; ++i) ASSERT_EQ(chunks[static_cast<std::size_t>(i)], i / kChunkSize);
    }
}

TEST(Parallel, WithoutItemsNothingIsCalled) {
    ParallelFor(0, 4, [](int, int, int) { FAIL(); });
}

TEST(Parallel, AnExceptionArrivesAtTheCallerAfterAllThreadsHaveEnded) {
    for (int const numThreads : {1, 4}) {
        std::atomic<int> running{0};
        std::string text;
        try {
            ParallelFor(40 * kChunkSize, numThreads, [&](int, int, int chunk) {
                ++running;
                if (chunk == 7) {
                    --running;
                    throw std::runtime_error("chunk 7");
                }
                --running;
            });
        } catch (std::runtime_error const& error) {
            text = error.what();
        }
        EXPECT_EQ(text, "chunk 7");
        EXPECT_EQ(running, 0);
    }
}

}  // namespace
