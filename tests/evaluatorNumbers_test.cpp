// SPDX-License-Identifier: Apache-2.0

// Frames of points that are no numbers, huge, tiny, or in one place.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "osd_shading/shadingEvaluator.h"
#include "tests/evaluatorCases.h"
#include "tests/sampleSize.h"
#include "tests/tableAgreement.h"

namespace osd_shading::tests {
namespace {

/// Control vertices by the rounds of faces between them and a face: 0 are its own.
std::vector<std::vector<bool>> VerticesNear(Shape const& shape, int rounds) {
    std::vector<std::vector<int>> const faces = shape.Faces();
    std::vector<std::vector<bool>> near(faces.size(), std::vector<bool>(Index(shape.NumVertices()), false));
    for (std::size_t f = 0; f < faces.size(); ++f) {
        for (int const v : faces[f]) near[f][Index(v)] = true;
        for (int round = 0; round < rounds; ++round) {
            std::vector<bool> const inner = near[f];
            for (std::vector<int> const& face : faces) {
                bool touches = false;
                for (int const v : face) touches = touches || inner[Index(v)];
                for (int const v : face) near[f][Index(v)] = near[f][Index(v)] || touches;
            }
        }
    }
    return near;
}

TEST(ShadingEvaluator, ANanSpoilsTheTilesAroundItAndNothingElse) {
    for (Case const& c : Cases()) {
        if (c.shape.rules.creasing == Sdc::Options::CREASE_CHAIKIN) continue;  // its tiles look one face further
        ShadingTable const table(c.shape.Mesh(), c.options);
        TableFrame const clean = FrameOf(c, table);
        // Holes have values too; the faces that tell where those lie are those of the mesh without holes.
        Shape whole = c.shape;
        whole.holes.clear();
        ShadingTable const wholeTable(whole.Mesh(), c.options);
        ASSERT_EQ(wholeTable.ResultValues(), table.ResultValues());
        std::vector<int> const faces = wholeTable.FaceValues(), base = wholeTable.BaseFaces();
        std::vector<int> const results = table.ResultValues();
        auto const size = Index(table.FaceSize());
        auto const near = VerticesNear(c.shape, 1), nearNormals = VerticesNear(c.shape, 3);
        for (int v = 0; v < c.shape.NumVertices(); v += 1 + c.shape.NumVertices() / 5) {
            for (float const bad :
                 {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
                std::vector<float> points = c.points;
                points[3 * Index(v) + 1] = bad;
                TableFrame const frame = EvaluateAll(table, ViewOf(points), {}, ViewOf(c.normals));
                // What no face of a value can see stays as it is.
                std::vector<bool> mayChange(frame.positions.size(), false), normalMayChange = mayChange;
                for (std::size_t i = 0; i < faces.size(); ++i) {
                    auto const f = Index(base[i / size]);
                    if (near[f][Index(v)]) mayChange[Index(faces[i])] = true;
                    if (nearNormals[f][Index(v)]) normalMayChange[Index(faces[i])] = true;
                }
                auto const isSame = [](Vec3<float> const& a, Vec3<float> const& b) {
                    return std::memcmp(&a, &b, sizeof a) == 0;
                };
                for (std::size_t i = 0; i < frame.positions.size(); ++i) {
                    if (!mayChange[i]) {
                        ASSERT_TRUE(isSame(frame.positions[i], clean.positions[i])) << c.Name() << " value " << i;
                        ASSERT_TRUE(isSame(frame.limitNormals[i], clean.limitNormals[i])) << c.Name();
                    }
                    if (!normalMayChange[i] || (!mayChange[i] && clean.blendWeights[i] == 0)) {
                        ASSERT_TRUE(isSame(frame.blendedNormals[i], clean.blendedNormals[i])) << c.Name();
                    }
                    ASSERT_EQ(frame.blendWeights[i], clean.blendWeights[i]);
                }

                // What depends on it is no number, and never looks like one.
                Shape moved = c.shape;
                moved.positions[3 * Index(v) + 1] += 0.37;
                std::vector<double> const normals(c.normals.begin(), c.normals.end());
                auto const shade = [&](Shape const& shape) {
                    ShadingInput<double> input;
                    input.positions = shape.Points();
                    input.vertexNormals = {normals.data(), normals.size() / 3};
                    return ShadeSubdivision(shape.Mesh(), input, c.options);
                };
                ShadingResult<double> const before = shade(c.shape), after = shade(moved);
                for (std::size_t i = 0; i < frame.positions.size(); ++i) {
                    auto const vertex = Index(before.valueVertices[Index(results[i])]);
                    if (Distance(before.positions[vertex], after.positions[vertex]) < 1e-9) continue;
                    ASSERT_FALSE(IsFinite(frame.positions[i])) << c.Name() << " value " << i;
                }
            }
        }
    }
}

/// The cases at level 2 and less: where every normal is settled by itself a frame takes its time.
std::vector<Case> SmallCases() {
    std::vector<Case> cases;
    SweepSample sample(1);
    for (Case const& c : Cases()) {
        if (!sample.Takes()) continue;
        cases.push_back(c);
        cases.back().options.level = std::min(c.options.level, 2);
    }
    return cases;
}

/// Whether normals and supports are those of `expected`, to `tolerance` radians.
void ExpectSameNormals(TableFrame const& frame, TableFrame const& expected, double tolerance,
                       std::string const& name) {
    for (std::size_t i = 0; i < frame.positions.size(); ++i) {
        ASSERT_TRUE(IsFinite(frame.positions[i])) << name;
        ASSERT_LE(Distance(frame.limitNormals[i], expected.limitNormals[i]), tolerance) << name << ", value " << i;
        ASSERT_LE(Distance(frame.blendedNormals[i], expected.blendedNormals[i]), tolerance)
            << name << ", value " << i;
    }
}

TEST(ShadingEvaluator, NormalsHaveNoUnitOfLength) {
    for (Case const& c : SmallCases()) {
        ShadingTable const table(c.shape.Mesh(), c.options);
        TableFrame const expected = FrameOf(c, table);
        for (int const power : {-100, -60, 40, 96}) {
            std::vector<float> points = c.points;
            for (float& x : points) x = std::ldexp(x, power);
            TableFrame const frame = EvaluateAll(table, ViewOf(points), {}, ViewOf(c.normals));
            ExpectSameNormals(frame, expected, 2e-5, c.Name() + ", times 2^" + std::to_string(power));
        }
    }
}

TEST(ShadingEvaluator, HugeAndTinyCoordinatesNeitherTrapNorHang) {
    for (Case const& c : SmallCases()) {
        ShadingTable const table(c.shape.Mesh(), c.options);
        shapes::Random random(4);
        float const extremes[] = {1e30F,  -1e30F, std::numeric_limits<float>::max(),
                                  1e-42F, 1e-30F, -std::numeric_limits<float>::infinity(),
                                  0,      1};
        for (int round = 0; round < 8; ++round) {
            std::vector<float> points = c.points;
            for (float& x : points) {
                if (round == 0) x = std::ldexp(x, -140);  // all denormal
                if (round > 0 && random.Chance(0.2)) x = extremes[random.Below(8)];
            }
            auto const start = std::chrono::steady_clock::now();
            TableFrame const frame = EvaluateAll(table, ViewOf(points), {}, ViewOf(c.normals));
            std::chrono::duration<double> const seconds = std::chrono::steady_clock::now() - start;
            EXPECT_LT(seconds.count(), 30) << c.Name();
            for (std::size_t i = 0; i < frame.positions.size(); ++i) {
                // A normal is of unit length, zero, or no number.
                double const length =
                    Length(Vec3<double>{double{frame.blendedNormals[i].x}, double{frame.blendedNormals[i].y},
                                        double{frame.blendedNormals[i].z}});
                bool const isOne = std::fabs(length - 1) < 1e-5;
                ASSERT_TRUE(isOne || IsZero(frame.blendedNormals[i]) || !IsFinite(frame.blendedNormals[i]))
                    << c.Name() << ", round " << round << ", value " << i << ": length " << length;
            }
        }
    }
}

TEST(ShadingEvaluator, AllPointsInOnePlaceGiveZeroNormalsSoon) {
    for (Case const& c : SmallCases()) {
        ShadingTable const table(c.shape.Mesh(), c.options);
        std::vector<float> points = c.points;
        for (std::size_t i = 0; i < points.size(); ++i) points[i] = i % 3 == 0 ? 1.7F : -0.3F;
        auto const start = std::chrono::steady_clock::now();
        TableFrame const frame = EvaluateAll(table, ViewOf(points), {}, ViewOf(c.normals));
        std::chrono::duration<double> const seconds = std::chrono::steady_clock::now() - start;
        EXPECT_LT(seconds.count(), 20) << c.Name();
        bool const isUser = c.options.startNormals.kind == StartNormalKind::User;
        bool isBlended = false;
        for (std::size_t i = 0; i < frame.positions.size(); ++i) {
            ASSERT_NEAR(frame.positions[i].x, 1.7F, 1e-6F) << c.Name();
            ASSERT_NEAR(frame.positions[i].y, -0.3F, 1e-6F) << c.Name();
            isBlended = isBlended || frame.blendWeights[i] > 0;
            if (isUser) continue;  // N_S stands in
            ASSERT_TRUE(IsZero(frame.limitNormals[i])) << c.Name();
            ASSERT_TRUE(IsZero(frame.blendedNormals[i])) << c.Name();
        }
        EXPECT_TRUE(!isBlended || isUser || frame.report.zeroStartNormals > 0) << c.Name();
        if (c.options.limits.normals == LimitNormalKind::Limit) {
            EXPECT_GT(frame.report.fallbackNormals, 0) << c.Name();
        }
    }
}

/// Normals of the one-shot path that some 1e-12 of the model's size can turn: rounding alone decides on them.
std::vector<bool> AreNoise(Case const& c, Reference const& reference) {
    std::vector<double> points(c.points.begin(), c.points.end());
    shapes::Random random(1);
    for (double& x : points) x += 1e-12 * reference.size * random.Uniform(-1, 1);
    ShadingInput<double> input;
    input.positions = {points.data(), points.size() / 3};
    ShadingResult<double> const moved = ShadeSubdivision(c.shape.Mesh(), input, c.options);
    std::vector<bool> areNoise;
    for (std::size_t i = 0; i < moved.limitNormals.size(); ++i) {
        areNoise.push_back(Distance(moved.limitNormals[i], reference.result.limitNormals[i]) > 1e-6);
    }
    return areNoise;
}

TEST(ShadingEvaluator, FallsBackAsTheOneShotPathWhereFacesCollapse) {
    std::int64_t numFallbacks = 0;
    for (Case c : Cases()) {
        if (c.options.startNormals.kind == StartNormalKind::User) continue;
        // One face becomes a point, another loses a side.
        std::vector<std::vector<int>> const faces = c.shape.Faces();
        for (std::size_t i = 1; i < faces[0].size(); ++i) {
            std::copy_n(&c.points[3 * Index(faces[0][0])], 3, &c.points[3 * Index(faces[0][i])]);
        }
        std::size_t const other = faces.size() / 2;
        std::copy_n(&c.points[3 * Index(faces[other][0])], 3, &c.points[3 * Index(faces[other].back())]);
        ShadingTable const table(c.shape.Mesh(), c.options);
        TableFrame frame = FrameOf(c, table);
        Reference reference = ReferenceOf(c.shape.Mesh(), c.points, c.options);
        ASSERT_GT(reference.size, 0) << c.Name();
        std::vector<int> const values = table.ResultValues();
        std::vector<bool> const areNoise = AreNoise(c, reference);
        std::int64_t numNoise = 0;
        for (std::size_t i = 0; i < values.size(); ++i) {
            auto const value = Index(values[i]);
            if (!areNoise[value]) continue;
            ++numNoise;
            frame.limitNormals[i] = frame.blendedNormals[i] = {};
            reference.result.limitNormals[value] = reference.result.blendedNormals[value] = {};
        }
        EXPECT_LE(numNoise, static_cast<std::int64_t>(values.size() / 5)) << c.Name();
        Agreement const agreement = Compare(frame, values, reference);
        EXPECT_LE(agreement.position, 2e-7) << c.Name();
        // Of tangents that only just are no doubtful ones float leaves 64 times its rounding, of several terms.
        EXPECT_LE(agreement.normal, 2e-5) << c.Name() << ": " << agreement.worst;
        // A table computes the start normals that it needs, not all.
        EXPECT_LE(frame.report.zeroStartNormals, reference.result.report.zeroStartNormals) << c.Name();
        if (c.options.limits.normals == LimitNormalKind::Limit) {
            EXPECT_TRUE(frame.report.fallbackNormals > 0 || reference.result.report.fallbackNormals == 0)
                << c.Name();
        }
        numFallbacks += reference.result.report.fallbackNormals;
    }
    EXPECT_GT(numFallbacks, 0);
}

}  // namespace
}  // namespace osd_shading::tests
