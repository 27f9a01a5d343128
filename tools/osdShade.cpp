// SPDX-License-Identifier: Apache-2.0

// The program osd_shade: reads a control mesh, shades it, writes it, and says what it did.

#include <opensubdiv/far/error.h>
#include <signal.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <limits>
#include <new>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "commandLine.h"
#include "frameTimes.h"
#include "memory.h"
#include "modelInput.h"
#include "osd_shading/geometryCheck.h"
#include "osd_shading/io/errors.h"
#include "osd_shading/io/fileReplacement.h"
#include "osd_shading/io/objWriter.h"
#include "osd_shading/io/plyWriter.h"
#include "osd_shading/io/usdWriter.h"
#include "osd_shading/limitTessellation.h"
#include "osd_shading/shadingTable.h"
#include "osd_shading/subdivisionShading.h"
#include "outputTarget.h"
#include "progressBar.h"
#include "report.h"

namespace osd_shading::tool {

namespace {

constexpr int kSuccess = 0;
constexpr int kFailure = 2;
constexpr int kCheckFailed = 3;

// One line, whatever the text: scripts read it as such.
void PrintLine(char const* kind, std::string text) {
    for (char& c : text) {
        if (c == '\n' || c == '\r') c = ' ';
    }
    std::fprintf(stderr, "osd_shade: %s: %s\n", kind, text.c_str());
}

using StageSeconds = std::vector<std::pair<std::string, double>>;

// Appends, when it ends, the time since it was made.
class StageTimer {
public:
    StageTimer(StageSeconds& seconds, char const* stage) : _seconds(seconds), _stage(stage) {}
    ~StageTimer() { _seconds.emplace_back(_stage, std::chrono::duration<double>(Clock::now() - _start).count()); }
    StageTimer(StageTimer const&) = delete;
    StageTimer& operator=(StageTimer const&) = delete;

private:
    using Clock = std::chrono::steady_clock;

