# SPDX-License-Identifier: Apache-2.0
#
# `cmake --install`: headers, libraries, CMake package with our find module, pkg-config file.
include(CMakePackageConfigHelpers)

set(packageFolder "${CMAKE_INSTALL_LIBDIR}/cmake/osd_shading")
set(installed osd_shading osd_shading_io)
install(TARGETS ${installed} EXPORT osd_shadingTargets
        LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}"
        ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}"
        RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}")
foreach(program IN ITEMS osd_shade osd_shading_viewer)
    if(TARGET ${program})
        install(TARGETS ${program} RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}")
    endif()
endforeach()
foreach(target IN LISTS installed)
    get_target_property(headers ${target} OSD_SHADING_PUBLIC_HEADERS)
    get_target_property(folder ${target} SOURCE_DIR)
    file(RELATIVE_PATH subfolder "${PROJECT_SOURCE_DIR}" "${folder}")
    list(TRANSFORM headers PREPEND "${folder}/")
    install(FILES ${headers} DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/${subfolder}")
endforeach()

install(EXPORT osd_shadingTargets NAMESPACE osd_shading:: DESTINATION "${packageFolder}")
# A static library leaves it to its users to link what it needs.
set(configDependencies "")
if(OSD_SHADING_WITH_TBB AND NOT BUILD_SHARED_LIBS)
    set(configDependencies "find_dependency(TBB 2021 CONFIG)\n")
endif()
configure_package_config_file("${PROJECT_SOURCE_DIR}/cmake/osd_shadingConfig.cmake.in"
                              "${PROJECT_BINARY_DIR}/osd_shadingConfig.cmake"
                              INSTALL_DESTINATION "${packageFolder}")
# Before 1.0 a minor version may change the interface.
write_basic_package_version_file("${PROJECT_BINARY_DIR}/osd_shadingConfigVersion.cmake"
                                 VERSION "${PROJECT_VERSION}" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/osd_shadingConfig.cmake" "${PROJECT_BINARY_DIR}/osd_shadingConfigVersion.cmake"
              "${PROJECT_SOURCE_DIR}/cmake/FindOpenSubdiv.cmake"
        DESTINATION "${packageFolder}")
install(FILES "${PROJECT_SOURCE_DIR}/cmake/probeOpenSubdiv/CMakeLists.txt"
        DESTINATION "${packageFolder}/probeOpenSubdiv")

# The pkg-config file. It finds its prefix itself, so that an installed tree can be moved.
cmake_path(IS_ABSOLUTE CMAKE_INSTALL_LIBDIR isAbsolute)
if(isAbsolute)
    set(pcPrefix "${CMAKE_INSTALL_PREFIX}")
else()
    file(RELATIVE_PATH pcPrefix "/prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig" "/prefix")
    string(PREPEND pcPrefix "\${pcfiledir}/")
endif()
set(pcIncludeFolder "\${prefix}")
cmake_path(APPEND pcIncludeFolder "${CMAKE_INSTALL_INCLUDEDIR}")
set(pcLibraryFolder "\${prefix}")
cmake_path(APPEND pcLibraryFolder "${CMAKE_INSTALL_LIBDIR}")

# OpenSubdiv where it was found; folders that the compiler searches anyway need no flag.
set(pcFlags "")
if(BUILD_SHARED_LIBS)
    set(pcFlags " -DOSD_SHADING_SHARED")
endif()
set(pcLibraries " -losdCPU")
get_target_property(folders osd_shading::OpenSubdiv INTERFACE_INCLUDE_DIRECTORIES)
list(REMOVE_ITEM folders "" ${CMAKE_CXX_IMPLICIT_INCLUDE_DIRECTORIES})
foreach(folder IN LISTS folders)
    string(APPEND pcFlags " -I\"${folder}\"")
endforeach()
get_target_property(linked osd_shading::OpenSubdiv INTERFACE_LINK_LIBRARIES)
foreach(target osd_shading::OpenSubdiv ${linked})
    foreach(property IMPORTED_LOCATION IMPORTED_LOCATION_RELEASE IMPORTED_LOCATION_NONE IMPORTED_LOCATION_DEBUG)
        set(location "")
        if(TARGET ${target})
            get_target_property(location ${target} ${property})
        endif()
        if(location MATCHES "^(.+)/lib([^/]+)\\.(so|a|dylib)[0-9.]*$")
            set(pcLibraries " -l${CMAKE_MATCH_2}")
            if(NOT CMAKE_MATCH_1 IN_LIST CMAKE_CXX_IMPLICIT_LINK_DIRECTORIES)
                string(PREPEND pcLibraries " -L\"${CMAKE_MATCH_1}\"")
            endif()
            break()
        endif()
    endforeach()
endforeach()
if(OSD_SHADING_WITH_TBB AND NOT BUILD_SHARED_LIBS)
    string(APPEND pcLibraries " -ltbb")
endif()
configure_file("${PROJECT_SOURCE_DIR}/cmake/osd_shading.pc.in" "${PROJECT_BINARY_DIR}/osd_shading.pc" @ONLY)
install(FILES "${PROJECT_BINARY_DIR}/osd_shading.pc" DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
