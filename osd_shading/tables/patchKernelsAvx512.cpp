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

// Where x y z of 16 points come from when they are written `stride` floats apart, 16 floats at a time.
struct Interleaving {
    int fromXY[16];         // x at 0 .. 15, y at 16 .. 31
    int fromXYAndZ[16];     // itself at 0 .. 15, z at 16 .. 31
    unsigned short filled;  // one bit per float that belongs to a point
};

constexpr Interleaving makeInterleaving(int stride, int part) {
    Interleaving result{};
    for (int i = 0; i < 16; ++i) {
        int const point = (16 * part + i) / stride, component = (16 * part + i) % stride;
        result.fromXY[i] = component == 1 ? 16 + point : point;
        result.fromXYAndZ[i] = component == 2 ? 16 + point : i;
        if (component < 3) result.filled = static_cast<unsigned short>(result.filled | 1U << i);
    }
    return result;
}

alignas(64) constexpr Interleaving kPacked[3] = {makeInterleaving(3, 0), makeInterleaving(3, 1),
                                                 makeInterleaving(3, 2)};
alignas(64) constexpr Interleaving kByFour[4] = {makeInterleaving(4, 0), makeInterleaving(4, 1),
                                                 makeInterleaving(4, 2), makeInterleaving(4, 3)};
alignas(64) constexpr Interleaving kBySix[6] = {makeInterleaving(6, 0), makeInterleaving(6, 1),
                                                makeInterleaving(6, 2), makeInterleaving(6, 3),
                                                makeInterleaving(6, 4), makeInterleaving(6, 5)};

struct Avx512Lanes {
    struct Mask {
        __mmask16 m;

        friend Mask And(Mask a, Mask b) { return {static_cast<__mmask16>(a.m & b.m)}; }
        friend unsigned Bits(Mask a) { return a.m; }
    };

    struct Vector {
        __m512 v;

        static Vector Load(float const* p) { return {_mm512_loadu_ps(p)}; }
        static Vector Broadcast(float const* p) { return {_mm512_set1_ps(*p)}; }
        static Vector Set(float x) { return {_mm512_set1_ps(x)}; }
        void Store(float* p) const { _mm512_storeu_ps(p, v); }
        Vector Kept() const {
            Vector kept = *this;
#ifdef __GNUC__
            asm("" : "+v"(kept.v));
#endif
            return kept;
        }

        friend Vector operator+(Vector a, Vector b) { return {_mm512_add_ps(a.v, b.v)}; }
        friend Vector operator-(Vector a, Vector b) { return {_mm512_sub_ps(a.v, b.v)}; }
        friend Vector operator*(Vector a, Vector b) { return {_mm512_mul_ps(a.v, b.v)}; }
        friend Vector operator/(Vector a, Vector b) { return {_mm512_div_ps(a.v, b.v)}; }
        friend Vector MulAdd(Vector a, Vector b, Vector c) { return {_mm512_fmadd_ps(a.v, b.v, c.v)}; }
        friend Vector MulSub(Vector a, Vector b, Vector c) { return {_mm512_fmsub_ps(a.v, b.v, c.v)}; }
        friend Vector Sqrt(Vector a) { return {_mm512_sqrt_ps(a.v)}; }
        friend Vector Max(Vector a, Vector b) { return {_mm512_max_ps(a.v, b.v)}; }
        friend Mask Greater(Vector a, Vector b) { return {_mm512_cmp_ps_mask(a.v, b.v, _CMP_GT_OQ)}; }
        friend Mask NotLess(Vector a, Vector b) { return {_mm512_cmp_ps_mask(a.v, b.v, _CMP_GE_OQ)}; }
        friend Vector Select(Mask m, Vector a, Vector b) { return {_mm512_mask_blend_ps(m.m, b.v, a.v)}; }
        friend Vector KeepIf(Mask m, Vector a) { return {_mm512_maskz_mov_ps(m.m, a.v)}; }
    };

    using Quarter = QuadLanes<Fma>;
    using Quad = Quarter::Vector;
    static constexpr int kCount = 16;

    template <int kSide>
    static Vector Repeat(float const* p) {
        if constexpr (kSide == 16) {
            return Vector::Load(p);
        } else if constexpr (kSide == 8) {
            return {_mm512_broadcast_f32x8(_mm256_loadu_ps(p))};
        } else {
            return {_mm512_broadcast_f32x4(_mm_loadu_ps(p))};
        }
    }
    template <int kSide>
    static Vector Spread(float const* p) {
        if constexpr (kSide == 16) {
            return Vector::Broadcast(p);
        } else if constexpr (kSide == 8) {
            __m512 const first = _mm512_castps256_ps512(_mm256_broadcast_ss(p));
            return {_mm512_insertf32x8(first, _mm256_broadcast_ss(p + 1), 1)};
        } else {
            __m512i const from = _mm512_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3);
            return {_mm512_permutexvar_ps(from, _mm512_castps128_ps512(_mm_loadu_ps(p)))};
        }
    }

    static void WritePacked(Vector x, Vector y, Vector z, float* to) {
        for (int part = 0; part < 3; ++part) {
            _mm512_storeu_ps(to + 16 * part, interleave(x, y, z, kPacked[part]));
        }
    }

    static void WriteStrided(Vector x, Vector y, Vector z, float* to, std::size_t stride) {
        if (stride == 4) {
            writeMasked<4>(x, y, z, to, kByFour);
        } else if (stride == 6) {
            writeMasked<6>(x, y, z, to, kBySix);
        } else {
            Quarter::WriteStrided(quarter<0>(x), quarter<0>(y), quarter<0>(z), to, stride);
            Quarter::WriteStrided(quarter<1>(x), quarter<1>(y), quarter<1>(z), to + 4 * stride, stride);
            Quarter::WriteStrided(quarter<2>(x), quarter<2>(y), quarter<2>(z), to + 8 * stride, stride);
            Quarter::WriteStrided(quarter<3>(x), quarter<3>(y), quarter<3>(z), to + 12 * stride, stride);
        }
    }

private:
    static __m512 interleave(Vector x, Vector y, Vector z, Interleaving const& from) {
        __m512 const xy = _mm512_permutex2var_ps(x.v, _mm512_loadu_si512(from.fromXY), y.v);
        return _mm512_permutex2var_ps(xy, _mm512_loadu_si512(from.fromXYAndZ), z.v);
    }

    template <int kStride>
    static void writeMasked(Vector x, Vector y, Vector z, float* to, Interleaving const* from) {
        for (int part = 0; part < kStride; ++part) {
            _mm512_mask_storeu_ps(to + 16 * part, from[part].filled, interleave(x, y, z, from[part]));
        }
    }

    template <int kIndex>
    static Quad quarter(Vector a) {
        return {_mm512_extractf32x4_ps(a.v, kIndex)};
    }
};

}  // namespace

constinit PatchKernels const kAvx512Kernels = KernelsFor<Avx512Lanes>::Table("avx512");

}  // namespace v1
}  // namespace osd_shading
