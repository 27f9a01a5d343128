// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/tables/tableEstimate.h"

#include <gtest/gtest.h>

#include "osd_shading/oneShotShading.h"
#include "tests/sampleSize.h"
#include "tests/testHelpers.h"

namespace {

using namespace osd_shading;
using namespace osd_shading::tests;
using namespace osd_shading::tables;

std::uint64_t EstimateOf(Shape const& shape, ShadingOptions const& options, ValueOrder order = ValueOrder::Tiles) {
    RefinedTopology const base(shape.Mesh(), 0);
    return EstimateTableBytes(base, ResolveOptions(options, shape.Mesh()), order);
}

TEST(TableEstimate, IsNeverLessThanTheTable) {
    SweepSample sample(1);
    for (Shape const& shape : AllShapes()) {
        for (int level = HasOnlyRegularFaces(shape) ? 0 : 1; level <= 4; ++level) {
            for (ShadingOptions const& options : {PaperPreset(level), SmoothPreset(level)}) {
                for (auto const order : {ValueOrder::Tiles, ValueOrder::OpenSubdiv}) {
                    if (!sample.Takes()) continue;
                    ShadingTable const table(shape.Mesh(), options, order);
                    EXPECT_GE(EstimateOf(shape, options, order), table.NumBytes())
                        << shape.name << ", level " << level;
                }
            }
        }
    }
}

TEST(TableEstimate, GrowsWithTheSquareOfAPolesValence) {
    double const some = static_cast<double>(EstimateOf(shapes::Bipyramid(500), PaperPreset(3)));
    double const twice = static_cast<double>(EstimateOf(shapes::Bipyramid(1000), PaperPreset(3)));
    EXPECT_GT(twice / some, 3);
}

TEST(TableEstimate, OfARegularMeshHardlyGrowsWithTheLevel) {
    Shape const torus = shapes::Torus(20, 20);
    EXPECT_EQ(EstimateOf(torus, PaperPreset(4)), EstimateOf(torus, PaperPreset(10)));
}

TEST(TableEstimate, IsWhatATableIsRefusedBy) {
    Shape const cube = shapes::Cube();
    ShadingOptions options = PaperPreset(3);
    std::uint64_t const bytes = EstimateOf(cube, options);
    options.execution.memoryLimit = bytes;
    EXPECT_NO_THROW(ShadingTable(cube.Mesh(), options));
    options.execution.memoryLimit = bytes - 1;
    EXPECT_EQ(ErrorOf<MemoryLimitExceeded>([&] { ShadingTable(cube.Mesh(), options); }),
              "a table of level 3 would take about " + std::to_string(bytes) + " bytes, more than the limit of " +
                  std::to_string(bytes - 1) + "; use a lower level or raise the limit");
    // Whole levels count in 32 bits.
    options = PaperPreset(14);
    options.weights.scheme = WeightScheme::Bilinear;
    EXPECT_NE(ErrorOf<MemoryLimitExceeded>([&] { ShadingTable(cube.Mesh(), options); }), "no error");
}

TEST(BuildProgress, AscendsToOneAndMayEndTheBuildAnywhere) {
    Shape const torus = shapes::Torus(20, 20).CreaseAll(1.5F);
    ShadingOptions options = PaperPreset(3);
    std::vector<double> told;
    options.execution.progress = [&](double done) {
        told.push_back(done);
        return true;
    };
    ShadingTable const table(torus.Mesh(), options);
    ASSERT_GT(told.size(), 10u);
    EXPECT_EQ(told.front(), 0);
    EXPECT_EQ(told.back(), 1);
    for (std::size_t i = 1; i < told.size(); ++i) EXPECT_LT(told[i - 1], told[i]);
    for (std::size_t end = 1; end <= told.size(); end += 7) {
        std::size_t count = 0;
        options.execution.progress = [&](double) { return ++count < end; };
        EXPECT_EQ(ErrorOf<Cancelled>([&] { ShadingTable(torus.Mesh(), options); }), "the build was abandoned");
        EXPECT_EQ(count, end);
    }
}

}  // namespace
