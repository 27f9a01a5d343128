// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/exactLimitMasks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "osd_shading/limitFrames.h"
#include "tests/testHelpers.h"

namespace {

using namespace osd_shading;
using namespace osd_shading::tests;

constexpr double kPi = 3.14159265358979323846;
constexpr double kDegrees = 180 / kPi;

/// The faces round vertex 0: edges 1 .. numEdges, then (Catmull-Clark) the faces' opposite vertices.
Shape Round(bool isCatmark, int numFaces, RingKind kind) {
    bool const isFan = kind == RingKind::Fan;
    int const numEdges = isFan ? numFaces + 1 : numFaces;
    double const step = (isFan ? kPi : 2 * kPi) / numFaces;
    Shape shape;
    shape.Vertex(0, 0, 0);
    for (int i = 0; i < numEdges; ++i) shape.Vertex(std::cos(step * i), std::sin(step * i), 0);
    for (int i = 0; i < numFaces && isCatmark; ++i) {
        shape.Vertex(1.3 * std::cos(step * (i + .5)), 1.3 * std::sin(step * (i + .5)), 0);
    }
    for (int i = 0; i < numFaces; ++i) {
        int const a = 1 + i, b = isFan ? 2 + i : 1 + (i + 1) % numFaces;
        if (isCatmark) {
            shape.Face({0, a, 1 + numEdges + i, b});
        } else {
            shape.Face({0, a, b});
        }
    }
    if (!isCatmark) shape.rules.scheme = Sdc::SCHEME_LOOP;
    shape.rules.boundary = Sdc::Options::VTX_BOUNDARY_EDGE_ONLY;
    if (kind == RingKind::Dart) shape.Crease(0, 1);
    return shape.Jitter(0.25, 7);
}

/// What is round vertex 0, `numLevels` levels further down, by OpenSubdiv alone: one level of it at a time. The
/// sides from the vertex are kept at size 1; `vertex` becomes the vertex.
std::vector<Vec3<double>> GoDown(Shape const& shape, int numLevels, Vec3<double>& vertex) {
    RefinedTopology const topology(shape.Mesh(), 1);
    LevelMasks<double> const masks = topology.RecordMasks<double>(1);
    Far::TopologyLevel const& level = topology.Level(0);
    std::vector<int> children(static_cast<std::size_t>(shape.NumVertices()));
    children[0] = level.GetVertexChildVertex(0);
    for (int e = 0; e < level.GetNumEdges(); ++e) {
        Far::ConstIndexArray const ends = level.GetEdgeVertices(e);
        if (ends[0] != 0 && ends[1] != 0) continue;
        children[static_cast<std::size_t>(ends[0] + ends[1])] = level.GetEdgeChildVertex(e);
    }
    bool const isCatmark = topology.IsCatmark();
    for (int f = 0; f < shape.NumFaces() && isCatmark; ++f) {
        children[static_cast<std::size_t>(level.GetFaceVertices(f)[2])] = level.GetFaceChildVertex(f);
    }
    std::vector<Vec3<double>> points = PointsOf<double>(shape);
    vertex = points[0];
    double size = 1;
    for (Vec3<double>& p : points) p = p - vertex;
    for (int i = 0; i < numLevels; ++i) {
        std::vector<Vec3<double>> const refined = RefinePoints(masks, points, 1);
        Vec3<double> const moved = refined[static_cast<std::size_t>(children[0])];
        vertex += size * moved;
        double largest = 0;
        for (std::size_t v = 0; v < points.size(); ++v) {
            points[v] = refined[static_cast<std::size_t>(children[v])] - moved;
            largest = std::max(largest, Length(points[v]));
        }
        for (Vec3<double>& p : points) p = (1 / largest) * p;
        size *= largest;
    }
    return points;
}

/// The mean of the faces' unit normals at the vertex, and the largest angle of one from it.
Vec3<double> MeanNormal(Shape const& shape, std::vector<Vec3<double>> const& points, double& spread) {
    std::vector<Vec3<double>> normals;
    Vec3<double> sum{};
    for (std::vector<int> const& face : shape.Faces()) {
        Vec3<double> const a = points[static_cast<std::size_t>(face[1])] - points[0],
                           b = points[static_cast<std::size_t>(face.back())] - points[0];
        normals.push_back(Normalized(Cross(Normalized(a), Normalized(b))));
        sum += normals.back();
    }
    spread = 0;
    for (Vec3<double> const& n : normals) spread = std::max(spread, kDegrees * AngleBetween(sum, n));
    return Normalized(sum);
}

Vec3<double> NormalAtVertex(Shape const& shape, LimitNormalKind kind, std::int64_t& numAverages) {
    RefinedTopology const topology(shape.Mesh(), 0);
    CreaseRegions const regions(topology, 0, 1);
    LimitStep<double> const limit(topology, 0, regions, 1, kind);
    LimitNormals<double> const normals = ComputeLimitNormals(limit, PointsOf<double>(shape), 1);
    numAverages = normals.numAverages;
    return normals.normals[static_cast<std::size_t>(regions.FirstValue(0))];
}

std::string Format(char const* format, double number) {
    char text[32];
    std::snprintf(text, sizeof text, format, number);
    return text;
}

struct Case {
    bool isCatmark;
    int numFaces;
    RingKind kind;
    bool hasPlane;

