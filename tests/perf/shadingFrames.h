// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "movingMesh.h"
#include "osd_shading/shadingEvaluator.h"
#include "osd_shading/shadingTable.h"

namespace perf {

/// What our frames write: positions and a normal per value.
enum class FrameKind {
    Shaded,        ///< N_B, by the paper's preset
    LimitNormals,  ///< N_L, from the same table
    Smooth         ///< N_S of variant D
};

/// The options of a table for frames of `kind`, which runs with one thread.
osd_shading::ShadingOptions OptionsFor(FrameKind kind, int level);

/// Room for a frame: packed positions and normals.
struct FrameBuffers {
    std::vector<float> positions, normals;

    explicit FrameBuffers(std::size_t numValues) : positions(3 * numValues), normals(3 * numValues) {}
};

/// Our frames: `table`'s values into `buffers`, which both live longer.
class ShadingFrames {
public:
    ShadingFrames(osd_shading::ShadingTable const& table, FrameKind kind,
                  osd_shading::EvaluatorOptions const& options, FrameBuffers& buffers);

    void Evaluate(ControlPoints const& points);

private:
    osd_shading::ShadingEvaluator _evaluator;
    osd_shading::ShadingOutputs _outputs;
};

}  // namespace perf
