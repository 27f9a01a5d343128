// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "movingMesh.h"

namespace perf {

/// Largest differences between a frame and ShadeSubdivision in double.
struct Accuracy {
    double positions = 0;  ///< over the longest side of the bounding box
    /// N_B, times the length of the blend's sum before it is normalised: at least as strict as the goal, whose
    /// factor may be smaller still.
    double blendedNormals = 0;
    double limitNormals = 0;  ///< N_L
};

Accuracy MeasureAccuracy(MovingMesh const& mesh, int level);

}  // namespace perf
