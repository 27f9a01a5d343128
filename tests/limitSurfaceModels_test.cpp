// SPDX-License-Identifier: Apache-2.0

// Limit surfaces of models as they come: beside uniform shading, and from both sides of every edge.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "osd_shading/io/objReader.h"
#include "tests/ioFiles.h"
#include "tests/sampleSize.h"
#include "tests/surfaceAgreement.h"

namespace osd_shading::tests {
namespace {

/// A model as a shape in each scheme that takes it; none where the library refuses it.
std::vector<Shape> ShapesOf(std::string const& file) {
    std::vector<Shape> taken;
    try {
        io::Model const model = io::ReadObj(file);
        for (Sdc::SchemeType const scheme : {Sdc::SCHEME_CATMARK, Sdc::SCHEME_LOOP}) {
            bool const areTriangles =
                std::all_of(model.faceSizes.begin(), model.faceSizes.end(), [](int size) { return size == 3; });
            if (scheme == Sdc::SCHEME_LOOP && !areTriangles) continue;
            Shape shape;
            shape.name = model.name + (scheme == Sdc::SCHEME_LOOP ? ", loop" : ", catmark");
            shape.positions = model.positions;
            shape.faceSizes = model.faceSizes;
            shape.faceVertices = model.faceVertices;
            shape.creaseVertices = model.creaseVertices;
            shape.creaseSharpness = model.creaseSharpness;
            shape.cornerVertices = model.cornerVertices;
            shape.cornerSharpness = model.cornerSharpness;
            shape.holes = model.holes;
            shape.rules.scheme = scheme;
            shape.rules = model.Rules(shape.rules);
            ValidateControlMesh(shape.Mesh());
            taken.push_back(shape);
        }
    } catch (Error const& error) {
        std::printf("left out: %s\n", error.what());
    }
    return taken;
}

/// A surface's options: its own level, or the last one at which uniform shading has no more than a million faces (a
/// hundredth under sanitizers).
ShadingOptions OptionsFor(Shape const& shape) {
    ShadingOptions options = SurfacePreset();
    int const level = Surface<double>(shape, options).limit.Options().level;
    options.level = 1;
    std::size_t const most = IsSanitizerRun() ? 10000 : 1000000;
    for (std::size_t faces = 4 * shape.faceVertices.size(); options.level < level && faces <= most; faces *= 4) {
        ++options.level;
    }
    return options;
}

std::int64_t CompareModel(Shape const& shape) {
    double size = 0;
    for (double const x : shape.positions) size = std::max(size, std::fabs(x));
    std::int64_t numCompared = 0;
    for (LimitNormalKind const kind : {LimitNormalKind::Limit, LimitNormalKind::Exact}) {
        ShadingOptions options = OptionsFor(shape);
        options.limits.normals = kind;
        // Chaikin's rule averages sharpness in float, in the order of the edges.
        double const slack = shape.rules.creasing == Sdc::Options::CREASE_CHAIKIN ? 1e5 : 1;
        Differences const d = CompareWithUniform(shape, options);
        std::string const text = shape.name + ": " + d.where;
        EXPECT_LE(d.position, slack * 1e-13) << text;
        EXPECT_LE(d.weight, slack * 1e-12) << text;
        EXPECT_LE(d.limitNormal, slack * 1e-9) << text;
        EXPECT_LE(d.subdivided, slack * 1e-9) << text;
        EXPECT_LE(d.blended, slack * 1e-9) << text;
        if (kind == LimitNormalKind::Limit) continue;

        // At interior vertices of valence 2 there is no tangent plane: normals near them turn with each level.
        RefinedTopology const topology(shape.Mesh(), 0);
        auto const isNearFold = [&](int edge, double t) {
            Far::ConstIndexArray const ends = topology.Level(0).GetEdgeVertices(edge);
            auto const isFold = [&](int v) {
                return topology.Level(0).GetVertexFaces(v).size() == 2 && !topology.Level(0).IsVertexBoundary(v);
            };
            return (t < 1e-3 && isFold(ends[0])) || (t > 1 - 1e-3 && isFold(ends[1]));
        };
        Surface<double> const surface(shape, options);
        ForEachEdge(surface, shape, [&](auto const& a, auto const& b, bool isSharp, int e, double t) {
            std::string const where = shape.name + ", edge " + std::to_string(e) + " at " + std::to_string(t);
            EXPECT_LE(Distance(a.position, b.position), slack * 1e-12 * size) << where;
            auto const isDegenerate = [&](auto const& p) {
                return Length(Cross(p.du, p.dv)) < 1e-5 * Length(p.du) * Length(p.dv) ||
                       std::min(Length(p.du), Length(p.dv)) < 1e-12 * size;
            };
            if (isSharp || isDegenerate(a) || isDegenerate(b) || isNearFold(e, t)) return;
            if (IsZero(a.subdividedNormal) != IsZero(b.subdividedNormal)) return;
            // Two sheets back to back, whose edges are folds.
            if (Dot(a.limitNormal, b.limitNormal) < -1 + 1e-9) return;
            ++numCompared;
            EXPECT_LE(std::fabs(a.blendWeight - b.blendWeight), slack * 1e-12) << where;
            EXPECT_LE(Distance(a.blendedNormal, b.blendedNormal), 1e-6) << where;
        });
    }
    return numCompared;
}

void CompareFiles(std::vector<std::string> const& files) {
    std::int64_t numCompared = 0;
    std::size_t const mostFaces = IsFullRun() ? 4000 : IsSanitizerRun() ? 40 : 300;
    for (std::string const& file : files) {
        for (Shape const& shape : ShapesOf(file)) {
            if (shape.faceSizes.size() > mostFaces) continue;
            numCompared += CompareModel(shape);
        }
    }
    EXPECT_GT(numCompared, Fewest(1000));
}

TEST(LimitSurfaceModels, OurOwnAreTheUniformResultAndContinuousAcrossEdges) { CompareFiles(ioFiles::OwnModels()); }

TEST(LimitSurfaceModels, SharedOnesAreTheUniformResultAndContinuousAcrossEdges) {
    std::vector<std::string> const files = ioFiles::SharedModels();
    if (files.empty()) GTEST_SKIP() << ioFiles::kNoSharedModels;
    CompareFiles(files);
}

}  // namespace
}  // namespace osd_shading::tests
