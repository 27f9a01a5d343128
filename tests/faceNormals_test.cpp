// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/faceNormals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/testHelpers.h"

namespace {

using namespace osd_shading;
using namespace osd_shading::tests;

constexpr double kRounding = 1e-15;

template <typename Real>
std::vector<Vec3<Real>> Averages(Shape const& shape, FaceWeight weight, int level = 0) {
    Rooms<Real> const rooms(shape, level);
    return AverageFaceNormals(rooms.Last(), rooms.LastRegions(), rooms.points.back(), weight, 1);
}

Vec3<double> NormalOfFace(Shape const& shape, int face = 0) {
    RefinedTopology const topology(shape.Mesh(), 0);
    return UnitFaceNormal(topology.Level(0), PointsOf<double>(shape), face);
}

Shape Scaled(Shape shape, double x, double y, double z) {
    for (std::size_t i = 0; i < shape.positions.size(); ++i)
        shape.positions[i] *= i % 3 == 0 ? x : i % 3 == 1 ? y : z;
    return shape;
}

TEST(FaceNormals, OfANonPlanarQuadIsTheProductOfItsDiagonals) {
    // (2, 1, 1/2) x (-2, 1, 0) = (-1/2, -1, 4), of squared length 17.25
    double const length = std::sqrt(17.25);
    EXPECT_LE(Distance(NormalOfFace(shapes::LoneQuad()), {-0.5 / length, -1 / length, 4 / length}), kRounding);
}

TEST(FaceNormals, AnglesWeighTheFacesRoundAVertex) {
    // At vertex 0 a triangle of normal z and 45 degrees meets one of normal y and 90 degrees: as 1 : 2.
    Shape shape;
    shape.Vertex(0, 0, 0).Vertex(1, 0, 0).Vertex(1, 1, 0).Vertex(0, 0, 1);
    shape.Face({0, 1, 2}).Face({0, 3, 1});
    double const length = std::sqrt(5.0);
    EXPECT_LE(Distance(Averages<double>(shape, FaceWeight::Angle)[0], {0, 2 / length, 1 / length}), kRounding);
}

TEST(FaceNormals, AreasWeighTheCornersOfABox) {
    // Sides 2, 4, 6 at vertex 6: areas 24, 12, 8 across x, y, z, as 6 : 3 : 2, whose length is 7.
    Shape const box = Scaled(shapes::Cube(), 1, 2, 3);
    double const third = 1 / std::sqrt(3.0);
    EXPECT_LE(Distance(Averages<double>(box, FaceWeight::CornerArea)[6], {6.0 / 7, 3.0 / 7, 2.0 / 7}), kRounding);
    EXPECT_LE(Distance(Averages<double>(box, FaceWeight::Uniform)[6], {third, third, third}), kRounding);
    EXPECT_LE(Distance(Averages<double>(box, FaceWeight::Angle)[6], {third, third, third}), kRounding);
}

TEST(FaceNormals, EachSideOfACreaseHasItsOwn) {
    Shape const cube = shapes::CubeWithSharpTop();
    Rooms<double> const rooms(cube, 0);
    std::vector<Vec3<double>> const normals = Averages<double>(cube, FaceWeight::Uniform);
    double const half = std::sqrt(0.5);
    for (int corner = 0; corner < 4; ++corner) {
        EXPECT_LE(Distance(normals[Index(rooms.LastRegions().CornerValue(0, corner))], {0, 0, 1}), kRounding);
    }
    // Face 2 looks to -y and face 3 to +x; they meet in vertices 1 and 5.
    EXPECT_LE(Distance(normals[Index(rooms.LastRegions().CornerValue(2, 2))], {half, -half, 0}), kRounding);
}

TEST(FaceNormals, DoNotDependOnTheFirstVertex) {
    for (std::size_t first = 0; first < 6; ++first) {
        // An L: its first three vertices may turn either way.
        double const outline[6][2] = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 3}, {0, 3}};
        Shape shape;
        std::vector<int> face;
        for (std::size_t i = 0; i < 6; ++i) {
            shape.Vertex(outline[(i + first) % 6][0], outline[(i + first) % 6][1], 5);
            face.push_back(static_cast<int>(i));
        }
        EXPECT_LE(Distance(NormalOfFace(shape.Face(face)), {0, 0, 1}), kRounding);
    }
}

