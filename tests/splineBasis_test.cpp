// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/tables/splineBasis.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/shapes.h"

namespace {

using namespace osd_shading;

// Values are numbers of at most 1, rounded once from double.
constexpr double kRounding = 6e-8;

// The B-spline of degree `degree` over the knots i, i + 1, ... at x. [de Boor 1972]
double deBoor(int i, int degree, double x) {
    if (degree == 0) return x >= i && x < i + 1 ? 1 : 0;
    return (x - i) / degree * deBoor(i, degree - 1, x) +
           (i + degree + 1 - x) / degree * deBoor(i + 1, degree - 1, x);
}

double valueAt(SplineBasis const& basis, int i, std::vector<double> const& control, int first = 0) {
    double sum = 0;
    for (int j = 0; j < 4; ++j) sum += double(basis.value[j][i]) * control[static_cast<std::size_t>(first + j)];
    return sum;
}

double slopeAt(SplineBasis const& basis, int i, std::vector<double> const& control) {
    double sum = 0;
    for (std::size_t j = 0; j < 3; ++j) sum += double(basis.slope[j][i]) * (control[j + 1] - control[j]);
    return sum;
}

// All windows that begin at a few places of the side of a face.
std::vector<ParameterWindow> windows() {
    std::vector<ParameterWindow> all;
    for (int depth = 0; depth <= 15; ++depth) {
        int const last = 1 << depth;
        for (int const first : {0, 1, last / 2, last - 16, last}) {
            if (first >= 0 && first <= last) all.push_back({depth, first, std::min(17, last + 1 - first)});
        }
    }
    return all;
}

TEST(SplineBasis, AtTheEndsOfAFaceTheValuesAreOneFourOneSixths) {
    SplineBasis const basis = MakeFaceBasis({0, 0, 2});
    EXPECT_EQ(basis.numParameters, 2);
    EXPECT_EQ(basis.gridSize, 1);
    float const expected[4] = {1 / 6.F, 4 / 6.F, 1 / 6.F, 0};
    for (int j = 0; j < 4; ++j) {
        EXPECT_EQ(basis.value[j][0], expected[j]);
        EXPECT_EQ(basis.value[j][1], expected[3 - j]);
    }
    float const slope[3] = {0.5F, 0.5F, 0};
    for (int j = 0; j < 3; ++j) {
        EXPECT_EQ(basis.slope[j][0], slope[j]);
        EXPECT_EQ(basis.slope[j][1], slope[2 - j]);
    }
}

TEST(SplineBasis, ARefinedFaceGivesTheRulesOfSubdivision) {
    SplineBasis const basis = MakeRefinedFaceBasis({1, 0, 3});
    float const vertex[4] = {1 / 8.F, 6 / 8.F, 1 / 8.F, 0}, edge[4] = {0, 0.5F, 0.5F, 0};
    for (int j = 0; j < 4; ++j) {
        EXPECT_EQ(basis.value[j][0], vertex[j]);
        EXPECT_EQ(basis.value[j][1], edge[j]);
        EXPECT_EQ(basis.value[j][2], vertex[3 - j]);
    }
}

TEST(SplineBasis, ValuesAreTheBSplinesOfDeBoor) {
    for (ParameterWindow const& window : windows()) {
        SplineBasis const basis = MakeFaceBasis(window);
        for (int i = 0; i < window.count; ++i) {
            double const x = std::ldexp(window.first + i, -window.depth);
            for (int j = 0; j < 4; ++j) EXPECT_NEAR(double(basis.value[j][i]), deBoor(j - 3, 3, x), kRounding);
            for (int j = 0; j < 3; ++j) EXPECT_NEAR(double(basis.slope[j][i]), deBoor(j - 2, 2, x), kRounding);
        }
    }
}

TEST(SplineBasis, RefinedValuesAreThoseOfRepeatedSubdivision) {
    shapes::Random random(5);
    for (int depth = 0; depth <= 10; ++depth) {
        // Control points -1, 0, 1, 2 of the face between 0 and 1; each step keeps the neighbours of its ends.
        std::vector<double> control;
        for (int i = 0; i < 4; ++i) control.push_back(random.Uniform(-1, 1));
        std::vector<double> refined = control;
        for (int k = 0; k < depth; ++k) {
            std::vector<double> finer;
            for (std::size_t i = 0; i + 1 < refined.size(); ++i) {
                if (i > 0) finer.push_back((refined[i - 1] + 6 * refined[i] + refined[i + 1]) / 8);
                finer.push_back((refined[i] + refined[i + 1]) / 2);
            }
            refined = finer;
        }
        int const last = 1 << depth;
        for (int first = 0; first <= last; first += 16) {
            ParameterWindow const window{depth, first, std::min(17, last + 1 - first)};
            SplineBasis const basis = MakeRefinedFaceBasis(window), limit = MakeFaceBasis(window);
            for (int i = 0; i < window.count; ++i) {
                auto const vertex = static_cast<std::size_t>(first + i + 1);
                EXPECT_NEAR(valueAt(basis, i, control), refined[vertex], 4 * kRounding);
                EXPECT_EQ(slopeAt(basis, i, control), slopeAt(limit, i, control));
            }
        }
    }
}

TEST(SplineBasis, LinearControlPointsGiveALineWithItsSlope) {
    std::vector<double> line;
    for (int i = 0; i < 20; ++i) line.push_back(i - 1);
    for (ParameterWindow const& window : windows()) {
        for (SplineBasis const& basis : {MakeFaceBasis(window), MakeRefinedFaceBasis(window)}) {
            for (int i = 0; i < window.count; ++i) {
                EXPECT_NEAR(valueAt(basis, i, line), std::ldexp(window.first + i, -window.depth), 4 * kRounding);
                EXPECT_NEAR(slopeAt(basis, i, line), 1, 2 * kRounding);
            }
        }
    }
    for (int gridSize = 2; gridSize <= 16; gridSize *= 2) {
        for (int shift = 0; (gridSize << shift) <= 16; ++shift) {
            SplineBasis const basis = MakeGridBasis(gridSize, shift);
            for (int i = 0; i < basis.numParameters; ++i) {
                // The last parameter has a control point past the end.
                EXPECT_NEAR(valueAt(basis, i, line, i >> shift), std::ldexp(i, -shift), 20 * kRounding);
            }
        }
    }
}

TEST(SplineBasis, SlopesAreDerivatives) {
    // Values of the cubic that the face's control points give, by its derivative from differences of values.
    std::vector<double> const control = {0.3, -0.9, 1.4, 0.2};
    SplineBasis const basis = MakeFaceBasis({4, 0, 17});
    auto const cubic = [&](double x) {
        double sum = 0;
        for (int j = 0; j < 4; ++j) sum += deBoor(j - 3, 3, x) * control[static_cast<std::size_t>(j)];
        return sum;
    };
    for (int i = 1; i < 16; ++i) {
        double const x = i / 16.0, h = 1e-5;
        EXPECT_NEAR(slopeAt(basis, i, control), (cubic(x + h) - cubic(x - h)) / (2 * h), 1e-6);
    }
}

TEST(SplineBasis, AGridRepeatsTheValuesOfOneFaceAndEndsWithAZero) {
    for (int gridSize = 2; gridSize <= 16; gridSize *= 2) {
        for (int shift = 0; (gridSize << shift) <= 16; ++shift) {
            SplineBasis const grid = MakeGridBasis(gridSize, shift);
            SplineBasis const face = MakeFaceBasis({shift, 0, (1 << shift) + 1});
            EXPECT_EQ(grid.gridSize, gridSize);
            EXPECT_EQ(grid.shift, shift);
            ASSERT_EQ(grid.numParameters, (gridSize << shift) + 1);
            for (int j = 0; j < 4; ++j) {
                for (int i = 0; i < grid.numParameters; ++i) {
                    EXPECT_EQ(grid.value[j][i], face.value[j][i % (1 << shift)]);
                }
            }
            EXPECT_EQ(grid.value[3][grid.numParameters - 1], 0);
        }
    }
}

TEST(SplineBasis, PastTheLastParameterAllIsZero) {
    for (SplineBasis const& basis :
         {MakeFaceBasis({4, 3, 5}), MakeRefinedFaceBasis({9, 100, 17}), MakeGridBasis(8, 1)}) {
        for (int i = basis.numParameters; i < SplineBasis::kPitch; ++i) {
            for (int j = 0; j < 4; ++j) EXPECT_EQ(basis.value[j][i], 0);
            for (int j = 0; j < 3; ++j) EXPECT_EQ(basis.slope[j][i], 0);
        }
    }
}

}  // namespace
