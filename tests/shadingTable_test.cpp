// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/shadingTable.h"

#include <gtest/gtest.h>

#include "tests/sampleSize.h"
#include "tests/tableAgreement.h"

namespace {

using namespace osd_shading;
using namespace osd_shading::tests;

/// Rounding of float coordinates, some units in the last place, of the model's size; and of normals.
constexpr double kPositions = 2e-7, kNormals = 1e-5;

void ExpectAgreement(Shape const& shape, ShadingOptions const& options, std::string const& what) {
    SCOPED_TRACE(shape.name + ", level " + std::to_string(options.level) + ", " + what);
    std::vector<float> const points = shape.FloatPositions();
    ShadingTable const table(shape.Mesh(), options);
    TableFrame const frame = EvaluateAll(table, {points.data(), points.size() / 3});
    Reference const reference = ReferenceOf(shape.Mesh(), points, options);
    Agreement const agreement = Compare(frame, table.ResultValues(), reference);
    EXPECT_TRUE(agreement.isNumbered);
    EXPECT_LE(agreement.position, kPositions);
    EXPECT_LE(agreement.normal, kNormals) << agreement.worst;
    EXPECT_EQ(agreement.supportDiffers, 0);
    EXPECT_LE(agreement.weight, 1e-6);
}

TEST(ShadingTable, AgreesWithTheOneShotPathOnEveryShape) {
    for (Shape const& shape : AllShapes()) {
        for (int level = HasOnlyRegularFaces(shape) ? 0 : 1; level <= 4; ++level) {
            ExpectAgreement(shape, PaperPreset(level), "paper");
        }
    }
}

/// The options that a table must hold, one at a time and some together.
std::vector<std::pair<std::string, ShadingOptions>> ManyOptions(int level, bool hasOnlyRegularFaces) {
    std::vector<std::pair<std::string, ShadingOptions>> all;
    auto const add = [&](std::string const& name, auto const& change) {
        ShadingOptions options = PaperPreset(level);
        change(options);
        all.emplace_back(name, options);
    };
    all.emplace_back("smooth", SmoothPreset(level));
    for (int n = 0; n <= level; ++n) {
        add("n " + std::to_string(n), [&](ShadingOptions& o) { o.startNormals.level = n; });
        add("w " + std::to_string(n), [&](ShadingOptions& o) { o.weights.level = n; });
        if (n == 0 && !hasOnlyRegularFaces) continue;  // no limits there
        add("limit, n " + std::to_string(n), [&](ShadingOptions& o) {
            o.startNormals = {StartNormalKind::Limit, n};
            o.weights.sharpVertices = SharpVertexWeight::Smooth;
        });
        add("limit smoothed, n " + std::to_string(n), [&](ShadingOptions& o) {
            o.startNormals = {StartNormalKind::LimitSmoothed, n};
            o.weights.scheme = WeightScheme::One;
        });
    }
    add("variant A", [](ShadingOptions& o) { o.weights.sharpVertices = SharpVertexWeight::Smooth; });
    add("variant C", [](ShadingOptions& o) { o.weights.sharpVertices = SharpVertexWeight::PerRegion; });
    add("sharp darts", [](ShadingOptions& o) { o.weights.darts = DartWeight::LikeSharp; });
    add("extraordinary only", [](ShadingOptions& o) { o.weights.scheme = WeightScheme::ExtraordinaryOnly; });
    add("bilinear", [](ShadingOptions& o) { o.weights.scheme = WeightScheme::Bilinear; });
    add("inverse limit", [](ShadingOptions& o) { o.weights.scheme = WeightScheme::InverseLimit; });
    add("one", [](ShadingOptions& o) { o.weights.scheme = WeightScheme::One; });
    add("exponent", [](ShadingOptions& o) { o.weights.exponent = 2.5; });
    add("corner area", [](ShadingOptions& o) { o.startNormals.kind = StartNormalKind::CornerArea; });
    add("angle", [](ShadingOptions& o) { o.startNormals.kind = StartNormalKind::Angle; });
    add("refined", [](ShadingOptions& o) { o.limits.positions = PositionKind::Refined; });
    add("face average", [](ShadingOptions& o) { o.limits.normals = LimitNormalKind::FaceAverage; });
    add("face average by angle", [](ShadingOptions& o) {
        o.limits.normals = LimitNormalKind::FaceAverage;
        o.startNormals.kind = StartNormalKind::Angle;
    });
    return all;
}

TEST(ShadingTable, AgreesWithTheOneShotPathInEveryOption) {
    for (Shape const& shape : AllShapes()) {
        for (int level = 1; level <= 3; ++level) {
            for (auto const& [name, options] : ManyOptions(level, HasOnlyRegularFaces(shape))) {
                ExpectAgreement(shape, options, name);
            }
        }
    }
}

TEST(ShadingTable, AgreesWithTheOneShotPathOnRandomMeshes) {
    shapes::Random random(20);
    for (std::uint64_t i = 0; i < SampleSize(150); ++i) {
        shapes::RandomShapeOptions kind;
        kind.triangles = random.Chance(0.4);
        kind.nonManifold = random.Chance(0.2);
        kind.chaikin = random.Chance(0.2);
        std::uint64_t const seed = random.Bits();
        Shape const shape = shapes::RandomShape(seed, kind);
        int const level = 1 + random.Below(4);
        auto const options = ManyOptions(level, HasOnlyRegularFaces(shape));
        auto const& [name, chosen] = options[Index(random.Below(static_cast<int>(options.size())))];
        ExpectAgreement(shape, chosen, name + ", seed " + std::to_string(seed));
    }
}

}  // namespace
