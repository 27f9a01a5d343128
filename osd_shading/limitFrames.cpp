// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/limitFrames.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "osd_shading/parallel.h"
#include "osd_shading/vectorMath.h"

namespace osd_shading {
inline namespace v1 {

namespace {

/// The unit normal of the tangents that `mask` gives round `vertex`, decided exactly; zero where they are
/// degenerate.
template <typename Real>
Vec3<Real> normalOfDoubtfulTangents(std::vector<Vec3<Real>> const& points, int vertex, int const* ring,
                                    LimitMask<Real> const& mask) {
    Vec3<Real> const origin = points[static_cast<std::size_t>(vertex)];
    Vec3<Real> tangent1{}, tangent2{};
    Real added1 = 0, added2 = 0;
    auto const add = [&](int neighbor, typename LimitMask<Real>::Weights const& weights) {
        Vec3<Real> const side = points[static_cast<std::size_t>(neighbor)] - origin;
        Real const length = Length(side);
        tangent1 += weights.tangent1 * side;
        tangent2 += weights.tangent2 * side;
        added1 += std::fabs(weights.tangent1) * length;
        added2 += std::fabs(weights.tangent2) * length;
    };
    for (auto const& weights : mask.faces) add(*ring++, weights);
    for (auto const& weights : mask.edges) add(*ring++, weights);
    if (!(added1 > 0) || !(added2 > 0)) return {};
    // Scaled first: the product of tiny or huge tangents leaves the range of numbers.
    auto const scaled = [](Vec3<Real> const& a, Real size) {
        return Vec3<Real>{a.x / size, a.y / size, a.z / size};
    };
    return NormalizedSum(Cross(scaled(tangent1, added1), scaled(tangent2, added2)), Real(1));
}

/// The same, settled without a root per neighbour where the tangents are far from degenerate.
template <typename Real>
Vec3<Real> normalOfTangents(std::vector<Vec3<Real>> const& points, int vertex, int const* ring,
                            LimitMask<Real> const& mask) {
    Vec3<Real> const origin = points[static_cast<std::size_t>(vertex)];
    int const* const first = ring;
    Vec3<Real> tangent1{}, tangent2{};
    Real squares = 0;
    // Weights add to zero: differences leave out the vertex itself, and keep what a distant origin would round
    // away.
    auto const add = [&](int neighbor, typename LimitMask<Real>::Weights const& weights) {
        Vec3<Real> const side = points[static_cast<std::size_t>(neighbor)] - origin;
        squares += Dot(side, side);
        tangent1 += weights.tangent1 * side;
        tangent2 += weights.tangent2 * side;
    };
    for (auto const& weights : mask.faces) add(*ring++, weights);
    for (auto const& weights : mask.edges) add(*ring++, weights);

    // By Cauchy and Schwarz sum |w| |p - v| is at most the root of (sum w^2) (sum |p - v|^2).
    Vec3<Real> const normal = Cross(tangent1, tangent2);
    Real const squared = Dot(normal, normal), bound = kVanishing<Real> * mask.tangentNorms * squares;
    constexpr Real kSmallest = std::numeric_limits<Real>::min() / kVanishing<Real>;
    if (squared > bound * bound && squared > kSmallest && squared < 1 / kSmallest) {
        Real const inverse = 1 / std::sqrt(squared);
        return inverse * normal;
    }
    return normalOfDoubtfulTangents(points, vertex, first, mask);
}

template <typename Real>
Vec3<Real> normalOfCorner(Far::TopologyLevel const& level, std::vector<Vec3<Real>> const& points, int face,
                          int corner) {
    Far::ConstIndexArray const vertices = level.GetFaceVertices(face);
    int const size = vertices.size();
    Vec3<Real> const origin = points[static_cast<std::size_t>(vertices[corner])];
    Vec3<Real> const after = points[static_cast<std::size_t>(vertices[(corner + 1) % size])] - origin;
    Vec3<Real> const before = points[static_cast<std::size_t>(vertices[(corner + size - 1) % size])] - origin;
    return NormalizedSum(Cross(Normalized(after), Normalized(before)), Real(1));
}

struct ChunkCounts {
    std::vector<int> missing;
    std::int64_t numFallbacks = 0, numAverages = 0;
};

template <typename Real>
void gather(std::vector<ChunkCounts> const& chunks, LimitNormals<Real>& result) {
    for (ChunkCounts const& chunk : chunks) {
        result.missing.insert(result.missing.end(), chunk.missing.begin(), chunk.missing.end());
        result.numFallbacks += chunk.numFallbacks;
        result.numAverages += chunk.numAverages;
    }
}

}  // namespace

template <typename Real>
LimitNormals<Real> ComputeLimitNormals(LimitStep<Real> const& step, std::vector<Vec3<Real>> const& points,
                                       int numThreads) {
    CreaseRegions const& regions = step.Regions();
    Far::TopologyLevel const& level = step.Level();
    bool const isCatmark = step.Topology().IsCatmark();
    LimitNormals<Real> result;
    result.normals.resize(static_cast<std::size_t>(regions.NumValues()));
    std::vector<ChunkCounts> chunks(static_cast<std::size_t>(NumChunks(regions.NumVertices())));
    ParallelFor(regions.NumVertices(), numThreads, [&](int begin, int end, int chunk) {
        ChunkCounts& counts = chunks[static_cast<std::size_t>(chunk)];
        std::vector<int> neighbors;
        std::vector<RegionFan> fans;
        for (int v = begin; v < end; ++v) {
            int const numValues = regions.NumVertexValues(v);
            if (numValues == 0) continue;
            VertexKind const kind = regions.Kind(v);

            // Smooth vertices and darts: their ring, as OpenSubdiv orders it.
            bool hasPlane = true;
            if (kind <= VertexKind::Dart) {
                LimitMask<Real> const& mask = step.RingMask(v);
                Vec3<Real>& normal = result.normals[static_cast<std::size_t>(regions.FirstValue(v))];
                hasPlane = mask.hasTangents;
                if (hasPlane) normal = normalOfTangents(points, v, step.Ring(v).vertices, mask);
                if (!IsZero(normal)) continue;
            }

            // The others, region by region.
            FindRegionFans(level, regions, v, fans);
            for (RegionFan const& fan : fans) {
                Vec3<Real>& normal = result.normals[static_cast<std::size_t>(fan.value)];
                bool const isOneFace = fan.faces.size() == 1;
                bool isAverage = kind == VertexKind::Corner ? !isOneFace : !fan.isOrdered || !hasPlane;
                if (kind == VertexKind::Crease && fan.isOrdered) {
                    LimitMask<Real> const& mask = step.Masks().Fan(static_cast<int>(fan.faces.size()));
                    isAverage = !mask.hasTangents;
                    GatherFan(level, fan, isCatmark, neighbors);
                    if (!isAverage) normal = normalOfTangents(points, v, neighbors.data(), mask);
                } else if (kind == VertexKind::Corner && isOneFace) {
                    normal = normalOfCorner(level, points, fan.faces[0], fan.corners[0]);
                }
                if (!IsZero(normal)) continue;
                normal = AverageFaceNormal(level, points, fan);
                counts.numAverages += isAverage;
                if (!isAverage || IsZero(normal)) ++counts.numFallbacks;
                if (IsZero(normal)) counts.missing.push_back(fan.value);
            }
        }
    });
    gather(chunks, result);
    return result;
}

template <typename Real>
LimitNormals<Real> ComputeFaceAverageNormals(LimitStep<Real> const& step, std::vector<Vec3<Real>> const& points,
                                             FaceWeight weight, int numThreads) {
    LimitNormals<Real> result;
    result.normals = AverageFaceNormals(step.Level(), step.Regions(), points, weight, numThreads);
    for (std::size_t value = 0; value < result.normals.size(); ++value) {
        if (IsZero(result.normals[value])) result.missing.push_back(static_cast<int>(value));
    }
    result.numFallbacks = static_cast<std::int64_t>(result.missing.size());
    return result;
}

template <typename Real>
void FindLimitFrames(LimitStep<Real> const& step, int vertex, std::vector<LimitFrame<Real>>& frames) {
    CreaseRegions const& regions = step.Regions();
    Far::TopologyLevel const& level = step.Level();
    VertexKind const kind = regions.Kind(vertex);
    std::vector<RegionFan> fans;
    FindRegionFans(level, regions, vertex, fans);
    frames.resize(fans.size());
    for (std::size_t i = 0; i < fans.size(); ++i) {
        LimitFrame<Real>& frame = frames[i];
        frame.fan = std::move(fans[i]);
        frame.value = frame.fan.value;
        frame.vertices.assign(1, vertex);
        frame.tangent1.assign(1, 0);
        frame.tangent2.assign(1, 0);
        auto const add = [&](int neighbor, Real weight1, Real weight2) {
            frame.vertices.push_back(neighbor);
            frame.tangent1.push_back(weight1);
            frame.tangent2.push_back(weight2);
            frame.tangent1[0] -= weight1;
            frame.tangent2[0] -= weight2;
        };
        auto const addMask = [&](int const* ring, LimitMask<Real> const& mask) {
            for (auto const& weights : mask.faces) add(*ring++, weights.tangent1, weights.tangent2);
            for (auto const& weights : mask.edges) add(*ring++, weights.tangent1, weights.tangent2);
        };

        std::size_t const numFaces = frame.fan.faces.size();
        LimitMask<Real> const* mask = nullptr;
        if (kind <= VertexKind::Dart) mask = &step.RingMask(vertex);
        if (kind == VertexKind::Crease && frame.fan.isOrdered) mask = &step.Masks().Fan(static_cast<int>(numFaces));
        frame.isAverage = false;
        if (kind <= VertexKind::Dart && mask->hasTangents) {
            // The faces in the order of the mask.
            if (mask == step.Masks().Dart(static_cast<int>(numFaces))) {
                auto const start = FindDartStart(level, vertex);
                std::rotate(frame.fan.faces.begin(), frame.fan.faces.begin() + start, frame.fan.faces.end());
                std::rotate(frame.fan.corners.begin(), frame.fan.corners.begin() + start, frame.fan.corners.end());
            }
            addMask(step.Ring(vertex).vertices, *mask);
        } else if (kind == VertexKind::Crease && mask != nullptr && mask->hasTangents) {
            std::vector<int> neighbors;
            GatherFan(level, frame.fan, step.Topology().IsCatmark(), neighbors);
            addMask(neighbors.data(), *mask);
        } else if (kind == VertexKind::Corner && numFaces == 1) {
            Far::ConstIndexArray const vertices = level.GetFaceVertices(frame.fan.faces[0]);
            int const size = vertices.size(), corner = frame.fan.corners[0];
            add(vertices[(corner + 1) % size], 1, 0);
            add(vertices[(corner + size - 1) % size], 0, 1);
        } else {
            frame.isAverage = true;
            frame.vertices.clear();
            frame.tangent1.clear();
            frame.tangent2.clear();
        }
    }
}

#define OSD_SHADING_INSTANTIATE(Real)                                                                             \
    template LimitNormals<Real> ComputeLimitNormals(LimitStep<Real> const&, std::vector<Vec3<Real>> const&, int); \
    template void FindLimitFrames(LimitStep<Real> const&, int, std::vector<LimitFrame<Real>>&);                   \
    template LimitNormals<Real> ComputeFaceAverageNormals(LimitStep<Real> const&, std::vector<Vec3<Real>> const&, \
                                                          FaceWeight, int);
OSD_SHADING_INSTANTIATE(float)
OSD_SHADING_INSTANTIATE(double)
#undef OSD_SHADING_INSTANTIATE

}  // namespace v1
}  // namespace osd_shading
