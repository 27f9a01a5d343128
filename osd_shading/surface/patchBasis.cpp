// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/surface/patchBasis.h"

namespace osd_shading {
inline namespace v1 {
namespace surface {

namespace {

/// A weight as a function of the barycentric coordinates 1 - u - v, u and v, each on its own: its derivatives by u
/// and v follow from those by the three.
template <typename Real>
struct Barycentric {
    Real value = 0, by[3] = {}, second[3][3] = {};

    void WriteTo(PatchBasis<Real>& basis, int point, bool hasSecond) const {
        basis.value[point] = value;
        basis.du[point] = by[1] - by[0];
        basis.dv[point] = by[2] - by[0];
        if (!hasSecond) return;
        basis.duu[point] = second[1][1] - 2 * second[0][1] + second[0][0];
        basis.duv[point] = second[1][2] - second[0][1] - second[0][2] + second[0][0];
        basis.dvv[point] = second[2][2] - 2 * second[0][2] + second[0][0];
    }
    void SetSecond(int i, int j, Real to) { second[i][j] = second[j][i] = to; }
};

/// The point beyond corner A on the side of corner B: a^3 (a + 2 b) / 12.
template <int A, int B, typename Real>
void beyondCorner(Real const (&at)[3], bool hasSecond, PatchBasis<Real>& basis, int point) {
    Real const a = at[A], b = at[B], a2 = a * a, a3 = a2 * a;
    Barycentric<Real> weight;
    weight.value = a3 * (a + 2 * b) / 12;
    weight.by[A] = a2 * (2 * a + 3 * b) / 6;
    weight.by[B] = a3 / 6;
    if (hasSecond) {
        weight.SetSecond(A, A, a * (a + b));
        weight.SetSecond(A, B, a2 / 2);
    }
    weight.WriteTo(basis, point, hasSecond);
}

/// The point across the edge of corners A and B: with s = a + b and q = a b, (s^4 + 2 q (s^2 + q) + 2 c s^3) / 12.
template <int A, int B, typename Real>
void acrossEdge(Real const (&at)[3], bool hasSecond, PatchBasis<Real>& basis, int point) {
    constexpr int kC = 3 - A - B;
    Real const a = at[A], b = at[B], c = at[kC], s = a + b, q = a * b, s2 = s * s;
    constexpr Real kSixth = Real(1) / 6;
    Real const byS = kSixth * s * (2 * s2 + 2 * q + 3 * c * s), byQ = kSixth * (s2 + 2 * q);
    Barycentric<Real> weight;
    weight.value = kSixth * (s2 * s * (s / 2 + c) + q * (s2 + q));
    weight.by[A] = byS + b * byQ;
    weight.by[B] = byS + a * byQ;
    weight.by[kC] = kSixth * s2 * s;
    if (hasSecond) {
        constexpr Real kThird = Real(1) / 3;
        Real const bySS = s2 + kThird * q + c * s, bySQ = kThird * s;
        weight.SetSecond(A, A, bySS + 2 * b * bySQ + kThird * b * b);
        weight.SetSecond(B, B, bySS + 2 * a * bySQ + kThird * a * a);
        weight.SetSecond(A, B, bySS + s * bySQ + kThird * q + byQ);
        weight.SetSecond(A, kC, s2 / 2);
        weight.SetSecond(B, kC, s2 / 2);
    }
    weight.WriteTo(basis, point, hasSecond);
}

/// The weights of the triangle's corners from those of all others: the weighted sum of the lattice is (u, v).
template <typename Real>
void fillCorners(Real (&weights)[kTrianglePoints], Real one, Real u, Real v) {
    Real sum = 0, columns = 0, rows = 0;
    for (int p = 3; p < kTrianglePoints; ++p) {
        sum += weights[p];
        columns += static_cast<Real>(kTriangleLattice[p].column) * weights[p];
        rows += static_cast<Real>(kTriangleLattice[p].row) * weights[p];
    }
    weights[1] = u - columns;
    weights[2] = v - rows;
    weights[0] = one - sum - weights[1] - weights[2];
}

}  // namespace

template <typename Real>
void EvaluateCubicBasis(Real t, CubicBasis<Real>& basis) {
    Real const s = 1 - t, t2 = t * t, s2 = s * s;
    constexpr Real kSixth = Real(1) / 6;
    basis.value[0] = kSixth * s2 * s;
    basis.value[3] = kSixth * t2 * t;
    basis.value[1] = kSixth * (4 + 3 * t2 * (t - 2));
    basis.value[2] = kSixth * (4 + 3 * s2 * (s - 2));
    basis.first[0] = Real(-0.5) * s2;
    basis.first[3] = Real(0.5) * t2;
    basis.first[1] = t * (Real(1.5) * t - 2);
    basis.first[2] = s * (2 - Real(1.5) * s);
    basis.second[0] = s;
    basis.second[1] = 3 * t - 2;
    basis.second[2] = 3 * s - 2;
    basis.second[3] = t;
}

template <typename Real>
void EvaluateTriangleBasis(Real u, Real v, bool hasSecond, PatchBasis<Real>& basis) {
    Real const at[3] = {1 - u - v, u, v};
    acrossEdge<0, 2>(at, hasSecond, basis, 3);
    beyondCorner<0, 2>(at, hasSecond, basis, 4);
    beyondCorner<0, 1>(at, hasSecond, basis, 5);
    acrossEdge<0, 1>(at, hasSecond, basis, 6);
    beyondCorner<1, 0>(at, hasSecond, basis, 7);
    beyondCorner<1, 2>(at, hasSecond, basis, 8);
    acrossEdge<1, 2>(at, hasSecond, basis, 9);
    beyondCorner<2, 1>(at, hasSecond, basis, 10);
    beyondCorner<2, 0>(at, hasSecond, basis, 11);
    fillCorners<Real>(basis.value, 1, u, v);
    fillCorners<Real>(basis.du, 0, 1, 0);
    fillCorners<Real>(basis.dv, 0, 0, 1);
    if (!hasSecond) return;
    fillCorners<Real>(basis.duu, 0, 0, 0);
    fillCorners<Real>(basis.duv, 0, 0, 0);
    fillCorners<Real>(basis.dvv, 0, 0, 0);
}

#define OSD_SHADING_INSTANTIATE(Real)                          \
    template void EvaluateCubicBasis(Real, CubicBasis<Real>&); \
    template void EvaluateTriangleBasis(Real, Real, bool, PatchBasis<Real>&);
OSD_SHADING_INSTANTIATE(float)
OSD_SHADING_INSTANTIATE(double)
#undef OSD_SHADING_INSTANTIATE

}  // namespace surface
}  // namespace v1
}  // namespace osd_shading
