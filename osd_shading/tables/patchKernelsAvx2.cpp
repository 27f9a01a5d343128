// SPDX-License-Identifier: Apache-2.0
#include <immintrin.h>

#include "osd_shading/tables/patchKernelSets.h"
#include "osd_shading/tables/patchKernelsImpl.h"
#include "osd_shading/tables/quadLanes.h"

namespace osd_shading {
inline namespace v1 {

namespace {

struct Fma {
    static __m128 Add(__m128 a, __m128 b, __m128 c) { return _mm_fmadd_ps(a, b, c); }
    static __m128 Subtract(__m128 a, __m128 b, __m128 c) { return _mm_fmsub_ps(a, b, c); }
};

struct Avx2Lanes {
    struct Mask {
        __m256 m;

        friend Mask And(Mask a, Mask b) { return {_mm256_and_ps(a.m, b.m)}; }
        friend unsigned Bits(Mask a) { return static_cast<unsigned>(_mm256_movemask_ps(a.m)); }
    };

    struct Vector {
        __m256 v;

        static Vector Load(float const* p) { return {_mm256_loadu_ps(p)}; }
        static Vector Broadcast(float const* p) { return {_mm256_broadcast_ss(p)}; }
        static Vector Set(float x) { return {_mm256_set1_ps(x)}; }
        void Store(float* p) const { _mm256_storeu_ps(p, v); }
        Vector Kept() const {
            Vector kept = *this;
#ifdef __GNUC__
            asm("" : "+x"(kept.v));
#endif
            return kept;
        }

        friend Vector operator+(Vector a, Vector b) { return {_mm256_add_ps(a.v, b.v)}; }
        friend Vector operator-(Vector a, Vector b) { return {_mm256_sub_ps(a.v, b.v)}; }
        friend Vector operator*(Vector a, Vector b) { return {_mm256_mul_ps(a.v, b.v)}; }
        friend Vector operator/(Vector a, Vector b) { return {_mm256_div_ps(a.v, b.v)}; }
        friend Vector MulAdd(Vector a, Vector b, Vector c) { return {_mm256_fmadd_ps(a.v, b.v, c.v)}; }
        friend Vector MulSub(Vector a, Vector b, Vector c) { return {_mm256_fmsub_ps(a.v, b.v, c.v)}; }
        friend Vector Sqrt(Vector a) { return {_mm256_sqrt_ps(a.v)}; }
        friend Vector Max(Vector a, Vector b) { return {_mm256_max_ps(a.v, b.v)}; }
        friend Mask Greater(Vector a, Vector b) { return {_mm256_cmp_ps(a.v, b.v, _CMP_GT_OQ)}; }
        friend Mask NotLess(Vector a, Vector b) { return {_mm256_cmp_ps(a.v, b.v, _CMP_GE_OQ)}; }
        friend Vector Select(Mask m, Vector a, Vector b) { return {_mm256_blendv_ps(b.v, a.v, m.m)}; }
        friend Vector KeepIf(Mask m, Vector a) { return {_mm256_and_ps(m.m, a.v)}; }
    };

    using Half = QuadLanes<Fma>;
    using Quad = Half::Vector;
    static constexpr int kCount = 8;

    template <int kSide>
    static Vector Repeat(float const* p) {
        if constexpr (kSide == 8) {
            return Vector::Load(p);
        } else {
            return {_mm256_broadcast_ps(reinterpret_cast<__m128 const*>(p))};
        }
    }
    template <int kSide>
    static Vector Spread(float const* p) {
        if constexpr (kSide == 8) {
            return Vector::Broadcast(p);
        } else {
            return {_mm256_set_m128(_mm_broadcast_ss(p + 1), _mm_broadcast_ss(p))};
        }
    }

    static void WritePacked(Vector x, Vector y, Vector z, float* to) {
        // In each half of four points ...
        __m256 const xy = _mm256_shuffle_ps(x.v, y.v, _MM_SHUFFLE(2, 0, 2, 0));    // x0 x2 y0 y2
        __m256 const yz = _mm256_shuffle_ps(y.v, z.v, _MM_SHUFFLE(3, 1, 3, 1));    // y1 y3 z1 z3
        __m256 const zx = _mm256_shuffle_ps(z.v, x.v, _MM_SHUFFLE(3, 1, 2, 0));    // z0 z2 x1 x3
        __m256 const first = _mm256_shuffle_ps(xy, zx, _MM_SHUFFLE(2, 0, 2, 0));   // x0 y0 z0 x1
        __m256 const second = _mm256_shuffle_ps(yz, xy, _MM_SHUFFLE(3, 1, 2, 0));  // y1 z1 x2 y2
        __m256 const third = _mm256_shuffle_ps(zx, yz, _MM_SHUFFLE(3, 1, 3, 1));   // z2 x3 y3 z3
        // ... and the halves one after the other.
        _mm256_storeu_ps(to, _mm256_permute2f128_ps(first, second, 0x20));
        _mm256_storeu_ps(to + 8, _mm256_blend_ps(third, first, 0xf0));
        _mm256_storeu_ps(to + 16, _mm256_permute2f128_ps(second, third, 0x31));
    }

    static void WriteStrided(Vector x, Vector y, Vector z, float* to, std::size_t stride) {
        Half::WriteStrided(low(x), low(y), low(z), to, stride);
        Half::WriteStrided(high(x), high(y), high(z), to + 4 * stride, stride);
    }

private:
    static Quad low(Vector a) { return {_mm256_castps256_ps128(a.v)}; }
    static Quad high(Vector a) { return {_mm256_extractf128_ps(a.v, 1)}; }
};

}  // namespace

constinit PatchKernels const kAvx2Kernels = KernelsFor<Avx2Lanes>::Table("avx2");

}  // namespace v1
}  // namespace osd_shading
