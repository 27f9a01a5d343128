// SPDX-License-Identifier: Apache-2.0

// The program osd_shading_viewer: a window on subdivision shading, and pictures of it without a window.

#include <opensubdiv/far/error.h>
#include <signal.h>

#include <cstdio>
#include <exception>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <vector>

#include "annotations.h"
#include "builtInModels.h"
#include "commandLine.h"
#include "figures.h"
#include "modelInput.h"
#include "offscreen.h"
#include "osd_shading/subdivisionShading.h"
#include "outputTarget.h"
#include "sceneBuilder.h"
#include "window.h"

namespace osd_shading::viewer {

namespace {

constexpr int kSuccess = 0, kFailure = 2;
constexpr glm::ivec2 kDefaultSize(1280, 800);

// One line, whatever the text: scripts read it as such.
void PrintLine(char const* kind, std::string text) {
    for (char& c : text) {
        if (c == '\n' || c == '\r') c = ' ';
    }
    std::fprintf(stderr, "osd_shading_viewer: %s: %s\n", kind, text.c_str());
}

void PrintOpenSubdivWarning(char const* text) { PrintLine("warning", std::string("OpenSubdiv: ") + text); }

int MakeImage(CommandLine const& line) {
    Settings const& settings = line.settings;
    std::string const name = settings.modelFile.empty() ? std::string(kFirstModel) : settings.modelFile;
    auto model = std::make_shared<io::Model>(LoadModel(name));
    tool::ApplyMeshOptions(settings.mesh, *model);
    for (std::string const& warning : model->warnings) PrintLine("warning", warning);

    SceneBuilder builder;
    SceneRequest request{model,
                         name,
                         settings.mesh.Rules(*model),
                         settings.shading.Resolve(),
                         settings.view.Shows(NormalChoice::Subdivided),
                         settings.deformation};
    request.options.execution.numThreads = settings.numThreads;
    std::shared_ptr<Scene const> const scene = builder.Build(request, [](double) { return true; });

    OffscreenContext const context;
    PictureMaker maker(line.scale);
    WritePng(line.imageFile, maker.Make(scene, settings.camera, settings.view, line.size.value_or(kDefaultSize), {},
                                        line.hasHud ? SceneLines(*scene) : std::vector<std::string>()));
    return kSuccess;
}

int Run(std::vector<std::string> const& words) {
    std::optional<CommandLine> const line = ParseCommandLine(words);
    if (!line) return kSuccess;
    Far::SetWarningCallback(PrintOpenSubdivWarning);
    if (!line->imageFile.empty()) return MakeImage(*line);
    if (!line->figuresFolder.empty()) {
        OffscreenContext const context;
        for (std::string const& file : WriteFigures(line->figuresFolder, line->extraModels, line->scale)) {
            std::puts(file.c_str());
        }
        return kSuccess;
    }
    RunWindow(*line);
    return kSuccess;
}

}  // namespace

}  // namespace osd_shading::viewer

int main(int argc, char** argv) {
    using namespace osd_shading::viewer;
    // A pipe that closes is an error of the write, not the end.
    signal(SIGPIPE, SIG_IGN);
    try {
        return Run(std::vector<std::string>(argv + (argc > 0 ? 1 : 0), argv + argc));
    } catch (std::bad_alloc const&) {
        PrintLine("error", "out of memory; a lower --level takes a quarter");
    } catch (std::exception const& error) {
        PrintLine("error", error.what());
    }
    return kFailure;
}
