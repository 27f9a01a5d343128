# SPDX-License-Identifier: Apache-2.0
#
# osd_shading_instruction_sets(OUTPUT): the files of the x86 kernels that this compiler can make, with their flags.
#
# No flag reaches another file: what else there is runs on any processor.

include(CheckCXXSourceCompiles)

function(osd_shading_instruction_sets output)
    set(files tables/patchKernelsPortable.cpp)
    set(definitions "")
    # A product and a sum are fused where the source says so and nowhere else: the same bits from any compiler.
    if(MSVC)
        set(exact /fp:precise)
        set(flagsSse2 "")
        set(flagsAvx2 /arch:AVX2)
        set(flagsAvx512 /arch:AVX512)
    else()
        set(exact -ffp-contract=off)
        set(flagsSse2 -msse2)
        set(flagsAvx2 -mavx2 -mfma)
        set(flagsAvx512 -mavx512f -mavx512bw -mavx512dq -mavx512vl -mavx2 -mfma)
    endif()
    set(probeSse2 "__m128 a = _mm_set1_ps(1); return _mm_movemask_ps(_mm_cmpgt_ps(a, a));")
    set(probeAvx2 "__m256 a = _mm256_set1_ps(1); return _mm256_movemask_ps(_mm256_fmadd_ps(a, a, a));")
    set(probeAvx512 "__m512 a = _mm512_set1_ps(1); return _mm_extract_epi32(_mm_castps_si128(_mm512_extractf32x4_ps(
                     _mm512_mask_blend_ps(_mm512_cmp_ps_mask(a, a, _CMP_GT_OQ), a, a), 3)), 0);")

    if(CMAKE_SYSTEM_PROCESSOR MATCHES "^([xX]86_64|[aA][mM][dD]64|[iI][3-6]86|[xX]86)$")
        foreach(set Sse2 Avx2 Avx512)
            string(TOUPPER ${set} upper)
            list(JOIN flags${set} " " CMAKE_REQUIRED_FLAGS)
            check_cxx_source_compiles("#include <immintrin.h>\nint main() { ${probe${set}} }" OSD_SHADING_HAS_${upper})
            if(OSD_SHADING_HAS_${upper})
                list(APPEND files tables/patchKernels${set}.cpp)
                list(APPEND definitions OSD_SHADING_WITH_${upper})
                # g++ 12 and 13 warn of its own intrinsics, _mm512_undefined_ps (GCC bug 105593).
                set_source_files_properties(
                    tables/patchKernels${set}.cpp PROPERTIES
                    COMPILE_OPTIONS
                    "${exact};${flags${set}};$<$<CXX_COMPILER_ID:GNU>:-Wno-uninitialized;-Wno-maybe-uninitialized>")
            endif()
        endforeach()
    endif()
    set_source_files_properties(tables/patchKernelsPortable.cpp PROPERTIES COMPILE_OPTIONS "${exact}")
    # What the other files share is compiled for any processor.
    set_source_files_properties(${files} PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
    set_source_files_properties(tables/patchKernels.cpp PROPERTIES COMPILE_DEFINITIONS "${definitions}")
    set(${output} ${files} PARENT_SCOPE)
endfunction()
