// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/limitSurface.h"

#include <gtest/gtest.h>
#include <opensubdiv/bfr/parameterization.h>
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
#include "tests/testHelpers.h"

namespace {

namespace Bfr = OpenSubdiv::OPENSUBDIV_VERSION::Bfr;
using namespace osd_shading;
using namespace osd_shading::tests;

std::size_t Index(int i) { return static_cast<std::size_t>(i); }

/// A shape with its surface.
template <typename Real>
struct Surface {
    std::vector<Vec3<Real>> points;
    std::vector<Vec3<Real>> normals;  // per vertex, where the options ask for them
    LimitSurface<Real> limit;

    Surface(Shape const& shape, ShadingOptions const& options)
        : points(PointsOf<Real>(shape)), normals(points), limit(shape.Mesh(), Input(options), options) {}
    ShadingInput<Real> Input(ShadingOptions const& options) const {
        ShadingInput<Real> input;
        input.positions = points;
        if (options.startNormals.kind == StartNormalKind::User) input.vertexNormals = normals;
        return input;
    }
};

/// Where the corners of the last level's faces lie on the control faces.
struct Location {
    int face;
    double u, v;
};
std::vector<Location> LocationsOf(RefinedTopology const& topology) {
    struct Corners {
        int base;
        double at[4][2];
    };
    int const size = topology.IsCatmark() ? 4 : 3;
    std::vector<Corners> here, next;
    for (int f = 0; f < topology.Level(0).GetNumFaces(); ++f) {
        Corners corners{f, {}};
        int const numVertices = topology.Level(0).GetFaceVertices(f).size();
        Bfr::Parameterization const parametrization(topology.Scheme(), numVertices);
        for (int i = 0; i < size && !parametrization.HasSubFaces(); ++i) {
            parametrization.GetVertexCoord(i, corners.at[i]);
        }
        here.push_back(corners);
    }
    for (int level = 0; level < topology.LastLevel(); ++level) {
        next.assign(Index(topology.Level(level + 1).GetNumFaces()), {});
        for (int f = 0; f < topology.Level(level).GetNumFaces(); ++f) {
            Far::ConstIndexArray const children = topology.Level(level).GetFaceChildFaces(f);
            int const numVertices = topology.Level(level).GetFaceVertices(f).size();
            Bfr::Parameterization const parametrization(topology.Scheme(), numVertices);
            Corners const& parent = here[Index(f)];
            for (int c = 0; c < children.size(); ++c) {
                Corners& child = next[Index(children[c])];
                child.base = parent.base;
                if (parametrization.HasSubFaces()) {
                    double const square[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
                    for (int i = 0; i < 4; ++i) {
                        parametrization.ConvertNormalizedSubFaceToCoord(c, square[i], child.at[i]);
                    }
                    continue;
                }
                auto const middle = [&](int i, int j, double (&at)[2]) {
                    at[0] = (parent.at[i][0] + parent.at[j][0]) / 2;
                    at[1] = (parent.at[i][1] + parent.at[j][1]) / 2;
                };
                if (size == 3 && c == 3) {
                    middle(1, 2, child.at[0]);
                    middle(2, 0, child.at[1]);
                    middle(0, 1, child.at[2]);
                    continue;
                }
                for (int i = 0; i < size; ++i) {
                    if (size == 4 && (i + 2) % 4 == c) {
                        middle(0, 2, child.at[i]);
                    } else {
                        middle(c, i, child.at[i]);
                    }
                }
            }
        }
        here.swap(next);
    }
    std::vector<Location> locations;
    for (Corners const& corners : here) {
        for (int i = 0; i < size; ++i) locations.push_back({corners.base, corners.at[i][0], corners.at[i][1]});
    }
    return locations;
}

/// Largest differences from the uniform result at the points of the last level.
struct Differences {
    double position = 0, limitNormal = 0, subdivided = 0, blended = 0, weight = 0;
    std::string where;
};
Differences CompareWithUniform(Shape const& shape, ShadingOptions const& options) {
    Surface<double> const surface(shape, options);
    ShadingResult<double> const result =
        ShadeSubdivision(shape.Mesh(), surface.Input(options), surface.limit.Options());
    RefinedTopology const topology(shape.Mesh(), surface.limit.Options().level);
    std::vector<Location> const locations = LocationsOf(topology);
    CreaseRegions const regions(topology, topology.LastLevel(), 1);
    Differences differences;
    double size = 0;
    for (double const x : shape.positions) size = std::max(size, std::fabs(x));
    for (std::size_t i = 0; i < locations.size(); ++i) {
        SurfacePoint<double> const point =
            surface.limit.Evaluate(locations[i].face, locations[i].u, locations[i].v);
        auto const value = Index(regions.CornerValues()[i]);
        auto const vertex = Index(result.valueVertices[value]);
        auto const note = [&](double& largest, double difference, char const* what) {
            if (difference > 1e-10) {
                differences.where = std::string(what) + " at face " + std::to_string(locations[i].face) + " (" +
                                    std::to_string(locations[i].u) + ", " + std::to_string(locations[i].v) +
                                    "), kind " + std::to_string(int(result.vertexTags[vertex].kind)) + " valence " +
                                    std::to_string(result.vertexTags[vertex].valence);
            }
            largest = std::max(largest, difference);
        };
        note(differences.position, Distance(point.position, result.positions[vertex]) / size, "position");
        note(differences.weight, std::fabs(point.blendWeight - result.blendWeights[value]), "weight");
        note(differences.limitNormal, Distance(point.limitNormal, result.limitNormals[value]), "N_L");
        if (result.blendWeights[value] > 1e-12) {
            note(differences.subdivided, Distance(point.subdividedNormal, result.subdividedNormals[value]), "N_S");
        }
        note(differences.blended, Distance(point.blendedNormal, result.blendedNormals[value]), "N_B");
    }
    return differences;
}

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
    for (Shape const& shape : AllShapes()) {
        for (auto const& [name, options] : ManyOptions()) {
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

}  // namespace
