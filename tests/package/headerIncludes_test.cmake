# SPDX-License-Identifier: Apache-2.0
#
# Reads the #include lines of every public header: OpenSubdiv, the standard library and public headers may be there,
# and no header of the core includes one of the files' target.
cmake_minimum_required(VERSION 3.22)

string(REPLACE "," ";" HEADERS "${HEADERS}")
set(failed "")
foreach(header IN LISTS HEADERS)
    file(STRINGS "${ROOT}/${header}" lines REGEX "^[ \t]*#[ \t]*include")
    foreach(line IN LISTS lines)
        string(REGEX REPLACE "^[ \t]*#[ \t]*include[ \t]*" "" included "${line}")
        if(included MATCHES "^<opensubdiv/[A-Za-z/]+\\.h>$" OR included MATCHES "^<[a-z_]+>$")
            continue()
        endif()
        if(included MATCHES "^\"(.+)\"$" AND CMAKE_MATCH_1 IN_LIST HEADERS)
            if(NOT CMAKE_MATCH_1 MATCHES "^osd_shading/io/" OR header MATCHES "^osd_shading/io/")
                continue()
            endif()
        endif()
        string(APPEND failed "${header}: ${line}\n")
    endforeach()
endforeach()
if(failed)
    message(FATAL_ERROR "${failed}")
endif()
