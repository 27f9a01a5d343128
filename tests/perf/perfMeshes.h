// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "osd_shading/io/model.h"

namespace perf {

/// A torus of some `around` * `up` quads, a quarter more at a `spacing` of 4, with creases and extraordinary
/// vertices in the same density at any size.
///
/// One quad in `spacing` each way has a smaller one set into it: four vertices of valence 3 inside, four of valence
/// 5 outside.
/// Every 8th ring is creased with sharpness 1.5, 2.5 or 3.5, each second one of them only half way, from dart to
/// dart.
///
/// REQUIRES: `around` and `up` are multiples of 4.
osd_shading::io::Model CreasedTorus(int around, int up, int spacing = 4);

/// The same faces cut into triangles, for Loop.
osd_shading::io::Model Triangulated(osd_shading::io::Model const& model);

/// Spot from the folder `extraModels`; where that has none, our own mug.
osd_shading::io::Model ReadSpot(std::string const& extraModels);

}  // namespace perf
