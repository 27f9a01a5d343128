// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/tables/tangentRows.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace osd_shading {
inline namespace v1 {
namespace tables {

LimitFrame<double> TangentRows::Find(int row, int column) {
    FaceCorner const at = _grid[index(row, column)];
    FindLimitFrames(_limit, VertexAt(_levels.Level(_level), at), _frames);
    int const value = _levels.ValueAt(_level, at);
    auto const found = std::find_if(_frames.begin(), _frames.end(),
                                    [&](auto const& candidate) { return candidate.value == value; });
    assert(found != _frames.end());
    LimitFrame<double> frame = std::move(*found);
    if (!frame.isAverage) orient(row, column, frame);
    return frame;
}

void TangentRows::orient(int row, int column, LimitFrame<double>& frame) const {
    constexpr double kPi = 3.14159265358979323846;
    Far::TopologyLevel const& level = _levels.Level(_level);
    RegionFan const& fan = frame.fan;
    int const vertex = frame.vertices[0], numFaces = static_cast<int>(fan.faces.size());
    VertexKind const kind = _limit.Regions().Kind(vertex);

    if (kind == VertexKind::Corner) {
        // Of one face: its two edges, as the tile sees them.
        int const corner = row == 0 && column == 0       ? 0
                           : column == _side && row == 0 ? 1
                           : row == _side && column == 0 ? (_isCatmark ? 3 : 2)
                                                         : 2;
        std::vector<double> const after = frame.tangent1, before = frame.tangent2;
        for (std::size_t i = 0; i < after.size(); ++i) {
            double const a = after[i], b = before[i];
            double u = a, v = b;
            if (_isCatmark) {
                if (corner == 1) u = -b, v = a;
                if (corner == 2) u = -a, v = -b;
                if (corner == 3) u = b, v = -a;
            } else {
                if (corner == 1) u = -b, v = a - b;
                if (corner == 2) u = b - a, v = -a;
            }
            frame.tangent1[i] = _side * u;
            frame.tangent2[i] = _side * v;
        }
        return;
    }

    // Where the mask's directions lie: edge j of a ring at 2 pi j / n, of a fan at pi j / m.
    bool const isRing = kind <= VertexKind::Dart;
    int const numEdges = isRing ? numFaces : numFaces + 1;
    double const step = (isRing ? 2 * kPi : kPi) / numFaces;
    auto const farEnd = [&](int j) {
        int const face = fan.faces[static_cast<std::size_t>(j < numFaces ? j : j - 1)];
        int const corner = fan.corners[static_cast<std::size_t>(j < numFaces ? j : j - 1)];
        Far::ConstIndexArray const vertices = level.GetFaceVertices(face);
        int const size = vertices.size();
        return vertices[(corner + (j < numFaces ? 1 : size - 1)) % size];
    };
    auto const angleTo = [&](int toRow, int toColumn) {
        int const neighbor = VertexAt(level, _grid[index(toRow, toColumn)]);
        for (int j = 0; j < numEdges; ++j) {
            if (farEnd(j) == neighbor) return step * j;
        }
        return 0.0;  // a vertex met twice round its own ring: any direction will do
    };
    bool const hasNext = column < _side && (_isCatmark || row + column < _side);
    double const u = hasNext      ? angleTo(row, column + 1)
                     : column > 0 ? angleTo(row, column - 1) + kPi
                                  : angleTo(row - 1, column + 1) + kPi / 3;
    bool const isRegularTriangle = !_isCatmark && numFaces == (isRing ? 6 : 3);
    double const v = u + (isRegularTriangle ? kPi / 3 : kPi / 2);

    // The lengths that the mask gives an even layout of edges of length 1.
    double length1 = 0, length2 = 0;
    auto const measure = [&](std::size_t term, double x, double y) {
        length1 += frame.tangent1[term] * x;
        length2 += frame.tangent2[term] * y;
    };
    std::size_t term = 1;
    for (int j = 0; _isCatmark && j < numFaces; ++j, ++term) {
        measure(term, std::cos(step * j) + std::cos(step * (j + 1)), std::sin(step * j) + std::sin(step * (j + 1)));
    }
    for (int j = 0; j < numEdges; ++j, ++term) measure(term, std::cos(step * j), std::sin(step * j));
    constexpr double kTiny = 1e-9;
    double const scale1 = _side / (std::fabs(length1) > kTiny ? length1 : 1);
    double const scale2 = _side / (std::fabs(length2) > kTiny ? length2 : 1);
    for (std::size_t i = 0; i < frame.tangent1.size(); ++i) {
        double const t1 = scale1 * frame.tangent1[i], t2 = scale2 * frame.tangent2[i];
        frame.tangent1[i] = std::cos(u) * t1 + std::sin(u) * t2;
        frame.tangent2[i] = std::cos(v) * t1 + std::sin(v) * t2;
    }
}

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
