// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include "osd_shading/tables/patchKernels.h"

namespace osd_shading {
inline namespace v1 {

/// `count` of the 2^depth + 1 parameters of a face's side, from `first` on.
struct ParameterWindow {
    int depth;  ///< 0 to 15
    int first, count;
};

/// Limit values and slopes at `window`. For control points p: value = sum of value[j] p[j], and the derivative by
/// the face's parameter, which goes from 0 to 1, = sum of slope[j] (p[j + 1] - p[j]).
///
/// Computed in double and rounded once; `gridSize` is 1.
SplineBasis MakeFaceBasis(ParameterWindow const& window);

/// The same, but `value` gives the vertices of the face refined `depth` times: the blossom f(x - h, x, x + h),
/// h = 2^-depth. Slopes stay those of the limit.
SplineBasis MakeRefinedFaceBasis(ParameterWindow const& window);

/// Limit values over `gridSize` (2 to 16) faces of `2^shift` parameters each, and the end; at most 17 in all.
SplineBasis MakeGridBasis(int gridSize, int shift);

}  // namespace v1
}  // namespace osd_shading
