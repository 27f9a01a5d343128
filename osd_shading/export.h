// SPDX-License-Identifier: Apache-2.0
#pragma once

/// \file
/// Symbol visibility. `OSD_SHADING_SHARED` is set by the CMake target when the library is shared,
/// `OSD_SHADING_BUILDING` only while the library itself is compiled.

#if !defined(OSD_SHADING_SHARED)
#    define OSD_SHADING_API
#elif defined(_WIN32) && defined(OSD_SHADING_BUILDING)
#    define OSD_SHADING_API __declspec(dllexport)
#elif defined(_WIN32)
#    define OSD_SHADING_API __declspec(dllimport)
#else
#    define OSD_SHADING_API __attribute__((visibility("default")))
#endif
