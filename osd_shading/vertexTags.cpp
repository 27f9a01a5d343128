// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/vertexTags.h"

#include <algorithm>
#include <vector>

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

VertexKind KindBelow(RefinedTopology const& topology, int levelIndex, int vertex, int numLevels) {
    Far::TopologyLevel const& level = topology.Level(levelIndex);
    Sdc::Crease const crease(topology.Refiner().GetSchemeOptions());
    float atVertex = level.GetVertexSharpness(vertex);
    std::vector<float> sharpness;
    for (int const edge : level.GetVertexEdges(vertex)) sharpness.push_back(level.GetEdgeSharpness(edge));
    int const numEdges = static_cast<int>(sharpness.size());
    std::vector<float> below(sharpness.size());
    for (int i = 0; i < numLevels; ++i) {
        atVertex = crease.SubdivideVertexSharpness(atVertex);
        crease.SubdivideEdgeSharpnessesAroundVertex(numEdges, sharpness.data(), below.data());
        sharpness.swap(below);
    }
    return KindOf(crease.DetermineVertexVertexRule(atVertex, numEdges, sharpness.data()));
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
