// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "renderer.h"

struct ImDrawList;

namespace osd_shading::viewer {

/// Writes what a picture needs to be read: which normals are where, colour scales, caption; `lines`, where there
/// are some, stand above left.
void Annotate(ImDrawList& list, ViewOptions const& view, ViewFacts const& facts, glm::ivec2 size, float scale,
              std::vector<std::string> const& lines);

/// The words for `choice`, as the paper has them.
std::string NormalLabel(NormalChoice choice);

/// What the head-up display says of a scene: counts, extraordinary vertices, angles, times.
std::vector<std::string> SceneLines(Scene const& scene);

}  // namespace osd_shading::viewer
