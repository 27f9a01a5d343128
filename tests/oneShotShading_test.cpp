// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/oneShotShading.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "osd_shading/blendedNormals.h"
#include "tests/testHelpers.h"

namespace {

using namespace osd_shading;
using namespace osd_shading::tests;

TEST(OneShotShading, ACubesCornersAreHalfAsFarAndShadedAlongTheirDiagonals) {
    ShadingResult<double> const cube = Shade<double>(shapes::Cube(), PaperPreset(4));
    double const third = 1 / std::sqrt(3.0);
    EXPECT_LE(Distance(cube.positions[6], {0.5, 0.5, 0.5}), 1e-15);
    for (auto const* normals : {&cube.limitNormals, &cube.subdividedNormals, &cube.blendedNormals}) {
        EXPECT_LE(Distance((*normals)[6], {third, third, third}), 1e-14);
    }
    EXPECT_NEAR(cube.blendWeights[6], 1, 1e-14);
    EXPECT_EQ(cube.report.vertices, 6 * 256 + 2);
    EXPECT_EQ(cube.report.faces, 6 * 256);
    EXPECT_EQ(cube.report.extraordinary, (std::map<int, std::int64_t>{{3, 8}}));
}

TEST(OneShotShading, DefaultsAreThePapers) {
    // [ZBK23]: start normals averaged from faces and weights of variant B, both from level 1, linear, p = 1.
    ShadingOptions const options = ResolveOptions(PaperPreset(), false, Sdc::SCHEME_CATMARK);
    EXPECT_EQ(options.level, 4);
    EXPECT_EQ(options.startNormals.kind, StartNormalKind::Uniform);
    EXPECT_EQ(options.startNormals.level, 1);
    EXPECT_EQ(options.subdividedNormals.averaging, NormalAveraging::Linear);
    EXPECT_EQ(options.weights.scheme, WeightScheme::OneRing);
    EXPECT_EQ(options.weights.sharpVertices, SharpVertexWeight::Zero);
    EXPECT_EQ(options.weights.darts, DartWeight::LikeSmooth);
    EXPECT_EQ(options.weights.level, 1);
    EXPECT_EQ(options.weights.exponent, 1);
    EXPECT_EQ(options.limits.positions, PositionKind::Limit);
    EXPECT_EQ(options.limits.normals, LimitNormalKind::Limit);
    EXPECT_EQ(options.execution.numThreads, 1);
    EXPECT_EQ(options.execution.memoryLimit, 0U);
}

TEST(OneShotShading, StartLevelsDefaultToOneOrTheLastLevel) {
    for (int const level : {0, 1, 2, 15}) {
        ShadingOptions const options = ResolveOptions(PaperPreset(level), false, Sdc::SCHEME_LOOP);
        EXPECT_EQ(options.startNormals.level, std::min(level, 1));
        EXPECT_EQ(options.weights.level, std::min(level, 1));
    }
    ShadingOptions user = PaperPreset(3);
    user.startNormals.kind = StartNormalKind::User;
    EXPECT_EQ(ResolveOptions(user, true, Sdc::SCHEME_CATMARK).startNormals.level, 0);
}

TEST(OneShotShading, TheSmoothPresetStartsAtLevelTwoOrTheLast) {
    for (int const level : {0, 1, 2, 5}) {
        ShadingResult<double> const result = Shade<double>(shapes::CubeWithSharpTop(1.5F), SmoothPreset(level));
        EXPECT_EQ(result.options.startNormals.kind, StartNormalKind::LimitSmoothed);
        EXPECT_EQ(result.options.startNormals.level, std::min(level, 2));
        EXPECT_EQ(result.options.weights.scheme, WeightScheme::One);
        for (std::size_t i = 0; i < result.blendWeights.size(); ++i) {
            EXPECT_EQ(result.blendWeights[i], 1);
            // Normalised once more.
            EXPECT_LE(Distance(result.blendedNormals[i], result.subdividedNormals[i]), 1e-15);
        }
    }
}

TEST(OneShotShading, AsManyThreadsAsTheMachineHasIsAtLeastOne) {
    ShadingOptions options;
    options.execution.numThreads = 0;
    EXPECT_GE(ResolveOptions(options, false, Sdc::SCHEME_CATMARK).execution.numThreads, 1);
}

TEST(OneShotShading, EveryValueIsTheBlendOfItsNormalsAndSubdividedOnlyWhereItCounts) {
    for (Shape const& shape : AllShapes()) {
        ShadingOptions options = PaperPreset(2);
        options.weights.exponent = 1.5;
        ShadingResult<double> const result = Shade<double>(shape, options);
        int numWeighted = 0;
        for (std::size_t i = 0; i < result.blendWeights.size(); ++i) {
            double const b = result.blendWeights[i];
            EXPECT_EQ(Distance(result.blendedNormals[i],
                               BlendNormals(result.limitNormals[i], result.subdividedNormals[i], b, 1.5)),
                      0);
            EXPECT_NEAR(Length(result.blendedNormals[i]), 1, 1e-15) << shape.name;
            if (b == 0) {
                EXPECT_TRUE(IsZero(result.subdividedNormals[i])) << shape.name;
                EXPECT_EQ(Distance(result.blendedNormals[i], result.limitNormals[i]), 0) << shape.name;
            }
            numWeighted += b > 0;
        }
        EXPECT_EQ(result.report.subdividedValues, numWeighted) << shape.name;
    }
}

TEST(OneShotShading, TheReportsCountsAreThoseOfTheResult) {
    for (Shape const& shape : AllShapes()) {
        ShadingResult<double> const result = Shade<double>(shape, PaperPreset(2));
        ShadingReport const& report = result.report;
        std::map<int, std::int64_t> interior, boundary;
        std::int64_t sharp = 0, darts = 0, boundaries = 0, nonManifold = 0, weighted = 0, opposed = 0;
        for (std::size_t v = 0; v < result.vertexTags.size(); ++v) {
            VertexTag const& tag = result.vertexTags[v];
            if (tag.isExtraordinary) ++(tag.isBoundary ? boundary : interior)[tag.valence];
            sharp += tag.kind == VertexKind::Crease || tag.kind == VertexKind::Corner;
            darts += tag.kind == VertexKind::Dart;
            boundaries += tag.isBoundary;
            nonManifold += tag.isNonManifold;
            bool hasWeight = false;
            for (int i = result.vertexValues[v]; i < result.vertexValues[v + 1]; ++i) {
                hasWeight = hasWeight || result.blendWeights[Index(i)] > 0;
            }
            weighted += hasWeight;
        }
        double sum = 0, largest = 0;
        for (std::size_t i = 0; i < result.blendWeights.size(); ++i) {
            double const angle = AngleBetween(result.limitNormals[i], result.blendedNormals[i]) * 57.29577951308232;
            sum += angle;
            largest = std::fmax(largest, angle);
            opposed += result.blendWeights[i] > 0 && Dot(result.limitNormals[i], result.subdividedNormals[i]) < 0;
        }
        EXPECT_EQ(report.extraordinary, interior) << shape.name;
        EXPECT_EQ(report.boundaryExtraordinary, boundary) << shape.name;
        EXPECT_EQ(report.sharpVertices, sharp) << shape.name;
        EXPECT_EQ(report.darts, darts) << shape.name;
        EXPECT_EQ(report.boundaryVertices, boundaries) << shape.name;
        EXPECT_EQ(report.nonManifoldVertices, nonManifold) << shape.name;
        EXPECT_EQ(report.verticesWithWeight, weighted) << shape.name;
        EXPECT_EQ(report.opposedNormals, opposed) << shape.name;
        EXPECT_EQ(report.vertices, result.NumVertices());
        EXPECT_EQ(report.faces, result.NumFaces());
        EXPECT_EQ(report.values, result.NumValues());
        EXPECT_NEAR(report.meanAngle, sum / result.NumValues(), 1e-6) << shape.name;  // limit normals keep rounding
        EXPECT_NEAR(report.maxAngle, largest, 1e-6) << shape.name;
        ASSERT_GE(report.maxAngleValue, 0);
        ASSERT_LT(report.maxAngleValue, result.NumValues());
    }
}

TEST(OneShotShading, TheResultsPartsReferToEachOther) {
    for (Shape const& shape : AllShapes()) {
        int const level = 2;
        ShadingResult<double> const result = Shade<double>(shape, PaperPreset(level));
        ASSERT_EQ(result.vertexValues.size(), result.positions.size() + 1);
        ASSERT_EQ(result.vertexValues.back(), result.NumValues());
        for (int v = 0; v < result.NumVertices(); ++v) {
            for (int i = result.vertexValues[Index(v)]; i < result.vertexValues[Index(v) + 1]; ++i) {
                ASSERT_EQ(result.valueVertices[Index(i)], v);
            }
        }
        for (auto const* perValue : {&result.limitNormals, &result.subdividedNormals, &result.blendedNormals}) {
            EXPECT_EQ(perValue->size(), result.valueVertices.size());
        }
        ASSERT_EQ(result.faceValues.size(), result.faceVertices.size());
        for (std::size_t i = 0; i < result.faceValues.size(); ++i) {
            ASSERT_EQ(result.valueVertices[Index(result.faceValues[i])], result.faceVertices[i]) << shape.name;
        }
        // Face by face as in OpenSubdiv, without holes.
        std::unique_ptr<Far::TopologyRefiner> const refiner = shapes::MakeRefiner(shape, level);
        Far::TopologyLevel const last = refiner->GetLevel(level);
        int next = 0;
        for (int f = 0; f < last.GetNumFaces(); ++f) {
            if (last.IsFaceHole(f)) continue;
            int base = f;
            for (int l = level; l > 0; --l) base = refiner->GetLevel(l).GetFaceParentFace(base);
            ASSERT_EQ(result.baseFaces[Index(next)], base) << shape.name;
            if (!result.refinerFaces.empty()) {
                ASSERT_EQ(result.refinerFaces[Index(next)], f) << shape.name;
            }
            for (int i = 0; i < result.faceSize; ++i) {
                ASSERT_EQ(result.faceVertices[Index(next * result.faceSize + i)], last.GetFaceVertices(f)[i]);
            }
            ++next;
        }
        EXPECT_EQ(result.NumFaces(), next) << shape.name;
        EXPECT_EQ(result.refinerFaces.empty(), next == last.GetNumFaces()) << shape.name;
    }
}

TEST(OneShotShading, CreaseEdgesKeepTheirControlEdgesSharpnessAndTellWhatIsLeft) {
    ShadingResult<double> const cube =
        Shade<double>(shapes::CubeWithSharpTop(2.5F).Crease(0, 4).Crease(1, 5, 1), PaperPreset(2));
    std::map<float, std::map<float, int>> found;  // by control sharpness and what is left of it
    for (CreaseEdge const& edge : cube.creaseEdges) ++found[edge.controlSharpness][edge.sharpness];
    EXPECT_EQ(found, (std::map<float, std::map<float, int>>{{2.5F, {{0.5F, 16}}}, {10, {{10, 4}}}, {1, {{0, 4}}}}));

    // An infinitely sharp ring of a plane stays in its plane.
    ShadingResult<double> const top = Shade<double>(shapes::CubeWithSharpTop(), PaperPreset(3));
    EXPECT_EQ(top.creaseEdges.size(), 32U);
    for (CreaseEdge const& edge : top.creaseEdges) {
        EXPECT_FALSE(edge.isBoundary);
        for (int const v : edge.vertices) {
            EXPECT_NEAR(top.positions[Index(v)].z, 1, 1e-15);
            EXPECT_GE(top.vertexTags[Index(v)].kind, VertexKind::Crease);
        }
    }
    ShadingResult<double> const box = Shade<double>(shapes::OpenBox(), PaperPreset(1));
    EXPECT_EQ(box.creaseEdges.size(), 8U);
    for (CreaseEdge const& edge : box.creaseEdges) {
        EXPECT_TRUE(edge.isBoundary);
        EXPECT_EQ(edge.controlSharpness, 10);
    }
}

TEST(OneShotShading, RefinedPositionsChangeNothingElse) {
    ShadingOptions options = PaperPreset(2);
    Shape const shape = shapes::CubeWithSharpTop(1.5F);
    ShadingResult<double> const limit = Shade<double>(shape, options);
    options.limits.positions = PositionKind::Refined;
    ShadingResult<double> const refined = Shade<double>(shape, options);
    EXPECT_TRUE(HasSameBits(limit.blendedNormals, refined.blendedNormals));
    EXPECT_TRUE(HasSameBits(limit.blendWeights, refined.blendWeights));
    EXPECT_TRUE(HasSameBits(refined.positions, Rooms<double>(shape, 2).points.back()));
}

TEST(OneShotShading, CoincidentPointsGiveZeroNormalsThatAreCounted) {
    for (Shape shape : AllShapes()) {
        std::fill(shape.positions.begin(), shape.positions.end(), 0.1);
        for (ShadingOptions const& options : {PaperPreset(2), SmoothPreset(2)}) {
            ShadingResult<float> const result = Shade<float>(shape, options);
            for (Vec3<float> const& n : result.blendedNormals) EXPECT_TRUE(IsZero(n)) << shape.name;
            EXPECT_EQ(result.report.zeroNormals, result.NumValues()) << shape.name;
            EXPECT_EQ(result.report.fallbackNormals, result.NumValues()) << shape.name;
            EXPECT_GT(result.report.zeroStartNormals, 0) << shape.name;
        }
    }
}

TEST(OneShotShading, WhereNothingElseHasANormalTheSubdividedOneStandsIn) {
    Shape shape = shapes::CubeWithSharpTop();
    std::fill(shape.positions.begin(), shape.positions.end(), 0.1);
    std::vector<Vec3<double>> const points = PointsOf<double>(shape), normals(8, Vec3<double>{0.6, 0, 0.8});
    ShadingInput<double> input;
    input.positions = points;
    input.vertexNormals = normals;
    ShadingOptions options = PaperPreset(2);
    options.startNormals.kind = StartNormalKind::User;
    ShadingResult<double> const result = ShadeSubdivision(shape.Mesh(), input, options);
    for (int i = 0; i < result.NumValues(); ++i) {
        EXPECT_LE(Distance(result.limitNormals[Index(i)], {0.6, 0, 0.8}), 1e-15);
        EXPECT_LE(Distance(result.blendedNormals[Index(i)], {0.6, 0, 0.8}), 1e-15);
        EXPECT_EQ(IsZero(result.subdividedNormals[Index(i)]), result.blendWeights[Index(i)] == 0);
    }
    EXPECT_EQ(result.report.zeroNormals, 0);
    EXPECT_EQ(result.report.subdividedValues, result.NumValues());
}

TEST(OneShotShading, OpposedNormalsAreCounted) {
    Shape const cube = shapes::Cube();
    std::vector<Vec3<double>> const points = PointsOf<double>(cube);
    std::vector<Vec3<double>> inwards = points;
    for (Vec3<double>& n : inwards) n = -1.0 * n;
    ShadingInput<double> input;
    input.positions = points;
    input.vertexNormals = inwards;
    ShadingOptions options = PaperPreset(1);
    options.startNormals.kind = StartNormalKind::User;
    ShadingResult<double> const result = ShadeSubdivision(cube.Mesh(), input, options);
    EXPECT_EQ(result.report.opposedNormals, 26);  // b is 1 on all vertices of level 1
    // The shortest is in the middle of a face: see OfACubeAreItsPointsAndShortenAsItDoes.
    EXPECT_NEAR(result.report.minSubdividedLength, 68 / (81 * std::sqrt(3.0)), 1e-14);
}

TEST(OneShotShading, AMeshWithoutExtraordinaryVerticesIsShadedByItsLimitAlone) {
    ShadingResult<double> const torus = Shade<double>(shapes::Torus(5, 4), PaperPreset(2));
    EXPECT_EQ(torus.report.subdividedValues, 0);
    EXPECT_EQ(torus.report.verticesWithWeight, 0);
    EXPECT_EQ(torus.report.minSubdividedLength, -1);
    EXPECT_EQ(torus.report.maxAngle, 0);
    EXPECT_TRUE(HasSameBits(torus.blendedNormals, torus.limitNormals));
}

TEST(OneShotShading, LargeValencesAndFacesAreShaded) {
    for (Shape const& shape : {shapes::Pyramid(1500), shapes::Bipyramid(1500), shapes::Bipyramid(1500).Loop()}) {
        ShadingResult<double> const result = Shade<double>(shape, PaperPreset(1));
        EXPECT_EQ(result.report.extraordinary.at(1500), 2) << shape.name;
        EXPECT_EQ(result.report.zeroNormals, 0) << shape.name;
        EXPECT_LE(Distance(result.blendedNormals[0], {0, 0, 1}), 1e-10) << shape.name;  // 1500 roundings
    }
}

template <typename Real>
void ExpectNumbersAtSize(Shape shape, double size) {
    for (double& x : shape.positions) x *= size;
    for (StartNormalKind const kind : {StartNormalKind::Uniform, StartNormalKind::CornerArea,
                                       StartNormalKind::Angle, StartNormalKind::LimitSmoothed}) {
        ShadingOptions options = PaperPreset(2);
        options.startNormals.kind = kind;
        ShadingResult<Real> const result = Shade<Real>(shape, options);
        for (std::size_t i = 0; i < result.blendWeights.size(); ++i) {
            ASSERT_TRUE(std::isfinite(result.blendWeights[i])) << shape.name << " " << size;
            for (auto const* normals : {&result.limitNormals, &result.subdividedNormals, &result.blendedNormals}) {
                double const length = static_cast<double>(Length((*normals)[i]));
                ASSERT_TRUE(length == 0 || std::fabs(length - 1) < 1e-6)
                    << shape.name << " " << size << " " << length;
            }
        }
        EXPECT_TRUE(std::isfinite(result.report.meanAngle) && std::isfinite(result.report.maxAngle));
    }
}

TEST(OneShotShading, NormalsOfMeshesOfAnySizeAreUnitOrZero) {
    for (Shape const& shape : AllShapes()) {
        for (double const size : {1e-320, 1e-300, 1e-170, 1e170, 1e300}) ExpectNumbersAtSize<double>(shape, size);
        for (double const size : {1e-44, 1e-38, 1e-25, 1e25, 1e37}) ExpectNumbersAtSize<float>(shape, size);
    }
}

TEST(OneShotShading, ResolvedOptionsNameWhatIsWrong) {
    auto const errorWith = [](auto const& change, bool hasIrregularFaces = false) {
        ShadingOptions options = PaperPreset(3);
        change(options);
        return ErrorOf<InvalidOptions>([&] { ResolveOptions(options, hasIrregularFaces, Sdc::SCHEME_CATMARK); });
    };
    using O = ShadingOptions;
    EXPECT_EQ(errorWith([](O&) {}), "no error");
    EXPECT_EQ(errorWith([](O& o) { o.level = -1; }), "level is -1; it must be 0 to 15");
    EXPECT_EQ(errorWith([](O& o) { o.level = 16; }), "level is 16; it must be 0 to 15");
    EXPECT_EQ(errorWith([](O& o) { o.level = 0; }, true),
              "level is 0, but the mesh has faces other than quads, where limits exist from level 1 on");
    EXPECT_EQ(errorWith([](O& o) { o.startNormals.level = 4; }),
              "the start level of normals is 4; it must be 0 to the level, 3");
    EXPECT_EQ(errorWith([](O& o) { o.startNormals.level = -2; }),
              "the start level of normals is -2; it must be 0 to the level, 3");
    EXPECT_EQ(errorWith([](O& o) { o.weights.level = 4; }),
              "the start level of weights is 4; it must be 0 to the level, 3");
    auto const user = [](O& o) {
        o.startNormals.kind = StartNormalKind::User;
        o.startNormals.level = 1;
    };
    EXPECT_EQ(errorWith(user), "the start level of normals is 1, but user normals are those of level 0");
    for (StartNormalKind const kind : {StartNormalKind::Limit, StartNormalKind::LimitSmoothed}) {
        auto const atZero = [kind](O& o) {
            o.startNormals.kind = kind;
            o.startNormals.level = 0;
        };
        EXPECT_EQ(errorWith(atZero), "no error");
        EXPECT_EQ(
            errorWith(atZero, true),
            "limit normals can't start at level 0, where the mesh has faces other than quads; start at level 1");
    }
    auto const inverse = [](O& o) {
        o.weights.scheme = WeightScheme::InverseLimit;
        o.weights.level = 0;
    };
    EXPECT_EQ(errorWith(inverse), "no error");
    EXPECT_EQ(errorWith(inverse, true),
              "inverse-limit weights can't start at level 0, where the mesh has faces "
              "other than quads; start at 1");
    double const nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    for (auto const& [wrong, word] : {std::pair{0.0, "0"}, std::pair{-1.0, "-1"}, std::pair{-1e-300, "-1e-300"},
                                      std::pair{nan, "nan"}, std::pair{infinity, "inf"}}) {
        EXPECT_EQ(errorWith([&, exponent = wrong](O& o) { o.weights.exponent = exponent; }),
                  "the exponent of the blend weight is " + std::string(word) + "; it must be positive");
    }
    EXPECT_EQ(errorWith([](O& o) { o.subdividedNormals.sphericalSteps = -1; }),
              "sphericalSteps is -1; it must be 0 to 100");
    EXPECT_EQ(errorWith([](O& o) { o.subdividedNormals.sphericalSteps = 101; }),
              "sphericalSteps is 101; it must be 0 to 100");
    EXPECT_EQ(errorWith([](O& o) { o.execution.numThreads = -1; }), "numThreads is -1; it must be 0 or more");
}

TEST(OneShotShading, TrianglesInLoopAreRegularAtLevelZero) {
    EXPECT_EQ(Shade<double>(shapes::Icosahedron().Loop(), PaperPreset(0)).NumVertices(), 12);
    EXPECT_EQ(ErrorOf<InvalidOptions>([] { Shade<double>(shapes::Icosahedron(), PaperPreset(0)); }),
              "level is 0, but the mesh has faces other than quads, where limits exist from level 1 on");
}

TEST(OneShotShading, WhereAllFacesAreHolesThePrimvarsHaveNoneEither) {
    Shape const quad = shapes::LoneQuad().Boundary(Sdc::Options::VTX_BOUNDARY_NONE);
    std::vector<Vec3<double>> const points = PointsOf<double>(quad);
    std::vector<int> const indices{0, 1, 2, 3};
    std::vector<double> const uvs{0, 0, 1, 0, 1, 1, 0, 1};
    ShadingInput<double> input;
    input.positions = points;
    input.faceVaryingData.push_back({indices, {uvs.data(), 4, 2}});
    ShadingResult<double> const result = ShadeSubdivision(quad.Mesh(), input, PaperPreset(2));
    EXPECT_EQ(result.NumFaces(), 0);
    EXPECT_TRUE(result.faceVaryingData[0].faceIndices.empty());
}

TEST(OneShotShading, TheResultKeepsNothingOfTheCallersProgress) {
    ShadingOptions options = PaperPreset(1);
    options.execution.progress = [](double) { return true; };
    EXPECT_FALSE(Shade<double>(shapes::Cube(), options).options.execution.progress);
}

}  // namespace
