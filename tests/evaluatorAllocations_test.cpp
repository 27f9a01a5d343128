// SPDX-License-Identifier: Apache-2.0

// A program of its own: it counts what is allocated.

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "tests/countedAllocations.h"
#include "tests/tableAgreement.h"

namespace osd_shading::tests {
namespace {

/// All that a frame can write, in buffers of its own.
class Outputs {
public:
    explicit Outputs(ShadingTable const& table) : _vectors(6), _weights(Index(table.NumValues())) {
        for (auto& vectors : _vectors) vectors.resize(_weights.size());
    }
    ShadingOutputs Views() {
        return {SpanOf(_vectors[0]),
                SpanOf(_vectors[1]),
                SpanOf(_vectors[2]),
                SpanOf(_vectors[3]),
                SpanOf(_vectors[4]),
                SpanOf(_vectors[5]),
                {_weights.data(), _weights.size(), 1}};
    }

private:
    std::vector<std::vector<Vec3<float>>> _vectors;
    std::vector<float> _weights;
};

TEST(EvaluatorAllocations, AreCounted) {
    std::int64_t const before = NumAllocations();
    std::vector<int> const numbers(100);
    EXPECT_EQ(NumAllocations(), before + 1);
    EXPECT_EQ(numbers[99], 0);
}

TEST(EvaluatorAllocations, AFrameMakesNone) {
    std::vector<std::pair<std::string, ShadingOptions>> kinds;
    for (auto const& [name, kind] :
         {std::pair{"uniform", StartNormalKind::Uniform}, std::pair{"corner area", StartNormalKind::CornerArea},
          std::pair{"angle", StartNormalKind::Angle}, std::pair{"limit", StartNormalKind::Limit},
          std::pair{"limit smoothed", StartNormalKind::LimitSmoothed}, std::pair{"user", StartNormalKind::User}}) {
        ShadingOptions options = PaperPreset(3);
        options.startNormals.kind = kind;
        options.startNormals.level = kind == StartNormalKind::User ? 0 : 1;
        kinds.emplace_back(name, options);
    }
    kinds.emplace_back("smooth preset", SmoothPreset(3));
    kinds.emplace_back("refined positions", PaperPreset(3));
    kinds.back().second.limits.positions = PositionKind::Refined;
    kinds.emplace_back("face average", PaperPreset(3));
    kinds.back().second.limits.normals = LimitNormalKind::FaceAverage;

    for (Shape const& shape : {shapes::Torus(12, 10).Crease(0, 1, 1.5F).Jitter(0.1), shapes::MixedPolygons(),
                               shapes::Cross().CreaseAll(1.5F), shapes::Icosahedron().Loop().Crease(0, 1)}) {
        std::vector<float> const points = shape.FloatPositions();
        PointView<float> const view{points.data(), points.size() / 3};
        for (auto const& [name, options] : kinds) {
            PointView<float> const normals =
                options.startNormals.kind == StartNormalKind::User ? view : PointView<float>();
            for (ValueOrder const order : {ValueOrder::Tiles, ValueOrder::OpenSubdiv}) {
                ShadingTable const table(shape.Mesh(), options, order);
                Outputs outputs(table);
                ShadingOutputs const all = outputs.Views();
                ShadingOutputs onlyNormals;
                onlyNormals.blendedNormals = all.blendedNormals;
                for (int const numThreads : {1, 3}) {
                    EvaluatorOptions own;
                    own.numThreads = numThreads;
                    ShadingEvaluator evaluator(table, own);
                    // From the first frame on.
                    std::int64_t const before = NumAllocations();
                    FrameReport const report = evaluator.Evaluate(view, normals, all);
                    evaluator.Evaluate(view, normals, onlyNormals);
                    evaluator.Evaluate(view, normals, all);
                    EXPECT_EQ(NumAllocations(), before)
                        << shape.name << ", " << name << ", " << numThreads << " threads";
                    EXPECT_EQ(report.fallbackNormals, 0) << shape.name << ", " << name;
                }
            }
        }
    }
}

}  // namespace
}  // namespace osd_shading::tests
