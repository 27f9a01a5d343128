// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "osd_shading/shadingOptions.h"
#include "osd_shading/views.h"

namespace osd_shading {
inline namespace v1 {

/// Kinds of vertex at a level, in the order in which they are tested. Crease and corner vertices are *sharp*.
enum class VertexKind : std::uint8_t {
    Smooth,  ///< no sharp edge
    Dart,    ///< one
    Crease,  ///< two
    Corner   ///< three or more, or a sharpness of its own
};

/// What a vertex of the last level is, for display.
struct VertexTag {
    VertexKind kind = VertexKind::Smooth;  ///< at the last level
    bool isBoundary : 1;                   ///< on a boundary
    bool isExtraordinary : 1;              ///< by valence, sharp or not; isolated vertices are not
    bool isNonManifold : 1;                ///< read as infinitely sharp
    std::uint16_t valence = 0;             ///< number of edges

    VertexTag() : isBoundary(false), isExtraordinary(false), isNonManifold(false) {}
};

/// An edge of the last level that lies on an edge of the control mesh that is sharp or a boundary.
struct CreaseEdge {
    int vertices[2];         ///< its ends, vertices of the last level
    float controlSharpness;  ///< of the control edge; 10 is infinite (boundaries are)
    float sharpness;         ///< what is left of it at the last level
    bool isBoundary;         ///< one face lies along it
};

/// A vertex primvar at the last level: `width` numbers per vertex.
template <typename Real>
struct RefinedPrimvar {
    int width = 0;             ///< numbers per vertex
    std::vector<Real> values;  ///< width * number of vertices
};

/// A face-varying primvar at the last level.
template <typename Real>
struct RefinedFaceVarying {
    int width = 0;                 ///< numbers per value
    std::vector<Real> values;      ///< width * number of values
    std::vector<int> faceIndices;  ///< per face corner of the result's faces: index of a value
};

/// Counts and figures of one run; angles in degrees.
struct ShadingReport {
    std::int64_t vertices = 0;                          ///< of the last level, also isolated ones
    std::int64_t faces = 0;                             ///< without holes
    std::int64_t values = 0;                            ///< (vertex, region) pairs
    std::map<int, std::int64_t> extraordinary;          ///< interior, valence -> count
    std::map<int, std::int64_t> boundaryExtraordinary;  ///< boundary, valence -> count
    std::int64_t sharpVertices = 0;                     ///< crease and corner vertices at the last level
    std::int64_t darts = 0;                             ///< vertices where one sharp edge ends
    std::int64_t boundaryVertices = 0;                  ///< vertices on a boundary
    std::int64_t nonManifoldVertices = 0;               ///< read as infinitely sharp; without isolated ones
    std::int64_t nonManifoldEdges = 0;                  ///< read as infinitely sharp
    std::int64_t verticesWithWeight = 0;                ///< limit of b > 0 in any value
    std::int64_t subdividedValues = 0;                  ///< values whose N_S was computed at the last level
    std::int64_t zeroStartNormals = 0;                  ///< start normals whose sum vanished
    std::int64_t zeroNormals = 0;                       ///< values whose N_B is zero
    std::int64_t fallbackNormals =
        0;  ///< values whose limit tangents were degenerate, or that only N_S gave a normal
    std::int64_t averagedNormals =
        0;  ///< values that have no tangent plane, whose N_L is an average of face normals
    std::int64_t opposedNormals = 0;  ///< values with b > 0 and N_L . N_S < 0
    double minSubdividedLength = -1;  ///< smallest |N_S| before normalising where b > 0; -1: b > 0 nowhere
    double meanAngle = 0;             ///< between N_L and N_B, mean over the values
    double maxAngle = 0;              ///< the largest of them, 0 to 180
    std::int64_t maxAngleValue = -1;  ///< the value where it is largest; -1: there is no value
    std::vector<std::pair<std::string, double>> seconds;  ///< wall time of each stage, in order
};

/// The shaded mesh at the last level L.
///
/// A *value* is a (vertex, region) pair: one normal and one weight; a vertex has one value for each side of its
/// creases. Vertices have OpenSubdiv's order, values follow their vertices. Faces are quads (Catmull-Clark) or
/// triangles (Loop) in OpenSubdiv's order, holes left out.
template <typename Real>
struct ShadingResult {
    ShadingOptions options;  ///< as resolved: start levels are never kDefaultStartLevel
    int faceSize = 4;        ///< vertices of a face: 4 or 3

    std::vector<Vec3<Real>> positions;    ///< per vertex
    std::vector<VertexTag> vertexTags;    ///< per vertex
    std::vector<int> vertexValues;        ///< per vertex and one more: first value; isolated vertices have none
    std::vector<CreaseEdge> creaseEdges;  ///< of the last level

    std::vector<int> faceVertices;  ///< faceSize per face
    std::vector<int> faceValues;    ///< faceSize per face: the value of each corner
    std::vector<int> baseFaces;     ///< per face: face of the control mesh
    std::vector<int>
        refinerFaces;  ///< per face: OpenSubdiv's face at level L; empty without holes: the same number

    std::vector<int> valueVertices;             ///< per value: its vertex
    std::vector<Vec3<Real>> limitNormals;       ///< per value: N_L, unit length or zero
    std::vector<Vec3<Real>> subdividedNormals;  ///< per value: N_S, zero where b = 0
    std::vector<Vec3<Real>> blendedNormals;     ///< per value: N_B, unit length or zero
    std::vector<Real> blendWeights;             ///< per value: limit of b, in [0, 1]

    std::vector<RefinedPrimvar<Real>> vertexData;           ///< as ShadingInput::vertexData
    std::vector<RefinedFaceVarying<Real>> faceVaryingData;  ///< as ShadingInput::faceVaryingData

    ShadingReport report;  ///< counts, figures and times of the run

    /// Vertices of the last level, also isolated ones.
    int NumVertices() const { return static_cast<int>(positions.size()); }
    /// Faces of the last level, without holes.
    int NumFaces() const { return static_cast<int>(faceVertices.size()) / faceSize; }
    /// (vertex, region) pairs.
    int NumValues() const { return static_cast<int>(blendedNormals.size()); }
};

}  // namespace v1
}  // namespace osd_shading
