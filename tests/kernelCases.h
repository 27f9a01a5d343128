// SPDX-License-Identifier: Apache-2.0
#pragma once

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
#include "osd_shading/tables/patchKernels.h"
#include "osd_shading/vectorMath.h"
#include "tests/shapes.h"

/// What the tests of the kernels share: fields, points, plans, and the instruction sets of this processor.
namespace osd_shading::tests {

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

inline bool isSame(Point const& a, Point const& b) { return std::memcmp(&a, &b, sizeof a) == 0; }
inline bool isNan(Point const& a) { return std::isnan(a.x) || std::isnan(a.y) || std::isnan(a.z); }

inline void expectNear(Point const& a, Point const& b, double tolerance, std::string const& what) {
    EXPECT_NEAR(a.x, b.x, tolerance) << what;
    EXPECT_NEAR(a.y, b.y, tolerance) << what;
    EXPECT_NEAR(a.z, b.z, tolerance) << what;
}

inline Point randomPoint(Random& random, double size = 1) {
    return {random.Uniform(-size, size), random.Uniform(-size, size), random.Uniform(-size, size)};
}

inline Point pointOf(LocalPoint const& p) { return {double(p.v[0]), double(p.v[1]), double(p.v[2])}; }

inline std::vector<LocalPoint> randomLocalPoints(Random& random, int count) {
    std::vector<LocalPoint> points(at(count));
    for (LocalPoint& p : points) {
        for (int c = 0; c < 3; ++c) p.v[c] = static_cast<float>(random.Uniform(-1, 1));
        p.v[3] = 0;
    }
    return points;
}

inline std::vector<std::uint16_t> randomIndices(Random& random, int count, int numPoints) {
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
inline std::vector<Plan> plans(Random& random, int numU, int numV) {
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

class PatchKernelsOf : public testing::TestWithParam<InstructionSet> {
protected:
    PatchKernels const& kernels() const { return *FindKernels(GetParam()); }
};

inline std::vector<InstructionSet> availableSets() {
    std::vector<InstructionSet> sets;
    for (InstructionSet const set :
         {InstructionSet::Portable, InstructionSet::Sse2, InstructionSet::Avx2, InstructionSet::Avx512}) {
        if (IsAvailable(set)) sets.push_back(set);
    }
    return sets;
}

}  // namespace osd_shading::tests
