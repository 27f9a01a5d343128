// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/limitSurface.h"

#include <gtest/gtest.h>
#include <opensubdiv/bfr/refinerSurfaceFactory.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <thread>
#include <vector>

#include "osd_shading/subdivisionShading.h"
#include "osd_shading/vectorMath.h"
#include "tests/sampleSize.h"
#include "tests/surfaceAgreement.h"
#include "tests/testHelpers.h"

namespace {

using namespace osd_shading;
using namespace osd_shading::tests;

std::vector<std::pair<std::string, ShadingOptions>> ManyOptions() {
    std::vector<std::pair<std::string, ShadingOptions>> all;
    auto const add = [&](std::string const& name, auto const& change) {
        for (LimitNormalKind const kind : {LimitNormalKind::Limit, LimitNormalKind::Exact}) {
            ShadingOptions options = SurfacePreset();
            options.limits.normals = kind;
            change(options);
            all.emplace_back(name + (kind == LimitNormalKind::Exact ? ", exact" : ""), options);
        }
    };
    add("defaults", [](ShadingOptions&) {});
    add("level 3", [](ShadingOptions& o) { o.level = 3; });
    add("variant A", [](ShadingOptions& o) { o.weights.sharpVertices = SharpVertexWeight::Smooth; });
    add("variant C", [](ShadingOptions& o) { o.weights.sharpVertices = SharpVertexWeight::PerRegion; });
    add("sharp darts", [](ShadingOptions& o) { o.weights.darts = DartWeight::LikeSharp; });
    add("n 0, w 0", [](ShadingOptions& o) {
        o.startNormals.level = o.weights.level = 0;
        o.weights.exponent = 2.5;
    });
    add("n 2, w 1", [](ShadingOptions& o) { o.startNormals = {StartNormalKind::Angle, 2}; });
    add("smooth", [](ShadingOptions& o) {
        LimitNormalKind const kind = o.limits.normals;
        o = SmoothPreset(2);
        o.level = kDefaultSurfaceLevel;
        o.limits.normals = kind;
    });
    add("ev only", [](ShadingOptions& o) { o.weights.scheme = WeightScheme::ExtraordinaryOnly; });
    add("limit start", [](ShadingOptions& o) { o.startNormals = {StartNormalKind::Limit, 1}; });
    add("user", [](ShadingOptions& o) { o.startNormals = {StartNormalKind::User, 0}; });
    return all;
}

TEST(LimitSurface, IsTheUniformResultAtThePointsOfTheLastLevel) {
    // Each shape with the defaults and, in CI, with every fourth of the other options, other ones for each shape.
    std::size_t turn = 0;
    for (Shape const& shape : AllShapes()) {
        ++turn;
        for (auto const& [name, options] : ManyOptions()) {
            ++turn;
            if (name.rfind("defaults", 0) != 0 && turn % 4 != 0 && !IsFullRun()) continue;
            Differences const d = CompareWithUniform(shape, options);
            // Roundings of coordinates of size 1, divided by the lengths of what is normalised.
            std::string const text = shape.name + ", " + name + ": " + d.where;
            EXPECT_LE(d.position, 1e-13) << text;
            EXPECT_LE(d.weight, 1e-12) << text;
            EXPECT_LE(d.limitNormal, 1e-11) << text;
            EXPECT_LE(d.subdivided, 1e-11) << text;
            EXPECT_LE(d.blended, 1e-11) << text;
        }
    }
}

TEST(LimitSurface, IsTheUniformResultWhereCreasesFadeFarDown) {
    // There the levels are not refined whole: of each few, what still fades is cut out anew. Sharpness by 2.4 more
    // than what the shapes have, so that it is released at levels 3 to 5.
    SweepSample sample(5);
    std::int64_t numShapes = 0;
    for (Shape shape : AllShapes()) {
        bool hasFading = false;
        auto const sharpen = [&](std::vector<float>& sharpness) {
            for (float& s : sharpness) {
                if (!(s > 0) || s >= Sdc::Crease::SHARPNESS_INFINITE) continue;
                s = std::min(s + 2.4F, 4.8F);
                hasFading = true;
            }
        };
        sharpen(shape.creaseSharpness);
        sharpen(shape.cornerSharpness);
        if (!hasFading) continue;
        ++numShapes;
        for (auto const& [name, options] : ManyOptions()) {
            if (name.rfind("level", 0) == 0 || !sample.Takes()) continue;
            Differences const d = CompareWithUniform(shape, options);
            std::string const text = shape.name + ", " + name + ": " + d.where;
            double const slack = shape.rules.creasing == Sdc::Options::CREASE_CHAIKIN ? 1e5 : 1;
            EXPECT_LE(d.position, slack * 1e-13) << text;
            EXPECT_LE(d.weight, slack * 1e-12) << text;
            EXPECT_LE(d.limitNormal, slack * 1e-11) << text;
            EXPECT_LE(d.subdivided, slack * 1e-11) << text;
            EXPECT_LE(d.blended, slack * 1e-11) << text;
        }
    }
    EXPECT_GT(numShapes, Fewest(20));

    // And once through many cuts.
    if (IsSanitizerRun()) return;
    for (Shape shape : {shapes::Cube().Crease(0, 1, 6.8F), shapes::Cube().Crease(0, 1, 6.8F).Loop()}) {
        for (SharpVertexWeight const variant : {SharpVertexWeight::Zero, SharpVertexWeight::PerRegion}) {
            ShadingOptions options = SurfacePreset();
            options.weights.sharpVertices = variant;
            Differences const d = CompareWithUniform(shape, options);
            EXPECT_LE(std::max(d.position, d.weight), 1e-12) << d.where;
            EXPECT_LE(std::max({d.limitNormal, d.subdivided, d.blended}), 1e-11) << d.where;
        }
    }
}

TEST(LimitSurface, TakesTheCallersNormalsByFaceCorner) {
    for (Shape const& shape : AllShapes()) {
        ShadingOptions options = SurfacePreset();
        options.startNormals = {StartNormalKind::User, 0};
        options.weights.sharpVertices = SharpVertexWeight::Smooth;
        Differences const d = CompareWithUniform(shape, options, 0, true);
        EXPECT_LE(d.subdivided, 1e-10) << shape.name << ": " << d.where;
        EXPECT_LE(d.blended, 1e-10) << shape.name << ": " << d.where;
    }
}

bool HasAverages(Surface<double> const& surface, Shape const& shape) {
    ShadingOptions const& options = surface.limit.Options();
    return ShadeSubdivision(shape.Mesh(), surface.Input(options), options).report.averagedNormals > 0;
}

TEST(LimitSurface, IsWhereDeepUniformRefinementLeads) {
    // Nothing fades or is seeded below the surface's own level: OpenSubdiv's rules, three levels further, go on as
    // the patches and the neighbourhoods that come round to themselves do. Round darts, irregular creases and
    // valence 2 too.
    for (Shape const& shape : AllShapes()) {
        ShadingOptions options = SurfacePreset();
        options.limits.normals = LimitNormalKind::Exact;
        options.weights.scheme = WeightScheme::One;
        Surface<double> const surface(shape, options);
        if (surface.limit.Options().level > 3) continue;
        Differences const d = CompareWithUniform(shape, options, 3);
        std::string const text = shape.name + ": " + d.where;
        EXPECT_LE(d.position, 1e-13) << text;
        EXPECT_LE(d.subdivided, 1e-11) << text;
        // Where there is no tangent plane N_L is an average of the last level's faces: other ones at each level.
        if (!HasAverages(surface, shape)) {
            EXPECT_LE(d.limitNormal, 1e-10) << text;
        }
    }
}

/// Compares with Bfr at points of every face; calls `visit(isBfrRegular, difference)`: of positions and
/// derivatives, over the model's size.
template <typename Visit>
void CompareWithBfr(Shape const& shape, double margin, Visit const& visit) {
    Surface<double> const surface(shape, SurfacePreset());
    RefinedTopology const topology(shape.Mesh(), 0);
    Bfr::RefinerSurfaceFactory<> const factory(
        topology.Refiner(),
        Bfr::SurfaceFactory::Options().EnableCaching(false).SetApproxLevelSmooth(10).SetApproxLevelSharp(10));
    double size = 0;
    for (double const x : shape.positions) size = std::max(size, std::fabs(x));
    shapes::Random random(4);
    for (int f = 0; f < surface.limit.NumFaces(); ++f) {
        Bfr::Surface<double> bfr;
        if (!factory.InitVertexSurface(f, &bfr)) continue;
        std::vector<double> patchPoints(3 * Index(bfr.GetNumPatchPoints()));
        bfr.PreparePatchPoints(shape.positions.data(), {3, 3}, patchPoints.data(), {3, 3});
        int const faceSize = surface.limit.FaceSize(f);
        Bfr::Parameterization const parametrization = bfr.GetParameterization();
        for (int i = 0; i < 12; ++i) {
            double inFace[2] = {random.Uniform(margin, 1 - margin), random.Uniform(margin, 1 - margin)};
            if (!topology.IsCatmark() && inFace[0] + inFace[1] > 1 - margin) continue;
            double uv[2] = {inFace[0], inFace[1]};
            if (parametrization.HasSubFaces()) {
                parametrization.ConvertNormalizedSubFaceToCoord(random.Below(faceSize), inFace, uv);
            }
            double p[3], du[3], dv[3];
            bfr.Evaluate(uv, patchPoints.data(), {3, 3}, p, du, dv);
            SurfacePoint<double> const point = surface.limit.Evaluate(f, uv[0], uv[1]);
            double const difference =
                std::max({Distance(point.position, {p[0], p[1], p[2]}), Distance(point.du, {du[0], du[1], du[2]}),
                          Distance(point.dv, {dv[0], dv[1], dv[2]})});
            visit(bfr.IsRegular(), difference / size, f, uv);
        }
    }
}

TEST(LimitSurface, IsBfrsSurfaceWhereThatIsExact) {
    std::int64_t numRegular = 0;
    for (Shape const& shape : AllShapes()) {
        CompareWithBfr(shape, 0, [&](bool isRegular, double difference, int face, double const* uv) {
            if (!isRegular) return;
            ++numRegular;
            EXPECT_LE(difference, 1e-12) << shape.name << ", face " << face << " " << uv[0] << " " << uv[1];
        });
    }
    EXPECT_GT(numRegular, Fewest(200));
}

TEST(LimitSurface, IsBfrsSurfaceAwayFromIrregularVertices) {
    // In Bfr's tree of ten levels the regular patches are exact: all that are 2^-9 from a corner. Darts, fading
    // creases, non-manifold joins and valence 2 are no exception.
    std::int64_t numCompared = 0;
    for (Shape const& shape : AllShapes()) {
        CompareWithBfr(shape, 1.0 / 512, [&](bool, double difference, int face, double const* uv) {
            ++numCompared;
            EXPECT_LE(difference, 1e-12) << shape.name << ", face " << face << " " << uv[0] << " " << uv[1];
        });
    }
    EXPECT_GT(numCompared, Fewest(5000));
}

TEST(LimitSurface, DerivativesAreThoseOfDifferences) {
    for (Shape const& shape : AllShapes()) {
        for (ShadingOptions options : {SurfacePreset(), SmoothPreset(2)}) {
            options.weights.exponent = 1.5;
            Surface<double> const surface(shape, options);
            shapes::Random random(9);
            double const h = 1e-5;
            for (int f = 0; f < surface.limit.NumFaces(); ++f) {
                if (surface.limit.FaceSize(f) != 4 && shape.rules.scheme == Sdc::SCHEME_CATMARK) continue;
                for (int i = 0; i < 4; ++i) {
                    // Not across the borders of patches, where second derivatives jump.
                    double const u = (random.Below(8) + random.Uniform(0.1, 0.9)) / 16;
                    double const v = (random.Below(8) + random.Uniform(0.1, 0.9)) / 16;
                    if (u + v < 0.2 || u + v > 0.9) continue;
                    auto const at = [&](double du, double dv) {
                        return surface.limit.Evaluate(f, u + du, v + dv, SurfaceDerivatives::Second);
                    };
                    SurfacePoint<double> const p = at(0, 0), right = at(h, 0), left = at(-h, 0), up = at(0, h),
                                               down = at(0, -h);
                    auto const difference = [&](auto const& a, auto const& b) { return (0.5 / h) * (a - b); };
                    double const scale = 1 + Length(p.du) + Length(p.dv) + Length(p.duu) + Length(p.dvv);
                    // Of second order: h^2 times third derivatives.
                    double const tolerance = 1e-6 * scale;
                    EXPECT_LE(Distance(p.du, difference(right.position, left.position)), tolerance) << shape.name;
                    EXPECT_LE(Distance(p.dv, difference(up.position, down.position)), tolerance) << shape.name;
                    EXPECT_LE(Distance(p.duu, difference(right.du, left.du)), tolerance) << shape.name;
                    EXPECT_LE(Distance(p.duv, difference(up.du, down.du)), tolerance) << shape.name;
                    EXPECT_LE(Distance(p.dvv, difference(up.dv, down.dv)), tolerance) << shape.name;
                    // Where the sum that is normalised is short its derivatives are large.
                    if (Length(Cross(p.du, p.dv)) < 0.1 * Length(p.du) * Length(p.dv) ||
                        Dot(p.limitNormal, p.subdividedNormal) < 0 || (p.blendWeight > 0 && p.blendWeight < 1e-4)) {
                        continue;
                    }
                    double const size = 1e-5 * (1 + Length(p.normalDu) + Length(p.normalDv)) *
                                        (1 + Length(p.normalDu) + Length(p.normalDv)) * scale;
                    EXPECT_LE(Distance(p.normalDu, difference(right.blendedNormal, left.blendedNormal)), size)
                        << shape.name << " " << f << " " << u << " " << v << " b " << p.blendWeight;
                    EXPECT_LE(Distance(p.normalDv, difference(up.blendedNormal, down.blendedNormal)), size)
                        << shape.name << " " << f << " " << u << " " << v << " b " << p.blendWeight;
                }
            }
        }
    }
}

TEST(LimitSurface, IsContinuousAcrossEdgesThatAreNotSharp) {
    std::int64_t numCompared = 0, numSharp = 0;
    for (Shape const& shape : AllShapes()) {
        ShadingOptions options = SurfacePreset();
        options.limits.normals = LimitNormalKind::Exact;
        Surface<double> const surface(shape, options);
        ForEachEdge(surface, shape, [&](auto const& a, auto const& b, bool isSharp, int e, double t) {
            std::string const text = shape.name + ", edge " + std::to_string(e) + " at " + std::to_string(t);
            EXPECT_LE(Distance(a.position, b.position), 1e-12) << text;
            if (isSharp) {
                ++numSharp;
                return;
            }
            // Where nothing degenerates: there two roundings may decide for different fallbacks.
            if (Length(Cross(a.du, a.dv)) < 1e-6 * Length(a.du) * Length(a.dv)) return;
            if (Length(Cross(b.du, b.dv)) < 1e-6 * Length(b.du) * Length(b.dv)) return;
            ++numCompared;
            EXPECT_LE(std::fabs(a.blendWeight - b.blendWeight), 1e-12) << text;
            EXPECT_LE(Distance(a.limitNormal, b.limitNormal), 1e-6) << text;
            EXPECT_LE(Distance(a.blendedNormal, b.blendedNormal), 1e-6) << text;
        });
    }
    EXPECT_GT(numCompared, Fewest(2000));
    EXPECT_GT(numSharp, Fewest(200));
}

TEST(LimitSurface, ComesNearToItsVerticesWithExactLimits) {
    // From 2^-8 down to 2^-44 of a face's size, the position runs into the vertex's own, and never leaves it.
    for (Shape const& shape : AllShapes()) {
        ShadingOptions options = SurfacePreset();
        options.limits.normals = LimitNormalKind::Exact;
        Surface<double> const surface(shape, options);
        double size = 0;
        for (double const x : shape.positions) size = std::max(size, std::fabs(x));
        for (int f = 0; f < surface.limit.NumFaces(); ++f) {
            SurfacePoint<double> const corner = surface.limit.Evaluate(f, 0, 0);
            double last = 4 * size;
            for (int k = 4; k <= 44; k += 4) {
                double const t = std::ldexp(1.0, -k);
                SurfacePoint<double> const p = surface.limit.Evaluate(f, 0.6 * t, 0.35 * t);
                double const distance = Distance(p.position, corner.position);
                EXPECT_LE(distance, last + 1e-15 * size) << shape.name << ", face " << f << ", 2^-" << k;
                last = distance;
                EXPECT_NEAR(Length(p.limitNormal), 1, 1e-12) << shape.name << ", face " << f << ", 2^-" << k;
            }
            // .65^44 is left at the slowest corners of the slowest fans.
            EXPECT_LE(last, 1e-7 * size) << shape.name << ", face " << f;
        }
    }
}

TEST(LimitSurface, IsTheSameWhateverTheThreads) {
    Shape const shape = shapes::RandomShape(5);
    Surface<double> const one(shape, SurfacePreset()), many(shape, SurfacePreset());
    std::vector<std::vector<SurfacePoint<double>>> results(
        4, std::vector<SurfacePoint<double>>(Index(one.limit.NumFaces())));
    std::vector<std::thread> threads;
    for (auto& result : results) {
        threads.emplace_back([&] {
            for (int f = 0; f < many.limit.NumFaces(); ++f) result[Index(f)] = many.limit.Evaluate(f, 0.3, 0.2);
        });
    }
    for (std::thread& thread : threads) thread.join();
    for (int f = 0; f < one.limit.NumFaces(); ++f) {
        SurfacePoint<double> const expected = one.limit.Evaluate(f, 0.3, 0.2);
        for (auto const& result : results) {
            EXPECT_EQ(Distance(result[Index(f)].position, expected.position), 0);
            EXPECT_EQ(Distance(result[Index(f)].blendedNormal, expected.blendedNormal), 0);
        }
    }
    EXPECT_EQ(many.limit.Stats().builtFaces, many.limit.NumFaces());
}

TEST(LimitSurface, GivesNumbersAtRandomPointsOfRandomMeshes) {
    shapes::Random random(11);
    for (std::uint64_t i = 0; i < SampleSize(60); ++i) {
        shapes::RandomShapeOptions const kind = AnyKind(random);
        std::uint64_t const seed = random.Bits();
        Shape const shape = shapes::RandomShape(seed, kind);
        auto const options = ManyOptions();
        auto const& [name, chosen] = options[Index(random.Below(static_cast<int>(options.size())))];
        std::string const text = name + ", seed " + std::to_string(seed);
        try {
            Surface<double> const surface(shape, chosen);
        } catch (InvalidControlMesh const&) {
            continue;  // back to back
        }
        Surface<double> const exact(shape, chosen);
        Surface<float> const rounded(shape, chosen);
        double size = 0;
        for (double const x : shape.positions) size = std::max(size, std::fabs(x));
        for (int f = 0; f < exact.limit.NumFaces(); ++f) {
            for (int k = 0; k < 6; ++k) {
                double const u = random.Uniform(-0.1, 1.6), v = random.Uniform(-0.1, 1.6);
                SurfacePoint<double> const p = exact.limit.Evaluate(f, u, v, SurfaceDerivatives::Second);
                SurfacePoint<float> const q =
                    rounded.limit.Evaluate(f, float(u), float(v), SurfaceDerivatives::Second);
                double const length = Length(p.blendedNormal);
                EXPECT_TRUE(std::fabs(length - 1) < 1e-12 || length == 0) << text;
                EXPECT_TRUE(p.blendWeight >= 0 && p.blendWeight <= 1) << text;
                for (Vec3<double> const& x :
                     {p.position, p.du, p.dv, p.duu, p.duv, p.dvv, p.normalDu, p.normalDv}) {
                    EXPECT_TRUE(std::isfinite(x.x) && std::isfinite(x.y) && std::isfinite(x.z)) << text;
                }
                EXPECT_LE(Distance(p.position, {q.position.x, q.position.y, q.position.z}), 2e-5 * size) << text;
                EXPECT_NEAR(p.blendWeight, q.blendWeight, 1e-4) << text;
            }
        }
    }
}

TEST(LimitSurface, AgreesWithTheUniformResultOnRandomMeshes) {
    shapes::Random random(21);
    std::uint64_t numRefused = 0;
    for (std::uint64_t i = 0; i < SampleSize(60); ++i) {
        shapes::RandomShapeOptions const kind = AnyKind(random);
        std::uint64_t const seed = random.Bits();
        Shape const shape = shapes::RandomShape(seed, kind);
        auto const options = ManyOptions();
        auto const& [name, chosen] = options[Index(random.Below(static_cast<int>(options.size())))];
        Differences d;
        try {
            d = CompareWithUniform(shape, chosen);
        } catch (InvalidControlMesh const&) {
            ++numRefused;  // back to back
            continue;
        }
        std::string const text = name + ", seed " + std::to_string(seed) + ": " + d.where;
        // Chaikin's rule averages sharpness in float, in the order of the edges.
        double const slack = kind.chaikin ? 1e5 : 1;
        EXPECT_LE(d.position, slack * 1e-13) << text;
        EXPECT_LE(d.weight, slack * 1e-12) << text;
        EXPECT_LE(d.limitNormal, slack * 1e-9) << text;
        EXPECT_LE(d.subdivided, slack * 1e-9) << text;
        EXPECT_LE(d.blended, slack * 1e-9) << text;
    }
    EXPECT_LE(numRefused, SampleSize(60) / 10);
}

TEST(LimitSurface, SharesNeighbourhoodsAndTakesOtherPositions) {
    Shape const shape = shapes::QuadGrid(12, 12);
    Surface<double> const surface(shape, SurfacePreset());
    for (int f = 0; f < surface.limit.NumFaces(); ++f) surface.limit.Evaluate(f, 0.5, 0.5);
    EXPECT_EQ(surface.limit.Stats().builtFaces, 144);
    EXPECT_LE(surface.limit.Stats().faceClasses, 7 * 7);  // by the distance from two borders

    std::vector<Vec3<double>> moved = surface.points;
    for (Vec3<double>& p : moved) p = {2 * p.x, 2 * p.y, p.z + 1};
    ShadingInput<double> input;
    input.positions = moved;
    LimitSurface<double> const other = surface.limit.Moved(input);
    SurfacePoint<double> const a = surface.limit.Evaluate(70, 0.3, 0.4), b = other.Evaluate(70, 0.3, 0.4);
    EXPECT_LE(Distance(b.position, {2 * a.position.x, 2 * a.position.y, a.position.z + 1}), 1e-13);
    EXPECT_EQ(other.Stats().builtFaces, 1);
}

TEST(LimitSurface, ChoosesTheLevelAtWhichAllCreasesAreReleased) {
    Shape const cube = shapes::Cube();
    EXPECT_EQ(Surface<double>(cube, SurfacePreset()).limit.Options().level, 1);
    EXPECT_EQ(Surface<double>(shapes::Cube().Crease(0, 1, 2.3F), SurfacePreset()).limit.Options().level, 3);
    EXPECT_EQ(Surface<double>(shapes::Cube().Crease(0, 1), SurfacePreset()).limit.Options().level, 1);
    EXPECT_EQ(Surface<double>(shapes::Cube().Crease(0, 1, 9.5F), SurfacePreset()).limit.Options().level, 10);
    // Where neighbourhoods may have to be refined whole.
    Shape fin = shapes::Cube().Crease(0, 1, 9.5F);
    fin.Vertex(0, 0, 9).Vertex(0, 1, 9).Face({fin.faceVertices[0], fin.faceVertices[1], 8, 9});
    EXPECT_EQ(Surface<double>(fin, SurfacePreset()).limit.Options().level, 6);
    ShadingOptions options = SurfacePreset();
    options.level = 9;
    EXPECT_NE(
        ErrorOf<InvalidOptions>([&] { Surface<double> const surface(fin, options); }).find("at most 8, not 9"),
        std::string::npos);
}

TEST(LimitSurface, RefusesAVertexWhoseRegionHasOneBorderOfItsTwo) {
    // At vertex 1 two faces meet that both end at edge (1, 3) of six faces; the other sharp edge there is (0, 1).
    Shape shape = shapes::Tetrahedron();
    shape.positions = {0, 0, 0, 2, 0, 5.875, 0, 0, 2, 5.3125, 5.3125, 5.3125};
    shape.rules.boundary = Sdc::Options::VTX_BOUNDARY_NONE;
    shape.SetFaces({{0, 3, 1, 2}, {3, 1, 0}, {2, 1, 3}, {3, 1, 2}, {1, 3, 0}, {3, 0, 2, 1}});
    ShadingOptions const options = SurfacePreset();
    EXPECT_NE(ErrorOf<InvalidControlMesh>([&] {
                  Surface<double> const surface(shape, options);
              }).find("begin and end at the same non-manifold edge (vertices "),
              std::string::npos);
    // Triangles of Loop back to back are the other kind that is refused.
    Shape twins = shapes::Tetrahedron();
    twins.SetFaces({{0, 1, 2}, {0, 2, 1}});
    EXPECT_NO_THROW(Surface<double>(twins, options));
    twins.rules.scheme = Sdc::SCHEME_LOOP;
    EXPECT_EQ(
        ErrorOf<InvalidControlMesh>([&] { Surface<double> const surface(twins, options); }),
        "faces 0 and 1 share two edges, and a limit surface can't tell their sides apart; use ShadeSubdivision");
    // Fins and books of faces have none such.
    for (Shape const& other : AllShapes()) {
        SCOPED_TRACE(other.name);
        EXPECT_NO_THROW(Surface<double>(other, options));
    }
}

TEST(LimitSurface, RefusesInWordsWhatOnlyAMeshHas) {
    Shape const cube = shapes::Cube();
    auto const wordsOf = [&](auto const& change) {
        ShadingOptions options = SurfacePreset();
        change(options);
        return ErrorOf<InvalidOptions>([&] { Surface<double> const surface(cube, options); });
    };
    EXPECT_NE(
        wordsOf([](ShadingOptions& o) { o.limits.positions = PositionKind::Refined; }).find("limit positions"),
        std::string::npos);
    EXPECT_NE(wordsOf([](ShadingOptions& o) { o.limits.normals = LimitNormalKind::FaceAverage; }).find("no faces"),
              std::string::npos);
    EXPECT_NE(wordsOf([](ShadingOptions& o) { o.weights.scheme = WeightScheme::Bilinear; }).find("no limit"),
              std::string::npos);
    EXPECT_NE(wordsOf([](ShadingOptions& o) { o.weights.scheme = WeightScheme::InverseLimit; }).find("whole mesh"),
              std::string::npos);
    EXPECT_NE(wordsOf([](ShadingOptions& o) {
                  o.subdividedNormals.averaging = NormalAveraging::Spherical;
              }).find("linear"),
              std::string::npos);
    EXPECT_NE(wordsOf([](ShadingOptions& o) { o.level = 11; }).find("at most 10"), std::string::npos);
    EXPECT_NE(wordsOf([](ShadingOptions& o) { o.level = -2; }).find("0 to 15"), std::string::npos);
    Surface<double> const surface(cube, SurfacePreset());
    EXPECT_NE(ErrorOf<InvalidOptions>([&] { surface.limit.Evaluate(6, 0, 0); }).find("face 6"), std::string::npos);
    EXPECT_NE(ErrorOf<InvalidOptions>([&] { surface.limit.Evaluate(-1, 0, 0); }).find("face -1"),
              std::string::npos);
    // Parameters are moved into the face.
    double const nan = std::nan("");
    EXPECT_EQ(Distance(surface.limit.Evaluate(0, nan, -3).position, surface.limit.Evaluate(0, 0, 0).position), 0);
    EXPECT_EQ(Distance(surface.limit.Evaluate(0, 1e300, 7).position, surface.limit.Evaluate(0, 1, 1).position), 0);
}

}  // namespace
