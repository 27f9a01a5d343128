// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/limitFrames.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/testHelpers.h"

namespace {

using namespace osd_shading;
using namespace osd_shading::tests;

constexpr double kPi = 3.14159265358979323846;
constexpr double kRounding = 1e-14;  // some 10 roundings of unit vectors

template <typename Real>
LimitNormals<Real> NormalsOf(Rooms<Real> const& rooms, int numThreads = 1) {
    return ComputeLimitNormals(rooms.limit, rooms.points.back(), numThreads);
}
template <typename Real>
LimitNormals<Real> NormalsOf(Shape const& shape, int level) {
    return NormalsOf(Rooms<Real>(shape, level));
}

Shape Scaled(Shape shape, double size) {
    for (double& x : shape.positions) x *= size;
    return shape;
}

/// Two planes that meet at right angles above the grid's middle column, vertices 2, 7, 12, 17 and 22.
Shape Roof() {
    Shape roof = shapes::QuadGrid(4, 4);
    for (std::size_t i = 0; i < roof.positions.size(); i += 3) {
        roof.positions[i + 2] = -std::fabs(roof.positions[i] - 2);
    }
    return roof.CreasePath({2, 7, 12, 17, 22});
}

TEST(LimitFrames, PointOutwardsAtTheCornersOfACube) {
    double const third = 1 / std::sqrt(3.0);
    for (int level = 0; level <= 2; ++level) {
        std::vector<Vec3<double>> const normals = NormalsOf<double>(shapes::Cube(), level).normals;
        EXPECT_LE(Distance(normals[6], {third, third, third}), kRounding);
        EXPECT_LE(Distance(normals[0], {-third, -third, -third}), kRounding);
        EXPECT_LE(Distance(normals[5], {third, -third, third}), kRounding);
    }
}

TEST(LimitFrames, ACubeOfSharpEdgesKeepsItsSixFaceNormals) {
    Vec3<double> const expected[] = {{0, 0, 1}, {0, 0, -1}, {0, -1, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}};
    for (int level = 0; level <= 2; ++level) {
        Rooms<double> const rooms(shapes::Cube().CreaseAll(), level);
        LimitNormals<double> const found = NormalsOf(rooms);
        EXPECT_EQ(rooms.LastRegions().NumVertexValues(6), 3);
        for (int f = 0; f < rooms.Last().GetNumFaces(); ++f) {
            for (int i = 0; i < 4; ++i) {  // the children of a face follow each other
                int const value = rooms.LastRegions().CornerValue(f, i);
                EXPECT_LE(Distance(found.normals[Index(value)], expected[f >> (2 * level)]), kRounding);
            }
        }
        EXPECT_EQ(found.numFallbacks, 0);
    }
}

TEST(LimitFrames, TheSidesOfARoofKeepTheirPlanes) {
    double const half = std::sqrt(0.5);
    for (Shape const& roof : {Roof(), Roof().Loop()}) {
        Rooms<double> const rooms(roof, 2);
        std::vector<Vec3<double>> const normals = NormalsOf(rooms).normals;
        for (int f = 0; f < rooms.Last().GetNumFaces(); ++f) {
            Far::ConstIndexArray const vertices = rooms.Last().GetFaceVertices(f);
            double middle = 0;
            for (int const v : vertices) middle += rooms.points.back()[Index(v)].x / vertices.size();
            for (int i = 0; i < vertices.size(); ++i) {
                Vec3<double> const n = normals[Index(rooms.LastRegions().CornerValue(f, i))];
                EXPECT_LE(Distance(n, {middle < 2 ? -half : half, 0, half}), kRounding) << roof.name;
            }
        }
    }
}

TEST(LimitFrames, CornersOfSeveralFacesTakeTheMeanOfTheirNormals) {
    // Of a box of sides 2, 4, 6 too: faces count alike.
    Shape box = shapes::Cube().Corner(6);
    for (std::size_t i = 0; i < box.positions.size(); ++i) box.positions[i] *= static_cast<double>(i % 3) + 1;
    double const third = 1 / std::sqrt(3.0);
    LimitNormals<double> const found = NormalsOf<double>(box, 0);
    EXPECT_LE(Distance(found.normals[6], {third, third, third}), kRounding);
    EXPECT_EQ(found.numFallbacks, 0);  // no limit normal exists: that is no fallback
}

TEST(LimitFrames, APlaneStaysAPlane) {
    Shape flat = shapes::QuadGrid(5, 4).Jitter(0.2, 4).CreasePath({6, 7, 13, 14, 15}).Crease(8, 9, 1.5F).Hole(2);
    flat.Corner(20, 2.5F);
    for (std::size_t i = 2; i < flat.positions.size(); i += 3) flat.positions[i] = 7;
    for (Shape const& shape : {flat, Shape(flat).Loop(), Shape(flat).Chaikin()}) {
        for (int level = 0; level <= 2; ++level) {
            for (Vec3<double> const& n : NormalsOf<double>(shape, level).normals) {
                EXPECT_LE(Distance(n, {0, 0, 1}), kRounding);
            }
        }
    }
}

TEST(LimitFrames, AReflexCornerInAPlaneDoesNotTurnInwards) {
    // Three quads of an L round its inner corner 4: by the boundary's curve, and as a sharp corner.
    Shape shape = shapes::QuadGrid(2, 2);
    shape.SetFaces({{0, 1, 4, 3}, {1, 2, 5, 4}, {3, 4, 7, 6}});
    shape.positions.erase(shape.positions.end() - 3, shape.positions.end());  // vertex 8 is in no face
    for (Shape const& reflex : {shape, Shape(shape).Corner(4), Shape(shape).Corner(4).Loop()}) {
        for (int level = 0; level <= 2; ++level) {
            EXPECT_LE(Distance(NormalsOf<double>(reflex, level).normals[4], {0, 0, 1}), kRounding);
        }
    }
}

TEST(LimitFrames, AgreeWithOpenSubdivsTangentsOnTheSideThatItGives) {
    for (Shape const& shape : AllShapes()) {
        Rooms<double> const rooms(shape, 2);
        CreaseRegions const& regions = rooms.LastRegions();
        LimitNormals<double> const found = NormalsOf(rooms);
        std::vector<OsdPoint> points, limits(Index(regions.NumVertices())), tangents1 = limits, tangents2 = limits;
        for (Vec3<double> const& p : rooms.points.back()) points.push_back({p});
        Far::PrimvarRefinerReal<double>(rooms.topology.Refiner()).Limit(points, limits, tangents1, tangents2);
        for (int v = 0; v < regions.NumVertices(); ++v) {
            Vec3<double> const normal = Normalized(Cross(tangents1[Index(v)].at, tangents2[Index(v)].at));
            // OpenSubdiv takes no side at a corner, and does not order the faces of a non-manifold vertex.
            if (regions.Kind(v) == VertexKind::Corner || rooms.Last().IsVertexNonManifold(v)) continue;
            double closest = 2;
            for (int i = regions.FirstValue(v); i < regions.FirstValue(v + 1); ++i) {
                closest = std::fmin(closest, Distance(found.normals[Index(i)], normal));
            }
            // Tangents may be a hundredth of the points that make them.
            EXPECT_LE(closest, 1e-12) << shape.name << " vertex " << v;
        }
    }
}

TEST(LimitFrames, AreUnitVectorsOrCountedAsMissing) {
    for (Shape const& shape : AllShapes()) {
        for (int level = HasOnlyRegularFaces(shape) ? 0 : 1; level <= 2; ++level) {
            LimitNormals<double> const found = NormalsOf<double>(shape, level);
            std::vector<int> zeros;
            for (std::size_t i = 0; i < found.normals.size(); ++i) {
                if (IsZero(found.normals[i])) {
                    zeros.push_back(static_cast<int>(i));
                } else {
                    EXPECT_NEAR(Length(found.normals[i]), 1, 1e-15) << shape.name;
                }
            }
            EXPECT_EQ(found.missing, zeros) << shape.name;
        }
    }
}

TEST(LimitFrames, DoNotDependOnSize) {
    for (Shape const& shape :
         {shapes::MixedPolygons().CreasePath({1, 8, 9}), shapes::CubeWithSharpTop(2.5F).Corner(0),
          shapes::GridWithDart().Loop(), shapes::TwoBoxesSharingAnEdge()}) {
        std::vector<Vec3<double>> const expected = NormalsOf<double>(shape, 1).normals;
        for (double const size : {1e-150, 1e150}) {
            std::vector<Vec3<double>> const normals = NormalsOf<double>(Scaled(shape, size), 1).normals;
            for (std::size_t i = 0; i < normals.size(); ++i) {
                EXPECT_LE(Distance(normals[i], expected[i]), 1e-13) << shape.name << " " << size;
            }
        }
        for (double const size : {1e-20, 1e18}) {
            std::vector<Vec3<float>> const normals = NormalsOf<float>(Scaled(shape, size), 1).normals;
            for (std::size_t i = 0; i < normals.size(); ++i) {
                Vec3<double> const n{normals[i].x, normals[i].y, normals[i].z};
                // Tangents lose a digit or two to cancelling.
                EXPECT_LE(Distance(n, expected[i]), 1e-5) << shape.name << " " << size;
            }
        }
    }
}

TEST(LimitFrames, ANonManifoldEdgesSheetsEachHaveTheirOwn) {
    Rooms<double> const rooms(shapes::FinnedGrid(), 2);
    std::vector<Vec3<double>> const normals = NormalsOf(rooms).normals;
    for (int f = 0; f < rooms.Last().GetNumFaces(); ++f) {
        bool const isFin = f >= 8 * 16;  // its faces come last, and all children of a face together
        for (int i = 0; i < 4; ++i) {
            Vec3<double> const n = normals[Index(rooms.LastRegions().CornerValue(f, i))];
            EXPECT_LE(Distance(n, isFin ? Vec3<double>{0, -1, 0} : Vec3<double>{0, 0, 1}), kRounding);
        }
    }
}

TEST(LimitFrames, ABowtieVertexHasTheNormalsOfTwoSharpCorners) {
    Rooms<double> const rooms(shapes::TwoBoxesSharingAVertex(), 1);
    std::vector<Vec3<double>> const normals = NormalsOf(rooms).normals;
    std::vector<Vec3<double>> const alone = NormalsOf<double>(shapes::Cube().Corner(6).Corner(0), 1).normals;
    int const first = rooms.LastRegions().FirstValue(6);
    double const same = Distance(normals[Index(first)], alone[6]),
                 turned = Distance(normals[Index(first)], alone[0]);
    EXPECT_LE(std::fmin(same, turned), kRounding);
    EXPECT_LE(Distance(normals[Index(first + 1)], same < turned ? alone[0] : alone[6]), kRounding);
}

TEST(LimitFrames, AValenceTwoVertexHasAUnitNormal) {
    for (int level = 0; level <= 3; ++level) {
        EXPECT_NEAR(Length(NormalsOf<double>(shapes::ValenceTwo(), level).normals[8]), 1, 1e-15);
    }
}

TEST(LimitFrames, DegenerateTangentsFallBackToTheMeanOfTheFacesAndAreCounted) {
    // A fan that winds twice round its centre: each face looks up, but the sums with cos(i 60) and sin(i 60) over
    // points at i 120 degrees vanish.
    Shape fan = shapes::TriangleFan(6);
    fan.positions[2] = 0;
    for (std::size_t i = 1; i <= 6; ++i) {
        fan.positions[3 * i] = std::cos(2 * kPi * static_cast<double>(i) / 3);
        fan.positions[3 * i + 1] = std::sin(2 * kPi * static_cast<double>(i) / 3);
    }
    LimitNormals<double> const found = NormalsOf<double>(fan.Loop(), 0);
    EXPECT_LE(Distance(found.normals[0], {0, 0, 1}), kRounding);
    EXPECT_GE(found.numFallbacks, 1);
    EXPECT_TRUE(found.missing.empty());
    // The same by weights that sum to rounding: far from the origin.
    for (std::size_t i = 0; i < fan.positions.size(); ++i) fan.positions[i] += i % 3 == 2 ? 0 : 3;
    EXPECT_LE(Distance(NormalsOf<double>(fan, 0).normals[0], {0, 0, 1}), kRounding);
}

TEST(LimitFrames, OfPointsThatAllCoincideAreMissing) {
    for (Shape shape : AllShapes()) {
        for (std::size_t i = 0; i < shape.positions.size(); ++i) shape.positions[i] = i % 3 == 0 ? 0.1 : -0.7;
        LimitNormals<double> const found = NormalsOf<double>(shape, 1);
        EXPECT_EQ(found.missing.size(), found.normals.size()) << shape.name;
        EXPECT_EQ(found.numFallbacks, static_cast<std::int64_t>(found.normals.size())) << shape.name;
        for (Vec3<double> const& n : found.normals) EXPECT_TRUE(IsZero(n)) << shape.name;
    }
}

template <typename Real>
void ExpectUnitOrZero(Shape const& shape, double tolerance) {
    for (Vec3<Real> const& n : NormalsOf<Real>(shape, 2).normals) {
        ASSERT_TRUE(IsFinite(n)) << shape.name;
        double const length = static_cast<double>(Length(n));
        ASSERT_TRUE(length == 0 || std::fabs(length - 1) < tolerance) << shape.name << " " << length;
    }
}

TEST(LimitFrames, OfFlattenedAndCollapsedMeshesAreUnitOrZero) {
    for (Shape const& shape : AllShapes()) {
        for (double const flat : {0.0, 1e-15, 1e-8, 1e-300}) {
            Shape sliver = shape, needle = shape;
            for (std::size_t i = 0; i < shape.positions.size(); ++i) {
                if (i % 3 == 2) sliver.positions[i] *= flat;
                if (i % 3 != 0) needle.positions[i] *= flat;
            }
            Shape pinched = shape;  // vertex 1 falls on vertex 0
            std::copy_n(pinched.positions.begin(), 3, pinched.positions.begin() + 3);
            for (Shape const& degenerate : {sliver, needle, pinched}) {
                ExpectUnitOrZero<double>(degenerate, 1e-14);
                ExpectUnitOrZero<float>(degenerate, 1e-6);
            }
        }
    }
}

TEST(LimitFrames, FaceAveragesAreTheStartNormalsOfTheLastLevel) {
    Rooms<double> const rooms(shapes::CubeWithSharpTop(), 1);
    for (FaceWeight const weight : {FaceWeight::Uniform, FaceWeight::CornerArea, FaceWeight::Angle}) {
        LimitNormals<double> const found = ComputeFaceAverageNormals(rooms.limit, rooms.points.back(), weight, 1);
        EXPECT_TRUE(HasSameBits(
            found.normals, AverageFaceNormals(rooms.Last(), rooms.LastRegions(), rooms.points.back(), weight, 1)));
        EXPECT_TRUE(found.missing.empty());
        EXPECT_EQ(found.numFallbacks, 0);
    }
}

TEST(LimitFrames, DoNotDependOnTheThreads) {
    Rooms<float> const rooms(shapes::TorusWithCreaseRing(), 5);
    LimitNormals<float> const one = NormalsOf(rooms, 1), four = NormalsOf(rooms, 4);
    EXPECT_TRUE(HasSameBits(one.normals, four.normals));
    EXPECT_EQ(one.missing, four.missing);
    EXPECT_EQ(one.numFallbacks, four.numFallbacks);
}

}  // namespace
