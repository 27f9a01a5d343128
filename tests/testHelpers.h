// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <opensubdiv/far/primvarRefiner.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "osd_shading/fieldRefiner.h"
#include "osd_shading/limitMasks.h"
#include "osd_shading/subdivisionShading.h"
#include "osd_shading/vectorMath.h"
#include "tests/sampleSize.h"
#include "tests/shapes.h"

/// What the tests of the rooms share.
namespace osd_shading::tests {

using shapes::Shape;

inline std::size_t Index(int i) { return static_cast<std::size_t>(i); }

template <typename Real>
std::vector<Vec3<Real>> PointsOf(Shape const& shape) {
    std::vector<Vec3<Real>> points;
    for (std::size_t i = 0; i < shape.positions.size(); i += 3) {
        double const* const p = &shape.positions[i];
        points.push_back({static_cast<Real>(p[0]), static_cast<Real>(p[1]), static_cast<Real>(p[2])});
    }
    return points;
}

template <typename Real>
ShadingResult<Real> Shade(Shape const& shape, ShadingOptions const& options) {
    std::vector<Vec3<Real>> const points = PointsOf<Real>(shape);
    ShadingInput<Real> input;
    input.positions = points;
    return ShadeSubdivision(shape.Mesh(), input, options);
}

/// The rooms of a shape, one made from the other, and its refined points by level.
template <typename Real>
struct Rooms {
    RefinedTopology topology;
    FieldLevels<Real> levels;
    LimitStep<Real> limit;
    std::vector<std::vector<Vec3<Real>>> points;

    Rooms(Shape const& shape, int level)
        : topology(shape.Mesh(), level),
          levels(topology, 0, 1),
          limit(topology, level, levels.Regions(level), 1),
          points{PointsOf<Real>(shape)} {
        for (int l = 1; l <= level; ++l) points.push_back(RefinePoints(levels.Masks(l), points.back(), 1));
    }
    Far::TopologyLevel const& Last() const { return topology.Level(topology.LastLevel()); }
    CreaseRegions const& LastRegions() const { return levels.Regions(topology.LastLevel()); }
};

/// Draws what kind of random shape comes next: of every kind.
inline shapes::RandomShapeOptions AnyKind(shapes::Random& random) {
    shapes::RandomShapeOptions kind;
    kind.triangles = random.Chance(0.4);
    kind.nonManifold = random.Chance(0.2);
    kind.chaikin = random.Chance(0.2);
    return kind;
}

/// Every shape in both schemes. Under sanitizers each fifth, from one on that the running test's name chooses, so
/// that the suite sees them all.
inline std::vector<Shape> AllShapes() {
    std::vector<Shape> all = shapes::CatmarkShapes();
    for (Shape const& shape : shapes::LoopShapes()) all.push_back(shape);
    testing::TestInfo const* const test = testing::UnitTest::GetInstance()->current_test_info();
    if (!IsSanitizerRun() || IsFullRun() || test == nullptr) return all;
    constexpr std::size_t kStep = 5;
    std::vector<Shape> some;
    for (std::size_t i = std::string_view(test->name()).size() % kStep; i < all.size(); i += kStep) {
        some.push_back(all[i]);
    }
    return some;
}

inline bool HasOnlyRegularFaces(Shape const& shape) {
    int const regular = shape.rules.scheme == Sdc::SCHEME_LOOP ? 3 : 4;
    return std::all_of(shape.faceSizes.begin(), shape.faceSizes.end(), [&](int size) { return size == regular; });
}

/// The words of the error that `call` throws. Errors of other types end the test.
template <typename ExpectedError, typename Call>
std::string ErrorOf(Call const& call) {
    try {
        call();
    } catch (ExpectedError const& error) {
        return error.what();
    }
    return "no error";
}

/// A point as OpenSubdiv's own refining wants to see it.
struct OsdPoint {
    Vec3<double> at{};

