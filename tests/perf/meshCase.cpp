// SPDX-License-Identifier: Apache-2.0
#include "meshCase.h"

#include <cstring>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "childProcess.h"
#include "openSubdivFrames.h"
#include "shadingFrames.h"
#include "stopwatch.h"

namespace perf {

using osd_shading::InstructionSet;
using osd_shading::ShadingTable;

namespace {

/// Contenders, and where their medians go.
class Contest {
public:
    void Add(double& result, std::function<void()> frame, Clock clock = Clock::Thread) {
        _contenders.push_back({std::move(frame), clock});
        _results.push_back(&result);
    }
    void Run(double seconds) {
        std::vector<double> const times = SecondsPerFrame(_contenders, seconds);
        for (std::size_t i = 0; i < times.size(); ++i) *_results[i] = times[i];
    }

private:
    std::vector<Contender> _contenders;
    std::vector<double*> _results;
};

void clear(FrameBuffers& buffers, std::size_t first, std::size_t end) {
    std::memset(buffers.positions.data() + first, 0, (end - first) * sizeof(float));
    std::memset(buffers.normals.data() + first, 0, (end - first) * sizeof(float));
}

void clearWithTwoThreads(FrameBuffers& buffers) {
    std::size_t const middle = buffers.positions.size() / 2;
    std::thread other([&] { clear(buffers, 0, middle); });
    clear(buffers, middle, buffers.positions.size());
    other.join();
}

/// Frames of `table` by one instruction set; null where this processor does not have it.
std::unique_ptr<ShadingFrames> framesBy(InstructionSet set, ShadingTable const& table, FrameKind kind,
                                        FrameBuffers& buffers) {
    if (!osd_shading::IsAvailable(set)) return nullptr;
    return std::make_unique<ShadingFrames>(table, kind, osd_shading::EvaluatorOptions{1, set}, buffers);
}

void measureWithTwoThreads(MovingMesh& mesh, ShadingTable const& table, FrameBuffers& buffers, double seconds,
                           CaseFigures& figures) {
    ShadingFrames one(table, FrameKind::Shaded, {1, InstructionSet::Best}, buffers);
    ShadingFrames two(table, FrameKind::Shaded, {2, InstructionSet::Best}, buffers);
    Contest contest;
    contest.Add(
        figures.wallOneThread, [&] { one.Evaluate(mesh.NextPose()); }, Clock::Wall);
    contest.Add(
        figures.wallTwoThreads, [&] { two.Evaluate(mesh.NextPose()); }, Clock::Wall);
    contest.Add(
        figures.memsetOneWall, [&] { clear(buffers, 0, buffers.positions.size()); }, Clock::Wall);
    contest.Add(
        figures.memsetTwoThreads, [&] { clearWithTwoThreads(buffers); }, Clock::Wall);
    contest.Run(seconds);
}

}  // namespace

std::optional<CaseFigures> MeasureCase(MovingMesh& mesh, int level, CaseEffort const& effort) {
    // OpenSubdiv's table twice while it is built, and its frame.
    constexpr double kBytesPerVertex = 2 * 300 + 100;
    double const bytes = mesh.AboutVertices(level) * kBytesPerVertex;
    if (bytes > 0.5 * static_cast<double>(AvailableBytes())) return std::nullopt;

    CaseFigures figures;
    figures.mesh = mesh.Model().name;
    figures.isLoop = mesh.IsLoop();
    figures.level = level;

    auto const build = [&] { return ShadingTable(mesh.Mesh(), OptionsFor(FrameKind::Shaded, level)); };
    figures.build = MedianSeconds(effort.comparesBuild ? 5 : 1, build);
    ShadingTable const table = build();
    ShadingTable const smoothTable(mesh.Mesh(), OptionsFor(FrameKind::Smooth, level));
    figures.table = table.Stats();
    FrameBuffers buffers(static_cast<std::size_t>(table.NumValues()));
    FrameBuffers smoothBuffers(static_cast<std::size_t>(smoothTable.NumValues()));

    auto const best = framesBy(InstructionSet::Best, table, FrameKind::Shaded, buffers);
    auto const avx2 = framesBy(InstructionSet::Avx2, table, FrameKind::Shaded, buffers);
    auto const sse2 = framesBy(InstructionSet::Sse2, table, FrameKind::Shaded, buffers);
    auto const limit = framesBy(InstructionSet::Best, table, FrameKind::LimitNormals, buffers);
    auto const smooth = framesBy(InstructionSet::Best, smoothTable, FrameKind::Smooth, smoothBuffers);
    {
        OpenSubdivFrames openSubdiv(mesh, level);
        figures.openSubdivVertices = openSubdiv.NumVertices();
        figures.openSubdivBytes =
            static_cast<double>(openSubdiv.NumBytes()) / static_cast<double>(openSubdiv.NumVertices());
        figures.openSubdivBuild = openSubdiv.BuildSeconds();
        Contest contest;
        for (std::size_t i = 0; i < kOpenSubdivForms.size(); ++i) {
            OpenSubdivForm const form = kOpenSubdivForms[i];
            contest.Add(figures.openSubdivLimits[i],
                        [&, form] { openSubdiv.EvaluateLimits(mesh.NextPose(), form); });
            contest.Add(figures.openSubdivNormals[i], [&, form] {
                openSubdiv.EvaluateLimits(mesh.NextPose(), form);
                openSubdiv.ComputeNormals(form);
            });
            // Any points serve as normals: the time is the same.
            contest.Add(figures.openSubdivTwice[i],
                        [&, form] { openSubdiv.EvaluateTwice(mesh.NextPose(), mesh.FirstPose().four, form); });
        }
        contest.Add(figures.shaded, [&] { best->Evaluate(mesh.NextPose()); });
        if (avx2) contest.Add(figures.shadedAvx2, [&] { avx2->Evaluate(mesh.NextPose()); });
        if (sse2) contest.Add(figures.shadedSse2, [&] { sse2->Evaluate(mesh.NextPose()); });
        contest.Add(figures.limitNormals, [&] { limit->Evaluate(mesh.NextPose()); });
        contest.Add(figures.smooth, [&] { smooth->Evaluate(mesh.NextPose()); });
        contest.Add(figures.memsetOutput, [&] { clear(buffers, 0, buffers.positions.size()); });
        contest.Run(effort.seconds);
    }
    if (effort.usesTwoThreads) {
        measureWithTwoThreads(mesh, table, buffers, effort.seconds / 2, figures);
    }
    return figures;
}

}  // namespace perf
