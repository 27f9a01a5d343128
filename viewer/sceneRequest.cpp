// SPDX-License-Identifier: Apache-2.0
#include "sceneRequest.h"

namespace osd_shading::viewer {

SceneRequest MakeRequest(Settings const& settings, std::shared_ptr<io::Model const> const& model,
                         std::string const& file) {
    SceneRequest request{model,
                         file,
                         settings.mesh.Rules(*model),
                         settings.shading.Resolve(),
                         settings.view.Shows(NormalChoice::Subdivided),
                         settings.deformation,
                         settings.run.precision.value_or(tool::Precision::Float)};
    request.options.execution.numThreads = settings.run.threads.value_or(0);
    request.options.execution.memoryLimit = settings.run.memoryLimit.value_or(0);
    return request;
}

}  // namespace osd_shading::viewer
