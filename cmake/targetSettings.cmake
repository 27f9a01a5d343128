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
        # -Wno-restrict: g++ 12 and 13 find an overlap in any "text" + std::string (GCC bug 105651).
        target_compile_options(${target} PRIVATE -Wall -Wextra -Wconversion -Wshadow
                                                 $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
                                                 $<$<BOOL:${OSD_SHADING_WERROR}>:-Werror>)
    endif()

    if(OSD_SHADING_SANITIZE)
        string(REPLACE ";" "," sanitizers "${OSD_SHADING_SANITIZE}")
        target_compile_options(${target} PRIVATE -fsanitize=${sanitizers} -fno-sanitize-recover=all
                                                 -fno-omit-frame-pointer)
        target_link_options(${target} PRIVATE -fsanitize=${sanitizers})
    endif()
endfunction()
