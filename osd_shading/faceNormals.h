// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <cstdint>
#include <vector>

#include "osd_shading/creaseRegions.h"
#include "osd_shading/vectorMath.h"

namespace osd_shading {
inline namespace v1 {

/// How much a face counts in the normal of a vertex.
enum class FaceWeight { Uniform, CornerArea, Angle };

/// What a face counts at a corner with the sides `after` and `before`.
template <typename Real>
Real CornerWeight(FaceWeight weight, Vec3<Real> const& after, Vec3<Real> const& before) {
    switch (weight) {
        case FaceWeight::CornerArea:
            return Length(Cross(after, before));
        case FaceWeight::Angle: {
            Vec3<Real> const a = Normalized(after), b = Normalized(before);
            return std::atan2(Length(Cross(a, b)), Dot(a, b));
        }
        default:
            return 1;
    }
}

/// The least that a face counts, `longest` being the longest of the sides at the vertex: where the sides of every
/// corner run along each other rounding would decide which face counts, and whether any does.
template <typename Real>
Real LeastWeight(FaceWeight weight, Real longest) {
    return weight == FaceWeight::CornerArea ? kVanishing<Real> * longest * longest : kVanishing<Real>;
}

/// The unit normal by its vector area (Newell) of a polygon of `size` points, `pointAt(0)` and on; zero where it
/// has none.
template <typename Real, typename PointAt>
Vec3<Real> UnitPolygonNormal(int size, PointAt const& pointAt) {
    Vec3<Real> const origin = pointAt(0);
    // Scaled to unit size first: areas of tiny or huge faces leave the range of numbers.
    Real largest = 0;
    for (int i = 1; i < size; ++i) largest = std::fmax(largest, Length(pointAt(i) - origin));
    if (!(largest > 0)) return {};
    auto const sideTo = [&](int i) {
        Vec3<Real> const side = pointAt(i) - origin;
        return Vec3<Real>{side.x / largest, side.y / largest, side.z / largest};
    };
    // An area vanishes against the product of its triangles' sides, not against itself: rounding is no normal.
    Vec3<Real> area{}, side = sideTo(1);
    Real added = 0, sideLength = Length(side);
    for (int i = 2; i < size; ++i) {
        Vec3<Real> const next = sideTo(i);
        Real const nextLength = Length(next);
        area += Cross(side, next);
        added += sideLength * nextLength;
        side = next;
        sideLength = nextLength;
    }
    return NormalizedSum(area, added);
}

/// The unit normal of a face by its vector area (Newell); zero where it has none.
template <typename Real>
Vec3<Real> UnitFaceNormal(Far::TopologyLevel const& level, std::vector<Vec3<Real>> const& points, int face);

/// That of a face given by its vertices.
template <typename Real>
Vec3<Real> UnitFaceNormal(std::vector<Vec3<Real>> const& points, Far::ConstIndexArray const& vertices);

/// A corner of a face given by its vertices.
struct PolygonCorner {
    Far::ConstIndexArray vertices;
    int corner = 0;
};

/// What each of the corners at one vertex counts, up to a factor that they share.
template <typename Real>
void WeighCorners(std::vector<Vec3<Real>> const& points, FaceWeight weight,
                  std::vector<PolygonCorner> const& corners, std::vector<Real>& weights);

/// A sum of unit normals (or zeros, which do not count) and of their weights.
template <typename Real>
struct NormalSum {
    Vec3<Real> sum{};
    Real added = 0;

    void Add(Vec3<Real> const& unit, Real weight) {
        if (IsZero(unit)) return;
        sum += weight * unit;
        added += weight;
    }
    Vec3<Real> Unit() const { return NormalizedSum(sum, added); }
};

/// The normalised sum of the unit normals of a region's faces; zero where it vanishes.
template <typename Real>
Vec3<Real> AverageFaceNormal(Far::TopologyLevel const& level, std::vector<Vec3<Real>> const& points,
                             RegionFan const& fan);

/// That of every value of a level, each face weighted. [ZBK23] Sec. 2.2
template <typename Real>
std::vector<Vec3<Real>> AverageFaceNormals(Far::TopologyLevel const& level, CreaseRegions const& regions,
                                           std::vector<Vec3<Real>> const& points, FaceWeight weight,
                                           int numThreads);

}  // namespace v1
}  // namespace osd_shading
