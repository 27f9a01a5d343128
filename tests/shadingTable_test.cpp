// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/shadingTable.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <utility>

#include "tests/sampleSize.h"
#include "tests/tableAgreement.h"

namespace {

using namespace osd_shading;
using namespace osd_shading::tests;

/// Rounding of float coordinates, some units in the last place, of the model's size; and of normals.
constexpr double kPositions = 2e-7, kNormals = 1e-5;

void ExpectAgreement(Shape const& shape, ShadingOptions const& options, std::string const& what,
                     std::vector<float> const& userNormals = {}) {
    SCOPED_TRACE(shape.name + ", level " + std::to_string(options.level) + ", " + what);
    std::vector<float> const points = shape.FloatPositions();
    ShadingTable const table(shape.Mesh(), options);
    TableFrame const frame =
        EvaluateAll(table, {points.data(), points.size() / 3}, {}, {userNormals.data(), userNormals.size() / 3});
    Reference const reference = ReferenceOf(shape.Mesh(), points, options, userNormals);
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
    add("exact", [](ShadingOptions& o) { o.limits.normals = LimitNormalKind::Exact; });
    add("exact, variant A", [](ShadingOptions& o) {
        o.limits.normals = LimitNormalKind::Exact;
        o.weights.sharpVertices = SharpVertexWeight::Smooth;
    });
    return all;
}

TEST(ShadingTable, AgreesWithTheOneShotPathInEveryOption) {
    SweepSample sample(5);
    for (Shape const& shape : AllShapes()) {
        for (int level = 1; level <= 3; ++level) {
            for (auto const& [name, options] : ManyOptions(level, HasOnlyRegularFaces(shape))) {
                if (sample.Takes()) ExpectAgreement(shape, options, name);
            }
        }
    }
}

TEST(ShadingTable, AgreesWithTheOneShotPathOnRandomMeshes) {
    shapes::Random random(20);
    for (std::uint64_t i = 0; i < SampleSize(150); ++i) {
        shapes::RandomShapeOptions const kind = AnyKind(random);
        std::uint64_t const seed = random.Bits();
        Shape const shape = shapes::RandomShape(seed, kind);
        int const level = 1 + random.Below(4);
        auto const options = ManyOptions(level, HasOnlyRegularFaces(shape));
        auto const& [name, chosen] = options[Index(random.Below(static_cast<int>(options.size())))];
        ExpectAgreement(shape, chosen, name + ", seed " + std::to_string(seed));
    }
}

TEST(ShadingTable, AgreesWithTheOneShotPathOnTheCallersNormals) {
    for (Shape const& shape : AllShapes()) {
        shapes::Random random(3);
        for (std::size_t const count : {Index(shape.NumVertices()), shape.faceVertices.size()}) {
            std::vector<float> normals;
            for (std::size_t i = 0; i < 3 * count; ++i)
                normals.push_back(static_cast<float>(random.Uniform(-1, 1)));
            ShadingOptions options = PaperPreset(2);
            options.startNormals.kind = StartNormalKind::User;
            options.startNormals.level = 0;
            ExpectAgreement(shape, options, std::to_string(count) + " normals", normals);
        }
    }
}

/// Shapes of every kind, few enough for tests that build several tables of each.
std::vector<Shape> SomeShapes() {
    std::vector<Shape> some = {shapes::CubeWithSharpTop(),
                               shapes::GridWithDart(1.5F),
                               shapes::MixedPolygons(),
                               shapes::Cross().CreaseAll(2.5F),
                               shapes::FinnedGrid(),
                               shapes::TwoBoxesSharingAVertex(),
                               shapes::IsolatedVertex(),
                               shapes::Torus(6, 5).Hole(7),
                               shapes::OpenBox().Chaikin().CreaseAll(1.5F),
                               shapes::Pyramid(5).Hole(2),
                               shapes::Icosahedron().Loop().Crease(0, 1),
                               shapes::TriangleFan(7).Loop().Hole(3)};
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
        shapes::RandomShapeOptions kind;
        kind.triangles = seed % 2 == 1;
        kind.nonManifold = seed >= 4;
        some.push_back(shapes::RandomShape(70 + seed, kind));
    }
    return some;
}

