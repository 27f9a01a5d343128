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
if(TARGET osd_shade)
    install(TARGETS osd_shade RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}")
endif()
foreach(target IN LISTS installed)
    get_target_property(headers ${target} OSD_SHADING_PUBLIC_HEADERS)
    get_target_property(folder ${target} SOURCE_DIR)
    file(RELATIVE_PATH subfolder "${PROJECT_SOURCE_DIR}" "${folder}")
    list(TRANSFORM headers PREPEND "${folder}/")
    install(FILES ${headers} DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/${subfolder}")
endforeach()

install(EXPORT osd_shadingTargets NAMESPACE osd_shading:: DESTINATION "${packageFolder}")
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

set(pkgConfigFlags "$<$<BOOL:${BUILD_SHARED_LIBS}>: -DOSD_SHADING_SHARED>")
file(GENERATE OUTPUT "${PROJECT_BINARY_DIR}/osd_shading.pc" CONTENT
"prefix=${CMAKE_INSTALL_PREFIX}
includedir=${CMAKE_INSTALL_FULL_INCLUDEDIR}
libdir=${CMAKE_INSTALL_FULL_LIBDIR}

Name: osd_shading
Description: ${PROJECT_DESCRIPTION} ${OpenSubdiv_VERSION}
Version: ${PROJECT_VERSION}
Cflags: -I\${includedir}${pkgConfigFlags}
Libs: -L\${libdir} -losd_shading -losdCPU -pthread
")
install(FILES "${PROJECT_BINARY_DIR}/osd_shading.pc" DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
