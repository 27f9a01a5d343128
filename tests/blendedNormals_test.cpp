// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/blendedNormals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/testHelpers.h"

namespace {

using namespace osd_shading;
using namespace osd_shading::tests;

Vec3<double> const kX{1, 0, 0}, kY{0, 1, 0};

TEST(BlendedNormals, AWeightOfThreeSeventhsBlendsFourToThree) {
    // (4/7, 3/7, 0) has the direction (4, 3, 0) / 5.
    EXPECT_LE(Distance(BlendNormals(kX, kY, 3.0 / 7, 1), {0.8, 0.6, 0}), 1e-15);
}

TEST(BlendedNormals, TheExponentIsThatOfTheWeight) {
    // The square of the root of 3/7; the root of the square.
    EXPECT_LE(Distance(BlendNormals(kX, kY, std::sqrt(3.0 / 7), 2), {0.8, 0.6, 0}), 1e-15);
    EXPECT_LE(Distance(BlendNormals(kX, kY, 9.0 / 49, 0.5), {0.8, 0.6, 0}), 1e-15);
}

TEST(BlendedNormals, AtWeightZeroIsTheLimitNormalBitForBit) {
    Vec3<double> const odd{0.1, 0.7, 0.3};  // not of unit length: it would change if it were normalised
    for (double const exponent : {0.25, 1.0, 3.0}) {
        Vec3<double> const blended = BlendNormals(odd, kY, 0.0, exponent);
        EXPECT_EQ(Distance(blended, odd), 0);
    }
}

TEST(BlendedNormals, AtWeightOneIsTheSubdividedNormal) {
    for (double const exponent : {0.25, 1.0, 3.0}) EXPECT_EQ(Distance(BlendNormals(kX, kY, 1.0, exponent), kY), 0);
}

TEST(BlendedNormals, HaveUnitLengthAndLieBetweenTheTwo) {
    shapes::Random random(6);
    auto const direction = [&] {
        return Normalized(Vec3<double>{random.Uniform(-1, 1), random.Uniform(-1, 1), random.Uniform(-1, 1)});
    };
    for (int i = 0; i < 1000; ++i) {
        Vec3<double> const a = direction(), b = direction();
        double const weight = random.Uniform(0, 1), exponent = random.Uniform(0.1, 4);
        Vec3<double> const blended = BlendNormals(a, b, weight, exponent);
        EXPECT_NEAR(Length(blended), 1, 1e-15);
        // The two angles add up: the blend lies on the arc.
        EXPECT_NEAR(AngleBetween(a, blended) + AngleBetween(blended, b), AngleBetween(a, b), 1e-13);
    }
}

TEST(BlendedNormals, OpposedNormalsThatCancelGiveTheLimitNormal) {
    EXPECT_EQ(Distance(BlendNormals(kX, {-1, 0, 0}, 0.5, 1), kX), 0);
    EXPECT_EQ(Distance(BlendNormals(kX, {-1, 1e-14, 0}, 0.5, 1), kX), 0);  // under the precision of what was added
    EXPECT_EQ(Distance(BlendNormals(kX, {-1, 0, 0}, 0.75, 1), {-1, 0, 0}), 0);
    Vec3<float> const x{1, 0, 0};
    EXPECT_EQ(Distance(BlendNormals(x, {-1, 1e-7F, 0}, 0.5F, 1), x), 0);
}

TEST(BlendedNormals, AZeroVectorLeavesTheOther) {
    EXPECT_EQ(Distance(BlendNormals(kX, {}, 0.5, 1), kX), 0);
    EXPECT_EQ(Distance(BlendNormals(kX, {}, 1.0, 1), kX), 0);
    EXPECT_EQ(Distance(BlendNormals({}, kY, 0.5, 1), kY), 0);
    EXPECT_TRUE(IsZero(BlendNormals(Vec3<double>{}, Vec3<double>{}, 0.5, 1)));
    EXPECT_TRUE(IsZero(BlendNormals(Vec3<double>{}, kY, 0.0, 1)));
}

TEST(BlendedNormals, TheSmallestWeightsAndLargestExponentsAreNeverNotANumber) {
    for (double const weight : {1e-300, 1e-20, 1 - 1e-16}) {
        for (double const exponent : {1e-6, 1.0, 1e6}) {
            Vec3<double> const blended = BlendNormals(kX, kY, weight, exponent);
            EXPECT_TRUE(IsFinite(blended));
            EXPECT_NEAR(Length(blended), 1, 1e-15);
        }
    }
}

}  // namespace