TEST(FaceNormals, DoNotDependOnSize) {
    for (FaceWeight const weight : {FaceWeight::Uniform, FaceWeight::CornerArea, FaceWeight::Angle}) {
        Shape const shape = shapes::MixedPolygons().CreasePath({1, 8, 9});
        std::vector<Vec3<double>> const expected = Averages<double>(shape, weight);
        for (double const size : {1e-150, 1e150}) {
            std::vector<Vec3<double>> const normals = Averages<double>(Scaled(shape, size, size, size), weight);
            for (std::size_t i = 0; i < normals.size(); ++i) EXPECT_LE(Distance(normals[i], expected[i]), 1e-14);
        }
        for (double const size : {1e-20, 1e18}) {
            std::vector<Vec3<float>> const normals = Averages<float>(Scaled(shape, size, size, size), weight);
            for (std::size_t i = 0; i < normals.size(); ++i) {
                Vec3<double> const n{normals[i].x, normals[i].y, normals[i].z};
                EXPECT_LE(Distance(n, expected[i]), 2e-6) << static_cast<int>(weight) << " " << size;
            }
        }
    }
}

TEST(FaceNormals, HaveUnitLengthOnEveryShape) {
    for (Shape const& shape : AllShapes()) {
        for (FaceWeight const weight : {FaceWeight::Uniform, FaceWeight::CornerArea, FaceWeight::Angle}) {
            for (Vec3<double> const& n : Averages<double>(shape, weight, 1)) {
                EXPECT_NEAR(Length(n), 1, 2 * kRounding) << shape.name;
            }
        }
    }
}

TEST(FaceNormals, OfFacesWithoutAreaAreZero) {
    Shape point, sliver, bowtie;
    for (int i = 0; i < 4; ++i) point.Vertex(0.1, 0.7, 0.3);
    EXPECT_TRUE(IsZero(NormalOfFace(point.Face({0, 1, 2, 3}))));
    // On a line, but for rounding, which is no normal.
    for (double const t : {0.0, 0.1, 0.7, 0.3}) sliver.Vertex(0.1 + t / 3, 0.7 - t / 7, 0.3 + t / 9);
    EXPECT_TRUE(IsZero(NormalOfFace(sliver.Face({0, 1, 2, 3}))));
    bowtie.Vertex(0, 0, 0).Vertex(1, 1, 0).Vertex(1, 0, 0).Vertex(0, 1, 0);
    EXPECT_TRUE(IsZero(NormalOfFace(bowtie.Face({0, 1, 2, 3}))));
}

TEST(FaceNormals, FacesWithoutAreaAddNothing) {
    // The triangle on top of a cube's corner has shrunk to a point.
    Shape shape = shapes::Cube();
    std::vector<std::vector<int>> faces = shape.Faces();
    faces[0] = {4, 5, 8, 9, 7};
    faces[3] = {1, 2, 6, 8, 5};
    faces[4] = {2, 3, 7, 9, 6};
    faces.push_back({6, 9, 8});
    shape.SetFaces(faces);
    shape.Vertex(1, 1, 1).Vertex(1, 1, 1);
    double const half = std::sqrt(0.5);
    std::vector<Vec3<double>> const normals = Averages<double>(shape, FaceWeight::Uniform);
    EXPECT_LE(Distance(normals[6], {half, half, 0}), kRounding);
    EXPECT_LE(Distance(normals[8], {half, 0, half}), kRounding);
    EXPECT_LE(Distance(normals[9], {0, half, half}), kRounding);
}

TEST(FaceNormals, OpposedFacesCancelToZero) {
    Shape pillow = shapes::LoneTriangle();
    pillow.Face({0, 2, 1});
    for (FaceWeight const weight : {FaceWeight::Uniform, FaceWeight::CornerArea, FaceWeight::Angle}) {
        for (Vec3<double> const& n : Averages<double>(pillow, weight)) EXPECT_TRUE(IsZero(n));
    }
}

}  // namespace
