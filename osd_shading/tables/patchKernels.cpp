// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/tables/patchKernels.h"

#include "osd_shading/shadingEvaluator.h"
#include "osd_shading/tables/patchKernelSets.h"

#if defined(_MSC_VER) && (defined(OSD_SHADING_WITH_SSE2) || defined(OSD_SHADING_WITH_AVX2))
#    include <intrin.h>
#endif

namespace osd_shading {
inline namespace v1 {

namespace {

// Whether the processor has an instruction set and the operating system keeps its registers.
#if defined(_MSC_VER) && !defined(__clang__)
#    if defined(OSD_SHADING_WITH_SSE2) || defined(OSD_SHADING_WITH_AVX2)

struct CpuFeatures {
    bool sse2, avx2, avx512;
};

CpuFeatures detectCpu() {
    int leaf[4] = {};
    __cpuid(leaf, 0);
    int const numLeaves = leaf[0];
    __cpuid(leaf, 1);
    auto const bit = [](int word, int i) { return ((static_cast<unsigned>(word) >> i) & 1U) != 0; };
    bool const sse2 = bit(leaf[3], 26), fma = bit(leaf[2], 12), osxsave = bit(leaf[2], 27);
    unsigned long long const saved = osxsave ? _xgetbv(0) : 0;
    bool const savesAvx = (saved & 0x6) == 0x6, savesAvx512 = (saved & 0xe6) == 0xe6;
    if (numLeaves < 7) return {sse2, false, false};
    __cpuidex(leaf, 7, 0);
    bool const avx2 = fma && bit(leaf[1], 5) && savesAvx;
    bool const avx512 = bit(leaf[1], 16) && bit(leaf[1], 17) && bit(leaf[1], 30) && bit(leaf[1], 31);
    return {sse2, avx2, avx2 && avx512 && savesAvx512};
}

[[maybe_unused]] bool hasSse2() { return detectCpu().sse2; }
[[maybe_unused]] bool hasAvx2() { return detectCpu().avx2; }
[[maybe_unused]] bool hasAvx512() { return detectCpu().avx512; }

#    endif
#elif defined(OSD_SHADING_WITH_SSE2) || defined(OSD_SHADING_WITH_AVX2)

[[maybe_unused]] bool hasSse2() {
    __builtin_cpu_init();
    return __builtin_cpu_supports("sse2");
}

[[maybe_unused]] bool hasAvx2() {
    __builtin_cpu_init();
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
}

[[maybe_unused]] bool hasAvx512() {
    return hasAvx2() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
}

#endif

}  // namespace

PatchKernels const* FindKernels(InstructionSet set) {
    switch (set) {
        case InstructionSet::Best:
            for (InstructionSet const better :
                 {InstructionSet::Avx512, InstructionSet::Avx2, InstructionSet::Sse2}) {
                if (PatchKernels const* const kernels = FindKernels(better)) return kernels;
            }
            return &kPortableKernels;
        case InstructionSet::Portable:
            return &kPortableKernels;
        case InstructionSet::Sse2:
#ifdef OSD_SHADING_WITH_SSE2
            if (hasSse2()) return &kSse2Kernels;
#endif
            break;
        case InstructionSet::Avx2:
#ifdef OSD_SHADING_WITH_AVX2
            if (hasAvx2()) return &kAvx2Kernels;
#endif
            break;
        case InstructionSet::Avx512:
#ifdef OSD_SHADING_WITH_AVX512
            if (hasAvx512()) return &kAvx512Kernels;
#endif
            break;
    }
    return nullptr;
}

bool IsAvailable(InstructionSet set) { return FindKernels(set) != nullptr; }

}  // namespace v1
}  // namespace osd_shading
