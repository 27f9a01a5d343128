// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <cstdint>
#include <vector>

#include "osd_shading/tables/frameThreads.h"
#include "osd_shading/tables/tableData.h"

namespace osd_shading {
inline namespace v1 {
namespace tables {

/// The start normals of one frame, where they are averages of faces or the caller's: in double precision, as the
/// one-shot path has them.
class StartFrame {
public:
    /// `data` must outlive this object.
    explicit StartFrame(TableData const& data);

    /// Sets `normals`, one per start normal; returns how many are zero. `userNormals`: StartNormalKind::User only,
    /// one per control vertex or one per face corner.
    std::int64_t Compute(PointView<float> controlPoints, PointView<float> userNormals, FrameThreads& threads,
                         std::vector<LocalPoint>& normals);

private:
    TableData const& _data;
    std::vector<Vec3<double>> _points, _faceNormals;
};

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
