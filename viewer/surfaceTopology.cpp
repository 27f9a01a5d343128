// SPDX-License-Identifier: Apache-2.0
#include "surfaceTopology.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace osd_shading::viewer {

namespace {

/// An edge of the result, seen from one face; `low` and `high` are vertices.
struct HalfEdge {
    int high, lowValue, highValue, baseFace;
    bool isForward;  // runs from low to high
};

/// An edge of the result that lies on a control edge.
struct CurveEdge {
    int vertices[2], values[2];
};

void AddTriangles(SurfaceTopology& topology) {
    auto const size = static_cast<std::size_t>(topology.faceSize);
    topology.triangles.reserve(topology.NumFaces() * (size - 2) * 3);
    for (std::size_t first = 0; first < topology.faceValues.size(); first += size) {
        for (std::size_t i = 1; i + 1 < size; ++i) {
            for (std::size_t corner : {std::size_t{0}, i, i + 1}) {
                topology.triangles.push_back(static_cast<std::uint32_t>(topology.faceValues[first + corner]));
            }
        }
    }
}

// Finds the edges, each once, and those of them that lie between two control faces, or at one only.
std::vector<CurveEdge> AddWires(SurfaceTopology& topology) {
    auto const size = static_cast<std::size_t>(topology.faceSize);
    auto const numVertices = static_cast<std::size_t>(topology.NumVertices());
    auto const vertexOf = [&](int value) { return topology.valueVertices[static_cast<std::size_t>(value)]; };

    // Sort half-edges by their lower vertex.
    std::vector<int> offsets(numVertices + 1, 0);
    std::vector<HalfEdge> halfEdges(topology.faceValues.size());
    auto const forEach = [&](auto const& visit) {
        for (std::size_t corner = 0; corner < topology.faceValues.size(); ++corner) {
            std::size_t const next = corner % size == size - 1 ? corner + 1 - size : corner + 1;
            int a = topology.faceValues[corner], b = topology.faceValues[next];
            bool const isForward = vertexOf(a) < vertexOf(b);
            if (!isForward) std::swap(a, b);
            visit(static_cast<std::size_t>(vertexOf(a)),
                  HalfEdge{vertexOf(b), a, b, topology.baseFaces[corner / size], isForward});
        }
    };
    forEach([&](std::size_t low, HalfEdge const&) { ++offsets[low + 1]; });
    for (std::size_t i = 0; i < numVertices; ++i) offsets[i + 1] += offsets[i];
    std::vector<int> ends(offsets.begin(), offsets.end() - 1);
    forEach(
        [&](std::size_t low, HalfEdge const& edge) { halfEdges[static_cast<std::size_t>(ends[low]++)] = edge; });

    // Bring those of one edge together.
    std::vector<CurveEdge> onCurves;
    topology.wires.reserve(halfEdges.size() / 2);
    topology.hidesBackFaces = true;
    for (std::size_t low = 0; low < numVertices; ++low) {
        auto const first = halfEdges.begin() + offsets[low], last = halfEdges.begin() + offsets[low + 1];
        std::sort(first, last, [](HalfEdge const& a, HalfEdge const& b) { return a.high < b.high; });
        for (auto begin = first, end = first; begin != last; begin = end) {
            bool isInside = true;
            for (end = begin; end != last && end->high == begin->high; ++end) {
                isInside = isInside && end->baseFace == begin->baseFace;
            }
            topology.wires.push_back({begin->lowValue, begin->highValue});
            bool const isCurve = !isInside || end - begin == 1;
            bool const isPair = end - begin == 2 && begin->isForward != (begin + 1)->isForward;
            topology.hidesBackFaces = topology.hidesBackFaces && isPair;
            if (isCurve) {
                onCurves.push_back({{static_cast<int>(low), begin->high}, {begin->lowValue, begin->highValue}});
            }
        }
    }
    return onCurves;
}

// Strings edges together to curves from control vertex to control vertex. A control vertex keeps its number at
// every level, so that it is known by that; on the way each point has just two of the edges.
void AddCurves(std::vector<CurveEdge> const& edges, SurfaceTopology& topology) {
    auto const numVertices = static_cast<std::size_t>(topology.NumVertices());
    std::vector<int> offsets(numVertices + 1, 0), items(2 * edges.size());
    for (CurveEdge const& edge : edges) {
        for (int vertex : edge.vertices) ++offsets[static_cast<std::size_t>(vertex) + 1];
    }
    for (std::size_t i = 0; i < numVertices; ++i) offsets[i + 1] += offsets[i];
    std::vector<int> ends(offsets.begin(), offsets.end() - 1);
    for (std::size_t i = 0; i < edges.size(); ++i) {
        for (int vertex : edges[i].vertices) {
            items[static_cast<std::size_t>(ends[static_cast<std::size_t>(vertex)]++)] = static_cast<int>(i);
        }
    }

    std::vector<bool> isUsed(edges.size(), false);
    for (int start = 0; start < std::min(topology.numControlVertices, topology.NumVertices()); ++start) {
        for (int i = offsets[static_cast<std::size_t>(start)]; i < offsets[static_cast<std::size_t>(start) + 1];
             ++i) {
            auto next = static_cast<std::size_t>(items[static_cast<std::size_t>(i)]);
            if (isUsed[next]) continue;
            ControlCurve curve{{start, start}, topology.curveValues.size(), 0};
            int vertex = start;
            for (bool goesOn = true; goesOn;) {
                CurveEdge const& edge = edges[next];
                isUsed[next] = true;
                int const side = edge.vertices[0] == vertex ? 0 : 1;
                if (vertex == start) topology.curveValues.push_back(edge.values[side]);
                topology.curveValues.push_back(edge.values[1 - side]);
                vertex = edge.vertices[1 - side];
                goesOn = false;
                if (vertex < topology.numControlVertices) break;
                for (int k = offsets[static_cast<std::size_t>(vertex)];
                     k < offsets[static_cast<std::size_t>(vertex) + 1]; ++k) {
                    auto const candidate = static_cast<std::size_t>(items[static_cast<std::size_t>(k)]);
                    if (isUsed[candidate]) continue;
                    next = candidate;
                    goesOn = true;
                }
            }
            curve.vertices[1] = vertex;
            curve.count = topology.curveValues.size() - curve.first;
            // Round a hole that is left out a curve may end nowhere: such edges can't be picked.
            if (vertex >= topology.numControlVertices) {
                topology.curveValues.resize(curve.first);
                continue;
            }
            if (curve.vertices[0] > curve.vertices[1]) {
                std::swap(curve.vertices[0], curve.vertices[1]);
                std::reverse(topology.curveValues.begin() + static_cast<std::ptrdiff_t>(curve.first),
                             topology.curveValues.end());
            }
            topology.curves.push_back(curve);
        }
    }
}

// Whether each connected piece encloses more of its inside than of its outside, by its signed volume.
template <typename Real>
bool LooksOutwards(SurfaceTopology const& topology, std::vector<Vec3<Real>> const& positions) {
    // Join the vertices of each face.
    std::vector<int> parents(positions.size());
    for (std::size_t i = 0; i < parents.size(); ++i) parents[i] = static_cast<int>(i);
    auto const find = [&](int vertex) {
        while (parents[static_cast<std::size_t>(vertex)] != vertex) {
            int& parent = parents[static_cast<std::size_t>(vertex)];
            parent = parents[static_cast<std::size_t>(parent)];
            vertex = parent;
        }
        return vertex;
    };
    auto const vertexAt = [&](std::size_t corner) {
        return topology.valueVertices[static_cast<std::size_t>(topology.triangles[corner])];
    };
    for (std::size_t i = 0; i < topology.triangles.size(); i += 3) {
        int const root = find(vertexAt(i));
        for (std::size_t k : {i + 1, i + 2}) parents[static_cast<std::size_t>(find(vertexAt(k)))] = root;
    }

    std::vector<double> volumes(positions.size(), 0);
    for (std::size_t i = 0; i < topology.triangles.size(); i += 3) {
        auto const point = [&](std::size_t corner) {
            Vec3<Real> const& p = positions[static_cast<std::size_t>(vertexAt(corner))];
            return glm::dvec3(p.x, p.y, p.z);
        };
        volumes[static_cast<std::size_t>(find(vertexAt(i)))] +=
            glm::dot(point(i), glm::cross(point(i + 1), point(i + 2)));
    }
    return std::none_of(volumes.begin(), volumes.end(), [](double volume) { return volume < 0; });
}

}  // namespace

template <typename Real>
std::shared_ptr<SurfaceTopology const> MakeSurfaceTopology(ShadingResult<Real>&& result, int numControlVertices) {
    auto topology = std::make_shared<SurfaceTopology>();
    topology->faceSize = result.faceSize;
    topology->faceValues = std::move(result.faceValues);
    topology->baseFaces = std::move(result.baseFaces);
    topology->valueVertices = std::move(result.valueVertices);
    topology->vertexValues = std::move(result.vertexValues);
    topology->vertexTags = std::move(result.vertexTags);
    topology->creaseEdges = std::move(result.creaseEdges);
    topology->numControlVertices = numControlVertices;
    AddTriangles(*topology);
    AddCurves(AddWires(*topology), *topology);
    topology->hidesBackFaces = topology->hidesBackFaces && LooksOutwards(*topology, result.positions);
    return topology;
}

template std::shared_ptr<SurfaceTopology const> MakeSurfaceTopology(ShadingResult<float>&&, int);
template std::shared_ptr<SurfaceTopology const> MakeSurfaceTopology(ShadingResult<double>&&, int);

}  // namespace osd_shading::viewer
