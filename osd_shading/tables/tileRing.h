// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "osd_shading/fieldRefiner.h"
#include "osd_shading/tables/faceGrid.h"

namespace osd_shading {
inline namespace v1 {
namespace tables {

/// The rules of refinement that a mesh and everything cut out of it share.
SubdivisionRules RulesOf(Far::TopologyRefiner const& refiner);

/// Whether an edge or vertex of sharpness `sharpness` is still sharp after `numLevels` more levels, whatever is
/// round it. Chaikin's rule mixes neighbours, so there only infinite sharpness is.
inline bool StaysSharp(float sharpness, int numLevels, bool isUniform) {
    return sharpness >= Sdc::Crease::SHARPNESS_INFINITE || (isUniform && sharpness > static_cast<float>(numLevels));
}

/// A face with all faces that share a vertex with it, as a mesh of its own: all that the surface over the face
/// depends on (with semi-sharp creases by Chaikin's rule the faces round those too). Faces and vertices are
/// numbered by a walk round the corners, so that equal neighbourhoods give equal meshes.
struct TileRing {
    int numVertices = 0;
    int tileFace = 0;
    bool isInLevelOrder = false;  ///< faces as the level has them, which matters here; not rotated
    std::vector<int> faceSizes, faceVertices;
    std::vector<int> creaseVertices, cornerVertices;
    std::vector<float> creaseSharpness, cornerSharpness;

    std::vector<int> vertices;      ///< of the level, by vertex of the ring
    std::vector<int> faces;         ///< of the level, by face of the ring
    std::vector<int> firstCorners;  ///< which corner of the level's face is the first of the ring's

    ControlMesh Mesh(SubdivisionRules const& rules) const;
    void AppendKey(std::vector<std::int32_t>& key) const;
    std::size_t NumBytes() const;
};

/// The hash of a key that AppendKey made, or of a longer one. FNV-1a.
struct KeyHash {
    std::size_t operator()(std::vector<std::int32_t> const& key) const;
};

/// FNV-1a.
std::uint64_t HashOf(void const* data, std::size_t size);

/// Enters the sharp edges between faces of a ring, with sharpness `sharpnessOf(edge of the level)`, sorted. Edges
/// of one face alone are boundaries in the ring's mesh as in the level, or lie at the ring's rim.
void AppendInnerCreases(Far::TopologyLevel const& level, std::function<float(int)> const& sharpnessOf,
                        TileRing& ring);

/// Finds the rings of a level's faces.
class TileRings {
public:
    /// `topology` must outlive this object.
    TileRings(RefinedTopology const& topology, int level);

    /// The ring of a face, whose corner `rotation` becomes corner 0. What stays sharp for `numLevels` levels more
    /// is entered as infinitely sharp.
    TileRing Find(int face, int rotation, int numLevels);

private:
    void add(TileRing& ring, int face, int firstCorner);
    bool hasFadingEdges(TileRing const& ring) const;
    void addSharpness(TileRing& ring, int face, int rotation, int numLevels) const;

    RefinedTopology const* _topology;
    Far::TopologyLevel const* _level;
    bool _isUniform;
    std::vector<int> _numberOfVertex;  // in the ring being built; -1: none
    std::vector<unsigned char> _isFaceInRing;
};

/// A refined mesh with the regions and masks of each level and the rings of its faces, found when they are asked
/// for.
class RegionLevels {
public:
    /// `topology` must outlive this object.
    explicit RegionLevels(RefinedTopology const& topology);

    RefinedTopology const& Topology() const { return *_topology; }
    Far::TopologyLevel const& Level(int level) const { return _topology->Level(level); }
    CreaseRegions const& Regions(int level);
    TileRings& Rings(int level);
    /// From `level - 1` to `level`.
    LevelMasks<double> const& Masks(int level);
    FieldStep<double> const& Step(int level);
    /// Whether values are vertices on all levels from 0 to `lastLevel`.
    bool HasOneValuePerVertex(int lastLevel);
    /// Memory of those who number some elements (values or vertices) of a level: -1 for each. To be left so.
    std::vector<int>& Slots(int level);
    int ValueAt(int level, FaceCorner const& at) { return Regions(level).CornerValue(at.face, at.corner); }

private:
    RefinedTopology const* _topology;
    std::vector<std::unique_ptr<CreaseRegions>> _regions;
    std::vector<std::unique_ptr<TileRings>> _rings;
    std::vector<std::unique_ptr<LevelMasks<double>>> _masks;
    std::vector<std::unique_ptr<FieldStep<double>>> _steps;
    std::vector<std::vector<int>> _slots;
};

/// Whether the ring of a face of a refined level, as a mesh of its own, is refined as it is there. It is not at
/// non-manifold creases: OpenSubdiv makes corners of the vertices of one that is a control mesh's.
bool IsRefinedAlike(RegionLevels& levels, int level, int face);

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
