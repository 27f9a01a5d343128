// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/surface/patchBasis.h"

#include <array>
#include <cstddef>

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

/// In the order of kTriangleLattice.
std::array<Quartic, kTrianglePoints> const& boxSpline() {
    static std::array<Quartic, kTrianglePoints> const kPieces = {
        expanded(kAtCorner, {0, 1, 2}),   expanded(kAtCorner, {1, 2, 0}),     expanded(kAtCorner, {2, 0, 1}),
        expanded(kAcrossEdge, {0, 2, 1}), expanded(kBeyondCorner, {0, 2, 1}), expanded(kBeyondCorner, {0, 1, 2}),
        expanded(kAcrossEdge, {0, 1, 2}), expanded(kBeyondCorner, {1, 0, 2}), expanded(kBeyondCorner, {1, 2, 0}),
        expanded(kAcrossEdge, {1, 2, 0}), expanded(kBeyondCorner, {2, 1, 0}), expanded(kBeyondCorner, {2, 0, 1})};
    return kPieces;
}

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
    // Powers and their derivatives.
    Real const pu[5] = {1, u, u * u, u * u * u, u * u * u * u}, pv[5] = {1, v, v * v, v * v * v, v * v * v * v};
    Real const qu[5] = {0, 1, 2 * u, 3 * pu[2], 4 * pu[3]}, qv[5] = {0, 1, 2 * v, 3 * pv[2], 4 * pv[3]};
    Real const ru[5] = {0, 0, 2, 6 * u, 12 * pu[2]}, rv[5] = {0, 0, 2, 6 * v, 12 * pv[2]};
    auto const& pieces = boxSpline();
    for (std::size_t p = 0; p < pieces.size(); ++p) {
        Real sums[6] = {};
        for (std::size_t i = 0; i < 5; ++i) {
            Real value = 0, first = 0, second = 0;
            for (std::size_t j = 0; i + j < 5; ++j) {
                auto const c = static_cast<Real>(pieces[p][i][j]);
                value += c * pv[j];
                first += c * qv[j];
                if (hasSecond) second += c * rv[j];
            }
            sums[0] += pu[i] * value;
            sums[1] += qu[i] * value;
            sums[2] += pu[i] * first;
            if (!hasSecond) continue;
            sums[3] += ru[i] * value;
            sums[4] += qu[i] * first;
            sums[5] += pu[i] * second;
        }
        basis.value[p] = sums[0];
        basis.du[p] = sums[1];
        basis.dv[p] = sums[2];
        basis.duu[p] = sums[3];
        basis.duv[p] = sums[4];
        basis.dvv[p] = sums[5];
    }
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
