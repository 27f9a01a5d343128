// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opensubdiv/far/stencilTable.h>

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "movingMesh.h"

namespace perf {

namespace Far = OpenSubdiv::OPENSUBDIV_VERSION::Far;

/// How OpenSubdiv's evaluator is called.
enum class OpenSubdivForm {
    FusedThree,  ///< P, du, dv in one call, 3 floats a point
    FusedFour,   ///< the same with 4 floats a point
    ThreeCalls   ///< a call each, 4 floats a point
};
constexpr std::array<OpenSubdivForm, 3> kOpenSubdivForms = {OpenSubdivForm::FusedThree, OpenSubdivForm::FusedFour,
                                                            OpenSubdivForm::ThreeCalls};
char const* FormName(OpenSubdivForm form);

/// What to write today: a Far::LimitStencilTable at the vertices of the uniform mesh, Osd::CpuEvaluator for P, du
/// and dv, then cross products, normalised. One thread.
class OpenSubdivFrames {
public:
    /// Builds the table from a refiner isolated to `level`.
    OpenSubdivFrames(MovingMesh const& mesh, int level);

    /// P, du and dv.
    void EvaluateLimits(ControlPoints const& points, OpenSubdivForm form);
    /// The normals of what `EvaluateLimits` left.
    void ComputeNormals(OpenSubdivForm form);
    /// The naive way to shade: limits and normals; then the position weights once more on normals in place of
    /// points; then the blend of both. `normals` has 4 floats a control vertex.
    void EvaluateTwice(ControlPoints const& points, std::vector<float> const& normals, OpenSubdivForm form);

    std::size_t NumVertices() const { return _numVertices; }
    std::size_t NumBytes() const;
    double BuildSeconds() const { return _buildSeconds; }
    /// Largest distance from the origin along an axis of what `EvaluateLimits` left.
    float Extent(OpenSubdivForm form) const;

private:
    std::unique_ptr<Far::LimitStencilTable const> _table;
    std::size_t _numVertices = 0;
    double _buildSeconds = 0;
    std::vector<float> _positions, _du, _dv, _subdivided;  ///< 3 or 4 floats a vertex
    std::vector<float> _normals;                           ///< 3 floats a vertex
    std::vector<float> _weights;
};

}  // namespace perf
