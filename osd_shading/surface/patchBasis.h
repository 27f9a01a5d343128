// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

namespace osd_shading {
inline namespace v1 {
namespace surface {

constexpr int kQuadPoints = 16, kTrianglePoints = 12;

/// The four weights of a uniform cubic B-spline, and their derivatives.
template <typename Real>
struct CubicBasis {
    Real value[4], first[4], second[4];
};

/// At t in [0, 1], between the points 1 and 2: the bicubic B-spline of 4 x 4 points is their product.   [CC78]
template <typename Real>
void EvaluateCubicBasis(Real t, CubicBasis<Real>& basis);

/// Weights of a regular triangle's control points at a parameter, and their derivatives.
template <typename Real>
struct PatchBasis {
    Real value[kTrianglePoints], du[kTrianglePoints], dv[kTrianglePoints];
    Real duu[kTrianglePoints], duv[kTrianglePoints], dvv[kTrianglePoints];  ///< where asked for
};

/// The quartic box spline over the triangle u, v >= 0, u + v <= 1: 12 points of the lattice whose (0, 0), (1, 0)
/// and (0, 1) are the triangle's vertices, in the order of kTriangleLattice.   [Loop87]
template <typename Real>
void EvaluateTriangleBasis(Real u, Real v, bool hasSecond, PatchBasis<Real>& basis);

struct LatticePoint {
    int column, row;
};
constexpr LatticePoint kTriangleLattice[kTrianglePoints] = {{0, 0},  {1, 0},  {0, 1}, {-1, 1}, {-1, 0}, {0, -1},
                                                            {1, -1}, {2, -1}, {2, 0}, {1, 1},  {0, 2},  {-1, 2}};

}  // namespace surface
}  // namespace v1
}  // namespace osd_shading
