// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/tables/sharpSides.h"

namespace osd_shading {
inline namespace v1 {
namespace tables {

std::optional<unsigned> FindSharpSides(RegionLevels& levels, int levelIndex, int face, int k) {
    Far::TopologyLevel const& level = levels.Level(levelIndex);
    Far::ConstIndexArray const vertices = level.GetFaceVertices(face), edges = level.GetFaceEdges(face);
    if (vertices.size() != 4) return std::nullopt;
    bool const isUniform =
        levels.Topology().Refiner().GetSchemeOptions().GetCreasingMethod() == Sdc::Options::CREASE_UNIFORM;
    auto const stays = [&](int edge) { return StaysSharp(level.GetEdgeSharpness(edge), k, isUniform); };

    CreaseRegions const& regions = levels.Regions(levelIndex);
    unsigned sides = 0;
    for (int i = 0; i < 4; ++i) {
        if (!IsSharpEdge(level, edges[i])) continue;
        if (!stays(edges[i])) return std::nullopt;
        sides |= 1u << i;
    }
    for (int i = 0; i < 4; ++i) {
        int const v = vertices[i];
        if (level.IsVertexNonManifold(v)) return std::nullopt;
        Far::ConstIndexArray const faces = level.GetVertexFaces(v);
        if (levels.Topology().HasIrregularFaces(levelIndex)) {
            for (int const f : faces) {
                if (level.GetFaceVertices(f).size() != 4) return std::nullopt;
            }
        }
        bool const isAfter = (sides & (1u << i)) != 0, isBefore = (sides & (1u << ((i + 3) % 4))) != 0;
        VertexKind const kind = regions.Kind(v);
        if (!isAfter && !isBefore) {
            if (kind != VertexKind::Smooth || level.IsVertexBoundary(v) || faces.size() != 4) return std::nullopt;
            continue;
        }
        // A sharp vertex must stay what it is, and its region have the regular number of faces.
        bool const isCorner = isAfter && isBefore;
        if (kind != (isCorner ? VertexKind::Corner : VertexKind::Crease)) return std::nullopt;
        Far::ConstIndexArray const around = level.GetVertexEdges(v);
        int numStaying = 0;
        for (int const edge : around) {
            if (!IsSharpEdge(level, edge)) continue;
            if (!stays(edge)) return std::nullopt;
            ++numStaying;
        }
        if (isCorner && numStaying < 3 && !StaysSharp(level.GetVertexSharpness(v), k, isUniform))
            return std::nullopt;
        Far::ConstLocalIndexArray const corners = level.GetVertexFaceLocalIndices(v);
        int const value = regions.CornerValue(face, i);
        int numFaces = 0;
        for (int j = 0; j < faces.size(); ++j) numFaces += regions.CornerValue(faces[j], corners[j]) == value;
        if (numFaces != (isCorner ? 1 : 2)) return std::nullopt;
    }
    return sides;
}

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
