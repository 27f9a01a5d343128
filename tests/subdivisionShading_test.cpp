// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/subdivisionShading.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "tests/testHelpers.h"

namespace {

using namespace osd_shading;
using namespace osd_shading::tests;

/// A cube's arrays, and an input that refers to them, with texture coordinates and a colour.
struct CubeInput {
    Shape shape = shapes::CubeWithSharpTop(1.5F);
    std::vector<Vec3<double>> points = PointsOf<double>(shape), normals = points;
    std::vector<double> uvs = std::vector<double>(shape.positions.begin(), shape.positions.begin() + 16);
    ShadingInput<double> input;

    CubeInput() {
        input.positions = points;
        input.vertexData.push_back({shape.positions.data(), 8, 3});
        input.faceVaryingData.push_back({shape.faceVertices, {uvs.data(), 8, 2}});
    }
    CubeInput(CubeInput const&) = delete;
    ShadingResult<double> Shade(ShadingOptions const& options = PaperPreset(2)) const {
        return ShadeSubdivision(shape.Mesh(), input, options);
    }
    std::string Error(ShadingOptions const& options = PaperPreset(2)) const {
        return ErrorOf<InvalidControlMesh>([&] { Shade(options); });
    }
};

TEST(SubdivisionShading, ACubeAtLevelZeroIsItsOwnLimit) {
    // The corners' limits, and b = 1 on the ring of every corner: all of the cube.
    ShadingResult<double> const cube = Shade<double>(shapes::Cube(), PaperPreset(0));
    EXPECT_EQ(cube.NumVertices(), 8);
    EXPECT_EQ(cube.faceVertices, shapes::Cube().faceVertices);
    EXPECT_EQ(cube.baseFaces, (std::vector<int>{0, 1, 2, 3, 4, 5}));
    for (double const b : cube.blendWeights) EXPECT_NEAR(b, 1, 1e-15);
    EXPECT_EQ(cube.options.startNormals.level, 0);
    EXPECT_EQ(cube.options.weights.level, 0);
}

TEST(SubdivisionShading, ARefinerInAnyStateGivesTheSameBitsAndIsLeftAsItIs) {
    CubeInput const own;
    ShadingResult<double> const expected = own.Shade();
    for (int const state : {0, 1, 2}) {  // unrefined, refined uniformly, refined adaptively
        std::unique_ptr<Far::TopologyRefiner> refiner =
            shapes::MakeRefiner(own.shape, state == 1 ? 3 : 0, own.shape.faceVertices, 8);
        if (state != 1) refiner->Unrefine();
        if (state == 2) refiner->RefineAdaptive(Far::TopologyRefiner::AdaptiveOptions(3));
        int const numLevels = refiner->GetNumLevels(), numFaces = refiner->GetNumFacesTotal();
        ShadingInput<double> input = own.input;
        input.faceVaryingData[0].indices = {};  // the refiner's channel is used
        EXPECT_TRUE(IsSameResult(ShadeSubdivision(*refiner, input, PaperPreset(2)), expected)) << state;
        EXPECT_EQ(refiner->GetNumLevels(), numLevels);
        EXPECT_EQ(refiner->GetNumFacesTotal(), numFaces);
    }
}

TEST(SubdivisionShading, ARefinerOfEveryShapeGivesTheSameBits) {
    for (Shape const& shape : AllShapes()) {
        std::vector<Vec3<float>> const points = PointsOf<float>(shape);
        ShadingInput<float> input;
        input.positions = points;
        std::unique_ptr<Far::TopologyRefiner> const refiner = shapes::MakeRefiner(shape, 1);
        EXPECT_TRUE(
            IsSameResult(ShadeSubdivision(*refiner, input, PaperPreset(2)), Shade<float>(shape, PaperPreset(2))))
            << shape.name;
    }
}

TEST(SubdivisionShading, StridedInputGivesTheSameBitsAsPacked) {
    CubeInput packed;
    packed.input.vertexNormals = packed.normals;
    ShadingOptions options = PaperPreset(2);
    options.startNormals.kind = StartNormalKind::User;
    ShadingResult<double> const expected = packed.Shade(options);
    // One buffer of position, normal, texture coordinates and padding: what is between must not be read.
    std::size_t const stride = 9;
    std::vector<double> buffer(8 * stride, std::numeric_limits<double>::quiet_NaN());
    for (std::size_t v = 0; v < 8; ++v) {
        for (std::size_t i = 0; i < 3; ++i) {
            buffer[v * stride + i] = packed.shape.positions[3 * v + i];
            buffer[v * stride + 3 + i] = packed.shape.positions[3 * v + i];
        }
        for (std::size_t i = 0; i < 2; ++i) buffer[v * stride + 6 + i] = packed.uvs[2 * v + i];
    }
    ShadingInput<double> input;
    input.positions = {buffer.data(), 8, stride};
    input.vertexNormals = {buffer.data() + 3, 8, stride};
    input.vertexData.push_back({buffer.data(), 8, 3, stride});
    input.faceVaryingData.push_back({packed.shape.faceVertices, {buffer.data() + 6, 8, 2, stride}});
    EXPECT_TRUE(IsSameResult(ShadeSubdivision(packed.shape.Mesh(), input, options), expected));
}

TEST(SubdivisionShading, TheThreadsChangeNoBit) {
    for (Shape const& shape : {shapes::TorusWithCreaseRing(2.5F), shapes::MixedPolygons().CreasePath({1, 8, 9}),
                               shapes::Icosahedron().Crease(0, 11).Loop()}) {
        for (ShadingOptions options : {PaperPreset(5), SmoothPreset(5)}) {
            ShadingResult<float> const expected = Shade<float>(shape, options);
            for (int const numThreads : {0, 2, 7}) {
                options.execution.numThreads = numThreads;
                EXPECT_TRUE(IsSameResult(Shade<float>(shape, options), expected)) << shape.name;
            }
        }
    }
}

TEST(SubdivisionShading, FloatAndDoubleAgreeWithinFloatPrecision) {
    for (Shape const& shape : AllShapes()) {
        ShadingResult<float> const single = Shade<float>(shape, PaperPreset(3));
        ShadingResult<double> const twice = Shade<double>(shape, PaperPreset(3));
        ASSERT_EQ(single.faceValues, twice.faceValues);
        auto const widened = [](Vec3<float> const& a) { return Vec3<double>{a.x, a.y, a.z}; };
        for (std::size_t v = 0; v < twice.positions.size(); ++v) {
            // Points of size 1 to 4, some 10 roundings of 6e-8.
            ASSERT_LE(Distance(widened(single.positions[v]), twice.positions[v]), 4e-6) << shape.name;
        }
        for (std::size_t i = 0; i < twice.blendWeights.size(); ++i) {
            ASSERT_NEAR(single.blendWeights[i], twice.blendWeights[i], 2e-6) << shape.name;
            // Differences of points a tenth apart and smaller at level 3 lose one to two digits.
            ASSERT_LE(Distance(widened(single.limitNormals[i]), twice.limitNormals[i]), 2e-4) << shape.name;
            ASSERT_LE(Distance(widened(single.blendedNormals[i]), twice.blendedNormals[i]), 2e-4) << shape.name;
        }
    }
}

TEST(SubdivisionShading, UserNormalsPerVertexEqualTheSamePerFaceCorner) {
    CubeInput perVertex, perCorner;
    perVertex.input.vertexNormals = perVertex.normals;
    std::vector<Vec3<double>> corners;
    for (int const v : perCorner.shape.faceVertices) corners.push_back(perVertex.normals[Index(v)]);
    perCorner.input.faceVaryingNormals = corners;
    ShadingOptions options = PaperPreset(2);
    options.startNormals.kind = StartNormalKind::User;
    ShadingResult<double> const result = perVertex.Shade(options);
    EXPECT_TRUE(IsSameResult(perCorner.Shade(options), result));
    EXPECT_EQ(result.options.startNormals.level, 0);
}

TEST(SubdivisionShading, UserNormalsMustBeCompleteAndGivenOnce) {
    ShadingOptions options = PaperPreset(2);
    options.startNormals.kind = StartNormalKind::User;
    CubeInput cube;
    EXPECT_EQ(cube.Error(options), "user start normals need vertexNormals or faceVaryingNormals; both are empty");
    std::vector<Vec3<double>> corners(24, Vec3<double>{0, 0, 1});
    cube.input.vertexNormals = cube.normals;
    cube.input.faceVaryingNormals = corners;
    EXPECT_EQ(cube.Error(options), "both vertexNormals and faceVaryingNormals are given; give one");
    cube.input.vertexNormals = {};
    corners[17].y = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(cube.Error(options), "faceVaryingNormals: face corner 17 is not finite");
    cube.input.faceVaryingNormals = {&corners[0].x, 23};
    EXPECT_EQ(cube.Error(options), "faceVaryingNormals has 23 elements; the mesh needs 24, one per face corner");
    cube.input.faceVaryingNormals = {};
    cube.normals[3].x = std::numeric_limits<double>::quiet_NaN();
    cube.input.vertexNormals = cube.normals;
    EXPECT_EQ(cube.Error(options), "vertexNormals: vertex 3 is not finite");
    cube.input.vertexNormals = {&cube.normals[0].x, 8, 1};
    EXPECT_EQ(cube.Error(options), "vertexNormals: its stride is 1; give 3 or more");
}

TEST(SubdivisionShading, ProgressGrowsToOneFromTheCallingThread) {
    std::vector<double> shares;
    ShadingOptions options = PaperPreset(3);
    options.execution.numThreads = 2;
    options.execution.progress = [&](double share) {
        shares.push_back(share);
        return true;
    };
    ShadingResult<double> const result = Shade<double>(shapes::Cube(), options);
    ASSERT_FALSE(shares.empty());
    EXPECT_GT(shares.front(), 0);
    for (std::size_t i = 1; i < shares.size(); ++i) EXPECT_GT(shares[i], shares[i - 1]);
    EXPECT_EQ(shares.back(), 1);
    ASSERT_EQ(result.report.seconds.size(), shares.size());
    for (auto const& [stage, seconds] : result.report.seconds) {
        EXPECT_FALSE(stage.empty());
        EXPECT_GE(seconds, 0);
    }
}

TEST(SubdivisionShading, ARunIsAbandonedWhereverProgressReturnsFalse) {
    for (int last = 1; last <= 8; ++last) {
        int numCalls = 0;
        ShadingOptions options = PaperPreset(2);
        options.execution.progress = [&](double) { return ++numCalls < last; };
        EXPECT_EQ(ErrorOf<Cancelled>([&] { Shade<double>(shapes::Cube(), options); }), "the run was abandoned");
        EXPECT_EQ(numCalls, last);
    }
}

MeshSize CubeSize() { return {Sdc::SCHEME_CATMARK, 8, 6, 24}; }

TEST(SubdivisionShading, TheMemoryLimitRefusesBeforeRefiningWithTheNumber) {
    ShadingOptions options = PaperPreset(5);
    int numCalls = 0;
    options.execution.progress = [&](double) { return ++numCalls > 0; };
    std::uint64_t const bytes = EstimateShadingBytes(CubeSize(), 5, sizeof(double));
    options.execution.memoryLimit = bytes - 1;
    try {
        Shade<double>(shapes::Cube(), options);
        FAIL();
    } catch (MemoryLimitExceeded const& error) {
        EXPECT_EQ(error.Bytes(), bytes);
        EXPECT_EQ(error.what(), "level 5 would take about " + std::to_string(bytes) +
                                    " bytes, more than the limit of " + std::to_string(bytes - 1) +
                                    "; use a lower level or raise the limit");
    }
    EXPECT_EQ(numCalls, 0);
    options.execution.memoryLimit = bytes;
    EXPECT_EQ(Shade<double>(shapes::Cube(), options).NumFaces(), 6 * 1024);
}

TEST(SubdivisionShading, MoreElementsThanIndicesCanNumberAreRefused) {
    // 24 4^14 faces; refining them would take the machine.
    std::uint64_t const bytes = EstimateShadingBytes(CubeSize(), 15, sizeof(float));
    EXPECT_EQ(ErrorOf<MemoryLimitExceeded>([] { Shade<float>(shapes::Cube(), PaperPreset(15)); }),
              "level 15 would take about " + std::to_string(bytes) +
                  " bytes and more elements than 32-bit indices can number; use a lower level");
}

TEST(SubdivisionShading, TheEstimateGrowsFourTimesALevelAndSaturates) {
    for (Sdc::SchemeType const scheme : {Sdc::SCHEME_CATMARK, Sdc::SCHEME_LOOP}) {
        for (std::size_t const size : {sizeof(float), sizeof(double)}) {
            MeshSize mesh{scheme, 1000000, 1000000, 4000000};
            auto const at = [&](int level) { return EstimateShadingBytes(mesh, level, size); };
            for (int level = 0; level < 10; ++level) {
                EXPECT_GT(at(level + 1), at(level));
                if (level > 0) {
                    EXPECT_NEAR(static_cast<double>(at(level + 1)) / static_cast<double>(at(level)), 4, 1);
                }
            }
            EXPECT_NEAR(static_cast<double>(at(10)) / static_cast<double>(at(9)), 4, 0.02);
            std::int64_t const most = std::numeric_limits<std::int64_t>::max();
            mesh.numFaces = mesh.numFaceCorners = most;
            EXPECT_EQ(at(15), 9200000000000000000U);
        }
    }
    EXPECT_GT(EstimateShadingBytes(CubeSize(), 5, 8), EstimateShadingBytes(CubeSize(), 5, 4));
}

TEST(SubdivisionShading, PointsMustBeThereFiniteAndAsManyAsVertices) {
    CubeInput cube;
    cube.input.positions = {};
    EXPECT_EQ(cube.Error(), "positions has 0 elements; the mesh needs 8, one per vertex");
    cube.input.positions = {&cube.points[0].x, 9};
    EXPECT_EQ(cube.Error(), "positions has 9 elements; the mesh needs 8, one per vertex");
    cube.input.positions = {nullptr, 8};
    EXPECT_EQ(cube.Error(), "positions: its pointer is null");
    cube.input.positions = {&cube.points[0].x, 8, 2};
    EXPECT_EQ(cube.Error(), "positions: its stride is 2; give 3 or more");
    for (double const wrong :
         {std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::infinity()}) {
        std::vector<Vec3<double>> points = cube.points;
        points[7].z = wrong;
        cube.input.positions = points;
        EXPECT_EQ(cube.Error(), "positions: vertex 7 is not finite");
    }
}

TEST(SubdivisionShading, VertexDataMustBeWellFormed) {
    CubeInput cube;
    double const* const data = cube.shape.positions.data();
    auto const errorWith = [&](PrimvarView<double> const& view) {
        cube.input.vertexData = {{data, 8, 3}, view};
        return cube.Error();
    };
    EXPECT_EQ(errorWith({data, 8, 0}), "vertexData 1: its width is 0; give 1 or more");
    EXPECT_EQ(errorWith({data, 8, 3, 2}), "vertexData 1: its stride, 2, is less than its width, 3");
    EXPECT_EQ(errorWith({nullptr, 8, 3}), "vertexData 1: its pointer is null");
    EXPECT_EQ(errorWith({data, 7, 3}), "vertexData 1 has 7 elements; the mesh has 8 vertices");
    EXPECT_EQ(errorWith({data, std::size_t{1} << 31, 3}), "vertexData 1: too many values");
    EXPECT_EQ(errorWith({data, 8, 3}), "no error");
}

TEST(SubdivisionShading, FaceVaryingDataMustBeWellFormed) {
    CubeInput cube;
    std::vector<int> indices = cube.shape.faceVertices;
    auto const errorWith = [&](ArrayView<int> const& view, PrimvarView<double> const& values) {
        cube.input.faceVaryingData = {{view, values}};
        return cube.Error();
    };
    PrimvarView<double> const values(cube.uvs.data(), 8, 2);
    EXPECT_EQ(errorWith({indices.data(), 23}, values),
              "faceVaryingData 0 has 23 indices; the mesh has 24 face corners");
    EXPECT_EQ(errorWith({}, values), "faceVaryingData 0 has 0 indices; the mesh has 24 face corners");
    EXPECT_EQ(errorWith(indices, {cube.uvs.data(), 8, 0}), "faceVaryingData 0: its width is 0; give 1 or more");
    EXPECT_EQ(errorWith(indices, {nullptr, 8, 2}), "faceVaryingData 0: its pointer is null");
    EXPECT_EQ(errorWith(indices, {cube.uvs.data(), 7, 2}),
              "faceVaryingData 0: face corner 3 names value 7; there are 7");
    indices[5] = -1;
    EXPECT_EQ(errorWith(indices, values), "faceVaryingData 0: face corner 5 names value -1; there are 8");
}

TEST(SubdivisionShading, FaceVaryingDataOfARefinerMustMatchItsChannels) {
    CubeInput const cube;
    std::unique_ptr<Far::TopologyRefiner> const refiner =
        shapes::MakeRefiner(cube.shape, 0, cube.shape.faceVertices, 8);
    auto const errorWith = [&](std::vector<FaceVaryingView<double>> const& data) {
        ShadingInput<double> input = cube.input;
        input.faceVaryingData = data;
        return ErrorOf<InvalidControlMesh>([&] { ShadeSubdivision(*refiner, input, PaperPreset(2)); });
    };
    PrimvarView<double> const values(cube.uvs.data(), 8, 2);
    EXPECT_EQ(errorWith({{{}, values}}), "no error");
    EXPECT_EQ(errorWith({{cube.shape.faceVertices, values}}),
              "faceVaryingData 0 has indices; those of the refiner's channel are used, leave them empty");
    EXPECT_EQ(errorWith({{{}, values}, {{}, values}}), "faceVaryingData 1: the refiner has only 1 channels");
    EXPECT_EQ(errorWith({{{}, {cube.uvs.data(), 7, 2}}}),
              "faceVaryingData 0 has 7 values; the refiner's channel has 8");
}

TEST(SubdivisionShading, EveryErrorIsAnError) {
    ShadingOptions options = PaperPreset(16);
    EXPECT_THROW(Shade<float>(shapes::Cube(), options), Error);
    EXPECT_THROW(Shade<float>(shapes::Cube().Crease(0, 6), PaperPreset(1)), Error);
}

}  // namespace
