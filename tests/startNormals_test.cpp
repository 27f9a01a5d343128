// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/startNormals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "osd_shading/extraordinaryVertices.h"
#include "tests/testHelpers.h"

namespace {

using namespace osd_shading;
using namespace osd_shading::tests;

constexpr double kRounding = 1e-15;
StartNormalKind const kComputedKinds[] = {StartNormalKind::Uniform, StartNormalKind::CornerArea,
                                          StartNormalKind::Angle, StartNormalKind::Limit,
                                          StartNormalKind::LimitSmoothed};

StartNormals<double> Start(Rooms<double> const& rooms, StartNormalKind kind) {
    return ComputeStartNormals(kind, rooms.topology, rooms.topology.LastLevel(), rooms.LastRegions(),
                               rooms.points.back(), 1);
}

TEST(StartNormals, OfEveryKindPointOutwardsAtTheCornersOfACube) {
    double const third = 1 / std::sqrt(3.0);
    for (StartNormalKind const kind : kComputedKinds) {
        for (int level = 0; level <= 2; ++level) {
            StartNormals<double> const start = Start(Rooms<double>(shapes::Cube(), level), kind);
            EXPECT_LE(Distance(start.normals[6], {third, third, third}), 4 * kRounding);
            EXPECT_EQ(start.numZero, 0);
        }
    }
}

TEST(StartNormals, WeighFacesAsTheirKindSays) {
    // A box of sides 2, 4, 6: uniform 1 : 1 : 1; by area 24 : 12 : 8 = 6 : 3 : 2; by angle 1 : 1 : 1.
    Shape box = shapes::Cube();
    for (std::size_t i = 0; i < box.positions.size(); ++i) box.positions[i] *= static_cast<double>(i % 3) + 1;
    Rooms<double> const rooms(box, 0);
    double const third = 1 / std::sqrt(3.0);
    EXPECT_LE(Distance(Start(rooms, StartNormalKind::Uniform).normals[6], {third, third, third}), kRounding);
    EXPECT_LE(Distance(Start(rooms, StartNormalKind::Angle).normals[6], {third, third, third}), kRounding);
    EXPECT_LE(Distance(Start(rooms, StartNormalKind::CornerArea).normals[6], {6.0 / 7, 3.0 / 7, 2.0 / 7}),
              kRounding);
    EXPECT_EQ(FaceWeightOf(StartNormalKind::CornerArea), FaceWeight::CornerArea);
    EXPECT_EQ(FaceWeightOf(StartNormalKind::Angle), FaceWeight::Angle);
    for (StartNormalKind const kind : {StartNormalKind::Uniform, StartNormalKind::Limit,
                                       StartNormalKind::LimitSmoothed, StartNormalKind::User}) {
        EXPECT_EQ(FaceWeightOf(kind), FaceWeight::Uniform);
    }
}

TEST(StartNormals, UserNormalsAreSummedOverTheCornersOfARegion) {
    // Four sides meet in the apex of a pyramid and one of them looks elsewhere: (0, 0, 3) + (4, 0, 0) is (4, 0, 3).
    Shape const shape = shapes::Pyramid(4);
    Rooms<double> const rooms(shape, 0);
    std::vector<Vec3<double>> corners(shape.faceVertices.size(), Vec3<double>{0, 0, 1});
    corners[0] = {4, 0, 0};
    StartNormals<double> const start =
        GatherUserNormals<double>(rooms.topology, rooms.levels.Regions(0), {}, PointView<double>(corners));
    EXPECT_LE(Distance(start.normals[0], {0.8, 0, 0.6}), kRounding);
    EXPECT_LE(Distance(start.normals[3], {0, 0, 1}), kRounding);
}

TEST(StartNormals, UserNormalsOfASideStayOnIt) {
    Shape const shape = shapes::CubeWithSharpTop();
    Rooms<double> const rooms(shape, 0);
    CreaseRegions const& regions = rooms.levels.Regions(0);
    std::vector<Vec3<double>> corners(24, Vec3<double>{0, 2, 0});
    for (std::size_t i = 0; i < 4; ++i) corners[i] = {0, 0, 5};  // face 0: the top
    std::vector<Vec3<double>> const normals =
        GatherUserNormals<double>(rooms.topology, regions, {}, PointView<double>(corners)).normals;
    for (int i = 0; i < 4; ++i) {
        EXPECT_EQ(Distance(normals[Index(regions.CornerValue(0, i))], {0, 0, 1}), 0);
        EXPECT_EQ(Distance(normals[Index(regions.CornerValue(2, i))], {0, 1, 0}), 0);
    }
}

TEST(StartNormals, UserNormalsPerVertexAreThatNormalInEveryRegion) {
    Shape const shape = shapes::CubeWithSharpTop();
    Rooms<double> const rooms(shape, 0);
    CreaseRegions const& regions = rooms.levels.Regions(0);
    std::vector<Vec3<double>> const vertices = PointsOf<double>(shapes::Cube().Jitter(0.3));
    StartNormals<double> const start =
        GatherUserNormals<double>(rooms.topology, regions, PointView<double>(vertices), {});
    for (int v = 0; v < 8; ++v) {
        for (int i = regions.FirstValue(v); i < regions.FirstValue(v + 1); ++i) {
            EXPECT_LE(Distance(start.normals[Index(i)], Normalized(vertices[Index(v)])), 2 * kRounding);
        }
    }
}

TEST(StartNormals, HaveUnitLengthOrAreCounted) {
    for (Shape const& shape : AllShapes()) {
        Rooms<double> const rooms(shape, 1);
        for (StartNormalKind const kind : kComputedKinds) {
            StartNormals<double> const start = Start(rooms, kind);
            EXPECT_EQ(start.normals.size(), Index(rooms.LastRegions().NumValues()));
            std::int64_t numZero = 0;
            for (Vec3<double> const& n : start.normals) {
                numZero += IsZero(n);
                if (!IsZero(n)) {
                    EXPECT_NEAR(Length(n), 1, 2 * kRounding) << shape.name;
                }
            }
            EXPECT_EQ(start.numZero, numZero) << shape.name;
        }
    }
}

TEST(StartNormals, LimitsAreTheLimitNormalsOfTheStartLevel) {
    Rooms<double> const rooms(shapes::CubeWithSharpTop(2.5F).Crease(0, 4), 1);
    EXPECT_TRUE(HasSameBits(Start(rooms, StartNormalKind::Limit).normals,
                            ComputeLimitNormals(rooms.limit, rooms.points.back(), 1).normals));
}

TEST(StartNormals, SmoothingTakesOpenSubdivsLimitOfTheNormalsRoundExtraordinaryVertices) {
    // Meshes without creases, for which OpenSubdiv's own limit of the normals is the rule.
    for (Shape const& shape : {shapes::MixedPolygons(), shapes::Cross(), shapes::Icosahedron().Loop(),
                               shapes::Bipyramid(7).Loop(), shapes::Torus(5, 4)}) {
        Rooms<double> const rooms(shape, 2);
        std::vector<Vec3<double>> const normals = Start(rooms, StartNormalKind::Limit).normals;
        std::vector<Vec3<double>> const smoothed = Start(rooms, StartNormalKind::LimitSmoothed).normals;
        std::vector<OsdPoint> source, limits(normals.size());
        for (Vec3<double> const& n : normals) source.push_back({n});
        Far::PrimvarRefinerReal<double>(rooms.topology.Refiner()).Limit(source, limits);

        int const regular = shape.rules.scheme == Sdc::SCHEME_LOOP ? 6 : 4;
        std::vector<char> isInRing(normals.size(), 0);
        for (int v = 0; v < rooms.Last().GetNumVertices(); ++v) {
            if (rooms.Last().GetVertexEdges(v).size() == regular) continue;
            for (int const f : rooms.Last().GetVertexFaces(v)) {
                for (int const u : rooms.Last().GetFaceVertices(f)) isInRing[Index(u)] = 1;
            }
        }
        for (std::size_t v = 0; v < normals.size(); ++v) {
            Vec3<double> const expected = isInRing[v] ? Normalized(limits[v].at) : normals[v];
            EXPECT_LE(Distance(smoothed[v], expected), 4 * kRounding) << shape.name << " vertex " << v;
        }
    }
}

TEST(StartNormals, SmoothingLeavesSharpVerticesAsTheyAre) {
    for (Shape const& shape : AllShapes()) {
        Rooms<double> const rooms(shape, 2);
        std::vector<Vec3<double>> const normals = Start(rooms, StartNormalKind::Limit).normals;
        std::vector<Vec3<double>> const smoothed = Start(rooms, StartNormalKind::LimitSmoothed).normals;
        CreaseRegions const& regions = rooms.LastRegions();
        for (int v = 0; v < regions.NumVertices(); ++v) {
            if (!regions.IsSharp(v)) continue;
            for (int i = regions.FirstValue(v); i < regions.FirstValue(v + 1); ++i) {
                EXPECT_EQ(Distance(smoothed[Index(i)], normals[Index(i)]), 0) << shape.name;
            }
        }
    }
}

TEST(StartNormals, OfAFlatDoubleSheetVanishAndAreCounted) {
    Shape pillow = shapes::LoneTriangle();
    pillow.Face({0, 2, 1});
    for (StartNormalKind const kind : kComputedKinds) {
        StartNormals<double> const start = Start(Rooms<double>(Shape(pillow).Loop(), 0), kind);
        for (Vec3<double> const& n : start.normals) EXPECT_TRUE(IsZero(n)) << static_cast<int>(kind);
        EXPECT_EQ(start.numZero, 3);
    }
    for (StartNormalKind const kind :
         {StartNormalKind::Uniform, StartNormalKind::CornerArea, StartNormalKind::Angle}) {
        StartNormals<double> const start = Start(Rooms<double>(pillow, 1), kind);
        EXPECT_EQ(start.numZero, 6);  // vertices and edge points; the two face points have a side each
    }
}

TEST(StartNormals, UserNormalsThatCancelAreZeroAndCounted) {
    Shape const shape = shapes::Tube(4, 2);
    Rooms<double> const rooms(shape, 0);
    std::vector<Vec3<double>> corners(shape.faceVertices.size(), Vec3<double>{1, 0, 0});
    // Vertex 5 is in the middle: two of its four corners look the other way.
    int numTurned = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        if (shape.faceVertices[i] == 5 && numTurned++ < 2) corners[i] = {-1, 0, 0};
    }
    StartNormals<double> const start =
        GatherUserNormals<double>(rooms.topology, rooms.levels.Regions(0), {}, PointView<double>(corners));
    EXPECT_TRUE(IsZero(start.normals[5]));
    EXPECT_EQ(start.numZero, 1);
}

TEST(StartNormals, AnIsolatedVertexsNormalIsNotUsed) {
    Shape const shape = shapes::IsolatedVertex();
    Rooms<double> const rooms(shape, 0);
    std::vector<Vec3<double>> const vertices(9, Vec3<double>{0, 0, 1});
    StartNormals<double> const start =
        GatherUserNormals<double>(rooms.topology, rooms.levels.Regions(0), PointView<double>(vertices), {});
    EXPECT_EQ(start.normals.size(), 8U);
    EXPECT_EQ(start.numZero, 0);
}

}  // namespace
