// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <opensubdiv/far/topologyRefiner.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "osd_shading/controlMesh.h"
#include "osd_shading/views.h"

namespace osd_shading {
inline namespace v1 {

namespace Far = OpenSubdiv::OPENSUBDIV_VERSION::Far;

/// A level's masks as OpenSubdiv computes them: each child vertex as a weighted sum.
///
/// A term refers to a parent vertex (>= 0) or, in Catmull-Clark, to the child vertex of a parent face (its
/// complement, < 0), so that the face-point structure of the scheme is kept.
template <typename Real>
struct LevelMasks {
    int numParentVertices = 0;
    int numChildVertices = 0;
    int numFaceChildren = 0;   ///< children of faces; they follow the parent's vertices
    std::vector<int> offsets;  ///< by row, and one more
    std::vector<int> terms;
    std::vector<Real> weights;

    /// OpenSubdiv visits the children of faces, then of edges, then of vertices: rows keep that order.
    int Row(int childVertex) const {
        return childVertex < numParentVertices ? childVertex + numChildVertices - numParentVertices
                                               : childVertex - numParentVertices;
    }
};

/// Which of OpenSubdiv's interpolations is recorded.
enum class MaskKind {
    Vertex,  ///< the scheme's own masks
    Varying  ///< bilinear
};

/// The refined levels of one control mesh. The only room that calls Far's factories.
///
/// Relies on the default order of child vertices: a vertex keeps its number, then come the children of the faces
/// (Catmull-Clark), then those of the edges.
class RefinedTopology {
public:
    /// Validates `mesh`; `faceVaryingIndices[i]` with `numFaceVaryingValues[i]` values becomes channel i.
    RefinedTopology(ControlMesh const& mesh, int level, std::vector<ArrayView<int>> const& faceVaryingIndices = {},
                    std::vector<int> const& numFaceVaryingValues = {});

    /// Shares level 0 of `base`, which must outlive this object.
    RefinedTopology(Far::TopologyRefiner const& base, int level);

    int LastLevel() const { return _lastLevel; }
    Sdc::SchemeType Scheme() const { return _refiner->GetSchemeType(); }
    bool IsCatmark() const { return Scheme() == Sdc::SCHEME_CATMARK; }
    Far::TopologyRefiner const& Refiner() const { return *_refiner; }
    Far::TopologyLevel const& Level(int level) const { return _levels[static_cast<std::size_t>(level)]; }

    /// Whether a face of level `level` may have another number of vertices than the scheme's own.
    bool HasIrregularFaces(int level) const { return level == 0 && _hasIrregularFaces; }

    /// The child vertex of face 0 at level `level`: those of the other faces follow.
    int FirstFaceChild(int level) const { return Level(level).GetNumVertices(); }

    /// Masks from `childLevel - 1` to `childLevel`.
    template <typename Real>
    LevelMasks<Real> RecordMasks(int childLevel, MaskKind kind = MaskKind::Vertex) const;

private:
    void refine(int level);

    std::unique_ptr<Far::TopologyRefiner> _refiner;
    std::vector<Far::TopologyLevel> _levels;
    int _lastLevel = 0;
    bool _hasIrregularFaces = false;
};

/// Throws MemoryLimitExceeded where the vertices of level 0 alone take more than `memoryLimit` bytes (0: no limit),
/// for doors that are given no points: a number of vertices that is a mistake takes no memory then.
void CheckVertexMemory(ControlMesh const& mesh, std::uint64_t memoryLimit);

/// Throws InvalidControlMesh unless level 0 of `refiner` keeps the conditions of a ControlMesh.
void ValidateRefiner(Far::TopologyRefiner const& refiner);

}  // namespace v1
}  // namespace osd_shading
