// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/tables/tileOwnership.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace osd_shading {
inline namespace v1 {
namespace tables {

EdgeOwnership EdgeOwnership::Of(std::vector<bool> points) {
    auto const numOwned = std::count(points.begin(), points.end(), true);
    if (numOwned == 0) return None();
    if (numOwned == static_cast<std::ptrdiff_t>(points.size())) return All();
    return EdgeOwnership(Kind::Some, std::move(points));
}

EdgeOwnership EdgeOwnership::FirstHalf() const {
    if (_kind != Kind::Some) return *this;
    return Of({_points.begin(), _points.begin() + static_cast<std::ptrdiff_t>(_points.size() / 2)});
}

EdgeOwnership EdgeOwnership::SecondHalf() const {
    if (_kind != Kind::Some) return *this;
    return Of({_points.begin() + static_cast<std::ptrdiff_t>(_points.size() / 2 + 1), _points.end()});
}

void EdgeOwnership::AppendKey(std::vector<std::int32_t>& key) const {
    key.push_back(static_cast<std::int32_t>(_kind));
    std::int32_t word = 0;
    for (std::size_t i = 0; i < _points.size(); ++i) {
        word = word * 2 + _points[i];
        if (i % 16 == 15 || i + 1 == _points.size()) key.push_back(std::exchange(word, 0));
    }
}

TileOwnership TileOwnership::OfChild(int child, int k, bool isCatmark) const {
    std::size_t const size = edges.size(), i = static_cast<std::size_t>(child), last = i + size - 1;
    if (!isCatmark) {
        TileOwnership own(3);
        if (child == 3) {
            std::fill(own.edges.begin(), own.edges.end(), EdgeOwnership::All());
            return own;
        }
        // Child i keeps corner i; the middle of edge i is its next corner.
        std::size_t const before = last % 3, after = (i + 1) % 3;
        own.edges[i] = edges[i].FirstHalf();
        own.edges[before] = edges[before].SecondHalf();
        own.corners[i] = corners[i];
        own.corners[after] = edges[i].HasMiddle(k);
        return own;
    }
    // A quad's child i has the parent's corner as its corner i, an n-gon's as its corner 0; then come the middle of
    // edge i, the face point, and the middle of the edge before.
    std::size_t const first = size == 4 ? i : 0;
    auto const local = [&](std::size_t corner) { return (first + corner) % 4; };
    TileOwnership own(4);
    own.edges[local(0)] = edges[i].FirstHalf();
    own.edges[local(1)] = EdgeOwnership::All();
    own.edges[local(3)] = edges[last % size].SecondHalf();
    own.corners[local(0)] = corners[i];
    own.corners[local(1)] = edges[i].HasMiddle(k);
    own.corners[local(2)] = child == 0;
    return own;
}

TileOwnership TileOwnership::Rotated(int rotation) const {
    TileOwnership own = *this;
    std::rotate(own.edges.begin(), own.edges.begin() + rotation, own.edges.end());
    std::rotate(own.corners.begin(), own.corners.begin() + rotation, own.corners.end());
    return own;
}

bool TileOwnership::Has(int row, int column, int k, bool isCatmark) const {
    int const side = 1 << k;
    if (isCatmark) {
        bool const isLowRow = row == 0, isHighRow = row == side, isLow = column == 0, isHigh = column == side;
        if (isLowRow && isLow) return corners[0];
        if (isLowRow && isHigh) return corners[1];
        if (isHighRow && isHigh) return corners[2];
        if (isHighRow && isLow) return corners[3];
        if (isLowRow) return edges[0].Has(static_cast<std::size_t>(column - 1));
        if (isHigh) return edges[1].Has(static_cast<std::size_t>(row - 1));
        if (isHighRow) return edges[2].Has(static_cast<std::size_t>(side - column - 1));
        if (isLow) return edges[3].Has(static_cast<std::size_t>(side - row - 1));
        return true;
    }
    assert(row + column <= side);
    if (row == 0 && column == 0) return corners[0];
    if (column == side) return corners[1];
    if (row == side) return corners[2];
    if (row == 0) return edges[0].Has(static_cast<std::size_t>(column - 1));
    if (row + column == side) return edges[1].Has(static_cast<std::size_t>(row - 1));
    if (column == 0) return edges[2].Has(static_cast<std::size_t>(side - row - 1));
    return true;
}

void TileOwnership::AppendKey(std::vector<std::int32_t>& key) const {
    for (EdgeOwnership const& edge : edges) edge.AppendKey(key);
    for (bool const corner : corners) key.push_back(corner);
}

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