TEST(ShadingTable, OfARefinerIsThatOfItsMesh) {
    for (Shape const& shape : SomeShapes()) {
        std::vector<float> const points = shape.FloatPositions();
        for (ShadingOptions const& options : {PaperPreset(3), SmoothPreset(3)}) {
            ShadingTable const own(shape.Mesh(), options), other(*shapes::MakeRefiner(shape, 1), options);
            EXPECT_TRUE(IsSameFrame(EvaluateAll(own, {points.data(), points.size() / 3}),
                                    EvaluateAll(other, {points.data(), points.size() / 3})))
                << shape.name;
            EXPECT_EQ(own.FaceValues(), other.FaceValues()) << shape.name;
            EXPECT_EQ(own.BaseFaces(), other.BaseFaces()) << shape.name;
            EXPECT_EQ(own.ResultValues(), other.ResultValues()) << shape.name;
            EXPECT_EQ(own.NumBytes(), other.NumBytes()) << shape.name;
        }
    }
}

/// `values` with element i at place `places[i]`.
template <typename T>
std::vector<T> Moved(std::vector<T> const& values, std::vector<int> const& places) {
    std::vector<T> moved(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) moved[Index(places[i])] = values[i];
    return moved;
}

TEST(ShadingTable, InOpenSubdivsOrderHoldsTheSameBitsInOtherPlaces) {
    for (Shape const& shape : SomeShapes()) {
        std::vector<float> const points = shape.FloatPositions();
        PointView<float> const view{points.data(), points.size() / 3};
        for (ShadingOptions const& options : {PaperPreset(1), PaperPreset(4), SmoothPreset(3)}) {
            ShadingTable const tiles(shape.Mesh(), options);
            ShadingTable const ordered(shape.Mesh(), options, ValueOrder::OpenSubdiv);
            std::vector<int> const places = tiles.ResultValues();
            TableFrame frame = EvaluateAll(tiles, view);
            for (auto* const field : {&frame.positions, &frame.blendedNormals, &frame.limitNormals,
                                      &frame.subdividedNormals, &frame.du, &frame.dv}) {
                *field = Moved(*field, places);
            }
            frame.blendWeights = Moved(frame.blendWeights, places);
            EXPECT_TRUE(IsSameFrame(frame, EvaluateAll(ordered, view))) << shape.name;

            std::vector<int> faces = tiles.FaceValues();
            for (int& value : faces) value = places[Index(value)];
            EXPECT_EQ(faces, ordered.FaceValues()) << shape.name;
            EXPECT_EQ(tiles.BaseFaces(), ordered.BaseFaces()) << shape.name;
            EXPECT_EQ(Moved(tiles.RefinedVertices(), places), ordered.RefinedVertices()) << shape.name;
            EXPECT_EQ(Moved(tiles.BlendWeights(), places), ordered.BlendWeights()) << shape.name;
        }
    }
}

/// Faces as sets: each turned to its least rotation, with the control face that it comes from, sorted.
std::vector<std::array<int, 5>> FacesAsSet(std::vector<int> const& values, std::vector<int> const& baseFaces,
                                           std::size_t faceSize) {
    std::vector<std::array<int, 5>> faces;
    for (std::size_t f = 0; f < baseFaces.size(); ++f) {
        std::vector<int> least, face(values.begin() + static_cast<std::ptrdiff_t>(f * faceSize),
                                     values.begin() + static_cast<std::ptrdiff_t>((f + 1) * faceSize));
        for (std::size_t turn = 0; turn < faceSize; ++turn) {
            std::rotate(face.begin(), face.begin() + 1, face.end());
            if (least.empty() || face < least) least = face;
        }
        std::array<int, 5> named{};
        std::copy(least.begin(), least.end(), named.begin());
        named[4] = baseFaces[f];
        faces.push_back(named);
    }
    std::sort(faces.begin(), faces.end());
    return faces;
}

