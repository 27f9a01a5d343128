// SPDX-License-Identifier: Apache-2.0
#include "tools/deformation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace {

using namespace osd_shading;
using namespace osd_shading::tool;

constexpr DeformationKind kAll[] = {DeformationKind::Bend, DeformationKind::Twist, DeformationKind::Wave};

/// A bar along y from 1 to 5, one wide along x and half of that along z.
std::vector<Vec3<float>> Bar() {
    std::vector<Vec3<float>> points;
    for (int i = 0; i <= 8; ++i) {
        float const y = 1 + 0.5F * static_cast<float>(i);
        for (float const x : {-0.5F, 0.5F}) {
            for (float const z : {2.75F, 3.25F}) points.push_back({x, y, z});
        }
    }
    return points;
}

void ExpectAt(Vec3<float> const& found, double x, double y, double z) {
    EXPECT_NEAR(double{found.x}, x, 1e-6);
    EXPECT_NEAR(double{found.y}, y, 1e-6);
    EXPECT_NEAR(double{found.z}, z, 1e-6);
}

TEST(Deformation, BendsABarByHand) {
    DeformationFrame const frame = FrameOf(Bar());
    EXPECT_EQ(frame.longAxis, 1);
    EXPECT_EQ(frame.sideAxis, 2);
    EXPECT_EQ(frame.length, 4);
    ExpectAt(Deformed(DeformationKind::Bend, frame, {0, 3, 3}, 0.25), 0, 3, 3);
    // A quarter of a circle of length 4 has the radius 8 / pi; its end stands at 45 degrees.
    double const radius = 8 / 3.14159265358979;
    ExpectAt(Deformed(DeformationKind::Bend, frame, {0, 5, 3}, 0.25), 0, 3 + radius * std::sqrt(0.5),
             3 + radius * (1 - std::sqrt(0.5)));
    // Half of half a turn.
    ExpectAt(Deformed(DeformationKind::Twist, frame, {0.5F, 5, 3}, 0.25), 0, 5, 2.5);
    // A quarter of a wave later the crest, a twentieth of 4 high, is in the middle, its slope upside down.
    ExpectAt(Deformed(DeformationKind::Wave, frame, {0, 3, 3}, 0.25), 0, 3, 2.8);
}

TEST(Deformation, HasAPeriodOfOneAndBendAndTwistRestAtHalfOfIt) {
    std::vector<Vec3<float>> const bar = Bar();
    DeformationFrame const frame = FrameOf(bar);
    for (Vec3<float> const& p : bar) {
        for (DeformationKind const kind : kAll) {
            Vec3<float> const first = Deformed(kind, frame, p, 0.3), later = Deformed(kind, frame, p, 1.3);
            ExpectAt(later, first.x, first.y, first.z);
            if (kind == DeformationKind::Wave) continue;
            ExpectAt(Deformed(kind, frame, p, 0), p.x, p.y, p.z);
            ExpectAt(Deformed(kind, frame, p, 0.5), p.x, p.y, p.z);
        }
    }
}

TEST(Deformation, OfNothingOrOfOnePointIsFinite) {
    EXPECT_EQ(FrameOf({}).length, 1);
    std::vector<Vec3<float>> const point = {{1, 2, 3}};
    for (DeformationKind const kind : kAll) {
        Vec3<float> const p = Deformed(kind, FrameOf(point), point[0], 0.2);
        EXPECT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
    }
}

}  // namespace
