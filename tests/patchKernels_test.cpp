// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/tables/patchKernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "osd_shading/shadingEvaluator.h"
#include "osd_shading/tables/splineBasis.h"
#include "osd_shading/vectorMath.h"
#include "tests/shapes.h"

namespace {

using namespace osd_shading;
using shapes::Random;

using Point = Vec3<double>;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr double kSingle = 6e-8;  // half a unit in the last place of 1
constexpr float kSentinel = -12345.5F;

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

// Memory for a leaf's field, full of `filler` wherever nothing was written.
class Field {
public:
    explicit Field(float filler = kNan) : _values(new Values) { _values->v.fill(filler); }
    FieldArrays Arrays() { return {&_values->v[0], &_values->v[kPitch], &_values->v[2 * kPitch]}; }
    Point operator[](int i) const {
        return {double(_values->v[at(i)]), double(_values->v[at(kPitch + i)]),
                double(_values->v[at(2 * kPitch + i)])};
    }
    void Set(int i, Point const& p) {
        _values->v[at(i)] = static_cast<float>(p.x);
        _values->v[at(kPitch + i)] = static_cast<float>(p.y);
        _values->v[at(2 * kPitch + i)] = static_cast<float>(p.z);
    }

private:
    static constexpr int kPitch = (kLeafCapacity + 15) / 16 * 16;
    struct Values {
        alignas(64) std::array<float, at(3 * kPitch)> v;
    };
    std::unique_ptr<Values> _values;
};

bool isSame(Point const& a, Point const& b) { return std::memcmp(&a, &b, sizeof a) == 0; }
bool isNan(Point const& a) { return std::isnan(a.x) || std::isnan(a.y) || std::isnan(a.z); }

void expectNear(Point const& a, Point const& b, double tolerance, std::string const& what) {
    EXPECT_NEAR(a.x, b.x, tolerance) << what;
    EXPECT_NEAR(a.y, b.y, tolerance) << what;
    EXPECT_NEAR(a.z, b.z, tolerance) << what;
}

Point randomPoint(Random& random, double size = 1) {
    return {random.Uniform(-size, size), random.Uniform(-size, size), random.Uniform(-size, size)};
}

Point pointOf(LocalPoint const& p) { return {double(p.v[0]), double(p.v[1]), double(p.v[2])}; }

std::vector<LocalPoint> randomLocalPoints(Random& random, int count) {
    std::vector<LocalPoint> points(at(count));
    for (LocalPoint& p : points) {
        for (int c = 0; c < 3; ++c) p.v[c] = static_cast<float>(random.Uniform(-1, 1));
        p.v[3] = 0;
    }
    return points;
}

std::vector<std::uint16_t> randomIndices(Random& random, int count, int numPoints) {
    std::vector<std::uint16_t> indices(at(count));
    for (std::uint16_t& index : indices) index = static_cast<std::uint16_t>(random.Below(numPoints));
    return indices;
}

// Segments and what follows from them.
struct Plan {
    std::vector<RowSegment> segments;
    RowPlan plan{};

