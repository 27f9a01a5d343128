// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "osd_shading/controlMesh.h"
#include "osd_shading/views.h"

/// Subdivision in double, with plain loops and maps, from its definition: what the naive reference shades.
namespace naive {

using Vec3 = osd_shading::Vec3<double>;

constexpr float kInfinite = 10;  ///< OpenSubdiv's infinite sharpness

enum class Kind { Smooth, Dart, Crease, Corner };

/// Vertices of the level below and their weights; each vertex once.
using Mask = std::map<int, double>;

struct Edge {
    int vertices[2];
    std::vector<int> faces;
    float sharpness = 0;
    bool isNonManifold = false;
};

/// One level: M_l.
struct Level {
    std::vector<Vec3> positions;
    std::vector<std::vector<int>> faces;
    std::vector<char> isHole;
    std::vector<int> baseFaces;  ///< face of the control mesh
    std::vector<Edge> edges;
    std::vector<std::vector<int>> faceEdges;  ///< per face: the edge that leaves each corner
    std::vector<float> vertexSharpness;
    std::vector<char> isNonManifold;
    std::vector<std::vector<int>> vertexFaces, vertexEdges;  ///< ascending
    std::vector<Kind> kinds;

    // A value is a (vertex, region) pair.
    std::vector<std::vector<int>> faceValues;  ///< per face: the value of each corner
    std::vector<int> valueVertices;
    std::vector<std::vector<int>> valueFaces;

    // From the level below; empty at level 0.
    std::vector<Mask> masks;       ///< per vertex
    std::vector<Mask> flatMasks;   ///< the same, bilinear
    std::vector<int> parentFaces;  ///< per face
    std::vector<int> parents;      ///< per vertex: the vertex that it is the child of, or -1

    int NumVertices() const { return static_cast<int>(positions.size()); }
    int NumFaces() const { return static_cast<int>(faces.size()); }
    int NumValues() const { return static_cast<int>(valueVertices.size()); }
    int EdgeBetween(int a, int b) const;  ///< the first, where there are several
    bool IsBoundary(int vertex) const;
    bool IsSharp(int vertex) const { return kinds[static_cast<std::size_t>(vertex)] >= Kind::Crease; }
};

/// The levels 0 to `last` of a control mesh. Faces have OpenSubdiv's order and orientation at every level (holes
/// included); vertices have not: a level's vertices are the children of vertices, of edges and of faces.
struct Hierarchy {
    osd_shading::SubdivisionRules rules;
    std::vector<Level> levels;
};
Hierarchy Refine(osd_shading::ControlMesh const& mesh, osd_shading::PointView<double> const& positions, int last);

/// Limit position of every vertex of `level` (its own where it is isolated).
std::vector<Vec3> LimitPositions(osd_shading::SubdivisionRules const& rules, Level const& level);

// What the shading needs of this too.

/// An index into a vector.
inline std::size_t U(int i) { return static_cast<std::size_t>(i); }

inline Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator*(double s, Vec3 a) { return {s * a.x, s * a.y, s * a.z}; }

/// Whether the scheme is Loop's; it is Catmull-Clark's otherwise.
bool IsLoop(osd_shading::SubdivisionRules const& rules);

/// The corner of `face` that is `vertex`, or the number of corners where none is.
int PlaceOf(std::vector<int> const& face, int vertex);

/// The vertex `steps` corners after `vertex` in `face`.
int After(std::vector<int> const& face, int vertex, int steps = 1);

/// The end of `edge` that is not `vertex`.
int OtherEnd(Edge const& edge, int vertex);

/// Whether a vertex has another valence than a regular mesh's, inside or at a boundary.
bool IsExtraordinary(osd_shading::SubdivisionRules const& rules, Level const& m, int v);

/// The limit mask of a vertex; what is sharp counts as infinitely sharp.
Mask LimitMask(osd_shading::SubdivisionRules const& rules, Level const& m, int vertex);

}  // namespace naive
