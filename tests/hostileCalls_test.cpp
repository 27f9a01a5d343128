// SPDX-License-Identifier: Apache-2.0

// Calls that nobody means well with behind the doors where a mesh comes in: refiners, frames, rows, checks,
// estimates.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "osd_shading/geometryCheck.h"
#include "osd_shading/io/objWriter.h"
#include "osd_shading/io/plyWriter.h"
#include "osd_shading/io/usdWriter.h"
#include "osd_shading/limitSurface.h"
#include "osd_shading/primvarTable.h"
#include "osd_shading/shadingEvaluator.h"
#include "osd_shading/shadingStencils.h"
#include "tests/ioFiles.h"
#include "tests/testHelpers.h"

namespace osd_shading::tests {
namespace {

constexpr int kLeast = std::numeric_limits<int>::min(), kMost = std::numeric_limits<int>::max();
constexpr std::size_t kAllBits = ~std::size_t{0};
constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();

template <typename Call>
std::string wordsOf(Call const& call) {
    return ErrorOf<Error>(call);
}

struct Case {
    char const* name;
    std::function<void()> call;
    std::string expected;
};

void expectWords(std::vector<Case> const& cases) {
    for (Case const& c : cases) EXPECT_EQ(wordsOf(c.call), c.expected) << c.name;
}

TEST(HostileCalls, RefinersThatCannotBeShadedAreRefusedInTheSameWordsAtEveryDoor) {
    auto const expectAtDoors = [](Far::TopologyRefiner const& refiner, std::string const& expected) {
        std::vector<double> const points(300, 1);
        ShadingInput<double> input;
        input.positions = {points.data(), static_cast<std::size_t>(refiner.GetLevel(0).GetNumVertices())};
        ShadingResult<double> const result = Shade<double>(shapes::Cube(), PaperPreset(1));
        EXPECT_EQ(wordsOf([&] { ShadeSubdivision(refiner, input, PaperPreset(1)); }), expected);
        EXPECT_EQ(wordsOf([&] { ShadingTable(refiner, PaperPreset(1)); }), expected);
        EXPECT_EQ(wordsOf([&] { BuildShadingStencils(refiner, PaperPreset(1)); }), expected);
        EXPECT_EQ(wordsOf([&] { LimitSurface<double>(refiner, input, PaperPreset(1)); }), expected);
        EXPECT_EQ(wordsOf([&] { BuildPrimvarTable<double>(refiner, PaperPreset(1)); }), expected);
        EXPECT_EQ(wordsOf([&] { CheckGeometry(refiner, input.positions, result); }), expected);
    };
    expectAtDoors(Far::TopologyRefiner(Sdc::SCHEME_CATMARK), "the refiner holds no mesh: its level 0 has no faces");
    Shape bilinear = shapes::Cube();
    bilinear.rules.scheme = Sdc::SCHEME_BILINEAR;
    expectAtDoors(*shapes::MakeRefiner(bilinear, 0),
                  "the bilinear scheme has no normals to subdivide; use Catmull-Clark or Loop");
    expectAtDoors(*shapes::MakeRefiner(shapes::Cube().Face({3, 1, 2, 1}), 0), "face 6 names vertex 1 twice");
    expectAtDoors(*shapes::MakeRefiner(shapes::Cube().Face({0, 1}), 0),
                  "face 6 has 2 vertices; a face needs 3 or more");
}

TEST(HostileCalls, AnAdaptiveRefinerIsShadedFromItsLevelZero) {
    Shape const shape = shapes::CubeWithSharpTop(2.5F);
    auto const refiner = shapes::MakeRefiner(shape, 0);
    refiner->RefineAdaptive(Far::TopologyRefiner::AdaptiveOptions(3));
    ShadingInput<double> input;
    input.positions = shape.Points();
    EXPECT_TRUE(
        IsSameResult(ShadeSubdivision(*refiner, input, PaperPreset(2)), Shade<double>(shape, PaperPreset(2))));
}

TEST(HostileCalls, TablesAndFramesRefuseWhatTheyCannotRead) {
    Shape const cube = shapes::Cube();
    std::vector<float> const points = cube.FloatPositions();
    PointView<float> const view{points.data(), 8};
    ShadingTable const table(cube.Mesh(), PaperPreset(1));
    ShadingEvaluator evaluator(table);
    std::vector<float> room(6 * 26);
    auto const frameOf = [&](PointView<float> from, PointSpan positions, NumberSpan weights = {}) {
        return [&evaluator, from, positions, weights] {
            ShadingOutputs outputs;
            outputs.positions = positions;
            outputs.blendWeights = weights;
            evaluator.Evaluate(from, outputs);
        };
    };
    float* const to = room.data();
    expectWords({
        {"an order that there is not", [&] { ShadingTable(cube.Mesh(), PaperPreset(1), ValueOrder(2)); },
         "order is 2, none that there is"},
        {"an instruction set that there is not",
         [&] {
             ShadingEvaluator(table, {1, static_cast<InstructionSet>(99)});
         },
         "this build or this processor does not have the instruction set asked for; use InstructionSet::Best"},
        {"least threads",
         [&] {
             ShadingEvaluator(table, {kLeast, InstructionSet::Best});
         },
         "numThreads is -2147483648; it must be 0 or more"},
        {"points of all 64 bits", frameOf({points.data(), kAllBits}, {to, 26, 3}),
         "controlPoints has 18446744073709551615 elements; the table needs 8, one per control vertex"},
        {"points of stride 0", frameOf({points.data(), 8, 0}, {to, 26, 3}),
         "controlPoints: its stride is 0; give 3 or more"},
        {"room of all 64 bits", frameOf(view, {to, kAllBits, 3}),
         "positions has room for 18446744073709551615 elements; the table has 26 values"},
        {"room of stride 0", frameOf(view, {to, 26, 0}), "positions: its stride is 0; give 3 or more"},
        {"room for nothing at a place", frameOf(view, {to, 0, 3}),
         "positions has room for 0 elements; the table has 26 values"},
        {"weights of stride 0", frameOf(view, {}, {to, 26, 0}), "blendWeights: its stride is 0; give 1 or more"},
        {"nothing wanted", frameOf(view, {}), "no error"},
        {"one buffer for both", frameOf(view, {to, 26, 6}, {to + 3, 26, 6}), "no error"},
    });
    EXPECT_FALSE(IsAvailable(static_cast<InstructionSet>(99)));
}

TEST(HostileCalls, ThreadsBeyondAllReasonGiveTheSameBits) {
    Shape const cube = shapes::CubeWithSharpTop(1.5F);
    std::vector<float> const points = cube.FloatPositions();
    ShadingOptions many = PaperPreset(4);
    many.execution.numThreads = kMost;
    EXPECT_TRUE(IsSameResult(Shade<float>(cube, many), Shade<float>(cube, PaperPreset(4))));
    ShadingTable const table(cube.Mesh(), many);
    std::size_t const count = Index(table.NumValues());
    std::vector<float> one(3 * count), other(3 * count);
    ShadingOutputs outputs;
    outputs.blendedNormals = {one.data(), count, 3};
    ShadingEvaluator(table).Evaluate({points.data(), 8}, outputs);
    outputs.blendedNormals = {other.data(), count, 3};
    ShadingEvaluator(table, {kMost, InstructionSet::Best}).Evaluate({points.data(), 8}, outputs);
    EXPECT_TRUE(HasSameBits(one, other));
    PrimvarTable<float> const primvars = BuildPrimvarTable<float>(cube.Mesh(), {}, many);
    std::vector<float> refined(3 * Index(primvars.vertexData.NumRows()));
    primvars.vertexData.Evaluate({points.data(), 8, 3}, {refined.data(), refined.size() / 3}, kMost);
    for (float const x : refined) EXPECT_LE(std::fabs(x), 1);
}

TEST(HostileCalls, RowsAndChannelsRefuseWhatTheyCannotRead) {
    Shape const cube = shapes::Cube();
    std::vector<int> const& indices = cube.faceVertices;
    PrimvarRows<double> const rows = BuildPrimvarTable<double>(cube.Mesh(), {}, PaperPreset(1)).vertexData;
    PrimvarRows<double> const none;
    std::vector<double> const control(8);
    std::vector<double> refined(26);
    auto const build = [&](FaceVaryingChannel const& channel) {
        return [&cube, channel] { BuildPrimvarTable<double>(cube.Mesh(), {channel}, PaperPreset(1)); };
    };
    auto const reorder = [&](std::vector<int> const& wanted) {
        return [&rows, wanted] { rows.Reordered(wanted); };
    };
    auto const range = [&](int begin, int end) {
        return [&, begin, end] { rows.EvaluateRange({control.data(), 8, 1}, {refined.data(), 26}, begin, end); };
    };
    auto const match = [](std::vector<int> const& faces, std::vector<int> const& wanted, int size) {
        return [faces, wanted, size] { MatchFaceCorners(faces, wanted, size); };
    };
    ArrayView<int> const nothing(nullptr, 24);
    expectWords({
        {"a channel without values", build({indices, 0}), "channel 0: face corner 0 names value 4; there are 0"},
        {"a channel of fewer values than none", build({indices, kLeast}),
         "channel 0: face corner 0 names value 4; there are -2147483648"},
        {"a channel of null", build({nothing, 8}), "channel 0: the pointer of its indices is null"},
        {"an empty channel", build({}), "channel 0 has 0 indices; the mesh has 24 face corners"},
        {"row -1", reorder({0, -1}), "element 1 asks for row -1; there are 26"},
        {"row 26", reorder({26}), "element 0 asks for row 26; there are 26"},
        {"least row", reorder({kLeast}), "element 0 asks for row -2147483648; there are 26"},
        {"rows of none", [&] { none.Reordered(std::vector<int>{0}); }, "element 0 asks for row 0; there are 0"},
        {"no rows", reorder({}), "no error"},
        {"rows from behind", range(3, 2), "rows 3 to 2 are no range of the table's 26"},
        {"rows from -1", range(-1, 2), "rows -1 to 2 are no range of the table's 26"},
        {"rows to the most", range(0, kMost), "rows 0 to 2147483647 are no range of the table's 26"},
        {"rows of nothing", range(26, 26), "no error"},
        {"values of none", [&] { none.Evaluate({}, {}); }, "control: its width is 0; give 1 or more"},
        {"least width",
         [&] {
             rows.Evaluate({control.data(), 8, kLeast, 1}, {refined.data(), 26});
         },
         "control: its width is -2147483648; give 1 or more"},
        {"control of stride 0",
         [&] {
             rows.Evaluate({control.data(), 8, 1, 0}, {refined.data(), 26});
         },
         "control: its stride, 0, is less than the width, 1"},
        {"control of all 64 bits",
         [&] {
             rows.Evaluate({control.data(), kAllBits, 1}, {refined.data(), 26});
         },
         "control has 18446744073709551615 elements; the table has 8"},
        {"faces of least size", match({0, 1, 2}, {0, 1, 2}, kLeast), "faceSize is -2147483648; give 3 or more"},
        {"faces of the largest size", match({0, 1, 2}, {0, 1, 2}, kMost),
         "an index buffer has a size that is no multiple of 2147483647"},
        {"a face that is not there", match({0, 1, 2}, {0, 2, 1}, 3),
         "face 0 of the wanted order is none of the faces"},
        {"no faces at all", match({}, {}, 3), "no error"},
    });
}

TEST(HostileCalls, ChecksRefuseWhatWasNotShadedFromTheirMesh) {
    Shape const cube = shapes::Cube();
    std::vector<Vec3<double>> points = PointsOf<double>(cube);
    auto const checkWith = [&](PointView<double> view, auto const& change) {
        ShadingResult<double> result = Shade<double>(cube, PaperPreset(1));
        change(result);
        return wordsOf([&] { CheckGeometry(cube.Mesh(), view, result); });
    };
    auto const nothing = [](ShadingResult<double>&) {};
    EXPECT_EQ(checkWith({nullptr, 8}, nothing), "positions: its pointer is null");
    EXPECT_EQ(checkWith({&points[0].x, 8, 0}, nothing), "positions: its stride is 0; give 3 or more");
    EXPECT_EQ(checkWith({&points[0].x, kAllBits}, nothing),
              "positions has 18446744073709551615 elements; the mesh needs 8, one per vertex");
    EXPECT_EQ(checkWith(points, [](ShadingResult<double>& r) { r.options.level = 1000000000; }),
              "level is 1000000000; it must be 0 to 15");
    std::string const notFrom = "the result was not shaded from this mesh: it has ";
    EXPECT_EQ(checkWith(points, [](ShadingResult<double>& r) { r = {}; }),
              notFrom + "0 vertices, not 1538");  // of level 4, the default
    EXPECT_EQ(checkWith(points, [](ShadingResult<double>& r) { r.positions.pop_back(); }),
              notFrom + "25 vertices, not 26");
    EXPECT_EQ(checkWith(points, [](ShadingResult<double>& r) { r.limitNormals.pop_back(); }),
              notFrom + "25 limit normals, not 26");
    EXPECT_EQ(checkWith(points, nothing), "no error");
    points[3].y = double{kNan};
    EXPECT_EQ(checkWith(points, nothing), "positions: vertex 3 is not finite");
}

TEST(HostileCalls, AResultWithNaNFailsItsCheck) {
    Shape const cube = shapes::Cube();
    std::vector<Vec3<double>> const points = PointsOf<double>(cube);
    ShadingResult<double> result = Shade<double>(cube, PaperPreset(1));
    result.positions[5].x = double{kNan};
    GeometryCheck const check = CheckGeometry<double>(cube.Mesh(), points, result);
    EXPECT_FALSE(check.Passes(1e300));
}

TEST(HostileCalls, NoNumbersOfAnEstimateAreTooManyOrTooFew) {
    EXPECT_EQ(EstimateShadingBytes({Sdc::SCHEME_LOOP, 0, -1000000000, -1, 0, 0, 0, 0, 0}, 4, 8), 0U);
    std::int64_t const most = std::numeric_limits<std::int64_t>::max();
    EXPECT_EQ(EstimateShadingBytes({Sdc::SCHEME_LOOP, most, most, most, most, most, most, most, most}, kMost, 8),
              9200000000000000000U);
    EXPECT_GT(EstimateShadingBytes({}, -1, 0), 0U);
    EXPECT_GT(EstimateShadingBytes({}, kLeast, 8), 0U);
    EXPECT_EQ(EstimateShadingBytes({}, 1000000000, 8), 9200000000000000000U);  // 0 faces, each cut infinitely often
}

TEST(HostileCalls, DataThatAreNotNumbersSpoilNothingElse) {
    Shape const cube = shapes::CubeWithSharpTop(2.5F);
    std::vector<Vec3<float>> const points = PointsOf<float>(cube);
    std::vector<float> data(16, 1), uvs(16, 1);
    data[0] = kNan;
    data[5] = kInfinity;
    uvs[7] = -kInfinity;
    ShadingInput<float> input;
    input.positions = points;
    input.vertexData = {{data.data(), 8, 2}};
    input.faceVaryingData = {{cube.faceVertices, {uvs.data(), 8, 2}}};
    ShadingResult<float> const spoilt = ShadeSubdivision(cube.Mesh(), input, PaperPreset(3));
    EXPECT_FALSE(std::isfinite(spoilt.vertexData[0].values[0]));
    EXPECT_TRUE(HasSameBits(spoilt.blendedNormals, Shade<float>(cube, PaperPreset(3)).blendedNormals));
}

TEST(HostileCalls, ExponentsAtTheEndsOfTheirRangeGiveUnitNormals) {
    Shape const cube = shapes::GridWithDart(1.5F).Jitter(0.2);
    for (double const exponent : {std::numeric_limits<double>::denorm_min(), 1e-300, 1e300}) {
        ShadingOptions options = PaperPreset(3);
        options.weights.exponent = exponent;
        for (Vec3<double> const& n : Shade<double>(cube, options).blendedNormals) {
            EXPECT_NEAR(Length(n), 1, 1e-12) << exponent;
        }
        std::vector<float> const points = cube.FloatPositions();
        ShadingTable const table(cube.Mesh(), options);
        std::size_t const count = Index(table.NumValues());
        std::vector<Vec3<float>> normals(count), subdivided(count);
        std::vector<float> const weights = table.BlendWeights();
        ShadingOutputs outputs;
        outputs.blendedNormals = {&normals[0].x, count, 3};
        outputs.subdividedNormals = {&subdivided[0].x, count, 3};
        ShadingEvaluator(table).Evaluate({points.data(), points.size() / 3}, outputs);
        for (Vec3<float> const& n : normals) EXPECT_NEAR(Length(n), 1, 1e-5) << exponent;
        // N_S is there wherever b is, though its power be less than any float.
        for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(Length(subdivided[i]) > 0, weights[i] > 0) << exponent;
    }
}

TEST(HostileCalls, WhereNothingIsLeftOfSubdividedNormalsThatCountAloneFramesTakeLimitNormals) {
    Shape const shape = shapes::MixedPolygons().Jitter(0.1);
    ShadingOptions options = PaperPreset(2);
    options.startNormals.kind = StartNormalKind::User;
    options.weights.scheme = WeightScheme::One;
    std::vector<float> const points = shape.FloatPositions(), zeros(points.size(), 0);
    PointView<float> const normals(zeros.data(), zeros.size() / 3);
    ShadingInput<float> input;
    input.positions = {points.data(), points.size() / 3};
    input.vertexNormals = normals;
    ShadingResult<float> const result = ShadeSubdivision(shape.Mesh(), input, options);
    EXPECT_TRUE(HasSameBits(result.blendedNormals, result.limitNormals));

    ShadingTable const table(shape.Mesh(), options);
    std::vector<int> const values = table.ResultValues();
    std::size_t const count = Index(table.NumValues());
    std::vector<Vec3<float>> blended(count), limits(count);
    for (bool const hasLimits : {false, true}) {
        ShadingOutputs outputs;
        outputs.blendedNormals = {&blended[0].x, count, 3};
        if (hasLimits) outputs.limitNormals = {&limits[0].x, count, 3};
        EXPECT_EQ(ShadingEvaluator(table).Evaluate(input.positions, normals, outputs).fallbackNormals, 0);
        for (std::size_t i = 0; i < count; ++i) {
            EXPECT_LT(Distance(blended[i], result.limitNormals[Index(values[i])]), 1e-5) << i << " " << hasLimits;
        }
    }
}

TEST(HostileCalls, AFaceCountsAtACornerWithoutAreaWhateverRoundingMakesOfIt) {
    // The pentagon's corner at (8, 8, 8), where two points are one, has no area at level 1 but for rounding.
    Shape shape;
    shape.Vertex(0, 1, 0).Vertex(0, 0, 0).Vertex(1, 1, 0.25).Vertex(8, 8, 8).Vertex(8, 8, 8);
    shape.Face({1, 2, 4, 3, 0}).Boundary(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    ShadingOptions options = PaperPreset(2);
    options.startNormals.kind = StartNormalKind::CornerArea;
    options.weights.scheme = WeightScheme::One;
    for (double const size : {1.0, 0.1, 1e-3, 1e5}) {
        Shape sized = shape;
        for (double& x : sized.positions) x *= size;
        std::vector<float> const points = sized.FloatPositions();
        std::vector<double> const exact(points.begin(), points.end());
        ShadingInput<double> input;
        input.positions = {exact.data(), exact.size() / 3};
        ShadingResult<double> const result = ShadeSubdivision(sized.Mesh(), input, options);
        EXPECT_EQ(result.report.zeroStartNormals, 0) << size;
        ShadingTable const table(sized.Mesh(), options);
        std::size_t const count = Index(table.NumValues());
        std::vector<Vec3<float>> normals(count);
        ShadingOutputs outputs;
        outputs.subdividedNormals = {&normals[0].x, count, 3};
        FrameReport const report = ShadingEvaluator(table).Evaluate({points.data(), points.size() / 3}, outputs);
        EXPECT_EQ(report.zeroStartNormals, 0) << size;
        std::vector<int> const values = table.ResultValues();
        for (std::size_t i = 0; i < count; ++i) {
            EXPECT_LT(AngleBetween(normals[i], result.subdividedNormals[Index(values[i])]), 1e-4)
                << size << " " << i;
            EXPECT_FALSE(IsZero(normals[i])) << size << " " << i;
        }
    }
}

TEST(HostileCalls, TrianglesBackToBackAreInTablesOfLoopUpToLevelTwoAndRefusedBeyond) {
    Shape shape;
    shape.Vertex(-8, -8, -8).Vertex(-8, -8, 0).Vertex(0, 2, 0).Face({0, 1, 2}).Face({1, 0, 2}).Loop();
    std::vector<float> const points = shape.FloatPositions();
    std::string const refusal =
        "faces 0 and 1 share two edges, which tables of Loop subdivision hold up to level 2 only; use "
        "ShadeSubdivision";
    for (int level = 0; level <= 4; ++level) {
        ShadingResult<double> const result = Shade<double>(shape, PaperPreset(level));
        if (level > 2) {
            EXPECT_EQ(wordsOf([&] { ShadingTable(shape.Mesh(), PaperPreset(level)); }), refusal);
            continue;
        }
        ShadingTable const table(shape.Mesh(), PaperPreset(level));
        std::size_t const count = Index(table.NumValues());
        std::vector<Vec3<float>> positions(count);
        ShadingOutputs outputs;
        outputs.positions = {&positions[0].x, count, 3};
        ShadingEvaluator(table).Evaluate({points.data(), 3}, outputs);
        std::vector<int> const vertices = table.RefinedVertices();
        for (std::size_t i = 0; i < count; ++i) {
            Vec3<double> const p = result.positions[Index(vertices[i])];
            EXPECT_LT(std::hypot(p.x - double(positions[i].x), p.y - double(positions[i].y),
                                 p.z - double(positions[i].z)),
                      1e-5)
                << level;
        }
    }
}

TEST(HostileCalls, PointsFarBeyondEveryModelGiveNoNaN) {
    for (double const size : {1e-300, 1e-160, 1e-40, 1e30, 1e150, 1e160, 1e300}) {
        Shape cube = shapes::CubeWithSharpTop(2.5F).Jitter(0.1);
        for (double& x : cube.positions) x *= size;
        ShadingResult<double> const result = Shade<double>(cube, PaperPreset(2));
        for (Vec3<double> const& p : result.positions) EXPECT_TRUE(IsFinite(p)) << size;
        for (Vec3<double> const& n : result.blendedNormals) {
            double const length = Length(n);
            EXPECT_TRUE(length == 0 || std::fabs(length - 1) < 1e-6) << size << ": " << length;
        }
    }
}

TEST(HostileCalls, AnEmptyResultIsWrittenAsAnEmptyFile) {
    ioFiles::TemporaryFolder const folder;
    ShadingResult<float> const empty;
    io::WritePly(folder.File("a.ply"), empty, {io::PlyFormat::Ascii});
    EXPECT_NE(ioFiles::ReadBytes(folder.File("a.ply")).find("element vertex 0\n"), std::string::npos);
    io::WriteUsd(folder.File("a.usda"), empty);
    EXPECT_NE(ioFiles::ReadBytes(folder.File("a.usda")).find("faceVertexCounts = []"), std::string::npos);
    io::WriteObj(folder.File("a.obj"), empty);
    EXPECT_EQ(wordsOf([&] { io::ReadObj(folder.File("a.obj")); }),
              folder.File("a.obj") + ": has no face (a line that begins with f): it is no OBJ model");
    Shape const cube = shapes::Cube();
    ControlMesh broken = cube.Mesh();
    broken.numVertices = -1;
    io::UsdOptions options;
    options.cage = &broken;
    EXPECT_NE(wordsOf([&] { io::WriteUsd(folder.File("b.usda"), empty, options); }), "no error");
    EXPECT_EQ(folder.NumFiles(), 3U);
}

}  // namespace
}  // namespace osd_shading::tests
