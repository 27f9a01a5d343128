// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/subdividedNormals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "osd_shading/startNormals.h"
#include "tests/testHelpers.h"

namespace {

using namespace osd_shading;
using namespace osd_shading::tests;

SubdividedNormalOptions With(NormalAveraging averaging, int sphericalSteps = 3) {
    SubdividedNormalOptions options;
    options.averaging = averaging;
    options.sphericalSteps = sphericalSteps;
    return options;
}

std::vector<Vec3<double>> Subdivide(Rooms<double> const& rooms, std::vector<Vec3<double>> const& start,
                                    SubdividedNormalOptions const& options = {}, ValueMarks const& marks = {},
                                    int numThreads = 1) {
    return ComputeSubdividedNormals(options, rooms.levels, 0, rooms.limit, start, marks, numThreads);
}

/// A normal per value of level 0, from a function of its vertex's point.
template <typename Function>
std::vector<Vec3<double>> FieldOf(Rooms<double> const& rooms, Function const& function) {
    CreaseRegions const& regions = rooms.levels.Regions(0);
    std::vector<Vec3<double>> field(Index(regions.NumValues()));
    for (int v = 0; v < regions.NumVertices(); ++v) {
        for (int i = regions.FirstValue(v); i < regions.FirstValue(v + 1); ++i) {
            field[Index(i)] = function(rooms.points[0][Index(v)]);
        }
    }
    return field;
}

std::vector<Vec3<double>> RandomDirections(std::size_t count, std::uint64_t seed) {
    shapes::Random random(seed);
    std::vector<Vec3<double>> directions(count);
    for (auto& n : directions) {
        n = Normalized(Vec3<double>{random.Uniform(-1, 1), random.Uniform(-1, 1), random.Uniform(-1, 1)});
    }
    return directions;
}

TEST(SubdividedNormals, OfACubeAreItsPointsAndShortenAsItDoes) {
    // Start normals (+-1, +-1, +-1) / sqrt 3 are the vertices themselves, whose limits are half as far away; the
    // middle of a face is at 4/9 + 4/9 3/4 + 1/9 5/9 = 68/81.
    Rooms<double> const rooms(shapes::Cube(), 1);
    double const third = 1 / std::sqrt(3.0);
    std::vector<Vec3<double>> const start = FieldOf(rooms, [&](Vec3<double> const& p) { return third * p; });
    std::vector<Vec3<double>> const normals = Subdivide(rooms, start);
    EXPECT_LE(Distance(normals[6], {third / 2, third / 2, third / 2}), 1e-15);
    EXPECT_NEAR(Length(normals[6]), 0.5, 1e-15);
    int const top = rooms.topology.FirstFaceChild(0);
    EXPECT_LE(Distance(normals[Index(top)], {0, 0, third * 68 / 81}), 1e-15);
}

TEST(SubdividedNormals, RenormalisedOnesAreUnitVectorsBeforeTheLimit) {
    // At level 1: 5/9, 3/4 and 1 from the middle become 1; the corner's limit is 3/8 + 1/2 c + 1/8 d with
    // c = (1, 1, 1) . (1, 1, 0) / sqrt 6 at edge points and d = 1 / sqrt 3 at face points.
    Rooms<double> const rooms(shapes::Cube(), 1);
    double const third = 1 / std::sqrt(3.0), c = 2 / std::sqrt(6.0), d = third;
    std::vector<Vec3<double>> const start = FieldOf(rooms, [&](Vec3<double> const& p) { return third * p; });
    std::vector<Vec3<double>> const normals = Subdivide(rooms, start, With(NormalAveraging::Renormalised));
    EXPECT_NEAR(Length(normals[6]), 3.0 / 8 + c / 2 + d / 8, 1e-15);
}

TEST(SubdividedNormals, AreOpenSubdivsLimitOfTheStartNormalsWithoutCreases) {
    for (Shape const& shape : {shapes::MixedPolygons(), shapes::Cross(), shapes::Icosahedron().Loop()}) {
        Rooms<double> const rooms(shape, 3);
        std::vector<Vec3<double>> const start = RandomDirections(rooms.points[0].size(), 4);
        std::vector<OsdPoint> source;
        for (Vec3<double> const& n : start) source.push_back({n});
        source = RefineByOsd(rooms.topology.Refiner(), source, 0, 3);
        std::vector<OsdPoint> limits(source.size());
        Far::PrimvarRefinerReal<double>(rooms.topology.Refiner()).Limit(source, limits);
        std::vector<Vec3<double>> const normals = Subdivide(rooms, start);
        for (std::size_t i = 0; i < normals.size(); ++i) EXPECT_LE(Distance(normals[i], limits[i].at), 1e-14);
    }
}

TEST(SubdividedNormals, EqualNormalsStayEqualInEveryMode) {
    Vec3<double> const up{0.48, -0.6, 0.64};
    for (Shape const& shape : AllShapes()) {
        Rooms<double> const rooms(shape, 2);
        std::vector<Vec3<double>> const start = FieldOf(rooms, [&](Vec3<double> const&) { return up; });
        for (NormalAveraging const averaging :
             {NormalAveraging::Linear, NormalAveraging::Renormalised, NormalAveraging::Spherical}) {
            for (Vec3<double> const& n : Subdivide(rooms, start, With(averaging))) {
                ASSERT_LE(Distance(n, up), 1e-14) << shape.name;
            }
        }
    }
}

TEST(SubdividedNormals, OnAGreatCircleSphericalMeansAverageAngles) {
    // The mean of angles is what the scalar field's own masks give: the logarithms lie on one line.
    for (Shape const& shape :
         {shapes::GridWithDart(1.5F), shapes::CubeWithSharpTop(), shapes::Bipyramid(7).Loop()}) {
        Rooms<double> const rooms(shape, 2);
        auto const angleAt = [](Vec3<double> const& p) { return 0.3 * p.x - 0.2 * p.y + 0.25 * p.z; };
        std::vector<Vec3<double>> const start = FieldOf(rooms, [&](Vec3<double> const& p) {
            return Vec3<double>{std::cos(angleAt(p)), 0, std::sin(angleAt(p))};
        });
        std::vector<Vec3<double>> const angles = FieldOf(rooms, [&](Vec3<double> const& p) {
            return Vec3<double>{angleAt(p), 0, 0};
        });
        std::vector<Vec3<double>> const means = Subdivide(rooms, start, With(NormalAveraging::Spherical, 1));
        std::vector<Vec3<double>> const expected = Subdivide(rooms, angles);
        for (std::size_t i = 0; i < means.size(); ++i) {
            double const angle = expected[i].x;
            EXPECT_LE(Distance(means[i], {std::cos(angle), 0, std::sin(angle)}), 1e-14) << shape.name;
        }
    }
}

TEST(SubdividedNormals, SphericalStepsConvergeFromTheLinearMean) {
    Rooms<double> const rooms(shapes::Icosahedron(), 2);
    std::vector<Vec3<double>> const start = FieldOf(rooms, [](Vec3<double> const& p) { return Normalized(p); });
    auto const with = [&](int steps) { return Subdivide(rooms, start, With(NormalAveraging::Spherical, steps)); };
    std::vector<Vec3<double>> const none = with(0), three = with(3), many = with(100), more = with(99);
    double first = 0, third = 0, last = 0;
    for (std::size_t i = 0; i < many.size(); ++i) {
        EXPECT_NEAR(Length(none[i]), 1, 1e-15);
        first = std::fmax(first, Distance(none[i], many[i]));
        third = std::fmax(third, Distance(three[i], many[i]));
        last = std::fmax(last, Distance(more[i], many[i]));
    }
    EXPECT_LT(third, 0.1 * first + 1e-14);
    EXPECT_LE(last, 1e-14);
}

TEST(SubdividedNormals, SidesOfASharpCreaseStayApart) {
    // Up on top and outwards round it; what is above the crease stays up.
    Shape const shape = shapes::CubeWithSharpTop();
    Rooms<double> const rooms(shape, 3);
    CreaseRegions const &base = rooms.levels.Regions(0), &last = rooms.LastRegions();
    std::vector<Vec3<double>> start(Index(base.NumValues()), Vec3<double>{1, 0, 0});
    for (int i = 0; i < 4; ++i) start[Index(base.CornerValue(0, i))] = {0, 0, 1};
    std::vector<Vec3<double>> const normals = Subdivide(rooms, start);
    for (int f = 0; f < rooms.Last().GetNumFaces(); ++f) {
        bool const isTop = f < 64;  // the children of face 0
        for (int i = 0; i < 4; ++i) {
            Vec3<double> const n = normals[Index(last.CornerValue(f, i))];
            EXPECT_LE(Distance(n, isTop ? Vec3<double>{0, 0, 1} : Vec3<double>{1, 0, 0}), 1e-14);
        }
    }
}

TEST(SubdividedNormals, MarkedValuesAreThoseOfTheWholeAndOthersZero) {
    for (Shape const& shape : AllShapes()) {
        Rooms<double> const rooms(shape, 2);
        std::vector<Vec3<double>> const start = RandomDirections(Index(rooms.levels.Regions(0).NumValues()), 8);
        shapes::Random random(3);
        ValueMarks marks(Index(rooms.LastRegions().NumValues()));
        for (auto& mark : marks) mark = random.Chance(0.1);
        for (NormalAveraging const averaging :
             {NormalAveraging::Linear, NormalAveraging::Renormalised, NormalAveraging::Spherical}) {
            std::vector<Vec3<double>> const all = Subdivide(rooms, start, With(averaging));
            std::vector<Vec3<double>> const some = Subdivide(rooms, start, With(averaging), marks);
            for (std::size_t i = 0; i < all.size(); ++i) {
                ASSERT_EQ(Distance(some[i], marks[i] ? all[i] : Vec3<double>{}), 0) << shape.name << " value " << i;
            }
        }
    }
}

TEST(SubdividedNormals, ZeroNormalsDoNotCountOnTheSphere) {
    Rooms<double> const rooms(shapes::QuadGrid(4, 4), 0);
    std::vector<Vec3<double>> start(25, Vec3<double>{0, 0, 1});
    start[12] = start[7] = {};
    std::vector<Vec3<double>> const normals = Subdivide(rooms, start, With(NormalAveraging::Spherical));
    for (Vec3<double> const& n : {normals[12], normals[13], normals[6]}) EXPECT_LE(Distance(n, {0, 0, 1}), 1e-15);
}

TEST(SubdividedNormals, OnTheSphereTheRestSharesTheWeightOfZeroNormals) {
    // Angles .1 at the neighbours 7 and 11, .4 at 13, 0 at the others; the vertex 12 itself, of weight 4/9, is
    // zero. With 1/9 per neighbour the rest, of weight 5/9, has the mean (.1 + .1 + .4) / 9 over 5/9.
    Rooms<double> const rooms(shapes::QuadGrid(4, 4), 0);
    std::vector<double> angles(25, 0.0);
    angles[7] = angles[11] = 0.1;
    angles[13] = 0.4;
    std::vector<Vec3<double>> start;
    for (double const angle : angles) start.push_back({std::cos(angle), std::sin(angle), 0});
    start[12] = {};
    double const angle = (2.0 / 9 * 0.1 + 1.0 / 9 * 0.4) / (5.0 / 9);
    Vec3<double> const mean = Subdivide(rooms, start, With(NormalAveraging::Spherical, 1))[12];
    EXPECT_LE(Distance(mean, {std::cos(angle), std::sin(angle), 0}), 1e-15);
}

TEST(SubdividedNormals, SumsThatVanishButForRoundingAreNotRenormalised) {
    // A sharp edge's middle between opposed normals.
    Rooms<double> const rooms(shapes::QuadGrid(2, 2).CreaseAll(), 1);
    CreaseRegions const& base = rooms.levels.Regions(0);
    std::vector<Vec3<double>> start(Index(base.NumValues()), Vec3<double>{1, 0, 0});
    for (int i = base.FirstValue(4); i < base.FirstValue(5); ++i) start[Index(i)] = {-1, 1e-14, 0};
    int const middle = rooms.topology.Level(0).GetEdgeChildVertex(rooms.topology.Level(0).FindEdge(3, 4));
    std::vector<Vec3<double>> const normals = Subdivide(rooms, start, With(NormalAveraging::Renormalised));
    EXPECT_LE(Length(normals[Index(rooms.LastRegions().FirstValue(middle))]), 1e-13);
}

TEST(SubdividedNormals, WhereAllAreZeroSoIsTheResult) {
    Rooms<double> const rooms(shapes::CubeWithSharpTop(1.5F), 2);
    std::vector<Vec3<double>> const start(Index(rooms.levels.Regions(0).NumValues()));
    for (NormalAveraging const averaging :
         {NormalAveraging::Linear, NormalAveraging::Renormalised, NormalAveraging::Spherical}) {
        for (Vec3<double> const& n : Subdivide(rooms, start, With(averaging))) EXPECT_TRUE(IsZero(n));
    }
}

TEST(SubdividedNormals, DoNotDependOnTheThreads) {
    Rooms<double> const rooms(shapes::TorusWithCreaseRing(), 5);
    std::vector<Vec3<double>> const start = RandomDirections(Index(rooms.levels.Regions(0).NumValues()), 12);
    for (NormalAveraging const averaging :
         {NormalAveraging::Linear, NormalAveraging::Renormalised, NormalAveraging::Spherical}) {
        EXPECT_TRUE(HasSameBits(Subdivide(rooms, start, With(averaging), {}, 1),
                                Subdivide(rooms, start, With(averaging), {}, 4)));
    }
}

}  // namespace
