# SPDX-License-Identifier: Apache-2.0
#
# Runs PROGRAM; what it prints must be the text in EXPECTED, its exit status 0.
cmake_minimum_required(VERSION 3.22)

execute_process(COMMAND "${PROGRAM}" RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE errors)
if(NOT status EQUAL 0 OR errors)
    message(FATAL_ERROR "ended with ${status}:\n${output}${errors}")
endif()

file(READ "${EXPECTED}" expected)
string(REPLACE "\r" "" output "${output}")
string(REPLACE "\r" "" expected "${expected}")
if(NOT output STREQUAL expected)
    message(FATAL_ERROR "printed\n${output}\nand not\n${expected}")
endif()
