// SPDX-License-Identifier: Apache-2.0
#include "commandLine.h"

#include <opensubdiv/version.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "outputTarget.h"

#define OSD_SHADE_TEXT_(x) #x
#define OSD_SHADE_TEXT(x) OSD_SHADE_TEXT_(x)

namespace osd_shading::tool {

namespace {

char const kVersionText[] =
    "osd_shade " OSD_SHADING_VERSION " (OpenSubdiv " OSD_SHADE_TEXT(OPENSUBDIV_VERSION_MAJOR) "." OSD_SHADE_TEXT(
        OPENSUBDIV_VERSION_MINOR) "." OSD_SHADE_TEXT(OPENSUBDIV_VERSION_PATCH) ")";

// The options that a preset has an opinion on: what is given wins, so they are kept apart until all are known.
struct GivenOptions {
    std::optional<bool> smoothPreset;
    std::optional<int> level, normalsFrom, weightsFrom, sphericalSteps, threads;
    std::optional<SharpVertexWeight> sharpVertices;
    std::optional<DartWeight> darts;
    std::optional<WeightScheme> weights;
    std::optional<double> exponent, tolerance;
    std::optional<StartNormalKind> startNormals;
    std::optional<NormalAveraging> averaging;
    std::optional<LimitNormalKind> limitNormals;
    std::optional<PositionKind> positions;
    std::optional<Sdc::SchemeType> scheme;
    std::optional<Precision> precision;
    std::optional<int> frames;
    std::optional<DeformationKind> deformation;
};

[[noreturn]] void Refuse(std::string const& option, std::string const& text) {
    throw UsageError(option + ": " + text);
}

// CLI11 would read "010" as eight and "0x10" as sixteen; the program's numbers are decimal.
template <typename T>
std::optional<T> ParseNumber(std::string_view text) {
    if (text.starts_with('+')) {
        text.remove_prefix(1);
        if (text.starts_with('-')) return std::nullopt;
    }
    T number{};
    char const* const end = text.data() + text.size();
    auto const [rest, error] = std::from_chars(text.data(), end, number);
    if (error != std::errc() || rest != end) return std::nullopt;
    return number;
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

/// Adds an option that takes one of `names`.
template <typename T, std::size_t N>
CLI::Option* AddChoice(CLI::App& app, std::string const& option, std::optional<T>& target,
                       OptionNames<T, N> const& names, std::string const& help) {
    std::string words;
    for (auto const& [name, value] : names) words += (words.empty() ? "" : "|") + std::string(name);
    auto const read = [=, &target, &names](std::string const& text) {
        for (auto const& [name, value] : names) {
            if (name == text) {
                target = value;
                return;
            }
        }
        Refuse(option, "'" + text + "' is not one of " + words);
    };
    return app.add_option_function<std::string>(option, read, help)->type_name(words);
}

/// Adds an option that takes a number for which `isAllowed` holds; `words` says which those are.
template <typename T, typename Predicate>
CLI::Option* AddNumber(CLI::App& app, std::string const& option, std::optional<T>& target, std::string const& words,
                       Predicate isAllowed, std::string const& help) {
    auto const read = [=, &target](std::string const& text) {
        target = ParseNumber<T>(text);
        if (!target || !isAllowed(*target)) Refuse(option, "'" + text + "' is not " + words);
    };
    return app.add_option_function<std::string>(option, read, help)->type_name("NUMBER");
}

// Options of files come first in the help, those that few need last.
void AddFileOptions(CLI::App& app, CommandLine& line) {
    app.add_option("MODEL", line.modelFile, "Control mesh: an OBJ file")->required()->type_name("FILE");
    app.add_option("-o", line.outputFile,
                   "Shaded mesh: a file that ends in .ply, .obj or .usda; to a pipe or device without such an "
                   "ending, as /dev/stdout, PLY. Without -o nothing is written")
        ->type_name("FILE");
    app.add_flag("--ascii", line.ascii, "PLY: as text");
    app.add_flag("--cage", line.cage, "USD: the control cage too, as a subdivision mesh");
    app.add_option("--report", line.reportFile, "Write what the table says, and more, as JSON")->type_name("FILE");
    app.add_flag("--quiet", line.quiet, "No table");
}

void AddMeshOptions(CLI::App& app, CommandLine& line, GivenOptions& given) {
    static constexpr char kGroup[] = "Control mesh";
    AddChoice(app, "--scheme", given.scheme, kSchemeNames, "Catmull-Clark (default) or Loop")->group(kGroup);
    app.add_option("--sharpness", line.sharpnessFile, "Replace the sharpness of all edges by that of a .sharp file")
        ->type_name("FILE")
        ->group(kGroup);
    AddNumber(
        app, "--crease-angle", line.creaseAngle, "an angle from 0 to 180 degrees",
        [](double x) { return x >= 0 && x <= 180; },
        "Make edges infinitely sharp at which the mesh turns by more degrees than this")
        ->group(kGroup);
    AddNumber(
        app, "--crease-scale", line.creaseScale, "a finite number, 0 or more",
        [](double x) { return std::isfinite(x) && x >= 0; }, "Multiply finite sharpness of edges, last of all")
        ->group(kGroup);
    AddChoice(app, "--boundary", line.boundary, kBoundaryNames,
              "Boundary interpolation (default: the model's tag, else edge-and-corner)")
        ->group(kGroup);
    AddChoice(app, "--creasing", line.creasing, kCreasingNames,
              "How sharpness falls (default: the model's tag, else uniform)")
        ->group(kGroup);
    AddChoice(app, "--triangles", line.triangles, kTriangleNames,
              "Rule for triangles in Catmull-Clark (default: the model's tag, else catmark)")
        ->group(kGroup);
}

void AddShadingOptions(CLI::App& app, GivenOptions& given) {
    static constexpr char kGroup[] = "Shading";
    static constexpr OptionNames<bool, 2> kPresetNames = {{{"paper", false}, {"smooth", true}}};
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

void AddRunOptions(CLI::App& app, CommandLine& line, GivenOptions& given) {
    static constexpr char kGroup[] = "Run";
    AddChoice(app, "--precision", given.precision, kPrecisionNames, "Numbers to compute with (default double)")
        ->group(kGroup);
    AddNumber(
        app, "--threads", given.threads, "a whole number, 0 or more", [](int x) { return x >= 0; },
        "Threads (default 0: as many as the machine has); the result is the same")
        ->group(kGroup);
    auto const readBytes = [&line](std::string const& text) {
        line.memoryLimit = ParseBytes(text);
        if (line.memoryLimit.value_or(0) == 0) {
            Refuse("--memory-limit",
                   "'" + text + "' is not a number of bytes above 0, which K, M, G or T may follow");
        }
    };
    app.add_option_function<std::string>(
           "--memory-limit", readBytes,
           "Refuse what would take more; K, M, G and T count in 1024s (default: three quarters of what is free)")
        ->type_name("BYTES")
        ->group(kGroup);
    app.add_flag("--check", line.check, "Compare the geometry with OpenSubdiv's own; status 3 when it differs")
        ->group(kGroup);
    AddNumber(
        app, "--tolerance", given.tolerance, "a number, 0 or more",
        [](double x) { return std::isfinite(x) && x >= 0; },
        "Of --check, a share of the model's size (default 1e-12, for float 1e-6)")
        ->group(kGroup);
}

void AddFrameOptions(CLI::App& app, CommandLine& line, GivenOptions& given) {
    static constexpr char kGroup[] = "Moving meshes";
    AddNumber(
        app, "--frames", given.frames, "a whole number from 1 to 1000000",
        [](int x) { return x >= 1 && x <= 1000000; },
        "Build a table too, and time this many frames of the moving model, in float")
        ->group(kGroup);
    AddChoice(app, "--deform", given.deformation, kDeformationNames, "How --frames moves it (default bend)")
        ->group(kGroup);
    app.add_flag("--stats", line.stats, "Build a table too, and say what it holds")->group(kGroup);
}

template <typename T>
void Replace(T& value, std::optional<T> const& given) {
    if (given) value = *given;
}

void RequireUpTo(int level, std::string const& option, std::optional<int> const& start) {
    if (start.value_or(0) > level) {
        Refuse(option, std::to_string(*start) + " lies above the last level, " + std::to_string(level));
    }
}

ShadingOptions ResolveShading(GivenOptions const& given) {
    int const level = given.level.value_or(ShadingOptions{}.level);
    RequireUpTo(level, "--normals-from", given.normalsFrom);
    RequireUpTo(level, "--weights-from", given.weightsFrom);

    ShadingOptions options = given.smoothPreset.value_or(false) ? SmoothPreset(level) : PaperPreset(level);
    Replace(options.startNormals.kind, given.startNormals);
    Replace(options.startNormals.level, given.normalsFrom);
    Replace(options.subdividedNormals.averaging, given.averaging);
    Replace(options.subdividedNormals.sphericalSteps, given.sphericalSteps);
    Replace(options.weights.scheme, given.weights);
    Replace(options.weights.sharpVertices, given.sharpVertices);
    Replace(options.weights.darts, given.darts);
    Replace(options.weights.level, given.weightsFrom);
    Replace(options.weights.exponent, given.exponent);
    Replace(options.limits.positions, given.positions);
    Replace(options.limits.normals, given.limitNormals);
    options.execution.numThreads = given.threads.value_or(0);

    // Normals of a file stand on the control mesh.
    if (options.startNormals.kind == StartNormalKind::User) {
        if (given.normalsFrom.value_or(0) != 0) {
            Refuse("--normals-from", "must be 0, or left out, where --start-normals is file");
        }
        options.startNormals.level = 0;
    }
    return options;
}

}  // namespace

SubdivisionRules CommandLine::Rules(io::Model const& model) const {
    SubdivisionRules rules;
    rules.scheme = scheme;
    rules = model.Rules(rules);
    Replace(rules.boundary, boundary);
    Replace(rules.creasing, creasing);
    Replace(rules.triangles, triangles);
    return rules;
}

std::optional<CommandLine> ParseCommandLine(int argc, char const* const* argv) {
    CLI::App app("Shades a subdivision surface with semi-sharp creases.", "osd_shade");
    app.set_help_flag("--help,-h", "Print this and exit");
    app.set_version_flag("--version", kVersionText, "Print the version and exit");
    app.footer(
        "Exit status: 0, 2 (bad usage or input, or output that can't be written) or 3 (--check failed).\n"
        "The table goes to stderr when the result goes to stdout.");
    app.get_formatter()->column_width(40);

    CommandLine line;
    GivenOptions given;
    AddFileOptions(app, line);
    AddMeshOptions(app, line, given);
    AddShadingOptions(app, given);
    AddRunOptions(app, line, given);
    AddFrameOptions(app, line, given);
    try {
        app.parse(argc, argv);
    } catch (CLI::Success const& success) {
        app.exit(success);
        return std::nullopt;
    } catch (CLI::ParseError const& error) {
        throw UsageError(std::string(error.what()) + " (see osd_shade --help)");
    }

    Replace(line.scheme, given.scheme);
    Replace(line.precision, given.precision);
    line.tolerance = given.tolerance.value_or(line.precision == Precision::Double ? 1e-12 : 1e-6);
    line.shading = ResolveShading(given);

    Replace(line.numFrames, given.frames);
    Replace(line.deformation, given.deformation);
    if (given.deformation && !given.frames) Refuse("--deform", "there are no frames; give --frames their number");
    if ((line.stats || given.frames) && line.shading.subdividedNormals.averaging != NormalAveraging::Linear) {
        Refuse("--averaging", "tables, which --frames and --stats build, hold linear averaging only");
    }

    if (app.count("-o") > 0) {
        line.format = FormatOf(line.outputFile);
        if (line.format == OutputFormat::None) {
            Refuse("-o", "'" + line.outputFile + "' does not end in .ply, .obj or .usda");
        }
    }
    if (line.ascii && line.format != OutputFormat::Ply) Refuse("--ascii", "only PLY output has a text form");
    if (line.cage && line.format != OutputFormat::Usda) Refuse("--cage", "only USD output can hold the cage");
    if (line.modelFile.empty()) Refuse("MODEL", "the name is empty");
    for (char const* option : {"--sharpness", "--report"}) {
        if (app.count(option) > 0 && app[option]->as<std::string>().empty()) Refuse(option, "the name is empty");
    }
    if (IsSameFile(line.outputFile, line.modelFile)) Refuse("-o", "would replace the model");
    if (IsSameFile(line.reportFile, line.modelFile)) Refuse("--report", "would replace the model");
    if (IsSameFile(line.outputFile, line.sharpnessFile)) Refuse("-o", "would replace the file of --sharpness");
    if (IsSameFile(line.reportFile, line.sharpnessFile)) {
        Refuse("--report", "would replace the file of --sharpness");
    }
    if (IsSameFile(line.reportFile, line.outputFile)) Refuse("--report", "names the same file as -o");
    return line;
}

}  // namespace osd_shading::tool
