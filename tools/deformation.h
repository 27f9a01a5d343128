// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osd_shading/views.h"

namespace osd_shading::tool {

/// Ways to move a mesh, each with a period of 1.
enum class DeformationKind {
    Bend,   ///< to an arc of up to 90 degrees, to and fro
    Twist,  ///< round the longest axis, up to 180 degrees from end to end, to and fro
    Wave    ///< two waves that travel along the longest axis, a twentieth of its length high
};

/// What a deformation knows of a model at rest: its middle, its longest axis, and the axis that it moves along.
struct DeformationFrame {
    Vec3<double> middle;
    int longAxis = 0, sideAxis = 1;  ///< 0, 1, 2: x, y, z; the shortest is the side
    double length = 1;               ///< of the model along the long axis; 1 where that is 0
};

DeformationFrame FrameOf(PointView<float> rest);

/// Where a point at rest is at `time`. Pure; Bend and Twist are at rest at whole and half times.
Vec3<float> Deformed(DeformationKind kind, DeformationFrame const& frame, Vec3<float> const& rest, double time);

}  // namespace osd_shading::tool
