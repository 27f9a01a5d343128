// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <cmath>

#include "osd_shading/vectorMath.h"

namespace osd_shading {
inline namespace v1 {

/// N_B = normalize((1 - b^p) N_L + b^p N_S), for b in [0, 1] and p > 0; N_L where the sum vanishes or b is 0.
/// [ZBK23] Eq. 1
template <typename Real>
Vec3<Real> BlendNormals(Vec3<Real> const& limitNormal, Vec3<Real> const& subdividedNormal, Real blendWeight,
                        double exponent) {
    if (blendWeight == 0) return limitNormal;
    Real const share =
        exponent == 1 ? blendWeight : static_cast<Real>(std::pow(static_cast<double>(blendWeight), exponent));
    Vec3<Real> const a = (1 - share) * limitNormal, b = share * subdividedNormal;
    Vec3<Real> const sum = a + b;
    // Both are at most a rounding longer than 1, so that most sums are settled without their lengths.
    Real const length = Length(sum);
    if (length > 4 * kVanishing<Real>) return {sum.x / length, sum.y / length, sum.z / length};
    Vec3<Real> const blended = NormalizedSum(sum, Length(a) + Length(b));
    return IsZero(blended) ? limitNormal : blended;
}

}  // namespace v1
}  // namespace osd_shading
