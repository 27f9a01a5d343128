// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opensubdiv/bfr/parameterization.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "osd_shading/limitSurface.h"
#include "osd_shading/subdivisionShading.h"
#include "osd_shading/vectorMath.h"
#include "tests/faceLocations.h"
#include "tests/testHelpers.h"

/// A limit surface beside uniform shading, and from both sides of its edges.
namespace osd_shading::tests {

namespace Bfr = OpenSubdiv::OPENSUBDIV_VERSION::Bfr;

/// A shape with its surface.
template <typename Real>
struct Surface {
    std::vector<Vec3<Real>> points;
    std::vector<Vec3<Real>> normals;  ///< where the options ask for the caller's: per vertex, or
    bool areByCorner;                 ///< per face corner
    LimitSurface<Real> limit;

    Surface(Shape const& shape, ShadingOptions const& options, bool byCorner = false)
        : points(PointsOf<Real>(shape)),
          normals(byCorner ? cornerNormals(shape) : points),
          areByCorner(byCorner),
          limit(shape.Mesh(), Input(options), options) {}
    ShadingInput<Real> Input(ShadingOptions const& options) const {
        ShadingInput<Real> input;
        input.positions = points;
        if (options.startNormals.kind == StartNormalKind::User) {
            (areByCorner ? input.faceVaryingNormals : input.vertexNormals) = normals;
        }
        return input;
    }

private:
    static std::vector<Vec3<Real>> cornerNormals(Shape const& shape) {
        shapes::Random random(8);
        std::vector<Vec3<Real>> normals;
        for (std::size_t i = 0; i < shape.faceVertices.size(); ++i) {
            normals.push_back({static_cast<Real>(random.Uniform(-1, 1)), static_cast<Real>(random.Uniform(-1, 1)),
                               static_cast<Real>(random.Uniform(0, 2))});
        }
        return normals;
    }
};

/// Largest differences from the uniform result at the points of the last level, or of one `levelsBelow` further
/// down.
struct Differences {
    double position = 0, limitNormal = 0, subdivided = 0, blended = 0, weight = 0;
    std::string where;
};
inline Differences CompareWithUniform(Shape const& shape, ShadingOptions const& options, int levelsBelow = 0,
                                      bool byCorner = false) {
    Surface<double> const surface(shape, options, byCorner);
    ShadingOptions uniform = surface.limit.Options();
    uniform.level += levelsBelow;
    ShadingResult<double> const result = ShadeSubdivision(shape.Mesh(), surface.Input(options), uniform);
    RefinedTopology const topology(shape.Mesh(), uniform.level);
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
        // Fallbacks are those of the last level's mesh there, and of larger faces here; and N_S is not at hand
        // where b is zero.
        double const lengths = Length(point.du) * Length(point.dv);
        if (!(IsZero(point.du) && IsZero(point.dv)) &&
            Length(Cross(point.du, point.dv)) <= std::max(1e-6 * lengths, 1e-9 * size * size)) {
            continue;
        }
        if (IsZero(point.limitNormal) != IsZero(result.limitNormals[value])) continue;
        note(differences.limitNormal, Distance(point.limitNormal, result.limitNormals[value]), "N_L");
        // Where a sum of normals vanishes but for rounding, one may be zero.
        bool const hasWeight = result.blendWeights[value] > 1e-12;
        if (hasWeight && IsZero(point.subdividedNormal) != IsZero(result.subdividedNormals[value])) continue;
        if (hasWeight) {
            note(differences.subdivided, Distance(point.subdividedNormal, result.subdividedNormals[value]), "N_S");
        }
        note(differences.blended, Distance(point.blendedNormal, result.blendedNormals[value]), "N_B");
    }
    return differences;
}

/// Calls `visit(a, b, isSharp, edge, t)` with the points of the two faces at points of each edge between two faces.
template <typename Visit>
void ForEachEdge(Surface<double> const& surface, Shape const& shape, Visit const& visit) {
    RefinedTopology const topology(shape.Mesh(), 0);
    Far::TopologyLevel const& level = topology.Level(0);
    for (int e = 0; e < level.GetNumEdges(); ++e) {
        Far::ConstIndexArray const faces = level.GetEdgeFaces(e);
        if (faces.size() != 2 || level.IsEdgeNonManifold(e)) continue;
        for (double const t : {0.0, 1e-6, 0.03, 0.25, 0.5, 0.7, 1 - 1e-9}) {
            SurfacePoint<double> points[2];
            for (int side = 0; side < 2; ++side) {
                int const face = faces[side], edge = level.GetFaceEdges(face).FindIndex(e);
                Far::ConstIndexArray const vertices = level.GetFaceVertices(face);
                bool const isForward = vertices[edge] == level.GetEdgeVertices(e)[0];
                double uv[2];
                Bfr::Parameterization(topology.Scheme(), vertices.size())
                    .GetEdgeCoord(edge, isForward ? t : 1 - t, uv);
                points[side] = surface.limit.Evaluate(face, uv[0], uv[1]);
            }
            visit(points[0], points[1], level.GetEdgeSharpness(e) > 0, e, t);
        }
    }
}

}  // namespace osd_shading::tests
