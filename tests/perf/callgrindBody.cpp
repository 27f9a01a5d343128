// SPDX-License-Identifier: Apache-2.0
#include "callgrindBody.h"

#include <cstddef>
#include <cstdio>
#include <functional>
#include <map>
#include <optional>

#include "mechanicalParts.h"
#include "movingMesh.h"
#include "openSubdivFrames.h"
#include "osd_shading/io/objReader.h"
#include "perfMeshes.h"
#include "shadingFrames.h"

namespace perf {

/// All that is counted. Not in an anonymous namespace: callgrind finds it by its name.
[[gnu::noinline]] void CountedFrames(std::function<void()> const& frame, int numFrames) {
    for (int i = 0; i < numFrames; ++i) frame();
}

namespace {

using osd_shading::InstructionSet;

constexpr int kLevel = 4, kNumFrames = 4;
constexpr int kNotThere = 3;

std::optional<osd_shading::io::Model> modelNamed(std::string const& name, std::string const& extraModels) {
    if (name == "fandisk") return FanDisk();
    if (name == "rockerarm") return RockerArm();
    if (name == "spot") {
        osd_shading::io::Model model = ReadSpot(extraModels);
        if (model.name != name) return std::nullopt;
        return model;
    }
    return osd_shading::io::ReadObj(std::string(OSD_SHADING_MODELS) + "/" + name + ".obj");
}

int report(std::size_t numValues) {
    std::printf("%zu %d\n", numValues, kNumFrames);
    return 0;
}

int badWord(char const* what, std::string const& word) {
    std::fprintf(stderr, "osd_shading_moving_perf: there is no %s '%s'\n", what, word.c_str());
    return 2;
}

}  // namespace

int RunCallgrindBody(std::string const& mesh, std::string const& kind, std::string const& instructionSet,
                     std::string const& extraModels) {
    static std::map<std::string, InstructionSet> const kSets = {{"best", InstructionSet::Best},
                                                                {"portable", InstructionSet::Portable},
                                                                {"sse2", InstructionSet::Sse2},
                                                                {"avx2", InstructionSet::Avx2},
                                                                {"avx512", InstructionSet::Avx512}};
    static std::map<std::string, FrameKind> const kKinds = {
        {"shaded", FrameKind::Shaded}, {"limit", FrameKind::LimitNormals}, {"smooth", FrameKind::Smooth}};
    auto const model = modelNamed(mesh, extraModels);
    if (!model) {
        std::fprintf(stderr, "osd_shading_moving_perf: %s is not there\n", mesh.c_str());
        return kNotThere;
    }
    MovingMesh moving(*model);
    if (kind == "openSubdiv") {
        OpenSubdivFrames frames(moving, kLevel);
        CountedFrames([&] { frames.EvaluateLimits(moving.NextPose(), OpenSubdivForm::FusedFour); }, kNumFrames);
        return report(frames.NumVertices());
    }

    auto const frameKind = kKinds.find(kind);
    if (frameKind == kKinds.end()) return badWord("kind of frame", kind);
    auto const set = kSets.find(instructionSet);
    if (set == kSets.end()) return badWord("instruction set", instructionSet);
    if (!osd_shading::IsAvailable(set->second)) {
        std::fprintf(stderr, "osd_shading_moving_perf: no %s here\n", instructionSet.c_str());
        return kNotThere;
    }
    osd_shading::ShadingTable const table(moving.Mesh(), OptionsFor(frameKind->second, kLevel));
    FrameBuffers buffers(static_cast<std::size_t>(table.NumValues()));
    ShadingFrames frames(table, frameKind->second, {1, set->second}, buffers);
    CountedFrames([&] { frames.Evaluate(moving.NextPose()); }, kNumFrames);
    return report(static_cast<std::size_t>(table.NumValues()));
}

}  // namespace perf
