// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/tables/patchKernels.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "osd_shading/tables/splineBasis.h"
#include "tests/kernelCases.h"

namespace osd_shading::tests {
namespace {

INSTANTIATE_TEST_SUITE_P(Sets, PatchKernelsOf, testing::ValuesIn(availableSets()),
                         [](auto const& set) { return std::string(FindKernels(set.param)->name); });

// What a spline is: plain sums over all control points.
template <typename Control>
Point tensor(float const (&u)[4][SplineBasis::kPitch], int i, float const (&v)[4][SplineBasis::kPitch], int j,
             Control const& control) {
    Point sum;
    for (int r = 0; r < 4; ++r) {
        for (int c = 0; c < 4; ++c) {
            double const weight = double(u[c][i]) * double(v[r][j]);
            if (weight != 0) sum += weight * control(r, c);
        }
    }
    return sum;
}

TEST(PatchKernels, ThePortableKernelsAreAlwaysThereAndTheBestAreSome) {
    ASSERT_TRUE(IsAvailable(InstructionSet::Portable));
    ASSERT_TRUE(IsAvailable(InstructionSet::Best));
    EXPECT_STREQ(FindKernels(InstructionSet::Portable)->name, "portable");
    PatchKernels const* const best = FindKernels(InstructionSet::Best);
    for (InstructionSet const set : availableSets()) EXPECT_LE(FindKernels(set)->numLanes, best->numLanes);
    EXPECT_EQ(best, FindKernels(availableSets().back()));
}

// --- Splines
// ------------------------------------------------------------------------------------------------------

TEST_P(PatchKernelsOf, AFrameOfOneFaceIsTheSumOverItsControlPoints) {
    Random random(1);
    for (int k = 0; k <= 6; ++k) {
        int const last = 1 << k;
        for (int trial = 0; trial < 3; ++trial) {
            auto const window = [&] {
                int const first = last <= 16 ? 0 : 16 * random.Below(last / 16);
                return ParameterWindow{k, first, std::min(17, last + 1 - first)};
            };
            SplineBasis const u = trial == 2 ? MakeRefinedFaceBasis(window()) : MakeFaceBasis(window());
            SplineBasis const v = trial == 2 ? MakeRefinedFaceBasis(window()) : MakeFaceBasis(window());
            std::vector<LocalPoint> const points = randomLocalPoints(random, 40);
            std::vector<std::uint16_t> const indices = randomIndices(random, 16, 40);
            auto const control = [&](int r, int c) { return pointOf(points[indices[at(4 * r + c)]]); };
            for (Plan& plan : plans(random, u.numParameters, v.numParameters)) {
                Field position, du, dv, alone;
                kernels().evaluateSplineFrame(u, v, plan.Get(), points.data(), indices.data(), position.Arrays(),
                                              du.Arrays(), dv.Arrays());
                kernels().evaluateSpline(u, v, plan.Get(), points.data(), indices.data(), alone.Arrays());
                plan.ForAll([&](int i, int row, int column) {
                    Point p = tensor(u.value, column, v.value, row, control), byU, byV;
                    for (int r = 0; r < 4; ++r) {
                        for (int c = 0; c < 3; ++c) {
                            byU += double(v.value[r][row]) * double(u.slope[c][column]) *
                                   (control(r, c + 1) - control(r, c));
                            byV += double(u.value[r][column]) * double(v.slope[c][row]) *
                                   (control(c + 1, r) - control(c, r));
                        }
                    }
                    // Sums of 16 numbers of size 1 and weights of sum 1; derivatives of size 2.
                    expectNear(position[i], p, 8 * kSingle, "position");
                    expectNear(alone[i], p, 8 * kSingle, "position alone");
                    expectNear(du[i], byU, 16 * kSingle, "du");
                    expectNear(dv[i], byV, 16 * kSingle, "dv");
                });
            }
        }
    }
}

TEST_P(PatchKernelsOf, TangentsOfAPlaneFarFromItsOriginAreExactToTheLastDigits) {
    // Differences of control points, not of rounded points: the distance takes part in the rounding of the input
    // alone.
    SplineBasis const basis = MakeFaceBasis({4, 0, 17});
    std::vector<LocalPoint> points(16);
    std::vector<std::uint16_t> indices(16);
    for (int i = 0; i < 16; ++i) {
        points[at(i)] = {{1000 + 0.125F * float(i % 4), 0.25F * float(i / 4), -500, 0}};
        indices[at(i)] = std::uint16_t(i);
    }
    Plan plan;
    for (int row = 0; row < 17; ++row) plan.Add(row, 0, 17);
    Field position, du, dv;
    kernels().evaluateSplineFrame(basis, basis, plan.Get(), points.data(), indices.data(), position.Arrays(),
                                  du.Arrays(), dv.Arrays());
    plan.ForAll([&](int i, int, int) {
        expectNear(du[i], {0.125, 0, 0}, 0.125 * 8 * kSingle, "du");
        expectNear(dv[i], {0, 0.25, 0}, 0.25 * 8 * kSingle, "dv");
    });
}

TEST_P(PatchKernelsOf, AGridIsTheSumOverTheControlPointsOfEachOfItsFaces) {
    Random random(2);
    for (int gridSize = 2; gridSize <= 16; gridSize *= 2) {
        for (int shift = 0; (gridSize << shift) <= 16; ++shift) {
            SplineBasis const basis = MakeGridBasis(gridSize, shift);
            std::vector<LocalPoint> points = randomLocalPoints(random, 400);
            std::vector<std::uint16_t> indices = randomIndices(random, (gridSize + 3) * (gridSize + 3), 400);
            // The end has weight 0 for a row past the last: what lies there does not matter.
            points.push_back({{kNan, kNan, kNan, kNan}});
            indices.insert(indices.end(), at(gridSize + 4), 400);
            for (Plan& plan : plans(random, basis.numParameters, basis.numParameters)) {
                Field field;
                kernels().evaluateSpline(basis, basis, plan.Get(), points.data(), indices.data(), field.Arrays());
                plan.ForAll([&](int i, int row, int column) {
                    auto const control = [&](int r, int c) {
                        int const index = ((row >> shift) + r) * (gridSize + 3) + (column >> shift) + c;
                        return pointOf(points[indices[at(index)]]);
                    };
                    expectNear(field[i], tensor(basis.value, column, basis.value, row, control), 8 * kSingle,
                               "grid");
                });
            }
        }
    }
}

// --- Dense matrices
// -----------------------------------------------------------------------------------------------

TEST_P(PatchKernelsOf, ADenseMatrixIsTheSumOverItsColumns) {
    Random random(3);
    for (int trial = 0; trial < 200; ++trial) {
        int const numFields = 1 + trial % 5;
        int const numPoints = trial < 80 ? 1 + trial / 5 * 2 : 1 + random.Below(289);
        int const numColumns = 1 + random.Below(70);
        int const numBlocks = (numPoints + kDenseBlock - 1) / kDenseBlock;
        std::vector<double> weights(at(numPoints * numFields * numColumns));
        std::vector<float> memory(at(numBlocks * numColumns * numFields * kDenseBlock + 16), 0.0F);
        void* start = memory.data();
        std::size_t space = memory.size() * sizeof(float);
        auto* const packed = static_cast<float*>(std::align(64, 64, start, space));
        for (int i = 0; i < numPoints; ++i) {
            for (int column = 0; column < numColumns; ++column) {
                for (int f = 0; f < numFields; ++f) {
                    auto const weight = static_cast<float>(random.Uniform(-1, 1));
                    weights[at((i * numColumns + column) * numFields + f)] = double(weight);
                    packed[((i / kDenseBlock * numColumns + column) * numFields + f) * kDenseBlock +
                           i % kDenseBlock] = weight;
                }
            }
        }
        std::vector<LocalPoint> const points = randomLocalPoints(random, 90);
        std::vector<std::uint16_t> const indices = randomIndices(random, numColumns, 90);
        std::vector<Field> fields(at(numFields));
        std::vector<FieldArrays> arrays;
        for (Field& field : fields) arrays.push_back(field.Arrays());
        kernels().evaluateDense({numPoints, numColumns, numFields, packed}, points.data(), indices.data(),
                                arrays.data());
        for (int i = 0; i < numPoints; ++i) {
            for (int f = 0; f < numFields; ++f) {
                Point sum;
                for (int column = 0; column < numColumns; ++column) {
                    sum += weights[at((i * numColumns + column) * numFields + f)] *
                           pointOf(points[indices[at(column)]]);
                }
                // Each sum of up to 70 products of size 1 is rounded as often.
                expectNear(fields[at(f)][i], sum, numColumns * 8 * kSingle, "dense");
            }
        }
    }
}

// --- Sparse rows
// --------------------------------------------------------------------------------------------------

TEST_P(PatchKernelsOf, RowsCombineThePointsBeforeThem) {
    Random random(10);
    int const numPoints = 25, numRows = 60;
    std::vector<LocalPoint> points = randomLocalPoints(random, numPoints);
    points.resize(at(numPoints + numRows));
    std::vector<Point> expected;
    for (int i = 0; i < numPoints; ++i) expected.push_back(pointOf(points[at(i)]));
    std::vector<std::uint32_t> offsets = {0};
    std::vector<std::uint16_t> sources;
    std::vector<float> weights;
    for (int row = 0; row < numRows; ++row) {
        int const numTerms = row == 3 ? 0 : 1 + random.Below(10);
        Point sum;
        for (int t = 0; t < numTerms; ++t) {
            auto const weight = static_cast<float>(random.Uniform(0, 2.0 / numTerms));
            int const source = random.Below(numPoints + row);
            sum += double(weight) * expected[at(source)];
            sources.push_back(std::uint16_t(source));
            weights.push_back(weight);
        }
        expected.push_back(sum);
        offsets.push_back(static_cast<std::uint32_t>(sources.size()));
    }
    kernels().combine(numRows, offsets.data(), sources.data(), weights.data(), points.data(),
                      points.data() + numPoints);
    for (int i = 0; i < numPoints + numRows; ++i) {
        expectNear(pointOf(points[at(i)]), expected[at(i)], 20 * kSingle, "row");
        EXPECT_EQ(points[at(i)].v[3], 0);
    }
}

}  // namespace
}  // namespace osd_shading::tests
