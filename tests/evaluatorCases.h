// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tests/tableAgreement.h"

/// What the tests of the evaluator go through.
namespace osd_shading::tests {

inline PointView<float> ViewOf(std::vector<float> const& points) { return {points.data(), points.size() / 3}; }

/// A shape with options of its own: what the tests of the evaluator go through.
struct Case {
    Shape shape;
    ShadingOptions options;
    std::vector<float> points = shape.FloatPositions(), normals = {};

    std::string Name() const { return shape.name + ", level " + std::to_string(options.level); }
};

/// Few, but with every kind of tile, start normal and weight.
inline std::vector<Case> Cases() {
    std::vector<Case> cases = {
        {shapes::CubeWithSharpTop(), PaperPreset(4)},
        {shapes::GridWithDart(1.5F), PaperPreset(3)},
        {shapes::MixedPolygons(), PaperPreset(3)},
        {shapes::FinnedGrid(), PaperPreset(2)},
        {shapes::IsolatedVertex(), PaperPreset(0)},
        {shapes::Torus(6, 5).Hole(7), PaperPreset(5)},
        {shapes::Cross().CreaseAll(2.5F), SmoothPreset(4)},
        {shapes::OpenBox().Chaikin().CreaseAll(1.5F), PaperPreset(3)},
        {shapes::Icosahedron().Loop().Crease(0, 1), PaperPreset(4)},
        {shapes::TriangleFan(7).Loop().Hole(3), SmoothPreset(3)},
    };
    auto const add = [&](Shape const& shape, auto const& change) {
        ShadingOptions options = PaperPreset(3);
        change(options);
        cases.push_back({shape, options});
    };
    add(shapes::RandomShape(71), [](ShadingOptions& o) {
        o.startNormals = {StartNormalKind::Limit, 1};
        o.weights.sharpVertices = SharpVertexWeight::PerRegion;
    });
    add(shapes::RandomShape(72), [](ShadingOptions& o) {
        o.startNormals.kind = StartNormalKind::Angle;
        o.weights.exponent = 2.5;
    });
    add(shapes::RandomShape(73), [](ShadingOptions& o) {
        o.limits = {PositionKind::Refined, LimitNormalKind::FaceAverage};
    });
    add(shapes::RandomShape(74), [](ShadingOptions& o) { o.limits.normals = LimitNormalKind::Exact; });
    add(shapes::MixedPolygons(), [](ShadingOptions& o) { o.startNormals = {StartNormalKind::User, 0}; });
    shapes::Random random(5);
    for (std::size_t i = 0; i < 3 * Index(cases.back().shape.NumVertices()); ++i) {
        cases.back().normals.push_back(static_cast<float>(random.Uniform(-1, 1)));
    }
    return cases;
}

inline TableFrame FrameOf(Case const& c, ShadingTable const& table, EvaluatorOptions const& options = {}) {
    return EvaluateAll(table, ViewOf(c.points), options, ViewOf(c.normals));
}

}  // namespace osd_shading::tests
