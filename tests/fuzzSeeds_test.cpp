// SPDX-License-Identifier: Apache-2.0

// The fuzzers' targets without libFuzzer: on their seeds, what they once found among them, and on random bytes.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/fuzz/fuzzTargets.h"
#include "tests/ioFiles.h"
#include "tests/sampleSize.h"
#include "tests/shapes.h"

namespace {

using Target = void (*)(std::uint8_t const*, std::size_t);

void run(Target target, std::string const& bytes) {
    target(reinterpret_cast<std::uint8_t const*>(bytes.data()), bytes.size());
}

/// Runs each file of the folder `name`, all its beginnings too where `isCut`. A target that fails ends the program.
void runSeeds(Target target, std::string const& name, bool isCut) {
    std::vector<std::filesystem::path> files;
    for (auto const& entry : std::filesystem::directory_iterator(OSD_SHADING_FUZZ_SEEDS "/" + name)) {
        files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    EXPECT_GE(files.size(), 2U);
    for (auto const& file : files) {
        SCOPED_TRACE(file.string());
        std::string const bytes = ioFiles::ReadBytes(file.string());
        ASSERT_FALSE(bytes.empty());
        run(target, bytes);
        for (std::size_t size = 0; isCut && size < bytes.size(); ++size) run(target, bytes.substr(0, size));
    }
}

TEST(FuzzSeeds, OfObjFilesKeepEveryPromiseWholeAndCut) { runSeeds(fuzz::FuzzObj, "obj", true); }

TEST(FuzzSeeds, OfSharpFilesKeepEveryPromiseWholeAndCut) { runSeeds(fuzz::FuzzSharp, "sharp", true); }

TEST(FuzzSeeds, OfMeshesKeepEveryPromise) { runSeeds(fuzz::FuzzMesh, "mesh", false); }

TEST(FuzzSeeds, ChangedAtRandomMeshesKeepEveryPromise) {
    std::string const folder = OSD_SHADING_FUZZ_SEEDS "/mesh";
    shapes::Random random(1);
    for (auto const& entry : std::filesystem::directory_iterator(folder)) {
        std::string const seed = ioFiles::ReadBytes(entry.path().string());
        for (std::uint64_t i = 0; i < osd_shading::tests::SampleSize(200); ++i) {
            std::string bytes = seed;
            for (int edits = 1 + random.Below(8); edits > 0; --edits) {
                bytes[static_cast<std::size_t>(random.Below(static_cast<int>(bytes.size())))] =
                    static_cast<char>(random.Below(256));
            }
            run(fuzz::FuzzMesh, bytes);
        }
    }
}

}  // namespace
