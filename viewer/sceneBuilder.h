// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "osd_shading/shadingEvaluator.h"
#include "scene.h"
#include "sceneRequest.h"

namespace osd_shading::viewer {

/// Computes scenes, and keeps between them what does not change. A model that moves is evaluated from tables,
/// unless its options are such that there are none (averaging on the sphere or normalising; normals of the file) or
/// it is wanted in double.
class SceneBuilder {
public:
    /// `progress` as in ExecutionOptions.
    ///
    /// ERRORS: those of the library, io::ParseError where the file's own normals are incomplete, std::bad_alloc.
    std::shared_ptr<Scene const> Build(SceneRequest const& request, std::function<bool(double)> const& progress);

private:
    template <typename Real>
    std::shared_ptr<Scene> shade(SceneRequest const& request, PointView<Real> const& points,
                                 std::function<bool(double)> const& progress);
    std::shared_ptr<Scene> evaluate(SceneRequest const& request, std::vector<glm::vec3> const& points,
                                    std::function<bool(double)> const& progress);
    bool keepsTables(SceneRequest const& request) const;

    // Of the last scene that was shaded level by level.
    std::shared_ptr<io::Model const> _model;
    SubdivisionRules _rules;
    int _level = -1;
    std::shared_ptr<SurfaceTopology const> _topology;

    /// What frames of a moving model share.
    struct Tables {
        SceneRequest request;               // without its movement
        std::shared_ptr<Scene const> rest;  // counts and connectivity
        ShadingEvaluator evaluator;
        std::optional<ShadingEvaluator> allSubdivided;  // with weight 1
    };
    std::optional<Tables> _tables;
};

}  // namespace osd_shading::viewer
