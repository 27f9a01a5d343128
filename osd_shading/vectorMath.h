// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <cmath>

#include "osd_shading/views.h"

namespace osd_shading {
inline namespace v1 {

template <typename Real>
constexpr Vec3<Real> operator+(Vec3<Real> const& a, Vec3<Real> const& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <typename Real>
constexpr Vec3<Real> operator-(Vec3<Real> const& a, Vec3<Real> const& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <typename Real>
constexpr Vec3<Real> operator*(Real s, Vec3<Real> const& a) {
    return {s * a.x, s * a.y, s * a.z};
}
template <typename Real>
constexpr Vec3<Real>& operator+=(Vec3<Real>& a, Vec3<Real> const& b) {
    a = a + b;
    return a;
}

template <typename Real>
constexpr Real Dot(Vec3<Real> const& a, Vec3<Real> const& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <typename Real>
constexpr Vec3<Real> Cross(Vec3<Real> const& a, Vec3<Real> const& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Length without overflow or underflow of the squares.
template <typename Real>
Real Length(Vec3<Real> const& a) {
    Real const squared = Dot(a, a);
    // Squares of ordinary lengths are exact enough; the rest is scaled first.
    constexpr Real kSmall = sizeof(Real) == 4 ? Real(1e-30) : Real(1e-280);
    constexpr Real kLarge = sizeof(Real) == 4 ? Real(1e30) : Real(1e280);
    if (squared > kSmall && squared < kLarge) return std::sqrt(squared);
    Real const largest = std::fmax(std::fabs(a.x), std::fmax(std::fabs(a.y), std::fabs(a.z)));
    if (!(largest > 0)) return 0;
    Vec3<Real> const scaled{a.x / largest, a.y / largest, a.z / largest};
    return largest * std::sqrt(Dot(scaled, scaled));
}

/// The relative size under which a sum of vectors counts as vanished.
template <typename Real>
constexpr Real kVanishing = sizeof(Real) == 4 ? Real(1e-6) : Real(1e-12);

/// `sum`, of vectors whose lengths add to `added`, at unit length; zero where it vanishes.
template <typename Real>
Vec3<Real> NormalizedSum(Vec3<Real> const& sum, Real added) {
    Real const length = Length(sum);
    if (!(length > kVanishing<Real> * added)) return {};
    return {sum.x / length, sum.y / length, sum.z / length};
}

/// `a` at unit length; zero stays zero.
template <typename Real>
Vec3<Real> Normalized(Vec3<Real> const& a) {
    return NormalizedSum(a, Real(0));
}

template <typename Real>
constexpr bool IsZero(Vec3<Real> const& a) {
    return a.x == 0 && a.y == 0 && a.z == 0;
}

/// Angle between two directions in radians, exact near 0 and pi too.
template <typename RealA, typename RealB>
double AngleBetween(Vec3<RealA> const& a, Vec3<RealB> const& b) {
    Vec3<double> const p{double(a.x), double(a.y), double(a.z)}, q{double(b.x), double(b.y), double(b.z)};
    return std::atan2(Length(Cross(p, q)), Dot(p, q));
}

}  // namespace v1
}  // namespace osd_shading
