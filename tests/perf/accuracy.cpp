// SPDX-License-Identifier: Apache-2.0
#include "accuracy.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "osd_shading/shadingEvaluator.h"
#include "osd_shading/shadingTable.h"
#include "osd_shading/subdivisionShading.h"
#include "shadingFrames.h"

namespace perf {

using osd_shading::ShadingResult;
using Vector = osd_shading::Vec3<double>;

namespace {

double distance(float const* a, Vector const& b) {
    return std::sqrt(std::pow(a[0] - b.x, 2) + std::pow(a[1] - b.y, 2) + std::pow(a[2] - b.z, 2));
}

double longestSide(std::vector<Vector> const& points) {
    double longest = 0;
    for (double Vector::*const axis : {&Vector::x, &Vector::y, &Vector::z}) {
        auto const [least, most] = std::minmax_element(
            points.begin(), points.end(), [axis](auto const& a, auto const& b) { return a.*axis < b.*axis; });
        longest = std::max(longest, (*most).*axis - (*least).*axis);
    }
    return longest;
}

/// |(1 - b) N_L + b N_S|, for the exponent 1.
double blendLength(ShadingResult<double> const& shaded, std::size_t value) {
    double const b = std::clamp(shaded.blendWeights[value], 0.0, 1.0);
    Vector const& l = shaded.limitNormals[value];
    Vector const& s = shaded.subdividedNormals[value];
    return std::hypot((1 - b) * l.x + b * s.x, (1 - b) * l.y + b * s.y, (1 - b) * l.z + b * s.z);
}

}  // namespace

Accuracy MeasureAccuracy(MovingMesh const& mesh, int level) {
    osd_shading::ShadingOptions const options = OptionsFor(FrameKind::Shaded, level);
    std::vector<float> const& points = mesh.FirstPose().three;
    std::vector<double> const exactPoints(points.begin(), points.end());
    osd_shading::ShadingInput<double> input;
    input.positions = {exactPoints.data(), exactPoints.size() / 3};
    ShadingResult<double> const shaded = osd_shading::ShadeSubdivision(mesh.Mesh(), input, options);

    osd_shading::ShadingTable const table(mesh.Mesh(), options);
    auto const numValues = static_cast<std::size_t>(table.NumValues());
    FrameBuffers frame(numValues), limitFrame(numValues);
    ShadingFrames(table, FrameKind::Shaded, {}, frame).Evaluate(mesh.FirstPose());
    ShadingFrames(table, FrameKind::LimitNormals, {}, limitFrame).Evaluate(mesh.FirstPose());

    Accuracy worst;
    double const size = longestSide(shaded.positions);
    std::vector<int> const resultValues = table.ResultValues();
    for (std::size_t i = 0; i < numValues; ++i) {
        auto const value = static_cast<std::size_t>(resultValues[i]);
        auto const vertex = static_cast<std::size_t>(shaded.valueVertices[value]);
        worst.positions =
            std::max(worst.positions, distance(&frame.positions[3 * i], shaded.positions[vertex]) / size);
        worst.blendedNormals =
            std::max(worst.blendedNormals, distance(&frame.normals[3 * i], shaded.blendedNormals[value]) *
                                               std::min(1.0, blendLength(shaded, value)));
        worst.limitNormals =
            std::max(worst.limitNormals, distance(&limitFrame.normals[3 * i], shaded.limitNormals[value]));
    }
    return worst;
}

}  // namespace perf
