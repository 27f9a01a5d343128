// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

namespace osd_shading {
inline namespace v1 {
namespace surface {

constexpr int kQuadPoints = 16, kTrianglePoints = 12;

/// Weights of a regular patch's control points at a parameter, and their derivatives.
template <typename Real>
struct PatchBasis {
    Real value[kQuadPoints], du[kQuadPoints], dv[kQuadPoints];
    Real duu[kQuadPoints], duv[kQuadPoints], dvv[kQuadPoints];  ///< where asked for
};

/// The uniform bicubic B-spline over [0, 1]^2: 4 x 4 points, row by row from (-1, -1) on.   [CC78]
template <typename Real>
void EvaluateQuadBasis(Real u, Real v, bool hasSecond, PatchBasis<Real>& basis);

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
