// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "scene.h"

namespace osd_shading::viewer {

/// Collects from a result what drawing and picking need and what does not change while points move: triangles,
/// edges once each, and the curves of the control edges.
///
/// COST: linear in the faces.
template <typename Real>
std::shared_ptr<SurfaceTopology const> MakeSurfaceTopology(ShadingResult<Real>&& result, int numControlVertices);

extern template std::shared_ptr<SurfaceTopology const> MakeSurfaceTopology(ShadingResult<float>&&, int);
extern template std::shared_ptr<SurfaceTopology const> MakeSurfaceTopology(ShadingResult<double>&&, int);

}  // namespace osd_shading::viewer
