// SPDX-License-Identifier: Apache-2.0
#include "openSubdivFrames.h"

#include <opensubdiv/far/stencilTableFactory.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/osd/cpuEvaluator.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "limitLocations.h"
#include "openSubdivAlone.h"
#include "stopwatch.h"

namespace perf {

namespace {

namespace Osd = OpenSubdiv::OPENSUBDIV_VERSION::Osd;

int width(OpenSubdivForm form) { return form == OpenSubdivForm::FusedThree ? 3 : 4; }

Osd::BufferDescriptor descriptor(int numFloats) { return {0, numFloats, numFloats}; }

/// One location array per ptex face, which is how the factory likes them best.
Far::LimitStencilTableFactory::LocationArrayVec locationArrays(LimitLocations const& locations) {
    Far::LimitStencilTableFactory::LocationArrayVec arrays;
    for (std::size_t begin = 0, end = 0; begin < locations.Size(); begin = end) {
        while (end < locations.Size() && locations.ptexFaces[end] == locations.ptexFaces[begin]) ++end;
        Far::LimitStencilTableFactory::LocationArray array;
        array.ptexIdx = locations.ptexFaces[begin];
        array.numLocations = static_cast<int>(end - begin);
        array.s = &locations.u[begin];
        array.t = &locations.v[begin];
        arrays.push_back(array);
    }
    return arrays;
}

std::unique_ptr<Far::LimitStencilTable const> buildTable(Far::TopologyRefiner& refiner,
                                                         Far::LimitStencilTableFactory::LocationArrayVec const& at,
                                                         int level) {
    Far::TopologyRefiner::AdaptiveOptions options(level);
    options.useInfSharpPatch = true;
    refiner.RefineAdaptive(options);
    return std::unique_ptr<Far::LimitStencilTable const>(Far::LimitStencilTableFactory::Create(refiner, at));
}

}  // namespace

char const* FormName(OpenSubdivForm form) {
    switch (form) {
        case OpenSubdivForm::FusedThree:
            return "fused, length 3";
        case OpenSubdivForm::FusedFour:
            return "fused, length 4";
        case OpenSubdivForm::ThreeCalls:
            return "three calls, length 4";
    }
    return "";
}

OpenSubdivFrames::OpenSubdivFrames(MovingMesh const& moving, int level) {
    osd_shading::ControlMesh const mesh = moving.Mesh();
    // The locations are ours; a user would have them.
    LimitLocations const locations = UniformLocations(*MakeRefiner(mesh), level);
    auto const arrays = locationArrays(locations);
    double const start = ThreadSeconds();
    std::unique_ptr<Far::TopologyRefiner> const refiner = MakeRefiner(mesh);
    _table = buildTable(*refiner, arrays, level);
    _buildSeconds = ThreadSeconds() - start;

    // The factory leaves out locations where it finds no patch, in silence.
    _numVertices = locations.Size();
    if (!_table || static_cast<std::size_t>(_table->GetNumStencils()) != _numVertices) {
        throw std::runtime_error("OpenSubdiv's limit table lacks some of " + std::to_string(_numVertices) +
                                 " locations");
    }
    for (std::vector<float>* const values : {&_positions, &_du, &_dv, &_subdivided})
        values->resize(4 * _numVertices);
    _normals.resize(3 * _numVertices);
    _weights.assign(_numVertices, 0.5f);
}

void OpenSubdivFrames::EvaluateLimits(ControlPoints const& points, OpenSubdivForm form) {
    Osd::BufferDescriptor const layout = descriptor(width(form));
    float const* const source = width(form) == 3 ? points.three.data() : points.four.data();
    int const* const sizes = _table->GetSizes().data();
    int const* const offsets = _table->GetOffsets().data();
    int const* const indices = _table->GetControlIndices().data();
    int const end = _table->GetNumStencils();
    if (form == OpenSubdivForm::ThreeCalls) {
        Osd::CpuEvaluator::EvalStencils(source, layout, _positions.data(), layout, sizes, offsets, indices,
                                        _table->GetWeights().data(), 0, end);
        Osd::CpuEvaluator::EvalStencils(source, layout, _du.data(), layout, sizes, offsets, indices,
                                        _table->GetDuWeights().data(), 0, end);
        Osd::CpuEvaluator::EvalStencils(source, layout, _dv.data(), layout, sizes, offsets, indices,
                                        _table->GetDvWeights().data(), 0, end);
    } else {
        Osd::CpuEvaluator::EvalStencils(source, layout, _positions.data(), layout, _du.data(), layout, _dv.data(),
                                        layout, sizes, offsets, indices, _table->GetWeights().data(),
                                        _table->GetDuWeights().data(), _table->GetDvWeights().data(), 0, end);
    }
}

void OpenSubdivFrames::ComputeNormals(OpenSubdivForm form) {
    auto const stride = static_cast<std::size_t>(width(form));
    for (std::size_t i = 0; i < _numVertices; ++i) {
        float const *const a = &_du[stride * i], *const b = &_dv[stride * i];
        float const x = a[1] * b[2] - a[2] * b[1];
        float const y = a[2] * b[0] - a[0] * b[2];
        float const z = a[0] * b[1] - a[1] * b[0];
        float const length = std::sqrt(x * x + y * y + z * z);
        float const scale = length > 0 ? 1 / length : 0;
        _normals[3 * i] = scale * x;
        _normals[3 * i + 1] = scale * y;
        _normals[3 * i + 2] = scale * z;
    }
}

void OpenSubdivFrames::EvaluateTwice(ControlPoints const& points, std::vector<float> const& normals,
                                     OpenSubdivForm form) {
    EvaluateLimits(points, form);
    ComputeNormals(form);
    Osd::BufferDescriptor const layout = descriptor(4);
    Osd::CpuEvaluator::EvalStencils(normals.data(), layout, _subdivided.data(), layout, _table->GetSizes().data(),
                                    _table->GetOffsets().data(), _table->GetControlIndices().data(),
                                    _table->GetWeights().data(), 0, _table->GetNumStencils());
    for (std::size_t i = 0; i < _numVertices; ++i) {
        float const* const s = &_subdivided[4 * i];
        float const b = _weights[i];
        float* const n = &_normals[3 * i];
        float const x = (1 - b) * n[0] + b * s[0];
        float const y = (1 - b) * n[1] + b * s[1];
        float const z = (1 - b) * n[2] + b * s[2];
        float const length = std::sqrt(x * x + y * y + z * z);
        float const scale = length > 0 ? 1 / length : 0;
        n[0] = scale * x;
        n[1] = scale * y;
        n[2] = scale * z;
    }
}

std::size_t OpenSubdivFrames::NumBytes() const {
    return sizeof(int) *
               (_table->GetSizes().size() + _table->GetOffsets().size() + _table->GetControlIndices().size()) +
           sizeof(float) *
               (_table->GetWeights().size() + _table->GetDuWeights().size() + _table->GetDvWeights().size());
}

float OpenSubdivFrames::Extent(OpenSubdivForm form) const {
    float extent = 0;
    for (std::size_t i = 0; i < _numVertices; ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            extent = std::max(extent, std::abs(_positions[static_cast<std::size_t>(width(form)) * i + axis]));
        }
    }
    return extent;
}

}  // namespace perf
