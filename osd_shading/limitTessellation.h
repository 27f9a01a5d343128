// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>

#include "osd_shading/export.h"
#include "osd_shading/limitSurface.h"
#include "osd_shading/shadingResult.h"

namespace osd_shading {
inline namespace v1 {

/// What decides into how many segments an edge of a control face is cut.
enum class TessellationKind {
    Uniform,    ///< the same number for all (default)
    Curvature,  ///< how far the surface turns
    Screen      ///< how long the edge is on the screen
};

/// How finely a limit surface is cut into triangles.
struct TessellationOptions {
    TessellationKind kind = TessellationKind::Uniform;  ///< what decides
    int rate = 8;                                       ///< Uniform: segments of each edge, 1 to 1024
    double maxAngle = 10;  ///< Curvature: degrees between normals, or directions, of neighbouring points; above 0
    double maxPixels = 8;  ///< Screen: length of a segment, above 0
    int maxRate = 64;      ///< Curvature and Screen: segments of an edge at most, 1 to 1024
    int numThreads = 1;    ///< 1 or more; 0: as many as the machine has. The result is the same

    /// Screen: from model to clip coordinates, column by column as OpenGL has it, and the screen in pixels.
    std::array<double, 16> viewProjection{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    int width = 1920;   ///< of the screen, in pixels
    int height = 1080;  ///< of the screen, in pixels

    std::function<bool(double)> progress;  ///< as in ExecutionOptions. Default: none
};

/// Cuts a limit surface into triangles: adaptive, and watertight, as both faces at an edge take its points from it.
///
/// Control faces are cut as Bfr::Tessellation does, with a rate for each edge. Of the result, positions, normals,
/// weights, faces, values, tags, crease edges and counts are set; there is one value for each side of a crease, as
/// in ShadeSubdivision, and values of a vertex whose normals agree (to 1e-6, in float 1e-4) are one. Vertices of
/// the control mesh come first and keep their numbers; they have its tags, and points of its edges those of its
/// creases.
///
/// ERRORS: InvalidOptions, Cancelled, MemoryLimitExceeded (by the surface's `execution.memoryLimit`); nothing else
/// but std::bad_alloc. COST: that of evaluating each point, once for each face at it.   [Bfr::Tessellation]
template <typename Real>
ShadingResult<Real> TessellateLimitSurface(LimitSurface<Real> const& surface, TessellationOptions const& options);

#define OSD_SHADING_DECLARE(Real)                                                                         \
    extern template OSD_SHADING_API ShadingResult<Real> TessellateLimitSurface(LimitSurface<Real> const&, \
                                                                               TessellationOptions const&);
OSD_SHADING_DECLARE(float)
OSD_SHADING_DECLARE(double)
#undef OSD_SHADING_DECLARE

}  // namespace v1
}  // namespace osd_shading
