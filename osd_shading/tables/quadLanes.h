// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <emmintrin.h>

#include <cstddef>

namespace osd_shading {
inline namespace v1 {

/// Four floats by SSE2, for `Lanes` of patchKernelsImpl.h. `Fused` has Add (a b + c) and Subtract (a b - c) and is
/// a type of one file alone, so that no code is shared between files that are compiled for different processors.
template <typename Fused>
struct QuadLanes {
    struct Mask {
        __m128 m;

        friend Mask And(Mask a, Mask b) { return {_mm_and_ps(a.m, b.m)}; }
        friend unsigned Bits(Mask a) { return static_cast<unsigned>(_mm_movemask_ps(a.m)); }
    };

    struct Vector {
        __m128 v;

        static Vector Load(float const* p) { return {_mm_loadu_ps(p)}; }
        static Vector Broadcast(float const* p) { return {_mm_set1_ps(*p)}; }
        static Vector Set(float x) { return {_mm_set1_ps(x)}; }
        void Store(float* p) const { _mm_storeu_ps(p, v); }
        Vector Kept() const { return *this; }  // loading again is as good as copying, without fused forms

        friend Vector operator+(Vector a, Vector b) { return {_mm_add_ps(a.v, b.v)}; }
        friend Vector operator-(Vector a, Vector b) { return {_mm_sub_ps(a.v, b.v)}; }
        friend Vector operator*(Vector a, Vector b) { return {_mm_mul_ps(a.v, b.v)}; }
        friend Vector operator/(Vector a, Vector b) { return {_mm_div_ps(a.v, b.v)}; }
        friend Vector Sqrt(Vector a) { return {_mm_sqrt_ps(a.v)}; }
        friend Vector Max(Vector a, Vector b) { return {_mm_max_ps(a.v, b.v)}; }
        friend Mask Greater(Vector a, Vector b) { return {_mm_cmpgt_ps(a.v, b.v)}; }
        friend Mask NotLess(Vector a, Vector b) { return {_mm_cmpge_ps(a.v, b.v)}; }
        friend Vector Select(Mask m, Vector a, Vector b) {
            return {_mm_or_ps(_mm_and_ps(m.m, a.v), _mm_andnot_ps(m.m, b.v))};
        }
        friend Vector KeepIf(Mask m, Vector a) { return {_mm_and_ps(m.m, a.v)}; }

        friend Vector MulAdd(Vector a, Vector b, Vector c) { return {Fused::Add(a.v, b.v, c.v)}; }
        friend Vector MulSub(Vector a, Vector b, Vector c) { return {Fused::Subtract(a.v, b.v, c.v)}; }

        friend Vector ZipLow(Vector a, Vector b) { return {_mm_unpacklo_ps(a.v, b.v)}; }
        friend Vector ZipHigh(Vector a, Vector b) { return {_mm_unpackhi_ps(a.v, b.v)}; }
        friend void Transpose(Vector& a, Vector& b, Vector& c, Vector& d) { _MM_TRANSPOSE4_PS(a.v, b.v, c.v, d.v); }
    };
    using Quad = Vector;

    static constexpr int kCount = 4;

    template <int kSide>
    static Vector Repeat(float const* p) {
        return Vector::Load(p);
    }
    template <int kSide>
    static Vector Spread(float const* p) {
        return Vector::Broadcast(p);
    }

    /// x0 y0 z0 x1 y1 z1 ...
    static void WritePacked(Vector x, Vector y, Vector z, float* to) {
        __m128 const xy = _mm_unpacklo_ps(x.v, y.v);                          // x0 y0 x1 y1
        __m128 const yz = _mm_shuffle_ps(y.v, z.v, _MM_SHUFFLE(2, 1, 2, 1));  // y1 y2 z1 z2
        __m128 const zx = _mm_shuffle_ps(z.v, x.v, _MM_SHUFFLE(3, 1, 2, 0));  // z0 z2 x1 x3
        __m128 const xyHigh = _mm_unpackhi_ps(x.v, y.v);                      // x2 y2 x3 y3
        _mm_storeu_ps(to, _mm_shuffle_ps(xy, zx, _MM_SHUFFLE(2, 0, 1, 0)));   // x0 y0 z0 x1
        _mm_storeu_ps(to + 4, _mm_shuffle_ps(_mm_shuffle_ps(yz, yz, _MM_SHUFFLE(3, 1, 2, 0)), xyHigh,
                                             _MM_SHUFFLE(1, 0, 1, 0)));                // y1 z1 x2 y2
        __m128 const zHigh = _mm_shuffle_ps(z.v, xyHigh, _MM_SHUFFLE(3, 2, 3, 2));     // z2 z3 x3 y3
        _mm_storeu_ps(to + 8, _mm_shuffle_ps(zHigh, zHigh, _MM_SHUFFLE(1, 3, 2, 0)));  // z2 x3 y3 z3
    }

    /// x, y, z of point i at `to + i * stride`, and nothing between.
    static void WriteStrided(Vector x, Vector y, Vector z, float* to, std::size_t stride) {
        __m128 const low = _mm_unpacklo_ps(x.v, y.v), high = _mm_unpackhi_ps(x.v, y.v);
        float *const to1 = to + stride, *const to2 = to1 + stride, *const to3 = to2 + stride;
        _mm_storel_pi(reinterpret_cast<__m64*>(to), low);
        _mm_store_ss(to + 2, z.v);
        _mm_storeh_pi(reinterpret_cast<__m64*>(to1), low);
        _mm_store_ss(to1 + 2, _mm_shuffle_ps(z.v, z.v, _MM_SHUFFLE(1, 1, 1, 1)));
        _mm_storel_pi(reinterpret_cast<__m64*>(to2), high);
        _mm_store_ss(to2 + 2, _mm_movehl_ps(z.v, z.v));
        _mm_storeh_pi(reinterpret_cast<__m64*>(to3), high);
        _mm_store_ss(to3 + 2, _mm_shuffle_ps(z.v, z.v, _MM_SHUFFLE(3, 3, 3, 3)));
    }
};

}  // namespace v1
}  // namespace osd_shading