    void Add(int row, int first, int count) {
        segments.push_back({std::uint8_t(row), std::uint8_t(first), std::uint8_t(count)});
    }
    RowPlan const& Get() {
        plan = {segments.data(), static_cast<int>(segments.size()), 0, 16, 0};
        for (RowSegment const& s : segments) {
            plan.numPoints += s.count;
            plan.firstColumn = std::min<int>(plan.firstColumn, s.first);
            plan.lastColumn = std::max(plan.lastColumn, s.first + s.count - 1);
        }
        return plan;
    }
    template <typename Function>
    void ForAll(Function const& f) const {
        int i = 0;
        for (RowSegment const& s : segments) {
            for (int column = s.first; column < s.first + s.count; ++column) f(i++, int(s.row), column);
        }
    }
};

// All rectangles with and without their borders, single points, and plans of any segments, for numU by numV.
std::vector<Plan> plans(Random& random, int numU, int numV) {
    std::vector<Plan> all;
    for (int border = 0; border < 16; ++border) {
        int const firstU = border & 1, firstV = border >> 1 & 1, lastU = numU - (border >> 2 & 1),
                  lastV = numV - (border >> 3 & 1);
        Plan plan;
        for (int row = firstV; row < lastV && firstU < lastU; ++row) plan.Add(row, firstU, lastU - firstU);
        if (!plan.segments.empty()) all.push_back(plan);
    }
    Plan single;
    single.Add(random.Below(numV), random.Below(numU), 1);
    all.push_back(single);
    for (int i = 0; i < 4; ++i) {
        Plan plan;
        for (int row = 0; row < numV; ++row) {
            if (random.Chance(0.3)) continue;
            int const first = random.Below(numU);
            plan.Add(row, first, 1 + random.Below(numU - first));
        }
        if (!plan.segments.empty()) all.push_back(plan);
    }
    return all;
}

// What a spline is: plain sums over all control points.
template <typename Control>
Point tensor(float const (&u)[4][SplineBasis::kPitch], int i, float const (&v)[4][SplineBasis::kPitch], int j,
             Control const& control) {
    Point sum;
    for (int r = 0; r < 4; ++r) {
        for (int c = 0; c < 4; ++c) {
            double const weight = double(u[c][i]) * double(v[r][j]);
            if (weight != 0) sum += weight * control(r, c);
        }
    }
    return sum;
}

class PatchKernelsOf : public testing::TestWithParam<InstructionSet> {
protected:
    PatchKernels const& kernels() const { return *FindKernels(GetParam()); }
};

std::vector<InstructionSet> availableSets() {
    std::vector<InstructionSet> sets;
    for (InstructionSet const set :
         {InstructionSet::Portable, InstructionSet::Sse2, InstructionSet::Avx2, InstructionSet::Avx512}) {
        if (IsAvailable(set)) sets.push_back(set);
    }
    return sets;
}

INSTANTIATE_TEST_SUITE_P(Sets, PatchKernelsOf, testing::ValuesIn(availableSets()),
                         [](auto const& set) { return std::string(FindKernels(set.param)->name); });

TEST(PatchKernels, ThePortableKernelsAreAlwaysThereAndTheBestAreSome) {
    ASSERT_TRUE(IsAvailable(InstructionSet::Portable));
    ASSERT_TRUE(IsAvailable(InstructionSet::Best));
    EXPECT_STREQ(FindKernels(InstructionSet::Portable)->name, "portable");
    PatchKernels const* const best = FindKernels(InstructionSet::Best);
    for (InstructionSet const set : availableSets()) EXPECT_LE(FindKernels(set)->numLanes, best->numLanes);
    EXPECT_EQ(best, FindKernels(availableSets().back()));
}

// --- Splines
// ------------------------------------------------------------------------------------------------------

TEST_P(PatchKernelsOf, AFrameOfOneFaceIsTheSumOverItsControlPoints) {
    Random random(1);
    for (int k = 0; k <= 6; ++k) {
        int const last = 1 << k;
        for (int trial = 0; trial < 3; ++trial) {
            auto const window = [&] {
                int const first = last <= 16 ? 0 : 16 * random.Below(last / 16);
                return ParameterWindow{k, first, std::min(17, last + 1 - first)};
            };
            SplineBasis const u = trial == 2 ? MakeRefinedFaceBasis(window()) : MakeFaceBasis(window());
            SplineBasis const v = trial == 2 ? MakeRefinedFaceBasis(window()) : MakeFaceBasis(window());
            std::vector<LocalPoint> const points = randomLocalPoints(random, 40);
            std::vector<std::uint16_t> const indices = randomIndices(random, 16, 40);
            auto const control = [&](int r, int c) { return pointOf(points[indices[at(4 * r + c)]]); };
            for (Plan& plan : plans(random, u.numParameters, v.numParameters)) {
                Field position, du, dv, alone;
                kernels().evaluateSplineFrame(u, v, plan.Get(), points.data(), indices.data(), position.Arrays(),
                                              du.Arrays(), dv.Arrays());
                kernels().evaluateSpline(u, v, plan.Get(), points.data(), indices.data(), alone.Arrays());
                plan.ForAll([&](int i, int row, int column) {
                    Point p = tensor(u.value, column, v.value, row, control), byU, byV;
                    for (int r = 0; r < 4; ++r) {
                        for (int c = 0; c < 3; ++c) {
                            byU += double(v.value[r][row]) * double(u.slope[c][column]) *
                                   (control(r, c + 1) - control(r, c));
                            byV += double(u.value[r][column]) * double(v.slope[c][row]) *
                                   (control(c + 1, r) - control(c, r));
                        }
                    }
                    // Sums of 16 numbers of size 1 and weights of sum 1; derivatives of size 2.
                    expectNear(position[i], p, 8 * kSingle, "position");
                    expectNear(alone[i], p, 8 * kSingle, "position alone");
                    expectNear(du[i], byU, 16 * kSingle, "du");
                    expectNear(dv[i], byV, 16 * kSingle, "dv");
                });
            }
        }
    }
}

TEST_P(PatchKernelsOf, TangentsOfAPlaneFarFromItsOriginAreExactToTheLastDigits) {
    // Differences of control points, not of rounded points: the distance takes part in the rounding of the input
    // alone.
    SplineBasis const basis = MakeFaceBasis({4, 0, 17});
    std::vector<LocalPoint> points(16);
    std::vector<std::uint16_t> indices(16);
    for (int i = 0; i < 16; ++i) {
        points[at(i)] = {{1000 + 0.125F * float(i % 4), 0.25F * float(i / 4), -500, 0}};
        indices[at(i)] = std::uint16_t(i);
    }
    Plan plan;
    for (int row = 0; row < 17; ++row) plan.Add(row, 0, 17);
    Field position, du, dv;
    kernels().evaluateSplineFrame(basis, basis, plan.Get(), points.data(), indices.data(), position.Arrays(),
                                  du.Arrays(), dv.Arrays());
    plan.ForAll([&](int i, int, int) {
        expectNear(du[i], {0.125, 0, 0}, 0.125 * 8 * kSingle, "du");
        expectNear(dv[i], {0, 0.25, 0}, 0.25 * 8 * kSingle, "dv");
    });
}

TEST_P(PatchKernelsOf, AGridIsTheSumOverTheControlPointsOfEachOfItsFaces) {
    Random random(2);
    for (int gridSize = 2; gridSize <= 16; gridSize *= 2) {
        for (int shift = 0; (gridSize << shift) <= 16; ++shift) {
            SplineBasis const basis = MakeGridBasis(gridSize, shift);
            std::vector<LocalPoint> points = randomLocalPoints(random, 400);
            std::vector<std::uint16_t> indices = randomIndices(random, (gridSize + 3) * (gridSize + 3), 400);
            // The end has weight 0 for a row past the last: what lies there does not matter.
            points.push_back({{kNan, kNan, kNan, kNan}});
            indices.insert(indices.end(), at(gridSize + 4), 400);
            for (Plan& plan : plans(random, basis.numParameters, basis.numParameters)) {
                Field field;
                kernels().evaluateSpline(basis, basis, plan.Get(), points.data(), indices.data(), field.Arrays());
                plan.ForAll([&](int i, int row, int column) {
                    auto const control = [&](int r, int c) {
                        int const index = ((row >> shift) + r) * (gridSize + 3) + (column >> shift) + c;
                        return pointOf(points[indices[at(index)]]);
                    };
                    expectNear(field[i], tensor(basis.value, column, basis.value, row, control), 8 * kSingle,
                               "grid");
                });
            }
        }
    }
}

// --- Dense matrices
// -----------------------------------------------------------------------------------------------

TEST_P(PatchKernelsOf, ADenseMatrixIsTheSumOverItsColumns) {
    Random random(3);
    for (int trial = 0; trial < 200; ++trial) {
        int const numFields = 1 + trial % 5;
        int const numPoints = trial < 80 ? 1 + trial / 5 * 2 : 1 + random.Below(289);
        int const numColumns = 1 + random.Below(70);
        int const numBlocks = (numPoints + kDenseBlock - 1) / kDenseBlock;
        std::vector<double> weights(at(numPoints * numFields * numColumns));
        std::vector<float> memory(at(numBlocks * numColumns * numFields * kDenseBlock + 16), 0.0F);
        void* start = memory.data();
        std::size_t space = memory.size() * sizeof(float);
        auto* const packed = static_cast<float*>(std::align(64, 64, start, space));
        for (int i = 0; i < numPoints; ++i) {
            for (int column = 0; column < numColumns; ++column) {
                for (int f = 0; f < numFields; ++f) {
                    auto const weight = static_cast<float>(random.Uniform(-1, 1));
                    weights[at((i * numColumns + column) * numFields + f)] = double(weight);
                    packed[((i / kDenseBlock * numColumns + column) * numFields + f) * kDenseBlock +
                           i % kDenseBlock] = weight;
                }
            }
        }
        std::vector<LocalPoint> const points = randomLocalPoints(random, 90);
        std::vector<std::uint16_t> const indices = randomIndices(random, numColumns, 90);
        std::vector<Field> fields(at(numFields));
        std::vector<FieldArrays> arrays;
        for (Field& field : fields) arrays.push_back(field.Arrays());
        kernels().evaluateDense({numPoints, numColumns, numFields, packed}, points.data(), indices.data(),
                                arrays.data());
        for (int i = 0; i < numPoints; ++i) {
            for (int f = 0; f < numFields; ++f) {
                Point sum;
                for (int column = 0; column < numColumns; ++column) {
                    sum += weights[at((i * numColumns + column) * numFields + f)] *
                           pointOf(points[indices[at(column)]]);
                }
                // Each sum of up to 70 products of size 1 is rounded as often.
                expectNear(fields[at(f)][i], sum, numColumns * 8 * kSingle, "dense");
            }
        }
    }
}

// --- Normals and output
// -------------------------------------------------------------------------------------------

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
    Output positions, blended, limit, subdivided, tangents1, tangents2;
    std::vector<std::uint16_t> doubtful;

