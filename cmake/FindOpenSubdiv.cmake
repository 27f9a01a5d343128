# SPDX-License-Identifier: Apache-2.0
#
# FindOpenSubdiv: OpenSubdiv's CPU library, from wherever it comes.
#
#   find_package(OpenSubdiv 3.5 MODULE REQUIRED)
#
# In this order, the first that is usable wins:
#   1. a target that exists already: OpenSubdiv::osdCPU, OpenSubdiv::osdCPU_static (upstream, vcpkg),
#      OpenSubdiv::osdcpu, OpenSubdiv::osdcpu_static (conan), osd_dynamic_cpu, osd_static_cpu (built along)
#   2. a config package that defines one of these. It is tried in a child process first, because some abort the
#      configure step even when they are asked QUIET (Debian's: it names static libraries that it does not ship)
#   3. header and library
#
# Reads: OpenSubdiv_ROOT, OpenSubdiv_DIR, CMAKE_PREFIX_PATH and whatever else find_package reads.
# Gives: osd_shading::OpenSubdiv    imported target: headers and CPU library
#        OpenSubdiv_FOUND, OpenSubdiv_VERSION (of opensubdiv/version.h),
#        OpenSubdiv_SOURCE          in words, where it was found
cmake_policy(PUSH)
cmake_policy(VERSION 3.22...3.28)

set(_osd_names OpenSubdiv::osdCPU OpenSubdiv::osdCPU_static OpenSubdiv::osdcpu OpenSubdiv::osdcpu_static
               osd_dynamic_cpu osd_static_cpu)

# Sets `result` to the folder above opensubdiv/version.h that belongs to `target`; to nothing if there is none.
function(_osd_include_dir target result)
    # Imported libraries may say it in generator expressions (conan's do): take every absolute path in them.
    set(candidates "")
    foreach(property INTERFACE_INCLUDE_DIRECTORIES INTERFACE_SYSTEM_INCLUDE_DIRECTORIES)
        get_target_property(value ${target} ${property})
        if(value)
            string(REGEX MATCHALL "(/|[A-Za-z]:/)[^;<>]+" paths "${value}")
            list(APPEND candidates ${paths})
        endif()
    endforeach()
    list(APPEND candidates ${OpenSubdiv_INCLUDE_DIR} ${OpenSubdiv_INCLUDE_DIRS})

    # Upstream's own configs name no include folder: it is beside the library, or above the source folder.
    get_target_property(isImported ${target} IMPORTED)
    if(isImported)
        foreach(property IMPORTED_LOCATION IMPORTED_LOCATION_RELEASE IMPORTED_LOCATION_RELWITHDEBINFO
                         IMPORTED_LOCATION_MINSIZEREL IMPORTED_LOCATION_DEBUG IMPORTED_LOCATION_NONE)
            get_target_property(location ${target} ${property})
            if(location)
                get_filename_component(folder "${location}" DIRECTORY)
                list(APPEND candidates "${folder}/../include" "${folder}/../../include")
            endif()
        endforeach()
    else()
        get_target_property(folder ${target} SOURCE_DIR)
        list(APPEND candidates "${folder}/.." "${folder}")
    endif()

    foreach(candidate IN LISTS candidates)
        if(EXISTS "${candidate}/opensubdiv/version.h")
            get_filename_component(candidate "${candidate}" ABSOLUTE)
            set(${result} "${candidate}" PARENT_SCOPE)
            return()
        endif()
    endforeach()
    set(${result} "" PARENT_SCOPE)
endfunction()

# Sets `result` to the version that opensubdiv/version.h below `folder` states.
function(_osd_version folder result)
    set(version "")
    if(EXISTS "${folder}/opensubdiv/version.h")
        file(STRINGS "${folder}/opensubdiv/version.h" line REGEX "#define OPENSUBDIV_VERSION +v[0-9_]+" LIMIT_COUNT 1)
        string(REGEX MATCH "[0-9]+_[0-9]+_[0-9]+" version "${line}")
        string(REPLACE "_" "." version "${version}")
    endif()
    set(${result} "${version}" PARENT_SCOPE)
endfunction()

