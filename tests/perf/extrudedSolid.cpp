// SPDX-License-Identifier: Apache-2.0
#include "extrudedSolid.h"

#include <cstddef>
#include <map>
#include <utility>

namespace perf {

using osd_shading::io::Model;

namespace {

using Edge = std::pair<int, int>;

/// The column on the left of each directed edge.
std::map<Edge, std::size_t> columnsOfEdges(std::vector<ExtrudedSolid::Column> const& columns) {
    std::map<Edge, std::size_t> columnOf;
    for (std::size_t i = 0; i < columns.size(); ++i) {
        for (std::size_t k = 0; k < 4; ++k) {
            columnOf[{columns[i].corners[k], columns[i].corners[(k + 1) % 4]}] = i;
        }
    }
    return columnOf;
}

}  // namespace

int ExtrudedSolid::AddPoint(double x, double y) {
    points.push_back({x, y});
    return static_cast<int>(points.size()) - 1;
}

void ExtrudedSolid::AddGrid(int numX, int numY, int top, std::function<int(int, int)> const& corner) {
    for (int i = 0; i < numX; ++i) {
        for (int j = 0; j < numY; ++j) {
            columns.push_back({{corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)}, 0, top});
        }
    }
}

ExtrudedSolid::Point ExtrudedSolid::Middle(Column const& column) const {
    Point middle = {0, 0};
    for (int const corner : column.corners) {
        middle[0] += points[static_cast<std::size_t>(corner)][0] / 4;
        middle[1] += points[static_cast<std::size_t>(corner)][1] / 4;
    }
    return middle;
}

void ExtrudedSolid::InsertRing(std::function<bool(Point const&)> const& isChosen, double share) {
    std::vector<std::size_t> chosen;
    Point center = {0, 0};
    for (std::size_t i = 0; i < columns.size(); ++i) {
        Point const middle = Middle(columns[i]);
        if (!isChosen(middle)) continue;
        chosen.push_back(i);
        center[0] += middle[0];
        center[1] += middle[1];
    }
    for (double& coordinate : center) coordinate /= static_cast<double>(chosen.size());

    // All points of the chosen columns get a smaller copy: those inside are then used by nobody else.
    std::vector<Column> inside;
    inside.reserve(chosen.size());
    for (std::size_t const i : chosen) inside.push_back(columns[i]);
    std::map<int, int> copyOf;
    for (Column const& column : inside) {
        for (int const corner : column.corners) {
            if (copyOf.count(corner) != 0) continue;
            Point const outer = points[static_cast<std::size_t>(corner)];
            copyOf[corner] =
                AddPoint(center[0] + share * (outer[0] - center[0]), center[1] + share * (outer[1] - center[1]));
        }
    }
    std::map<Edge, std::size_t> const columnOf = columnsOfEdges(inside);
    for (auto const& [edge, column] : columnOf) {
        if (columnOf.count({edge.second, edge.first}) != 0) continue;
        columns.push_back({{edge.first, edge.second, copyOf[edge.second], copyOf[edge.first]},
                           inside[column].bottom,
                           inside[column].top});
    }
    for (std::size_t const i : chosen) {
        for (int& corner : columns[i].corners) corner = copyOf[corner];
    }
}

void ExtrudedSolid::SetLayers(std::function<bool(Point const&)> const& isChosen, int bottom, int top) {
    for (Column& column : columns) {
        if (!isChosen(Middle(column))) continue;
        column.bottom = bottom;
        column.top = top;
    }
}

Model ExtrudedSolid::Surface(std::function<std::array<double, 3>(Point const&, int)> const& place) const {
    Model model;
    std::map<std::pair<int, int>, int> vertexOf;
    auto const vertex = [&](int point, int layer) {
        auto const [found, isNew] = vertexOf.try_emplace({point, layer}, model.NumVertices());
        if (isNew) {
            std::array<double, 3> const position = place(points[static_cast<std::size_t>(point)], layer);
            model.positions.insert(model.positions.end(), position.begin(), position.end());
        }
        return found->second;
    };
    auto const addQuad = [&](std::array<int, 4> const& vertices) {
        model.faceSizes.push_back(4);
        model.faceVertices.insert(model.faceVertices.end(), vertices.begin(), vertices.end());
    };

    std::map<Edge, std::size_t> const columnOf = columnsOfEdges(columns);
    for (Column const& column : columns) {
        if (column.bottom == column.top) continue;
        auto const& [a, b, c, d] = column.corners;
        addQuad({vertex(a, column.top), vertex(b, column.top), vertex(c, column.top), vertex(d, column.top)});
        addQuad({vertex(d, column.bottom), vertex(c, column.bottom), vertex(b, column.bottom),
                 vertex(a, column.bottom)});
        for (std::size_t k = 0; k < 4; ++k) {
            int const from = column.corners[k], to = column.corners[(k + 1) % 4];
            auto const neighbour = columnOf.find({to, from});
            for (int layer = column.bottom; layer < column.top; ++layer) {
                if (neighbour != columnOf.end()) {
                    Column const& other = columns[neighbour->second];
                    if (layer >= other.bottom && layer < other.top) continue;
                }
                addQuad({vertex(from, layer), vertex(to, layer), vertex(to, layer + 1), vertex(from, layer + 1)});
            }
        }
    }
    return model;
}

}  // namespace perf
