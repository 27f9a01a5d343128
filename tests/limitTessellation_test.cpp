// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/limitTessellation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "osd_shading/vectorMath.h"
#include "tests/sampleSize.h"
#include "tests/testHelpers.h"

namespace {

using namespace osd_shading;
using namespace osd_shading::tests;

std::size_t Index(int i) { return static_cast<std::size_t>(i); }

template <typename Real>
ShadingResult<Real> Cut(Shape const& shape, TessellationOptions const& options) {
    std::vector<Vec3<Real>> const points = PointsOf<Real>(shape);
    ShadingInput<Real> input;
    input.positions = points;
    return TessellateLimitSurface(LimitSurface<Real>(shape.Mesh(), input), options);
}

TessellationOptions Uniform(int rate) {
    TessellationOptions options;
    options.rate = rate;
    return options;
}
TessellationOptions Curvature(double maxAngle) {
    TessellationOptions options;
    options.kind = TessellationKind::Curvature;
    options.maxAngle = maxAngle;
    return options;
}

/// Uses of each edge by triangles, in both directions.
template <typename Real>
std::map<std::pair<int, int>, int> EdgesOf(ShadingResult<Real> const& result) {
    std::map<std::pair<int, int>, int> uses;
    for (std::size_t i = 0; i < result.faceVertices.size(); i += 3) {
        for (std::size_t k = 0; k < 3; ++k) {
            ++uses[{result.faceVertices[i + k], result.faceVertices[i + (k + 1) % 3]}];
        }
    }
    return uses;
}

bool IsClosed(Shape const& shape) {
    RefinedTopology const topology(shape.Mesh(), 0);
    for (int e = 0; e < topology.Level(0).GetNumEdges(); ++e) {
        if (topology.Level(0).GetEdgeFaces(e).size() != 2) return false;
    }
    return shape.holes.empty();
}

TEST(LimitTessellation, CutsACubesFaceOfTwoSegmentsIntoEightTriangles) {
    ShadingResult<double> const result = Cut<double>(shapes::Cube(), Uniform(2));
    // 8 vertices, 12 middles of edges, 6 of faces.
    EXPECT_EQ(result.NumVertices(), 26);
    EXPECT_EQ(result.NumValues(), 26);
    EXPECT_EQ(result.NumFaces(), 48);
    EXPECT_EQ(result.faceSize, 3);
    EXPECT_EQ(result.report.faces, 48);
    // A corner of the cube's limit is its eighth's centre: the mean of 8 corners, weighed.
    for (Vec3<double> const& n : result.blendedNormals) EXPECT_NEAR(Length(n), 1, 1e-12);
}

TEST(LimitTessellation, HasNoGapsAndTheShapesEulerNumberWhateverTheRates) {
    std::int64_t numClosed = 0;
    for (Shape const& shape : AllShapes()) {
        if (!IsClosed(shape)) continue;
        ++numClosed;
        std::set<int> const used(shape.faceVertices.begin(), shape.faceVertices.end());
        auto const numUsed = static_cast<int>(used.size());
        RefinedTopology const topology(shape.Mesh(), 0);
        int const euler = numUsed - topology.Level(0).GetNumEdges() + topology.Level(0).GetNumFaces();
        for (TessellationOptions const& options :
             {Uniform(1), Uniform(3), Uniform(4), Curvature(7), Curvature(25)}) {
            ShadingResult<double> const result = Cut<double>(shape, options);
            auto const edges = EdgesOf(result);
            int numDirected = 0;
            for (auto const& [edge, uses] : edges) {
                // Faces with the same vertices share edges that are not the same.
                EXPECT_TRUE(uses == 1 || options.rate == 1) << shape.name;
                if (uses == 1) {
                    EXPECT_EQ(edges.count({edge.second, edge.first}), 1U) << shape.name;
                }
                numDirected += uses;
            }
            int const numIsolated = shape.NumVertices() - numUsed;
            EXPECT_EQ(result.NumVertices() - numIsolated - numDirected / 2 + result.NumFaces(), euler)
                << shape.name;
        }
    }
    EXPECT_GE(numClosed, Fewest(20));
}

TEST(LimitTessellation, HoldsTheSurfacesOwnPointsAndOneNormalForEachSideOfACrease) {
    Shape const shape = shapes::Cube().CreaseAll();
    ShadingResult<double> const result = Cut<double>(shape, Uniform(4));
    // Inside a face one, on an edge two, at a corner three.
    EXPECT_EQ(result.NumVertices(), 8 + 12 * 3 + 6 * 9);
    EXPECT_EQ(result.NumValues(), 8 * 3 + 12 * 3 * 2 + 6 * 9);
    for (std::size_t i = 0; i < result.faceValues.size(); ++i) {
        EXPECT_EQ(result.valueVertices[Index(result.faceValues[i])], result.faceVertices[i]);
    }
    // The cube stays one: each normal is an axis.
    for (Vec3<double> const& n : result.blendedNormals) {
        EXPECT_NEAR(std::max({std::fabs(n.x), std::fabs(n.y), std::fabs(n.z)}), 1, 1e-12);
    }
    for (int v = 0; v < result.NumVertices(); ++v) {
        EXPECT_GT(result.vertexValues[Index(v + 1)], result.vertexValues[Index(v)]);
    }
}

TEST(LimitTessellation, CutsFinerWhereTheSurfaceTurns) {
    // A flat sheet stays as it is; a smooth cube turns by 90 degrees along an edge.
    ShadingResult<double> const flat = Cut<double>(shapes::QuadGrid(3, 3), Curvature(5));
    EXPECT_EQ(flat.NumFaces(), 18);
    ShadingResult<double> const coarse = Cut<double>(shapes::Cube(), Curvature(20)),
                                fine = Cut<double>(shapes::Cube(), Curvature(5));
    EXPECT_GT(fine.NumFaces(), 6 * coarse.NumFaces());
    auto const largestAngle = [](ShadingResult<double> const& result) {
        double largest = 0;
        for (std::size_t i = 0; i < result.faceValues.size(); i += 3) {
            for (std::size_t k = 0; k < 3; ++k) {
                largest = std::max(largest,
                                   AngleBetween(result.blendedNormals[Index(result.faceValues[i + k])],
                                                result.blendedNormals[Index(result.faceValues[i + (k + 1) % 3])]));
            }
        }
        return largest * 180 / 3.14159265358979323846;
    };
    // Parameters do not run evenly along the surface, and diagonals are longer.
    EXPECT_LE(largestAngle(fine), 2 * 5);
    EXPECT_LE(largestAngle(coarse), 2 * 20);
}

TEST(LimitTessellation, CutsFinerWhatIsLargerOnTheScreen) {
    TessellationOptions options;
    options.kind = TessellationKind::Screen;
    options.width = options.height = 1000;
    options.maxPixels = 25;
    options.maxRate = 1000;
    // Clip coordinates from -1 to 1 are the screen: a sheet of 4 x 4 faces over [0, 4]^2 is cut to 1/8 of it.
    options.viewProjection = {0.25, 0, 0, 0, 0, 0.25, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    Shape const sheet = shapes::QuadGrid(4, 4);
    ShadingResult<double> const near = Cut<double>(sheet, options);
    // A face is 125 pixels wide: 5 segments of 25. (Some more, by rounding up.)
    EXPECT_GE(near.NumFaces(), 16 * 2 * 5 * 5);
    EXPECT_LE(near.NumFaces(), 16 * 2 * 6 * 6);
    options.maxPixels = 125.001;
    EXPECT_EQ(Cut<double>(sheet, options).NumFaces(), 32);
    // Behind the eye nothing is cut.
    options.maxPixels = 1;
    options.viewProjection[15] = -1;
    EXPECT_EQ(Cut<double>(sheet, options).NumFaces(), 32);
}

TEST(LimitTessellation, IsTheSameWhateverTheThreads) {
    TessellationOptions options = Curvature(6);
    ShadingResult<float> const one = Cut<float>(shapes::CubeWithSharpTop(), options);
    options.numThreads = 4;
    ShadingResult<float> const four = Cut<float>(shapes::CubeWithSharpTop(), options);
    EXPECT_EQ(one.faceVertices, four.faceVertices);
    EXPECT_EQ(one.faceValues, four.faceValues);
    ASSERT_EQ(one.positions.size(), four.positions.size());
    for (std::size_t i = 0; i < one.positions.size(); ++i) {
        EXPECT_EQ(Length(one.positions[i] - four.positions[i]), 0);
    }
}

TEST(LimitTessellation, LeavesHolesOut) {
    Shape const shape = shapes::QuadGrid(3, 3).Hole(4);
    ShadingResult<double> const result = Cut<double>(shape, Uniform(2));
    EXPECT_EQ(result.NumFaces(), 8 * 8);
    EXPECT_EQ(std::count(result.baseFaces.begin(), result.baseFaces.end(), 4), 0);
}

TEST(LimitTessellation, KeepsTheNumbersOfControlVerticesAndTheirCreases) {
    // A lone vertex in the midst of the numbers.
    Shape shape = shapes::CubeWithSharpTop();
    shape.positions.insert(shape.positions.begin() + 6, {7, 8, 9});
    for (int& v : shape.faceVertices) v += v >= 2;
    for (int& v : shape.creaseVertices) v += v >= 2;
    ShadingResult<double> const result = Cut<double>(shape, Uniform(4));
    RefinedTopology const topology(shape.Mesh(), 0);
    Far::TopologyLevel const& level = topology.Level(0);
    std::vector<Vec3<double>> const points = PointsOf<double>(shape);
    ShadingInput<double> input;
    input.positions = points;
    LimitSurface<double> const surface(shape.Mesh(), input);
    for (int f = 0; f < level.GetNumFaces(); ++f) {
        Vec3<double> const corner = surface.Evaluate(f, 0, 0).position;
        EXPECT_LT(Length(corner - result.positions[Index(level.GetFaceVertices(f)[0])]), 1e-12);
    }
    EXPECT_EQ(Length(result.positions[2] - Vec3<double>{7, 8, 9}), 0);
    EXPECT_EQ(result.vertexValues[2], result.vertexValues[3]);
    for (int v = 0; v < level.GetNumVertices(); ++v) {
        VertexTag const& tag = result.vertexTags[Index(v)];
        EXPECT_EQ(tag.valence, level.GetVertexEdges(v).size());
        EXPECT_EQ(tag.kind == VertexKind::Crease, level.GetVertexRule(v) == Sdc::Crease::RULE_CREASE);
    }

    // Four edges of the sharp top, four segments each, strung together from vertex to vertex.
    EXPECT_EQ(result.creaseEdges.size(), 4U * 4U);
    auto const edges = EdgesOf(result);
    std::map<int, int> uses;
    for (CreaseEdge const& edge : result.creaseEdges) {
        EXPECT_TRUE(edges.count({edge.vertices[0], edge.vertices[1]}) > 0);
        for (int const v : edge.vertices) {
            ++uses[v];
            EXPECT_EQ(result.vertexTags[Index(v)].kind, VertexKind::Crease);
        }
    }
    EXPECT_EQ(uses.size(), 4U * 4U);
    for (auto const& [vertex, count] : uses) EXPECT_EQ(count, 2);
}

TEST(LimitTessellation, SaysHowFarItIsAndCanBeAbandoned) {
    TessellationOptions options = Uniform(2);
    std::vector<double> shares;
    options.progress = [&](double share) {
        shares.push_back(share);
        return true;
    };
    Shape const sheet = shapes::QuadGrid(20, 20);
    Cut<double>(sheet, options);
    EXPECT_GT(shares.size(), 3U);
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
    EXPECT_EQ(shares.back(), 1);
    options.progress = [](double share) { return share < 0.5; };
    EXPECT_NE(ErrorOf<Cancelled>([&] { Cut<double>(sheet, options); }).find("abandoned"), std::string::npos);
}

TEST(LimitTessellation, RefusesInWords) {
    auto const wordsOf = [](auto const& change) {
        TessellationOptions options;
        change(options);
        return ErrorOf<InvalidOptions>([&] { Cut<double>(shapes::Cube(), options); });
    };
    EXPECT_NE(wordsOf([](TessellationOptions& o) { o.rate = 0; }).find("rate is 0"), std::string::npos);
    EXPECT_NE(wordsOf([](TessellationOptions& o) { o.rate = 1025; }).find("1 to 1024"), std::string::npos);
    EXPECT_NE(wordsOf([](TessellationOptions& o) { o.maxRate = -1; }).find("maxRate"), std::string::npos);
    EXPECT_NE(wordsOf([](TessellationOptions& o) { o.maxAngle = 0; }).find("maxAngle"), std::string::npos);
    EXPECT_NE(wordsOf([](TessellationOptions& o) { o.maxPixels = std::nan(""); }).find("maxPixels"),
              std::string::npos);
    EXPECT_NE(wordsOf([](TessellationOptions& o) { o.width = 0; }).find("no pixels"), std::string::npos);
    EXPECT_NE(wordsOf([](TessellationOptions& o) { o.viewProjection[3] = std::nan(""); }).find("not finite"),
              std::string::npos);
    EXPECT_NE(wordsOf([](TessellationOptions& o) { o.numThreads = -1; }).find("numThreads"), std::string::npos);

    std::vector<Vec3<double>> const points = PointsOf<double>(shapes::Cube());
    ShadingInput<double> input;
    input.positions = points;
    ShadingOptions options = SurfacePreset();
    options.execution.memoryLimit = 10000;
    Shape const cube = shapes::Cube();
    LimitSurface<double> const surface(cube.Mesh(), input, options);
    EXPECT_NE(
        ErrorOf<MemoryLimitExceeded>([&] { TessellateLimitSurface(surface, Uniform(64)); }).find("lower rates"),
        std::string::npos);
}

}  // namespace
