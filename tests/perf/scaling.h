// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace perf {

/// What a mesh of a series costs, measured in a process of its own. Seconds per frame; 0: not measured.
struct ScalingFigures {
    int level = 0;
    double values = 0;
    double openSubdiv = 0;  ///< the fastest form, P, du and dv
    double limitNormals = 0;
    double shaded = 0;
    double shadedTwoThreads = 0;  ///< wall time
    double tableBytes = 0;        ///< per value
    double otherBytes = 0;        ///< per value: largest resident size less the outputs and what was there before
};

/// Control meshes, tori with creases and extraordinary vertices of a fixed density, that grow to `mostValues` at
/// level 4, OpenSubdiv up to `mostForOpenSubdiv`.
std::vector<ScalingFigures> ScalingSeries(double mostValues, double mostForOpenSubdiv);

/// Of that series the mesh of 2.7 million values at level 4, and the same at level 6: 43 million.
std::vector<ScalingFigures> ScalingByLevel();

}  // namespace perf
