// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <memory>
#include <mutex>
#include <unordered_map>
#include <vector>

#include "osd_shading/limitMasks.h"
#include "osd_shading/tables/tableData.h"
#include "osd_shading/tables/tileRing.h"

namespace osd_shading {
inline namespace v1 {
namespace tables {

/// The limit normal of one value in double precision, by subdividing down to the faces round it: for those whose
/// tangents vanish or nearly do.
class ExactNormal {
public:
    /// `ring`: the faces round a tile's face, by vertices of the control mesh (`ring.vertices`).
    ExactNormal(TileRing ring, SubdivisionRules const& rules, LimitNormalKind kind, int level,
                GridPoint const& point);

    /// N_L; zero where no face round the value has an area.
    Vec3<double> Find(PointView<float> controlPoints) const;

private:
    void refine(RefinedTopology const& topology, int level, std::vector<int> const& picked);

    std::vector<int> _vertices;  // control vertices
    std::vector<double> _rows;   // of the points round the value, by control vertex
    std::unique_ptr<RefinedTopology> _topology;
    std::unique_ptr<CreaseRegions> _regions;
    std::unique_ptr<LimitStep<double>> _step;
    int _value = 0;
};

/// Makes those of a table's values when they are first asked for, and keeps some thousand of them.
class ExactNormals {
public:
    /// `data` must outlive this object.
    explicit ExactNormals(TableData const& data);

    /// N_L of the table's value `value` (in Tiles order), one of tile `tile`.
    Vec3<double> Find(int tile, int value, PointView<float> controlPoints);

private:
    TileRing findRing(int tile) const;

    TableData const& _data;
    std::vector<int> _vertexFaceOffsets, _vertexFaces;
    std::mutex _mutex;
    std::unordered_map<int, std::unique_ptr<ExactNormal const>> _known;
};

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
