// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "osd_shading/controlMesh.h"
#include "osd_shading/io/model.h"

namespace perf {

namespace Sdc = osd_shading::Sdc;

/// Control points as both kinds of frame want them.
struct ControlPoints {
    std::vector<float> three, four;  ///< 3 and 4 floats a point; the fourth is 0
};

/// A control mesh with the poses that its frames go through in turn.
class MovingMesh {
public:
    explicit MovingMesh(osd_shading::io::Model model, Sdc::SchemeType scheme = Sdc::SCHEME_CATMARK);

    osd_shading::io::Model const& Model() const { return _model; }
    osd_shading::ControlMesh Mesh() const;
    bool IsLoop() const { return _scheme == Sdc::SCHEME_LOOP; }
    /// Vertices of the uniform mesh at `level`, or about as many: to see whether memory will do.
    double AboutVertices(int level) const;

    ControlPoints const& FirstPose() const { return _poses[0]; }
    /// The next pose, of a few that differ slightly: no frame finds its result there.
    ControlPoints const& NextPose();

private:
    osd_shading::io::Model _model;
    Sdc::SchemeType _scheme;
    std::vector<ControlPoints> _poses;
    std::size_t _next = 0;
};

}  // namespace perf
