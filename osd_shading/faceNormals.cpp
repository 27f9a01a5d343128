// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/faceNormals.h"

#include "osd_shading/parallel.h"
#include "osd_shading/vectorMath.h"

namespace osd_shading {
inline namespace v1 {

namespace {

/// The sides of a face's corner.
template <typename Real>
struct CornerSides {
    Vec3<Real> after, before;

    CornerSides(Far::TopologyLevel const& level, std::vector<Vec3<Real>> const& points, int face, int corner) {
        Far::ConstIndexArray const vertices = level.GetFaceVertices(face);
        int const size = vertices.size();
        Vec3<Real> const p = points[static_cast<std::size_t>(vertices[corner])];
        after = points[static_cast<std::size_t>(vertices[(corner + 1) % size])] - p;
        before = points[static_cast<std::size_t>(vertices[(corner + size - 1) % size])] - p;
    }
};

/// What each face round a vertex counts, up to a factor that they share.
template <typename Real>
void weighFaces(Far::TopologyLevel const& level, std::vector<Vec3<Real>> const& points, int vertex,
                FaceWeight weight, std::vector<Real>& weights) {
    Far::ConstIndexArray const faces = level.GetVertexFaces(vertex);
    Far::ConstLocalIndexArray const corners = level.GetVertexFaceLocalIndices(vertex);
    weights.assign(static_cast<std::size_t>(faces.size()), Real(1));
    if (weight == FaceWeight::Uniform) return;
    // Areas are taken at the size of the longest side: those of tiny or huge faces leave the range of numbers.
    Real longest = 0;
    for (int i = 0; i < faces.size() && weight == FaceWeight::CornerArea; ++i) {
        CornerSides<Real> const sides(level, points, faces[i], corners[i]);
        longest = std::fmax(longest, std::fmax(Length(sides.after), Length(sides.before)));
    }
    auto const scaled = [](Vec3<Real> const& a, Real size) {
        return size > 0 ? Vec3<Real>{a.x / size, a.y / size, a.z / size} : a;
    };
    for (int i = 0; i < faces.size(); ++i) {
        CornerSides<Real> const sides(level, points, faces[i], corners[i]);
        Vec3<Real> const after = weight == FaceWeight::CornerArea ? scaled(sides.after, longest) : sides.after;
        Vec3<Real> const before = weight == FaceWeight::CornerArea ? scaled(sides.before, longest) : sides.before;
        weights[static_cast<std::size_t>(i)] = CornerWeight(weight, after, before);
    }
}

}  // namespace

template <typename Real>
Vec3<Real> UnitFaceNormal(Far::TopologyLevel const& level, std::vector<Vec3<Real>> const& points, int face) {
    Far::ConstIndexArray const vertices = level.GetFaceVertices(face);
    return UnitPolygonNormal<Real>(vertices.size(),
                                   [&](int i) { return points[static_cast<std::size_t>(vertices[i])]; });
}

template <typename Real>
Vec3<Real> AverageFaceNormal(Far::TopologyLevel const& level, std::vector<Vec3<Real>> const& points,
                             RegionFan const& fan) {
    VectorSum<Real> sum;
    for (int const face : fan.faces) sum.Add(UnitFaceNormal(level, points, face), Real(1));
    return sum.Normalized();
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
        std::vector<VectorSum<Real>> sums;
        std::vector<Real> weights;
        for (int v = begin; v < end; ++v) {
            int const first = regions.FirstValue(v);
            sums.assign(static_cast<std::size_t>(regions.NumVertexValues(v)), {});
            weighFaces(level, points, v, weight, weights);
            Far::ConstIndexArray const faces = level.GetVertexFaces(v);
            Far::ConstLocalIndexArray const corners = level.GetVertexFaceLocalIndices(v);
            for (int i = 0; i < faces.size(); ++i) {
                sums[static_cast<std::size_t>(regions.CornerValue(faces[i], corners[i]) - first)].Add(
                    faceNormals[static_cast<std::size_t>(faces[i])], weights[static_cast<std::size_t>(i)]);
            }
            for (std::size_t i = 0; i < sums.size(); ++i) {
                normals[static_cast<std::size_t>(first) + i] = sums[i].Normalized();
            }
        }
    });
    return normals;
}

#define OSD_SHADING_INSTANTIATE(Real)                                                                    \
    template Vec3<Real> UnitFaceNormal(Far::TopologyLevel const&, std::vector<Vec3<Real>> const&, int);  \
    template Vec3<Real> AverageFaceNormal(Far::TopologyLevel const&, std::vector<Vec3<Real>> const&,     \
                                          RegionFan const&);                                             \
    template std::vector<Vec3<Real>> AverageFaceNormals(Far::TopologyLevel const&, CreaseRegions const&, \
                                                        std::vector<Vec3<Real>> const&, FaceWeight, int);
OSD_SHADING_INSTANTIATE(float)
OSD_SHADING_INSTANTIATE(double)
#undef OSD_SHADING_INSTANTIATE

}  // namespace v1
}  // namespace osd_shading
