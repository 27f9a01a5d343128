// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "osd_shading/io/model.h"

namespace perf {

/// A part of a fan as CAD meshes are: quads only, creases of sharpness 4 along all its feature edges, corners
/// where three of them meet, extraordinary vertices round a boss and a bolt hole.
osd_shading::io::Model FanDisk();

/// A rocker arm: quads only, smooth, with three holes through it, extraordinary vertices at the junctions of the
/// arm and round the pads on it.
osd_shading::io::Model RockerArm();

/// `model` without its creases, with a random real sharpness of 0 to 5 on one in ten of its edges: as many
/// different neighbourhoods as can be.
osd_shading::io::Model WithRandomSharpness(osd_shading::io::Model model, std::uint32_t seed);

}  // namespace perf
