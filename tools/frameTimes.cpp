// SPDX-License-Identifier: Apache-2.0
#include "frameTimes.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <thread>

namespace osd_shading::tool {

FrameTimes MeasureFrames(ShadingTable const& table, PointView<float> rest, PointView<float> userNormals,
                         DeformationKind deformation, int numFrames, int numThreads) {
    using Clock = std::chrono::steady_clock;
    FrameTimes times;
    times.numFrames = numFrames;
    times.deformation = deformation;
    times.numThreads =
        numThreads > 0 ? numThreads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    EvaluatorOptions options;
    options.numThreads = times.numThreads;
    ShadingEvaluator evaluator(table, options);
    times.instructionSet = evaluator.InstructionSetName();

    // Positions and normals side by side, as a renderer takes them.
    auto const numValues = static_cast<std::size_t>(table.NumValues());
    std::vector<float> buffer(6 * numValues);
    ShadingOutputs outputs;
    outputs.positions = {buffer.data(), numValues, 6};
    outputs.blendedNormals = {buffer.data() + 3, numValues, 6};

    DeformationFrame const frame = FrameOf(rest);
    std::vector<Vec3<float>> points(rest.size());
    std::vector<double> seconds;
    for (int i = 0; i < numFrames; ++i) {
        double const time = static_cast<double>(i) / numFrames;
        for (std::size_t p = 0; p < points.size(); ++p) points[p] = Deformed(deformation, frame, rest[p], time);
        Clock::time_point const start = Clock::now();
        FrameReport const report = evaluator.Evaluate(points, userNormals, outputs);
        seconds.push_back(std::chrono::duration<double>(Clock::now() - start).count());
        times.worst.fallbackNormals = std::max(times.worst.fallbackNormals, report.fallbackNormals);
        times.worst.zeroStartNormals = std::max(times.worst.zeroStartNormals, report.zeroStartNormals);
    }
    std::sort(seconds.begin(), seconds.end());
    times.leastSeconds = seconds.front();
    times.medianSeconds = (seconds[(seconds.size() - 1) / 2] + seconds[seconds.size() / 2]) / 2;
    return times;
}

}  // namespace osd_shading::tool