    std::string Name() const {
        char const* const kinds[] = {"ring", "dart", "fan"};
        return std::string(isCatmark ? "Catmull-Clark " : "Loop ") + kinds[static_cast<int>(kind)] + " of " +
               std::to_string(numFaces);
    }
};

std::vector<Case> AllCases() {
    std::vector<Case> cases;
    for (bool const isCatmark : {true, false}) {
        cases.push_back({isCatmark, 2, RingKind::Ring, false});
        for (int n = 2; n <= 9; ++n) cases.push_back({isCatmark, n, RingKind::Dart, n > 2});
        int const firstFan = isCatmark ? 3 : 4, lastWithPlane = isCatmark ? 4 : 6;
        for (int n = firstFan; n <= 8; ++n) cases.push_back({isCatmark, n, RingKind::Fan, n <= lastWithPlane});
    }
    return cases;
}

TEST(ExactLimitMasks, ADartOfARegularMeshHasThePositionWorkedByHand) {
    // By the matrix of the ring of a Loop dart of valence 6, whose left eigenvector of eigenvalue 1 is, over the
    // sum: vertex 6 a, edges as they are refined among themselves; checked by its own refinement.
    ExactLimitMask const mask = FindExactLimitMask(Sdc::SCHEME_LOOP, 6, RingKind::Dart);
    // Against l = l A: the entry of the vertex is 5/8 l_0 + 3/8 (five edges) + 1/2 (the sharp one).
    double const smooth = mask.position.edges[1] + mask.position.edges[2] + mask.position.edges[3] +
                          mask.position.edges[4] + mask.position.edges[5];
    double const sharp = mask.position.edges[0];
    EXPECT_NEAR(mask.position.vertex, 5. / 8 * mask.position.vertex + 3. / 8 * smooth + sharp / 2, 1e-14);
    // That of the edge opposite: 1/16 l_0 + 3/8 itself + 1/8 (its two neighbours).
    EXPECT_NEAR(mask.position.edges[3],
                mask.position.vertex / 16 + 3. / 8 * mask.position.edges[3] +
                    (mask.position.edges[2] + mask.position.edges[4]) / 8,
                1e-14);
    EXPECT_NEAR(mask.position.vertex + smooth + sharp, 1, 1e-14);
}

TEST(ExactLimitMasks, PositionsAreWhereOpenSubdivsRulesLead) {
    for (Case const& c : AllCases()) {
        Shape const shape = Round(c.isCatmark, c.numFaces, c.kind);
        Vec3<double> truth{};
        GoDown(shape, 100, truth);
        ExactLimitMask const mask = FindExactLimitMask(shape.rules.scheme, c.numFaces, c.kind);
        std::vector<Vec3<double>> const points = PointsOf<double>(shape);
        Vec3<double> limit = mask.position.vertex * points[0];
        for (std::size_t i = 0; i < mask.position.edges.size(); ++i)
            limit += mask.position.edges[i] * points[1 + i];
        for (std::size_t i = 0; i < mask.position.faces.size(); ++i) {
            limit += mask.position.faces[i] * points[1 + mask.position.edges.size() + i];
        }
        // What is left after 100 levels is .63^100; the rest are roundings.
        EXPECT_LE(Length(limit - truth), 1e-13) << c.Name();
    }
}

TEST(ExactLimitMasks, NormalsAreWhereOpenSubdivsRulesLead) {
    std::printf("%-24s %12s %12s %12s\n", "angle in degrees to", "", "OpenSubdiv's", "exact");
    std::printf("%-24s %12s %12s %12s\n", "deep local refinement", "its spread", "mask", "mask");
    for (Case const& c : AllCases()) {
        // Where eigenvalues are chained it comes nearer by 1/level, as the spread of its faces does.
        bool const isChained = c.kind == RingKind::Fan && c.numFaces == (c.isCatmark ? 4 : 6);
        Shape const shape = Round(c.isCatmark, c.numFaces, c.kind);
        Vec3<double> unused{};
        // The level at which the faces agree best: further down the smaller tangent is lost in roundings.
        double spread = 180;
        Vec3<double> truth{};
        for (int level = 4; level <= 240; level += 4) {
            double here = 0;
            Vec3<double> const mean = MeanNormal(shape, GoDown(shape, level, unused), here);
            if (here < spread) {
                spread = here;
                truth = mean;
            }
        }
        std::int64_t numAverages = 0, unusedCount = 0;
        Vec3<double> const exact = NormalAtVertex(shape, LimitNormalKind::Exact, numAverages);
        Vec3<double> const masks = NormalAtVertex(shape, LimitNormalKind::Limit, unusedCount);
        // Other vertices of the shape are boundaries of one or two faces.
        bool const isAverage = numAverages > unusedCount;
        EXPECT_EQ(isAverage, !c.hasPlane) << c.Name();
        std::string ours = "no plane";
        if (c.hasPlane) ours = Format("%.2g", kDegrees * AngleBetween(exact, truth));
        std::printf("%-24s %12.2g %12.2g %12s\n", c.Name().c_str(), spread, kDegrees * AngleBetween(masks, truth),
                    ours.c_str());
        if (!c.hasPlane) continue;
        EXPECT_LE(spread, isChained ? 0.5 : 1e-6) << c.Name();
        EXPECT_LE(kDegrees * AngleBetween(exact, truth), isChained ? 2 * spread : 2e-6) << c.Name();
    }
}

TEST(ExactLimitMasks, ALimitStepIsOpenSubdivsWhereItsMasksAreExact) {
    // Closed, smooth, valence 3 and more: the same bits.
    for (Shape const& shape : {shapes::Cube(), shapes::Cube().Loop()}) {
        RefinedTopology const topology(shape.Mesh(), 1);
        CreaseRegions const regions(topology, 1, 1);
        std::vector<Vec3<double>> const points =
            RefinePoints(topology.RecordMasks<double>(1), PointsOf<double>(shape), 1);
        LimitStep<double> const masks(topology, 1, regions, 1),
            exact(topology, 1, regions, 1, LimitNormalKind::Exact);
        auto const a = ComputeLimitNormals(masks, points, 1).normals,
                   b = ComputeLimitNormals(exact, points, 1).normals;
        for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(Length(a[i] - b[i]), 0);
    }
}

}  // namespace
