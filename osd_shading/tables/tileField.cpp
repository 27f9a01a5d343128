// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/tables/tileField.h"

#include <algorithm>

namespace osd_shading {
inline namespace v1 {
namespace tables {

FieldStage MakeFieldStage(RegionLevels& levels, NeededRows const& values, int levelIndex) {
    Far::TopologyLevel const& level = levels.Level(levelIndex);
    Far::TopologyLevel const& parent = levels.Level(levelIndex - 1);
    CreaseRegions const& regions = levels.Regions(levelIndex);
    CreaseRegions const& parentRegions = levels.Regions(levelIndex - 1);
    bool const isCatmark = levels.Topology().IsCatmark();
    int const regularSize = isCatmark ? 4 : 3, numParentVertices = parent.GetNumVertices();
    int const firstFaceChild = levels.Topology().FirstFaceChild(levelIndex - 1);

    NeededLevel const& needed = values.Level(levelIndex);
    FieldStage stage;
    stage.offsets = needed.offsets;
    stage.terms = needed.terms;
    stage.weights = needed.weights;
    stage.isNearNgon.assign(needed.Size(), 0);
    stage.isVertexNearNgon.assign(needed.Size(), 0);
    stage.origins.assign(needed.Size(), FieldStage::kNew);
    for (std::size_t i = 0; i < needed.Size(); ++i) {
        int const vertex = needed.vertices[i];
        stage.kinds.push_back(regions.Kind(vertex));
        std::size_t const firstSeed = stage.seeds.size();
        Far::ConstIndexArray const faces = level.GetVertexFaces(vertex);
        Far::ConstLocalIndexArray const corners = level.GetVertexFaceLocalIndices(vertex);
        for (int j = 0; j < faces.size(); ++j) {
            // The face lies in a corner of its parent; in Loop one in the middle has no old vertex.
            int const parentFace = level.GetFaceParentFace(faces[j]);
            int const size = parent.GetFaceVertices(parentFace).size();
            bool const isInRegion = regions.CornerValue(faces[j], corners[j]) == needed.elements[i];
            if (isCatmark && size != regularSize) {
                stage.isVertexNearNgon[i] = 1;
                if (isInRegion) stage.isNearNgon[i] = 1;
            }
            if (!isInRegion) continue;
            int const corner = parent.GetFaceChildFaces(parentFace).FindIndex(faces[j]);
            if (corner >= size) continue;
            int const seed = values.IndexOf(levelIndex - 1, parentRegions.CornerValue(parentFace, corner));
            if (seed < 0) continue;
            if (std::find(stage.seeds.begin() + static_cast<std::ptrdiff_t>(firstSeed), stage.seeds.end(), seed) ==
                stage.seeds.end()) {
                stage.seeds.push_back(seed);
            }
            if (vertex < numParentVertices) stage.origins[i] = seed;
        }
        stage.seedOffsets.push_back(stage.seeds.size());
        if (isCatmark && vertex >= firstFaceChild && vertex < firstFaceChild + parent.GetNumFaces() &&
            parent.GetFaceVertices(vertex - firstFaceChild).size() != regularSize) {
            stage.origins[i] = FieldStage::kNgonCenter;
        }
    }
    return stage;
}

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
