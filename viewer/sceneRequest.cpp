// SPDX-License-Identifier: Apache-2.0
#include "sceneRequest.h"

#include <algorithm>

namespace osd_shading::viewer {

SceneRequest MakeRequest(Settings const& settings, std::shared_ptr<io::Model const> const& model,
                         std::string const& file, glm::ivec2 size) {
    SceneRequest request;
    request.model = model;
    request.file = file;
    request.rules = settings.mesh.Rules(*model);
    request.options = settings.ResolveShading();
    request.allSubdivided = settings.view.Shows(NormalChoice::Subdivided);
    request.deformation = settings.deformation;
    request.tessellation = settings.tessellation.Resolve();
    request.camera = settings.camera;
    request.precision = settings.run.precision.value_or(tool::Precision::Float);
    request.options.execution.numThreads = settings.run.threads.value_or(0);
    request.options.execution.memoryLimit = settings.run.memoryLimit.value_or(0);
    if (request.tessellation) {
        request.tessellation->width = std::max(1, size.x);
        request.tessellation->height = std::max(1, size.y);
        request.tessellation->numThreads = request.options.execution.numThreads;
    }
    return request;
}

}  // namespace osd_shading::viewer
