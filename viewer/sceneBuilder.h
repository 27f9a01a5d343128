// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "deformation.h"
#include "osd_shading/io/model.h"
#include "osd_shading/shadingOptions.h"
#include "scene.h"

namespace osd_shading::viewer {

/// All that a scene is computed from.
struct SceneRequest {
    std::shared_ptr<io::Model const> model;
    std::string file;  ///< for messages
    SubdivisionRules rules;
    ShadingOptions options;
    bool allSubdivided = false;  ///< N_S also where the blend does not need it
    Deformation deformation;
};

/// Computes scenes, and keeps between them what does not change.
class SceneBuilder {
public:
    /// `progress` as in ExecutionOptions.
    ///
    /// ERRORS: those of the library, io::ParseError where the file's own normals are incomplete, std::bad_alloc.
    std::shared_ptr<Scene const> Build(SceneRequest const& request, std::function<bool(double)> const& progress);

private:
    // Of the last scene.
    std::shared_ptr<io::Model const> _model;
    SubdivisionRules _rules;
    int _level = -1;
    std::shared_ptr<SurfaceTopology const> _topology;
};

}  // namespace osd_shading::viewer
