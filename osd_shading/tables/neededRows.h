// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <cstddef>
#include <utility>
#include <vector>

#include "osd_shading/tables/tileRing.h"

namespace osd_shading {
inline namespace v1 {
namespace tables {

/// Elements of a level: what a field has one of each.
enum class ElementKind { Vertex, Value };

/// The elements of a level that are needed, each as a sum.
struct NeededLevel {
    std::vector<int>
        elements;  ///< of the level; rows name those of the level before, and earlier ones of their own
    std::vector<int> vertices;  ///< of each
    std::vector<std::size_t> offsets{0};
    std::vector<int> terms;  ///< index among the needed of the level before; < 0: complement of one of this level
    std::vector<double> weights;

    std::size_t Size() const { return elements.size(); }
};

/// What some elements of a level are made of, level by level, from a first level on; nothing else is looked at.
class NeededRows {
public:
    /// `last`: elements of `lastLevel`, each with its vertex; they come first among the needed, in their order,
    /// except that elements which others are made of go before them. `levels` must outlive this object, and no
    /// other object of its kind may use them meanwhile.
    NeededRows(RegionLevels& levels, ElementKind kind, int firstLevel, int lastLevel,
               std::vector<std::pair<int, int>> const& last);
    ~NeededRows();
    NeededRows(NeededRows const&) = delete;
    NeededRows& operator=(NeededRows const&) = delete;

    int FirstLevel() const { return _firstLevel; }
    int LastLevel() const { return _firstLevel + static_cast<int>(_levels.size()) - 1; }
    NeededLevel const& Level(int level) const { return _levels[static_cast<std::size_t>(level - _firstLevel)]; }
    /// The index of an element among the needed; -1 where it is not.
    int IndexOf(int level, int element) const {
        return (*_slots[static_cast<std::size_t>(level - _firstLevel)])[static_cast<std::size_t>(element)];
    }

private:
    int vertexOf(int level, int element) const;
    void addElements(int level, std::vector<std::pair<int, int>> const& wanted);

    RegionLevels& _source;
    ElementKind _kind;
    int _firstLevel;
    std::vector<NeededLevel> _levels;
    std::vector<std::vector<int>*> _slots;
};

/// Sums over sources, one after another; sources of a row in no order.
struct FlatRows {
    std::vector<std::size_t> offsets{0};
    std::vector<int> sources;
    std::vector<double> weights;

    std::size_t Size() const { return offsets.size() - 1; }
};

/// One row while it is added up.
class RowAdder {
public:
    explicit RowAdder(std::size_t numSources)
        : _weights(numSources, 0.0), _isUsed(numSources <= kFewSources ? 0 : numSources, 0) {}

    void AddRow(FlatRows const& rows, std::size_t row, double weight) {
        std::size_t const end = rows.offsets[row + 1];
        if (_isUsed.empty()) {
            for (std::size_t t = rows.offsets[row]; t < end; ++t) {
                _weights[static_cast<std::size_t>(rows.sources[t])] += weight * rows.weights[t];
            }
            return;
        }
        for (std::size_t t = rows.offsets[row]; t < end; ++t) {
            auto const i = static_cast<std::size_t>(rows.sources[t]);
            if (!std::exchange(_isUsed[i], 1)) _used.push_back(rows.sources[t]);
            _weights[i] += weight * rows.weights[t];
        }
    }
    /// Appends the sum to `rows`, and starts anew.
    void MoveTo(FlatRows& rows) {
        if (_isUsed.empty()) {
            for (std::size_t i = 0; i < _weights.size(); ++i) {
                if (_weights[i] == 0) continue;
                rows.sources.push_back(static_cast<int>(i));
                rows.weights.push_back(_weights[i]);
                _weights[i] = 0;
            }
        }
        for (int const source : _used) {
            auto const i = static_cast<std::size_t>(source);
            rows.sources.push_back(source);
            rows.weights.push_back(_weights[i]);
            _weights[i] = 0;
            _isUsed[i] = 0;
        }
        rows.offsets.push_back(rows.sources.size());
        _used.clear();
    }

private:
    static constexpr std::size_t kFewSources = 64;  // as many are looked at sooner than listed

    std::vector<double> _weights;
    std::vector<unsigned char> _isUsed;  // empty with few sources
    std::vector<int> _used;
};

/// The needed elements of the last level as sums over those of the first, by index.
FlatRows ComposeRows(NeededRows const& rows);

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
