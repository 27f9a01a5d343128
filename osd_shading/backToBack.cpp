// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/backToBack.h"

#include <algorithm>

#include "osd_shading/errors.h"

namespace osd_shading {
inline namespace v1 {

void RefuseBackToBack(Far::TopologyLevel const& level, std::string const& why) {
    for (int f = 0; f < level.GetNumFaces(); ++f) {
        Far::ConstIndexArray const edges = level.GetFaceEdges(f);
        if (edges.size() != 3) continue;
        int others[3] = {-1, -1, -1};
        for (int i = 0; i < 3; ++i) {
            Far::ConstIndexArray const faces = level.GetEdgeFaces(edges[i]);
            if (faces.size() != 2) continue;
            others[i] = faces[0] == f ? faces[1] : faces[0];
            if (std::count(others, others + i, others[i]) == 0) continue;
            throw InvalidControlMesh("faces " + std::to_string(f) + " and " + std::to_string(others[i]) +
                                     " share two edges, " + why + "; use ShadeSubdivision");
        }
    }
}

}  // namespace v1
}  // namespace osd_shading
