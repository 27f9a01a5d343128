// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>

#include "deformation.h"
#include "optionNames.h"
#include "osd_shading/io/model.h"
#include "osd_shading/shadingOptions.h"
#include "settings.h"

namespace osd_shading::viewer {

/// All that a scene is computed from.
struct SceneRequest {
    std::shared_ptr<io::Model const> model;
    std::string file;  ///< for messages
    SubdivisionRules rules;
    ShadingOptions options;
    bool allSubdivided = false;  ///< N_S also where the blend does not need it
    Deformation deformation;
    std::optional<TessellationOptions> tessellation =
        std::nullopt;                                    ///< triangles of the limit surface in place of a level
    CameraChoice camera{};                               ///< looks at them, on a screen of `tessellation`'s size
    tool::Precision precision = tool::Precision::Float;  ///< computed in; shown in float
};

/// What `settings` ask for, of `model`, which was read from `file`, on a screen of `size` pixels.
///
/// ERRORS: UsageError where options contradict each other.
SceneRequest MakeRequest(Settings const& settings, std::shared_ptr<io::Model const> const& model,
                         std::string const& file, glm::ivec2 size);

}  // namespace osd_shading::viewer
