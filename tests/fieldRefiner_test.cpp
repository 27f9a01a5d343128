// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/fieldRefiner.h"

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "tests/testHelpers.h"

namespace {

using namespace osd_shading;
using namespace osd_shading::tests;

using Row = std::map<int, double>;

/// What a value of level 1 is made of.
Row RowOf(Rooms<double> const& rooms, int vertex, int region = 0) {
    std::vector<std::pair<int, double>> terms;
    int const value = rooms.levels.Regions(1).FirstValue(vertex) + region;
    rooms.levels.Step(1).AppendTerms(vertex, value, terms);
    Row row;
    for (auto const& [source, weight] : terms) row[source] += weight;
    return row;
}

/// The value of a vertex of level 0 on the side of a face.
int ValueAt(Rooms<double> const& rooms, int face, int vertex) {
    return rooms.levels.Regions(0).CornerValue(face,
                                               rooms.topology.Level(0).GetFaceVertices(face).FindIndex(vertex));
}

void ExpectRow(Row const& row, Row const& expected) {
    EXPECT_EQ(row.size(), expected.size());
    for (auto const& [value, weight] : expected) {
        ASSERT_TRUE(row.count(value)) << value;
        EXPECT_NEAR(row.at(value), weight, 1e-15) << value;  // a few roundings
    }
}

// In the grid vertex (i, j) is 5 j + i and face (i, j) is 4 j + i.

TEST(FieldRefiner, ADartTakesItsNeighbourAcrossTheSharpEdgeFromBothSides) {
    // The smooth mask 9/16, 3/32, 1/64; the sharp edge leads to 11, whose sides are faces 5 below and 9 above.
    Rooms<double> const rooms(shapes::GridWithDart(), 1);
    auto const at = [&](int face, int vertex) { return ValueAt(rooms, face, vertex); };
    ExpectRow(RowOf(rooms, 12), {{at(5, 12), 9.0 / 16},
                                 {at(5, 7), 3.0 / 32},
                                 {at(6, 13), 3.0 / 32},
                                 {at(9, 17), 3.0 / 32},
                                 {at(5, 11), 3.0 / 64},
                                 {at(9, 11), 3.0 / 64},
                                 {at(5, 6), 1.0 / 64},
                                 {at(6, 8), 1.0 / 64},
                                 {at(9, 16), 1.0 / 64},
                                 {at(10, 18), 1.0 / 64}});
}

TEST(FieldRefiner, EachSideOfACreaseFollowsTheCreaseRuleWithItsOwnValues) {
    Rooms<double> const rooms(shapes::GridWithDart(), 1);
    CreaseRegions const& child = rooms.levels.Regions(1);
    ASSERT_EQ(child.NumVertexValues(11), 2);
    for (int region = 0; region < 2; ++region) {
        Row const row = RowOf(rooms, 11, region);
        // Below lie faces 4 and 5, above 8 and 9.
        int const face = row.count(ValueAt(rooms, 4, 11)) ? 4 : 8;
        ExpectRow(row, {{ValueAt(rooms, face, 11), 3.0 / 4},
                        {ValueAt(rooms, face, 10), 1.0 / 8},
                        {ValueAt(rooms, face + 1, 12), 1.0 / 8}});
    }
}

TEST(FieldRefiner, ReleasedSidesMergeByTheirNumbersOfFaces) {
    // The crease turns at 12: face 9 alone on one side, faces 5, 6 and 10 on the other. Its mask is still the
    // crease's; at 11 and 17 two of the four faces lie on each side.
    Rooms<double> const rooms(shapes::QuadGrid(4, 4).CreasePath({10, 11, 12, 17, 22}, 1), 1);
    auto const at = [&](int face, int vertex) { return ValueAt(rooms, face, vertex); };
    ASSERT_EQ(rooms.levels.Regions(0).NumVertexValues(12), 2);
    ASSERT_EQ(rooms.levels.Regions(1).NumVertexValues(12), 1);
    ExpectRow(RowOf(rooms, 12), {{at(9, 12), 3.0 / 16},
                                 {at(6, 12), 9.0 / 16},
                                 {at(9, 11), 1.0 / 16},
                                 {at(5, 11), 1.0 / 16},
                                 {at(9, 17), 1.0 / 16},
                                 {at(10, 17), 1.0 / 16}});
}

TEST(FieldRefiner, TheMiddleOfALoneSharpEdgeHasTwoEqualSides) {
    Rooms<double> const rooms(shapes::GridWithDartToDart(), 1);
    int const middle = rooms.topology.Level(0).GetEdgeChildVertex(rooms.topology.Level(0).FindEdge(12, 13));
    ASSERT_EQ(rooms.levels.Regions(1).NumVertexValues(middle), 2);
    for (int region = 0; region < 2; ++region) {
        ExpectRow(RowOf(rooms, middle, region), {{ValueAt(rooms, 6, 12), 0.5}, {ValueAt(rooms, 6, 13), 0.5}});
    }
}

TEST(FieldRefiner, AFieldThatIgnoresRegionsRefinesAsPointsDo) {
    for (Shape const& shape : AllShapes()) {
        Rooms<double> const rooms(shape, 3);
        for (int level = 1; level <= 3; ++level) {
            CreaseRegions const &parent = rooms.levels.Regions(level - 1), &child = rooms.levels.Regions(level);
            std::vector<Vec3<double>> field(Index(parent.NumValues())), refined(Index(child.NumValues()));
            for (int v = 0; v < parent.NumVertices(); ++v) {
                for (int i = parent.FirstValue(v); i < parent.FirstValue(v + 1); ++i) {
                    field[Index(i)] = rooms.points[Index(level) - 1][Index(v)];
                }
            }
            rooms.levels.Step(level).Apply(field, refined, {}, 1);
            for (int v = 0; v < child.NumVertices(); ++v) {
                for (int i = child.FirstValue(v); i < child.FirstValue(v + 1); ++i) {
                    // Points are of size 1 to 4: some 10 roundings.
                    ASSERT_LE(Distance(refined[Index(i)], rooms.points[Index(level)][Index(v)]), 1e-14)
                        << shape.name << " level " << level << " vertex " << v;
                }
            }
        }
    }
}

TEST(FieldRefiner, WeightsOfEachRowAddToOneAndAreWhatIsApplied) {
    shapes::Random random(5);
    for (Shape const& shape : AllShapes()) {
        Rooms<double> const rooms(shape, 2);
        CreaseRegions const &parent = rooms.levels.Regions(1), &child = rooms.levels.Regions(2);
        std::vector<double> field(Index(parent.NumValues())), refined(Index(child.NumValues()));
        for (double& x : field) x = random.Uniform(-1, 1);
        rooms.levels.Step(2).Apply(field, refined, {}, 1);
        std::vector<std::pair<int, double>> terms;
        for (int v = 0; v < child.NumVertices(); ++v) {
            for (int i = child.FirstValue(v); i < child.FirstValue(v + 1); ++i) {
                terms.clear();
                rooms.levels.Step(2).AppendTerms(v, i, terms);
                double sum = 0, applied = 0;
                for (auto const& [value, weight] : terms) {
                    sum += weight;
                    applied += weight * field[Index(value)];
                }
                ASSERT_NEAR(sum, 1, 1e-14) << shape.name << " vertex " << v;
                ASSERT_NEAR(applied, refined[Index(i)], 1e-14) << shape.name << " vertex " << v;
            }
        }
    }
}

TEST(FieldRefiner, OnInfinitelySharpCreasesAgreesWithOpenSubdivsFaceVaryingRefining) {
    // Without darts OpenSubdiv's own seams follow the same rules, with smooth seams (FVAR_LINEAR_NONE).
    for (Shape shape :
         {shapes::CubeWithSharpTop(), shapes::TorusWithCreaseRing(), shapes::TorusWithCreaseRing().Loop()}) {
        shape.rules.faceVarying = Sdc::Options::FVAR_LINEAR_NONE;
        Rooms<double> const rooms(shape, 3);
        CreaseRegions const& base = rooms.levels.Regions(0);
        std::unique_ptr<Far::TopologyRefiner> const refiner =
            shapes::MakeRefiner(shape, 3, base.CornerValues(), base.NumValues());
        shapes::Random random(11);
        std::vector<Vec3<double>> field(Index(base.NumValues()));
        for (auto& n : field) n = {random.Uniform(-1, 1), random.Uniform(-1, 1), random.Uniform(-1, 1)};
        std::vector<OsdPoint> expected;
        for (auto const& n : field) expected.push_back({n});
        Far::PrimvarRefinerReal<double> const primvars(*refiner);
        for (int level = 1; level <= 3; ++level) {
            std::vector<OsdPoint> next(Index(refiner->GetLevel(level).GetNumFVarValues()));
            primvars.InterpolateFaceVarying(level, expected, next);
            expected.swap(next);
            std::vector<Vec3<double>> refined(Index(rooms.levels.Regions(level).NumValues()));
            rooms.levels.Step(level).Apply(field, refined, {}, 1);
            field.swap(refined);
            for (int f = 0; f < refiner->GetLevel(level).GetNumFaces(); ++f) {
                Far::ConstIndexArray const indices = refiner->GetLevel(level).GetFaceFVarValues(f);
                for (int i = 0; i < indices.size(); ++i) {
                    int const value = rooms.levels.Regions(level).CornerValue(f, i);
                    ASSERT_LE(Distance(field[Index(value)], expected[Index(indices[i])].at), 1e-14) << shape.name;
                }
            }
        }
    }
}

TEST(FieldRefiner, MarkedValuesNeedNothingBeyondTheirMarkedSources) {
    shapes::Random random(17);
    for (Shape const& shape : AllShapes()) {
        Rooms<double> const rooms(shape, 2);
        FieldStep<double> const& step = rooms.levels.Step(2);
        std::vector<double> field(Index(step.Parent().NumValues())), all(Index(step.Child().NumValues()));
        for (double& x : field) x = random.Uniform(-1, 1);
        step.Apply(field, all, {}, 1);
        ValueMarks wanted(all.size()), childMarks, parentMarks;
        for (auto& mark : wanted) mark = random.Chance(0.05);
        childMarks = wanted;
        step.MarkSources(childMarks, parentMarks);
        // What is not marked is spoilt: it must not come through.
        std::vector<double> some = field, refined(all.size(), 1e30);
        for (std::size_t i = 0; i < some.size(); ++i) some[i] = parentMarks[i] ? field[i] : 1e30;
        step.Apply(some, refined, childMarks, 1);
        for (std::size_t i = 0; i < all.size(); ++i) {
            if (wanted[i]) {
                ASSERT_EQ(refined[i], all[i]) << shape.name << " value " << i;
            }
            if (!childMarks[i]) {
                ASSERT_EQ(refined[i], 1e30) << shape.name << " value " << i;
            }
        }
    }
}

TEST(FieldRefiner, AnIsolatedVertexDoesNotMakeUpForASplitOne) {
    // At level 1 the lone edge's middle has a value more than vertices, the isolated vertex one less.
    Shape const alone = shapes::GridWithDartToDart();
    Rooms<double> const a(alone, 2), b(Shape(alone).Vertex(9, 9, 9), 2);
    ASSERT_EQ(b.levels.Regions(1).NumValues(), b.levels.Regions(1).NumVertices());
    auto const refine = [](Rooms<double> const& rooms) {
        // The same number at the same face corner; sides differ.
        CreaseRegions const &parent = rooms.levels.Regions(1), &child = rooms.levels.Regions(2);
        std::vector<double> field(Index(parent.NumValues())), refined(Index(child.NumValues())), corners;
        for (int f = 0; f < rooms.topology.Level(1).GetNumFaces(); ++f) {
            for (int i = 0; i < 4; ++i) field[Index(parent.CornerValue(f, i))] = 7 * f % 11 + i;
        }
        rooms.levels.Step(2).Apply(field, refined, {}, 1);
        for (int const value : child.CornerValues()) corners.push_back(refined[Index(value)]);
        std::vector<double> limits(refined.size());
        rooms.limit.Apply(refined, limits, {}, 1);
        for (int const value : child.CornerValues()) corners.push_back(limits[Index(value)]);
        return corners;
    };
    EXPECT_TRUE(HasSameBits(refine(a), refine(b)));
    // The limit step at that very level.
    Rooms<double> const c(alone, 1), d(Shape(alone).Vertex(9, 9, 9), 1);
    auto const limit = [](Rooms<double> const& rooms) {
        CreaseRegions const& regions = rooms.LastRegions();
        std::vector<double> field(Index(regions.NumValues())), limits(field.size()), corners;
        for (int f = 0; f < rooms.Last().GetNumFaces(); ++f) {
            for (int i = 0; i < 4; ++i) field[Index(regions.CornerValue(f, i))] = 7 * f % 11 + i;
        }
        rooms.limit.Apply(field, limits, {}, 1);
        for (int const value : regions.CornerValues()) corners.push_back(limits[Index(value)]);
        return corners;
    };
    EXPECT_TRUE(HasSameBits(limit(c), limit(d)));
}

TEST(FieldRefiner, DoesNotDependOnTheThreads) {
    Shape const shape = shapes::TorusWithCreaseRing(3.5F);
    RefinedTopology const topology(shape.Mesh(), 5);
    FieldLevels<float> const one(topology, 3, 1), four(topology, 3, 4);
    for (int level = 4; level <= 5; ++level) {
        shapes::Random random(1);
        std::vector<float> field(Index(one.Regions(level - 1).NumValues()));
        for (float& x : field) x = static_cast<float>(random.Uniform(0, 1));
        std::vector<float> a(Index(one.Regions(level).NumValues())), b = a;
        one.Step(level).Apply(field, a, {}, 1);
        four.Step(level).Apply(field, b, {}, 4);
        EXPECT_TRUE(HasSameBits(a, b));
    }
}

}  // namespace
