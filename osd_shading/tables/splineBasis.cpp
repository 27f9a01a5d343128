// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/tables/splineBasis.h"

#include <cassert>

namespace osd_shading {
inline namespace v1 {

namespace {

// Writes the cubic B-splines at `x` in [0, 1] of a face as parameter `i`, less `h`^2 / 6 times their second
// derivatives: of a cubic f the blossom f(x - h, x, x + h) is f(x) - h^2 f''(x) / 6.
void setValues(SplineBasis& basis, int i, double x, double h) {
    double const y = 1 - x, q = h * h;
    double const outer0 = (y * y * y - q * y) / 6, outer3 = (x * x * x - q * x) / 6;
    double const inner1 = (4 + x * x * (3 * x - 6) - q * (3 * x - 2)) / 6;
    double const inner2 = (4 + y * y * (3 * y - 6) - q * (3 * y - 2)) / 6;
    basis.value[0][i] = static_cast<float>(outer0);
    basis.value[1][i] = static_cast<float>(inner1);
    basis.value[2][i] = static_cast<float>(inner2);
    basis.value[3][i] = static_cast<float>(outer3);
}

// The same for the quadratic B-splines.
void setSlopes(SplineBasis& basis, int i, double x) {
    double const y = 1 - x;
    basis.slope[0][i] = static_cast<float>(y * y / 2);
    basis.slope[1][i] = static_cast<float>(0.5 + x * y);
    basis.slope[2][i] = static_cast<float>(x * x / 2);
}

SplineBasis makeFaceBasis(ParameterWindow const& window, double blossomStep) {
    assert(window.depth >= 0 && window.depth <= 15 && window.first >= 0);
    assert(window.count >= 1 && window.count <= kLeafSide + 1);
    assert(window.first + window.count <= (1 << window.depth) + 1);
    SplineBasis basis{};
    basis.numParameters = window.count;
    basis.gridSize = 1;
    basis.shift = window.depth;
    double const step = 1.0 / (1 << window.depth);
    for (int i = 0; i < window.count; ++i) {
        double const x = (window.first + i) * step;
        setValues(basis, i, x, blossomStep);
        setSlopes(basis, i, x);
    }
    return basis;
}

}  // namespace

SplineBasis MakeFaceBasis(ParameterWindow const& window) { return makeFaceBasis(window, 0); }

SplineBasis MakeRefinedFaceBasis(ParameterWindow const& window) {
    return makeFaceBasis(window, 1.0 / (1 << window.depth));
}

SplineBasis MakeGridBasis(int gridSize, int shift) {
    assert(gridSize >= 2 && shift >= 0 && (gridSize << shift) <= kLeafSide);
    SplineBasis basis{};
    basis.numParameters = (gridSize << shift) + 1;
    basis.gridSize = gridSize;
    basis.shift = shift;
    int const perFace = 1 << shift;
    for (int i = 0; i < basis.numParameters; ++i) setValues(basis, i, double(i % perFace) / perFace, 0);
    return basis;
}

}  // namespace v1
}  // namespace osd_shading
