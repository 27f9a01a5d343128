// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/shadingEvaluator.h"

#include <algorithm>
#include <string>
#include <thread>
#include <utility>

#include "osd_shading/tables/tileFrames.h"

namespace osd_shading {
inline namespace v1 {

namespace {

using namespace tables;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

void checkSpan(char const* name, float const* data, std::size_t count, std::size_t stride, std::size_t width,
               std::size_t wanted) {
    if (data == nullptr && count == 0) return;
    auto const what = [&] { return std::string(name); };  // made where it is thrown: a frame allocates nothing
    if (count != wanted) {
        throw InvalidOptions(what() + " has room for " + std::to_string(count) + " elements; the table has " +
                             std::to_string(wanted) + " values");
    }
    if (data == nullptr && count > 0) throw InvalidOptions(what() + ": its pointer is null");
    if (stride < width) {
        throw InvalidOptions(what() + ": its stride is " + std::to_string(stride) + "; give " +
                             std::to_string(width) + " or more");
    }
}

void checkView(char const* name, PointView<float> const& view, std::size_t wanted, char const* element) {
    std::string const what = name;
    if (view.size() != wanted) {
        throw InvalidOptions(what + " has " + std::to_string(view.size()) + " elements; the table needs " +
                             std::to_string(wanted) + ", one per " + element);
    }
    if (view.size() > 0 && view.data() == nullptr) throw InvalidOptions(what + ": its pointer is null");
    if (view.stride() < 3) {
        throw InvalidOptions(what + ": its stride is " + std::to_string(view.stride()) + "; give 3 or more");
    }
}

}  // namespace

struct ShadingEvaluator::Impl : TileFrames {
    using TileFrames::TileFrames;
};

ShadingEvaluator::ShadingEvaluator(ShadingTable const& table, EvaluatorOptions const& options) {
    int numThreads = options.numThreads;
    if (numThreads < 0) {
        throw InvalidOptions("numThreads is " + std::to_string(numThreads) + "; it must be 0 or more");
    }
    if (numThreads == 0) numThreads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    PatchKernels const* const kernels = FindKernels(options.instructionSet);
    if (kernels == nullptr) {
        throw InvalidOptions(
            "this build or this processor does not have the instruction set asked for; use "
            "InstructionSet::Best");
    }
    _impl = std::make_unique<Impl>(table.SharedData(), kernels, std::make_shared<FrameThreads>(numThreads));
}

ShadingEvaluator::~ShadingEvaluator() = default;
ShadingEvaluator::ShadingEvaluator(ShadingEvaluator&&) noexcept = default;
ShadingEvaluator& ShadingEvaluator::operator=(ShadingEvaluator&&) noexcept = default;

FrameReport ShadingEvaluator::Evaluate(PointView<float> controlPoints, ShadingOutputs const& outputs) {
    return Evaluate(controlPoints, {}, outputs);
}

FrameReport ShadingEvaluator::Evaluate(PointView<float> controlPoints, PointView<float> userNormals,
                                       ShadingOutputs const& outputs) {
    TableMesh const& mesh = _impl->data->mesh;
    checkView("controlPoints", controlPoints, index(mesh.numVertices), "control vertex");
    bool const isUser = _impl->data->options.startNormals.kind == StartNormalKind::User;
    if (isUser) {
        bool const isPerVertex = userNormals.size() == index(mesh.numVertices);
        checkView("userNormals", userNormals, isPerVertex ? userNormals.size() : mesh.faceVertices.size(),
                  "control vertex or face corner");
    } else if (!userNormals.empty()) {
        throw InvalidOptions("userNormals are given, but the table's start normals are not StartNormalKind::User");
    }
    auto const numValues = index(_impl->data->numValues);
    auto const checkPoints = [&](char const* name, PointSpan const& span) {
        checkSpan(name, span.data, span.count, span.stride, 3, numValues);
    };
    checkPoints("positions", outputs.positions);
    checkPoints("blendedNormals", outputs.blendedNormals);
    checkPoints("limitNormals", outputs.limitNormals);
    checkPoints("subdividedNormals", outputs.subdividedNormals);
    checkPoints("du", outputs.du);
    checkPoints("dv", outputs.dv);
    checkSpan("blendWeights", outputs.blendWeights.data, outputs.blendWeights.count, outputs.blendWeights.stride, 1,
              numValues);
    return _impl->evaluate(controlPoints, userNormals, outputs);
}

char const* ShadingEvaluator::InstructionSetName() const { return _impl->kernels->name; }

}  // namespace v1
}  // namespace osd_shading