    Outputs(int numPoints, std::size_t stride)
        : positions(numPoints, stride),
          blended(numPoints, stride),
          limit(numPoints, stride),
          subdivided(numPoints, stride),
          tangents1(numPoints, stride),
          tangents2(numPoints, stride),
          doubtful(at(numPoints), 0xffff) {}
    std::vector<Output const*> All() const {
        return {&positions, &blended, &limit, &subdivided, &tangents1, &tangents2};
    }
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

TEST_P(PatchKernelsOf, NormalsAreBlendedAndWrittenWithAnyPartsAndStrides) {
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
                           wantsLimit = tangents && random.Chance(0.5), wantsSubdivided = random.Chance(0.5),
                           wantsTangents = tangents && random.Chance(0.3);
                if (wantsPositions) frame.positions = outputs.positions.Get();
                if (wantsBlended && (tangents || subdivided)) frame.blendedNormals = outputs.blended.Get();
                if (wantsLimit) frame.limitNormals = outputs.limit.Get();
                if (wantsSubdivided && (tangents || subdivided)) frame.subdividedNormals = outputs.subdivided.Get();
                if (wantsTangents) frame.tangents1 = outputs.tangents1.Get();
                if (wantsTangents) frame.tangents2 = outputs.tangents2.Get();
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
                    if (wantsTangents) {
                        EXPECT_TRUE(isSame(outputs.tangents1[i], leaf.tangent1[i]));
                        EXPECT_TRUE(isSame(outputs.tangents2[i], leaf.tangent2[i]));
                    }
                }
            }
        }
    }
}