TEST(ShadingTable, HasTheFacesAndVerticesOfTheResult) {
    for (Shape const& shape : AllShapes()) {
        for (int level = HasOnlyRegularFaces(shape) ? 0 : 1; level <= 3; ++level) {
            SCOPED_TRACE(shape.name + ", level " + std::to_string(level));
            ShadingTable const table(shape.Mesh(), PaperPreset(level));
            ShadingResult<double> const result = Shade<double>(shape, PaperPreset(level));
            ASSERT_EQ(table.NumFaces(), result.NumFaces());
            ASSERT_EQ(table.NumValues(), result.NumValues());
            ASSERT_EQ(table.FaceSize(), result.faceSize);
            EXPECT_EQ(table.NumControlVertices(), shape.NumVertices());
            EXPECT_EQ(table.NumControlFaceCorners(), static_cast<int>(shape.faceVertices.size()));
            std::vector<int> const places = table.ResultValues();
            std::vector<int> faces = table.FaceValues();
            std::vector<int> const triangles = table.TriangleValues(), own = faces;
            for (int& value : faces) value = places[Index(value)];
            ASSERT_EQ(faces.size(), result.faceValues.size());
            std::size_t const size = Index(table.FaceSize());
            EXPECT_EQ(FacesAsSet(faces, table.BaseFaces(), size),
                      FacesAsSet(result.faceValues, result.baseFaces, size));

            std::vector<int> const vertices = table.RefinedVertices();
            for (std::size_t i = 0; i < places.size(); ++i) {
                ASSERT_EQ(vertices[i], result.valueVertices[Index(places[i])]) << "value " << i;
            }
            std::vector<int> expected;
            for (std::size_t f = 0; f < own.size(); f += size) {
                for (std::size_t i = 1; i + 1 < size; ++i) {
                    expected.insert(expected.end(), {own[f], own[f + i], own[f + i + 1]});
                }
            }
            EXPECT_EQ(triangles, expected);

            std::vector<float> const weights = table.BlendWeights();
            for (std::size_t i = 0; i < places.size(); ++i) {
                double const b = result.blendWeights[Index(places[i])];
                ASSERT_NEAR(double{weights[i]}, b, 1e-6) << "value " << i;
                ASSERT_EQ(weights[i] > 0, b > 0) << "value " << i;
            }
        }
    }
}

TEST(ShadingTable, CountsWhatItHolds) {
    // A torus is 30 bicubic patches; on level 3 each has 8 x 8 faces.
    ShadingTable const torus(shapes::Torus(6, 5).Mesh(), PaperPreset(3));
    EXPECT_EQ(torus.Stats().tiles, 30);
    EXPECT_EQ(torus.Stats().regularTiles, 30);
    EXPECT_EQ(torus.Stats().blendedTiles, 0);
    EXPECT_EQ(torus.Stats().blendedValues, 0);
    EXPECT_EQ(torus.Stats().faces, 30 * 64);
    EXPECT_EQ(torus.Stats().values, 30 * 64);
    EXPECT_EQ(torus.Stats().denseMatrices, 0);

    for (Shape const& shape : SomeShapes()) {
        ShadingTable const table(shape.Mesh(), PaperPreset(3));
        ShadingTableStats const& stats = table.Stats();
        EXPECT_EQ(stats.values, table.NumValues()) << shape.name;
        EXPECT_EQ(stats.faces, table.NumFaces()) << shape.name;
        std::vector<float> const weights = table.BlendWeights();
        EXPECT_EQ(stats.blendedValues, std::count_if(weights.begin(), weights.end(), [](float b) { return b > 0; }))
            << shape.name;
        EXPECT_GT(stats.dictionaryBytes, 0U) << shape.name;
        EXPECT_GT(stats.bytes, stats.dictionaryBytes) << shape.name;
        EXPECT_EQ(table.NumBytes(), stats.bytes) << shape.name;
    }
}

