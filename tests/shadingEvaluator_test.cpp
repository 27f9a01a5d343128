// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/shadingEvaluator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/evaluatorCases.h"
#include "tests/sampleSize.h"
#include "tests/tableAgreement.h"

namespace osd_shading::tests {
namespace {

constexpr InstructionSet kAllSets[] = {InstructionSet::Portable, InstructionSet::Sse2, InstructionSet::Avx2,
                                       InstructionSet::Avx512};

// --- Numbers worked by hand
// ---------------------------------------------------------------------------------------

TEST(ShadingEvaluator, PutsACubesCornersHalfwayToTheMiddle) {
    // Three quads meet there: (9 v + 4 (sum of edge ends) + (sum of opposite corners)) / 24 with v = (1, 1, 1),
    // whose edge ends add to v and whose opposite corners add to -v, is v / 2.
    Shape const cube = shapes::Cube();
    std::vector<float> const points = cube.FloatPositions();
    ShadingTable const table(cube.Mesh(), PaperPreset(0));
    ASSERT_EQ(table.NumValues(), 8);
    TableFrame const frame = EvaluateAll(table, ViewOf(points));
    std::vector<int> const vertices = table.RefinedVertices();
    for (std::size_t i = 0; i < 8; ++i) {
        float const* const v = &points[3 * Index(vertices[i])];
        float const length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        for (int axis = 0; axis < 3; ++axis) {
            float const* const p = &frame.positions[i].x;
            float const* const n = &frame.blendedNormals[i].x;
            EXPECT_NEAR(p[axis], v[axis] / 2, 1e-6F);
            EXPECT_NEAR(n[axis], v[axis] / length, 1e-6F);
        }
    }
}

/// N_B alone.
std::vector<Vec3<float>> BlendedNormalsOf(ShadingEvaluator& evaluator, ShadingTable const& table,
                                          PointView<float> points) {
    std::vector<Vec3<float>> normals(Index(table.NumValues()));
    ShadingOutputs outputs;
    outputs.blendedNormals = SpanOf(normals);
    evaluator.Evaluate(points, outputs);
    return normals;
}

// --- Where numbers go
// ---------------------------------------------------------------------------------------------

/// All seven outputs, each in its own buffer of `strides[kind]` floats a value or interleaved in one.
TEST(ShadingEvaluator, WritesAnyStrideAndLeavesWhatLiesBetweenAlone) {
    constexpr float kSentinel = -12345.5F;
    for (Case const& c : Cases()) {
        for (ValueOrder const order : {ValueOrder::Tiles, ValueOrder::OpenSubdiv}) {
            ShadingTable const table(c.shape.Mesh(), c.options, order);
            auto const count = Index(table.NumValues());
            ShadingEvaluator evaluator(table);
            TableFrame packed;
            packed.positions.resize(count);
            packed.blendedNormals = packed.limitNormals = packed.positions;
            packed.blendWeights.resize(count);
            evaluator.Evaluate(ViewOf(c.points), ViewOf(c.normals),
                               {SpanOf(packed.positions),
                                SpanOf(packed.blendedNormals),
                                SpanOf(packed.limitNormals),
                                {},
                                {},
                                {},
                                {packed.blendWeights.data(), count, 1}});
            for (std::size_t const stride : {std::size_t{3}, std::size_t{4}, std::size_t{6}, std::size_t{8}}) {
                // P and N_B interleaved where there is room; N_L with a tail that is never written.
                std::size_t const pairStride = stride < 6 ? 2 * stride : stride;
                std::vector<float> pairs(count * pairStride + 5, kSentinel), limits(count * stride + 5, kSentinel),
                    weights(count * stride + 5, kSentinel);
                ShadingOutputs outputs;
                outputs.positions = {pairs.data(), count, pairStride};
                outputs.blendedNormals = {pairs.data() + pairStride / 2, count, pairStride};
                outputs.limitNormals = {limits.data(), count, stride};
                outputs.blendWeights = {weights.data(), count, stride};
                evaluator.Evaluate(ViewOf(c.points), ViewOf(c.normals), outputs);
                auto const expectAt = [&](float const* found, Vec3<float> const& expected) {
                    return std::memcmp(found, &expected, sizeof expected) == 0;
                };
                for (std::size_t i = 0; i < count; ++i) {
                    ASSERT_TRUE(expectAt(&pairs[i * pairStride], packed.positions[i])) << c.Name();
                    ASSERT_TRUE(expectAt(&pairs[i * pairStride + pairStride / 2], packed.blendedNormals[i]))
                        << c.Name();
                    ASSERT_TRUE(expectAt(&limits[i * stride], packed.limitNormals[i])) << c.Name();
                    ASSERT_EQ(weights[i * stride], packed.blendWeights[i]) << c.Name();
                    for (std::size_t k = 3; k < pairStride / 2; ++k) {
                        ASSERT_EQ(pairs[i * pairStride + k], kSentinel) << c.Name();
                        ASSERT_EQ(pairs[i * pairStride + pairStride / 2 + k], kSentinel) << c.Name();
                    }
                    for (std::size_t k = 3; k < stride; ++k) ASSERT_EQ(limits[i * stride + k], kSentinel);
                    for (std::size_t k = 1; k < stride; ++k) ASSERT_EQ(weights[i * stride + k], kSentinel);
                }
                for (std::size_t k = 0; k < 5; ++k) {
                    ASSERT_EQ(pairs[count * pairStride + k], kSentinel);
                    ASSERT_EQ(limits[count * stride + k], kSentinel);
                    ASSERT_EQ(weights[count * stride + k], kSentinel);
                }
            }
        }
    }
}

TEST(ShadingEvaluator, ReadsControlPointsOfAnyStride) {
    for (Case const& c : Cases()) {
        ShadingTable const table(c.shape.Mesh(), c.options);
        TableFrame const packed = FrameOf(c, table);
        for (std::size_t const stride : {std::size_t{4}, std::size_t{7}}) {
            std::size_t const count = c.points.size() / 3;
            std::vector<float> spread(count * stride, std::numeric_limits<float>::quiet_NaN());
            for (std::size_t i = 0; i < count; ++i) std::copy_n(&c.points[3 * i], 3, &spread[i * stride]);
            EXPECT_TRUE(
                IsSameFrame(packed, EvaluateAll(table, {spread.data(), count, stride}, {}, ViewOf(c.normals))))
                << c.Name();
        }
    }
}

TEST(ShadingEvaluator, GivesTheSameBitsForEverySubsetOfOutputs) {
    for (Case const& c : Cases()) {
        for (ValueOrder const order : {ValueOrder::Tiles, ValueOrder::OpenSubdiv}) {
            ShadingTable const table(c.shape.Mesh(), c.options, order);
            auto const count = Index(table.NumValues());
            TableFrame const all = FrameOf(c, table);
            std::vector<Vec3<float>> const* const expected[6] = {
                &all.positions, &all.blendedNormals, &all.limitNormals, &all.subdividedNormals, &all.du, &all.dv};
            ShadingEvaluator evaluator(table);
            for (unsigned subset = 0; subset < 128; ++subset) {
                if (IsSanitizerRun() && subset % 5 != 1) continue;
                std::vector<Vec3<float>> found[6];
                std::vector<float> weights;
                ShadingOutputs outputs;
                PointSpan* const spans[6] = {&outputs.positions,    &outputs.blendedNormals,
                                             &outputs.limitNormals, &outputs.subdividedNormals,
                                             &outputs.du,           &outputs.dv};
                for (unsigned kind = 0; kind < 6; ++kind) {
                    if (!(subset >> kind & 1)) continue;
                    found[kind].assign(count, {-1, -1, -1});
                    *spans[kind] = SpanOf(found[kind]);
                }
                if (subset >> 6 & 1) {
                    weights.assign(count, -1);
                    outputs.blendWeights = {weights.data(), count, 1};
                }
                evaluator.Evaluate(ViewOf(c.points), ViewOf(c.normals), outputs);
                for (unsigned kind = 0; kind < 6; ++kind) {
                    if (!(subset >> kind & 1)) continue;
                    ASSERT_TRUE(HasSameBits(found[kind], *expected[kind]))
                        << c.Name() << ", subset " << subset << ", output " << kind;
                }
                if (!weights.empty()) {
                    ASSERT_TRUE(HasSameBits(weights, all.blendWeights)) << c.Name();
                }
            }
        }
    }
}

// --- Threads
// ------------------------------------------------------------------------------------------------------

TEST(ShadingEvaluator, GivesTheSameBitsForAnyNumberOfThreads) {
    for (Case const& c : Cases()) {
        for (ValueOrder const order : {ValueOrder::Tiles, ValueOrder::OpenSubdiv}) {
            ShadingTable const table(c.shape.Mesh(), c.options, order);
            TableFrame const one = FrameOf(c, table);
            for (int numThreads = 0; numThreads <= 8; ++numThreads) {
                EvaluatorOptions options;
                options.numThreads = numThreads;
                EXPECT_TRUE(IsSameFrame(one, FrameOf(c, table, options))) << c.Name() << ", " << numThreads;
            }
        }
    }
}

TEST(ShadingEvaluator, ManyFramesOnManyThreadsAreAllTheSame) {
    // Large enough that all threads have work, and frames follow each other at once.
    Shape const shape = shapes::Torus(24, 16).Crease(0, 1, 1.5F).Jitter(0.1);
    Case const c{shape, PaperPreset(4)};
    ShadingTable const table(shape.Mesh(), c.options);
    EvaluatorOptions options;
    options.numThreads = 4;
    ShadingEvaluator one(table), four(table, options);
    std::vector<Vec3<float>> const expected = BlendedNormalsOf(one, table, ViewOf(c.points));
    for (int frame = 0; frame < (IsSanitizerRun() ? 20 : 200); ++frame) {
        ASSERT_TRUE(HasSameBits(BlendedNormalsOf(four, table, ViewOf(c.points)), expected)) << "frame " << frame;
    }
}

TEST(ShadingEvaluator, SeveralShareATableOnThreadsOfTheirOwn) {
    for (ShadingOptions const& options : {PaperPreset(3), SmoothPreset(3)}) {
        Shape const shape = shapes::Cross().CreaseAll(1.5F);
        ShadingTable const table(shape.Mesh(), options);
        Case const c{shape, options};
        // One frame with a collapsed face: normals that are settled one by one.
        std::vector<float> collapsed = c.points;
        for (int i = 1; i < shape.faceSizes[0]; ++i) {
            std::copy_n(&c.points[3 * Index(shape.faceVertices[0])], 3,
                        &collapsed[3 * Index(shape.faceVertices[Index(i)])]);
        }
        TableFrame const expected[2] = {EvaluateAll(table, ViewOf(c.points)),
                                        EvaluateAll(table, ViewOf(collapsed))};
        std::vector<std::thread> threads;
        std::vector<int> failures(4, 0);
        for (std::size_t t = 0; t < failures.size(); ++t) {
            threads.emplace_back([&, t] {
                EvaluatorOptions own;
                own.numThreads = 1 + static_cast<int>(t % 3);
                for (int frame = 0; frame < 5; ++frame) {
                    int const which = frame % 2;
                    TableFrame const found = EvaluateAll(table, ViewOf(which == 0 ? c.points : collapsed), own);
                    failures[t] += !IsSameFrame(expected[which], found);
                }
            });
        }
        for (std::thread& thread : threads) thread.join();
        for (int const count : failures) EXPECT_EQ(count, 0);
    }
}

TEST(ShadingEvaluator, KeepsItsTableAliveAndMoves) {
    Shape const shape = shapes::CubeWithSharpTop();
    std::vector<float> const points = shape.FloatPositions();
    auto table = std::make_unique<ShadingTable>(shape.Mesh(), PaperPreset(3));
    ShadingTable const same = *table;
    ShadingTable copy = *table;
    ShadingEvaluator first(*table), second(copy);
    std::vector<Vec3<float>> const expected = BlendedNormalsOf(first, same, ViewOf(points));
    table.reset();
    copy = ShadingTable(shapes::Torus(4, 4).Mesh(), PaperPreset(1));
    ShadingTable const moved = std::move(copy);
    EXPECT_EQ(moved.NumFaces(), 64);
    ShadingEvaluator third = std::move(first);
    EXPECT_TRUE(HasSameBits(BlendedNormalsOf(third, same, ViewOf(points)), expected));
    third = std::move(second);
    EXPECT_TRUE(HasSameBits(BlendedNormalsOf(third, same, ViewOf(points)), expected));
}

// --- Instruction sets
// ---------------------------------------------------------------------------------------------

TEST(ShadingEvaluator, InstructionSetsDifferInTheLastDigitsOnly) {
    ASSERT_TRUE(IsAvailable(InstructionSet::Portable));
    ASSERT_TRUE(IsAvailable(InstructionSet::Best));
    for (Case const& c : Cases()) {
        ShadingTable const table(c.shape.Mesh(), c.options);
        Reference const reference = ReferenceOf(c.shape.Mesh(), c.points, c.options, c.normals);
        std::vector<int> const values = table.ResultValues();
        std::optional<TableFrame> portable;
        for (InstructionSet const set : kAllSets) {
            if (!IsAvailable(set)) continue;
            EvaluatorOptions options;
            options.instructionSet = set;
            std::string const name = ShadingEvaluator(table, options).InstructionSetName();
            TableFrame const frame = FrameOf(c, table, options);
            Agreement const agreement = Compare(frame, values, reference);
            EXPECT_LE(agreement.position, 2e-7) << c.Name() << ", " << name;
            EXPECT_LE(agreement.normal, 1e-5) << c.Name() << ", " << name << ": " << agreement.worst;
            EXPECT_EQ(agreement.supportDiffers, 0) << c.Name() << ", " << name;
            if (!portable) portable = frame;
            for (std::size_t i = 0; i < frame.positions.size(); ++i) {
                double const b = double{frame.blendWeights[i]};
                ASSERT_EQ(frame.blendWeights[i], portable->blendWeights[i]);
                ASSERT_LE(Distance(frame.positions[i], portable->positions[i]), 1e-6 * reference.size)
                    << c.Name() << ", " << name << ", value " << i;
                // An angle between unit vectors near each other: both are 1e-5 from the truth at most.
                ASSERT_LE(Distance(frame.limitNormals[i], portable->limitNormals[i]), 2e-5)
                    << c.Name() << ", " << name << ", value " << i << ", b " << b;
            }
        }
    }
    EvaluatorOptions best;
    ShadingTable const table(shapes::Cube().Mesh(), PaperPreset(1));
    EXPECT_STRNE(ShadingEvaluator(table, best).InstructionSetName(), "");
}

// --- Tangents
// -----------------------------------------------------------------------------------------------------

TEST(ShadingEvaluator, LimitNormalsStandOnItsTangents) {
    for (Case const& c : Cases()) {
        if (c.options.limits.normals == LimitNormalKind::FaceAverage) continue;
        ShadingTable const table(c.shape.Mesh(), c.options);
        TableFrame const frame = FrameOf(c, table);
        std::int64_t numCompared = 0, numWithout = 0;
        for (std::size_t i = 0; i < frame.positions.size(); ++i) {
            Vec3<float> const normal = Cross(frame.du[i], frame.dv[i]);
            numWithout += IsZero(frame.du[i]) && IsZero(frame.dv[i]);
            float const sine = Length(normal) / (Length(frame.du[i]) * Length(frame.dv[i]));
            if (!(sine > 0.01F)) continue;
            ++numCompared;
            ASSERT_LE(AngleBetween(normal, frame.limitNormals[i]), 2e-6 / double{sine})
                << c.Name() << ", value " << i;
        }
        // The rest are corners of several faces.
        EXPECT_GE(numCompared + numWithout, static_cast<std::int64_t>(frame.positions.size() * 99 / 100))
            << c.Name();
    }
}

/// The values of each tile as a square or triangular grid, rows along v and columns along u, -1 outside; and the
/// side.
std::vector<std::pair<int, std::vector<std::vector<int>>>> GridsOf(Case const& c, ShadingTable const& table) {
    std::vector<std::pair<int, std::vector<std::vector<int>>>> grids;
    std::vector<int> const faces = table.FaceValues(), base = table.BaseFaces();
    auto const size = Index(table.FaceSize());
    std::size_t face = 0;
    while (face < base.size()) {
        int const numCorners = c.shape.faceSizes[Index(base[face])];
        bool const isNgon = size == 4 && numCorners != 4;
        for (int child = 0; child < (isNgon ? numCorners : 1); ++child) {
            int const side = 1 << (c.options.level - (isNgon ? 1 : 0));
            std::vector<std::vector<int>> grid(Index(side) + 1, std::vector<int>(Index(side) + 1, -1));
            for (std::size_t row = 0; row < Index(side); ++row) {
                for (std::size_t column = 0; column < Index(side) - (size == 3 ? row : 0); ++column) {
                    int const* const corners = &faces[size * face++];
                    grid[row][column] = corners[0];
                    grid[row][column + 1] = corners[1];
                    if (size == 4) {
                        grid[row + 1][column + 1] = corners[2];
                        grid[row + 1][column] = corners[3];
                        continue;
                    }
                    grid[row + 1][column] = corners[2];
                    if (row + column + 2 > Index(side)) continue;
                    grid[row + 1][column + 1] = faces[size * face++ + 1];  // the triangle between two of the row
                }
            }
            grids.emplace_back(side, std::move(grid));
        }
    }
    return grids;
}

TEST(ShadingEvaluator, TangentsAreTheDerivativesAlongATilesColumnsAndRows) {
    // A flat grid whose vertex (i, j) lies at (i, j) is its own surface: du = (1, 0, 0) wherever faces start at (i,
    // j).
    std::vector<std::pair<Case, double>> cases;
    // Polynomials of degree 4 and less have these five-point differences exactly, but for the rounding of P.
    cases.push_back({{shapes::Torus(6, 5).Jitter(0.1), PaperPreset(5)}, 2e-5});
    Shape const jittered = shapes::Torus(6, 5).Jitter(0.1);
    cases.push_back({{Shape(jittered).Loop(), PaperPreset(5)}, 2e-5});
    // Faces that begin at other corners.
    for (Shape shape : {jittered, Shape(jittered).Loop()}) {
        std::vector<std::vector<int>> faces = shape.Faces();
        for (std::size_t f = 0; f < faces.size(); ++f) {
            std::rotate(faces[f].begin(), faces[f].begin() + static_cast<std::ptrdiff_t>(f % faces[f].size()),
                        faces[f].end());
        }
        shape.SetFaces(faces);
        cases.push_back({{shape, PaperPreset(5)}, 2e-5});
    }
    // Tiles that split, and children of n-gons: pieces of polynomials that meet with their second derivatives.
    for (Shape const& shape :
         {shapes::Cube(), shapes::Cross().CreaseAll(1.5F), shapes::MixedPolygons(), shapes::Pyramid(5),
          shapes::Icosahedron().Loop(), shapes::Octahedron().Loop().CreaseAll(2), shapes::TriangleFan(7).Loop()}) {
        cases.push_back({{Shape(shape).Jitter(0.05), PaperPreset(6)}, 1e-2});
    }
    for (auto const& [c, tolerance] : cases) {
        ShadingTable const table(c.shape.Mesh(), c.options);
        TableFrame const frame = FrameOf(c, table);
        std::vector<Vec3<double>> points;
        for (Vec3<float> const& p : frame.positions) points.push_back({double{p.x}, double{p.y}, double{p.z}});
        int numCompared = 0;
        double worst = 0;
        for (auto const& tile : GridsOf(c, table)) {
            // clang 14 lets no lambda have a structured binding.
            auto const& side = tile.first;
            auto const& grid = tile.second;
            auto const along = [&](int row, int column, int rowStep, int columnStep,
                                   std::vector<Vec3<float>> const& t) {
                auto const at = [&](int step) {
                    return grid[Index(row + step * rowStep)][Index(column + step * columnStep)];
                };
                auto const pointAt = [&](int step) { return points[Index(at(step))]; };
                Vec3<double> const difference =
                    (side / 12.0) * (8.0 * (pointAt(1) - pointAt(-1)) - (pointAt(2) - pointAt(-2)));
                worst = std::max(worst, Distance({difference.x, difference.y, difference.z},
                                                 Vec3<double>{double{t[Index(at(0))].x}, double{t[Index(at(0))].y},
                                                              double{t[Index(at(0))].z}}) /
                                            Length(difference));
                ++numCompared;
            };
            for (int row = 2; row + 2 <= side; ++row) {
                for (int column = 2; column + 2 <= side - (table.FaceSize() == 3 ? row : 0); ++column) {
                    along(row, column, 0, 1, frame.du);
                    along(row, column, 1, 0, frame.dv);
                }
            }
        }
        EXPECT_GT(numCompared, 0) << c.Name();
        EXPECT_LE(worst, tolerance) << c.Name();
    }
}

// --- Bad calls
// ----------------------------------------------------------------------------------------------------

TEST(ShadingEvaluator, RefusesInWords) {
    Shape const cube = shapes::Cube();
    std::vector<float> const points = cube.FloatPositions();
    ShadingTable const table(cube.Mesh(), PaperPreset(0));
    auto const errorOf = [](auto const& call) { return ErrorOf<InvalidOptions>(call); };

    EvaluatorOptions negative;
    negative.numThreads = -2;
    EXPECT_EQ(errorOf([&] { ShadingEvaluator(table, negative); }), "numThreads is -2; it must be 0 or more");
    for (InstructionSet const set : kAllSets) {
        if (IsAvailable(set)) continue;
        EvaluatorOptions absent;
        absent.instructionSet = set;
        EXPECT_EQ(errorOf([&] { ShadingEvaluator(table, absent); }),
                  "this build or this processor does not have the instruction set asked for; use "
                  "InstructionSet::Best");
    }

    ShadingEvaluator evaluator(table);
    std::vector<Vec3<float>> room(8, Vec3<float>{7, 7, 7});
    std::vector<float> numbers(8, 7);
    auto const errorWith = [&](auto const& change, PointView<float> view, PointView<float> normals = {}) {
        ShadingOutputs outputs;
        outputs.positions = SpanOf(room);
        outputs.blendWeights = {numbers.data(), 8, 1};
        change(outputs);
        return errorOf([&] { evaluator.Evaluate(view, normals, outputs); });
    };
    auto const nothing = [](ShadingOutputs&) {};
    EXPECT_EQ(errorWith(nothing, {points.data(), 7}),
              "controlPoints has 7 elements; the table needs 8, one per control vertex");
    EXPECT_EQ(errorWith(nothing, {}), "controlPoints has 0 elements; the table needs 8, one per control vertex");
    EXPECT_EQ(errorWith(nothing, {nullptr, 8}), "controlPoints: its pointer is null");
    EXPECT_EQ(errorWith(nothing, {points.data(), 8, 2}), "controlPoints: its stride is 2; give 3 or more");
    EXPECT_EQ(errorWith(nothing, ViewOf(points), ViewOf(points)),
              "userNormals are given, but the table's start normals are not StartNormalKind::User");

    PointSpan ShadingOutputs::*const spans[] = {&ShadingOutputs::positions,    &ShadingOutputs::blendedNormals,
                                                &ShadingOutputs::limitNormals, &ShadingOutputs::subdividedNormals,
                                                &ShadingOutputs::du,           &ShadingOutputs::dv};
    char const* const names[] = {"positions", "blendedNormals", "limitNormals", "subdividedNormals", "du", "dv"};
    for (std::size_t i = 0; i < 6; ++i) {
        std::string const name = names[i];
        EXPECT_EQ(errorWith(
                      [&](ShadingOutputs& o) {
                          o.*spans[i] = {&room[0].x, 7, 3};
                      },
                      ViewOf(points)),
                  name + " has room for 7 elements; the table has 8 values");
        EXPECT_EQ(errorWith(
                      [&](ShadingOutputs& o) {
                          o.*spans[i] = {nullptr, 8, 3};
                      },
                      ViewOf(points)),
                  name + ": its pointer is null");
        EXPECT_EQ(errorWith(
                      [&](ShadingOutputs& o) {
                          o.*spans[i] = {&room[0].x, 8, 2};
                      },
                      ViewOf(points)),
                  name + ": its stride is 2; give 3 or more");
    }
    EXPECT_EQ(errorWith(
                  [&](ShadingOutputs& o) {
                      o.blendWeights = {numbers.data(), 9, 1};
                  },
                  ViewOf(points)),
              "blendWeights has room for 9 elements; the table has 8 values");
    EXPECT_EQ(errorWith(
                  [&](ShadingOutputs& o) {
                      o.blendWeights = {nullptr, 8, 1};
                  },
                  ViewOf(points)),
              "blendWeights: its pointer is null");
    EXPECT_EQ(errorWith(
                  [&](ShadingOutputs& o) {
                      o.blendWeights = {numbers.data(), 8, 0};
                  },
                  ViewOf(points)),
              "blendWeights: its stride is 0; give 1 or more");
    // Nothing was written on the way.
    for (Vec3<float> const& p : room) EXPECT_EQ(p.x, 7);
    for (float const b : numbers) EXPECT_EQ(b, 7);

    ShadingOptions user = PaperPreset(1);
    user.startNormals = {StartNormalKind::User, 0};
    ShadingTable const userTable(cube.Mesh(), user);
    ShadingEvaluator userEvaluator(userTable);
    EXPECT_EQ(errorOf([&] { userEvaluator.Evaluate(ViewOf(points), {}, {}); }),
              "userNormals has 0 elements; the table needs 24, one per control vertex or face corner");
    std::vector<float> const normals(3 * 23, 1.0F);
    EXPECT_EQ(errorOf([&] { userEvaluator.Evaluate(ViewOf(points), ViewOf(normals), {}); }),
              "userNormals has 23 elements; the table needs 24, one per control vertex or face corner");
}

}  // namespace
}  // namespace osd_shading::tests
