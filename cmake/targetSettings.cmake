# SPDX-License-Identifier: Apache-2.0
#
# What every target of this project is compiled with. On the target alone: nothing here reaches a consumer.

function(osd_shading_settings target)
    # C++17 is what users need (target_compile_features of the libraries); the sources may use C++20.
    set_target_properties(${target} PROPERTIES
        CXX_STANDARD 20 CXX_STANDARD_REQUIRED ON CXX_EXTENSIONS OFF
        CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON
        POSITION_INDEPENDENT_CODE ON)
    if(MSVC)
        target_compile_options(${target} PRIVATE /W4 /permissive- $<$<BOOL:${OSD_SHADING_WERROR}>:/WX>)
    else()
        # -Wno-...: g++ 12 and 13 find overlaps and lengths below 0 in any "text" + std::string (GCC bug 105651).
        target_compile_options(${target} PRIVATE -Wall -Wextra -Wconversion -Wshadow
                                                 $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict;-Wno-stringop-overflow;-Wno-array-bounds>
                                                 $<$<CXX_COMPILER_ID:Clang>:-Wreserved-identifier;-Wzero-as-null-pointer-constant>
                                                 $<$<BOOL:${OSD_SHADING_WERROR}>:-Werror>)
    endif()

    if(OSD_SHADING_SANITIZE)
        string(REPLACE ";" "," sanitizers "${OSD_SHADING_SANITIZE}")
        target_compile_options(${target} PRIVATE -fsanitize=${sanitizers} -fno-sanitize-recover=all
                                                 -fno-omit-frame-pointer)
        target_link_options(${target} PRIVATE -fsanitize=${sanitizers})
    endif()
endfunction()

# The same for programs, which spend their time in the library: with sanitizers it takes longer to optimise them.
function(osd_shading_program_settings target)
    osd_shading_settings(${target})
    if(OSD_SHADING_SANITIZE AND NOT MSVC)
        target_compile_options(${target} PRIVATE -O0)
    endif()
endfunction()

# Large headers that most of a target's files include, compiled once: that halves the time of a build. Each file names
# what it needs all the same; lint compiles without.
function(osd_shading_precompile target)
    target_precompile_headers(${target} PRIVATE
        <algorithm> <cmath> <cstdint> <functional> <map> <memory> <string> <unordered_map> <utility> <vector>
        <opensubdiv/far/primvarRefiner.h> <opensubdiv/far/topologyDescriptor.h> ${ARGN})
endfunction()
