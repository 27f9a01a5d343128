// SPDX-License-Identifier: Apache-2.0
#include "movingMesh.h"

#include <cmath>
#include <utility>

namespace perf {

namespace {

constexpr std::size_t kNumPoses = 4;

/// Bends the points by about a hundredth of their distance from the origin, times `amount`.
ControlPoints pose(std::vector<double> const& positions, double amount) {
    ControlPoints points;
    for (std::size_t i = 0; i + 2 < positions.size(); i += 3) {
        double const x = positions[i], y = positions[i + 1], z = positions[i + 2];
        double const angle = 0.01 * amount * std::atan(y);
        double const moved[3] = {std::cos(angle) * x - std::sin(angle) * z, y,
                                 std::sin(angle) * x + std::cos(angle) * z};
        for (double const coordinate : moved) {
            points.three.push_back(static_cast<float>(coordinate));
            points.four.push_back(static_cast<float>(coordinate));
        }
        points.four.push_back(0);
    }
    return points;
}

}  // namespace

MovingMesh::MovingMesh(osd_shading::io::Model model, Sdc::SchemeType scheme)
    : _model(std::move(model)), _scheme(scheme) {
    for (std::size_t i = 0; i < kNumPoses; ++i) _poses.push_back(pose(_model.positions, static_cast<double>(i)));
}

osd_shading::ControlMesh MovingMesh::Mesh() const {
    osd_shading::SubdivisionRules rules = _model.Rules({});
    rules.scheme = _scheme;
    return _model.Mesh(rules);
}

double MovingMesh::AboutVertices(int level) const {
    double const facesAtOne = IsLoop() ? 4.0 * _model.NumFaces() : static_cast<double>(_model.faceVertices.size());
    return std::ldexp(facesAtOne, 2 * (level - 1)) / (IsLoop() ? 2 : 1);
}

ControlPoints const& MovingMesh::NextPose() {
    _next = (_next + 1) % kNumPoses;
    return _poses[_next];
}

}  // namespace perf
