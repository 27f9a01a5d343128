// SPDX-License-Identifier: Apache-2.0

// What must not change a result, on random meshes with random options: creases, fractions, boundaries, holes and
// non-manifold joins. Each failure names the seed of its mesh, and a property of the test the seed of them all.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "tests/sampleSize.h"
#include "tests/testHelpers.h"

namespace osd_shading::tests {
namespace {

constexpr std::uint64_t kSeed = 71;
using Vector = Vec3<double>;

struct Case {
    std::uint64_t seed = 0;
    Shape shape;
    ShadingOptions options;
};

ShadingOptions randomOptions(shapes::Random& random) {
    ShadingOptions options = PaperPreset(1 + random.Below(3));
    options.startNormals.kind = static_cast<StartNormalKind>(random.Below(5));
    options.startNormals.level = random.Chance(0.5) ? 1 : options.level;
    options.subdividedNormals.averaging = static_cast<NormalAveraging>(random.Below(3));
    options.weights.scheme = static_cast<WeightScheme>(random.Below(5));
    options.weights.sharpVertices = static_cast<SharpVertexWeight>(random.Below(3));
    options.weights.darts = static_cast<DartWeight>(random.Below(2));
    options.weights.level = random.Chance(0.5) ? 1 : options.level;
    options.weights.exponent = random.Chance(0.7) ? 1 : 2;
    options.limits.normals = random.Chance(0.5) ? LimitNormalKind::Limit : LimitNormalKind::Exact;
    return options;
}

/// Calls `check(case, random)` for many random cases.
template <typename Check>
void forRandomCases(std::uint64_t sample, Check const& check) {
    ::testing::Test::RecordProperty("seed", std::to_string(kSeed));
    shapes::Random random(kSeed);
    for (std::uint64_t i = 0; i < SampleSize(sample); ++i) {
        shapes::RandomShapeOptions kind;
        kind.triangles = random.Chance(0.4);
        kind.nonManifold = random.Chance(0.3);
        kind.chaikin = random.Chance(0.2);
        Case c;
        c.seed = random.Bits();
        c.shape = shapes::RandomShape(c.seed, kind);
        c.options = randomOptions(random);
        SCOPED_TRACE("seed " + std::to_string(kSeed) + ", mesh " + std::to_string(i) + ", " + c.shape.name);
        check(c, random);
        if (::testing::Test::HasFailure()) return;  // one mesh at a time
    }
}

Vector mapped(double const (&m)[9], Vector const& v) {
    return {m[0] * v.x + m[1] * v.y + m[2] * v.z, m[3] * v.x + m[4] * v.y + m[5] * v.z,
            m[6] * v.x + m[7] * v.y + m[8] * v.z};
}

Shape movedShape(Shape shape, double const (&m)[9], Vector const& to) {
    for (std::size_t i = 0; i < shape.positions.size(); i += 3) {
        double* const p = &shape.positions[i];
        Vector const q = mapped(m, {p[0], p[1], p[2]}) + to;
        p[0] = q.x;
        p[1] = q.y;
        p[2] = q.z;
    }
    return shape;
}

/// Interior vertices of valence 2 in Catmull-Clark, whose N_L depends on which of their faces comes first: README.
bool hasLimitNormalByNumber(ShadingResult<double> const& result, std::size_t value) {
    VertexTag const& tag = result.vertexTags[Index(result.valueVertices[value])];
    return result.faceSize == 4 && tag.valence == 2 && !tag.isBoundary;
}

/// How steady a blended normal is: the length of the sum that it is the direction of.
double lengthOfBlend(ShadingResult<double> const& result, std::size_t value) {
    double const power = std::pow(result.blendWeights[value], result.options.weights.exponent);
    return Length((1 - power) * result.limitNormals[value] + power * result.subdividedNormals[value]);
}

// Sums of some twenty numbers of size 1 at each level; normals are those of tangents that reach a tenth across.
constexpr double kPositions = 1e-12, kNormals = 1e-8;

TEST(RandomInvariance, WeightsAreInRangeAndNormalsUnitOrZero) {
    forRandomCases(800, [](Case const& c, shapes::Random&) {
        ShadingResult<double> const result = Shade<double>(c.shape, c.options);
        for (std::size_t i = 0; i < result.blendWeights.size(); ++i) {
            ASSERT_GE(result.blendWeights[i], 0) << i;
            ASSERT_LE(result.blendWeights[i], 1) << i;
            for (auto const* normals : {&result.limitNormals, &result.subdividedNormals, &result.blendedNormals}) {
                double const length = Length((*normals)[i]);
                ASSERT_TRUE(length == 0 || std::fabs(length - 1) < 1e-14) << i << ": " << length;
            }
        }
    });
}

TEST(RandomInvariance, AConstantFieldOfNormalsStaysConstant) {
    Vector const normal{2 / 7.0, -3 / 7.0, 6 / 7.0};
    forRandomCases(400, [&](Case const& c, shapes::Random& random) {
        ShadingOptions options = c.options;
        options.startNormals = {StartNormalKind::User, 0};
        options.weights.scheme = WeightScheme::One;
        std::vector<Vector> const normals(c.shape.faceVertices.size(), normal);
        ShadingInput<double> input;
        input.positions = c.shape.Points();
        if (random.Chance(0.5)) {
            input.faceVaryingNormals = normals;
        } else {
            input.vertexNormals = {&normals[0].x, input.positions.size()};
        }
        // Isolated vertices may make for more vertices than corners.
        if (input.positions.size() > normals.size()) return;
        ShadingResult<double> const result = ShadeSubdivision(c.shape.Mesh(), input, options);
        for (Vector const& n : result.blendedNormals) ASSERT_LT(Distance(n, normal), 1e-13);
    });
}

TEST(RandomInvariance, TurnedAndMovedMeshesGiveTurnedNormals) {
    // Columns are orthogonal and of unit length: a turn about (1, 2, 2).
    double const turn[9] = {1 / 9.0 - 8 / 9.0, 4 / 9.0, 4 / 9.0, 4 / 9.0, -1 / 9.0,
                            8 / 9.0,           4 / 9.0, 8 / 9.0, -1 / 9.0};
    forRandomCases(400, [&](Case const& c, shapes::Random&) {
        ShadingResult<double> const plain = Shade<double>(c.shape, c.options);
        ShadingResult<double> const turned = Shade<double>(movedShape(c.shape, turn, {3, -1, 2}), c.options);
        ASSERT_TRUE(HasSameBits(plain.blendWeights, turned.blendWeights));
        for (std::size_t v = 0; v < plain.positions.size(); ++v) {
            ASSERT_LT(Distance(mapped(turn, plain.positions[v]) + Vector{3, -1, 2}, turned.positions[v]),
                      kPositions * 10);
        }
        for (std::size_t i = 0; i < plain.limitNormals.size(); ++i) {
            ASSERT_LT(Distance(mapped(turn, plain.limitNormals[i]), turned.limitNormals[i]), kNormals) << i;
            double const steady = lengthOfBlend(plain, i);
            ASSERT_LT(steady * Distance(mapped(turn, plain.blendedNormals[i]), turned.blendedNormals[i]), kNormals)
                << i;
        }
    });
}

TEST(RandomInvariance, AffineMapsOfTheMeshMapTheSurfaceAndItsTangentPlanes) {
    forRandomCases(400, [](Case const& c, shapes::Random& random) {
        double m[9];
        for (double& x : m) x = random.Uniform(-1, 1);
        m[0] += 2;
        m[4] += 2;
        m[8] -= 2;  // mirrors, too
        Vector const rows[3] = {{m[0], m[1], m[2]}, {m[3], m[4], m[5]}, {m[6], m[7], m[8]}};
        // How normals are mapped: the products of the rows.
        Vector const a = Cross(rows[1], rows[2]), b = Cross(rows[2], rows[0]), d = Cross(rows[0], rows[1]);
        double const normalMap[9] = {a.x, a.y, a.z, b.x, b.y, b.z, d.x, d.y, d.z};
        ShadingOptions options = c.options;
        options.limits.normals = LimitNormalKind::Limit;  // exact ones know of vertices without tangent plane
        ShadingResult<double> const plain = Shade<double>(c.shape, options);
        ShadingResult<double> const moved = Shade<double>(movedShape(c.shape, m, {1, 2, 3}), options);
        ASSERT_TRUE(HasSameBits(plain.blendWeights, moved.blendWeights));
        for (std::size_t v = 0; v < plain.positions.size(); ++v) {
            ASSERT_LT(Distance(mapped(m, plain.positions[v]) + Vector{1, 2, 3}, moved.positions[v]),
                      kPositions * 10);
        }
        // Corners of several faces and degenerate tangents take averages of normals, which no affine map keeps.
        if (plain.report.fallbackNormals + moved.report.fallbackNormals > 0) return;
        for (std::size_t i = 0; i < plain.limitNormals.size(); ++i) {
            VertexTag const& tag = plain.vertexTags[Index(plain.valueVertices[i])];
            if (tag.kind == VertexKind::Corner) continue;
            Vector const expected = mapped(normalMap, plain.limitNormals[i]);
            ASSERT_LT(Distance(1 / Length(expected) * expected, moved.limitNormals[i]), kNormals) << i;
        }
    });
}

TEST(RandomInvariance, RenumberingTheVerticesChangesNothingAtTheCornersOfTheFaces) {
    forRandomCases(400, [](Case const& c, shapes::Random& random) {
        std::vector<int> numbers(Index(c.shape.NumVertices()));
        std::iota(numbers.begin(), numbers.end(), 0);
        for (int i = c.shape.NumVertices() - 1; i > 0; --i)
            std::swap(numbers[Index(i)], numbers[Index(random.Below(i + 1))]);
        Shape renumbered = c.shape;
        for (std::size_t v = 0; v < numbers.size(); ++v) {
            std::copy_n(&c.shape.positions[3 * v], 3, &renumbered.positions[3 * Index(numbers[v])]);
        }
        for (auto* vertices : {&renumbered.faceVertices, &renumbered.creaseVertices, &renumbered.cornerVertices}) {
            for (int& v : *vertices) v = numbers[Index(v)];
        }
        ShadingResult<double> const plain = Shade<double>(c.shape, c.options),
                                    other = Shade<double>(renumbered, c.options);
        ASSERT_EQ(plain.faceValues.size(), other.faceValues.size());
        for (std::size_t k = 0; k < plain.faceValues.size(); ++k) {
            std::size_t const i = Index(plain.faceValues[k]), j = Index(other.faceValues[k]);
            ASSERT_LT(Distance(plain.positions[Index(plain.valueVertices[i])],
                               other.positions[Index(other.valueVertices[j])]),
                      kPositions);
            ASSERT_NEAR(plain.blendWeights[i], other.blendWeights[j], 1e-13);
            if (hasLimitNormalByNumber(plain, i)) continue;
            ASSERT_LT(Distance(plain.limitNormals[i], other.limitNormals[j]), kNormals) << i;
            double const steady = lengthOfBlend(plain, i);
            ASSERT_LT(steady * Distance(plain.blendedNormals[i], other.blendedNormals[j]), kNormals) << i;
        }
    });
}

}  // namespace
}  // namespace osd_shading::tests
