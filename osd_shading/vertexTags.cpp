// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/vertexTags.h"

#include <algorithm>

#include "osd_shading/extraordinaryVertices.h"

namespace osd_shading {
inline namespace v1 {

VertexKind KindOf(Sdc::Crease::Rule rule) {
    switch (rule) {
        case Sdc::Crease::RULE_CORNER:
            return VertexKind::Corner;
        case Sdc::Crease::RULE_CREASE:
            return VertexKind::Crease;
        case Sdc::Crease::RULE_DART:
            return VertexKind::Dart;
        default:
            return VertexKind::Smooth;
    }
}

VertexTag TagOf(bool isCatmark, Far::TopologyLevel const& level, int vertex) {
    VertexTag tag;
    tag.kind = KindOf(level.GetVertexRule(vertex));
    tag.valence = static_cast<std::uint16_t>(std::min(level.GetVertexEdges(vertex).size(), 65535));
    tag.isBoundary = level.IsVertexBoundary(vertex);
    tag.isExtraordinary = IsExtraordinary(isCatmark, level, vertex);
    tag.isNonManifold = level.IsVertexNonManifold(vertex) && level.GetVertexFaces(vertex).size() > 0;
    return tag;
}

void CountTag(VertexTag const& tag, ShadingReport& report) {
    if (tag.isExtraordinary) ++(tag.isBoundary ? report.boundaryExtraordinary : report.extraordinary)[tag.valence];
    report.sharpVertices += tag.kind >= VertexKind::Crease;
    report.darts += tag.kind == VertexKind::Dart;
    report.boundaryVertices += tag.isBoundary;
    report.nonManifoldVertices += tag.isNonManifold;
}

}  // namespace v1
}  // namespace osd_shading
