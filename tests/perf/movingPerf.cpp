// SPDX-License-Identifier: Apache-2.0

// What a frame of a moving mesh costs beside OpenSubdiv's own limit stencils, one process for all; and whether the
// goals are met.

#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "accuracy.h"
#include "callgrindBody.h"
#include "goalReport.h"
#include "goals.h"
#include "mechanicalParts.h"
#include "meshCase.h"
#include "movingMesh.h"
#include "osd_shading/io/objReader.h"
#include "perfMeshes.h"
#include "scaling.h"
#include "shadingFrames.h"

namespace perf {
namespace {

struct Options {
    std::string extraModels = OSD_SHADING_EXTRA_MODELS;
    std::string jsonFile, part, program;
    bool isQuick = false, isLarge = false;
};

std::optional<osd_shading::io::Model> readExtra(Options const& options, char const* name) {
    std::filesystem::path const file = std::filesystem::path(options.extraModels) / "zbk" / name;
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) return std::nullopt;
    return osd_shading::io::ReadObj(file.string());
}

std::vector<MovingMesh> quadMeshes(Options const& options) {
    std::vector<MovingMesh> meshes = {MovingMesh(FanDisk()), MovingMesh(RockerArm())};
    meshes.emplace_back(ReadSpot(options.extraModels));
    if (meshes.back().Model().name != "spot") {
        std::printf("No zbk/spot.obj in '%s': our own %s stands in for it.\n", options.extraModels.c_str(),
                    meshes.back().Model().name.c_str());
    }
    return meshes;
}

std::vector<MovingMesh> triangleMeshes(Options const& options) {
    std::vector<MovingMesh> meshes;
    for (char const* const name : {"hat.obj", "robot.obj"}) {
        if (auto model = readExtra(options, name)) {
            meshes.emplace_back(std::move(*model), Sdc::SCHEME_LOOP);
        } else {
            std::printf("No zbk/%s in '%s'.\n", name, options.extraModels.c_str());
        }
    }
    if (meshes.empty()) {
        std::printf("Our own hat stands in for both.\n");
        meshes.emplace_back(osd_shading::io::ReadObj(std::string(OSD_SHADING_MODELS) + "/hat.obj"),
                            Sdc::SCHEME_LOOP);
    }
    return meshes;
}

void measureCases(std::vector<MovingMesh>& meshes, std::vector<int> const& levels, CaseEffort const& effort,
                  Measurements& measured) {
    for (MovingMesh& mesh : meshes) {
        for (int const level : levels) {
            std::fprintf(stderr, "%s, level %d ..\n", mesh.Model().name.c_str(), level);
            if (auto const figures = MeasureCase(mesh, level, effort)) {
                measured.cases.push_back(*figures);
            } else {
                std::printf("%s level %d is left out: not enough memory.\n", mesh.Model().name.c_str(), level);
            }
        }
    }
}

/// Lets the script count; nothing where it can't.
std::map<std::string, double> countInstructions(Options const& options) {
    std::map<std::string, double> counted;
    std::fprintf(stderr, "instructions ..\n");
    std::string const command = "bash '" OSD_SHADING_PERF_FOLDER "/instructions.sh' '" + options.program + "'";
    auto const close = [](FILE* pipe) { pclose(pipe); };
    std::unique_ptr<FILE, decltype(close)> const pipe(popen(command.c_str(), "r"), close);
    char mesh[64], kind[64];
    double perValue = 0;
    while (pipe && std::fscanf(pipe.get(), "%63s %63s %lf", mesh, kind, &perValue) == 3) {
        counted[std::string(mesh) + " " + kind] = perValue;
    }
    return counted;
}

void measureScaling(Options const& options, Measurements& measured) {
    std::fprintf(stderr, "scaling ..\n");
    constexpr double kMillion = 1e6;
    double const mostValues = options.isQuick ? kMillion : options.isLarge ? 50 * kMillion : 12 * kMillion;
    double const mostForOpenSubdiv = options.isQuick   ? 0.3 * kMillion
                                     : options.isLarge ? 12 * kMillion
                                                       : 3 * kMillion;
    measured.scalingSeries = ScalingSeries(mostValues, mostForOpenSubdiv);
    if (!options.isQuick) measured.scalingByLevel = ScalingByLevel();
}

void measureFrames(Options const& options, Measurements& measured) {
    std::vector<MovingMesh> quads = quadMeshes(options), triangles = triangleMeshes(options);
    CaseEffort effort;
    if (options.isQuick) effort.seconds = 0.6;
    measureCases(quads, options.isQuick ? std::vector<int>{3, 4} : std::vector<int>{2, 3, 4, 5, 6}, effort,
                 measured);
    measureCases(triangles, options.isQuick ? std::vector<int>{4} : std::vector<int>{4, 5, 6}, effort, measured);
    for (MovingMesh const& mesh : quads) {
        measured.accuracy.emplace_back(mesh.Model().name, MeasureAccuracy(mesh, 4));
    }
    MovingMesh const random(WithRandomSharpness(RockerArm(), 1));
    for (int level = 4; level <= (options.isQuick ? 4 : 6); ++level) {
        osd_shading::ShadingTable const table(random.Mesh(), OptionsFor(FrameKind::Shaded, level));
        measured.randomSharpness.push_back(table.Stats());
    }
}

Measurements measure(Options const& options) {
    auto const isWanted = [&](char const* part) { return options.part.empty() || options.part == part; };
    Measurements measured;
    // First, while this process is small: the resident sizes of child processes count.
    if (isWanted("scaling")) measureScaling(options, measured);
    if (isWanted("frames")) measureFrames(options, measured);
    if (isWanted("instructions") && !options.isQuick) measured.instructions = countInstructions(options);
    return measured;
}

char const kUsage[] =
    "usage: osd_shading_moving_perf [EXTRA_MODELS] [--quick] [--large] [--part PART] [--json FILE]\n"
    "       osd_shading_moving_perf --callgrind-body MESH KIND SET   (for instructions.sh)\n"
    "  EXTRA_MODELS  folder with zbk/spot.obj, hat.obj and robot.obj\n"
    "  --quick       less than a minute: levels 3 and 4 only, no scaling beyond a million, no instructions\n"
    "  --large       the scaling series up to 43 million values, OpenSubdiv's up to 11 million\n"
    "  --part        one of scaling, frames, instructions\n"
    "  --json        everything that was measured, seconds per frame\n";

std::optional<Options> parseOptions(std::vector<std::string> const& words) {
    Options options;
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (words[i] == "--quick") {
            options.isQuick = true;
        } else if (words[i] == "--large") {
            options.isLarge = true;
        } else if (words[i] == "--json" && i + 1 < words.size()) {
            options.jsonFile = words[++i];
        } else if (words[i] == "--part" && i + 1 < words.size()) {
            options.part = words[++i];
            if (options.part != "scaling" && options.part != "frames" && options.part != "instructions") {
                return std::nullopt;
            }
        } else if (!words[i].empty() && words[i][0] != '-') {
            options.extraModels = words[i];
        } else {
            return std::nullopt;
        }
    }
    return options;
}

int run(std::string const& program, std::vector<std::string> const& words) {
    if (words.size() == 4 && words[0] == "--callgrind-body") {
        return RunCallgrindBody(words[1], words[2], words[3], OSD_SHADING_EXTRA_MODELS);
    }
    std::optional<Options> options = parseOptions(words);
    if (!options) {
        std::fputs(kUsage, stderr);
        return 2;
    }
    options->program = program;
    Measurements const measured = measure(*options);
    std::vector<GoalRow> const rows = CompareWithGoals(measured);
    PrintCases(measured.cases);
    std::vector<ScalingFigures> scaling = measured.scalingSeries;
    scaling.insert(scaling.end(), measured.scalingByLevel.begin(), measured.scalingByLevel.end());
    PrintScaling(scaling);
    PrintGoals(rows);
    if (!options->jsonFile.empty()) WriteJson(options->jsonFile, measured, rows);
    return 0;
}

}  // namespace
}  // namespace perf

int main(int numArguments, char** arguments) {
    try {
        return perf::run(arguments[0], {arguments + 1, arguments + numArguments});
    } catch (std::exception const& error) {
        std::fprintf(stderr, "osd_shading_moving_perf: %s\n", error.what());
        return 1;
    }
}
