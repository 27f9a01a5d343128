// SPDX-License-Identifier: Apache-2.0

// What one-shot shading costs beside OpenSubdiv's own refining, interpolating and limits, in time and in peak
// memory, and whether both grow linearly with the faces.

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <functional>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "childProcess.h"
#include "openSubdivAlone.h"
#include "osd_shading/io/model.h"
#include "osd_shading/subdivisionShading.h"
#include "perfMeshes.h"

namespace perf {
namespace {

using osd_shading::io::Model;

constexpr double kTimeGoal = 2.5, kMemoryGoal = 2;
// Caches and fresh pages make a face dearer in large meshes, also in OpenSubdiv's own run, whose work is linear.
// What grows faster than linearly would fall behind it further and further over three decades.
constexpr double kGrowthGoal = 1.5;

struct Options {
    std::string extraModels = OSD_SHADING_EXTRA_MODELS;
    std::string csvFile;
    HeapState heap = HeapState::Cold;
    bool isQuick = false, isLarge = false, showsStages = false;
};

/// One mesh at one level in one precision.
struct Case {
    Model const* model;
    Sdc::SchemeType scheme;
    int level;
    std::size_t realSize;

    bool IsCatmark() const { return scheme == Sdc::SCHEME_CATMARK; }
    std::int64_t LastFaces() const {
        auto const count = IsCatmark() ? model->faceVertices.size() : 4 * model->faceSizes.size();
        return static_cast<std::int64_t>(count) << (2 * (level - 1));
    }
    std::uint64_t Estimate() const {
        osd_shading::MeshSize size;
        size.scheme = scheme;
        size.numVertices = model->NumVertices();
        size.numFaces = model->NumFaces();
        size.numFaceCorners = static_cast<std::int64_t>(model->faceVertices.size());
        size.numCreases = static_cast<std::int64_t>(model->creaseSharpness.size());
        return osd_shading::EstimateShadingBytes(size, level, realSize);
    }
    std::string Name() const {
        return model->name + (IsCatmark() ? " catmark " : " loop ") + (realSize == 4 ? "float" : "double") +
               " level " + std::to_string(level);
    }
};

struct Seconds {
    double wall = 0, processor = 0;
};

struct Cost {
    Seconds shadingTime, openSubdivTime;
    std::int64_t shadingBytes = 0, openSubdivBytes = 0;
    int numRuns = 0;
    std::vector<std::pair<std::string, double>> stages;

