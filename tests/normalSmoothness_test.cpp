// SPDX-License-Identifier: Apache-2.0

// How smooth normals are round extraordinary vertices: first-order, or not.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "osd_shading/limitSurface.h"
#include "osd_shading/vectorMath.h"
#include "tests/testHelpers.h"

namespace {

using namespace osd_shading;
using namespace osd_shading::tests;

constexpr double kPi = 3.14159265358979323846;

/// A vertex of valence n with three rings of regular faces round it, all points moved a little.
Shape Star(bool isCatmark, int n) {
    Shape shape;
    shape.Vertex(0, 0, 0);
    // Ring r of sector s: points along its first edge, and between its two edges.
    constexpr int kRings = 3;
    std::vector<std::vector<std::vector<int>>> at(static_cast<std::size_t>(n));
    for (int s = 0; s < n; ++s) {
        double const a = 2 * kPi * s / n, b = 2 * kPi * (s + 1) / n;
        auto& sector = at[static_cast<std::size_t>(s)];
        sector.resize(kRings + 1, std::vector<int>(kRings + 1, 0));
        for (int i = 1; i <= kRings; ++i) {
            for (int j = 0; j <= (isCatmark ? kRings : kRings - i); ++j) {
                double const x = i * std::cos(a) + j * std::cos(b), y = i * std::sin(a) + j * std::sin(b);
                sector[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = shape.NumVertices();
                shape.Vertex(x, y, 0.15 * (x * x - 0.5 * y * y) + 0.1 * x * y);
            }
        }
    }
    auto const vertex = [&](int s, int i, int j) {
        // Its second edge is the next sector's first.
        if (i == 0 && j > 0) return at[static_cast<std::size_t>((s + 1) % n)][static_cast<std::size_t>(j)][0];
        return at[static_cast<std::size_t>(s % n)][static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
    };
    // Faces 0 to n - 1 are those at the vertex, each from it on.
    std::vector<std::vector<int>> others;
    for (int s = 0; s < n; ++s) {
        for (int i = 0; i < kRings; ++i) {
            for (int j = 0; j < kRings; ++j) {
                if (isCatmark) {
                    std::vector<int> const face{vertex(s, i, j), vertex(s, i + 1, j), vertex(s, i + 1, j + 1),
                                                vertex(s, i, j + 1)};
                    if (i == 0 && j == 0) {
                        shape.Face(face);
                    } else {
                        others.push_back(face);
                    }
                    continue;
                }
                if (i + j >= kRings) continue;
                std::vector<int> const face{vertex(s, i, j), vertex(s, i + 1, j), vertex(s, i, j + 1)};
                if (i == 0 && j == 0) {
                    shape.Face(face);
                } else {
                    others.push_back(face);
                }
                if (i + j + 1 < kRings) {
                    others.push_back({vertex(s, i + 1, j), vertex(s, i + 1, j + 1), vertex(s, i, j + 1)});
                }
            }
        }
    }
    for (std::vector<int> const& face : others) shape.Face(face);
    if (!isCatmark) shape.rules.scheme = Sdc::SCHEME_LOOP;
    return shape.Jitter(0.1, static_cast<std::uint32_t>(n));
}

/// How far the derivatives of a normal, by the characteristic parametrisation, differ round a vertex: what is left
/// of a linear fit to the normal at points that are some `radius` away, over the largest change that it explains.
struct Disagreement {
    double limit = 0, blended = 0;
};
Disagreement MeasureAround(LimitSurface<double> const& surface, int n, int depth) {
    // Near the vertex the surface is, in its tangent plane, the characteristic map to first order.
    SurfacePoint<double> const center = surface.Evaluate(0, 0, 0);
    Vec3<double> const axisX = Normalized(center.du), axisY = Cross(center.limitNormal, axisX);
    struct Sample {
        double x, y;
        Vec3<double> limit, blended;
    };
    std::vector<Sample> samples;
    for (int face = 0; face < n; ++face) {
        for (double const share : {0.1, 0.35, 0.6, 0.85}) {
            double const size = std::ldexp(0.7, -depth);
            SurfacePoint<double> const p = surface.Evaluate(face, size * (1 - share), size * share);
            Vec3<double> const side = p.position - center.position;
            samples.push_back({Dot(side, axisX), Dot(side, axisY), p.limitNormal - center.limitNormal,
                               p.blendedNormal - center.blendedNormal});
        }
    }
    double xx = 0, xy = 0, yy = 0;
    for (Sample const& s : samples) {
        xx += s.x * s.x;
        xy += s.x * s.y;
        yy += s.y * s.y;
    }
    double const determinant = xx * yy - xy * xy;
    auto const leftOver = [&](auto const& change) {
        Vec3<double> bx{}, by{};
        for (Sample const& s : samples) {
            bx += s.x * change(s);
            by += s.y * change(s);
        }
        Vec3<double> const a = (1 / determinant) * (yy * bx - xy * by), b = (1 / determinant) * (xx * by - xy * bx);
        double largest = 0, explained = 0;
        for (Sample const& s : samples) {
            Vec3<double> const linear = s.x * a + s.y * b;
            largest = std::max(largest, Length(change(s) - linear));
            explained = std::max(explained, Length(linear));
        }
        return largest / explained;
    };
    return {leftOver([](Sample const& s) { return s.limit; }), leftOver([](Sample const& s) { return s.blended; })};
}

TEST(NormalSmoothness, BlendedNormalsHaveOneDerivativeAtExtraordinaryVerticesAndLimitNormalsNone) {
    std::printf("%-14s %7s | %10s %10s %10s | %10s %10s %10s\n", "disagreement", "of", "N_L", "", "", "N_B", "",
                "");
    std::printf("%-14s %7s | %10s %10s %10s | %10s %10s %10s\n", "of derivatives", "valence", "at 1e-2", "1e-4",
                "1e-6", "at 1e-2", "1e-4", "1e-6");
    for (bool const isCatmark : {true, false}) {
        for (int n = 3; n <= 12; ++n) {
            Shape const shape = Star(isCatmark, n);
            std::vector<Vec3<double>> const points = PointsOf<double>(shape);
            ShadingInput<double> input;
            input.positions = points;
            LimitSurface<double> const surface(shape.Mesh(), input);
            ASSERT_NEAR(surface.Evaluate(0, 0, 0).blendWeight, n == (isCatmark ? 4 : 6) ? 0 : 1, 1e-12);
            // By the subdominant eigenvalue: how many levels make a radius.
            double const c = std::cos(2 * kPi / n);
            double const lambda = isCatmark ? (c + 5 + std::sqrt((c + 1) * (c + 9))) / 16 : (3 + 2 * c) / 8;
            Disagreement found[3];
            for (int i = 0; i < 3; ++i) {
                int const depth =
                    static_cast<int>(std::lround(std::log(std::pow(10, -2 * (i + 1))) / std::log(lambda)));
                found[i] = MeasureAround(surface, n, depth);
            }
            std::printf("%-14s %7d | %10.2g %10.2g %10.2g | %10.2g %10.2g %10.2g\n",
                        isCatmark ? "Catmull-Clark" : "Loop", n, found[0].limit, found[1].limit, found[2].limit,
                        found[0].blended, found[1].blended, found[2].blended);
            std::string const text = (isCatmark ? "Catmull-Clark, valence " : "Loop, valence ") + std::to_string(n);
            // N_B: the next eigenvalue is smaller by a tenth and more, some 27 levels further.
            EXPECT_LE(found[2].blended, 0.1) << text;
            EXPECT_LE(found[2].blended, 0.75 * found[0].blended) << text;
            // N_L: what is not linear does not get less, but in regular meshes.
            if (n == (isCatmark ? 4 : 6)) {
                EXPECT_LE(found[2].limit, 1e-3) << text;
                continue;
            }
            EXPECT_GE(found[2].limit, 40 * found[2].blended) << text;
            // In Loop's of valence 4 and 5 the linear part grows by a constant a level: there 1/level is left.
            if (isCatmark || (n != 4 && n != 5)) {
                EXPECT_GE(found[2].limit, 0.5 * found[0].limit) << text;
            }
        }
    }
}

}  // namespace