# Loads a config package in a child process. Sets `folder` to its folder if that went well and the libraries that
# it names are there; else `reason` says in words what was wrong, and is empty where there was no package.
function(_osd_probe_config folder reason)
    set(${folder} "" PARENT_SCOPE)
    set(${reason} "" PARENT_SCOPE)
    set(probe "${CMAKE_BINARY_DIR}/CMakeFiles/osd_shading_probe")
    file(MAKE_DIRECTORY "${probe}")
    file(REMOVE "${probe}/result.txt" "${probe}/started.txt")

    # The child must look where this process would: it gets these settings through a file, so that lists survive.
    set(settings "")
    foreach(variable OpenSubdiv_DIR OpenSubdiv_ROOT OPENSUBDIV_ROOT CMAKE_PREFIX_PATH CMAKE_FRAMEWORK_PATH CMAKE_APPBUNDLE_PATH
                     CMAKE_MODULE_PATH CMAKE_FIND_ROOT_PATH CMAKE_FIND_ROOT_PATH_MODE_PACKAGE CMAKE_SYSROOT
                     CMAKE_SYSTEM_PREFIX_PATH CMAKE_IGNORE_PATH CMAKE_IGNORE_PREFIX_PATH CMAKE_BUILD_TYPE
                     CMAKE_FIND_PACKAGE_PREFER_CONFIG CMAKE_FIND_USE_SYSTEM_PACKAGE_REGISTRY
                     CMAKE_FIND_USE_PACKAGE_REGISTRY CMAKE_FIND_USE_CMAKE_SYSTEM_PATH
                     CMAKE_FIND_USE_SYSTEM_ENVIRONMENT_PATH)
        if(DEFINED ${variable} AND NOT "${${variable}}" STREQUAL "")
            string(APPEND settings "set(${variable} [==[${${variable}}]==])\n")
        endif()
    endforeach()
    file(WRITE "${probe}/settings.cmake" "${settings}")

    set(arguments -S "${CMAKE_CURRENT_FUNCTION_LIST_DIR}/probeOpenSubdiv" -B "${probe}" -G "${CMAKE_GENERATOR}"
                  "-DOSD_SHADING_PROBE=${probe}" "-DOSD_SHADING_VERSION=${OpenSubdiv_FIND_VERSION}"
                  "-DCMAKE_MAKE_PROGRAM=${CMAKE_MAKE_PROGRAM}"
                  "-DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER}" --no-warn-unused-cli)
    foreach(variable CMAKE_TOOLCHAIN_FILE CMAKE_OSX_SYSROOT CMAKE_OSX_ARCHITECTURES VCPKG_TARGET_TRIPLET
                     VCPKG_INSTALLED_DIR)
        if(${variable})
            list(APPEND arguments "-D${variable}=${${variable}}")
        endif()
    endforeach()
    if(CMAKE_GENERATOR_PLATFORM)
        list(APPEND arguments -A "${CMAKE_GENERATOR_PLATFORM}")
    endif()
    execute_process(COMMAND "${CMAKE_COMMAND}" ${arguments} RESULT_VARIABLE status OUTPUT_VARIABLE output
                    ERROR_VARIABLE output)
    file(WRITE "${probe}/log.txt" "${output}")

    if(EXISTS "${probe}/result.txt")
        file(READ "${probe}/result.txt" result)
        if(result MATCHES "^folder=([^\n]+)")
            set(${folder} "${CMAKE_MATCH_1}" PARENT_SCOPE)
        elseif(result MATCHES "^reason=([^\n]+)")
            set(${reason} "${CMAKE_MATCH_1}" PARENT_SCOPE)
        endif()
    elseif(EXISTS "${probe}/started.txt")
        set(${reason} "its config package aborts (see ${probe}/log.txt)" PARENT_SCOPE)
    endif()
endfunction()

unset(OpenSubdiv_TARGET)
set(OpenSubdiv_SOURCE "")
set(_osd_reason "")

if(TARGET osd_shading::OpenSubdiv)
    # A second call, from another folder of the same build.
    set(OpenSubdiv_TARGET osd_shading::OpenSubdiv)
    get_target_property(OpenSubdiv_SOURCE osd_shading::OpenSubdiv OSD_SHADING_SOURCE)
endif()

