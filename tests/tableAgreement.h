// SPDX-License-Identifier: Apache-2.0
#pragma once

/// \file
/// A frame of a shading table beside the one-shot path in double precision.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "osd_shading/shadingEvaluator.h"
#include "osd_shading/startNormals.h"
#include "osd_shading/subdividedNormals.h"
#include "osd_shading/subdivisionShading.h"
#include "tests/testHelpers.h"

namespace osd_shading::tests {

/// All that a frame can write, packed.
struct TableFrame {
    std::vector<Vec3<float>> positions, blendedNormals, limitNormals, subdividedNormals, du, dv;
    std::vector<float> blendWeights;
    FrameReport report;
};

inline PointSpan SpanOf(std::vector<Vec3<float>>& points) {
    return {points.empty() ? nullptr : &points[0].x, points.size(), 3};
}

inline TableFrame EvaluateAll(ShadingTable const& table, PointView<float> controlPoints,
                              EvaluatorOptions const& options = {}, PointView<float> userNormals = {}) {
    auto const count = static_cast<std::size_t>(table.NumValues());
    TableFrame frame;
    ShadingOutputs outputs;
    auto const add = [&](std::vector<Vec3<float>>& points, PointSpan& span) {
        points.assign(count, {std::nanf(""), std::nanf(""), std::nanf("")});
        span = SpanOf(points);
    };
    add(frame.positions, outputs.positions);
    add(frame.blendedNormals, outputs.blendedNormals);
    add(frame.limitNormals, outputs.limitNormals);
    add(frame.subdividedNormals, outputs.subdividedNormals);
    add(frame.du, outputs.du);
    add(frame.dv, outputs.dv);
    frame.blendWeights.assign(count, std::nanf(""));
    outputs.blendWeights = {frame.blendWeights.data(), count, 1};
    ShadingEvaluator evaluator(table, options);
    frame.report = evaluator.Evaluate(controlPoints, userNormals, outputs);
    return frame;
}

/// Whether two frames hold the same bits.
inline ::testing::AssertionResult IsSameFrame(TableFrame const& a, TableFrame const& b) {
    auto const differs = [](char const* what) { return ::testing::AssertionFailure() << what << " differ"; };
    if (!HasSameBits(a.positions, b.positions)) return differs("positions");
    if (!HasSameBits(a.blendedNormals, b.blendedNormals)) return differs("blendedNormals");
    if (!HasSameBits(a.limitNormals, b.limitNormals)) return differs("limitNormals");
    if (!HasSameBits(a.subdividedNormals, b.subdividedNormals)) return differs("subdividedNormals");
    if (!HasSameBits(a.du, b.du) || !HasSameBits(a.dv, b.dv)) return differs("tangents");
    if (!HasSameBits(a.blendWeights, b.blendWeights)) return differs("blendWeights");
    if (a.report.fallbackNormals != b.report.fallbackNormals ||
        a.report.zeroStartNormals != b.report.zeroStartNormals) {
        return differs("reports");
    }
    return ::testing::AssertionSuccess();
}

/// The one-shot path in double from the same float points, and |N_S| before it is normalised.
struct Reference {
    ShadingResult<double> result;
    std::vector<double> subdividedLengths;
    double size = 0;  ///< of the control points' box, its longest side
};

inline Reference ReferenceOf(ControlMesh const& mesh, std::vector<float> const& points,
                             ShadingOptions const& options, std::vector<float> const& userNormals = {}) {
    Reference reference;
    std::vector<double> const positions(points.begin(), points.end());
    std::vector<double> const normals(userNormals.begin(), userNormals.end());
    ShadingInput<double> input;
    input.positions = {positions.data(), positions.size() / 3};
    if (options.startNormals.kind == StartNormalKind::User) {
        PointView<double> const view{normals.data(), normals.size() / 3};
        (view.size() == input.positions.size() ? input.vertexNormals : input.faceVaryingNormals) = view;
    }
    reference.result = ShadeSubdivision(mesh, input, options);
    for (int axis = 0; axis < 3; ++axis) {
        double low = 1e300, high = -1e300;
        for (std::size_t i = static_cast<std::size_t>(axis); i < positions.size(); i += 3) {
            low = std::min(low, positions[i]);
            high = std::max(high, positions[i]);
        }
        reference.size = std::max(reference.size, high - low);
    }

    // N_S once more, as it is before normalising.
    ShadingOptions const& resolved = reference.result.options;
    RefinedTopology const topology(mesh, resolved.level);
    int const n = resolved.startNormals.level;
    FieldLevels<double> const levels(topology, n, 1);
    LimitStep<double> const limit(topology, resolved.level, levels.Regions(resolved.level), 1,
                                  resolved.limits.normals);
    StartNormals<double> start;
    if (resolved.startNormals.kind == StartNormalKind::User) {
        start = GatherUserNormals(topology, levels.Regions(0), input.vertexNormals, input.faceVaryingNormals);
    } else {
        std::vector<Vec3<double>> at;
        for (std::size_t i = 0; i < input.positions.size(); ++i) at.push_back(input.positions[i]);
        for (int level = 1; level <= n; ++level) at = RefinePoints(topology.RecordMasks<double>(level), at, 1);
        start = ComputeStartNormals(resolved.startNormals.kind, topology, n, levels.Regions(n), at, 1);
    }
    for (Vec3<double> const& normal :
         ComputeSubdividedNormals({}, levels, n, limit, std::move(start.normals), {}, 1)) {
        reference.subdividedLengths.push_back(Length(normal));
    }
    return reference;
}

/// What a frame and its reference differ by.
struct Agreement {
    double position = 0;  ///< over the model's size, beyond what rounding the true coordinates to float costs
    double normal = 0;    ///< the largest of angle * m over all normals, in radians
    std::string worst;    ///< where that is
    std::int64_t supportDiffers = 0;
    double weight = 0;
    bool isNumbered = true;  ///< every value of the reference stands for one of the table
};

/// `values`: ShadingTable::ResultValues(). Values whose N_L is a fallback are compared like all others where both
/// sides have a normal.
inline Agreement Compare(TableFrame const& frame, std::vector<int> const& values, Reference const& reference) {
    ShadingResult<double> const& result = reference.result;
    Agreement agreement;
    std::vector<unsigned char> isMet(result.blendedNormals.size(), 0);
    agreement.isNumbered = values.size() == isMet.size();
    for (std::size_t i = 0; i < values.size(); ++i) {
        auto const value = static_cast<std::size_t>(values[i]);
        agreement.isNumbered &= !isMet[value];
        isMet[value] = 1;
        auto const vertex = static_cast<std::size_t>(result.valueVertices[value]);
        Vec3<double> const p = result.positions[vertex];
        Vec3<float> const q = frame.positions[i];
        // A model far from the origin has no better coordinates in float.
        auto const rounding = [](double x) { return x - double{static_cast<float>(x)}; };
        double const distance = std::hypot(p.x - double{q.x}, p.y - double{q.y}, p.z - double{q.z}) -
                                std::hypot(rounding(p.x), rounding(p.y), rounding(p.z));
        if (!(distance / reference.size <= agreement.position)) agreement.position = distance / reference.size;

        double const b = result.blendWeights[value];
        agreement.supportDiffers += (b > 0) != (frame.blendWeights[i] > 0);
        double const weightDifference = std::fabs(b - double{frame.blendWeights[i]});
        if (!(weightDifference <= agreement.weight)) agreement.weight = weightDifference;

        double const power = std::pow(b, result.options.weights.exponent);
        Vec3<double> const sum = (1 - power) * result.limitNormals[value] + power * result.subdividedNormals[value];
        auto const compare = [&](char const* what, Vec3<float> const& have, Vec3<double> const& want, double m) {
            double const angle = IsZero(want) ? Length(Vec3<double>{double{have.x}, double{have.y}, double{have.z}})
                                              : AngleBetween(have, want) + (IsZero(have) ? 1 : 0);
            if (!(angle * m <= agreement.normal)) {
                agreement.normal = angle * m;
                agreement.worst = std::string(what) + " of value " + std::to_string(value) + " (vertex " +
                                  std::to_string(vertex) + "), m " + std::to_string(m) + ", b " + std::to_string(b);
            }
        };
        double const lengthS = std::min(1.0, reference.subdividedLengths[value]);
        compare("N_L", frame.limitNormals[i], result.limitNormals[value], 1);
        if (b > 0) compare("N_S", frame.subdividedNormals[i], result.subdividedNormals[value], lengthS);
        compare("N_B", frame.blendedNormals[i], result.blendedNormals[value],
                b > 0 ? std::min(lengthS, Length(sum)) : 1);
    }
    return agreement;
}

}  // namespace osd_shading::tests
