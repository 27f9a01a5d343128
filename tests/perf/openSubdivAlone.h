// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/topologyDescriptor.h>

#include <memory>
#include <vector>

#include "osd_shading/controlMesh.h"
#include "osd_shading/views.h"

namespace perf {

namespace Far = OpenSubdiv::OPENSUBDIV_VERSION::Far;
namespace Sdc = osd_shading::Sdc;

/// A point as OpenSubdiv's own tutorials write it: not set to zero when it is made, since `Clear` comes first.
template <typename Real>
struct OpenSubdivPoint {
    OpenSubdivPoint() {}

    void Clear() { x = y = z = 0; }
    void AddWithWeight(OpenSubdivPoint const& other, Real weight) {
        x += weight * other.x;
        y += weight * other.y;
        z += weight * other.z;
    }

    Real x, y, z;
};

/// OpenSubdiv's refiner of `mesh`, not refined.
inline std::unique_ptr<Far::TopologyRefiner> MakeRefiner(osd_shading::ControlMesh const& mesh) {
    Far::TopologyDescriptor descriptor;
    descriptor.numVertices = mesh.numVertices;
    descriptor.numFaces = static_cast<int>(mesh.faceSizes.size());
    descriptor.numVertsPerFace = mesh.faceSizes.data();
    descriptor.vertIndicesPerFace = mesh.faceVertices.data();
    descriptor.numCreases = static_cast<int>(mesh.creaseSharpness.size());
    descriptor.creaseVertexIndexPairs = mesh.creaseVertices.data();
    descriptor.creaseWeights = mesh.creaseSharpness.data();
    descriptor.numCorners = static_cast<int>(mesh.cornerSharpness.size());
    descriptor.cornerVertexIndices = mesh.cornerVertices.data();
    descriptor.cornerWeights = mesh.cornerSharpness.data();
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(mesh.rules.boundary);
    options.SetCreasingMethod(mesh.rules.creasing);
    options.SetTriangleSubdivision(mesh.rules.triangles);
    using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
    return std::unique_ptr<Far::TopologyRefiner>(
        Factory::Create(descriptor, Factory::Options(mesh.rules.scheme, options)));
}

/// What OpenSubdiv gives without shading: limit points and two tangents at each vertex of the last level.
template <typename Real>
struct OpenSubdivLimits {
    std::vector<OpenSubdivPoint<Real>> points, tangents1, tangents2;
};

/// The yardstick: OpenSubdiv's create, RefineUniform, Interpolate through all levels, and Limit.
///
/// As lean as a user would write it: only two levels of points are held at a time.
template <typename Real>
OpenSubdivLimits<Real> RunOpenSubdiv(osd_shading::ControlMesh const& mesh, std::vector<Real> const& positions,
                                     int level) {
    std::unique_ptr<Far::TopologyRefiner> const refiner = MakeRefiner(mesh);
    Far::TopologyRefiner::UniformOptions uniform(level);
    uniform.fullTopologyInLastLevel = true;
    refiner->RefineUniform(uniform);

    Far::PrimvarRefinerReal<Real> const primvars(*refiner);
    std::vector<OpenSubdivPoint<Real>> points(static_cast<std::size_t>(mesh.numVertices));
    for (std::size_t i = 0; i < points.size(); ++i) {
        points[i].x = positions[3 * i];
        points[i].y = positions[3 * i + 1];
        points[i].z = positions[3 * i + 2];
    }
    for (int i = 1; i <= level; ++i) {
        std::vector<OpenSubdivPoint<Real>> next(static_cast<std::size_t>(refiner->GetLevel(i).GetNumVertices()));
        primvars.Interpolate(i, points, next);
        points.swap(next);
    }

    OpenSubdivLimits<Real> limits;
    limits.points.resize(points.size());
    limits.tangents1.resize(points.size());
    limits.tangents2.resize(points.size());
    primvars.Limit(points, limits.points, limits.tangents1, limits.tangents2);
    return limits;
}

}  // namespace perf
