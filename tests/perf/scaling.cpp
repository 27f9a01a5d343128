// SPDX-License-Identifier: Apache-2.0
#include "scaling.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

#include "childProcess.h"
#include "movingMesh.h"
#include "openSubdivFrames.h"
#include "perfMeshes.h"
#include "shadingFrames.h"
#include "stopwatch.h"

namespace perf {

using osd_shading::InstructionSet;

namespace {

// One quad in 16 each way has eight extraordinary vertices round it, one edge in 16 is sharp.
constexpr int kSpacing = 16, kLevel = 4;
constexpr int kAround = 104, kUp = 100;
constexpr double kSeconds = 3;

/// Resident size of this process in bytes; 0 where the system doesn't tell.
std::int64_t residentBytes() {
    std::ifstream file("/proc/self/statm");
    std::int64_t total = 0, resident = 0;
    file >> total >> resident;
    return resident * sysconf(_SC_PAGESIZE);
}

struct OurCost {
    double values = 0, limitNormals = 0, shaded = 0, shadedTwoThreads = 0, tableBytes = 0;
    std::int64_t residentBefore = 0;
};

std::string measureOurs(int around, int up, int level) {
    OurCost cost;
    MovingMesh mesh(CreasedTorus(around, up, kSpacing));
    cost.residentBefore = residentBytes();
    osd_shading::ShadingTable const table(mesh.Mesh(), OptionsFor(FrameKind::Shaded, level));
    FrameBuffers buffers(static_cast<std::size_t>(table.NumValues()));
    {
        ShadingFrames limit(table, FrameKind::LimitNormals, {1, InstructionSet::Best}, buffers);
        ShadingFrames shaded(table, FrameKind::Shaded, {1, InstructionSet::Best}, buffers);
        std::vector<double> const seconds =
            SecondsPerFrame({{[&] { limit.Evaluate(mesh.NextPose()); }, Clock::Thread},
                             {[&] { shaded.Evaluate(mesh.NextPose()); }, Clock::Thread}},
                            kSeconds);
        cost.limitNormals = seconds[0];
        cost.shaded = seconds[1];
    }
    ShadingFrames two(table, FrameKind::Shaded, {2, InstructionSet::Best}, buffers);
    cost.shadedTwoThreads =
        SecondsPerFrame({{[&] { two.Evaluate(mesh.NextPose()); }, Clock::Wall}}, kSeconds / 2)[0];

    std::ostringstream text;
    text.precision(9);
    text << table.NumValues() << ' ' << cost.limitNormals << ' ' << cost.shaded << ' ' << cost.shadedTwoThreads
         << ' ' << table.NumBytes() << ' ' << cost.residentBefore;
    return text.str();
}

std::string measureOpenSubdiv(int around, int up, int level) {
    MovingMesh mesh(CreasedTorus(around, up, kSpacing));
    OpenSubdivFrames frames(mesh, level);
    std::vector<Contender> contenders;
    contenders.reserve(kOpenSubdivForms.size());
    for (OpenSubdivForm const form : kOpenSubdivForms) {
        contenders.push_back({[&, form] { frames.EvaluateLimits(mesh.NextPose(), form); }, Clock::Thread});
    }
    std::vector<double> const seconds = SecondsPerFrame(contenders, kSeconds);
    std::ostringstream text;
    text.precision(9);
    text << *std::min_element(seconds.begin(), seconds.end());
    return text.str();
}

/// Adds the figures of one mesh, unless memory won't do: what the one before took beside its outputs tells.
void addFigures(int around, int up, int level, bool withOpenSubdiv, std::vector<ScalingFigures>& series) {
    constexpr double kOutputBytes = 24;
    // OpenSubdiv's table twice while it is built, and its frame.
    constexpr double kOpenSubdivBytes = 700;
    double const ourBytes = kOutputBytes + (series.empty() ? 0 : series.back().otherBytes);
    double const values = static_cast<double>(around) * up * static_cast<double>(1 << (2 * level));
    double const bytes = values * std::max(ourBytes, withOpenSubdiv ? kOpenSubdivBytes : 0);
    // Half of what is there: the estimate is rough, and others work here too.
    if (bytes > 0.5 * static_cast<double>(AvailableBytes())) {
        std::printf("%.1f million values are left out: they would take %.1f GB of memory.\n", 1e-6 * values,
                    1e-9 * bytes);
        return;
    }

    ScalingFigures figures;
    figures.level = level;
    ChildOutcome const ours = RunInChild([=] { return measureOurs(around, up, level); });
    if (!ours.succeeded) throw std::runtime_error("scaling: " + ours.text);
    std::istringstream text(ours.text);
    double tableBytes = 0, residentBefore = 0;
    text >> figures.values >> figures.limitNormals >> figures.shaded >> figures.shadedTwoThreads >> tableBytes >>
        residentBefore;
    figures.tableBytes = tableBytes / figures.values;
    figures.otherBytes = (static_cast<double>(ours.peakBytes) - residentBefore) / figures.values - kOutputBytes;
    if (withOpenSubdiv) {
        ChildOutcome const theirs = RunInChild([=] { return measureOpenSubdiv(around, up, level); });
        if (!theirs.succeeded) throw std::runtime_error("scaling: " + theirs.text);
        std::istringstream(theirs.text) >> figures.openSubdiv;
    }
    series.push_back(figures);
}

}  // namespace

std::vector<ScalingFigures> ScalingSeries(double mostValues, double mostForOpenSubdiv) {
    // Some 8, 50, 200, .. thousand values, and 43 million.
    constexpr std::array<std::pair<int, int>, 7> kSizes = {
        {{8, 4}, {16, 12}, {28, 28}, {52, 52}, {kAround, kUp}, {208, 200}, {416, 400}}};
    std::vector<ScalingFigures> series;
    for (auto const& [around, up] : kSizes) {
        double const about = std::ldexp(around * up, 2 * kLevel);
        if (about > mostValues) break;
        addFigures(around, up, kLevel, about <= mostForOpenSubdiv, series);
    }
    return series;
}

std::vector<ScalingFigures> ScalingByLevel() {
    std::vector<ScalingFigures> series;
    for (int const level : {kLevel, kLevel + 2}) addFigures(kAround, kUp, level, false, series);
    return series;
}

}  // namespace perf
