// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/surface/patchBasis.h"

#include <array>
#include <cstddef>
#include <utility>

namespace osd_shading {
inline namespace v1 {
namespace surface {

namespace {

template <typename Real>
void cubicBasis(Real t, Real (&value)[4], Real (&first)[4], Real (&second)[4]) {
    Real const s = 1 - t, t2 = t * t, s2 = s * s;
    constexpr Real kSixth = Real(1) / 6;
    value[0] = kSixth * s2 * s;
    value[3] = kSixth * t2 * t;
    value[1] = kSixth * (4 + 3 * t2 * (t - 2));
    value[2] = kSixth * (4 + 3 * s2 * (s - 2));
    first[0] = Real(-0.5) * s2;
    first[3] = Real(0.5) * t2;
    first[1] = t * (Real(1.5) * t - 2);
    first[2] = s * (2 - Real(1.5) * s);
    second[0] = s;
    second[1] = 3 * t - 2;
    second[2] = 3 * s - 2;
    second[3] = t;
}

/// Polynomials of degree 4 in u and v: the coefficient of u^i v^j at [i][j].
using Quartic = std::array<std::array<double, 5>, 5>;

/// A term c a^i b^j d^k of barycentric coordinates.
struct BarycentricTerm {
    double factor;
    int i, j, k;
};

// One of the three kinds of the box spline's pieces, times 12, of the coordinates a, b, c of three corners.
// At corner a of the triangle.
constexpr BarycentricTerm kAtCorner[] = {{6, 4, 0, 0},  {24, 3, 1, 0}, {24, 3, 0, 1}, {24, 2, 2, 0}, {60, 2, 1, 1},
                                         {24, 2, 0, 2}, {8, 1, 3, 0},  {36, 1, 2, 1}, {36, 1, 1, 2}, {8, 1, 0, 3},
                                         {1, 0, 4, 0},  {6, 0, 3, 1},  {12, 0, 2, 2}, {6, 0, 1, 3},  {1, 0, 0, 4}};
// Across the edge of corners a and b.
constexpr BarycentricTerm kAcrossEdge[] = {{1, 4, 0, 0}, {6, 3, 1, 0}, {2, 3, 0, 1}, {12, 2, 2, 0}, {6, 2, 1, 1},
                                           {6, 1, 3, 0}, {6, 1, 2, 1}, {1, 0, 4, 0}, {2, 0, 3, 1}};
// Beyond corner a, on the side of corner b.
constexpr BarycentricTerm kBeyondCorner[] = {{1, 4, 0, 0}, {2, 3, 1, 0}};

Quartic multiplied(Quartic const& p, Quartic const& q) {
    Quartic product{};
    for (std::size_t i = 0; i < 5; ++i) {
        for (std::size_t j = 0; j < 5; ++j) {
            for (std::size_t k = 0; i + k < 5 && p[i][j] != 0; ++k) {
                for (std::size_t l = 0; j + l < 5; ++l) product[i + k][j + l] += p[i][j] * q[k][l];
            }
        }
    }
    return product;
}

/// corners: which barycentric coordinate (0: 1 - u - v, 1: u, 2: v) stands for a, b and c.
template <std::size_t Count>
Quartic expanded(BarycentricTerm const (&terms)[Count], std::array<int, 3> const& corners) {
    Quartic coordinates[3] = {};
    coordinates[0][0][0] = 1;
    coordinates[0][1][0] = coordinates[0][0][1] = -1;
    coordinates[1][1][0] = 1;
    coordinates[2][0][1] = 1;
    Quartic sum{};
    for (BarycentricTerm const& term : terms) {
        Quartic product{};
        product[0][0] = term.factor / 12;
        int const powers[3] = {term.i, term.j, term.k};
        for (std::size_t c = 0; c < 3; ++c) {
            for (int n = 0; n < powers[c]; ++n) {
                product = multiplied(product, coordinates[static_cast<std::size_t>(corners[c])]);
            }
        }
        for (std::size_t i = 0; i < 5; ++i) {
            for (std::size_t j = 0; j < 5; ++j) sum[i][j] += product[i][j];
        }
    }
    return sum;
}

/// The powers u^i v^j with i + j <= 4, those of low degree first.
constexpr int kNumPowers = 15;
constexpr int kPowers[kNumPowers][2] = {{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}, {3, 0}, {2, 1},
                                        {1, 2}, {0, 3}, {4, 0}, {3, 1}, {2, 2}, {1, 3}, {0, 4}};

/// By power, the coefficients of all control points, in the order of kTriangleLattice.
template <typename Real>
struct BoxSpline {
    Real coefficients[kNumPowers][kTrianglePoints];

    BoxSpline() {
        Quartic const pieces[kTrianglePoints] = {
            expanded(kAtCorner, {0, 1, 2}),     expanded(kAtCorner, {1, 2, 0}),
            expanded(kAtCorner, {2, 0, 1}),     expanded(kAcrossEdge, {0, 2, 1}),
            expanded(kBeyondCorner, {0, 2, 1}), expanded(kBeyondCorner, {0, 1, 2}),
            expanded(kAcrossEdge, {0, 1, 2}),   expanded(kBeyondCorner, {1, 0, 2}),
            expanded(kBeyondCorner, {1, 2, 0}), expanded(kAcrossEdge, {1, 2, 0}),
            expanded(kBeyondCorner, {2, 1, 0}), expanded(kBeyondCorner, {2, 0, 1})};
        for (std::size_t power = 0; power < kNumPowers; ++power) {
            auto const i = static_cast<std::size_t>(kPowers[power][0]),
                       j = static_cast<std::size_t>(kPowers[power][1]);
            for (std::size_t p = 0; p < kTrianglePoints; ++p) {
                coefficients[power][p] = static_cast<Real>(pieces[p][i][j]);
            }
        }
    }
    static BoxSpline const& Get() {
        static BoxSpline const kSpline;
        return kSpline;
    }
};

}  // namespace

template <typename Real>
void EvaluateQuadBasis(Real u, Real v, bool hasSecond, PatchBasis<Real>& basis) {
    Real bu[4], bv[4], du[4], dv[4], duu[4], dvv[4];
    cubicBasis(u, bu, du, duu);
    cubicBasis(v, bv, dv, dvv);
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) {
            int const i = 4 * row + column;
            basis.value[i] = bu[column] * bv[row];
            basis.du[i] = du[column] * bv[row];
            basis.dv[i] = bu[column] * dv[row];
        }
    }
    if (!hasSecond) return;
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) {
            int const i = 4 * row + column;
            basis.duu[i] = duu[column] * bv[row];
            basis.duv[i] = du[column] * dv[row];
            basis.dvv[i] = bu[column] * dvv[row];
        }
    }
}

