// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "osd_shading/export.h"
#include "osd_shading/subdivisionShading.h"

namespace osd_shading {
inline namespace v1 {

/// One comparison with OpenSubdiv.
struct GeometryComparison {
    std::string name;           ///< "stencils", "limit", "bfr" or "limit_normals"
    std::int64_t total = 0;     ///< vertices (of all levels compared) that there are
    std::int64_t compared = 0;  ///< of them, those compared: where OpenSubdiv is exact
    double largest = 0;         ///< largest difference: share of the model's size; limit normals: radians
    int level = -1;             ///< where it is; -1: nothing was compared
    int vertex = -1;            ///< likewise: OpenSubdiv's number of it there
};

/// The largest differences between a result and OpenSubdiv's own numbers.
struct GeometryCheck {
    double modelSize = 0;                         ///< diagonal of the control points' bounding box
    std::vector<GeometryComparison> comparisons;  ///< one per name, in the order of that list

    /// Whether every position is within `tolerance` of the model's size and every limit normal within 1000 times
    /// `tolerance` radians.
    OSD_SHADING_API bool Passes(double tolerance) const;
};

/// Compares `result`, shaded from `mesh` and `positions`, with what OpenSubdiv computes by other routes:
///
/// "stencils"       refined positions of every level with `Far::StencilTable`
/// "limit"          limit positions with `Far::PrimvarRefiner::Limit`
/// "bfr"            limit positions with `Bfr::Surface` at the vertices of the last level
/// "limit_normals"  N_L with the tangents of `Far::PrimvarRefiner::Limit`, on the side of a crease that it gives
///
/// Left out, and so not counted in `compared`, is what OpenSubdiv computes only approximately: see the README.
/// COST: several times the shading itself.     ERRORS: as ShadeSubdivision; InvalidOptions when `result` has
/// other counts than `mesh` gives.
template <typename Real>
GeometryCheck CheckGeometry(ControlMesh const& mesh, PointView<Real> positions, ShadingResult<Real> const& result);

/// The same for a result that was shaded from a refiner.
template <typename Real>
GeometryCheck CheckGeometry(Far::TopologyRefiner const& refiner, PointView<Real> positions,
                            ShadingResult<Real> const& result);

#define OSD_SHADING_DECLARE(Real)                                                                             \
    extern template OSD_SHADING_API GeometryCheck CheckGeometry(ControlMesh const&, PointView<Real>,          \
                                                                ShadingResult<Real> const&);                  \
    extern template OSD_SHADING_API GeometryCheck CheckGeometry(Far::TopologyRefiner const&, PointView<Real>, \
                                                                ShadingResult<Real> const&);
OSD_SHADING_DECLARE(float)
OSD_SHADING_DECLARE(double)
#undef OSD_SHADING_DECLARE

}  // namespace v1
}  // namespace osd_shading