TEST_P(PatchKernelsOf, TheBlendIsTheSameBitsWhateverElseIsWritten) {
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

TEST_P(PatchKernelsOf, WithoutAWeightNBIsExactlyNLWhateverNSIs) {
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

TEST_P(PatchKernelsOf, WhereTheSumVanishesNBIsNL) {
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

TEST_P(PatchKernelsOf, NormalsOfVanishingVectorsAreZeroAndNotNan) {
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

TEST_P(PatchKernelsOf, WithoutNLTheBlendIsNS) {
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

TEST_P(PatchKernelsOf, TangentsThatReachTooLittleAcrossEachOtherAreDoubtful) {
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

TEST_P(PatchKernelsOf, TangentsTooSmallForTheirSquaresAreDoubtful) {
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

TEST_P(PatchKernelsOf, NanSpoilsOnlyItsPoint) {
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

TEST_P(PatchKernelsOf, ResultsAreTheSameBitsWhateverLiesInThePadding) {
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

// --- Sparse rows
// --------------------------------------------------------------------------------------------------

TEST_P(PatchKernelsOf, RowsCombineThePointsBeforeThem) {
    Random random(10);
    int const numPoints = 25, numRows = 60;
    std::vector<LocalPoint> points = randomLocalPoints(random, numPoints);
    points.resize(at(numPoints + numRows));
    std::vector<Point> expected;
    for (int i = 0; i < numPoints; ++i) expected.push_back(pointOf(points[at(i)]));
    std::vector<std::uint32_t> offsets = {0};
    std::vector<std::uint16_t> sources;
    std::vector<float> weights;
    for (int row = 0; row < numRows; ++row) {
        int const numTerms = row == 3 ? 0 : 1 + random.Below(10);
        Point sum;
        for (int t = 0; t < numTerms; ++t) {
            auto const weight = static_cast<float>(random.Uniform(0, 2.0 / numTerms));
            int const source = random.Below(numPoints + row);
            sum += double(weight) * expected[at(source)];
            sources.push_back(std::uint16_t(source));
            weights.push_back(weight);
        }
        expected.push_back(sum);
        offsets.push_back(static_cast<std::uint32_t>(sources.size()));
    }
    kernels().combine(numRows, offsets.data(), sources.data(), weights.data(), points.data(),
                      points.data() + numPoints);
    for (int i = 0; i < numPoints + numRows; ++i) {
        expectNear(pointOf(points[at(i)]), expected[at(i)], 20 * kSingle, "row");
        EXPECT_EQ(points[at(i)].v[3], 0);
    }
}

}  // namespace
