// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/startNormals.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "osd_shading/extraordinaryVertices.h"
#include "osd_shading/vectorMath.h"

namespace osd_shading {
inline namespace v1 {

namespace {

template <typename Real>
std::int64_t countZero(std::vector<Vec3<Real>> const& normals) {
    return std::count_if(normals.begin(), normals.end(), [](Vec3<Real> const& n) { return IsZero(n); });
}

/// Replaces the normals round extraordinary vertices that are not sharp by their limit, all at the same time.
template <typename Real>
void smoothOnce(LimitStep<Real> const& step, std::vector<Vec3<Real>>& normals, int numThreads) {
    ValueMarks const marks = MarkSmoothed(step);
    // Limit weights are positive and add to one: a sum of unit normals vanishes against 1.
    std::vector<Vec3<Real>> smoothed = normals;
    step.Apply(normals, smoothed, marks, numThreads);
    for (std::size_t value = 0; value < normals.size(); ++value) {
        if (marks[value]) normals[value] = NormalizedSum(smoothed[value], Real(1));
    }
}

}  // namespace

template <typename Real>
ValueMarks MarkSmoothed(LimitStep<Real> const& step) {
    CreaseRegions const& regions = step.Regions();
    Far::TopologyLevel const& level = step.Level();
    ValueMarks marks(static_cast<std::size_t>(regions.NumValues()), 0);
    for (int v = 0; v < regions.NumVertices(); ++v) {
        if (regions.IsSharp(v) || !IsExtraordinary(step.Topology(), level, v)) continue;
        for (int const face : level.GetVertexFaces(v)) {
            for (int const u : level.GetFaceVertices(face)) {
                if (!regions.IsSharp(u)) marks[static_cast<std::size_t>(regions.FirstValue(u))] = 1;
            }
        }
    }
    return marks;
}

FaceWeight FaceWeightOf(StartNormalKind kind) {
    switch (kind) {
        case StartNormalKind::CornerArea:
            return FaceWeight::CornerArea;
        case StartNormalKind::Angle:
            return FaceWeight::Angle;
        default:
            return FaceWeight::Uniform;
    }
}

template <typename Real>
StartNormals<Real> ComputeStartNormals(StartNormalKind kind, RefinedTopology const& topology, int level,
                                       CreaseRegions const& regions, std::vector<Vec3<Real>> const& points,
                                       int numThreads) {
    StartNormals<Real> start;
    if (kind == StartNormalKind::Limit || kind == StartNormalKind::LimitSmoothed) {
        LimitStep<Real> const step(topology, level, regions, numThreads);
        start.normals = ComputeLimitNormals(step, points, numThreads).normals;
        if (kind == StartNormalKind::LimitSmoothed) smoothOnce(step, start.normals, numThreads);
    } else {
        start.normals = AverageFaceNormals(topology.Level(level), regions, points, FaceWeightOf(kind), numThreads);
    }
    start.numZero = countZero(start.normals);
    return start;
}

template <typename Real>
StartNormals<Real> GatherUserNormals(RefinedTopology const& topology, CreaseRegions const& regions,
                                     PointView<Real> vertexNormals, PointView<Real> faceVaryingNormals) {
    Far::TopologyLevel const& level = topology.Level(0);
    auto const numValues = static_cast<std::size_t>(regions.NumValues());
    StartNormals<Real> start;
    start.normals.resize(numValues);
    std::vector<Real> added(numValues, 0);
    // Scaled, so that sums of huge normals stay numbers.
    PointView<Real> const& given = vertexNormals.empty() ? faceVaryingNormals : vertexNormals;
    Real largest = 0;
    for (std::size_t i = 0; i < given.size(); ++i) {
        Vec3<Real> const n = given[i];
        largest = std::fmax(largest, std::fmax(std::fabs(n.x), std::fmax(std::fabs(n.y), std::fabs(n.z))));
    }
    Real const scale = largest > 0 ? 1 / std::fmax(largest, std::numeric_limits<Real>::min()) : Real(1);
    std::size_t corner = 0;
    for (int f = 0; f < level.GetNumFaces(); ++f) {
        Far::ConstIndexArray const vertices = level.GetFaceVertices(f);
        for (int i = 0; i < vertices.size(); ++i, ++corner) {
            Vec3<Real> const normal =
                scale * given[vertexNormals.empty() ? corner : static_cast<std::size_t>(vertices[i])];
            auto const value = static_cast<std::size_t>(regions.CornerValue(f, i));
            start.normals[value] += normal;
            added[value] += Length(normal);
        }
    }
    for (std::size_t value = 0; value < numValues; ++value) {
        start.normals[value] = NormalizedSum(start.normals[value], added[value]);
    }
    start.numZero = countZero(start.normals);
    return start;
}

#define OSD_SHADING_INSTANTIATE(Real)                                                                            \
    template StartNormals<Real> ComputeStartNormals(StartNormalKind, RefinedTopology const&, int,                \
                                                    CreaseRegions const&, std::vector<Vec3<Real>> const&, int);  \
    template ValueMarks MarkSmoothed(LimitStep<Real> const&);                                                    \
    template StartNormals<Real> GatherUserNormals(RefinedTopology const&, CreaseRegions const&, PointView<Real>, \
                                                  PointView<Real>);
OSD_SHADING_INSTANTIATE(float)
OSD_SHADING_INSTANTIATE(double)
#undef OSD_SHADING_INSTANTIATE

}  // namespace v1
}  // namespace osd_shading
