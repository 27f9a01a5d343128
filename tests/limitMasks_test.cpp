// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/limitMasks.h"

#include <gtest/gtest.h>

#include <map>
#include <utility>
#include <vector>

#include "tests/testHelpers.h"

namespace {

using namespace osd_shading;
using namespace osd_shading::tests;

using Row = std::map<int, double>;

Row RowOf(Rooms<double> const& rooms, int vertex, int region = 0) {
    std::vector<std::pair<int, double>> terms;
    rooms.limit.AppendTerms(vertex, rooms.LastRegions().FirstValue(vertex) + region, terms);
    Row row;
    for (auto const& [source, weight] : terms) row[source] += weight;
    return row;
}

int ValueAt(Rooms<double> const& rooms, int face, int vertex) {
    return rooms.LastRegions().CornerValue(face, rooms.Last().GetFaceVertices(face).FindIndex(vertex));
}

void ExpectRow(Row const& row, Row const& expected) {
    EXPECT_EQ(row.size(), expected.size());
    for (auto const& [value, weight] : expected) {
        ASSERT_TRUE(row.count(value)) << value;
        EXPECT_NEAR(row.at(value), weight, 1e-15) << value;  // a few roundings
    }
}

// In the grid vertex (i, j) is 5 j + i and face (i, j) is 4 j + i.

TEST(LimitMasks, AreThoseOfBSplinesAtRegularVertices) {
    ExpectRow(RowOf(Rooms<double>(shapes::QuadGrid(4, 4), 0), 12), {{12, 4.0 / 9},
                                                                    {7, 1.0 / 9},
                                                                    {11, 1.0 / 9},
                                                                    {13, 1.0 / 9},
                                                                    {17, 1.0 / 9},
                                                                    {6, 1.0 / 36},
                                                                    {8, 1.0 / 36},
                                                                    {16, 1.0 / 36},
                                                                    {18, 1.0 / 36}});
    ExpectRow(
        RowOf(Rooms<double>(shapes::QuadGrid(4, 4).Loop(), 0), 12),
        {{12, 0.5}, {7, 1.0 / 12}, {11, 1.0 / 12}, {13, 1.0 / 12}, {17, 1.0 / 12}, {6, 1.0 / 12}, {18, 1.0 / 12}});
    ExpectRow(RowOf(Rooms<double>(shapes::QuadGrid(4, 4), 0), 2), {{1, 1.0 / 6}, {2, 2.0 / 3}, {3, 1.0 / 6}});
    ExpectRow(RowOf(Rooms<double>(shapes::QuadGrid(4, 4), 0), 0), {{0, 1}});
}

TEST(LimitMasks, OfAnExtraordinaryVertexAreThoseOfItsValence) {
    // n / (n + 5) at the vertex, 4 / (n (n + 5)) and 1 / (n (n + 5)) round it.
    ExpectRow(
        RowOf(Rooms<double>(shapes::Cube(), 0), 6),
        {{6, 3.0 / 8}, {2, 1.0 / 6}, {5, 1.0 / 6}, {7, 1.0 / 6}, {1, 1.0 / 24}, {3, 1.0 / 24}, {4, 1.0 / 24}});
}

TEST(LimitMasks, ACreasesSidesFollowTheCurveWithTheirOwnValues) {
    Rooms<double> const rooms(shapes::GridWithDart(), 0);
    ASSERT_EQ(rooms.LastRegions().NumVertexValues(11), 2);
    for (int region = 0; region < 2; ++region) {
        Row const row = RowOf(rooms, 11, region);
        int const face = row.count(ValueAt(rooms, 4, 11)) ? 4 : 8;
        ExpectRow(row, {{ValueAt(rooms, face, 11), 2.0 / 3},
                        {ValueAt(rooms, face, 10), 1.0 / 6},
                        {ValueAt(rooms, face + 1, 12), 1.0 / 6}});
    }
}

TEST(LimitMasks, ADartTakesItsNeighbourAcrossTheSharpEdgeFromBothSides) {
    Rooms<double> const rooms(shapes::GridWithDart(), 0);
    Row const row = RowOf(rooms, 12);
    EXPECT_NEAR(row.at(ValueAt(rooms, 5, 11)), 1.0 / 18, 1e-15);
    EXPECT_NEAR(row.at(ValueAt(rooms, 9, 11)), 1.0 / 18, 1e-15);
    EXPECT_NEAR(row.at(ValueAt(rooms, 5, 7)), 1.0 / 9, 1e-15);
}

TEST(LimitMasks, PositionsAreOpenSubdivsLimits) {
    for (Shape const& shape : AllShapes()) {
        for (int level = HasOnlyRegularFaces(shape) ? 0 : 1; level <= 3; ++level) {
            Rooms<double> const rooms(shape, level);
            std::vector<Vec3<double>> limits;
            rooms.limit.ApplyToPoints(rooms.points.back(), limits, 1);
            std::vector<OsdPoint> source, expected(limits.size());
            for (Vec3<double> const& p : rooms.points.back()) source.push_back({p});
            Far::PrimvarRefinerReal<double>(rooms.topology.Refiner()).Limit(source, expected);
            for (std::size_t v = 0; v < limits.size(); ++v) {
                // Points are of size 1 to 4: some 10 roundings.
                ASSERT_LE(Distance(limits[v], expected[v].at), 1e-14)
                    << shape.name << " level " << level << " vertex " << v;
            }
        }
    }
}

TEST(LimitMasks, AFieldThatIgnoresRegionsHasTheLimitsOfPoints) {
    for (Shape const& shape : AllShapes()) {
        Rooms<double> const rooms(shape, 2);
        CreaseRegions const& regions = rooms.LastRegions();
        std::vector<Vec3<double>> positions, field(Index(regions.NumValues())), limits(field.size());
        rooms.limit.ApplyToPoints(rooms.points.back(), positions, 1);
        for (int v = 0; v < regions.NumVertices(); ++v) {
            for (int i = regions.FirstValue(v); i < regions.FirstValue(v + 1); ++i) {
                field[Index(i)] = rooms.points.back()[Index(v)];
            }
        }
        rooms.limit.Apply(field, limits, {}, 1);
        for (int v = 0; v < regions.NumVertices(); ++v) {
            for (int i = regions.FirstValue(v); i < regions.FirstValue(v + 1); ++i) {
                ASSERT_LE(Distance(limits[Index(i)], positions[Index(v)]), 1e-14) << shape.name << " vertex " << v;
            }
        }
    }
}

TEST(LimitMasks, WeightsOfEachRowAddToOneAndAreWhatIsApplied) {
    shapes::Random random(9);
    for (Shape const& shape : AllShapes()) {
        Rooms<double> const rooms(shape, 2);
        CreaseRegions const& regions = rooms.LastRegions();
        std::vector<double> field(Index(regions.NumValues())), limits(field.size());
        for (double& x : field) x = random.Uniform(-1, 1);
        rooms.limit.Apply(field, limits, {}, 1);
        for (int v = 0; v < regions.NumVertices(); ++v) {
            for (int region = 0; region < regions.NumVertexValues(v); ++region) {
                double sum = 0, applied = 0;
                for (auto const& [value, weight] : RowOf(rooms, v, region)) {
                    sum += weight;
                    applied += weight * field[Index(value)];
                }
                ASSERT_NEAR(sum, 1, 1e-14) << shape.name << " vertex " << v;
                ASSERT_NEAR(applied, limits[Index(regions.FirstValue(v) + region)], 1e-14) << shape.name;
            }
        }
    }
}

TEST(LimitMasks, MarkedValuesNeedNothingBeyondTheirMarkedSources) {
    shapes::Random random(19);
    for (Shape const& shape : AllShapes()) {
        Rooms<double> const rooms(shape, 2);
        std::vector<double> field(Index(rooms.LastRegions().NumValues())), all(field.size());
        for (double& x : field) x = random.Uniform(-1, 1);
        rooms.limit.Apply(field, all, {}, 1);
        ValueMarks marks(all.size()), sources;
        for (auto& mark : marks) mark = random.Chance(0.05);
        rooms.limit.MarkSources(marks, sources);
        std::vector<double> limits(all.size(), 1e30);
        for (std::size_t i = 0; i < field.size(); ++i) field[i] = sources[i] ? field[i] : 1e30;
        rooms.limit.Apply(field, limits, marks, 1);
        for (std::size_t i = 0; i < all.size(); ++i) {
            ASSERT_EQ(limits[i], marks[i] ? all[i] : 1e30) << shape.name << " value " << i;
        }
    }
}

TEST(LimitMasks, TangentWeightsAddToZero) {
    // Tangents of a mesh do not move with it.
    for (Shape const& shape : {shapes::Bipyramid(7), shapes::QuadFan(5), shapes::Bipyramid(7).Loop()}) {
        Rooms<double> const rooms(shape, 1);
        for (int v = 0; v < rooms.LastRegions().NumVertices(); ++v) {
            if (rooms.LastRegions().Kind(v) == VertexKind::Corner) continue;
            int const numFaces = rooms.Last().GetVertexFaces(v).size();
            LimitMask<double> const& mask = rooms.LastRegions().IsSharp(v) ? rooms.limit.Masks().Fan(numFaces)
                                                                           : rooms.limit.Masks().Ring(numFaces);
            double sum1 = mask.vertex.tangent1, sum2 = mask.vertex.tangent2;
            for (auto const* weights : {&mask.edges, &mask.faces}) {
                for (auto const& w : *weights) {
                    sum1 += w.tangent1;
                    sum2 += w.tangent2;
                }
            }
            EXPECT_NEAR(sum1, 0, 1e-13) << shape.name;  // weights of up to some 10
            EXPECT_NEAR(sum2, 0, 1e-13) << shape.name;
        }
    }
}

TEST(LimitMasks, AnIsolatedVertexStaysWhereItIs) {
    Rooms<double> const rooms(shapes::IsolatedVertex(), 1);
    std::vector<Vec3<double>> limits;
    rooms.limit.ApplyToPoints(rooms.points.back(), limits, 1);
    EXPECT_EQ(Distance(limits[8], {3, 3, 3}), 0);
}

TEST(LimitMasks, WhatIsStillSharpCountsAsInfinitelySharp) {
    // At level 1 sharpness 1.25 has .25 left, which the limit takes in full.
    Rooms<double> const semi(shapes::CubeWithSharpTop(1.25F), 1), sharp(shapes::CubeWithSharpTop(), 1);
    ExpectRow(RowOf(semi, 4, 1), RowOf(sharp, 4, 1));
    Rooms<double> const released(shapes::CubeWithSharpTop(1.25F), 2);
    EXPECT_EQ(RowOf(released, 4).size(), 7U);
}

TEST(LimitMasks, DoNotDependOnTheThreads) {
    Shape const shape = shapes::TorusWithCreaseRing();
    RefinedTopology const topology(shape.Mesh(), 5);
    CreaseRegions const regions(topology, 5, 1);
    LimitStep<float> const one(topology, 5, regions, 1), four(topology, 5, regions, 4);
    shapes::Random random(2);
    std::vector<Vec3<float>> points(Index(regions.NumVertices())), a, b;
    for (auto& p : points)
        p = {static_cast<float>(random.Uniform(0, 1)), static_cast<float>(random.Uniform(0, 1)), 0};
    one.ApplyToPoints(points, a, 1);
    four.ApplyToPoints(points, b, 4);
    EXPECT_TRUE(HasSameBits(a, b));
    std::vector<float> field(Index(regions.NumValues())), c(field.size()), d(field.size());
    for (float& x : field) x = static_cast<float>(random.Uniform(0, 1));
    one.Apply(field, c, {}, 1);
    four.Apply(field, d, {}, 4);
    EXPECT_TRUE(HasSameBits(c, d));
}

}  // namespace
