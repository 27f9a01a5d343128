// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "camera.h"
#include "osd_shading/controlMesh.h"
#include "osd_shading/shadingResult.h"
#include "viewOptions.h"

namespace osd_shading::viewer {

// What is shown, as plain data: nothing here knows of GL or of windows.

/// What the renderer calls a vertex: a (vertex, region) value of the result. Coordinates relative to Scene::origin.
struct SurfaceVertex {
    glm::vec3 position;
    glm::vec3 limitNormal, subdividedNormal, blendedNormal;
    float weight;
};

/// A control edge as a curve on the surface; from its first vertex to its second.
struct ControlCurve {
    std::array<int, 2> vertices;  ///< of the control mesh, the lower number first
    std::size_t first, count;     ///< its points in SurfaceTopology::curveValues
};

/// What stays while positions move.
struct SurfaceTopology {
    int faceSize = 4;
    std::vector<int> faceValues;  ///< faceSize per face
    std::vector<int> baseFaces;   ///< per face: of the control mesh
    std::vector<std::uint32_t> triangles;

    std::vector<int> valueVertices;  ///< per value: its vertex
    std::vector<int> vertexValues;   ///< per vertex and one more: first value; isolated vertices have none
    std::vector<VertexTag> vertexTags;
    std::vector<CreaseEdge> creaseEdges;

    std::vector<std::array<int, 2>> wires;  ///< edges of the result, as values
    std::vector<ControlCurve> curves;
    std::vector<int> curveValues;
    int numControlVertices = 0;
    bool hidesBackFaces = false;  ///< closed, and looks outwards: seen from outside, no back of a face is in sight

    std::size_t NumFaces() const { return baseFaces.size(); }
    int NumVertices() const { return static_cast<int>(vertexTags.size()); }
    int NumValues() const { return static_cast<int>(valueVertices.size()); }
    bool IsIsolated(int vertex) const { return FirstValue(vertex) == FirstValue(vertex + 1); }
    int FirstValue(int vertex) const { return vertexValues[static_cast<std::size_t>(vertex)]; }
};

/// The control mesh, to be drawn.
struct CageShape {
    std::vector<glm::vec3> points;
    std::vector<std::array<int, 2>> edges;
};

struct Scene {
    std::shared_ptr<SurfaceTopology const> topology;
    std::vector<SurfaceVertex> vertices;
    CageShape cage;
    glm::dvec3 origin{0};  ///< of all coordinates here, in the model's
    Sphere bounds;         ///< of the surface at rest

    ShadingOptions options;  ///< as resolved
    ShadingReport report;
    bool hasAllSubdivided = false;  ///< subdividedNormal is there also where the weight is 0
    double seconds = 0;             ///< from options to here

    glm::vec3 Position(int value) const { return vertices[static_cast<std::size_t>(value)].position; }
};

/// The normal of `vertex` that `choice` names; `Face` has none here.
inline glm::vec3 NormalOf(SurfaceVertex const& vertex, NormalChoice choice) {
    switch (choice) {
        case NormalChoice::Limit:
            return vertex.limitNormal;
        case NormalChoice::Subdivided:
            return vertex.subdividedNormal;
        case NormalChoice::Blended:
            return vertex.blendedNormal;
        case NormalChoice::Face:
            break;
    }
    return glm::vec3(0);
}

}  // namespace osd_shading::viewer
