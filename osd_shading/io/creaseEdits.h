// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osd_shading/export.h"
#include "osd_shading/io/model.h"

namespace osd_shading {
inline namespace v1 {
namespace io {

/// Makes every edge infinitely sharp at which the surface turns by more than `degrees`: the angle between the
/// normals of its two faces, 0 where they lie in one plane, 90 at the edges of a cube.
///
/// Adds crease entries; those there stay. 1e-6 degrees more do not count as more, so
/// that rounding does not decide about a right angle. Edges of one face, of more than two (OpenSubdiv makes both
/// infinitely sharp anyway) and of faces without area are left alone. The normal of a face that is not flat is
/// that of its projected area; faces wound in opposite directions are compared as if they were not.
///
/// ERRORS: InvalidOptions unless `degrees` is in [0, 180].     COST: a sort of the faces' edges.
OSD_SHADING_API void AddCreasesByAngle(Model& model, double degrees);

/// Multiplies the finite sharpness of edges, that below 10, by `factor`; infinite sharpness stays, and what
/// reaches 10 is infinite. The sharpness of vertices stays: the option that calls this is named for creases.
///
/// ERRORS: InvalidOptions unless `factor` is finite and 0 or more.
OSD_SHADING_API void ScaleCreases(Model& model, double factor);

}  // namespace io
}  // namespace v1
}  // namespace osd_shading
