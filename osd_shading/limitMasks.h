// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "osd_shading/creaseRegions.h"
#include "osd_shading/fieldRefiner.h"
#include "osd_shading/shadingOptions.h"

namespace osd_shading {
inline namespace v1 {

/// The limit masks of a fan of faces: the weights of position, first and second tangent.
template <typename Real>
struct LimitMask {
    struct Weights {
        Real position = 0, tangent1 = 0, tangent2 = 0;
    };
    Weights vertex;
    std::vector<Weights> edges;  ///< far ends of the fan's edges, counter-clockwise
    std::vector<Weights> faces;  ///< opposite vertices of its quads; empty in Loop
    Real tangentNorms = 0;       ///< product of the tangent masks' lengths, without the vertex
    bool hasTangents = true;     ///< false: no tangent plane exists; their weights mean nothing

    std::vector<Real> positions;  ///< position weights alone, in the order of a RingView
};

/// The masks of every fan that a level holds: full rings, and fans between two sharp edges. They are OpenSubdiv's
/// [Sdc::Scheme]; with LimitNormalKind::Exact, where those are not the limit of its rules, exact ones.
template <typename Real>
class LimitMasks {
public:
    LimitMasks(RefinedTopology const& topology, int level, CreaseRegions const& regions, LimitNormalKind kind);

    LimitMask<Real> const& Ring(int numFaces) const { return *_rings[static_cast<std::size_t>(numFaces)]; }
    LimitMask<Real> const& Fan(int numFaces) const { return *_fans[static_cast<std::size_t>(numFaces)]; }
    /// Of a ring whose edge 0 is sharp; null: that of any ring.
    LimitMask<Real> const* Dart(int numFaces) const {
        auto const i = static_cast<std::size_t>(numFaces);
        return i < _darts.size() ? _darts[i].get() : nullptr;
    }

private:
    std::vector<std::unique_ptr<LimitMask<Real>>> _rings, _fans, _darts;
};

/// The face of a dart's ring that its sharp edge leads, as a number among the vertex's faces; -1 where these make
/// no ring.
int FindDartStart(Far::TopologyLevel const& level, int vertex);

/// The neighbours of one vertex in the order in which masks sum them: vertices opposite in quads, then the far ends
/// of edges.
struct RingView {
    int const* vertices;
    int size;
};

/// The neighbours of a fan's vertex among its faces, in that order. Reuses the memory of `neighbors`.
void GatherFan(Far::TopologyLevel const& level, RegionFan const& fan, bool isCatmark, std::vector<int>& neighbors);

/// The limit step at one level: what is sharp there counts as infinitely sharp.
template <typename Real>
class LimitStep {
public:
    /// All arguments must outlive the step.
    LimitStep(RefinedTopology const& topology, int level, CreaseRegions const& regions, int numThreads,
              LimitNormalKind kind = LimitNormalKind::Limit);

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

    /// Appends the terms (vertex, weight) of the limit position of `vertex`.
    void AppendVertexTerms(int vertex, std::vector<std::pair<int, Real>>& terms) const;

    /// The neighbours that the limit position of `vertex` is made of: the whole ring of a smooth vertex or dart,
    /// the far ends of its two sharp edges on a crease, none at a corner.
    RingView Ring(int vertex) const {
        auto const v = static_cast<std::size_t>(vertex);
        return {_ringVertices.data() + _ringOffsets[v], static_cast<int>(_ringOffsets[v + 1] - _ringOffsets[v])};
    }
    /// The mask of a whole ring. REQUIRES: `vertex` is smooth or a dart, and not isolated.
    LimitMask<Real> const& RingMask(int vertex) const {
        int const size = Ring(vertex).size, numFaces = _isCatmark ? size / 2 : size;
        if (_regions->Kind(vertex) == VertexKind::Dart) {
            LimitMask<Real> const* const dart = _masks.Dart(numFaces);
            if (dart != nullptr && FindDartStart(*_level, vertex) >= 0) return *dart;
        }
        return _masks.Ring(numFaces);
    }

    LimitMasks<Real> const& Masks() const { return _masks; }
    CreaseRegions const& Regions() const { return *_regions; }
    RefinedTopology const& Topology() const { return *_topology; }
    Far::TopologyLevel const& Level() const { return *_level; }

private:
    void gatherRings(int numThreads);
    /// Calls `visit(vertex, weight)` for each term of a vertex's limit position.
    template <typename Visit>
    void forEachVertexTerm(int vertex, Visit const& visit) const;
    bool isSpecial(int vertex) const { return !_isSpecial.empty() && _isSpecial[static_cast<std::size_t>(vertex)]; }

    RefinedTopology const* _topology;
    Far::TopologyLevel const* _level;
    CreaseRegions const* _regions;
    LimitMasks<Real> _masks;
    bool _isCatmark;
    // Every limit and every normal asks for these: gathered once.
    std::vector<std::uint32_t> _ringOffsets;  // by vertex, and one more
    std::vector<int> _ringVertices;
    ValueRows<Real> _special;
    std::vector<unsigned char> _isSpecial;  // per vertex; empty: none is
};

}  // namespace v1
}  // namespace osd_shading
