// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <memory>
#include <vector>

#include "osd_shading/tables/tableData.h"

namespace osd_shading {
inline namespace v1 {
namespace tables {

/// Limit normals of single points in double precision, by subdividing round them: for those whose tangents vanish
/// or nearly do. Slow (some ten microseconds a point and level), and allocates.
class ExactNormals {
public:
    /// `data` must outlive this object.
    explicit ExactNormals(TableData const& data);

    /// N_L at a point of tile `tile`; zero where no face round it has an area.
    Vec3<double> Find(int tile, GridPoint const& point, PointView<float> controlPoints) const;

private:
    TableData const& _data;
    std::vector<int> _vertexFaceOffsets, _vertexFaces;
};

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
