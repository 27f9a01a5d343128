// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/backToBack.h"

#include <algorithm>

namespace osd_shading {
inline namespace v1 {

std::vector<std::pair<int, int>> FindBackToBack(Far::TopologyLevel const& level) {
    std::vector<std::pair<int, int>> pairs;
    for (int f = 0; f < level.GetNumFaces(); ++f) {
        Far::ConstIndexArray const edges = level.GetFaceEdges(f);
        if (edges.size() != 3) continue;
        int others[3] = {-1, -1, -1};
        for (int i = 0; i < 3; ++i) {
            Far::ConstIndexArray const faces = level.GetEdgeFaces(edges[i]);
            if (faces.size() != 2) continue;
            others[i] = faces[0] == f ? faces[1] : faces[0];
            if (others[i] < f || std::count(others, others + i, others[i]) != 1) continue;
            pairs.emplace_back(f, others[i]);
        }
    }
    return pairs;
}

}  // namespace v1
}  // namespace osd_shading
