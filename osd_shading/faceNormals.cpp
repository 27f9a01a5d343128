// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/faceNormals.h"

#include <cmath>

#include "osd_shading/parallel.h"
#include "osd_shading/vectorMath.h"

namespace osd_shading {
inline namespace v1 {

namespace {

/// The sides of a face's corner.
template <typename Real>
struct CornerSides {
    Vec3<Real> after, before;

    CornerSides(std::vector<Vec3<Real>> const& points, PolygonCorner const& at) {
        Far::ConstIndexArray const& vertices = at.vertices;
        int const size = vertices.size();
        Vec3<Real> const p = points[static_cast<std::size_t>(vertices[at.corner])];
        after = points[static_cast<std::size_t>(vertices[(at.corner + 1) % size])] - p;
        before = points[static_cast<std::size_t>(vertices[(at.corner + size - 1) % size])] - p;
    }
};

}  // namespace

template <typename Real>
void WeighCorners(std::vector<Vec3<Real>> const& points, FaceWeight weight,
                  std::vector<PolygonCorner> const& corners, std::vector<Real>& weights) {
    weights.assign(corners.size(), Real(1));
    if (weight == FaceWeight::Uniform) return;
    // Areas are taken at the size of the longest side: those of tiny or huge faces leave the range of numbers.
    Real longest = 0;
    for (std::size_t i = 0; i < corners.size() && weight == FaceWeight::CornerArea; ++i) {
        CornerSides<Real> const sides(points, corners[i]);
        longest = std::fmax(longest, std::fmax(Length(sides.after), Length(sides.before)));
    }
    auto const scaled = [](Vec3<Real> const& a, Real size) {
        return size > 0 ? Vec3<Real>{a.x / size, a.y / size, a.z / size} : a;
    };
    for (std::size_t i = 0; i < corners.size(); ++i) {
        CornerSides<Real> const sides(points, corners[i]);
        Vec3<Real> const after = weight == FaceWeight::CornerArea ? scaled(sides.after, longest) : sides.after;
        Vec3<Real> const before = weight == FaceWeight::CornerArea ? scaled(sides.before, longest) : sides.before;
        weights[i] = std::fmax(CornerWeight(weight, after, before), LeastWeight(weight, Real(1)));
    }
}

template <typename Real>
Vec3<Real> UnitFaceNormal(Far::TopologyLevel const& level, std::vector<Vec3<Real>> const& points, int face) {
    return UnitFaceNormal(points, level.GetFaceVertices(face));
}

template <typename Real>
Vec3<Real> UnitFaceNormal(std::vector<Vec3<Real>> const& points, Far::ConstIndexArray const& vertices) {
    return UnitPolygonNormal<Real>(vertices.size(),
                                   [&](int i) { return points[static_cast<std::size_t>(vertices[i])]; });
}

template <typename Real>
Vec3<Real> AverageFaceNormal(Far::TopologyLevel const& level, std::vector<Vec3<Real>> const& points,
                             RegionFan const& fan) {
    NormalSum<Real> sum;
    for (int const face : fan.faces) sum.Add(UnitFaceNormal(level, points, face), Real(1));
    return sum.Unit();
}

template <typename Real>
std::vector<Vec3<Real>> AverageFaceNormals(Far::TopologyLevel const& level, CreaseRegions const& regions,
                                           std::vector<Vec3<Real>> const& points, FaceWeight weight,
                                           int numThreads) {
    std::vector<Vec3<Real>> faceNormals(static_cast<std::size_t>(level.GetNumFaces()));
    ParallelFor(level.GetNumFaces(), numThreads, [&](int begin, int end, int) {
        for (int f = begin; f < end; ++f) {
            faceNormals[static_cast<std::size_t>(f)] = UnitFaceNormal(level, points, f);
        }
    });
    std::vector<Vec3<Real>> normals(static_cast<std::size_t>(regions.NumValues()));
    ParallelFor(regions.NumVertices(), numThreads, [&](int begin, int end, int) {
        std::vector<NormalSum<Real>> sums;
        std::vector<PolygonCorner> faceCorners;
        std::vector<Real> weights;
        for (int v = begin; v < end; ++v) {
            int const first = regions.FirstValue(v);
            sums.assign(static_cast<std::size_t>(regions.NumVertexValues(v)), {});
            Far::ConstIndexArray const faces = level.GetVertexFaces(v);
            Far::ConstLocalIndexArray const corners = level.GetVertexFaceLocalIndices(v);
            faceCorners.clear();
            for (int i = 0; i < faces.size(); ++i) {
                faceCorners.push_back({level.GetFaceVertices(faces[i]), corners[i]});
            }
            WeighCorners(points, weight, faceCorners, weights);
            for (int i = 0; i < faces.size(); ++i) {
                sums[static_cast<std::size_t>(regions.CornerValue(faces[i], corners[i]) - first)].Add(
                    faceNormals[static_cast<std::size_t>(faces[i])], weights[static_cast<std::size_t>(i)]);
            }
            for (std::size_t i = 0; i < sums.size(); ++i) {
                normals[static_cast<std::size_t>(first) + i] = sums[i].Unit();
            }
        }
    });
    return normals;
}

#define OSD_SHADING_INSTANTIATE(Real)                                                                         \
    template Vec3<Real> UnitFaceNormal(Far::TopologyLevel const&, std::vector<Vec3<Real>> const&, int);       \
    template Vec3<Real> UnitFaceNormal(std::vector<Vec3<Real>> const&, Far::ConstIndexArray const&);          \
    template void WeighCorners(std::vector<Vec3<Real>> const&, FaceWeight, std::vector<PolygonCorner> const&, \
                               std::vector<Real>&);                                                           \
    template Vec3<Real> AverageFaceNormal(Far::TopologyLevel const&, std::vector<Vec3<Real>> const&,          \
                                          RegionFan const&);                                                  \
    template std::vector<Vec3<Real>> AverageFaceNormals(Far::TopologyLevel const&, CreaseRegions const&,      \
                                                        std::vector<Vec3<Real>> const&, FaceWeight, int);
OSD_SHADING_INSTANTIATE(float)
OSD_SHADING_INSTANTIATE(double)
#undef OSD_SHADING_INSTANTIATE

}  // namespace v1
}  // namespace osd_shading
