// SPDX-License-Identifier: Apache-2.0
#include "commandLine.h"

#include <opensubdiv/version.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <string_view>

#include "tessellationOptions.h"

#define OSD_SHADE_TEXT_(x) #x
#define OSD_SHADE_TEXT(x) OSD_SHADE_TEXT_(x)

namespace osd_shading::tool {

namespace {

char const kVersionText[] =
    "osd_shade " OSD_SHADING_VERSION " (OpenSubdiv " OSD_SHADE_TEXT(OPENSUBDIV_VERSION_MAJOR) "." OSD_SHADE_TEXT(
        OPENSUBDIV_VERSION_MINOR) "." OSD_SHADE_TEXT(OPENSUBDIV_VERSION_PATCH) ")";

// Options whose default depends on others.
struct GivenOptions {
    ShadingChoice shading;
    RunChoice run;
    std::optional<double> tolerance;
    std::optional<int> frames;
    std::optional<DeformationKind> deformation;
    TessellationChoice tessellation;
};

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

void AddCheckOptions(CLI::App& app, CommandLine& line, GivenOptions& given) {
    static constexpr char kGroup[] = "Run";
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

// Numbers with a separator between them, as many as `numbers` has.
template <typename T>
bool ParseList(std::string_view text, char separator, T* numbers, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        std::size_t const end = i + 1 < count ? text.find(separator) : text.size();
        if (end == std::string_view::npos) return false;
        std::optional<T> const number = ParseNumber<T>(text.substr(0, end));
        if (!number) return false;
        numbers[i] = *number;
        text.remove_prefix(i + 1 < count ? end + 1 : end);
    }
    return true;
}

void AddEyeOption(CLI::App& app, CommandLine& line) {
    auto const readEye = [&line](std::string const& text) {
        double numbers[3] = {};
        bool const isRead = ParseList(text, ',', numbers, 3);
        if (!isRead || !std::isfinite(numbers[0]) || !std::isfinite(numbers[1]) || !std::isfinite(numbers[2])) {
            Refuse("--eye", "'" + text + "' is not a point X,Y,Z");
        }
        line.eye = Vec3<double>{numbers[0], numbers[1], numbers[2]};
    };
    app.add_option_function<std::string>(
           "--eye", readEye,
           "screen of 1920 x 1080: where the model is looked at from (default: the front, all of it in view)")
        ->type_name("X,Y,Z")
        ->group(kTessellationGroup);
}

// What triangles of the limit surface do not go with.
void ResolveTessellation(CLI::App const& app, CommandLine& line, GivenOptions const& given) {
    line.tessellation = given.tessellation.Resolve();
    if (line.eye && !line.tessellation) Refuse("--eye", "nothing is tessellated; give --tessellate");
    if (!line.tessellation) return;
    if (line.eye && !given.tessellation.IsScreen()) Refuse("--eye", "goes with --tessellate screen");
    for (char const* option : {"--check", "--frames", "--stats", "--cage"}) {
        if (app.count(option) > 0) Refuse(option, "needs a uniform level, which --tessellate has not");
    }
}

}  // namespace

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
    AddMeshOptions(app, line);
    AddShadingOptions(app, given.shading);
    AddRunOptions(app, given.run, "double");
    AddCheckOptions(app, line, given);
    AddFrameOptions(app, line, given);
    AddTessellationOptions(app, given.tessellation);
    AddEyeOption(app, line);
    try {
        app.parse(argc, argv);
    } catch (CLI::Success const& success) {
        app.exit(success);
        return std::nullopt;
    } catch (CLI::ParseError const& error) {
        throw UsageError(std::string(error.what()) + " (see osd_shade --help)");
    }

    Replace(line.precision, given.run.precision);
    line.memoryLimit = given.run.memoryLimit;
    line.tolerance = given.tolerance.value_or(line.precision == Precision::Double ? 1e-12 : 1e-6);
    line.shading = given.shading.Resolve(given.tessellation.kind ? kDefaultSurfaceLevel : ShadingOptions{}.level);
    line.shading.execution.numThreads = given.run.threads.value_or(0);

    ResolveTessellation(app, line, given);
    if (line.tessellation) line.tessellation->numThreads = line.shading.execution.numThreads;
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