    double TimeRatio() const { return shadingTime.processor / openSubdivTime.processor; }
    double WallRatio() const { return shadingTime.wall / openSubdivTime.wall; }
    double MemoryRatio() const {
        return static_cast<double>(shadingBytes) / static_cast<double>(std::max<std::int64_t>(openSubdivBytes, 1));
    }
};

double median(std::vector<double> values) {
    auto const middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Calls `run` and returns its time; what it returns is destroyed afterwards, off the clock.
template <typename Run>
Seconds timeOf(Run const& run) {
    auto const wall = std::chrono::steady_clock::now();
    double const processor = ProcessorSeconds();
    auto const result = run();
    double const processorEnd = ProcessorSeconds();
    return {std::chrono::duration<double>(std::chrono::steady_clock::now() - wall).count(),
            processorEnd - processor};
}

struct Series {
    std::vector<double> wall, processor;

    void Add(Seconds const& time) {
        wall.push_back(time.wall);
        processor.push_back(time.processor);
    }
    Seconds Median() const { return {median(wall), median(processor)}; }
};

/// The two runs that are compared, on one case.
template <typename Real>
class Contest {
public:
    explicit Contest(Case const& what)
        : _level(what.level), _positions(what.model->positions.begin(), what.model->positions.end()) {
        osd_shading::SubdivisionRules rules = what.model->Rules({});
        rules.scheme = what.scheme;
        _mesh = what.model->Mesh(rules);
        // Once over everything, so that loading code counts in no run.
        Model const small = what.IsCatmark() ? CreasedTorus(4, 4) : Triangulated(CreasedTorus(4, 4));
        std::vector<Real> const points(small.positions.begin(), small.positions.end());
        shade(small.Mesh(rules), points, 1);
        RunOpenSubdiv(small.Mesh(rules), points, 1);
    }

    auto Shade() const { return shade(_mesh, _positions, _level); }
    auto OpenSubdiv() const { return RunOpenSubdiv(_mesh, _positions, _level); }

private:
    static osd_shading::ShadingResult<Real> shade(osd_shading::ControlMesh const& mesh,
                                                  std::vector<Real> const& positions, int level) {
        osd_shading::ShadingInput<Real> input;
        input.positions = {positions.data(), positions.size() / 3};
        return osd_shading::ShadeSubdivision(mesh, input, osd_shading::PaperPreset(level));
    }

    int _level;
    std::vector<Real> _positions;
    osd_shading::ControlMesh _mesh;
};

/// Times both in turn, as often as it takes, and returns the medians as text.
template <typename Real>
std::string measureTimes(Case const& what, HeapState heap) {
    if (heap == HeapState::Warm) KeepFreedMemory();
    Contest<Real> const contest(what);
    constexpr int kFewest = 5, kMost = 41;  // and one before them
    constexpr double kEnoughSeconds = 2;
    Series shading, openSubdiv;
    std::vector<std::string> stageNames;
    std::map<std::string, std::vector<double>> stages;
    double total = 0;
    for (int run = 0; run <= kFewest || (run < kMost && total < kEnoughSeconds); ++run) {
        std::vector<std::pair<std::string, double>> runStages;
        if (heap == HeapState::Cold) ReturnFreedMemory();
        Seconds const ours = timeOf([&] {
            auto result = contest.Shade();
            runStages = result.report.seconds;
            return result;
        });
        if (heap == HeapState::Cold) ReturnFreedMemory();
        Seconds const theirs = timeOf([&] { return contest.OpenSubdiv(); });
        if (run == 0) continue;  // warms code, and memory where that is wanted
        total += ours.wall + theirs.wall;
        shading.Add(ours);
        openSubdiv.Add(theirs);
        for (auto const& [name, seconds] : runStages) {
            if (stages[name].empty()) stageNames.push_back(name);
            stages[name].push_back(seconds);
        }
    }
    std::ostringstream text;
    text.precision(9);
    for (Series const* series : {&shading, &openSubdiv}) {
        Seconds const time = series->Median();
        text << time.wall << ' ' << time.processor << ' ';
    }
    text << shading.wall.size() << '\n';
    for (std::string const& name : stageNames) text << median(stages[name]) << ' ' << name << '\n';
    return text.str();
}

template <typename Real>
Cost measureAs(Case const& what, HeapState heap) {
    auto const run = [](std::function<std::string()> const& work) {
        ChildOutcome outcome = RunInChild(work);
        if (!outcome.succeeded) throw std::runtime_error(outcome.text);
        return outcome;
    };
    auto const peakOf = [&](auto const& work) {
        return run([&] {
                   Contest<Real> const contest(what);
                   work(contest);
                   return std::string();
               })
            .peakBytes;
    };
    Cost cost;
    std::int64_t const idle = peakOf([](Contest<Real> const&) {});
    cost.shadingBytes = peakOf([](Contest<Real> const& contest) { contest.Shade(); }) - idle;
    cost.openSubdivBytes = peakOf([](Contest<Real> const& contest) { contest.OpenSubdiv(); }) - idle;

    std::istringstream text(run([&] { return measureTimes<Real>(what, heap); }).text);
    text >> cost.shadingTime.wall >> cost.shadingTime.processor >> cost.openSubdivTime.wall >>
        cost.openSubdivTime.processor >> cost.numRuns;
    double seconds = 0;
    for (std::string name; text >> seconds && std::getline(text >> std::ws, name);) {
        cost.stages.emplace_back(name, seconds);
    }
    return cost;
}

/// Measures, or says on the table why not.
std::optional<Cost> measure(Case const& what, HeapState heap) {
    double const estimate = static_cast<double>(what.Estimate());
    if (estimate > 0.8 * static_cast<double>(AvailableBytes())) {
        std::printf("%-32s left out: it may take %.0f MB, more than there is\n", what.Name().c_str(),
                    estimate / 1e6);
        return std::nullopt;
    }
    try {
        return what.realSize == sizeof(float) ? measureAs<float>(what, heap) : measureAs<double>(what, heap);
    } catch (std::runtime_error const& error) {
        std::printf("%-32s failed: %s\n", what.Name().c_str(), error.what());
        return std::nullopt;
    }
}

/// The tables, line by line as they are measured; the same numbers as CSV; and what is over its goal.
class Record {
public:
    explicit Record(Options const& options) : _showsStages(options.showsStages) {
        if (options.csvFile.empty()) return;
        _csv.open(options.csvFile);
        if (!_csv) throw std::runtime_error(options.csvFile + ": can't be written");
        _csv << "mesh,scheme,precision,level,faces,runs,shading_seconds,shading_processor_seconds,"
                "opensubdiv_seconds,opensubdiv_processor_seconds,shading_bytes,opensubdiv_bytes,estimated_bytes\n";
    }

    static void PrintHeading(char const* title) {
        std::printf("\n%s\n%-32s %9s | %10s %10s %11s %6s | %9s %9s %9s | %8s\n", title, "", "faces", "shading ms",
                    "OpenSubdiv", "ratio /goal", "(wall)", "shading MB", "OpenSubdiv", "ratio/goal", "estimate");
    }

    void Add(Case const& what, Cost const& cost) {
        double const estimate = static_cast<double>(what.Estimate()) / static_cast<double>(cost.shadingBytes);
        std::printf("%-32s %9lld | %10.2f %10.2f %5.2f / %.1f %6.2f | %10.1f %10.1f %4.2f / %.0f | %8.2f\n",
                    what.Name().c_str(), static_cast<long long>(what.LastFaces()), 1e3 * cost.shadingTime.processor,
                    1e3 * cost.openSubdivTime.processor, cost.TimeRatio(), kTimeGoal, cost.WallRatio(),
                    static_cast<double>(cost.shadingBytes) / 1e6, static_cast<double>(cost.openSubdivBytes) / 1e6,
                    cost.MemoryRatio(), kMemoryGoal, estimate);
        if (_showsStages) {
            for (auto const& [name, seconds] : cost.stages) {
                std::printf("    %-28s %27.2f ms\n", name.c_str(), 1e3 * seconds);
            }
        }
        std::fflush(stdout);
        if (_csv.is_open()) {
            _csv << what.model->name << ',' << (what.IsCatmark() ? "catmark" : "loop") << ','
                 << (what.realSize == sizeof(float) ? "float" : "double") << ',' << what.level << ','
                 << what.LastFaces() << ',' << cost.numRuns << ',' << cost.shadingTime.wall << ','
                 << cost.shadingTime.processor << ',' << cost.openSubdivTime.wall << ','
                 << cost.openSubdivTime.processor << ',' << cost.shadingBytes << ',' << cost.openSubdivBytes << ','
                 << what.Estimate() << std::endl;
        }
        if (estimate < 1) Miss(what.Name() + ": takes more than EstimateShadingBytes", 1 / estimate, 1);
    }

    void Miss(std::string const& what, double have, double goal) {
        char text[32];
        std::snprintf(text, sizeof text, " (%.2f / %.1f)", have, goal);
        _missed.push_back(what + text);
    }

    void PrintMissed() const {
        std::printf("\n%s", _missed.empty() ? "every goal is met" : "missed: ");
        for (std::size_t i = 0; i < _missed.size(); ++i) std::printf("%s%s", i > 0 ? ", " : "", _missed[i].c_str());
        std::printf("\n");
    }

private:
    bool _showsStages;
    std::ofstream _csv;
    std::vector<std::string> _missed;
};

constexpr std::size_t kPrecisions[] = {sizeof(float), sizeof(double)};

/// Both ratios on Spot and on 10,000 faces, level by level.
void compareWithOpenSubdiv(Options const& options, Record& record) {
    Model const spot = ReadSpot(options.extraModels);
    if (spot.name != "spot")
        std::printf("(zbk/spot.obj is not in %s: %s instead)\n", options.extraModels.c_str(), spot.name.c_str());
    Record::PrintHeading(
        options.heap == HeapState::Cold
            ? "One-shot shading against OpenSubdiv alone (medians of processor time, fresh memory)"
            : "One-shot shading against OpenSubdiv alone (medians of processor time, warm memory)");
    Model const quads = CreasedTorus(100, 80), triangles = Triangulated(CreasedTorus(80, 52));
    std::pair<Model const*, Sdc::SchemeType> const meshes[] = {
        {&spot, Sdc::SCHEME_CATMARK}, {&quads, Sdc::SCHEME_CATMARK}, {&triangles, Sdc::SCHEME_LOOP}};
    for (auto const& [model, scheme] : meshes) {
        for (std::size_t const realSize : kPrecisions) {
            for (int level = 3; level <= (options.isQuick ? 4 : 6); ++level) {
                Case const what{model, scheme, level, realSize};
                std::optional<Cost> const cost = measure(what, options.heap);
                if (!cost) continue;
                record.Add(what, *cost);
                if (cost->TimeRatio() > kTimeGoal)
                    record.Miss("time of " + what.Name(), cost->TimeRatio(), kTimeGoal);
                if (cost->MemoryRatio() > kMemoryGoal) {
                    record.Miss("memory of " + what.Name(), cost->MemoryRatio(), kMemoryGoal);
                }
            }
        }
    }
}

/// Smallest and largest of what a face costs.
struct Range {
    double least = HUGE_VAL, most = 0;

    void Add(double value) {
        least = std::min(least, value);
        most = std::max(most, value);
    }
    double Growth() const { return most / least; }
};

/// The cost of a face of the last level while the control mesh grows.
void growWithFaces(Options const& options, Record& record) {
    using Size = std::pair<int, int>;
    // At level 4 a face becomes 256: some 10, 30, 100, .. thousand of them, and 40 million.
    constexpr std::array<Size, 8> kQuadSizes = {
        {{8, 4}, {12, 8}, {20, 16}, {40, 24}, {80, 40}, {120, 80}, {200, 160}, {400, 320}}};
    constexpr std::array<Size, 8> kTriangleSizes = {
        {{4, 4}, {12, 4}, {20, 8}, {24, 20}, {40, 40}, {80, 60}, {160, 100}, {320, 200}}};
    constexpr int kLevel = 4;
    std::size_t const numSizes = options.isQuick ? 5 : options.isLarge ? 8 : 7;
    for (Sdc::SchemeType const scheme : {Sdc::SCHEME_CATMARK, Sdc::SCHEME_LOOP}) {
        bool const isCatmark = scheme == Sdc::SCHEME_CATMARK;
        for (std::size_t const realSize : kPrecisions) {
            std::string const name = std::string(isCatmark ? "Catmull-Clark" : "Loop") + " in " +
                                     (realSize == sizeof(float) ? "float" : "double");
            Record::PrintHeading(("Growth with the faces: " + name).c_str());
            Range time, memory, openSubdivTime, openSubdivMemory;
            for (std::size_t i = 0; i < numSizes; ++i) {
                Size const size = isCatmark ? kQuadSizes[i] : kTriangleSizes[i];
                Model const quads = CreasedTorus(size.first, size.second);
                Model const model = isCatmark ? quads : Triangulated(quads);
                Case const what{&model, scheme, kLevel, realSize};
                std::optional<Cost> const cost = measure(what, options.heap);
                if (!cost) continue;
                record.Add(what, *cost);
                auto const faces = static_cast<double>(what.LastFaces());
                time.Add(1e9 * cost->shadingTime.processor / faces);
                memory.Add(static_cast<double>(cost->shadingBytes) / faces);
                openSubdivTime.Add(1e9 * cost->openSubdivTime.processor / faces);
                openSubdivMemory.Add(static_cast<double>(cost->openSubdivBytes) / faces);
            }
            if (time.most == 0) continue;
            std::printf(
                "%s, a face: %.0f to %.0f ns, largest over smallest %.2f (OpenSubdiv alone %.2f); "
                "%.0f to %.0f bytes, %.2f (%.2f)\n",
                name.c_str(), time.least, time.most, time.Growth(), openSubdivTime.Growth(), memory.least,
                memory.most, memory.Growth(), openSubdivMemory.Growth());
            double const timeGrowth = time.Growth() / openSubdivTime.Growth();
            double const memoryGrowth = memory.Growth() / openSubdivMemory.Growth();
            if (timeGrowth > kGrowthGoal) record.Miss("growth of time, " + name, timeGrowth, kGrowthGoal);
            if (memoryGrowth > kGrowthGoal) record.Miss("growth of memory, " + name, memoryGrowth, kGrowthGoal);
        }
    }
}

char const kUsage[] =
    "usage: osd_shading_perf [EXTRA_MODELS] [--quick] [--large] [--warm] [--stages] [--csv FILE]\n"
    "  EXTRA_MODELS  folder with zbk/spot.obj\n"
    "  --quick       levels 3 and 4 only, and a million faces at most\n"
    "  --large       40 million faces too\n"
    "  --warm        from memory that the process already holds, instead of fresh pages of the system\n"
    "  --stages      wall time of each stage\n";

std::optional<Options> parseOptions(std::vector<std::string> const& words) {
    Options options;
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (words[i] == "--quick") {
            options.isQuick = true;
        } else if (words[i] == "--large") {
            options.isLarge = true;
        } else if (words[i] == "--warm") {
            options.heap = HeapState::Warm;
        } else if (words[i] == "--stages") {
            options.showsStages = true;
        } else if (words[i] == "--csv" && i + 1 < words.size()) {
            options.csvFile = words[++i];
        } else if (!words[i].empty() && words[i][0] != '-') {
            options.extraModels = words[i];
        } else {
            return std::nullopt;
        }
    }
    return options;
}

}  // namespace
}  // namespace perf

int main(int numArguments, char** arguments) {
    std::optional<perf::Options> const options = perf::parseOptions({arguments + 1, arguments + numArguments});
    if (!options) {
        std::fputs(perf::kUsage, stderr);
        return 2;
    }
    try {
        perf::Record record(*options);
        perf::compareWithOpenSubdiv(*options, record);
        perf::growWithFaces(*options, record);
        record.PrintMissed();
    } catch (std::exception const& error) {
        std::fprintf(stderr, "osd_shading_perf: %s\n", error.what());
        return 1;
    }
    return 0;
}
