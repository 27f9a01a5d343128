// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/tables/patchKernelSets.h"
#include "osd_shading/tables/patchKernelsImpl.h"
#include "osd_shading/tables/quadLanes.h"

namespace osd_shading {
inline namespace v1 {

namespace {

struct Sse2 {
    static __m128 Add(__m128 a, __m128 b, __m128 c) { return _mm_add_ps(_mm_mul_ps(a, b), c); }
    static __m128 Subtract(__m128 a, __m128 b, __m128 c) { return _mm_sub_ps(_mm_mul_ps(a, b), c); }
};

}  // namespace

constinit PatchKernels const kSse2Kernels = KernelsFor<QuadLanes<Sse2>>::Table("sse2");

}  // namespace v1
}  // namespace osd_shading
