// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <utility>
#include <vector>

#include "osd_shading/creaseRegions.h"
#include "osd_shading/refinedTopology.h"

namespace osd_shading {
inline namespace v1 {

/// Marks of the values of a level that are needed; empty: all are.
using ValueMarks = std::vector<unsigned char>;

/// Sums over values of a level: row i holds what target `targets[i]` is made of. Targets ascend.
template <typename Real>
struct ValueRows {
    std::vector<int> targets;
    std::vector<std::size_t> offsets{0};  ///< a face of many corners near a crease makes rows as long
    std::vector<int> values;
    std::vector<Real> weights;

    /// Sets the targets that `marks` asks for, of type T (Real or Vec3<Real>).
    template <typename T>
    void Apply(std::vector<T> const& field, std::vector<T>& result, ValueMarks const& marks, int numThreads) const;

    /// Marks in `sources` the values of the rows of marked targets.
    void MarkSources(ValueMarks const& marks, ValueMarks& sources) const;

    /// Appends the terms (value, weight) of the row of `target`, which must have one.
    void AppendTerms(int target, std::vector<std::pair<int, Real>>& terms) const;
};

/// Restricts a mask over vertices to regions: the child-region rule.
///
///     n(c, R') = sum_i w_i * mean, over those f in F that hold v_i, of n(v_i, reg(f))
///
/// F: the parents of the faces in R'.   [ZBK23] Sec. 3.2, as a rule for every case
template <typename Real>
class RegionRule {
public:
    RegionRule(Far::TopologyLevel const& level, CreaseRegions const& regions);

    void Clear();
    void AddVertex(int vertex, Real weight);
    /// The average of a face's corners.
    void AddFace(int face, Real weight);

    /// Appends to `rows` the row of `target` over the faces `faces` (repeats count once).
    void AppendRow(int target, std::vector<int>& faces, ValueRows<Real>& rows);

private:
    Far::TopologyLevel const& _level;
    CreaseRegions const& _regions;
    std::vector<int> _slotOfVertex;  // -1: not in the mask
    std::vector<int> _slotOfValue;   // -1: not in the row
    std::vector<int> _vertices;
    std::vector<Real> _weights;
    std::vector<int> _counts;
    std::vector<std::pair<int, int>> _found;  // slot of the vertex, value
};

/// The step of a field of one number per value from a level to the next.
template <typename Real>
class FieldStep {
public:
    /// All arguments must outlive the step.
    FieldStep(RefinedTopology const& topology, int childLevel, LevelMasks<Real> const& masks,
              CreaseRegions const& parent, CreaseRegions const& child, int numThreads);

    /// Refines values of type T (Real or Vec3<Real>), where `marks` asks for them. Others are left as they are.
    template <typename T>
    void Apply(std::vector<T> const& parentField, std::vector<T>& childField, ValueMarks const& marks,
               int numThreads) const;

    /// Adds to `childMarks` the face points that marked values need, and marks in `parentMarks` all that they need.
    void MarkSources(ValueMarks& childMarks, ValueMarks& parentMarks) const;

    /// Appends the terms (parent value, weight) of a child value's mask, face points expanded.
    void AppendTerms(int childVertex, int childValue, std::vector<std::pair<int, Real>>& terms) const;

    /// The same with face points as they are: a term < 0 is the complement of a child value.
    void AppendMaskTerms(int childVertex, int childValue, std::vector<std::pair<int, Real>>& terms) const;

    CreaseRegions const& Parent() const { return *_parent; }
    CreaseRegions const& Child() const { return *_child; }

private:
    template <typename T>
    T sumOfMask(int childVertex, std::vector<T> const& parentField, std::vector<T> const& childField) const;

    RefinedTopology const* _topology;
    int _childLevel;
    LevelMasks<Real> const* _masks;
    CreaseRegions const* _parent;
    CreaseRegions const* _child;
    ValueRows<Real> _special;               // values whose mask needs a choice of region
    std::vector<unsigned char> _isSpecial;  // per child vertex; empty: none is
};

/// Refines one point per vertex by a level's masks.
template <typename Real>
std::vector<Vec3<Real>> RefinePoints(LevelMasks<Real> const& masks, std::vector<Vec3<Real>> const& points,
                                     int numThreads);

/// Regions, masks and steps of the levels that fields are refined through.
template <typename Real>
class FieldLevels {
public:
    /// Regions of `firstLevel` to the last, and the steps between them. `topology` must outlive this object.
    FieldLevels(RefinedTopology const& topology, int firstLevel, int numThreads);

    int FirstLevel() const { return _firstLevel; }
    CreaseRegions const& Regions(int level) const { return _regions[index(level)]; }
    /// From `level - 1` to `level`.
    LevelMasks<Real> const& Masks(int level) const { return _masks[index(level) - 1]; }
    FieldStep<Real> const& Step(int level) const { return _steps[index(level) - 1]; }

private:
    std::size_t index(int level) const { return static_cast<std::size_t>(level - _firstLevel); }

    int _firstLevel;
    std::vector<CreaseRegions> _regions;
    std::vector<LevelMasks<Real>> _masks;
    std::vector<FieldStep<Real>> _steps;
};

}  // namespace v1
}  // namespace osd_shading