    StageSeconds& _seconds;
    char const* _stage;
    Clock::time_point _start = Clock::now();
};

// Runs `work` as the stage `name`, and returns what it returns.
template <typename Work>
auto Timed(StageSeconds& seconds, char const* name, Work const& work) {
    StageTimer const timer(seconds, name);
    return work();
}

// Three quarters: estimates count what is allocated, not what the allocator and the system add.
std::uint64_t MemoryLimit(CommandLine const& line) {
    std::uint64_t const free = FreeMemory();
    return line.memoryLimit.value_or(free - free / 4);
}

template <typename Real>
ShadingResult<Real> Shade(CommandLine const& line, ControlMesh const& mesh, ShadingInput<Real> const& input) {
    ShadingOptions options = line.shading;
    options.execution.memoryLimit = MemoryLimit(line);

    ProgressBar bar(!line.quiet);
    if (bar.IsEnabled()) {
        options.execution.progress = [&bar](double share) {
            bar.Show(share);
            return true;
        };
    }
    try {
        return ShadeSubdivision(mesh, input, options);
    } catch (InvalidControlMesh const& error) {
        throw io::ParseError(line.modelFile, 0, error.what());  // the library knows no files
    }
}

// A view from `eye` towards the middle of the points, or from the front, that shows all of them. Column by column.
std::array<double, 16> ViewProjection(std::vector<double> const& positions, std::optional<Vec3<double>> const& eye,
                                      double aspect) {
    Vec3<double> low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
    for (std::size_t i = 0; i + 2 < positions.size(); i += 3) {
        low = {std::min(low.x, positions[i]), std::min(low.y, positions[i + 1]), std::min(low.z, positions[i + 2])};
        high = {std::max(high.x, positions[i]), std::max(high.y, positions[i + 1]),
                std::max(high.z, positions[i + 2])};
    }
    Vec3<double> const middle{(low.x + high.x) / 2, (low.y + high.y) / 2, (low.z + high.z) / 2};
    double const radius = std::max(std::hypot(high.x - low.x, high.y - low.y, high.z - low.z) / 2,
                                   std::numeric_limits<double>::min());
    constexpr double kHalfView = 0.35;  // radians
    double const distance = radius / std::sin(kHalfView);
    Vec3<double> const from = eye.value_or(Vec3<double>{middle.x, middle.y, middle.z + distance});

    // Axes of the view; looked at from where the middle is, any will do.
    auto const unit = [](Vec3<double> const& v, Vec3<double> const& other) {
        double const length = std::hypot(v.x, v.y, v.z);
        return length > 0 ? Vec3<double>{v.x / length, v.y / length, v.z / length} : other;
    };
    auto const cross = [](Vec3<double> const& a, Vec3<double> const& b) {
        return Vec3<double>{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    };
    Vec3<double> const back = unit({from.x - middle.x, from.y - middle.y, from.z - middle.z}, {0, 0, 1});
    Vec3<double> const right = unit(cross({0, 1, 0}, back), {1, 0, 0}), up = cross(back, right);
    double const scale = 1 / std::tan(kHalfView);
    auto const dot = [](Vec3<double> const& a, Vec3<double> const& b) { return a.x * b.x + a.y * b.y + a.z * b.z; };
    double const x = scale / aspect, y = scale;
    return {x * right.x,           y * up.x,           -back.x,         -back.x,
            x * right.y,           y * up.y,           -back.y,         -back.y,
            x * right.z,           y * up.z,           -back.z,         -back.z,
            -x * dot(right, from), -y * dot(up, from), dot(back, from), dot(back, from)};
}

// Triangles of the limit surface in place of a uniform level.
template <typename Real>
ShadingResult<Real> Tessellate(CommandLine const& line, io::Model const& model, ControlMesh const& mesh,
                               ShadingInput<Real> const& input, StageSeconds& seconds) {
    ShadingOptions options = line.shading;
    options.execution.memoryLimit = MemoryLimit(line);
    TessellationOptions tessellation = *line.tessellation;
    if (tessellation.kind == TessellationKind::Screen) {
        double const aspect = static_cast<double>(tessellation.width) / tessellation.height;
        tessellation.viewProjection = ViewProjection(model.positions, line.eye, aspect);
    }
    return Timed(seconds, "tessellation", [&] {
        try {
            return TessellateLimitSurface(LimitSurface<Real>(mesh, input, options), tessellation);
        } catch (InvalidControlMesh const& error) {
            throw io::ParseError(line.modelFile, 0, error.what());
        }
    });
}

// Builds a table of the same mesh, and times frames where they are wanted.
void RunFrames(CommandLine const& line, io::Model const& model, ControlMesh const& mesh, RunSummary& run) {
    RunInput<float> const input = MakeInput<float>(line.modelFile, model, line.shading.startNormals.kind);
    ShadingOptions options = line.shading;
    options.execution.memoryLimit = MemoryLimit(line);
    ShadingTable const table = Timed(run.seconds, "table", [&] { return ShadingTable(mesh, options); });
    run.table = table.Stats();
    if (line.numFrames == 0) return;
    run.frames = Timed(run.seconds, "frames", [&] {
        return MeasureFrames(table, input.input.positions, input.input.faceVaryingNormals, line.deformation,
                             line.numFrames, line.shading.execution.numThreads);
    });
}

template <typename Real>
void WriteResult(CommandLine const& line, io::Model const& model, ControlMesh const& mesh,
                 ShadingResult<Real> const& result) {
    DeferredSignals const deferred(line.outputFile);
    switch (line.format) {
        case OutputFormat::None:
            break;
        case OutputFormat::Ply:
            io::WritePly(line.outputFile, result, {line.ascii ? io::PlyFormat::Ascii : io::PlyFormat::Binary});
            break;
        case OutputFormat::Obj:
            io::WriteObj(line.outputFile, result);
            break;
        case OutputFormat::Usda: {
            io::UsdOptions options;
            if (line.cage) {
                options.cage = &mesh;
                options.cagePositions = {model.positions.data(), model.positions.size() / 3};
                if (!model.uvIndices.empty()) {
                    options.cageUvs = {model.uvIndices, {model.uvs.data(), model.uvs.size() / 2, 2}};
                }
            }
            io::WriteUsd(line.outputFile, result, options);
            break;
        }
    }
}

void WriteReport(CommandLine const& line, RunSummary const& run) {
    DeferredSignals const deferred(line.reportFile);
    std::string const text = JsonText(line, run);
    io::FileReplacement file(line.reportFile);
    file.Write(text.data(), text.size());
    file.Commit();
}

// OpenSubdiv prints to standard output, where the result may go.
void PrintOpenSubdivWarning(char const* text) { PrintLine("warning", std::string("OpenSubdiv: ") + text); }

// A reader that went away (| head) has seen enough; any other failure is one.
void PrintTable(CommandLine const& line, RunSummary const& run) {
    bool const isOutputTaken = IsStandardOutput(line.outputFile) || IsStandardOutput(line.reportFile);
    std::FILE* const out = isOutputTaken ? stderr : stdout;
    std::string const text = TableText(line, run);
    errno = 0;
    bool const isPrinted = std::fwrite(text.data(), 1, text.size(), out) == text.size() && std::fflush(out) == 0;
    if (!isPrinted && errno != EPIPE) {
        throw io::WriteError("standard output", std::generic_category().message(errno));
    }
}

template <typename Real>
int Run(CommandLine const& line) {
    RunSummary run;

    // Read the control mesh and its sharpness.
    io::Model const model = Timed(run.seconds, "reading", [&] { return ReadModel(line.modelFile, line); });
    for (std::string const& warning : model.warnings) PrintLine("warning", warning);
    run.rules = line.Rules(model);
    RequireTriangles(line.modelFile, line.Scheme(), model);
    ControlMesh const mesh = model.Mesh(run.rules);
    RunInput<Real> const input = MakeInput<Real>(line.modelFile, model, line.shading.startNormals.kind);

    // Shade it.
    ShadingResult<Real> const result = line.tessellation ? Tessellate(line, model, mesh, input.input, run.seconds)
                                                         : Shade(line, mesh, input.input);
    run.options = result.options;
    run.shading = result.report;
    run.seconds.insert(run.seconds.end(), result.report.seconds.begin(), result.report.seconds.end());
    if (result.report.maxAngleValue >= 0) {
        run.maxAngleVertex = result.valueVertices[static_cast<std::size_t>(result.report.maxAngleValue)];
        Vec3<Real> const& p = result.positions[static_cast<std::size_t>(run.maxAngleVertex)];
        run.maxAnglePosition = {p.x, p.y, p.z};
    }

    // Compare it with OpenSubdiv; what fails is written all the same, to be looked at.
    if (line.check) {
        run.check = Timed(run.seconds, "geometry check",
                          [&] { return CheckGeometry(mesh, input.input.positions, result); });
    }

    // The same mesh as it moves.
    if (line.stats || line.numFrames > 0) RunFrames(line, model, mesh, run);

    // Write it, and say what was done.
    if (line.format != OutputFormat::None) {
        Timed(run.seconds, "writing", [&] { WriteResult(line, model, mesh, result); });
    }
    run.peakBytes = PeakMemory();
    if (!line.reportFile.empty()) WriteReport(line, run);
    if (!line.quiet) PrintTable(line, run);
    if (run.check && !run.check->Passes(line.tolerance)) {
        PrintLine("check", "the geometry departs from OpenSubdiv's by more than the tolerance");
        return kCheckFailed;
    }
    return kSuccess;
}

int RunCommandLine(int argc, char const* const* argv) {
    std::optional<CommandLine> const line = ParseCommandLine(argc, argv);
    if (!line) return kSuccess;
    Far::SetWarningCallback(PrintOpenSubdivWarning);
    RequireWritable(line->outputFile);
    RequireWritable(line->reportFile);
    return line->precision == Precision::Float ? Run<float>(*line) : Run<double>(*line);
}

}  // namespace

}  // namespace osd_shading::tool

int main(int argc, char** argv) {
    using osd_shading::tool::kFailure;
    using osd_shading::tool::PrintLine;

    // A pipe that closes is an error of the write, not the end.
    signal(SIGPIPE, SIG_IGN);
    try {
        return osd_shading::tool::RunCommandLine(argc, argv);
    } catch (osd_shading::MemoryLimitExceeded const& error) {
        PrintLine("error", std::string(error.what()) + " (--memory-limit, or what is free)");
    } catch (std::bad_alloc const&) {
        PrintLine("error", "out of memory; a lower --level takes a quarter");
    } catch (std::exception const& error) {
        PrintLine("error", error.what());
    }
    return kFailure;
}
