// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/tables/tileWeights.h"

#include <gtest/gtest.h>

#include "osd_shading/oneShotShading.h"
#include "osd_shading/shadingTable.h"
#include "osd_shading/subdivisionShading.h"
#include "tests/sampleSize.h"
#include "tests/testHelpers.h"

namespace {

using namespace osd_shading;
using namespace osd_shading::tests;
using namespace osd_shading::tables;

/// b of a table beside the one-shot path's, which refines the whole mesh.
void ExpectSameWeights(Shape const& shape, ShadingOptions const& options, std::string const& what) {
    SCOPED_TRACE(shape.name + ", " + what);
    ShadingTable const table(shape.Mesh(), options);
    std::vector<float> const weights = table.BlendWeights();
    std::vector<int> const values = table.ResultValues();
    std::vector<double> const positions = shape.positions;
    ShadingInput<double> input;
    input.positions = {positions.data(), positions.size() / 3};
    ShadingResult<double> const result = ShadeSubdivision(shape.Mesh(), input, options);
    ASSERT_EQ(weights.size(), result.blendWeights.size());
    int numDifferent = 0, numOffSupport = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        double const b = result.blendWeights[Index(values[i])];
        numDifferent += !(std::fabs(b - double{weights[i]}) <= 1e-7);
        numOffSupport += (b > 0) != (weights[i] > 0);
    }
    EXPECT_EQ(numDifferent, 0);
    EXPECT_EQ(numOffSupport, 0);
    std::int64_t numBlended = 0;
    for (float const b : weights) numBlended += b > 0;
    EXPECT_EQ(numBlended, table.Stats().blendedValues);
}

TEST(TileWeights, StartAtOneOnTheRingsOfExtraordinaryVerticesAlone) {
    Shape const cube = shapes::Cube();
    RefinedTopology const topology(cube.Mesh(), 1);
    RegionLevels levels(topology);
    BlendWeightOptions options;
    options.level = 1;
    WeightSources const start = FindStartWeights(options, levels, 1, 4);
    // All 26 vertices of level 1 lie round one of the 8 corners; and so need no further seed.
    EXPECT_EQ(start.weights, std::vector<double>(26, 1.0));
    EXPECT_EQ(start.seeds, std::vector<std::uint32_t>(26, 0));
}

TEST(TileWeights, SeedLaterWhereASharpVertexWasSkipped) {
    // A corner of a cube whose three edges are sharp for two levels is extraordinary and smooth from level 2 on.
    Shape cube = shapes::Cube();
    RefinedTopology const plain(cube.Mesh(), 1);
    Far::TopologyLevel const& base = plain.Level(0);
    for (int const edge : base.GetVertexEdges(0)) {
        cube.creaseVertices.insert(cube.creaseVertices.end(),
                                   {base.GetEdgeVertices(edge)[0], base.GetEdgeVertices(edge)[1]});
        cube.creaseSharpness.push_back(2);
    }
    RefinedTopology const topology(cube.Mesh(), 1);
    RegionLevels levels(topology);
    BlendWeightOptions options;
    options.level = 1;
    WeightSources const start = FindStartWeights(options, levels, 1, 4);
    int const value = levels.Regions(1).FirstValue(0);
    EXPECT_EQ(start.weights[Index(value)], 0);
    EXPECT_EQ(start.seeds[Index(value)], 0b11100u);
}

TEST(TileWeights, AgreeWithTheWholeMeshOnEveryShape) {
    SweepSample sample(1);
    for (Shape const& shape : AllShapes()) {
        int const lowest = HasOnlyRegularFaces(shape) ? 0 : 1;
        for (auto const sharp :
             {SharpVertexWeight::Zero, SharpVertexWeight::Smooth, SharpVertexWeight::PerRegion}) {
            for (auto const darts : {DartWeight::LikeSmooth, DartWeight::LikeSharp}) {
                for (int level = lowest; level <= 4; level += 2) {
                    if (!sample.Takes()) continue;
                    ShadingOptions options = PaperPreset(level);
                    options.weights.sharpVertices = sharp;
                    options.weights.darts = darts;
                    ExpectSameWeights(shape, options, "level " + std::to_string(level));
                }
            }
        }
    }
}

TEST(TileWeights, AgreeWithTheWholeMeshOnRandomMeshesFromAnyLevels) {
    shapes::Random random(77);
    std::uint64_t numRefused = 0;
    for (std::uint64_t i = 0; i < SampleSize(200); ++i) {
        shapes::RandomShapeOptions kind;
        kind.triangles = random.Chance(0.4);
        kind.nonManifold = random.Chance(0.05);
        kind.chaikin = random.Chance(0.05);
        std::uint64_t const seed = random.Bits();
        Shape const shape = shapes::RandomShape(seed, kind);
        ShadingOptions options = PaperPreset(1 + random.Below(5));
        options.startNormals.level = random.Below(std::min(options.level, 2) + 1);
        options.weights.level = random.Below(options.level + 1);
        options.weights.sharpVertices = static_cast<SharpVertexWeight>(random.Below(3));
        options.weights.darts = static_cast<DartWeight>(random.Below(2));
        try {
            ExpectSameWeights(shape, options,
                              "seed " + std::to_string(seed) + ", L " + std::to_string(options.level) + ", n " +
                                  std::to_string(options.startNormals.level) + ", w " +
                                  std::to_string(options.weights.level) + ", variant " +
                                  std::to_string(static_cast<int>(options.weights.sharpVertices)));
        } catch (InvalidControlMesh const& error) {
            // Twin triangles, which some random meshes have.
            EXPECT_NE(std::string(error.what()).find("share two edges"), std::string::npos) << error.what();
            ++numRefused;
        }
    }
    EXPECT_LE(numRefused, SampleSize(200) / 20 + 1);
}

}  // namespace
