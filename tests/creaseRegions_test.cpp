// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/creaseRegions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "tests/sampleSize.h"
#include "tests/testHelpers.h"

namespace {

using namespace osd_shading;
using namespace osd_shading::tests;

/// Regions of a level, with the topology that they refer to.
struct LevelRegions {
    RefinedTopology topology;
    CreaseRegions regions;

    explicit LevelRegions(Shape const& shape, int level = 0)
        : topology(shape.Mesh(), level), regions(topology, level, 1) {}
    Far::TopologyLevel const& Level() const { return topology.Level(topology.LastLevel()); }
    int NumRegions(int vertex) const { return regions.NumVertexValues(vertex); }
    int ValueAt(int face, int vertex) const {
        return regions.CornerValue(face, Level().GetFaceVertices(face).FindIndex(vertex));
    }
    std::vector<RegionFan> Fans(int vertex) const {
        std::vector<RegionFan> fans;
        FindRegionFans(Level(), regions, vertex, fans);
        return fans;
    }
};

using Partition = std::set<std::set<int>>;

Partition FacesByValue(LevelRegions const& found, int vertex) {
    std::map<int, std::set<int>> faces;
    for (int const f : found.Level().GetVertexFaces(vertex)) faces[found.ValueAt(f, vertex)].insert(f);
    Partition partition;
    for (auto const& [value, set] : faces) partition.insert(set);
    return partition;
}

/// The same from faces and edges alone: flooding over edges at the vertex that are not sharp.
Partition FacesByFlooding(Far::TopologyLevel const& level, int vertex) {
    std::set<int> left;
    for (int const f : level.GetVertexFaces(vertex)) left.insert(f);
    Partition partition;
    while (!left.empty()) {
        std::set<int> region;
        std::vector<int> open{*left.begin()};
        left.erase(left.begin());
        while (!open.empty()) {
            int const face = open.back();
            open.pop_back();
            region.insert(face);
            for (int const edge : level.GetFaceEdges(face)) {
                if (level.GetEdgeVertices(edge).FindIndex(vertex) < 0 || level.GetEdgeSharpness(edge) > 0) continue;
                for (int const next : level.GetEdgeFaces(edge)) {
                    if (left.erase(next)) open.push_back(next);
                }
            }
        }
        partition.insert(region);
    }
    return partition;
}

TEST(CreaseRegions, TwoSharpEdgesSplitTheFacesRoundAVertexInTwo) {
    LevelRegions const cube(shapes::CubeWithSharpTop());
    EXPECT_EQ(cube.regions.NumValues(), 12);  // four vertices at the bottom, twice four at the top
    for (int v = 0; v < 4; ++v) EXPECT_EQ(cube.NumRegions(v), 1);
    for (int v = 4; v < 8; ++v) {
        EXPECT_EQ(cube.NumRegions(v), 2);
        EXPECT_EQ(cube.regions.Kind(v), VertexKind::Crease);
    }
    // Face 0 is the top, faces 2 and 3 are the sides at vertex 5.
    EXPECT_EQ(FacesByValue(cube, 5), (Partition{{0}, {2, 3}}));
}

TEST(CreaseRegions, ThreeSharpEdgesMakeACornerOfThreeRegions) {
    LevelRegions const cube(shapes::Cube().CreaseAll());
    EXPECT_EQ(cube.regions.NumValues(), 24);
    for (int v = 0; v < 8; ++v) {
        EXPECT_EQ(cube.NumRegions(v), 3);
        EXPECT_EQ(cube.regions.Kind(v), VertexKind::Corner);
    }
}

TEST(CreaseRegions, ADartHasOneRegion) {
    LevelRegions const grid(shapes::GridWithDart());
    EXPECT_EQ(grid.regions.Kind(12), VertexKind::Dart);
    EXPECT_EQ(grid.NumRegions(12), 1);
    EXPECT_EQ(grid.NumRegions(11), 2);
    EXPECT_EQ(grid.regions.Kind(10), VertexKind::Corner);  // the crease meets the boundary: three sharp edges
    EXPECT_EQ(grid.NumRegions(10), 2);
}

TEST(CreaseRegions, ALoneSharpEdgeBetweenTwoDartsSplitsItsOwnMiddleOnly) {
    Shape const shape = shapes::GridWithDartToDart();
    LevelRegions const grid(shape), refined(shape, 1);
    EXPECT_EQ(grid.regions.NumValues(), grid.regions.NumVertices());
    EXPECT_EQ(grid.regions.Kind(12), VertexKind::Dart);
    EXPECT_EQ(grid.regions.Kind(13), VertexKind::Dart);
    EXPECT_EQ(refined.regions.NumValues(), refined.regions.NumVertices() + 1);
    int const middle =
        grid.topology.Level(0).GetNumEdges() > 0
            ? refined.topology.Level(0).GetEdgeChildVertex(refined.topology.Level(0).FindEdge(12, 13))
            : -1;
    EXPECT_EQ(refined.NumRegions(middle), 2);
}

TEST(CreaseRegions, ACornersOwnSharpnessSplitsNothing) {
    LevelRegions const cube(shapes::Cube().Corner(6));
    EXPECT_EQ(cube.regions.Kind(6), VertexKind::Corner);
    EXPECT_EQ(cube.NumRegions(6), 1);
}

TEST(CreaseRegions, TheRingsArbitraryStartDoesNotSplitARegion) {
    // Two sharp edges at each pair of places of each ring, wherever OpenSubdiv starts it.
    Shape const torus = shapes::Torus(5, 4);
    RefinedTopology const plain(torus.Mesh(), 0);
    for (int v = 0; v < plain.Level(0).GetNumVertices(); ++v) {
        Far::ConstIndexArray const edges = plain.Level(0).GetVertexEdges(v);
        for (int i = 0; i < 4; ++i) {
            for (int j = i + 1; j < 4; ++j) {
                Shape shape = torus;
                for (int const e : {edges[i], edges[j]}) {
                    Far::ConstIndexArray const ends = plain.Level(0).GetEdgeVertices(e);
                    shape.Crease(ends[0], ends[1], 1.5F);
                }
                LevelRegions const found(shape);
                ASSERT_EQ(found.NumRegions(v), 2);
                std::vector<RegionFan> const fans = found.Fans(v);
                EXPECT_EQ(fans[0].faces.size() + fans[1].faces.size(), 4U);
                EXPECT_EQ(std::min(fans[0].faces.size(), fans[1].faces.size()), j - i == 2 ? 2U : 1U);
                EXPECT_EQ(FacesByValue(found, v), FacesByFlooding(found.Level(), v));
            }
        }
    }
}

TEST(CreaseRegions, RegionsAreWhatFloodingFinds) {
    for (Shape const& shape : AllShapes()) {
        for (int level = 0; level <= 2; ++level) {
            LevelRegions const found(shape, level);
            for (int v = 0; v < found.regions.NumVertices(); ++v) {
                Partition const expected = FacesByFlooding(found.Level(), v);
                ASSERT_EQ(FacesByValue(found, v), expected) << shape.name << " level " << level << " vertex " << v;
                ASSERT_EQ(found.NumRegions(v), static_cast<int>(expected.size()));
            }
        }
    }
}

TEST(CreaseRegions, RegionsOfRandomNonManifoldMeshesAreWhatFloodingFinds) {
    for (std::uint64_t seed = 0; seed < SampleSize(60); ++seed) {
        shapes::RandomShapeOptions options;
        options.nonManifold = true;
        LevelRegions const found(shapes::RandomShape(seed, options), static_cast<int>(seed % 2));
        for (int v = 0; v < found.regions.NumVertices(); ++v) {
            ASSERT_EQ(FacesByValue(found, v), FacesByFlooding(found.Level(), v)) << "seed " << seed;
        }
    }
}

TEST(CreaseRegions, KindsAreOpenSubdivsAndThoseOfTheSharpnessRoundAVertex) {
    for (Shape const& shape : AllShapes()) {
        for (int level = 0; level <= 2; ++level) {
            LevelRegions const found(shape, level);
            for (int v = 0; v < found.regions.NumVertices(); ++v) {
                int numSharp = 0;
                for (int const e : found.Level().GetVertexEdges(v))
                    numSharp += found.Level().GetEdgeSharpness(e) > 0;
                VertexKind const counted = found.Level().GetVertexSharpness(v) > 0 || numSharp > 2
                                               ? VertexKind::Corner
                                               : static_cast<VertexKind>(numSharp);
                std::map<Sdc::Crease::Rule, VertexKind> const kinds{{Sdc::Crease::RULE_SMOOTH, VertexKind::Smooth},
                                                                    {Sdc::Crease::RULE_DART, VertexKind::Dart},
                                                                    {Sdc::Crease::RULE_CREASE, VertexKind::Crease},
                                                                    {Sdc::Crease::RULE_CORNER, VertexKind::Corner}};
                ASSERT_EQ(found.regions.Kind(v), counted) << shape.name << " level " << level << " vertex " << v;
                ASSERT_EQ(found.regions.Kind(v), kinds.at(found.Level().GetVertexRule(v))) << shape.name;
                ASSERT_EQ(found.regions.IsSharp(v), counted >= VertexKind::Crease);
            }
        }
    }
}

TEST(CreaseRegions, EveryCornerHasAValueOfItsVertexAndEveryValueAFace) {
    for (Shape const& shape : AllShapes()) {
        LevelRegions const found(shape, 1);
        std::vector<char> isUsed(Index(found.regions.NumValues()), 0);
        for (int f = 0; f < found.Level().GetNumFaces(); ++f) {
            Far::ConstIndexArray const vertices = found.Level().GetFaceVertices(f);
            bool isPlain = true;
            for (int i = 0; i < vertices.size(); ++i) {
                int const value = found.regions.FaceValues(f)[i];
                ASSERT_GE(value, found.regions.FirstValue(vertices[i]));
                ASSERT_LT(value, found.regions.FirstValue(vertices[i] + 1));
                isUsed[Index(value)] = 1;
                isPlain = isPlain && found.NumRegions(vertices[i]) == 1;
            }
            ASSERT_EQ(found.regions.IsPlainFace(f), isPlain) << shape.name << " face " << f;
        }
        EXPECT_EQ(std::count(isUsed.begin(), isUsed.end(), 0), 0) << shape.name;
    }
}

TEST(CreaseRegions, FansOfManifoldVerticesRunFromOneSharpEdgeToTheNext) {
    for (Shape const& shape : AllShapes()) {
        LevelRegions const found(shape, 1);
        for (int v = 0; v < found.regions.NumVertices(); ++v) {
            for (RegionFan const& fan : found.Fans(v)) {
                if (!found.Level().IsVertexNonManifold(v)) {
                    ASSERT_TRUE(fan.isOrdered) << shape.name;
                }
                if (!fan.isOrdered) continue;
                auto const edgeAt = [&](std::size_t i, int step) {
                    Far::ConstIndexArray const edges = found.Level().GetFaceEdges(fan.faces[i]);
                    return edges[(fan.corners[i] + step) % edges.size()];
                };
                std::size_t const count = fan.faces.size();
                for (std::size_t i = 0; i < count; ++i) {
                    ASSERT_EQ(found.Level().GetFaceVertices(fan.faces[i])[fan.corners[i]], v);
                    ASSERT_EQ(found.ValueAt(fan.faces[i], v), fan.value);
                    int const last = found.Level().GetFaceEdges(fan.faces[i]).size() - 1;
                    if (i + 1 < count || fan.isClosed) {
                        ASSERT_EQ(edgeAt(i, last), edgeAt((i + 1) % count, 0));
                    }
                    if (i + 1 == count && !fan.isClosed) {
                        ASSERT_TRUE(IsSharpEdge(found.Level(), edgeAt(i, last)));
                    }
                }
                if (!fan.isClosed) {
                    ASSERT_TRUE(IsSharpEdge(found.Level(), edgeAt(0, 0))) << shape.name;
                }
            }
        }
    }
}

TEST(CreaseRegions, AReleasedCreasesRegionsMerge) {
    // Sharpness 1.25 is left at levels 0 and 1 and released at level 2, the next whole number.
    Shape const cube = shapes::CubeWithSharpTop(1.25F);
    EXPECT_EQ(LevelRegions(cube, 0).regions.NumValues(), 12);
    EXPECT_EQ(LevelRegions(cube, 1).regions.NumValues(), 26 + 8);
    EXPECT_EQ(LevelRegions(cube, 2).regions.NumValues(), 98);
    // A whole number is released at its own level.
    EXPECT_EQ(LevelRegions(shapes::CubeWithSharpTop(1), 1).regions.NumValues(), 26);
}

TEST(CreaseRegions, BoundaryVerticesHaveOneRegionAndAreSharp) {
    LevelRegions const box(shapes::OpenBox());
    for (int v = 4; v < 8; ++v) {
        EXPECT_EQ(box.NumRegions(v), 1);
        EXPECT_EQ(box.regions.Kind(v), VertexKind::Crease);
    }
    LevelRegions const quad(shapes::LoneQuad()),
        edgeOnly(shapes::LoneQuad().Boundary(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY));
    for (int v = 0; v < 4; ++v) {
        EXPECT_EQ(quad.regions.Kind(v), VertexKind::Corner);
        EXPECT_EQ(edgeOnly.regions.Kind(v), VertexKind::Crease);
    }
}

TEST(CreaseRegions, AnEdgeOfThreeFacesSeparatesAllOfThem) {
    // On the middle row of the grid meet the sheets below and above and the fin.
    LevelRegions const grid(shapes::FinnedGrid());
    EXPECT_EQ(FacesByValue(grid, 7), (Partition{{1, 2}, {5, 6}, {9, 10}}));
    for (RegionFan const& fan : grid.Fans(7)) EXPECT_TRUE(fan.isOrdered);
}

TEST(CreaseRegions, ABowtieVertexHasARegionForEachSide) {
    LevelRegions const boxes(shapes::TwoBoxesSharingAVertex());
    EXPECT_EQ(boxes.NumRegions(6), 2);
    EXPECT_EQ(boxes.regions.Kind(6), VertexKind::Corner);
    for (RegionFan const& fan : boxes.Fans(6)) {
        EXPECT_EQ(fan.faces.size(), 3U);
        EXPECT_FALSE(fan.isOrdered);  // a full ring, but OpenSubdiv makes its vertex sharp
    }
}

TEST(CreaseRegions, AnIsolatedVertexHasNone) {
    for (int level = 0; level <= 1; ++level) {
        LevelRegions const cube(shapes::IsolatedVertex(), level);
        EXPECT_EQ(cube.NumRegions(8), 0);
        EXPECT_TRUE(cube.Fans(8).empty());
        EXPECT_EQ(cube.regions.NumValues(), cube.regions.NumVertices() - 1);
    }
}

TEST(CreaseRegions, DoNotDependOnTheThreads) {
    // More than one chunk of vertices and faces.
    Shape const shape = shapes::TorusWithCreaseRing();
    RefinedTopology const topology(shape.Mesh(), 5);
    CreaseRegions const one(topology, 5, 1), four(topology, 5, 4);
    EXPECT_EQ(one.FirstValues(), four.FirstValues());
    EXPECT_EQ(one.CornerValues(), four.CornerValues());
}

}  // namespace
