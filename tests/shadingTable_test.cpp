// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/shadingTable.h"

#include <gtest/gtest.h>

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

}  // namespace
