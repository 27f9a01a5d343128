// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "osd_shading/views.h"

namespace osd_shading {
inline namespace v1 {

/// A face-varying primvar of the control mesh (UVs).
template <typename Real>
struct FaceVaryingView {
    ArrayView<int>
        indices;  ///< per face corner: a value. With a TopologyRefiner: empty, channel i is the refiner's
    PrimvarView<Real> values;  ///< what the indices name, of any width
};

/// The numbers on a control mesh. Views over the caller's memory; only `positions` is needed.
template <typename Real>
struct ShadingInput {
    PointView<Real> positions;  ///< one per control vertex, finite

    PointView<Real> vertexNormals;       ///< StartNormalKind::User: one per control vertex, or
    PointView<Real> faceVaryingNormals;  ///< one per face corner, in the order of the faces' vertices

    std::vector<PrimvarView<Real>> vertexData;           ///< refined as positions are
    std::vector<FaceVaryingView<Real>> faceVaryingData;  ///< refined by OpenSubdiv's face-varying rules;
                                                         ///< at level 0 they stay as they are
};

}  // namespace v1
}  // namespace osd_shading
