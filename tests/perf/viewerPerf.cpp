// SPDX-License-Identifier: Apache-2.0

// What the viewer costs without a display: a frame in each shading mode, a change of an option, a frame of a moving
// model. Medians, in milliseconds; a program to run by hand, not a test.

#include <epoxy/gl.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "builtInModels.h"
#include "frameTarget.h"
#include "offscreen.h"
#include "sceneBuilder.h"

namespace osd_shading::viewer {
namespace {

constexpr glm::ivec2 kSize(1280, 800);
constexpr double kFrameGoal = 150, kChangeGoal = 50;
constexpr int kTorusLevel = 4, kTorusRound = 30, kTorusAcross = 17;  // 30 * 17 * 4^4 quads: 261,120 triangles

std::shared_ptr<io::Model const> MakeTorus() {
    auto model = std::make_shared<io::Model>();
    for (int i = 0; i < kTorusRound; ++i) {
        for (int j = 0; j < kTorusAcross; ++j) {
            double const u = 2 * M_PI * i / kTorusRound, v = 2 * M_PI * j / kTorusAcross, r = 2 + std::cos(v);
            model->positions.insert(model->positions.end(), {r * std::cos(u), std::sin(v), -r * std::sin(u)});
            int const next = (i + 1) % kTorusRound, above = (j + 1) % kTorusAcross;
            model->faceSizes.push_back(4);
            model->faceVertices.insert(model->faceVertices.end(),
                                       {i * kTorusAcross + j, next * kTorusAcross + j, next * kTorusAcross + above,
                                        i * kTorusAcross + above});
        }
    }
    return model;
}

template <typename Work>
double MedianMilliseconds(int repetitions, Work const& work) {
    std::vector<double> times;
    for (int i = 0; i < repetitions; ++i) {
        auto const start = std::chrono::steady_clock::now();
        work(i);
        times.push_back(
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    }
    std::nth_element(times.begin(), times.begin() + repetitions / 2, times.end());
    return times[static_cast<std::size_t>(repetitions / 2)];
}

bool DoAll() {
    OffscreenContext const context;
    std::printf("%s, %s; %d x %d pixels; medians in ms\n\n",
                reinterpret_cast<char const*>(glGetString(GL_RENDERER)),
                reinterpret_cast<char const*>(glGetString(GL_VERSION)), kSize.x, kSize.y);
    SceneBuilder builder;
    auto const progress = [](double) { return true; };
    auto const requestFor = [&](std::string const& name, int level) {
        auto const model = std::make_shared<io::Model>(LoadModel(name));
        SceneRequest request{model, name, model->Rules({}), PaperPreset(level), false, {}};
        request.options.execution.numThreads = 0;
        return request;
    };
    bool isWithin = true;
    auto const print = [&](char const* what, double time, double goal) {
        if (goal > 0) isWithin = isWithin && time < goal;
        std::printf("  %-44s %8.1f", what, time);
        if (goal > 0) std::printf("   goal %.0f%s", goal, time < goal ? "" : "   MISSED");
        std::printf("\n");
    };

    SceneRequest const torus{MakeTorus(), "torus", {}, PaperPreset(kTorusLevel), false, {}};
    std::shared_ptr<Scene const> const large = builder.Build(torus, progress);
    std::printf("a frame of a torus, %zu triangles\n", large->topology->triangles.size() / 3);
    Renderer renderer;
    FrameTarget const target(kSize);
    auto const draw = [&](std::shared_ptr<Scene const> const& scene, ViewOptions const& view, float yaw) {
        CameraChoice choice;
        choice.camera.yaw = yaw;
        target.Bind();
        renderer.Draw(scene, CameraFor(choice, *scene, view, kSize), view, FindViewFacts(*scene, view), {}, kSize,
                      1);
        glFinish();
    };
    for (auto const& [name, mode] : kShadingNames) {
        ViewOptions view;
        view.shading = mode;
        draw(large, view, 0);  // compiles
        print(std::string(name).c_str(),
              MedianMilliseconds(15, [&](int i) { draw(large, view, static_cast<float>(i)); }), kFrameGoal);
    }
    ViewOptions split;
    split.split = SplitKind::SideBySide;
    draw(large, split, 0);
    print("highlight, side by side",
          MedianMilliseconds(15, [&](int i) { draw(large, split, static_cast<float>(i)); }), 0);
    split.overlays = kWireframe | kCreases | kCage | kEv;
    draw(large, split, 0);
    print("and with overlays", MedianMilliseconds(15, [&](int i) { draw(large, split, static_cast<float>(i)); }),
          0);

    // An option changes: all that happens until it can be drawn.
    SceneRequest request = requestFor("mug", 4);
    std::shared_ptr<Scene const> const scene = builder.Build(request, progress);
    ViewOptions const shown;
    auto const change = [&] {
        renderer.Prepare(builder.Build(request, progress), shown);
        glFinish();
    };
    std::printf("\na change of mug, level 4, %lld faces\n", static_cast<long long>(scene->report.faces));
    print("exponent",
          MedianMilliseconds(21,
                             [&](int i) {
                                 request.options.weights.exponent = 1 + 0.01 * i;
                                 change();
                             }),
          kChangeGoal);
    print("variant",
          MedianMilliseconds(21,
                             [&](int i) {
                                 request.options.weights.sharpVertices =
                                     i % 2 ? SharpVertexWeight::Zero : SharpVertexWeight::Smooth;
                                 change();
                             }),
          kChangeGoal);
    print("sharpness of an edge",
          MedianMilliseconds(21,
                             [&](int i) {
                                 auto edited = std::make_shared<io::Model>(*request.model);
                                 edited->creaseSharpness[0] = 1 + 0.1F * static_cast<float>(i);
                                 request.model = edited;
                                 change();
                             }),
          0);
    request.deformation = {DeformationKind::Bend, 0.1F, 1};
    change();
    print("a frame of its movement (by tables)",
          MedianMilliseconds(21,
                             [&](int i) {
                                 request.deformation.phase = 0.02F * static_cast<float>(i);
                                 change();
                             }),
          kChangeGoal);
    std::printf("\n1 million triangles at 60 frames a second on a GPU: not measured here\n");
    return isWithin;
}

}  // namespace
}  // namespace osd_shading::viewer

int main() {
    try {
        return osd_shading::viewer::DoAll() ? 0 : 1;
    } catch (std::exception const& error) {
        std::fprintf(stderr, "osd_shading_viewer_perf: %s\n", error.what());
        return 2;
    }
}
