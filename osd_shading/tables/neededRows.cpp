// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/tables/neededRows.h"

#include <algorithm>

namespace osd_shading {
inline namespace v1 {
namespace tables {

NeededRows::NeededRows(RegionLevels& levels, ElementKind kind, int firstLevel, int lastLevel,
                       std::vector<std::pair<int, int>> const& last)
    : _source(levels), _kind(kind), _firstLevel(firstLevel) {
    auto const numLevels = static_cast<std::size_t>(lastLevel - firstLevel + 1);
    _levels.resize(numLevels);
    for (std::size_t i = 0; i < numLevels; ++i) {
        _slots.push_back(&levels.Slots(firstLevel + static_cast<int>(i)));
    }
    addElements(lastLevel, last);
    for (int level = lastLevel - 1; level >= firstLevel; --level) {
        // What the rows of the level after name, in the order in which they do; their terms are elements so far.
        NeededLevel& after = _levels[static_cast<std::size_t>(level + 1 - firstLevel)];
        std::vector<int>& slots = *_slots[static_cast<std::size_t>(level - firstLevel)];
        std::vector<std::pair<int, int>> wanted;
        for (int const term : after.terms) {
            if (term < 0) continue;
            int& slot = slots[static_cast<std::size_t>(term)];
            if (slot >= 0) continue;
            slot = 0;
            wanted.emplace_back(term, vertexOf(level, term));
        }
        for (auto const& [element, vertex] : wanted) slots[static_cast<std::size_t>(element)] = -1;
        addElements(level, wanted);
        for (int& term : after.terms) {
            if (term >= 0) term = slots[static_cast<std::size_t>(term)];
        }
    }
}

NeededRows::~NeededRows() {
    for (std::size_t i = 0; i < _levels.size(); ++i) {
        for (int const element : _levels[i].elements) (*_slots[i])[static_cast<std::size_t>(element)] = -1;
    }
}

int NeededRows::vertexOf(int level, int element) const {
    CreaseRegions const& regions = _source.Regions(level);
    if (_kind == ElementKind::Vertex || regions.HasOneValuePerVertex()) return element;
    std::vector<int> const& first = regions.FirstValues();
    return static_cast<int>(std::upper_bound(first.begin(), first.end(), element) - first.begin() - 1);
}

/// The wanted elements and those of the same level that they are made of, these first.
void NeededRows::addElements(int level, std::vector<std::pair<int, int>> const& wanted) {
    NeededLevel& own = _levels[static_cast<std::size_t>(level - _firstLevel)];
    std::vector<int>& slots = *_slots[static_cast<std::size_t>(level - _firstLevel)];
    auto const add = [&](int element, int vertex) {
        slots[static_cast<std::size_t>(element)] = static_cast<int>(own.elements.size());
        own.elements.push_back(element);
        own.vertices.push_back(vertex);
    };
    if (level == _firstLevel) {
        for (auto const& [element, vertex] : wanted) add(element, vertex);
        return;
    }

    std::vector<std::pair<int, double>> terms;
    auto const findTerms = [&](int element, int vertex) {
        terms.clear();
        if (_kind == ElementKind::Value) {
            _source.Step(level).AppendMaskTerms(vertex, element, terms);
            return;
        }
        LevelMasks<double> const& masks = _source.Masks(level);
        auto const row = static_cast<std::size_t>(masks.Row(vertex));
        for (auto t = static_cast<std::size_t>(masks.offsets[row]);
             t < static_cast<std::size_t>(masks.offsets[row + 1]); ++t) {
            terms.emplace_back(masks.terms[t], masks.weights[t]);
        }
    };
    auto const append = [&](int element, int vertex) {
        add(element, vertex);
        for (auto const& [source, weight] : terms) {
            own.terms.push_back(source >= 0 ? source : ~slots[static_cast<std::size_t>(~source)]);
            own.weights.push_back(weight);
        }
        own.offsets.push_back(own.terms.size());
    };

    // First those made of the level before alone.
    own.elements.reserve(2 * wanted.size());
    own.vertices.reserve(2 * wanted.size());
    own.offsets.reserve(2 * wanted.size() + 1);
    own.terms.reserve(10 * wanted.size());
    own.weights.reserve(10 * wanted.size());
    std::vector<std::pair<int, int>> derived;
    auto const isOwn = [](auto const& term) { return term.first < 0; };
    for (auto const& [element, vertex] : wanted) {
        findTerms(element, vertex);
        if (std::any_of(terms.begin(), terms.end(), isOwn)) {
            derived.emplace_back(element, vertex);
        } else if (slots[static_cast<std::size_t>(element)] < 0) {
            append(element, vertex);
        }
    }
    std::vector<int> named;
    for (auto const& [element, vertexOfDerived] : derived) {
        findTerms(element, vertexOfDerived);
        named.clear();
        for (auto const& [source, weight] : terms) {
            if (source < 0 && slots[static_cast<std::size_t>(~source)] < 0) named.push_back(~source);
        }
        for (int const source : named) {
            int const vertex = vertexOf(level, source);
            findTerms(source, vertex);
            append(source, vertex);
        }
    }
    for (auto const& [element, vertex] : derived) {
        findTerms(element, vertex);
        append(element, vertex);
    }
}

FlatRows ComposeRows(NeededRows const& rows) {
    std::size_t const width = rows.Level(rows.FirstLevel()).Size();
    RowAdder sum(width);
    FlatRows composed;
    for (std::size_t i = 0; i < width; ++i) {
        composed.sources.push_back(static_cast<int>(i));
        composed.weights.push_back(1);
        composed.offsets.push_back(i + 1);
    }
    for (int level = rows.FirstLevel() + 1; level <= rows.LastLevel(); ++level) {
        NeededLevel const& needed = rows.Level(level);
        FlatRows next;
        next.offsets.reserve(needed.Size() + 1);
        next.sources.reserve(needed.Size() * std::min<std::size_t>(width, 16));
        next.weights.reserve(needed.Size() * std::min<std::size_t>(width, 16));
        for (std::size_t i = 0; i < needed.Size(); ++i) {
            for (std::size_t t = needed.offsets[i]; t < needed.offsets[i + 1]; ++t) {
                int const term = needed.terms[t];
                if (term >= 0) {
                    sum.AddRow(composed, static_cast<std::size_t>(term), needed.weights[t]);
                } else {
                    sum.AddRow(next, static_cast<std::size_t>(~term), needed.weights[t]);
                }
            }
            sum.MoveTo(next);
        }
        composed = std::move(next);
    }
    return composed;
}

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
