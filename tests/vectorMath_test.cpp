// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/vectorMath.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/testHelpers.h"

namespace {

using namespace osd_shading;
using namespace osd_shading::tests;

constexpr double kPi = 3.14159265358979323846;

TEST(VectorMath, LengthOfThreeAndFourIsFive) {
    EXPECT_EQ(Length(Vec3<double>{3, 4, 0}), 5);
    EXPECT_EQ(Length(Vec3<float>{0, -3, 4}), 5);
}

TEST(VectorMath, LengthNeitherOverflowsNorUnderflows) {
    // The squares of these leave the range of numbers; a few roundings remain.
    for (double const size : {1e-300, 1e-200, 1e200, 1e300}) {
        EXPECT_NEAR(Length(Vec3<double>{3 * size, 4 * size, 0}) / size, 5, 1e-14);
    }
    for (float const size : {1e-30F, 1e-22F, 1e25F, 1e37F}) {
        EXPECT_NEAR(Length(Vec3<float>{3 * size, 4 * size, 0}) / size, 5, 2e-6);
    }
}

TEST(VectorMath, CrossOfXAndYIsZ) {
    Vec3<double> const z = Cross(Vec3<double>{1, 0, 0}, Vec3<double>{0, 1, 0});
    EXPECT_EQ(z.x, 0);
    EXPECT_EQ(z.y, 0);
    EXPECT_EQ(z.z, 1);
}

TEST(VectorMath, AnglesAreExactNearZeroAndHalfATurn) {
    // The arc cosine of a product would give 0 for both.
    EXPECT_NEAR(AngleBetween(Vec3<double>{1, 0, 0}, Vec3<double>{1, 1e-9, 0}), 1e-9, 1e-24);
    EXPECT_NEAR(kPi - AngleBetween(Vec3<double>{1, 0, 0}, Vec3<double>{-1, 1e-9, 0}), 1e-9, 1e-15);
    EXPECT_EQ(AngleBetween(Vec3<float>{0, 1, 0}, Vec3<float>{0, 2, 0}), 0);
    EXPECT_EQ(AngleBetween(Vec3<double>{}, Vec3<double>{1, 0, 0}), 0);
}

TEST(VectorMath, NormalizedVectorsHaveUnitLengthAtAnySize) {
    shapes::Random random(3);
    for (double exponent = -300; exponent <= 300; exponent += 7) {
        double const size = std::pow(10, exponent);
        Vec3<double> const a{random.Uniform(-size, size), random.Uniform(-size, size), random.Uniform(-size, size)};
        EXPECT_NEAR(Length(Normalized(a)), 1, 1e-15);  // a few roundings
    }
}

TEST(VectorMath, SumsVanishAgainstWhatWasAdded) {
    EXPECT_TRUE(IsZero(NormalizedSum(Vec3<double>{1e-13, 0, 0}, 1.0)));
    EXPECT_EQ(NormalizedSum(Vec3<double>{1e-11, 0, 0}, 1.0).x, 1);
    EXPECT_EQ(NormalizedSum(Vec3<double>{1e-13, 0, 0}, 1e-13).x, 1);
    EXPECT_TRUE(IsZero(NormalizedSum(Vec3<float>{1e-7F, 0, 0}, 1.0F)));
    EXPECT_EQ(NormalizedSum(Vec3<float>{1e-5F, 0, 0}, 1.0F).x, 1);
}

TEST(VectorMath, ZeroAndNotANumberNormalizeToZero) {
    double const nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(IsZero(Normalized(Vec3<double>{})));
    for (Vec3<double> const& a : {Vec3<double>{nan, 0, 0}, {nan, 1, 0}, {1, 1, nan}}) {
        EXPECT_TRUE(IsZero(Normalized(a)));
    }
}

TEST(VectorMath, SmallestNumbersKeepTheirDirection) {
    double const tiny = std::numeric_limits<double>::denorm_min();
    EXPECT_NEAR(Distance(Normalized(Vec3<double>{tiny, 0, 0}), {1, 0, 0}), 0, 1e-15);
}

}  // namespace
