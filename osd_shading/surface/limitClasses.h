// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <array>
#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "osd_shading/surface/regionRing.h"

namespace osd_shading {
inline namespace v1 {
namespace surface {

/// Sums over lines, appended to them in order: a row may name results of rows before it.
struct LineRows {
    std::vector<std::uint32_t> offsets{0};
    std::vector<std::uint32_t> sources;
    std::vector<double> weights;

    int NumRows() const { return static_cast<int>(offsets.size()) - 1; }
    void Add(std::uint32_t source, double weight) {
        sources.push_back(source);
        weights.push_back(weight);
    }
    void EndRow() { offsets.push_back(static_cast<std::uint32_t>(sources.size())); }
};

/// All faces of one neighbourhood in which nothing fades or is seeded any more. Its local lines are its inputs (the
/// values of its ring), then the results of its rows.
struct LimitClass {
    int numInputs = 0;
    LineRows rows;
    std::vector<std::uint32_t> patch;  ///< lines of its control points, where it is a regular patch
    std::uint16_t phantoms = 0;        ///< bit i: its control point i is no point of the mesh
    struct Child {
        LimitClass const* limitClass = nullptr;
        std::vector<std::uint32_t> inputs;  ///< its inputs among the local lines
    };
    std::array<Child, 4> children;  ///< where it is not

    bool IsRegular() const { return !patch.empty(); }
    int NumLines() const { return numInputs + rows.NumRows(); }
};

/// Finds the classes of faces, or makes them. Irregular ones come round to themselves after some levels: so there
/// are only as many as there are neighbourhoods.
class LimitClasses {
public:
    explicit LimitClasses(Sdc::SchemeType scheme) : _scheme(scheme) {}

    /// The class of a face, whose inputs are, in order, the values at `inputs` (corners of faces of its level).
    /// Not to be called by two threads at once; what it returned earlier may be used meanwhile.
    LimitClass const& Find(RegionLevels& levels, int level, int face, std::vector<FaceCorner>& inputs);

    std::size_t NumClasses() const { return _classOfKey.size(); }

private:
    struct Entry {
        LimitClass limitClass;
        std::vector<FaceCorner> inputs;  ///< corners of the ring's faces
        bool isMade = false, isBeingMade = false;
    };

    void make(TileRing const& ring, Entry& entry);

    Sdc::SchemeType _scheme;
    std::unordered_map<std::vector<std::int32_t>, std::unique_ptr<Entry>, tables::KeyHash> _classOfKey;
};

}  // namespace surface
}  // namespace v1
}  // namespace osd_shading
