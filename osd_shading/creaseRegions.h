// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <vector>

#include "osd_shading/refinedTopology.h"
#include "osd_shading/shadingResult.h"

namespace osd_shading {
inline namespace v1 {

/// Whether an edge of `level` is sharp there: by its sharpness, which OpenSubdiv sets to infinite on boundary and
/// non-manifold edges.
inline bool IsSharpEdge(Far::TopologyLevel const& level, int edge) { return level.GetEdgeSharpness(edge) > 0; }

/// One level's crease-aware face-varying channel: values are (vertex, region) pairs, and each face corner has one.
///
/// A region of a vertex is a maximal set of its faces joined by edges at it that are not sharp.
class CreaseRegions {
public:
    CreaseRegions(RefinedTopology const& topology, int level, int numThreads);

    int NumVertices() const { return static_cast<int>(_firstValues.size()) - 1; }
    int NumValues() const { return _firstValues.back(); }

    /// First value of a vertex; the others follow. Isolated vertices have none.
    int FirstValue(int vertex) const { return _firstValues[static_cast<std::size_t>(vertex)]; }
    int NumVertexValues(int vertex) const { return FirstValue(vertex + 1) - FirstValue(vertex); }
    /// Whether values are vertices: no vertex is isolated or has several regions.
    bool HasOneValuePerVertex() const { return _plainFaces.empty() && NumValues() == NumVertices(); }
    VertexKind Kind(int vertex) const { return _kinds[static_cast<std::size_t>(vertex)]; }
    bool IsSharp(int vertex) const { return Kind(vertex) >= VertexKind::Crease; }

    /// Values of the corners of a face, in its order.
    int const* FaceValues(int face) const { return _cornerValues.data() + cornerOffset(face); }

    /// The value of `vertex` that the corner `corner` of `face` (which is at it) belongs to.
    int CornerValue(int face, int corner) const { return FaceValues(face)[corner]; }

    /// Whether each vertex of a face has just one region, so that nothing needs to be chosen.
    bool IsPlainFace(int face) const { return _plainFaces.empty() || _plainFaces[static_cast<std::size_t>(face)]; }

    std::vector<int> const& FirstValues() const { return _firstValues; }
    std::vector<int> const& CornerValues() const { return _cornerValues; }

private:
    std::size_t cornerOffset(int face) const {
        return _faceOffsets.empty() ? static_cast<std::size_t>(face) * _faceSize
                                    : static_cast<std::size_t>(_faceOffsets[static_cast<std::size_t>(face)]);
    }

    std::vector<VertexKind> _kinds;
    std::vector<int> _firstValues;
    std::vector<int> _cornerValues;
    std::vector<int> _faceOffsets;           // only where faces differ in size
    std::vector<unsigned char> _plainFaces;  // empty: all are
    std::size_t _faceSize = 0;
};

/// The faces of one region at a vertex, counter-clockwise where `isOrdered`.
struct RegionFan {
    int value = 0;
    bool isClosed = false;   ///< a full ring without sharp edge
    bool isOrdered = false;  ///< false: a non-manifold region that no walk from edge to edge covers
    std::vector<int> faces;
    std::vector<int> corners;  ///< of the vertex in each face
};

/// The faces of each region of `vertex`, in the order of its values. Reuses the memory of `facesOfRegion`, which
/// may keep more entries than there are regions.
void FindRegionFaces(Far::TopologyLevel const& level, CreaseRegions const& regions, int vertex,
                     std::vector<std::vector<int>>& facesOfRegion);

/// The regions of `vertex` as fans, in the order of its values. Reuses the memory of `fans`.
void FindRegionFans(Far::TopologyLevel const& level, CreaseRegions const& regions, int vertex,
                    std::vector<RegionFan>& fans);

}  // namespace v1
}  // namespace osd_shading