TEST(ShadingTable, IsTheSameForAnyNumberOfThreads) {
    for (Shape const& shape : SomeShapes()) {
        std::vector<float> const points = shape.FloatPositions();
        ShadingOptions options = PaperPreset(3);
        ShadingTable const one(shape.Mesh(), options);
        for (int const numThreads : {0, 2, 5}) {
            options.execution.numThreads = numThreads;
            ShadingTable const several(shape.Mesh(), options);
            EXPECT_TRUE(IsSameFrame(EvaluateAll(one, {points.data(), points.size() / 3}),
                                    EvaluateAll(several, {points.data(), points.size() / 3})))
                << shape.name;
            EXPECT_EQ(one.FaceValues(), several.FaceValues()) << shape.name;
            EXPECT_EQ(one.NumBytes(), several.NumBytes()) << shape.name;
        }
    }
}

TEST(ShadingTable, RefusesInWords) {
    Shape const cube = shapes::Cube();
    auto const errorOf = [&](auto const& change) {
        ShadingOptions options = PaperPreset(2);
        change(options);
        return ErrorOf<InvalidOptions>([&] { ShadingTable(cube.Mesh(), options); });
    };
    EXPECT_EQ(errorOf([](ShadingOptions& o) { o.subdividedNormals.averaging = NormalAveraging::Spherical; }),
              "a table holds linear averaging of normals only; use ShadeSubdivision for the others");
    EXPECT_EQ(errorOf([](ShadingOptions& o) { o.subdividedNormals.averaging = NormalAveraging::Renormalised; }),
              "a table holds linear averaging of normals only; use ShadeSubdivision for the others");
    EXPECT_EQ(errorOf([](ShadingOptions& o) { o.level = 16; }), "level is 16; it must be 0 to 15");
    EXPECT_NE(errorOf([](ShadingOptions& o) { o.startNormals.level = 3; }), "no error");
    EXPECT_NE(errorOf([](ShadingOptions& o) { o.weights.exponent = 0; }), "no error");
    EXPECT_NE(errorOf([](ShadingOptions& o) { o.execution.numThreads = -1; }), "no error");

    Shape const pyramid = shapes::Pyramid(4);
    EXPECT_NE(ErrorOf<InvalidOptions>([&] { ShadingTable(pyramid.Mesh(), PaperPreset(0)); }), "no error");
    ControlMesh broken = cube.Mesh();
    broken.numVertices = 7;
    EXPECT_NE(ErrorOf<InvalidControlMesh>([&] { ShadingTable(broken, PaperPreset(2)); }), "no error");
    ControlMesh quads = cube.Mesh();
    quads.rules.scheme = Sdc::SCHEME_LOOP;
    EXPECT_NE(ErrorOf<InvalidControlMesh>([&] { ShadingTable(quads, PaperPreset(2)); }), "no error");
}

TEST(ShadingTable, ThatWouldTakeMoreThanItsLimitIsRefused) {
    Shape const torus = shapes::Torus(20, 20);
    ShadingOptions options = PaperPreset(5);
    options.execution.memoryLimit = 1000;
    EXPECT_NE(ErrorOf<MemoryLimitExceeded>([&] { ShadingTable(torus.Mesh(), options); }), "no error");
}

TEST(ShadingTable, OfMoreFacesThanIntCanNumberIsRefusedBeforeAnyWork) {
    Shape const torus = shapes::Torus(20, 20);
    std::string const expected = "level 12 has more faces than 32-bit indices can number; use a lower level";
    EXPECT_EQ(ErrorOf<MemoryLimitExceeded>([&] { ShadingTable(torus.Mesh(), PaperPreset(12)); }), expected);
    auto const refiner = shapes::MakeRefiner(torus, 0);
    EXPECT_EQ(ErrorOf<MemoryLimitExceeded>([&] { ShadingTable(*refiner, PaperPreset(12)); }), expected);
}

TEST(ShadingTable, StopsWhenItsProgressIsRefused) {
    Shape const torus = shapes::Torus(20, 20).CreaseAll(1.5F);
    ShadingOptions options = PaperPreset(4);
    options.execution.progress = [](double) { return false; };
    EXPECT_NE(ErrorOf<Cancelled>([&] { ShadingTable(torus.Mesh(), options); }), "no error");
}

}  // namespace
