# SPDX-License-Identifier: Apache-2.0
#
# Compiles a file for each public header that includes it first and twice, as C++17, warnings as errors. OpenSubdiv's
# headers are not ours to warn about.
cmake_minimum_required(VERSION 3.22)

string(REPLACE "," ";" HEADERS "${HEADERS}")
file(REMOVE_RECURSE "${WORK}")
set(failed "")
# A folder that the compiler searches anyway is given none: it would come too early for the standard library.
set(system "")
if(OPENSUBDIV)
    set(system -isystem "${OPENSUBDIV}")
endif()
foreach(header IN LISTS HEADERS)
    string(MAKE_C_IDENTIFIER "${header}" name)
    file(WRITE "${WORK}/${name}.cpp" "#include <${header}>\n#include <${header}>\n")
    execute_process(COMMAND "${COMPILER}" -std=c++17 -fsyntax-only -Wall -Wextra -Wconversion -Wshadow -Werror
                            "-I${ROOT}" ${system} "${WORK}/${name}.cpp"
                    RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
    if(NOT status EQUAL 0)
        string(APPEND failed "${header}:\n${output}\n")
    endif()
endforeach()
if(failed)
    message(FATAL_ERROR "${failed}")
endif()
