// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/composedRows.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "osd_shading/blendWeights.h"
#include "osd_shading/errors.h"
#include "tests/sampleSize.h"
#include "tests/testHelpers.h"

namespace {

using namespace osd_shading;
using namespace osd_shading::tests;

/// Sums of the rows of `level`, by element.
std::vector<Vec3<double>> Apply(ComposedLevel const& level, std::vector<Vec3<double>> const& sources) {
    std::vector<Vec3<double>> sums;
    for (int i = 0; i < level.NumElements(); ++i) {
        RowSum<1> sum(level.numSources);
        level.AddTo<1>(sum, i, {1});
        SparseRows<double, 1> row;
        sum.MoveTo(row);
        Vec3<double> point{};
        for (std::size_t t = 0; t < row.sources.size(); ++t) {
            point += row.weights[0][t] * sources[Index(row.sources[t])];
        }
        sums.push_back(point);
    }
    return sums;
}

TEST(ComposedRows, ASumJoinsTermsSortsThemAndStartsAnew) {
    RowSum<2> sum(5);
    sum.Add(3, {1, 2});
    sum.Add(1, {0.25, 0});
    sum.Add(3, {0.5, -2});
    sum.Add(4, {0, 0});
    SparseRows<float, 2> rows;
    sum.MoveTo(rows);
    sum.Add(4, {0, 7});
    sum.MoveTo(rows);
    sum.MoveTo(rows);
    EXPECT_EQ(rows.offsets, (std::vector<std::size_t>{0, 2, 3, 3}));
    EXPECT_EQ(rows.sources, (std::vector<int>{1, 3, 4}));
    EXPECT_EQ(rows.weights[0], (std::vector<float>{0.25F, 1.5F, 0}));
    EXPECT_EQ(rows.weights[1], (std::vector<float>{0, 0, 7}));
}

TEST(ComposedRows, OfVerticesGiveTheRefinedPoints) {
    for (Shape const& shape : AllShapes()) {
        Rooms<double> const rooms(shape, 3);
        ComposedLevel level = IdentityLevel(shape.NumVertices());
        for (int l = 1; l <= 3; ++l) {
            level = ComposeVertices(level, rooms.levels.Masks(l), 2);
            std::vector<Vec3<double>> const found = Apply(level, rooms.points[0]);
            ASSERT_EQ(found.size(), rooms.points[Index(l)].size());
            for (std::size_t i = 0; i < found.size(); ++i) {
                ASSERT_LE(Distance(found[i], rooms.points[Index(l)][i]), 1e-14) << shape.name << " level " << l;
            }
        }
    }
}

TEST(ComposedRows, DoNotDependOnTheThreads) {
    auto const makeFill = [] {
        return [](int row, RowSum<1>& sum) {
            for (int i = 0; i < row % 7; ++i) sum.Add((row * 31 + i * 17) % 1000, {1.0 / (1 + row + i)});
        };
    };
    int const numRows = 3 * kChunkSize + 5;
    SparseRows<float, 1> const one = BuildRows<float, 1>(numRows, 1000, 1, makeFill);
    SparseRows<float, 1> const three = BuildRows<float, 1>(numRows, 1000, 3, makeFill);
    EXPECT_EQ(one.NumRows(), numRows);
    EXPECT_TRUE(HasSameBits(one.offsets, three.offsets));
    EXPECT_TRUE(HasSameBits(one.sources, three.sources));
    EXPECT_TRUE(HasSameBits(one.weights[0], three.weights[0]));
}

/// Terms that limits of values have over the control points, counted.
double CountPointTerms(Rooms<double> const& rooms, int numControlVertices) {
    ComposedLevel level = IdentityLevel(numControlVertices);
    int const last = rooms.topology.LastLevel();
    for (int l = 1; l <= last; ++l) level = ComposeVertices(level, rooms.levels.Masks(l), 1);
    double numTerms = 0;
    std::vector<std::pair<int, double>> terms;
    for (int v = 0; v < rooms.Last().GetNumVertices(); ++v) {
        RowSum<1> sum(level.numSources);
        terms.clear();
        rooms.limit.AppendVertexTerms(v, terms);
        // Tangents reach the whole ring.
        for (int const f : rooms.Last().GetVertexFaces(v)) {
            for (int const u : rooms.Last().GetFaceVertices(f)) terms.emplace_back(u, 1);
        }
        for (auto const& [u, weight] : terms) level.AddTo<1>(sum, u, {weight});
        SparseRows<double, 1> row;
        sum.MoveTo(row);
        numTerms += static_cast<double>(row.sources.size()) * rooms.LastRegions().NumVertexValues(v);
    }
    return numTerms;
}

TEST(ComposedRows, AreNotMoreThanTheEstimateWhichIsClose) {
    std::vector<Shape> all = AllShapes();
    for (std::uint64_t seed = 0; seed < SampleSize(60); ++seed) {
        shapes::RandomShapeOptions options;
        options.triangles = seed % 2 != 0;
        all.push_back(shapes::RandomShape(seed, options));
        if (options.triangles) all.back().Loop();
    }
    for (Shape const& shape : all) {
        for (int level = HasOnlyRegularFaces(shape) ? 0 : 1; level <= 3; ++level) {
            Rooms<double> const rooms(shape, level);
            double const estimate = RowEstimate(rooms.topology.Refiner()).PointTerms(level);
            double const counted = CountPointTerms(rooms, shape.NumVertices());
            EXPECT_GE(estimate, counted * (1 - 1e-12)) << shape.name << " level " << level;
            EXPECT_LE(estimate, 6 * counted + 100) << shape.name << " level " << level;
        }
    }
    // On regular ground, the count itself.
    Rooms<double> const torus(shapes::Torus(12, 8), 3);
    double const estimate = RowEstimate(torus.topology.Refiner()).PointTerms(3);
    EXPECT_EQ(estimate, 16.0 * torus.Last().GetNumVertices());
    EXPECT_LE(estimate, 1.2 * CountPointTerms(torus, 96));
}

TEST(ComposedRows, AnEstimateBeyondALimitIsRefusedInWords) {
    Shape const cube = shapes::Cube();
    RefinedTopology const base(cube.Mesh(), 0);
    RowEstimate const estimate(base.Refiner());
    EXPECT_EQ(estimate.NumFaces(0), 6);
    EXPECT_EQ(estimate.NumFaces(2), 96);
    ShadingOptions options = PaperPreset(2);
    options.startNormals.level = options.weights.level = 1;
    EXPECT_NO_THROW(estimate.Check(options, 1e9, 1e18));
    EXPECT_NE(ErrorOf<MemoryLimitExceeded>([&] {
                  estimate.Check(options, 2147483648.0, 0);
              }).find("more indices than 32 bits can number; use a lower level"),
              std::string::npos);
    options.execution.memoryLimit = 1000;
    EXPECT_NE(ErrorOf<MemoryLimitExceeded>([&] {
                  estimate.Check(options, 0, 0);
              }).find("bytes, more than the limit of 1000; use a lower level or raise the limit"),
              std::string::npos);
}

}  // namespace
