// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/io/creaseEdits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "ioFiles.h"
#include "osd_shading/errors.h"
#include "osd_shading/io/objReader.h"

using namespace osd_shading;
using namespace osd_shading::io;
using ioFiles::ErrorOf;

namespace {

Model cube() {
    return ParseObj(
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
        "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n",
        "cube.obj");
}

// Two triangles that meet in edge 0-1; the second is turned out of the plane of the first by `degrees`.
Model hinge(double degrees, char const* secondFace = "f 2 1 4\n") {
    double const angle = degrees * std::acos(-1.0) / 180;
    Model model = ParseObj(std::string("v 0 0 0\nv 0 1 0\nv -1 0 0\nv 1 0 0\nf 1 2 3\n") + secondFace, "m.obj");
    model.positions[9] = std::cos(angle);
    model.positions[11] = std::sin(angle);
    return model;
}

std::size_t numCreases(Model model, double degrees) {
    AddCreasesByAngle(model, degrees);
    for (float const sharpness : model.creaseSharpness) EXPECT_EQ(sharpness, kInfiniteSharpness);
    EXPECT_EQ(model.creaseVertices.size(), 2 * model.creaseSharpness.size());
    return model.creaseSharpness.size();
}

}  // namespace

TEST(CreaseEdits, TheEdgesOfACubeTurnByNinetyDegrees) {
    EXPECT_EQ(numCreases(cube(), 89.9), 12u);
    EXPECT_EQ(numCreases(cube(), 0), 12u);
    EXPECT_EQ(numCreases(cube(), 90), 0u);
    EXPECT_EQ(numCreases(cube(), 180), 0u);
}

TEST(CreaseEdits, ARightAngleIsNoMoreThanNinetyDegreesHoweverTheCubeLies) {
    Model model = cube();
    double const c = std::cos(0.7), s = std::sin(0.7);
    for (std::size_t i = 0; i < 24; i += 3) {
        double* const p = &model.positions[i];
        double const x = c * p[0] - s * p[1], y = s * p[0] + c * p[1];
        p[0] = 1e6 + x;
        p[1] = c * y - s * p[2];
        p[2] = s * y + c * p[2];
    }
    EXPECT_EQ(numCreases(model, 90), 0u);
    EXPECT_EQ(numCreases(model, 89.999), 12u);
}

TEST(CreaseEdits, OnlyEdgesThatTurnByMoreBecomeSharp) {
    for (double const angle : {0.0, 10.0, 30.0, 120.0, 179.0}) {
        EXPECT_EQ(numCreases(hinge(angle), angle + 0.01), 0u) << angle;
        if (angle > 0) {
            EXPECT_EQ(numCreases(hinge(angle), angle - 0.01), 1u) << angle;
        }
        EXPECT_EQ(numCreases(hinge(-angle), angle + 0.01), 0u) << angle;
    }
}

TEST(CreaseEdits, FacesWoundInOppositeDirectionsAreComparedAsIfTheyWereNot) {
    EXPECT_EQ(numCreases(hinge(20, "f 1 2 4\n"), 21), 0u);
    EXPECT_EQ(numCreases(hinge(20, "f 1 2 4\n"), 19), 1u);
}

TEST(CreaseEdits, EntriesThatAreThereStay) {
    Model model = hinge(90);
    model.creaseVertices = {0, 1};
    model.creaseSharpness = {2.5f};
    AddCreasesByAngle(model, 45);
    EXPECT_EQ(model.creaseVertices, (std::vector<int>{0, 1, 0, 1}));
    EXPECT_EQ(model.creaseSharpness, (std::vector<float>{2.5f, 10}));
}

TEST(CreaseEdits, TheSizeOfTheModelDoesNotMatter) {
    for (double const scale : {1e-200, 1e-30, 1e30, 1e300}) {
        Model model = hinge(30);
        for (double& x : model.positions) x *= scale;
        EXPECT_EQ(numCreases(model, 29), 1u) << scale;
        EXPECT_EQ(numCreases(model, 31), 0u) << scale;
    }
}

TEST(CreaseEdits, BoundariesNonManifoldEdgesAndFacesWithoutAreaAreLeftAlone) {
    EXPECT_EQ(numCreases(ParseObj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "m.obj"), 0), 0u);
    EXPECT_EQ(numCreases(hinge(90, "v 0 0 -9\nf 2 1 4\nf 1 2 5\n"), 0), 0u);
    EXPECT_EQ(numCreases(ParseObj("v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nf 1 2 3\nf 2 1 4\n", "m.obj"), 0), 0u);
}

TEST(CreaseEdits, ScalingMultipliesFiniteSharpnessOfEdgesOnly) {
    Model model = cube();
    model.creaseVertices = {0, 1, 1, 2, 2, 3, 3, 0};
    model.creaseSharpness = {0, 1.5f, 6, 10};
    model.cornerVertices = {0};
    model.cornerSharpness = {3};
    ScaleCreases(model, 2);
    EXPECT_EQ(model.creaseSharpness, (std::vector<float>{0, 3, 10, 10}));
    EXPECT_EQ(model.cornerSharpness, (std::vector<float>{3}));

    model.creaseSharpness = {4, 10, std::numeric_limits<float>::infinity()};
    ScaleCreases(model, 0);
    EXPECT_EQ(model.creaseSharpness, (std::vector<float>{0, 10, std::numeric_limits<float>::infinity()}));
    model.creaseSharpness = {4};
    ScaleCreases(model, 1e308);
    EXPECT_EQ(model.creaseSharpness, (std::vector<float>{10}));
}

TEST(CreaseEdits, NumbersOutOfRangeAreRefused) {
    Model model = cube();
    EXPECT_EQ(ErrorOf<InvalidOptions>([&] { AddCreasesByAngle(model, -1); }),
              "the crease angle is -1.000000: give 0 to 180 degrees");
    EXPECT_EQ(ErrorOf<InvalidOptions>([&] { ScaleCreases(model, -2); }),
              "the crease scale is -2.000000: give a finite number, 0 or more");
    double const infinity = std::numeric_limits<double>::infinity();
    for (double const number : {infinity, std::nan("")}) {
        EXPECT_THROW(AddCreasesByAngle(model, number), InvalidOptions);
        EXPECT_THROW(ScaleCreases(model, number), InvalidOptions);
    }
    EXPECT_TRUE(model.creaseSharpness.empty());
}
