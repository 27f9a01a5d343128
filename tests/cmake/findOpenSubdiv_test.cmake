# SPDX-License-Identifier: Apache-2.0
#
# One case of the find module's tests: lays out a prefix with spaces in its path, configures (and builds, and runs)
# the consumer project against it, and looks for what the case expects.
cmake_minimum_required(VERSION 3.22)
include(CMakePackageConfigHelpers)

set(here "${CMAKE_CURRENT_LIST_DIR}")
set(prefix "${WORK}/a prefix")
set(settings "")
set(expected "")        # what the consumer prints as the source
set(expectedError "")   # or the words of the error
file(REMOVE_RECURSE "${WORK}")
file(MAKE_DIRECTORY "${prefix}/lib" "${prefix}/include")
get_filename_component(libraryFile "${LIBRARY}" NAME)

# A config package in the prefix, from configs/`name`.cmake.in.
function(config_package name)
    write_basic_package_version_file("${prefix}/lib/cmake/OpenSubdiv/OpenSubdivConfigVersion.cmake"
                                     VERSION "${VERSION}" COMPATIBILITY SameMajorVersion ARCH_INDEPENDENT)
    configure_file("${here}/configs/${name}.cmake.in" "${prefix}/lib/cmake/OpenSubdiv/OpenSubdivConfig.cmake" @ONLY)
endfunction()

# The installed headers and library, seen below the prefix.
function(header_and_library)
    file(CREATE_LINK "${INCLUDE_DIR}/opensubdiv" "${prefix}/include/opensubdiv" SYMBOLIC)
    file(CREATE_LINK "${LIBRARY}" "${prefix}/lib/${libraryFile}" SYMBOLIC)
endfunction()

if(CASE STREQUAL "existingTarget")
    set(settings -DEXISTING_TARGET=OpenSubdiv::osdCPU "-DINCLUDE_DIR=${INCLUDE_DIR}" "-DLIBRARY=${LIBRARY}")
    set(expected "the target OpenSubdiv::osdCPU")
elseif(CASE STREQUAL "builtAlong")
    # As FetchContent of OpenSubdiv's sources leaves it: a target of this build that names no include folder.
    set(sources "${prefix}/OpenSubdiv/opensubdiv")
    file(MAKE_DIRECTORY "${sources}")
    file(GLOB headers "${INCLUDE_DIR}/opensubdiv/*")
    foreach(header IN LISTS headers)
        get_filename_component(name "${header}" NAME)
        file(CREATE_LINK "${header}" "${sources}/${name}" SYMBOLIC)
    endforeach()
    file(WRITE "${sources}/empty.cpp" "")
    file(WRITE "${sources}/CMakeLists.txt" "add_library(osd_static_cpu STATIC empty.cpp)\n"
                                           "target_link_libraries(osd_static_cpu INTERFACE \"${LIBRARY}\")\n")
    set(settings "-DBUILT_ALONG=${sources}")
    set(expected "the target osd_static_cpu")
elseif(CASE MATCHES "^(upstream|vcpkg|conan|conanStatic)$")
    config_package(${CASE})
    header_and_library()
    set(settings "-DCMAKE_PREFIX_PATH=${prefix}")
    set(expected "the config package in ${prefix}/lib/cmake/OpenSubdiv")
elseif(CASE MATCHES "^(aborting|dangling|dependency|gpuOnly)$")
    config_package(${CASE})
    header_and_library()
    set(settings "-DOpenSubdiv_ROOT=${prefix}")
    set(expected "${prefix}/lib/${libraryFile}")
elseif(CASE STREQUAL "older")
    file(WRITE "${prefix}/include/opensubdiv/far/topologyRefiner.h" "")
    file(WRITE "${prefix}/include/opensubdiv/version.h" "#define OPENSUBDIV_VERSION v3_4_4\n")
    file(CREATE_LINK "${LIBRARY}" "${prefix}/lib/${libraryFile}" SYMBOLIC)
    set(settings "-DOpenSubdiv_ROOT=${prefix}")
    set(expectedError "3\\.4\\.4" "at least \"3\\.5\"")
elseif(CASE STREQUAL "nothing")
    set(settings -DCMAKE_FIND_USE_CMAKE_SYSTEM_PATH=OFF -DCMAKE_FIND_USE_SYSTEM_ENVIRONMENT_PATH=OFF)
    set(expectedError "libosd-dev" "vcpkg" "conan" "Homebrew" "OpenSubdiv_ROOT")
else()
    message(FATAL_ERROR "no case '${CASE}'")
endif()

# Nothing from the tester's own settings may lead elsewhere.
foreach(variable CMAKE_PREFIX_PATH OpenSubdiv_ROOT OpenSubdiv_DIR OPENSUBDIV_ROOT)
    unset(ENV{${variable}})
endforeach()
execute_process(
    COMMAND "${CMAKE_COMMAND}" -S "${here}/consumer" -B "${WORK}/build" -G "${GENERATOR}" "-DCMAKE_CXX_COMPILER=${COMPILER}"
            "-DCMAKE_MAKE_PROGRAM=${MAKE_PROGRAM}" "-DMODULE_FOLDER=${here}/../../cmake" ${settings}
    RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)

if(expectedError)
    if(status EQUAL 0)
        message(FATAL_ERROR "configured, but should not:\n${output}")
    endif()
    string(REGEX REPLACE "[ \n]+" " " text "${output}")
    foreach(words IN LISTS expectedError)
        if(NOT text MATCHES "${words}")
            message(FATAL_ERROR "the error lacks '${words}':\n${output}")
        endif()
    endforeach()
    return()
endif()

if(NOT status EQUAL 0)
    message(FATAL_ERROR "did not configure:\n${output}")
endif()
string(FIND "${output}" "source: ${expected}\n" where)
if(where EQUAL -1)
    message(FATAL_ERROR "the source is not '${expected}':\n${output}")
endif()
string(FIND "${output}" "version: ${VERSION}\n" where)
if(where EQUAL -1)
    message(FATAL_ERROR "the version is not '${VERSION}':\n${output}")
endif()

execute_process(COMMAND "${CMAKE_COMMAND}" --build "${WORK}/build" RESULT_VARIABLE status OUTPUT_VARIABLE output
                ERROR_VARIABLE output)
if(NOT status EQUAL 0)
    message(FATAL_ERROR "did not build:\n${output}")
endif()
execute_process(COMMAND "${WORK}/build/consumer" RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(NOT status EQUAL 0 OR NOT output STREQUAL "catmark\n")
    message(FATAL_ERROR "the program ended with ${status}:\n${output}")
endif()

# A second configure step finds the same.
execute_process(COMMAND "${CMAKE_COMMAND}" "${WORK}/build" RESULT_VARIABLE status OUTPUT_VARIABLE output
                ERROR_VARIABLE output)
string(FIND "${output}" "source: ${expected}\n" where)
if(NOT status EQUAL 0 OR where EQUAL -1)
    message(FATAL_ERROR "configuring again found something else:\n${output}")
endif()
