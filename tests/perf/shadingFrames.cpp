// SPDX-License-Identifier: Apache-2.0
#include "shadingFrames.h"

namespace perf {

osd_shading::ShadingOptions OptionsFor(FrameKind kind, int level) {
    return kind == FrameKind::Smooth ? osd_shading::SmoothPreset(level) : osd_shading::PaperPreset(level);
}

ShadingFrames::ShadingFrames(osd_shading::ShadingTable const& table, FrameKind kind,
                             osd_shading::EvaluatorOptions const& options, FrameBuffers& buffers)
    : _evaluator(table, options) {
    std::size_t const numValues = buffers.positions.size() / 3;
    _outputs.positions = {buffers.positions.data(), numValues};
    osd_shading::PointSpan const normals = {buffers.normals.data(), numValues};
    switch (kind) {
        case FrameKind::Shaded:
            _outputs.blendedNormals = normals;
            break;
        case FrameKind::LimitNormals:
            _outputs.limitNormals = normals;
            break;
        case FrameKind::Smooth:
            _outputs.subdividedNormals = normals;
            break;
    }
}

void ShadingFrames::Evaluate(ControlPoints const& points) {
    _evaluator.Evaluate(osd_shading::PointView<float>(points.three.data(), points.three.size() / 3), _outputs);
}

}  // namespace perf