if(NOT OpenSubdiv_TARGET)
    foreach(_osd_name IN LISTS _osd_names)
        if(TARGET ${_osd_name})
            set(OpenSubdiv_TARGET ${_osd_name})
            set(OpenSubdiv_SOURCE "the target ${_osd_name}")
            break()
        endif()
    endforeach()
endif()

if(NOT OpenSubdiv_TARGET)
    _osd_probe_config(_osd_folder _osd_reason)
    if(_osd_folder)
        # Global, so that whoever links this library from another folder sees the package's targets too.
        set(_osd_was_global ${CMAKE_FIND_PACKAGE_TARGETS_GLOBAL})
        set(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL TRUE)
        set(OpenSubdiv_DIR "${_osd_folder}" CACHE PATH "Folder of OpenSubdiv's config package" FORCE)
        find_package(OpenSubdiv CONFIG QUIET NO_DEFAULT_PATH)
        set(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL ${_osd_was_global})
        foreach(_osd_name IN LISTS _osd_names)
            if(TARGET ${_osd_name})
                set(OpenSubdiv_TARGET ${_osd_name})
                set(OpenSubdiv_SOURCE "the config package in ${_osd_folder}")
                if(CMAKE_VERSION VERSION_LESS 3.24)
                    set_property(TARGET ${_osd_name} PROPERTY IMPORTED_GLOBAL TRUE)
                endif()
                break()
            endif()
        endforeach()
    endif()
endif()

if(OpenSubdiv_TARGET)
    _osd_include_dir(${OpenSubdiv_TARGET} _osd_include)
else()
    find_path(OpenSubdiv_INCLUDE_DIR opensubdiv/far/topologyRefiner.h)
    find_library(OpenSubdiv_LIBRARY NAMES osdCPU osdCPU_static)
    mark_as_advanced(OpenSubdiv_INCLUDE_DIR OpenSubdiv_LIBRARY)
    set(_osd_include "${OpenSubdiv_INCLUDE_DIR}")
    if(OpenSubdiv_INCLUDE_DIR AND OpenSubdiv_LIBRARY)
        set(OpenSubdiv_TARGET osd_shading::OpenSubdiv)
        set(OpenSubdiv_SOURCE "${OpenSubdiv_LIBRARY}")
    endif()
endif()
_osd_version("${_osd_include}" OpenSubdiv_VERSION)

set(_osd_help "OpenSubdiv 3.5 or newer is needed. Debian and Ubuntu: libosd-dev. vcpkg and conan: opensubdiv. "
              "Homebrew: opensubdiv. Or set OpenSubdiv_ROOT to the folder above its include and lib.")
if(_osd_reason)
    list(APPEND _osd_help " (Found, but not usable: ${_osd_reason}.)")
endif()
string(CONCAT _osd_help ${_osd_help})
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenSubdiv REQUIRED_VARS OpenSubdiv_TARGET OpenSubdiv_VERSION
                                  VERSION_VAR OpenSubdiv_VERSION REASON_FAILURE_MESSAGE "${_osd_help}")

if(OpenSubdiv_FOUND AND NOT TARGET osd_shading::OpenSubdiv)
    if(OpenSubdiv_TARGET STREQUAL "osd_shading::OpenSubdiv")
        add_library(osd_shading::OpenSubdiv UNKNOWN IMPORTED GLOBAL)
        set_target_properties(osd_shading::OpenSubdiv PROPERTIES IMPORTED_LOCATION "${OpenSubdiv_LIBRARY}")
    else()
        add_library(osd_shading::OpenSubdiv INTERFACE IMPORTED GLOBAL)
        set_target_properties(osd_shading::OpenSubdiv PROPERTIES INTERFACE_LINK_LIBRARIES ${OpenSubdiv_TARGET})
    endif()
    set_target_properties(osd_shading::OpenSubdiv PROPERTIES
        INTERFACE_INCLUDE_DIRECTORIES "${_osd_include}"
        INTERFACE_SYSTEM_INCLUDE_DIRECTORIES "${_osd_include}"
        OSD_SHADING_SOURCE "${OpenSubdiv_SOURCE}")
endif()

unset(_osd_names)
unset(_osd_name)
unset(_osd_reason)
unset(_osd_folder)
unset(_osd_include)
unset(_osd_help)
unset(_osd_was_global)
cmake_policy(POP)
