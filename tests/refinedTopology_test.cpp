// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/refinedTopology.h"

#include <gtest/gtest.h>
#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/stencilTableFactory.h>
#include <opensubdiv/far/topologyDescriptor.h>

#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tests/testHelpers.h"

namespace {

using namespace osd_shading;
using namespace osd_shading::tests;

using Mask = std::map<int, double>;

/// A child's mask over the vertices of the level before, face points expanded.
template <typename Real>
Mask MaskOf(RefinedTopology const& topology, LevelMasks<Real> const& masks, int level, int child) {
    Mask mask;
    auto const row = Index(masks.Row(child));
    for (int t = masks.offsets[row]; t < masks.offsets[row + 1]; ++t) {
        int const term = masks.terms[Index(t)];
        double const weight = static_cast<double>(masks.weights[Index(t)]);
        if (term >= 0) {
            mask[term] += weight;
            continue;
        }
        auto const vertices = topology.Level(level - 1).GetFaceVertices(~term - topology.FirstFaceChild(level - 1));
        for (int const v : vertices) mask[v] += weight / vertices.size();
    }
    return mask;
}

Mask MaskOfVertexChild(Shape const& shape, int vertex) {
    RefinedTopology const topology(shape.Mesh(), 1);
    return MaskOf(topology, topology.RecordMasks<double>(1), 1, vertex);
}

Mask MaskOfEdgeChild(Shape const& shape, int a, int b) {
    RefinedTopology const topology(shape.Mesh(), 1);
    Far::TopologyLevel const& base = topology.Level(0);
    return MaskOf(topology, topology.RecordMasks<double>(1), 1, base.GetEdgeChildVertex(base.FindEdge(a, b)));
}

void ExpectMask(Mask const& mask, Mask const& expected, double tolerance) {
    EXPECT_EQ(mask.size(), expected.size());
    for (auto const& [vertex, weight] : expected) {
        ASSERT_TRUE(mask.count(vertex)) << vertex;
        EXPECT_NEAR(mask.at(vertex), weight, tolerance) << vertex;
    }
}

constexpr double kRounding = 1e-15;  // a handful of roundings of numbers under 1

// The masks of [CC78], [Loop87] and [DKT98].
TEST(RefinedTopology, MasksAreThoseOfThePapers) {
    // In the grid vertex (i, j) is 5 j + i, and 12 the centre.
    ExpectMask(MaskOfVertexChild(shapes::QuadGrid(4, 4), 12),
               {{12, 9.0 / 16},
                {7, 3.0 / 32},
                {11, 3.0 / 32},
                {13, 3.0 / 32},
                {17, 3.0 / 32},
                {6, 1.0 / 64},
                {8, 1.0 / 64},
                {16, 1.0 / 64},
                {18, 1.0 / 64}},
               kRounding);
    ExpectMask(MaskOfVertexChild(shapes::QuadGrid(4, 4).CreasePath({11, 12, 13}), 12),
               {{11, 1.0 / 8}, {12, 3.0 / 4}, {13, 1.0 / 8}}, kRounding);
    ExpectMask(MaskOfEdgeChild(shapes::QuadGrid(4, 4).Crease(12, 13), 12, 13), {{12, 0.5}, {13, 0.5}}, kRounding);
    ExpectMask(MaskOfVertexChild(shapes::QuadGrid(4, 4).Corner(12), 12), {{12, 1}}, kRounding);
    ExpectMask(MaskOfVertexChild(shapes::QuadGrid(4, 4), 2), {{1, 1.0 / 8}, {2, 3.0 / 4}, {3, 1.0 / 8}}, kRounding);
    // All six neighbours in a grid of triangles: 11, 13, 7, 17 and along the diagonals 6, 18.
    ExpectMask(MaskOfVertexChild(shapes::QuadGrid(4, 4).Loop(), 12),
               {{12, 5.0 / 8},
                {11, 1.0 / 16},
                {13, 1.0 / 16},
                {7, 1.0 / 16},
                {17, 1.0 / 16},
                {6, 1.0 / 16},
                {18, 1.0 / 16}},
               kRounding);
    ExpectMask(MaskOfEdgeChild(shapes::QuadGrid(4, 4).Loop(), 12, 13),
               {{12, 3.0 / 8}, {13, 3.0 / 8}, {7, 1.0 / 8}, {18, 1.0 / 8}}, kRounding);
}

TEST(RefinedTopology, AFractionOfSharpnessMixesTheTwoRules) {
    // 0.3 (1/2, 1/2) + 0.7 (3/8, 3/8, and 1/16 four times); sharpness is a float.
    ExpectMask(MaskOfEdgeChild(shapes::QuadGrid(4, 4).Crease(12, 13, 0.3F), 12, 13),
               {{12, 0.4125}, {13, 0.4125}, {7, 0.04375}, {8, 0.04375}, {17, 0.04375}, {18, 0.04375}}, 1e-7);
}

TEST(RefinedTopology, BilinearMasksAreMeansOfCorners) {
    Shape const shape = shapes::MixedPolygons().CreaseAll(1.5F);
    RefinedTopology const topology(shape.Mesh(), 1);
    LevelMasks<double> const masks = topology.RecordMasks<double>(1, MaskKind::Varying);
    Far::TopologyLevel const& base = topology.Level(0);
    ExpectMask(MaskOf(topology, masks, 1, 3), {{3, 1}}, kRounding);
    int const edge = base.FindEdge(0, 1);
    ExpectMask(MaskOf(topology, masks, 1, base.GetEdgeChildVertex(edge)), {{0, 0.5}, {1, 0.5}}, kRounding);
    for (int f = 0; f < base.GetNumFaces(); ++f) {
        Mask expected;
        for (int const v : base.GetFaceVertices(f)) expected[v] = 1.0 / base.GetFaceVertices(f).size();
        ExpectMask(MaskOf(topology, masks, 1, base.GetFaceChildVertex(f)), expected, kRounding);
    }
}

TEST(RefinedTopology, WeightsOfEachMaskAddToOne) {
    for (Shape const& shape : AllShapes()) {
        RefinedTopology const topology(shape.Mesh(), 3);
        for (int level = 1; level <= 3; ++level) {
            for (MaskKind const kind : {MaskKind::Vertex, MaskKind::Varying}) {
                LevelMasks<double> const masks = topology.RecordMasks<double>(level, kind);
                ASSERT_EQ(masks.offsets.size(), Index(masks.numChildVertices) + 1);
                for (std::size_t row = 0; row + 1 < masks.offsets.size(); ++row) {
                    double sum = 0;
                    for (int t = masks.offsets[row]; t < masks.offsets[row + 1]; ++t)
                        sum += masks.weights[Index(t)];
                    ASSERT_NEAR(sum, 1, 1e-14) << shape.name << " level " << level << " row " << row;
                }
            }
        }
    }
}

TEST(RefinedTopology, MasksGiveThePointsOfOpenSubdivsRefining) {
    for (Shape const& shape : AllShapes()) {
        Rooms<double> const rooms(shape, 3);
        for (int level = 1; level <= 3; ++level) {
            auto const expected = RefineByOsd(rooms.topology.Refiner(), OsdPointsOf(shape), 0, level);
            for (std::size_t v = 0; v < expected.size(); ++v) {
                // Points are of size 1 to 4: some 10 roundings.
                ASSERT_LE(Distance(rooms.points[Index(level)][v], expected[v].at), 1e-14) << shape.name << " " << v;
            }
        }
    }
}

TEST(RefinedTopology, MasksGiveThePointsOfOpenSubdivsStencils) {
    for (Shape const& shape : AllShapes()) {
        Rooms<double> const rooms(shape, 2);
        Far::StencilTableFactoryReal<double>::Options options;
        options.generateIntermediateLevels = false;
        options.generateOffsets = true;
        std::unique_ptr<Far::StencilTableReal<double> const> const table(
            Far::StencilTableFactoryReal<double>::Create(rooms.topology.Refiner(), options));
        std::vector<OsdPoint> expected(Index(table->GetNumStencils()));
        ASSERT_EQ(expected.size(), rooms.points[2].size()) << shape.name;
        table->UpdateValues(OsdPointsOf(shape), expected);
        for (std::size_t v = 0; v < expected.size(); ++v) {
            ASSERT_LE(Distance(rooms.points[2][v], expected[v].at), 1e-14) << shape.name << " vertex " << v;
        }
    }
}

TEST(RefinedTopology, VerticesKeepTheirNumbersAndFacePointsFollow) {
    for (Shape const& shape : AllShapes()) {
        RefinedTopology const topology(shape.Mesh(), 2);
        for (int level = 0; level < 2; ++level) {
            Far::TopologyLevel const& here = topology.Level(level);
            for (int v = 0; v < here.GetNumVertices(); ++v) ASSERT_EQ(here.GetVertexChildVertex(v), v);
            for (int f = 0; topology.IsCatmark() && f < here.GetNumFaces(); ++f) {
                ASSERT_EQ(here.GetFaceChildVertex(f), topology.FirstFaceChild(level) + f);
            }
        }
    }
}

TEST(RefinedTopology, OfSeveralEntriesForAnEdgeTheSharpestCounts) {
    for (auto const& [first, second] : {std::pair{1.5F, 3.0F}, {3.0F, 1.5F}}) {
        for (bool const isTurned : {false, true}) {
            Shape shape = shapes::Cube().Crease(4, 5, first).Crease(6, 7, 0.5F);
            shape.Crease(isTurned ? 5 : 4, isTurned ? 4 : 5, second);
            RefinedTopology const topology(shape.Mesh(), 0);
            Far::TopologyLevel const& base = topology.Level(0);
            EXPECT_EQ(base.GetEdgeSharpness(base.FindEdge(4, 5)), 3);
            EXPECT_EQ(base.GetEdgeSharpness(base.FindEdge(6, 7)), 0.5F);
        }
    }
}

TEST(RefinedTopology, OfSeveralEntriesForACornerTheSharpestCounts) {
    for (auto const& [first, second] : {std::pair{1.5F, 3.0F}, {3.0F, 1.5F}}) {
        Shape const shape = shapes::Cube().Corner(2, first).Corner(3, 0.5F).Corner(2, second);
        RefinedTopology const topology(shape.Mesh(), 0);
        EXPECT_EQ(topology.Level(0).GetVertexSharpness(2), 3);
        EXPECT_EQ(topology.Level(0).GetVertexSharpness(3), 0.5F);
    }
}

TEST(RefinedTopology, TenAndMoreAreInfinitelySharp) {
    Shape const shape = shapes::Cube().Crease(4, 5, 1e30F).Crease(5, 6, std::numeric_limits<float>::infinity());
    RefinedTopology const topology(shape.Mesh(), 3);
    Far::TopologyLevel const& last = topology.Level(3);
    int numSharp = 0;
    for (int e = 0; e < last.GetNumEdges(); ++e) {
        if (last.GetEdgeSharpness(e) == 0) continue;
        EXPECT_EQ(last.GetEdgeSharpness(e), 10);
        ++numSharp;
    }
    EXPECT_EQ(numSharp, 16);  // two edges, halved three times
}

TEST(RefinedTopology, OnlyLevelZeroHasIrregularFaces) {
    Shape const cube = shapes::Cube(), mixed = shapes::MixedPolygons(), triangles = shapes::Icosahedron().Loop();
    EXPECT_FALSE(RefinedTopology(cube.Mesh(), 1).HasIrregularFaces(0));
    EXPECT_TRUE(RefinedTopology(mixed.Mesh(), 1).HasIrregularFaces(0));
    EXPECT_FALSE(RefinedTopology(mixed.Mesh(), 1).HasIrregularFaces(1));
    EXPECT_FALSE(RefinedTopology(triangles.Mesh(), 1).HasIrregularFaces(0));
}

TEST(RefinedTopology, AnIsolatedVertexStaysWhereItIs) {
    ExpectMask(MaskOfVertexChild(shapes::IsolatedVertex(), 8), {{8, 1}}, 0);
}

TEST(RefinedTopology, AGivenRefinerYieldsTheSameMasksAndIsLeftAsItIs) {
    Shape const shape = shapes::CubeWithSharpTop(2.5F).Crease(0, 4).Corner(1, 0.5F).Hole(2);
    RefinedTopology const own(shape.Mesh(), 3);
    for (int const state : {0, 1, 2}) {  // unrefined, refined uniformly, refined adaptively
        std::unique_ptr<Far::TopologyRefiner> refiner = shapes::MakeRefiner(shape, state == 1 ? 2 : 0);
        if (state != 1) refiner->Unrefine();
        if (state == 2) refiner->RefineAdaptive(Far::TopologyRefiner::AdaptiveOptions(4));
        int const numLevels = refiner->GetNumLevels(), numVertices = refiner->GetNumVerticesTotal();
        bool const isUniform = refiner->IsUniform();
        RefinedTopology const shared(*refiner, 3);
        for (int level = 1; level <= 3; ++level) {
            LevelMasks<double> const a = own.RecordMasks<double>(level), b = shared.RecordMasks<double>(level);
            EXPECT_EQ(a.offsets, b.offsets);
            EXPECT_EQ(a.terms, b.terms);
            EXPECT_EQ(a.weights, b.weights);
        }
        EXPECT_EQ(refiner->GetNumLevels(), numLevels);
        EXPECT_EQ(refiner->GetNumVerticesTotal(), numVertices);
        EXPECT_EQ(refiner->IsUniform(), isUniform);
    }
}

/// The words with which a refiner of these faces is refused.
std::string ErrorInRefiner(Shape const& shape) {
    std::unique_ptr<Far::TopologyRefiner> const refiner = shapes::MakeRefiner(shape, 0);
    return ErrorOf<InvalidControlMesh>([&] { ValidateRefiner(*refiner); });
}

TEST(RefinedTopology, RefinersWithoutNormalsToSubdivideAreRefused) {
    Shape shape = shapes::Cube();
    shape.rules.scheme = Sdc::SCHEME_BILINEAR;
    EXPECT_EQ(ErrorInRefiner(shape), "the bilinear scheme has no normals to subdivide; use Catmull-Clark or Loop");
    Far::TopologyRefiner const empty(Sdc::SCHEME_CATMARK);
    EXPECT_EQ(ErrorOf<InvalidControlMesh>([&] { ValidateRefiner(empty); }),
              "the refiner holds no mesh: its level 0 has no faces");
    for (Shape const& good : AllShapes()) EXPECT_EQ(ErrorInRefiner(good), "no error") << good.name;
}

TEST(RefinedTopology, RefinersWithFacesThatOpenSubdivLetsPassAreRefused) {
    EXPECT_EQ(ErrorInRefiner(shapes::Cube().Face({0, 1})), "face 6 has 2 vertices; a face needs 3 or more");
    EXPECT_EQ(ErrorInRefiner(shapes::Cube().Face({3, 1, 2, 1})), "face 6 names vertex 1 twice");
    // OpenSubdiv only counts corners: four and two are two triangles.
    Shape shape = shapes::Tetrahedron().Loop();
    shape.Face({0, 1, 2, 3}).Face({0, 1});
    EXPECT_EQ(ErrorInRefiner(shape), "face 4 has 4 vertices; Loop subdivision takes triangles only");
}

TEST(RefinedTopology, RefinersWithWrongSharpnessAreRefused) {
    for (float const wrong : {-1.0F, std::numeric_limits<float>::quiet_NaN()}) {
        // Straight to OpenSubdiv: MakeRefiner keeps the highest sharpness only.
        int const sizes[] = {4}, vertices[] = {0, 1, 2, 3}, pair[] = {0, 1}, corner[] = {2};
        Far::TopologyDescriptor descriptor;
        descriptor.numVertices = 4;
        descriptor.numFaces = 1;
        descriptor.numVertsPerFace = sizes;
        descriptor.vertIndicesPerFace = vertices;
        Sdc::Options options;
        options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_NONE);
        using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
        descriptor.numCorners = 1;
        descriptor.cornerVertexIndices = corner;
        descriptor.cornerWeights = &wrong;
        std::unique_ptr<Far::TopologyRefiner> refiner(
            Factory::Create(descriptor, Factory::Options(Sdc::SCHEME_CATMARK, options)));
        EXPECT_EQ(ErrorOf<InvalidControlMesh>([&] { ValidateRefiner(*refiner); }),
                  "sharpness of vertex 2 of the refiner is negative or not a number; give 0 or more");
        int const sizes2[] = {4, 4}, vertices2[] = {0, 1, 2, 3, 1, 0, 4, 5};
        descriptor.numVertices = 6;
        descriptor.numFaces = 2;
        descriptor.numVertsPerFace = sizes2;
        descriptor.vertIndicesPerFace = vertices2;
        descriptor.numCorners = 0;
        descriptor.numCreases = 1;
        descriptor.creaseVertexIndexPairs = pair;
        descriptor.creaseWeights = &wrong;
        refiner.reset(Factory::Create(descriptor, Factory::Options(Sdc::SCHEME_CATMARK, options)));
        int const edge = refiner->GetLevel(0).FindEdge(0, 1);
        EXPECT_EQ(ErrorOf<InvalidControlMesh>([&] { ValidateRefiner(*refiner); }),
                  "sharpness of edge " + std::to_string(edge) +
                      " of the refiner is negative or not a number; give 0 or more");
    }
}

}  // namespace
