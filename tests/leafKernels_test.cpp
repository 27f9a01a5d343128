// SPDX-License-Identifier: Apache-2.0

// What the kernels make of a leaf's fields: normals, the blend, and what is written.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "osd_shading/tables/patchKernels.h"
#include "osd_shading/tables/splineBasis.h"
#include "tests/kernelCases.h"

namespace osd_shading::tests {
namespace {

class LeafKernelsOf : public PatchKernelsOf {};

INSTANTIATE_TEST_SUITE_P(Sets, LeafKernelsOf, testing::ValuesIn(availableSets()),
                         [](auto const& set) { return std::string(FindKernels(set.param)->name); });

// One leaf for `finish`, its outputs and what they must be.
struct Leaf {
    int numPoints;
    Field position, tangent1, tangent2, subdivided;
    std::vector<float> blend;

    Leaf(int count, float filler)
        : numPoints(count),
          position(filler),
          tangent1(filler),
          tangent2(filler),
          subdivided(filler),
          blend(at(count)) {}
};

enum class Part : unsigned { Tangents = 1, Subdivided = 2, Blend = 4 };
bool has(unsigned parts, Part part) { return (parts & static_cast<unsigned>(part)) != 0; }

// An output buffer whose gaps are watched.
class Output {
public:
    Output(int numPoints, std::size_t stride)
        : _stride(stride), _values(stride * at(numPoints - 1) + 3 + kMargin, kSentinel), _numPoints(numPoints) {}
    LeafFrame::Output Get() { return {_values.data(), _stride}; }
    Point operator[](int i) const {
        float const* const p = &_values[at(i) * _stride];
        return {double(p[0]), double(p[1]), double(p[2])};
    }
    bool IsUntouchedBetweenPoints() const {
        std::size_t const end = _stride * at(_numPoints - 1) + 3;
        for (std::size_t i = 0; i < _values.size(); ++i) {
            if ((i >= end || i % _stride >= 3) && _values[i] != kSentinel) return false;
        }
        return true;
    }
    std::vector<float> const& Values() const { return _values; }

private:
    static constexpr std::size_t kMargin = 64;
    std::size_t _stride;
    std::vector<float> _values;
    int _numPoints;
};

struct Outputs {
    Output positions, blended, limit, subdivided;
    std::vector<std::uint16_t> doubtful;

