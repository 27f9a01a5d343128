// SPDX-License-Identifier: Apache-2.0
#include "imageMaker.h"

#include <memory>
#include <vector>

#include "annotations.h"
#include "builtInModels.h"
#include "modelInput.h"

namespace osd_shading::viewer {

namespace {

constexpr glm::ivec2 kDefaultSize(1280, 800);

}  // namespace

Image ImageMaker::Make(CommandLine const& line, std::function<void(std::string const&)> const& warn) {
    Settings const& settings = line.settings;
    std::string const name = settings.modelFile.empty() ? std::string(kFirstModel) : settings.modelFile;
    auto const model = std::make_shared<io::Model>(LoadModel(name));
    tool::ApplyMeshOptions(settings.mesh, *model);
    for (std::string const& warning : model->warnings) warn(warning);
    glm::ivec2 const size = line.size.value_or(kDefaultSize);
    std::shared_ptr<Scene const> const scene = _builder.Build(
        MakeRequest(settings, model, name, ViewportsOf(settings.view, size)[0].size), [](double) { return true; });

    // Only now: what is wrong with the model is said where there is no driver too.
    if (!_context) _context.emplace();
    return _makers.try_emplace(line.scale, line.scale)
        .first->second.Make(scene, settings.camera, settings.view, size, {},
                            line.hasHud ? SceneLines(*scene) : std::vector<std::string>());
}

}  // namespace osd_shading::viewer
