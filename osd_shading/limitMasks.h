// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <memory>
#include <utility>
#include <vector>

#include "osd_shading/creaseRegions.h"
#include "osd_shading/fieldRefiner.h"

namespace osd_shading {
inline namespace v1 {

/// OpenSubdiv's limit masks for a fan of faces: the weights of position, first and second tangent.
template <typename Real>
struct LimitMask {
    struct Weights {
        Real position = 0, tangent1 = 0, tangent2 = 0;
    };
    Weights vertex;
    std::vector<Weights> edges;  ///< far ends of the fan's edges, counter-clockwise
    std::vector<Weights> faces;  ///< opposite vertices of its quads; empty in Loop
    Real tangentNorms = 0;       ///< product of the tangent masks' lengths, without the vertex
};

/// The masks of every fan that a level holds: full rings, and fans between two sharp edges. [Sdc::Scheme]
template <typename Real>
class LimitMasks {
public:
    LimitMasks(RefinedTopology const& topology, int level, CreaseRegions const& regions);

    LimitMask<Real> const& Ring(int numFaces) const { return *_rings[static_cast<std::size_t>(numFaces)]; }
    LimitMask<Real> const& Fan(int numFaces) const { return *_fans[static_cast<std::size_t>(numFaces)]; }

private:
    std::vector<std::unique_ptr<LimitMask<Real>>> _rings, _fans;
};

/// The vertices round a vertex, or of a fan at it: far ends of edges, then vertices opposite in quads.
struct VertexRing {
    std::vector<int> edgeEnds;
    std::vector<int> faceOpposites;

    /// The whole ring of a manifold vertex, from OpenSubdiv's own start.
    void Gather(Far::TopologyLevel const& level, int vertex, bool isCatmark);
    void Gather(Far::TopologyLevel const& level, RegionFan const& fan, bool isCatmark);
};

/// The limit step at one level: what is sharp there counts as infinitely sharp.
template <typename Real>
class LimitStep {
public:
    /// All arguments must outlive the step.
    LimitStep(RefinedTopology const& topology, int level, CreaseRegions const& regions, int numThreads);

    /// Limit positions of all vertices.
    void ApplyToPoints(std::vector<Vec3<Real>> const& points, std::vector<Vec3<Real>>& limits,
                       int numThreads) const;

    /// The limit of a field of values of type T (Real or Vec3<Real>), by the same masks restricted to regions,
    /// where `marks` asks for it. Others are left as they are.
    template <typename T>
    void Apply(std::vector<T> const& field, std::vector<T>& limits, ValueMarks const& marks, int numThreads) const;

    /// Marks in `sources` all values that the limits of the values marked in `marks` need.
    void MarkSources(ValueMarks const& marks, ValueMarks& sources) const;

    /// Appends the terms (value, weight) of the limit of `value`, one of `vertex`.
    void AppendTerms(int vertex, int value, std::vector<std::pair<int, Real>>& terms) const;

    LimitMasks<Real> const& Masks() const { return _masks; }
    CreaseRegions const& Regions() const { return *_regions; }
    RefinedTopology const& Topology() const { return *_topology; }
    Far::TopologyLevel const& Level() const { return *_level; }

private:
    /// Calls `visit(vertex, weight)` for each term of a vertex's limit position.
    template <typename Visit>
    void forEachVertexTerm(int vertex, VertexRing& ring, Visit const& visit) const;
    bool isSpecial(int vertex) const { return !_isSpecial.empty() && _isSpecial[static_cast<std::size_t>(vertex)]; }

    RefinedTopology const* _topology;
    Far::TopologyLevel const* _level;
    CreaseRegions const* _regions;
    LimitMasks<Real> _masks;
    ValueRows<Real> _special;
    std::vector<unsigned char> _isSpecial;  // per vertex; empty: none is
};

}  // namespace v1
}  // namespace osd_shading