template <typename Real>
void EvaluateTriangleBasis(Real u, Real v, bool hasSecond, PatchBasis<Real>& basis) {
    BoxSpline<Real> const& spline = BoxSpline<Real>::Get();
    Real const u2 = u * u, v2 = v * v, uv = u * v, u3 = u2 * u, v3 = v2 * v;
    auto const sum = [&](Real(&result)[kQuadPoints], auto const&... factors) {
        // Powers whose derivative is zero are left out: `factors` are pairs of a power and what it is there.
        for (int p = 0; p < kTrianglePoints; ++p) {
            result[p] = (... + (factors.second * spline.coefficients[factors.first][p]));
        }
    };
    using Factor = std::pair<int, Real>;
    sum(basis.value, Factor{0, 1}, Factor{1, u}, Factor{2, v}, Factor{3, u2}, Factor{4, uv}, Factor{5, v2},
        Factor{6, u3}, Factor{7, u2 * v}, Factor{8, u * v2}, Factor{9, v3}, Factor{10, u2 * u2}, Factor{11, u3 * v},
        Factor{12, u2 * v2}, Factor{13, u * v3}, Factor{14, v2 * v2});
    sum(basis.du, Factor{1, 1}, Factor{3, 2 * u}, Factor{4, v}, Factor{6, 3 * u2}, Factor{7, 2 * uv}, Factor{8, v2},
        Factor{10, 4 * u3}, Factor{11, 3 * u2 * v}, Factor{12, 2 * u * v2}, Factor{13, v3});
    sum(basis.dv, Factor{2, 1}, Factor{4, u}, Factor{5, 2 * v}, Factor{7, u2}, Factor{8, 2 * uv}, Factor{9, 3 * v2},
        Factor{11, u3}, Factor{12, 2 * u2 * v}, Factor{13, 3 * u * v2}, Factor{14, 4 * v3});
    if (!hasSecond) return;
    sum(basis.duu, Factor{3, 2}, Factor{6, 6 * u}, Factor{7, 2 * v}, Factor{10, 12 * u2}, Factor{11, 6 * uv},
        Factor{12, 2 * v2});
    sum(basis.duv, Factor{4, 1}, Factor{7, 2 * u}, Factor{8, 2 * v}, Factor{11, 3 * u2}, Factor{12, 4 * uv},
        Factor{13, 3 * v2});
    sum(basis.dvv, Factor{5, 2}, Factor{8, 2 * u}, Factor{9, 6 * v}, Factor{12, 2 * u2}, Factor{13, 6 * uv},
        Factor{14, 12 * v2});
}

#define OSD_SHADING_INSTANTIATE(Real)                                     \
    template void EvaluateQuadBasis(Real, Real, bool, PatchBasis<Real>&); \
    template void EvaluateTriangleBasis(Real, Real, bool, PatchBasis<Real>&);
OSD_SHADING_INSTANTIATE(float)
OSD_SHADING_INSTANTIATE(double)
#undef OSD_SHADING_INSTANTIATE

}  // namespace surface
}  // namespace v1
}  // namespace osd_shading