    void Clear() { at = {}; }
    template <typename Weight>
    void AddWithWeight(OsdPoint const& other, Weight weight) {
        at += static_cast<double>(weight) * other.at;
    }
};

/// `points` of level `from` at level `to`, refined by OpenSubdiv itself.
inline std::vector<OsdPoint> RefineByOsd(Far::TopologyRefiner const& refiner, std::vector<OsdPoint> points,
                                         int from, int to) {
    Far::PrimvarRefinerReal<double> const primvars(refiner);
    for (int level = from + 1; level <= to; ++level) {
        std::vector<OsdPoint> refined(Index(refiner.GetLevel(level).GetNumVertices()));
        primvars.Interpolate(level, points, refined);
        points.swap(refined);
    }
    return points;
}

inline std::vector<OsdPoint> OsdPointsOf(Shape const& shape) {
    std::vector<OsdPoint> points;
    for (Vec3<double> const& p : PointsOf<double>(shape)) points.push_back({p});
    return points;
}

template <typename Real>
double Distance(Vec3<Real> const& a, Vec3<Real> const& b) {
    return std::hypot(double(a.x) - double(b.x), double(a.y) - double(b.y), double(a.z) - double(b.z));
}

template <typename Real>
bool IsFinite(Vec3<Real> const& a) {
    return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

/// Whether two arrays hold the same bits.
template <typename T>
bool HasSameBits(std::vector<T> const& a, std::vector<T> const& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

/// Whether two results hold the same numbers, bit for bit.
template <typename Real>
::testing::AssertionResult IsSameResult(ShadingResult<Real> const& a, ShadingResult<Real> const& b) {
    auto const differs = [](char const* what) { return ::testing::AssertionFailure() << what << " differ"; };
    if (!HasSameBits(a.positions, b.positions)) return differs("positions");
    if (!HasSameBits(a.limitNormals, b.limitNormals)) return differs("limitNormals");
    if (!HasSameBits(a.subdividedNormals, b.subdividedNormals)) return differs("subdividedNormals");
    if (!HasSameBits(a.blendedNormals, b.blendedNormals)) return differs("blendedNormals");
    if (!HasSameBits(a.blendWeights, b.blendWeights)) return differs("blendWeights");
    if (a.faceSize != b.faceSize || a.faceVertices != b.faceVertices) return differs("faceVertices");
    if (a.faceValues != b.faceValues) return differs("faceValues");
    if (a.baseFaces != b.baseFaces || a.refinerFaces != b.refinerFaces) return differs("faces");
    if (a.valueVertices != b.valueVertices || a.vertexValues != b.vertexValues) return differs("values");
    auto const isSameEdge = [](CreaseEdge const& p, CreaseEdge const& q) {
        return p.vertices[0] == q.vertices[0] && p.vertices[1] == q.vertices[1] && p.sharpness == q.sharpness &&
               p.controlSharpness == q.controlSharpness && p.isBoundary == q.isBoundary;
    };
    if (!std::equal(a.creaseEdges.begin(), a.creaseEdges.end(), b.creaseEdges.begin(), b.creaseEdges.end(),
                    isSameEdge)) {
        return differs("creaseEdges");
    }
    auto const isSameTag = [](VertexTag const& p, VertexTag const& q) {
        return p.kind == q.kind && p.isBoundary == q.isBoundary && p.isExtraordinary == q.isExtraordinary &&
               p.isNonManifold == q.isNonManifold && p.valence == q.valence;
    };
    if (!std::equal(a.vertexTags.begin(), a.vertexTags.end(), b.vertexTags.begin(), b.vertexTags.end(),
                    isSameTag)) {
        return differs("vertexTags");
    }
    if (a.vertexData.size() != b.vertexData.size()) return differs("vertexData");
    for (std::size_t i = 0; i < a.vertexData.size(); ++i) {
        if (!HasSameBits(a.vertexData[i].values, b.vertexData[i].values)) return differs("vertexData");
    }
    if (a.faceVaryingData.size() != b.faceVaryingData.size()) return differs("faceVaryingData");
    for (std::size_t i = 0; i < a.faceVaryingData.size(); ++i) {
        if (!HasSameBits(a.faceVaryingData[i].values, b.faceVaryingData[i].values) ||
            a.faceVaryingData[i].faceIndices != b.faceVaryingData[i].faceIndices) {
            return differs("faceVaryingData");
        }
    }
    return ::testing::AssertionSuccess();
}

}  // namespace osd_shading::tests
