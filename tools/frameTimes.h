// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "deformation.h"
#include "osd_shading/shadingEvaluator.h"

namespace osd_shading::tool {

/// How long the frames of a moving mesh took.
struct FrameTimes {
    int numFrames = 0;
    DeformationKind deformation = DeformationKind::Bend;
    int numThreads = 1;
    std::string instructionSet;
    double medianSeconds = 0, leastSeconds = 0;  ///< of a frame: P and N_B of every value, interleaved
    FrameReport worst;                           ///< the largest count of each kind over all frames
};

/// Moves `rest` through one period in `numFrames` frames and shades each. The user's normals, if any, stay.
FrameTimes MeasureFrames(ShadingTable const& table, PointView<float> rest, PointView<float> userNormals,
                         DeformationKind deformation, int numFrames, int numThreads);

}  // namespace osd_shading::tool
