// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/primvarTable.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "osd_shading/io/objReader.h"
#include "tests/ioFiles.h"
#include "tests/sampleSize.h"
#include "tests/testHelpers.h"

namespace osd_shading::tests {
namespace {

template <typename Real>
std::vector<Real> RandomNumbers(std::size_t count) {
    std::vector<Real> numbers;
    shapes::Random random(9);
    for (std::size_t i = 0; i < count; ++i) numbers.push_back(static_cast<Real>(random.Uniform(-1, 1)));
    return numbers;
}

template <typename Real>
std::vector<Real> Evaluate(PrimvarRows<Real> const& rows, std::vector<Real> const& control, int width) {
    std::vector<Real> refined(Index(rows.NumRows() * width));
    rows.Evaluate({control.data(), control.size() / Index(width), width}, {refined.data(), Index(rows.NumRows())});
    return refined;
}

/// Texture coordinates with a seam: the first face has values of its own, the others share those of their vertices.
std::vector<int> SeamedIndices(Shape const& shape) {
    std::vector<int> indices = shape.faceVertices;
    for (int i = 0; i < shape.faceSizes[0]; ++i) indices[Index(i)] = shape.NumVertices() + i;
    return indices;
}

template <typename Real>
void ExpectNear(std::vector<Real> const& found, std::vector<Real> const& expected, std::string const& name) {
    ASSERT_EQ(found.size(), expected.size()) << name;
    double const tolerance = sizeof(Real) == 4 ? 1e-6 : 1e-12;
    for (std::size_t i = 0; i < found.size(); ++i) {
        ASSERT_NEAR(double(found[i]), double(expected[i]), tolerance) << name << " number " << i;
    }
}

/// Compares with ShadeSubdivision: numbers of width 3 on vertices, and of width 2 on a channel.
template <typename Real>
void ExpectSame(ControlMesh const& mesh, std::vector<int> const& indices, int numValues,
                ShadingOptions const& options, std::string const& name) {
    std::vector<Real> const vertexData = RandomNumbers<Real>(3 * Index(mesh.numVertices));
    std::vector<Real> const uvs = RandomNumbers<Real>(2 * Index(numValues));
    ShadingInput<Real> input;
    input.positions = {vertexData.data(), Index(mesh.numVertices)};
    input.vertexData.push_back({vertexData.data(), Index(mesh.numVertices), 3});
    input.faceVaryingData.push_back({indices, {uvs.data(), Index(numValues), 2}});
    ShadingResult<Real> const expected = ShadeSubdivision(mesh, input, options);

    PrimvarTable<Real> const table = BuildPrimvarTable<Real>(mesh, {{indices, numValues}}, options);
    ASSERT_EQ(table.vertexData.NumRows(), expected.NumVertices()) << name;
    ASSERT_EQ(table.faceSize, expected.faceSize) << name;
    ASSERT_EQ(table.faceVertices, expected.faceVertices) << name;
    ASSERT_EQ(table.faceVarying[0].faceIndices, expected.faceVaryingData[0].faceIndices) << name;
    ExpectNear(Evaluate(table.vertexData, vertexData, 3), expected.vertexData[0].values, name);
    ExpectNear(Evaluate(table.faceVarying[0].values, uvs, 2), expected.faceVaryingData[0].values, name);
}

TEST(PrimvarTable, FacePointIsTheMeanOfItsCorners) {
    Shape const cube = shapes::Cube();
    ShadingOptions options = PaperPreset(1);
    options.limits.positions = PositionKind::Refined;
    PrimvarTable<double> const table = BuildPrimvarTable<double>(cube.Mesh(), {}, options);
    EXPECT_EQ(table.vertexData.NumControlValues(), 8);
    EXPECT_EQ(table.vertexData.NumRows(), 26);
    EXPECT_TRUE(table.faceVarying.empty());
    // The top is vertices 4 5 6 7; its point is the first after the eight vertices.
    EXPECT_EQ(Evaluate(table.vertexData, {0, 0, 0, 0, 1, 2, 3, 4}, 1)[8], 2.5);
}

TEST(PrimvarTable, GivesTheNumbersOfShadeSubdivisionForEveryFaceVaryingRule) {
    using Options = Sdc::Options;
    SweepSample sample(1);
    for (Options::FVarLinearInterpolation const linear :
         {Options::FVAR_LINEAR_NONE, Options::FVAR_LINEAR_CORNERS_ONLY, Options::FVAR_LINEAR_CORNERS_PLUS1,
          Options::FVAR_LINEAR_CORNERS_PLUS2, Options::FVAR_LINEAR_BOUNDARIES, Options::FVAR_LINEAR_ALL}) {
        for (Shape shape : AllShapes()) {
            shape.rules.faceVarying = linear;
            std::vector<int> const indices = SeamedIndices(shape);
            int const numValues = shape.NumVertices() + shape.faceSizes[0];
            for (int level = HasOnlyRegularFaces(shape) ? 0 : 1; level <= 3; ++level) {
                if (!sample.Takes()) continue;
                ShadingOptions options = PaperPreset(level);
                std::string const name = shape.name + " level " + std::to_string(level);
                ExpectSame<double>(shape.Mesh(), indices, numValues, options, name);
                options.limits.positions = PositionKind::Refined;
                options.execution.numThreads = 2;
                ExpectSame<float>(shape.Mesh(), indices, numValues, options, name);
            }
        }
    }
}

TEST(PrimvarTable, OfRandomMeshesWithAValuePerCornerGivesTheNumbersOfShadeSubdivision) {
    for (std::uint64_t seed = 0; seed < SampleSize(60); ++seed) {
        shapes::RandomShapeOptions random;
        random.triangles = seed % 3 == 1;
        random.chaikin = seed % 5 == 1;
        Shape shape = shapes::RandomShape(seed, random);
        if (random.triangles) shape.Loop();
        // Each corner has its vertex's value, or one of its own.
        std::vector<int> indices = shape.faceVertices;
        int numValues = shape.NumVertices();
        shapes::Random chance(seed);
        for (int& index : indices) index = chance.Chance(0.3) ? numValues++ : index;
        ExpectSame<double>(shape.Mesh(), indices, numValues, PaperPreset(2), shape.name);
        ExpectSame<float>(shape.Mesh(), indices, numValues, PaperPreset(1), shape.name);
    }
}

TEST(PrimvarTable, OfAllModelsWithUvsGivesTheNumbersOfShadeSubdivision) {
    int numModels = 0;
    for (auto const& files : {ioFiles::OwnModels(), ioFiles::SharedModels()}) {
        for (std::string const& file : files) {
            io::Model model;
            try {
                model = io::ReadObj(file);
            } catch (Error const&) {
                continue;  // a face with a repeated vertex is refused
            }
            if (model.uvIndices.empty()) continue;
            model.CompleteUvs();
            SubdivisionRules rules;
            rules.scheme = model.name.rfind("loop", 0) == 0 ? Sdc::SCHEME_LOOP : Sdc::SCHEME_CATMARK;
            ControlMesh const mesh = model.Mesh(model.Rules(rules));
            int const numUvs = static_cast<int>(model.uvs.size() / 2), level = IsSanitizerRun() ? 1 : 2;
            ExpectSame<double>(mesh, model.uvIndices, numUvs, PaperPreset(level), model.name);
            ExpectSame<float>(mesh, model.uvIndices, numUvs, PaperPreset(1), model.name);
            ++numModels;
        }
    }
    EXPECT_GE(numModels, 2);
}

TEST(PrimvarTable, TakesAnyWidthAndStrideAndLeavesWhatLiesBetweenAlone) {
    Shape const shape = shapes::MixedPolygons().CreasePath({1, 8, 9}, 1.5F);
    PrimvarTable<double> const table = BuildPrimvarTable<double>(shape.Mesh(), {}, PaperPreset(2));
    PrimvarRows<double> const& rows = table.vertexData;
    auto const numControl = Index(rows.NumControlValues()), numRows = Index(rows.NumRows());
    for (int const width : {1, 2, 3, 4, 5, 8, 9}) {
        std::size_t const from = Index(width) + 2, to = Index(width) + 3;
        std::vector<double> const control = RandomNumbers<double>(numControl * from);
        std::vector<double> refined(numRows * to, -99);
        rows.Evaluate({control.data(), numControl, width, from}, {refined.data(), numRows, to});
        for (int column = 0; column < width; ++column) {
            std::vector<double> own;
            for (std::size_t i = 0; i < numControl; ++i) own.push_back(control[i * from + Index(column)]);
            std::vector<double> const expected = Evaluate(rows, own, 1);
            for (std::size_t i = 0; i < numRows; ++i) ASSERT_EQ(refined[i * to + Index(column)], expected[i]);
        }
        for (std::size_t i = 0; i < refined.size(); ++i) {
            if (i % to >= Index(width)) {
                ASSERT_EQ(refined[i], -99);
            }
        }
    }
}

TEST(PrimvarTable, IsTheSameBitsFromARefinerWithAnyThreadsAndInRanges) {
    Shape const shape = shapes::Torus(7, 5).CreasePath({0, 5, 10}, 2.5F);
    std::vector<int> const indices = SeamedIndices(shape);
    int const numValues = shape.NumVertices() + 4;
    std::unique_ptr<Far::TopologyRefiner> const refiner = shapes::MakeRefiner(shape, 1, indices, numValues);
    ShadingOptions options = PaperPreset(4);
    PrimvarTable<float> const table = BuildPrimvarTable<float>(shape.Mesh(), {{indices, numValues}}, options);
    options.execution.numThreads = 3;
    PrimvarTable<float> const other = BuildPrimvarTable<float>(*refiner, options);
    std::vector<float> const uvs = RandomNumbers<float>(2 * Index(numValues));
    PrimvarView<float> const view(uvs.data(), Index(numValues), 2);
    PrimvarRows<float> const& rows = table.faceVarying[0].values;
    auto const numRows = Index(rows.NumRows());
    ASSERT_GT(rows.NumRows(), 2 * 4096);
    std::vector<float> const expected = Evaluate(rows, uvs, 2);
    EXPECT_TRUE(HasSameBits(Evaluate(other.faceVarying[0].values, uvs, 2), expected));
    for (int const numThreads : {0, 2, 5}) {
        std::vector<float> refined(2 * numRows);
        rows.Evaluate(view, {refined.data(), numRows}, numThreads);
        EXPECT_TRUE(HasSameBits(refined, expected));
    }
    std::vector<float> refined(2 * numRows);
    rows.EvaluateRange(view, {refined.data(), numRows}, 1000, rows.NumRows());
    EXPECT_EQ(refined[1999], 0);
    rows.EvaluateRange(view, {refined.data(), numRows}, 0, 1000);
    EXPECT_TRUE(HasSameBits(refined, expected));
    EXPECT_GT(rows.NumBytes(), 8 * numRows);
}

TEST(PrimvarTable, NanInOneControlValueSpoilsOnlyWhatDependsOnIt) {
    Shape const shape = shapes::Torus(12, 8);
    PrimvarTable<float> const table = BuildPrimvarTable<float>(shape.Mesh(), {}, PaperPreset(2));
    std::vector<float> control(96, 1);
    control[0] = std::numeric_limits<float>::quiet_NaN();
    std::vector<float> const refined = Evaluate(table.vertexData, control, 1);
    auto const numSpoilt = std::count_if(refined.begin(), refined.end(), [](float x) { return std::isnan(x); });
    EXPECT_GT(numSpoilt, 0);
    EXPECT_LE(numSpoilt, 15 * 15);  // four faces each way are 16 of level 2: inside them
}

TEST(PrimvarTable, RowsAreReorderedLeftOutAndRepeated) {
    Shape const shape = shapes::Cube().Hole(1);
    std::vector<int> const indices = SeamedIndices(shape);
    PrimvarTable<double> const table = BuildPrimvarTable<double>(shape.Mesh(), {{indices, 12}}, PaperPreset(2));
    std::vector<double> const uvs = RandomNumbers<double>(24);
    std::vector<double> const all = Evaluate(table.faceVarying[0].values, uvs, 2);

    // One row per face corner, the faces from last to first, each from its third corner.
    std::vector<int> wanted;
    auto const numFaces = static_cast<int>(table.faceVertices.size() / 4);
    EXPECT_EQ(numFaces, 5 * 16);
    for (int f = numFaces; f-- > 0;) {
        for (int i = 2; i < 6; ++i) wanted.push_back(table.faceVertices[Index(4 * f + i % 4)]);
    }
    std::vector<int> corners = MatchFaceCorners(table.faceVertices, wanted, 4);
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        ASSERT_EQ(corners[i], 4 * (numFaces - 1 - static_cast<int>(i / 4)) + static_cast<int>((i + 2) % 4));
    }
    for (int& corner : corners) corner = table.faceVarying[0].faceIndices[Index(corner)];
    PrimvarRows<double> const reordered = table.faceVarying[0].values.Reordered(corners);
    std::vector<double> const found = Evaluate(reordered, uvs, 2);
    ASSERT_EQ(found.size(), 2 * corners.size());
    for (std::size_t i = 0; i < corners.size(); ++i) {
        EXPECT_EQ(found[2 * i], all[2 * Index(corners[i])]);
        EXPECT_EQ(found[2 * i + 1], all[2 * Index(corners[i]) + 1]);
    }
    EXPECT_EQ(table.vertexData.Reordered({}).NumRows(), 0);
    EXPECT_EQ(ErrorOf<InvalidOptions>([&] {
                  table.vertexData.Reordered(std::vector<int>{0, 98});
              }),
              "element 1 asks for row 98; there are 98");
}

TEST(PrimvarTable, FacesBackToBackAreToldApartByTheirDirectionAndDoubleOnesByTheirOrder) {
    std::vector<int> const pillow{0, 1, 2, 3, 3, 2, 1, 0};
    EXPECT_EQ(MatchFaceCorners(pillow, std::vector<int>{1, 0, 3, 2, 1, 2, 3, 0}, 4),
              (std::vector<int>{6, 7, 4, 5, 1, 2, 3, 0}));
    std::vector<int> const twice{0, 1, 2, 0, 1, 2};
    EXPECT_EQ(MatchFaceCorners(twice, std::vector<int>{2, 0, 1, 1, 2, 0}, 3), (std::vector<int>{2, 0, 1, 4, 5, 3}));
    EXPECT_TRUE(MatchFaceCorners(twice, {}, 3).empty());
    auto const errorOf = [&](std::vector<int> const& wanted, int faceSize) {
        return ErrorOf<InvalidOptions>([&] { MatchFaceCorners(pillow, wanted, faceSize); });
    };
    EXPECT_EQ(errorOf({0, 1, 2, 3, 0, 1, 2, 3}, 4), "face 1 of the wanted order is none of the faces");
    EXPECT_EQ(errorOf({0, 1, 2}, 3), "an index buffer has a size that is no multiple of 3");
    EXPECT_EQ(errorOf({0, 1}, 2), "faceSize is 2; give 3 or more");
}

TEST(PrimvarTable, RefusesInWords) {
    Shape const cube = shapes::Cube();
    std::vector<int> indices = SeamedIndices(cube);
    auto const build = [&](std::vector<FaceVaryingChannel> const& channels, ShadingOptions const& options) {
        return [&cube, channels, options] { BuildPrimvarTable<float>(cube.Mesh(), channels, options); };
    };
    ArrayView<int> const fewer(indices.data(), 23);
    EXPECT_EQ(ErrorOf<InvalidControlMesh>(build({{indices, 12}, {fewer, 12}}, {})),
              "channel 1 has 23 indices; the mesh has 24 face corners");
    EXPECT_EQ(ErrorOf<InvalidControlMesh>(build({{indices, 11}}, {})),
              "channel 0: face corner 3 names value 11; there are 11");
    EXPECT_EQ(ErrorOf<InvalidOptions>(build({}, PaperPreset(16))), "level is 16; it must be 0 to 15");
    ShadingOptions options = PaperPreset(6);
    options.execution.memoryLimit = 1000000;
    EXPECT_NE(ErrorOf<MemoryLimitExceeded>(build({{indices, 12}}, options)).find("more than the limit of 1000000"),
              std::string::npos);
    options.execution.memoryLimit = 0;
    options.execution.progress = [](double done) { return done < 0.5; };
    EXPECT_THROW(build({{indices, 12}}, options)(), Cancelled);

    PrimvarRows<float> const rows = BuildPrimvarTable<float>(cube.Mesh(), {}, PaperPreset(1)).vertexData;
    std::vector<float> const control(16);
    std::vector<float> refined(52);
    auto const errorOf = [&](PrimvarView<float> from, PrimvarSpan<float> to, int numThreads = 1) {
        return ErrorOf<InvalidOptions>([&] { rows.Evaluate(from, to, numThreads); });
    };
    float const* const from = control.data();
    float* const to = refined.data();
    EXPECT_EQ(errorOf({from, 8, 2}, {to, 26}), "no error");
    EXPECT_EQ(errorOf({from, 7, 2}, {to, 26}), "control has 7 elements; the table has 8");
    EXPECT_EQ(errorOf({from, 8, 2}, {to, 25}), "refined has 25 elements; the table has 26");
    EXPECT_EQ(errorOf({nullptr, 8, 2}, {to, 26}), "control: its pointer is null");
    EXPECT_EQ(errorOf({from, 8, 2}, {nullptr, 26}), "refined: its pointer is null");
    EXPECT_EQ(errorOf({from, 8, 0}, {to, 26}), "control: its width is 0; give 1 or more");
    EXPECT_EQ(errorOf({from, 8, 2, 1}, {to, 26}), "control: its stride, 1, is less than the width, 2");
    EXPECT_EQ(errorOf({from, 8, 2}, {to, 26, 1}), "refined: its stride, 1, is less than the width, 2");
    EXPECT_EQ(errorOf({from, 8, 2}, {to, 26}, -1), "numThreads is -1; it must be 0 or more");
    EXPECT_EQ(ErrorOf<InvalidOptions>([&] {
                  rows.EvaluateRange({from, 8, 2}, {to, 26}, 3, 27);
              }),
              "rows 3 to 27 are no range of the table's 26");
    EXPECT_EQ(PrimvarRows<double>().NumRows(), 0);
}

}  // namespace
}  // namespace osd_shading::tests
