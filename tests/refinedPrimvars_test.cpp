// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/refinedPrimvars.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "tests/testHelpers.h"

namespace {

using namespace osd_shading;
using namespace osd_shading::tests;

PositionKind const kKinds[] = {PositionKind::Limit, PositionKind::Refined};

/// Texture coordinates with a seam: the first face has values of its own, the others share those of their vertices.
struct SeamedUvs {
    std::vector<int> indices;
    std::vector<double> values;

    explicit SeamedUvs(Shape const& shape) : indices(shape.faceVertices) {
        for (int i = 0; i < shape.faceSizes[0]; ++i) indices[Index(i)] = shape.NumVertices() + i;
        shapes::Random random(21);
        for (int i = 0; i < 3 * NumValues(shape); ++i) values.push_back(random.Uniform(0, 1));
    }
    static int NumValues(Shape const& shape) { return shape.NumVertices() + shape.faceSizes[0]; }
};

std::vector<OsdPoint> Triples(std::vector<double> const& values) {
    std::vector<OsdPoint> points;
    for (std::size_t i = 0; i < values.size(); i += 3)
        points.push_back({{values[i], values[i + 1], values[i + 2]}});
    return points;
}

std::vector<double> RandomNumbers(std::size_t count) {
    shapes::Random random(22);
    std::vector<double> values(count);
    for (double& x : values) x = random.Uniform(0, 1);
    return values;
}

TEST(RefinedPrimvars, AColourOnACubesCornerSpreadsByTheMasks) {
    // 1 at vertex 6 alone. Faces' points have 1/4, edges' (1 + 0 + 1/4 + 1/4) / 4, and the corner
    // (Q + 2 R) / 3 with Q = 1/4 of its faces' points and R = 1/2 of its edges' middles.
    Shape const cube = shapes::Cube();
    RefinedTopology const topology(cube.Mesh(), 1);
    std::vector<double> const values{0, 0, 0, 0, 0, 0, 1, 0};
    RefinedPrimvar<double> const refined =
        RefineVertexData<double>(topology, {values.data(), 8, 1}, PositionKind::Refined);
    Far::TopologyLevel const& base = topology.Level(0);
    EXPECT_EQ(refined.width, 1);
    EXPECT_NEAR(refined.values[6], 5.0 / 12, 1e-15);
    EXPECT_NEAR(refined.values[Index(base.GetEdgeChildVertex(base.FindEdge(5, 6)))], 3.0 / 8, 1e-15);
    EXPECT_NEAR(refined.values[Index(base.GetFaceChildVertex(0))], 1.0 / 4, 1e-15);
}

TEST(RefinedPrimvars, VertexDataIsWhatOpenSubdivInterpolates) {
    for (Shape const& shape : AllShapes()) {
        for (int level = HasOnlyRegularFaces(shape) ? 0 : 1; level <= 2; ++level) {
            RefinedTopology const topology(shape.Mesh(), level);
            std::vector<double> const values = RandomNumbers(shape.positions.size());
            std::vector<OsdPoint> const refined = RefineByOsd(topology.Refiner(), Triples(values), 0, level);
            std::vector<OsdPoint> limits(refined.size());
            Far::PrimvarRefinerReal<double>(topology.Refiner()).Limit(refined, limits);
            for (PositionKind const kind : kKinds) {
                PrimvarView<double> const view(values.data(), values.size() / 3, 3);
                std::vector<OsdPoint> const found = Triples(RefineVertexData(topology, view, kind).values);
                std::vector<OsdPoint> const& expected = kind == PositionKind::Limit ? limits : refined;
                ASSERT_EQ(found.size(), expected.size());
                for (std::size_t i = 0; i < found.size(); ++i) {
                    ASSERT_LE(Distance(found[i].at, expected[i].at), 1e-15) << shape.name << " level " << level;
                }
            }
        }
    }
}

TEST(RefinedPrimvars, PositionsAsVertexDataGiveThePositions) {
    for (Shape const& shape : AllShapes()) {
        std::vector<Vec3<double>> const points = PointsOf<double>(shape);
        for (PositionKind const kind : kKinds) {
            ShadingInput<double> input;
            input.positions = points;
            input.vertexData.push_back({&points[0].x, points.size(), 3});
            ShadingOptions options = PaperPreset(2);
            options.limits.positions = kind;
            ShadingResult<double> const result = ShadeSubdivision(shape.Mesh(), input, options);
            std::vector<OsdPoint> const data = Triples(result.vertexData[0].values);
            ASSERT_EQ(data.size(), result.positions.size());
            for (std::size_t v = 0; v < data.size(); ++v) {
                ASSERT_LE(Distance(data[v].at, result.positions[v]), 1e-14) << shape.name;
            }
        }
    }
}

TEST(RefinedPrimvars, FaceVaryingDataFollowsEveryLinearInterpolationAsInOpenSubdiv) {
    using Options = Sdc::Options;
    for (Options::FVarLinearInterpolation const linear :
         {Options::FVAR_LINEAR_NONE, Options::FVAR_LINEAR_CORNERS_ONLY, Options::FVAR_LINEAR_CORNERS_PLUS1,
          Options::FVAR_LINEAR_CORNERS_PLUS2, Options::FVAR_LINEAR_BOUNDARIES, Options::FVAR_LINEAR_ALL}) {
        for (Shape shape : AllShapes()) {
            shape.rules.faceVarying = linear;
            SeamedUvs const uvs(shape);
            int const numValues = SeamedUvs::NumValues(shape), level = 2;
            std::unique_ptr<Far::TopologyRefiner> const refiner =
                shapes::MakeRefiner(shape, level, uvs.indices, numValues);
            Far::PrimvarRefinerReal<double> const primvars(*refiner);
            std::vector<OsdPoint> refined = Triples(uvs.values);
            for (int l = 1; l <= level; ++l) {
                std::vector<OsdPoint> next(Index(refiner->GetLevel(l).GetNumFVarValues()));
                primvars.InterpolateFaceVarying(l, refined, next);
                refined.swap(next);
            }
            std::vector<OsdPoint> limits(refined.size());
            primvars.LimitFaceVarying(refined, limits);

            RefinedTopology const topology(shape.Mesh(), level, {ArrayView<int>(uvs.indices)}, {numValues});
            PrimvarView<double> const view(uvs.values.data(), Index(numValues), 3);
            for (PositionKind const kind : kKinds) {
                RefinedFaceVarying<double> const found = RefineFaceVaryingData(topology, 0, view, kind);
                std::vector<OsdPoint> const values = Triples(found.values);
                Far::TopologyLevel const last = refiner->GetLevel(level);
                std::size_t corner = 0;
                for (int f = 0; f < last.GetNumFaces(); ++f) {
                    if (last.IsFaceHole(f)) continue;
                    for (int const i : last.GetFaceFVarValues(f)) {
                        OsdPoint const& expected = (kind == PositionKind::Limit ? limits : refined)[Index(i)];
                        OsdPoint const& value = values[Index(found.faceIndices[corner++])];
                        ASSERT_LE(Distance(value.at, expected.at), 1e-15) << shape.name << " " << linear;
                    }
                }
                ASSERT_EQ(corner, found.faceIndices.size());
            }
        }
    }
}

TEST(RefinedPrimvars, AConstantStaysConstantInAnyWidthAndStride) {
    Shape const shape = shapes::MixedPolygons().CreasePath({1, 8, 9}, 1.5F);
    RefinedTopology const topology(shape.Mesh(), 3);
    for (int const width : {1, 2, 5}) {
        std::size_t const stride = Index(width) + 2;
        std::vector<float> values(Index(shape.NumVertices()) * stride, -99);
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (i % stride < Index(width)) values[i] = static_cast<float>(i % stride) + 0.5F;
        }
        PrimvarView<float> const view(values.data(), Index(shape.NumVertices()), width, stride);
        RefinedPrimvar<float> const refined = RefineVertexData(topology, view, PositionKind::Limit);
        ASSERT_EQ(refined.width, width);
        ASSERT_EQ(refined.values.size(), Index(topology.Level(3).GetNumVertices() * width));
        for (std::size_t i = 0; i < refined.values.size(); ++i) {
            EXPECT_NEAR(refined.values[i], static_cast<float>(i % Index(width)) + 0.5F, 5e-6);  // float, 4 steps
        }
    }
}

