// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/io/creaseEdits.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "osd_shading/errors.h"
#include "osd_shading/views.h"

namespace osd_shading {
inline namespace v1 {
namespace io {

namespace {

constexpr double kAngleTolerance = 1e-6;  // degrees; six decimals in an OBJ resolve no less
constexpr double kDegreesPerRadian = 57.295779513082320877;

struct FaceEdge {
    int low, high, face;
    bool isForward;  // runs from low to high
};

Vec3<double> cross(Vec3<double> const& a, Vec3<double> const& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

double dot(Vec3<double> const& a, Vec3<double> const& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

// The unit normal of the projected area; zero where there is none.
Vec3<double> faceNormal(Model const& model, int const* vertices, std::size_t size) {
    auto const point = [&](std::size_t i) { return &model.positions[3 * static_cast<std::size_t>(vertices[i])]; };

    // Offsets from the first vertex, divided by the largest: neither distance nor size of the face costs digits.
    double const* const origin = point(0);
    double scale = 0;
    for (std::size_t i = 1; i < size; ++i) {
        for (int k = 0; k < 3; ++k) scale = std::max(scale, std::abs(point(i)[k] / 2 - origin[k] / 2));
    }
    if (!(scale > 0)) return {};
    auto const offset = [&](std::size_t i) -> Vec3<double> {
        double const* const p = point(i);
        return {(p[0] / 2 - origin[0] / 2) / scale, (p[1] / 2 - origin[1] / 2) / scale,
                (p[2] / 2 - origin[2] / 2) / scale};
    };

    Vec3<double> sum;
    for (std::size_t i = 1; i + 1 < size; ++i) {
        auto const area = cross(offset(i), offset(i + 1));
        sum = {sum.x + area.x, sum.y + area.y, sum.z + area.z};
    }
    double const length = std::sqrt(dot(sum, sum));
    constexpr double kNoArea = 1e-14;  // of a face of size 1: what rounding leaves of a face without area
    if (!(length > kNoArea * static_cast<double>(size))) return {};
    return {sum.x / length, sum.y / length, sum.z / length};
}

}  // namespace

void AddCreasesByAngle(Model& model, double degrees) {
    if (!(degrees >= 0 && degrees <= 180)) {
        throw InvalidOptions("the crease angle is " + std::to_string(degrees) + ": give 0 to 180 degrees");
    }

    // Collect normals of faces and edges of faces.
    std::vector<Vec3<double>> normals;
    std::vector<FaceEdge> edges;
    normals.reserve(model.faceSizes.size());
    edges.reserve(model.faceVertices.size());
    std::size_t first = 0;
    for (std::size_t face = 0; face < model.faceSizes.size(); ++face) {
        auto const size = static_cast<std::size_t>(model.faceSizes[face]);
        int const* const vertices = model.faceVertices.data() + first;
        first += size;
        normals.push_back(faceNormal(model, vertices, size));
        for (std::size_t i = 0; i < size; ++i) {
            int const a = vertices[i], b = vertices[(i + 1) % size];
            edges.push_back({std::min(a, b), std::max(a, b), static_cast<int>(face), a < b});
        }
    }

    // Bring the faces of each edge together.
    std::sort(edges.begin(), edges.end(), [](FaceEdge const& a, FaceEdge const& b) {
        if (a.low != b.low) return a.low < b.low;
        return a.high != b.high ? a.high < b.high : a.face < b.face;
    });
    for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
        FaceEdge const& one = edges[begin];
        while (end < edges.size() && edges[end].low == one.low && edges[end].high == one.high) ++end;
        if (end - begin != 2) continue;

        // Compare their normals; the zero normal of a face without area gives the angle 0.
        FaceEdge const& other = edges[begin + 1];
        auto const& normal = normals[static_cast<std::size_t>(one.face)];
        auto facing = normals[static_cast<std::size_t>(other.face)];
        if (one.isForward == other.isForward) facing = {-facing.x, -facing.y, -facing.z};
        auto const sine = cross(normal, facing);
        double const angle = std::atan2(std::sqrt(dot(sine, sine)), dot(normal, facing)) * kDegreesPerRadian;
        if (!(angle > degrees + kAngleTolerance)) continue;
        model.creaseVertices.insert(model.creaseVertices.end(), {one.low, one.high});
        model.creaseSharpness.push_back(kInfiniteSharpness);
    }
}

void ScaleCreases(Model& model, double factor) {
    if (!(factor >= 0 && std::isfinite(factor))) {
        throw InvalidOptions("the crease scale is " + std::to_string(factor) + ": give a finite number, 0 or more");
    }
    for (float& sharpness : model.creaseSharpness) {
        if (sharpness >= kInfiniteSharpness) continue;
        sharpness = static_cast<float>(std::min(sharpness * factor, double{kInfiniteSharpness}));
    }
}

}  // namespace io
}  // namespace v1
}  // namespace osd_shading
