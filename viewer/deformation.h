// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "optionNames.h"

namespace osd_shading::viewer {

/// Built-in movements of a model, to see its normals while it moves.
enum class DeformationKind { None, Bend, Twist, Wave };

inline constexpr tool::OptionNames<DeformationKind, 4> kDeformationNames = {{{"none", DeformationKind::None},
                                                                             {"bend", DeformationKind::Bend},
                                                                             {"twist", DeformationKind::Twist},
                                                                             {"wave", DeformationKind::Wave}}};

struct Deformation {
    DeformationKind kind = DeformationKind::None;
    float phase = 0;   ///< 0 to 1 is one period; at 0 the model is at rest but for the wave
    float amount = 1;  ///< of the strength that is built in

    bool operator==(Deformation const&) const = default;
};

/// Moves `points`, which lie about the origin.
///
///     bend    the y axis becomes an arc, of up to 60 degrees to either side
///     twist   turned about the y axis, from one end to the other by up to 120 degrees
///     wave    shifted along z by a wave that runs along y
void Deform(Deformation const& deformation, std::vector<glm::vec3>& points);

}  // namespace osd_shading::viewer
