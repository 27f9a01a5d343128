// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/geometryCheck.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "osd_shading/io/objReader.h"
#include "tests/ioFiles.h"
#include "tests/sampleSize.h"
#include "tests/testHelpers.h"

namespace osd_shading::tests {
namespace {

GeometryComparison const& comparisonNamed(GeometryCheck const& check, std::string const& name) {
    return *std::find_if(check.comparisons.begin(), check.comparisons.end(),
                         [&](GeometryComparison const& comparison) { return comparison.name == name; });
}

template <typename Real>
GeometryCheck checkShape(Shape const& shape, ShadingOptions const& options) {
    std::vector<Vec3<Real>> const points = PointsOf<Real>(shape);
    return CheckGeometry<Real>(shape.Mesh(), points, Shade<Real>(shape, options));
}

std::string describe(GeometryCheck const& check) {
    std::string text;
    for (GeometryComparison const& comparison : check.comparisons) {
        text += comparison.name + ": " + std::to_string(comparison.compared) + " of " +
                std::to_string(comparison.total) + ", largest " + std::to_string(comparison.largest * 1e15) +
                "e-15 at vertex " + std::to_string(comparison.vertex) + " of level " +
                std::to_string(comparison.level) + "\n";
    }
    return text;
}

/// The model, or nothing where it has a face with a repeated vertex, which is refused.
std::optional<io::Model> readUnlessRefused(std::string const& file) {
    try {
        return io::ReadObj(file);
    } catch (Error const& error) {
        EXPECT_NE(std::string(error.what()).find("more than once"), std::string::npos) << error.what();
        return std::nullopt;
    }
}

/// Every level of a model that has limits, both schemes where they apply.
void checkModel(std::string const& file) {
    std::optional<io::Model> const model = readUnlessRefused(file);
    if (!model) return;
    int const lastLevel = LastLevelOf(model->faceVertices.size(), 4);
    auto const allHave = [&](int size) {
        return std::all_of(model->faceSizes.begin(), model->faceSizes.end(), [&](int n) { return n == size; });
    };
    for (Sdc::SchemeType const scheme : {Sdc::SCHEME_CATMARK, Sdc::SCHEME_LOOP}) {
        if (scheme == Sdc::SCHEME_LOOP && !allHave(3)) continue;
        SubdivisionRules rules;
        rules.scheme = scheme;
        ControlMesh const mesh = model->Mesh(model->Rules(rules));
        PointView<double> const points(model->positions.data(), model->positions.size() / 3);
        ShadingInput<double> input;
        input.positions = points;
        for (int level = scheme == Sdc::SCHEME_CATMARK && !allHave(4) ? 1 : 0; level <= lastLevel; ++level) {
            GeometryCheck const check =
                CheckGeometry(mesh, points, ShadeSubdivision(mesh, input, PaperPreset(level)));
            // Masks add some 30 numbers of the model's size a level: a few hundred roundings of 1e-16.
            EXPECT_TRUE(check.Passes(1e-12)) << file << " level " << level << "\n" << describe(check);
            GeometryComparison const& limit = comparisonNamed(check, "limit");
            EXPECT_EQ(limit.compared, limit.total) << file;
            GeometryComparison const& stencils = comparisonNamed(check, "stencils");
            EXPECT_EQ(stencils.compared, stencils.total) << file;
        }
    }
}

TEST(GeometryCheck, PositionsEqualOpenSubdivsOnEveryModelOfOurs) {
    std::vector<std::string> const files = ioFiles::OwnModels();
    ASSERT_FALSE(files.empty());
    for (auto const& file : files) checkModel(file);
}

TEST(GeometryCheck, PositionsEqualOpenSubdivsOnEveryFurtherModel) {
    std::vector<std::string> const files = ioFiles::SharedModels();
    if (files.empty()) GTEST_SKIP() << "there are no further models in " << OSD_SHADING_EXTRA_MODELS;
    for (auto const& file : files) checkModel(file);
}

TEST(GeometryCheck, ComparesEveryVertexOfAModelWithoutTheExceptedCases) {
    for (Shape const& shape : {shapes::Cube(), shapes::Icosahedron().Loop(), shapes::Torus(6, 5)}) {
        for (int level = 0; level <= 3; ++level) {
            GeometryCheck const check = checkShape<double>(shape, PaperPreset(level));
            for (GeometryComparison const& comparison : check.comparisons) {
                EXPECT_EQ(comparison.compared, comparison.total) << shape.name << " " << comparison.name;
            }
            EXPECT_EQ(comparisonNamed(check, "bfr").total, Shade<double>(shape, PaperPreset(level)).NumVertices());
        }
    }
}

TEST(GeometryCheck, LeavesOutWhatOpenSubdivOnlyApproximates) {
    Shape cube = shapes::Cube();
    cube.Crease(0, 1);  // a lone sharp edge: its two ends are darts
    GeometryCheck const check = checkShape<double>(cube, PaperPreset(2));
    EXPECT_EQ(comparisonNamed(check, "bfr").compared, comparisonNamed(check, "bfr").total - 2);
    EXPECT_EQ(comparisonNamed(check, "limit").compared, comparisonNamed(check, "limit").total);
}

TEST(GeometryCheck, FindsAMovedVertexAndATurnedNormalAndSaysWhere) {
    Shape const cube = shapes::Cube();
    std::vector<Vec3<double>> const points = PointsOf<double>(cube);
    ShadingResult<double> result = Shade<double>(cube, PaperPreset(2));
    ASSERT_TRUE(CheckGeometry<double>(cube.Mesh(), points, result).Passes(1e-12));

    ShadingResult<double> moved = result;
    moved.positions[17].y += 1e-9;
    GeometryCheck const check = CheckGeometry<double>(cube.Mesh(), points, moved);
    EXPECT_FALSE(check.Passes(1e-12));
    for (char const* name : {"limit", "bfr"}) {
        EXPECT_EQ(comparisonNamed(check, name).vertex, 17);
        EXPECT_EQ(comparisonNamed(check, name).level, 2);
        EXPECT_NEAR(comparisonNamed(check, name).largest * check.modelSize, 1e-9, 1e-14);
    }

    ShadingResult<double> turned = result;
    turned.limitNormals[5] = {1, 0, 0};
    GeometryCheck const turnedCheck = CheckGeometry<double>(cube.Mesh(), points, turned);
    EXPECT_FALSE(turnedCheck.Passes(1e-12));
    EXPECT_EQ(comparisonNamed(turnedCheck, "limit_normals").vertex, 5);

    ShadingResult<double> spoiled = result;
    spoiled.positions[3].x = std::nan("");
    EXPECT_FALSE(CheckGeometry<double>(cube.Mesh(), points, spoiled).Passes(1));
}

TEST(GeometryCheck, ChecksRefinedPositionsAgainstStencils) {
    Shape const cube = shapes::Cube();
    ShadingOptions options = PaperPreset(2);
    options.limits.positions = PositionKind::Refined;
    std::vector<Vec3<double>> const points = PointsOf<double>(cube);
    ShadingResult<double> result = Shade<double>(cube, options);
    EXPECT_TRUE(CheckGeometry<double>(cube.Mesh(), points, result).Passes(1e-12));
    result.positions[20].z += 1e-6;
    GeometryCheck const check = CheckGeometry<double>(cube.Mesh(), points, result);
    EXPECT_EQ(comparisonNamed(check, "stencils").vertex, 20);
    EXPECT_FALSE(check.Passes(1e-12));
}

TEST(GeometryCheck, FloatResultsAgreeWithOpenSubdivInFloat) {
    for (Shape const& shape : AllShapes()) {
        ShadingOptions options = PaperPreset(3);
        // Float has 6e-8 of a model's size; normals lose what the last level's edges are smaller.
        EXPECT_TRUE(checkShape<float>(shape, options).Passes(1e-6)) << shape.name;
    }
}

TEST(GeometryCheck, FloatResultsOfFurtherModelsAgreeWithOpenSubdivInDouble) {
    std::vector<std::string> const files = ioFiles::SharedModels();
    if (files.empty()) GTEST_SKIP() << "there are no further models in " << OSD_SHADING_EXTRA_MODELS;
    for (auto const& file : files) {
        std::optional<io::Model> const model = readUnlessRefused(file);
        if (!model) continue;
        std::vector<float> const points(model->positions.begin(), model->positions.end());
        ControlMesh const mesh = model->Mesh(model->Rules({}));
        ShadingInput<float> input;
        input.positions = {points.data(), points.size() / 3};
        GeometryCheck const check =
            CheckGeometry(mesh, input.positions, ShadeSubdivision(mesh, input, PaperPreset(2)));
        // Some ten roundings of 6e-8 a level, at numbers not much larger than the model.
        EXPECT_TRUE(check.Passes(1e-6)) << file << "\n" << describe(check);
    }
}

TEST(GeometryCheck, AResultOfAnImpossibleLevelIsRefused) {
    Shape const cube = shapes::Cube();
    std::vector<Vec3<double>> const points = PointsOf<double>(cube);
    for (int const level : {-3, -1, 16, 40}) {
        ShadingResult<double> result;
        result.options.level = level;
        EXPECT_EQ(ErrorOf<InvalidOptions>([&] { CheckGeometry<double>(cube.Mesh(), points, result); }),
                  "level is " + std::to_string(level) + "; it must be 0 to 15");
    }
}

TEST(GeometryCheck, NonManifoldMeshesPassWhateverBfrMakesOfThem) {
    for (std::uint64_t seed = 0; seed < SampleSize(300); ++seed) {
        shapes::RandomShapeOptions options;
        options.triangles = seed % 2 == 1;
        options.nonManifold = true;
        Shape const shape = shapes::RandomShape(40000 + seed, options);
        GeometryCheck const check = checkShape<double>(shape, PaperPreset(1 + static_cast<int>(seed % 3)));
        EXPECT_TRUE(check.Passes(1e-12)) << "seed " << 40000 + seed << "\n" << describe(check);
    }
}

TEST(GeometryCheck, ANonManifoldCreaseOfManyFacesIsCheckedWithoutOpenSubdivsTangents) {
    // Its Limit() would write past its own buffer: more faces than edges meet at the crease.
    Shape const shape = shapes::FinnedGrid();
    GeometryCheck const check = checkShape<double>(shape, PaperPreset(2));
    EXPECT_TRUE(check.Passes(1e-12)) << describe(check);
    EXPECT_EQ(comparisonNamed(check, "limit").compared, comparisonNamed(check, "limit").total);
}

TEST(GeometryCheck, AResultOfAnotherMeshIsRefused) {
    ShadingResult<double> const result = Shade<double>(shapes::Cube(), PaperPreset(1));
    Shape const other = shapes::Torus(6, 5);
    std::vector<Vec3<double>> const points = PointsOf<double>(other);
    std::string const words = ErrorOf<InvalidOptions>([&] { CheckGeometry<double>(other.Mesh(), points, result); });
    EXPECT_NE(words.find("was not shaded from this mesh"), std::string::npos) << words;
    std::vector<Vec3<double>> const tooFew(3);
    std::string const counts =
        ErrorOf<InvalidControlMesh>([&] { CheckGeometry<double>(other.Mesh(), tooFew, result); });
    EXPECT_NE(counts.find("positions has 3 elements; the mesh needs 30"), std::string::npos) << counts;
}

}  // namespace
}  // namespace osd_shading::tests
