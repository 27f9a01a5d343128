// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <cstdint>
#include <utility>
#include <vector>

namespace osd_shading {
inline namespace v1 {
namespace tables {

/// Which of the 2^k - 1 points inside an edge of a tile the tile writes, from the edge's start to its end.
class EdgeOwnership {
public:
    EdgeOwnership() = default;
    static EdgeOwnership None() { return {}; }
    static EdgeOwnership All() { return EdgeOwnership(Kind::All, {}); }
    /// The points before the middle.
    static EdgeOwnership Half() { return EdgeOwnership(Kind::Half, {}); }
    static EdgeOwnership HalfAndMiddle() { return EdgeOwnership(Kind::HalfAndMiddle, {}); }
    /// One flag for each point.
    static EdgeOwnership Of(std::vector<bool> points);

    /// `k` is that of the edge.
    bool Has(int point, int k) const;

    /// The halves of the edge, and the point between them; k is 1 or more.
    EdgeOwnership FirstHalf() const;
    EdgeOwnership SecondHalf() const;
    bool HasMiddle(int k) const { return Has((1 << (k - 1)) - 1, k); }

    void AppendKey(std::vector<std::int32_t>& key) const;
    /// The same for equal ones, 0 to 7.
    int Sign() const { return static_cast<int>(_kind); }

private:
    enum class Kind : std::int32_t { None, All, Half, HalfAndMiddle, Some };
    EdgeOwnership(Kind kind, std::vector<bool> points) : _kind(kind), _points(std::move(points)) {}

    Kind _kind = Kind::None;
    std::vector<bool> _points;  // Some only
};

/// The points on its border that a tile writes; it writes all inside.
struct TileOwnership {
    std::vector<EdgeOwnership> edges;  ///< edge i leads from corner i to the next
    std::vector<bool> corners;

    explicit TileOwnership(std::size_t size = 0) : edges(size), corners(size, false) {}

    /// That of child `child` of a face of `edges.size()` corners, in the order of OpenSubdiv's children; what lies
    /// between the children is shared out. `k` is that of the face.
    TileOwnership OfChild(int child, int k, bool isCatmark) const;
    /// The same tile, beginning with its corner `rotation`.
    TileOwnership Rotated(int rotation) const;
    /// Whether the point at (row, column) of the tile's grid is written; rows and columns run to 2^k.
    bool Has(int row, int column, int k, bool isCatmark) const;

    void AppendKey(std::vector<std::int32_t>& key) const;
};

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
