// SPDX-License-Identifier: Apache-2.0
#include "methodOptions.h"

#include <cmath>
#include <limits>
#include <string_view>

namespace osd_shading::tool {

namespace {

void RequireUpTo(int level, std::string const& option, std::optional<int> const& start) {
    if (start.value_or(0) > level) {
        Refuse(option, std::to_string(*start) + " lies above the last level, " + std::to_string(level));
    }
}

// Bytes, or units of 1024, its square, cube and fourth power.
std::optional<std::uint64_t> ParseBytes(std::string_view text) {
    int shift = 0;
    if (!text.empty()) {
        std::size_t const unit = std::string_view("KMGTkmgt").find(text.back());
        if (unit != std::string_view::npos) {
            shift = 10 * (static_cast<int>(unit % 4) + 1);
            text.remove_suffix(1);
        }
    }
    std::optional<std::uint64_t> const number = ParseNumber<std::uint64_t>(text);
    if (!number || *number > (std::numeric_limits<std::uint64_t>::max() >> shift)) return std::nullopt;
    return *number << shift;
}

}  // namespace

SubdivisionRules MeshOptions::Rules(io::Model const& model) const {
    SubdivisionRules rules;
    rules.scheme = Scheme();
    rules = model.Rules(rules);
    Replace(rules.boundary, boundary);
    Replace(rules.creasing, creasing);
    Replace(rules.triangles, triangles);
    return rules;
}

void AddMeshOptions(CLI::App& app, MeshOptions& mesh) {
    static constexpr char kGroup[] = "Control mesh";
    AddChoice(app, "--scheme", mesh.scheme, kSchemeNames, "Catmull-Clark (default) or Loop")->group(kGroup);
    app.add_option("--sharpness", mesh.sharpnessFile, "Replace the sharpness of all edges by that of a .sharp file")
        ->type_name("FILE")
        ->group(kGroup);
    AddNumber(
        app, "--crease-angle", mesh.creaseAngle, "an angle from 0 to 180 degrees",
        [](double x) { return x >= 0 && x <= 180; },
        "Make edges infinitely sharp at which the mesh turns by more degrees than this")
        ->group(kGroup);
    AddNumber(
        app, "--crease-scale", mesh.creaseScale, "a finite number, 0 or more",
        [](double x) { return std::isfinite(x) && x >= 0; }, "Multiply finite sharpness of edges, last of all")
        ->group(kGroup);
    AddChoice(app, "--boundary", mesh.boundary, kBoundaryNames,
              "Boundary interpolation (default: the model's tag, else edge-and-corner)")
        ->group(kGroup);
    AddChoice(app, "--creasing", mesh.creasing, kCreasingNames,
              "How sharpness falls (default: the model's tag, else uniform)")
        ->group(kGroup);
    AddChoice(app, "--triangles", mesh.triangles, kTriangleNames,
              "Rule for triangles in Catmull-Clark (default: the model's tag, else catmark)")
        ->group(kGroup);
}

void AddShadingOptions(CLI::App& app, ShadingChoice& given) {
    static constexpr char kGroup[] = "Shading";
    auto const isLevel = [](int x) { return x >= 0 && x <= 15; };
    AddNumber(app, "--level", given.level, "a level from 0 to 15", isLevel, "Steps of subdivision (default 4)")
        ->group(kGroup);
    AddChoice(app, "--preset", given.smoothPreset, kPresetNames,
              "paper: the defaults (variant B); smooth: variant D. Options that are given win over it")
        ->group(kGroup);
    AddChoice(app, "--start-normals", given.startNormals, kStartNormalNames,
              "The normals that are subdivided (default uniform); file: the model's vn")
        ->group(kGroup);
    AddNumber(app, "--normals-from", given.normalsFrom, "a level from 0 to 15", isLevel,
              "Level of the start normals, up to --level (default 1)")
        ->group(kGroup);
    AddChoice(app, "--weights", given.weights, kWeightNames,
              "Where the blend weight is 1 at first (default one-ring)")
        ->group(kGroup);
    AddNumber(app, "--weights-from", given.weightsFrom, "a level from 0 to 15", isLevel,
              "Level from which on there are weights, up to --level (default 1)")
        ->group(kGroup);
    AddChoice(app, "--sharp-vertices", given.sharpVertices, kSharpVertexNames,
              "Weight of sharp vertices: variants B (default), A and C")
        ->group(kGroup);
    AddChoice(app, "--darts", given.darts, kDartNames, "Darts count as smooth (default) or as sharp vertices")
        ->group(kGroup);
    AddNumber(
        app, "--exponent", given.exponent, "a finite number above 0",
        [](double x) { return std::isfinite(x) && x > 0; }, "Exponent of the weight in the blend (default 1)")
        ->group(kGroup);
    AddChoice(app, "--averaging", given.averaging, kAveragingNames, "How normals are averaged (default linear)")
        ->group(kGroup);
    AddNumber(
        app, "--spherical-steps", given.sphericalSteps, "a whole number from 0 to 100",
        [](int x) { return x >= 0 && x <= 100; }, "Steps of the mean on the sphere (default 3)")
        ->group(kGroup);
    AddChoice(app, "--limit-normals", given.limitNormals, kLimitNormalNames,
              "The surface's own normals: from limit tangents (default), or averages over faces")
        ->group(kGroup);
    AddChoice(app, "--positions", given.positions, kPositionNames,
              "Vertices on the limit surface (default), or as refined")
        ->group(kGroup);
}

void AddRunOptions(CLI::App& app, RunChoice& given, std::string const& precisionDefault) {
    static constexpr char kGroup[] = "Run";
    AddChoice(app, "--precision", given.precision, kPrecisionNames,
              "Numbers to compute with (default " + precisionDefault + ")")
        ->group(kGroup);
    AddNumber(
        app, "--threads", given.threads, "a whole number, 0 or more", [](int x) { return x >= 0; },
        "Threads (default 0: as many as the machine has); the result is the same")
        ->group(kGroup);
    auto const readBytes = [&given](std::string const& text) {
        given.memoryLimit = ParseBytes(text);
        if (given.memoryLimit.value_or(0) == 0) {
            Refuse("--memory-limit",
                   "'" + text + "' is not a number of bytes above 0, which K, M, G or T may follow");
        }
    };
    app.add_option_function<std::string>(
           "--memory-limit", readBytes,
           "Refuse what would take more; K, M, G and T count in 1024s (default: three quarters of what is free)")
        ->type_name("BYTES")
        ->group(kGroup);
}

ShadingOptions ShadingChoice::Resolve(int defaultLevel) const {
    int const last = level.value_or(defaultLevel);
    if (last >= 0) {
        RequireUpTo(last, "--normals-from", normalsFrom);
        RequireUpTo(last, "--weights-from", weightsFrom);
    }

    // A level left to the library is at least that of the smooth preset's normals.
    ShadingOptions options = smoothPreset.value_or(false) ? SmoothPreset(last < 0 ? 2 : last) : PaperPreset(last);
    options.level = last;
    Replace(options.startNormals.kind, startNormals);
    Replace(options.startNormals.level, normalsFrom);
    Replace(options.subdividedNormals.averaging, averaging);
    Replace(options.subdividedNormals.sphericalSteps, sphericalSteps);
    Replace(options.weights.scheme, weights);
    Replace(options.weights.sharpVertices, sharpVertices);
    Replace(options.weights.darts, darts);
    Replace(options.weights.level, weightsFrom);
    Replace(options.weights.exponent, exponent);
    Replace(options.limits.positions, positions);
    Replace(options.limits.normals, limitNormals);

    // Normals of a file stand on the control mesh.
    if (options.startNormals.kind == StartNormalKind::User) {
        if (normalsFrom.value_or(0) != 0) {
            Refuse("--normals-from", "must be 0, or left out, where --start-normals is file");
        }
        options.startNormals.level = 0;
    }
    return options;
}

}  // namespace osd_shading::tool