    Outputs(int numPoints, std::size_t stride)
        : positions(numPoints, stride),
          blended(numPoints, stride),
          limit(numPoints, stride),
          subdivided(numPoints, stride),
          doubtful(at(numPoints), 0xffff) {}
    std::vector<Output const*> All() const { return {&positions, &blended, &limit, &subdivided}; }
};

LeafFrame makeFrame(Leaf& leaf, Outputs& outputs, unsigned parts) {
    LeafFrame frame{};
    frame.numPoints = leaf.numPoints;
    frame.origin[0] = 1;
    frame.origin[1] = -2;
    frame.origin[2] = 3;
    frame.position = leaf.position.Arrays();
    if (has(parts, Part::Tangents)) {
        frame.tangent1 = leaf.tangent1.Arrays();
        frame.tangent2 = leaf.tangent2.Arrays();
    }
    if (has(parts, Part::Subdivided)) frame.subdivided = leaf.subdivided.Arrays();
    if (has(parts, Part::Blend)) frame.blend = leaf.blend.data();
    frame.doubtful = outputs.doubtful.data();
    frame.numDoubtful = -1;
    return frame;
}

Point unitOrZero(Point const& a, double smallest) { return Length(a) <= smallest ? Point{} : (1 / Length(a)) * a; }

Point limitNormalOf(Leaf const& leaf, int i) { return unitOrZero(Cross(leaf.tangent1[i], leaf.tangent2[i]), 0); }
Point subdividedNormalOf(Leaf const& leaf, int i) { return unitOrZero(leaf.subdivided[i], 1e-6); }
Point blendedNormalOf(Leaf const& leaf, int i, unsigned parts) {
    Point const limit = limitNormalOf(leaf, i), subdivided = subdividedNormalOf(leaf, i);
    if (!has(parts, Part::Subdivided)) return limit;
    if (!has(parts, Part::Tangents)) return subdivided;
    double const b = has(parts, Part::Blend) ? double(leaf.blend[at(i)]) : 1;
    Point const sum = (1 - b) * limit + b * subdivided;
    return b == 0 || Length(sum) <= 1e-6 ? limit : unitOrZero(sum, 0);
}

void fillRandomly(Leaf& leaf, Random& random) {
    for (int i = 0; i < leaf.numPoints; ++i) {
        leaf.position.Set(i, randomPoint(random, 10));
        // Tangents far from parallel, so that their rounding does not matter; of any size.
        double const size = std::pow(10, random.Uniform(-6, 6));
        Point const a = unitOrZero(randomPoint(random), 0);
        Point b = randomPoint(random);
        while (Length(Cross(a, b)) < 0.5 * Length(b) || Length(b) < 0.1) b = randomPoint(random);
        leaf.tangent1.Set(i, size * a);
        leaf.tangent2.Set(i, size * b);
        // N_S never against N_L.
        Point s = random.Uniform(0.01, 1) * unitOrZero(randomPoint(random), 0);
        if (Dot(s, limitNormalOf(leaf, i)) < 0) s = -1.0 * s;
        leaf.subdivided.Set(i, s);
        int const kind = random.Below(4);
        leaf.blend[at(i)] = kind == 0 ? 0.0F : kind == 1 ? 1.0F : static_cast<float>(random.Uniform(0, 1));
    }
}

constexpr int kSizes[] = {1, 2, 3, 4, 5, 7, 8, 9, 12, 15, 16, 17, 20, 25, 31, 33, 64, 100, 256, 288, 289};
constexpr unsigned kPartSets[] = {0, 1, 2, 3, 6 + 1};

TEST_P(LeafKernelsOf, NormalsAreBlendedAndWrittenWithAnyPartsAndStrides) {
    Random random(4);
    for (int const numPoints : kSizes) {
        for (unsigned const parts : kPartSets) {
            Leaf leaf(numPoints, kNan);
            fillRandomly(leaf, random);
            for (std::size_t const stride : {3U, 4U, 6U, 8U, 11U}) {
                Outputs outputs(numPoints, stride);
                LeafFrame frame = makeFrame(leaf, outputs, parts);
                // Any of the outputs that the parts allow.
                bool const tangents = has(parts, Part::Tangents), subdivided = has(parts, Part::Subdivided);
                bool const wantsPositions = random.Chance(0.7), wantsBlended = random.Chance(0.8),
                           wantsLimit = tangents && random.Chance(0.5), wantsSubdivided = random.Chance(0.5);
                if (wantsPositions) frame.positions = outputs.positions.Get();
                if (wantsBlended && (tangents || subdivided)) frame.blendedNormals = outputs.blended.Get();
                if (wantsLimit) frame.limitNormals = outputs.limit.Get();
                if (wantsSubdivided && (tangents || subdivided)) frame.subdividedNormals = outputs.subdivided.Get();
                kernels().finish(frame);

                EXPECT_EQ(frame.numDoubtful, 0);
                for (Output const* output : outputs.All()) EXPECT_TRUE(output->IsUntouchedBetweenPoints());
                for (int i = 0; i < numPoints; ++i) {
                    Point const untouched{double(kSentinel), double(kSentinel), double(kSentinel)};
                    auto const expect = [&](LeafFrame::Output const& wanted, Output const& output, Point const& p,
                                            double tolerance, char const* what) {
                        expectNear(output[i], wanted.data ? p : untouched, tolerance, what);
                    };
                    bool const counts = subdivided && (!has(parts, Part::Blend) || leaf.blend[at(i)] > 0);
                    Point const origin{1, -2, 3};
                    expect(frame.positions, outputs.positions, leaf.position[i] + origin, 13 * kSingle, "position");
                    expect(frame.blendedNormals, outputs.blended, blendedNormalOf(leaf, i, parts), 1e-6, "N_B");
                    expect(frame.limitNormals, outputs.limit, limitNormalOf(leaf, i), 1e-6, "N_L");
                    expect(frame.subdividedNormals, outputs.subdivided,
                           counts ? subdividedNormalOf(leaf, i) : Point{}, 3e-7, "N_S");
                }
            }
        }
    }
}

TEST_P(LeafKernelsOf, TheBlendIsTheSameBitsWhateverElseIsWritten) {
    Random random(5);
    Leaf leaf(100, kNan);
    fillRandomly(leaf, random);
    Outputs alone(100, 3), together(100, 8);
    LeafFrame frame = makeFrame(leaf, alone, 7);
    frame.blendedNormals = alone.blended.Get();
    kernels().finish(frame);
    frame = makeFrame(leaf, together, 7);
    frame.positions = together.positions.Get();
    frame.blendedNormals = together.blended.Get();
    frame.limitNormals = together.limit.Get();
    frame.subdividedNormals = together.subdivided.Get();
    kernels().finish(frame);
    for (int i = 0; i < 100; ++i) EXPECT_TRUE(isSame(alone.blended[i], together.blended[i]));
}

TEST_P(LeafKernelsOf, WithoutAWeightNBIsExactlyNLWhateverNSIs) {
    Random random(6);
    for (Point const& s : {Point{}, Point{double(kNan), 0, 0}, Point{1e-9, 0, 0}, Point{0, 1, 0}}) {
        Leaf leaf(40, kNan);
        fillRandomly(leaf, random);
        for (int i = 0; i < 40; ++i) leaf.subdivided.Set(i, s);
        std::fill(leaf.blend.begin(), leaf.blend.end(), 0.0F);
        Outputs outputs(40, 3);
        LeafFrame frame = makeFrame(leaf, outputs, 7);
        frame.blendedNormals = outputs.blended.Get();
        frame.subdividedNormals = outputs.subdivided.Get();
        kernels().finish(frame);
        for (int i = 0; i < 40; ++i) {
            expectNear(outputs.blended[i], limitNormalOf(leaf, i), 1e-6, "N_B");
            EXPECT_TRUE(IsZero(outputs.subdivided[i]));
        }
    }
}

TEST_P(LeafKernelsOf, WhereTheSumVanishesNBIsNL) {
    Leaf leaf(20, 0);
    for (int i = 0; i < 20; ++i) {
        leaf.tangent1.Set(i, {2, 0, 0});
        leaf.tangent2.Set(i, {0, 3, 0});
        leaf.subdivided.Set(i, {0, 0, -1});
        leaf.blend[at(i)] = 0.5F;
    }
    leaf.subdivided.Set(7, {0, 0, 1e-7});  // N_S vanishes: the sum is half of N_L
    leaf.subdivided.Set(8, {0, 0, 0});
    leaf.blend[8] = 1;  // and here nothing is left
    leaf.blend[9] = 0.25F;
    leaf.blend[10] = 0.75F;
    leaf.subdivided.Set(11, {1e-5, 0, 0});  // short, but counted
    leaf.blend[11] = 1;
    Outputs outputs(20, 3);
    LeafFrame frame = makeFrame(leaf, outputs, 7);
    frame.blendedNormals = outputs.blended.Get();
    kernels().finish(frame);
    for (int i = 0; i < 20; ++i) {
        Point const expected = i == 10 ? Point{0, 0, -1} : i == 11 ? Point{1, 0, 0} : Point{0, 0, 1};
        expectNear(outputs.blended[i], expected, 1e-7, "N_B");
    }
    EXPECT_EQ(frame.numDoubtful, 0);
}

TEST_P(LeafKernelsOf, NormalsOfVanishingVectorsAreZeroAndNotNan) {
    for (int const numPoints : {1, 5, 16, 37}) {
        for (unsigned const parts : kPartSets) {
            if (parts == 0) continue;
            Leaf leaf(numPoints, kNan);
            for (int i = 0; i < numPoints; ++i) {
                leaf.tangent1.Set(i, {0, 0, 0});
                leaf.tangent2.Set(i, {1, 0, 0});
                leaf.subdivided.Set(i, {0, 0, 0});
                leaf.blend[at(i)] = i % 2 == 0 ? 0.5F : 1.0F;
            }
            Outputs outputs(numPoints, 4);
            LeafFrame frame = makeFrame(leaf, outputs, parts);
            frame.blendedNormals = outputs.blended.Get();
            frame.subdividedNormals = outputs.subdivided.Get();
            if (has(parts, Part::Tangents)) frame.limitNormals = outputs.limit.Get();
            kernels().finish(frame);
            EXPECT_EQ(frame.numDoubtful, numPoints);
            for (int i = 0; i < numPoints; ++i) {
                EXPECT_TRUE(IsZero(outputs.blended[i]));
                EXPECT_TRUE(IsZero(outputs.subdivided[i]));
                if (has(parts, Part::Tangents)) {
                    EXPECT_TRUE(IsZero(outputs.limit[i]));
                }
            }
        }
    }
}

TEST_P(LeafKernelsOf, WithoutNLTheBlendIsNS) {
    Leaf leaf(18, 0);
    for (int i = 0; i < 18; ++i) {
        leaf.tangent1.Set(i, {0, 0, 0});
        leaf.tangent2.Set(i, {1, 0, 0});
        leaf.subdivided.Set(i, {0, -0.5, 0});
        leaf.blend[at(i)] = 0.125F;
    }
    Outputs outputs(18, 3);
    LeafFrame frame = makeFrame(leaf, outputs, 7);
    frame.blendedNormals = outputs.blended.Get();
    kernels().finish(frame);
    for (int i = 0; i < 18; ++i) expectNear(outputs.blended[i], {0, -1, 0}, 1e-7, "N_B");
    EXPECT_EQ(frame.numDoubtful, 18);
}

TEST_P(LeafKernelsOf, TangentsThatReachTooLittleAcrossEachOtherAreDoubtful) {
    Random random(7);
    for (int const numPoints : kSizes) {
        Leaf leaf(numPoints, kNan);
        fillRandomly(leaf, random);
        double const sine = 0.02;
        std::vector<std::uint16_t> expected;
        for (int i = 0; i < numPoints; ++i) {
            bool isDoubtful = true;
            switch (random.Below(8)) {
                case 0:
                    leaf.tangent1.Set(i, {0.0099, 0, 0}), leaf.tangent2.Set(i, {0, 1, 0});
                    break;
                case 1:
                    leaf.tangent1.Set(i, {1, 0, 0}), leaf.tangent2.Set(i, {0, 0.0199, 0});
                    break;
                case 2:
                    leaf.tangent1.Set(i, {1, 0, 0}), leaf.tangent2.Set(i, {3, 0, 0});
                    break;
                case 3:
                    leaf.tangent1.Set(i, {1, 0, 0}), leaf.tangent2.Set(i, {3, 0.0297, 0});  // less than |t2| doubt1
                    break;
                case 4:
                    leaf.tangent1.Set(i, {0, 0, 0}), leaf.tangent2.Set(i, {0, 0, 0});
                    break;
                // Squares out of the range of numbers: no normal in single precision.
                case 5:
                    leaf.tangent1.Set(i, {1e25, 1e25, 0}), leaf.tangent2.Set(i, {1e25, -1e25, 1});
                    break;
                case 6:
                    leaf.tangent1.Set(i, {double(kNan), 1, 0}), leaf.tangent2.Set(i, {0, 0, 0});
                    isDoubtful = false;
                    break;
                default:
                    leaf.tangent1.Set(i, {1, 0, 0}), leaf.tangent2.Set(i, {1, 1.02 * sine, 0});
                    isDoubtful = false;
            }
            if (isDoubtful) expected.push_back(std::uint16_t(i));
        }
        Outputs outputs(numPoints, 3);
        LeafFrame frame = makeFrame(leaf, outputs, 1);
        frame.doubt1 = 0.01F;
        frame.blendedNormals = outputs.blended.Get();
        frame.doubt2 = 0.02F;
        kernels().finish(frame);
        ASSERT_EQ(frame.numDoubtful, static_cast<int>(expected.size()));
        EXPECT_TRUE(std::equal(expected.begin(), expected.end(), outputs.doubtful.begin()));
    }
}

TEST_P(LeafKernelsOf, TangentsTooSmallForTheirSquaresAreDoubtful) {
    Leaf leaf(4, kNan);
    double const sizes[4] = {1e-30, 1e-12, 1e-10, 1e-8};
    for (int i = 0; i < 4; ++i) {
        leaf.tangent1.Set(i, {sizes[i], 0, 0});
        leaf.tangent2.Set(i, {0, sizes[i], 0});
    }
    Outputs outputs(4, 3);
    LeafFrame frame = makeFrame(leaf, outputs, 1);
    frame.limitNormals = outputs.limit.Get();
    kernels().finish(frame);
    ASSERT_EQ(frame.numDoubtful, 3);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(outputs.doubtful[at(i)], i);
    expectNear(outputs.limit[3], {0, 0, 1}, 1e-6, "N_L");
}

TEST_P(LeafKernelsOf, NanSpoilsOnlyItsPoint) {
    Random random(8);
    for (int const numPoints : {3, 16, 40, 100}) {
        for (unsigned const parts : kPartSets) {
            if (parts == 0) continue;
            Leaf leaf(numPoints, 0);
            fillRandomly(leaf, random);
            int const bad = random.Below(numPoints);
            auto const run = [&](Outputs& outputs) {
                LeafFrame frame = makeFrame(leaf, outputs, parts);
                frame.positions = outputs.positions.Get();
                frame.blendedNormals = outputs.blended.Get();
                if (has(parts, Part::Tangents)) frame.limitNormals = outputs.limit.Get();
                frame.subdividedNormals = outputs.subdivided.Get();
                kernels().finish(frame);
                EXPECT_EQ(frame.numDoubtful, 0);
            };
            leaf.blend[at(bad)] = 0.5F;
            Outputs good(numPoints, 3), spoiled(numPoints, 3);
            run(good);
            Point const nan{double(kNan), 1, 1};
            leaf.position.Set(bad, nan);
            leaf.tangent1.Set(bad, nan);
            leaf.subdivided.Set(bad, nan);
            run(spoiled);
            EXPECT_TRUE(isNan(spoiled.blended[bad]));
            for (int i = 0; i < numPoints; ++i) {
                if (i == bad) continue;
                for (std::size_t k = 0; k < 4; ++k) {
                    EXPECT_TRUE(isSame((*good.All()[k])[i], (*spoiled.All()[k])[i]));
                }
            }
        }
    }
}

TEST_P(LeafKernelsOf, ResultsAreTheSameBitsWhateverLiesInThePadding) {
    Random random(9);
    for (int const numPoints : kSizes) {
        std::vector<std::vector<float>> results;
        for (float const filler : {0.0F, kNan, std::numeric_limits<float>::infinity(), 1e-40F}) {
            Random same(static_cast<std::uint64_t>(numPoints));
            Leaf leaf(numPoints, filler);
            fillRandomly(leaf, same);
            for (unsigned const parts : kPartSets) {
                Outputs outputs(numPoints, 3);
                LeafFrame frame = makeFrame(leaf, outputs, parts);
                frame.positions = outputs.positions.Get();
                if (parts != 0) frame.blendedNormals = outputs.blended.Get();
                kernels().finish(frame);
                EXPECT_EQ(frame.numDoubtful, 0);
                results.push_back(outputs.positions.Values());
                results.push_back(outputs.blended.Values());
            }
        }
        std::size_t const numPerFiller = results.size() / 4;
        for (std::size_t i = numPerFiller; i < results.size(); ++i) {
            std::vector<float> const &a = results[i], &b = results[i % numPerFiller];
            EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(float)), 0);
        }
    }

    // The same for what is evaluated into a leaf that holds anything.
    SplineBasis const basis = MakeFaceBasis({4, 0, 17});
    std::vector<LocalPoint> const points = randomLocalPoints(random, 30);
    std::vector<std::uint16_t> const indices = randomIndices(random, 16, 30);
    for (Plan& plan : plans(random, 17, 17)) {
        Field a[3] = {Field(0), Field(0), Field(0)}, b[3];
        for (Field* f : {a, b}) {
            kernels().evaluateSplineFrame(basis, basis, plan.Get(), points.data(), indices.data(), f[0].Arrays(),
                                          f[1].Arrays(), f[2].Arrays());
        }
        plan.ForAll([&](int i, int, int) {
            for (int f = 0; f < 3; ++f) EXPECT_TRUE(isSame(a[f][i], b[f][i]));
        });
    }
}

}  // namespace
}  // namespace osd_shading::tests