TEST(RefinedPrimvars, HolesLeaveFaceIndicesOutAsTheyDoFaces) {
    Shape const shape = shapes::Cube().Hole(1).Hole(4);
    SeamedUvs const uvs(shape);
    std::vector<Vec3<double>> const points = PointsOf<double>(shape);
    ShadingInput<double> input;
    input.positions = points;
    input.faceVaryingData.push_back({uvs.indices, {uvs.values.data(), uvs.values.size() / 3, 3}});
    ShadingResult<double> const result = ShadeSubdivision(shape.Mesh(), input, PaperPreset(2));
    ASSERT_EQ(result.faceVaryingData[0].faceIndices.size(), result.faceVertices.size());
    std::unique_ptr<Far::TopologyRefiner> const refiner =
        shapes::MakeRefiner(shape, 2, uvs.indices, SeamedUvs::NumValues(shape));
    for (int f = 0; f < result.NumFaces(); ++f) {
        Far::ConstIndexArray const expected = refiner->GetLevel(2).GetFaceFVarValues(result.refinerFaces[Index(f)]);
        for (int i = 0; i < 4; ++i) {
            EXPECT_EQ(result.faceVaryingData[0].faceIndices[Index(4 * f + i)], expected[i]);
        }
    }
}

TEST(RefinedPrimvars, ChannelsAreIndependent) {
    Shape const shape = shapes::Cube();
    SeamedUvs const uvs(shape);
    std::vector<Vec3<double>> const points = PointsOf<double>(shape);
    std::vector<double> const plain = RandomNumbers(8);
    FaceVaryingView<double> const seamed{uvs.indices, {uvs.values.data(), uvs.values.size() / 3, 3}};
    FaceVaryingView<double> const shared{shape.faceVertices, {plain.data(), 8, 1}};
    auto const shade = [&](std::vector<FaceVaryingView<double>> const& channels) {
        ShadingInput<double> input;
        input.positions = points;
        input.faceVaryingData = channels;
        return ShadeSubdivision(shape.Mesh(), input, PaperPreset(2)).faceVaryingData;
    };
    auto const both = shade({seamed, shared}), first = shade({seamed}), second = shade({shared});
    EXPECT_TRUE(HasSameBits(both[0].values, first[0].values));
    EXPECT_TRUE(HasSameBits(both[1].values, second[0].values));
    EXPECT_EQ(both[0].faceIndices, first[0].faceIndices);
    EXPECT_EQ(both[1].faceIndices, second[0].faceIndices);
    EXPECT_EQ(both[1].width, 1);
}

}  // namespace
