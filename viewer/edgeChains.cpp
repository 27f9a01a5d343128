// SPDX-License-Identifier: Apache-2.0
#include "edgeChains.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

namespace osd_shading::viewer {

namespace {

int OtherEnd(EdgeKey const& edge, int vertex) { return edge[0] == vertex ? edge[1] : edge[0]; }

// The one other sharp edge at `vertex`, where there is just one.
std::optional<EdgeKey> AlongCrease(Creases const& creases, EdgeKey const& edge, int vertex) {
    std::optional<EdgeKey> next;
    for (auto const& [other, sharpness] : creases.edges) {
        bool const isHere = other[0] == vertex || other[1] == vertex;
        if (!isHere || !(sharpness > 0) || other == edge) continue;
        if (next) return std::nullopt;
        next = other;
    }
    return next;
}

// The edge across `vertex`: half a turn away from face to face, the vertices of which are in `spokes`.
std::optional<EdgeKey> AcrossVertex(io::Model const& model, EdgeKey const& edge, int vertex) {
    // Each face at the vertex joins two of its edges, known by their other ends.
    std::multimap<int, int> spokes;
    std::size_t first = 0;
    for (int size : model.faceSizes) {
        auto const count = static_cast<std::size_t>(size);
        for (std::size_t i = 0; i < count; ++i) {
            if (model.faceVertices[first + i] != vertex) continue;
            int const before = model.faceVertices[first + (i + count - 1) % count];
            int const after = model.faceVertices[first + (i + 1) % count];
            spokes.emplace(before, after);
            spokes.emplace(after, before);
        }
        first += count;
    }

    std::set<int> ends;
    for (auto const& spoke : spokes) ends.insert(spoke.first);
    bool const isEvenInside = ends.size() % 2 == 0 && std::all_of(ends.begin(), ends.end(),
                                                                  [&](int end) { return spokes.count(end) == 2; });
    if (!isEvenInside) return std::nullopt;

    int previous = -1, current = OtherEnd(edge, vertex);
    for (std::size_t step = 0; step < ends.size() / 2; ++step) {
        auto [begin, end] = spokes.equal_range(current);
        auto next = begin;
        if (next->second == previous) ++next;
        if (next == end) return std::nullopt;
        previous = current;
        current = next->second;
    }
    return MakeEdgeKey(vertex, current);
}

}  // namespace

std::vector<EdgeKey> ChainOf(io::Model const& model, Creases const& creases, EdgeKey const& start) {
    std::vector<EdgeKey> chain = {start};
    std::set<EdgeKey> seen = {start};
    bool const isCrease = creases.edges.count(start) > 0;
    for (int vertex : start) {
        EdgeKey edge = start;
        for (;;) {
            std::optional<EdgeKey> const next =
                isCrease ? AlongCrease(creases, edge, vertex) : AcrossVertex(model, edge, vertex);
            if (!next || !seen.insert(*next).second) break;
            chain.push_back(*next);
            edge = *next;
            vertex = OtherEnd(edge, vertex);
        }
    }
    return chain;
}

}  // namespace osd_shading::viewer
