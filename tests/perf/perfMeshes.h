// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "osd_shading/io/model.h"

namespace perf {

/// A torus of 5/4 * `around` * `up` quads with creases and extraordinary vertices in the same density at any size.
///
/// Every 16th quad has a smaller one set into it: four vertices of valence 3 inside, four of valence 5 outside.
/// Every 8th ring is creased with sharpness 1.5, 2.5 or 3.5, each second one of them only half way, from dart to
/// dart.
///
/// REQUIRES: `around` and `up` are multiples of 4.
osd_shading::io::Model CreasedTorus(int around, int up);

/// The same faces cut into triangles, for Loop.
osd_shading::io::Model Triangulated(osd_shading::io::Model const& model);

/// Spot from the folder `extraModels`; where that has none, our own mug.
osd_shading::io::Model ReadSpot(std::string const& extraModels);

}  // namespace perf
