// SPDX-License-Identifier: Apache-2.0
#include "tests/naiveRefinement.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <tuple>
#include <vector>

namespace naive {

namespace Sdc = osd_shading::Sdc;
using osd_shading::SubdivisionRules;

namespace {

constexpr double kPi = 3.141592653589793238;

int NumEdges(Level const& m) { return static_cast<int>(m.edges.size()); }

/// `isPrivate`: tells whether the edge between two vertices is its face's own, though another face may join the
/// same two (Loop's inner edges of two faces with the same vertices).
template <typename IsPrivate>
void FindEdgesAndRings(Level& m, IsPrivate isPrivate) {
    m.vertexFaces.resize(m.positions.size());
    m.vertexEdges.resize(m.positions.size());
    std::map<std::tuple<int, int, int>, int> edgeOf;
    for (int f = 0; f < m.NumFaces(); ++f) {
        auto const& face = m.faces[U(f)];
        m.faceEdges.emplace_back();
        for (int v : face) {
            m.vertexFaces[U(v)].push_back(f);
            int const w = After(face, v), owner = isPrivate(v, w) ? m.parentFaces[U(f)] : -1;
            auto const [place, isNew] = edgeOf.insert({{std::min(v, w), std::max(v, w), owner}, NumEdges(m)});
            if (isNew) {
                m.edges.push_back({{v, w}, {}});
                m.vertexEdges[U(v)].push_back(place->second);
                m.vertexEdges[U(w)].push_back(place->second);
            }
            Edge& edge = m.edges[U(place->second)];
            // Three faces, or two that run along the edge in the same direction.
            edge.isNonManifold |= edge.faces.size() >= 2 || (!edge.faces.empty() && edge.vertices[0] == v);
            edge.faces.push_back(f);
            m.faceEdges[U(f)].push_back(place->second);
        }
    }
}

/// Sets of faces at `vertex` that are connected through edges at `vertex` that `isOpen` lets pass; each set and
/// the sets themselves ascending.
template <typename IsOpen>
std::vector<std::vector<int>> ConnectedFaces(Level const& m, int vertex, IsOpen isOpen) {
    std::map<int, int> label;
    for (int f : m.vertexFaces[U(vertex)]) label[f] = f;
    for (bool changed = true; changed;) {
        changed = false;
        for (int e : m.vertexEdges[U(vertex)]) {
            if (!isOpen(m.edges[U(e)])) continue;
            int smallest = std::numeric_limits<int>::max();
            for (int f : m.edges[U(e)].faces) smallest = std::min(smallest, label[f]);
            for (int f : m.edges[U(e)].faces) {
                changed |= label[f] != smallest;
                label[f] = smallest;
            }
        }
    }
    std::map<int, std::vector<int>> sets;
    for (auto const& [face, l] : label) sets[l].push_back(face);
    std::vector<std::vector<int>> result;
    for (auto const& entry : sets) result.push_back(entry.second);
    return result;
}

std::vector<int> SharpEdges(Level const& m, int vertex) {
    std::vector<int> sharp;
    for (int e : m.vertexEdges[U(vertex)]) {
        if (m.edges[U(e)].sharpness > 0) sharp.push_back(e);
    }
    return sharp;
}

void FindKindsAndRegions(Level& m) {
    m.kinds.resize(m.positions.size());
    m.faceValues.resize(m.faces.size());
    for (std::size_t f = 0; f < m.faces.size(); ++f) m.faceValues[f].resize(m.faces[f].size());
    for (int v = 0; v < m.NumVertices(); ++v) {
        std::size_t const numSharp = SharpEdges(m, v).size();
        m.kinds[U(v)] = m.vertexSharpness[U(v)] > 0 || numSharp >= 3 ? Kind::Corner : static_cast<Kind>(numSharp);
        for (auto const& region : ConnectedFaces(m, v, [](Edge const& e) { return e.sharpness <= 0; })) {
            for (int f : region) m.faceValues[U(f)][U(PlaceOf(m.faces[U(f)], v))] = m.NumValues();
            m.valueVertices.push_back(v);
            m.valueFaces.push_back(region);
        }
    }
}

Level ControlLevel(osd_shading::ControlMesh const& mesh, osd_shading::PointView<double> const& positions) {
    Level m;
    for (int v = 0; v < mesh.numVertices; ++v) m.positions.push_back(positions[U(v)]);
    std::size_t next = 0;
    for (int size : mesh.faceSizes) {
        m.baseFaces.push_back(m.NumFaces());
        m.faces.emplace_back(mesh.faceVertices.begin() + next, mesh.faceVertices.begin() + next + U(size));
        next += U(size);
    }
    m.isHole.resize(m.faces.size(), 0);
    for (int f : mesh.holes) m.isHole[U(f)] = 1;
    m.vertexSharpness.resize(m.positions.size(), 0);
    m.isNonManifold.resize(m.positions.size(), 0);
    FindEdgesAndRings(m, [](int, int) { return false; });

    for (std::size_t i = 0; i < mesh.creaseSharpness.size(); ++i) {
        float& s = m.edges[U(m.EdgeBetween(mesh.creaseVertices[2 * i], mesh.creaseVertices[2 * i + 1]))].sharpness;
        s = std::max(s, std::min(mesh.creaseSharpness[i], kInfinite));
    }
    for (std::size_t i = 0; i < mesh.cornerVertices.size(); ++i) {
        float& s = m.vertexSharpness[U(mesh.cornerVertices[i])];
        s = std::max(s, std::min(mesh.cornerSharpness[i], kInfinite));
    }
    for (int v = 0; v < m.NumVertices(); ++v) {
        bool anyEdge = false;
        for (int e : m.vertexEdges[U(v)]) anyEdge |= m.edges[U(e)].isNonManifold;
        m.isNonManifold[U(v)] = anyEdge || ConnectedFaces(m, v, [](Edge const&) { return true; }).size() != 1;
    }

    // Without boundary interpolation, faces at a boundary edge that is not infinitely sharp become holes.
    if (mesh.rules.boundary == Sdc::Options::VTX_BOUNDARY_NONE) {
        for (int v = 0; v < m.NumVertices(); ++v) {
            for (int e : m.vertexEdges[U(v)]) {
                if (m.edges[U(e)].faces.size() > 1 || m.edges[U(e)].sharpness >= kInfinite) continue;
                for (int f : m.vertexFaces[U(v)]) m.isHole[U(f)] = 1;
            }
        }
    }
    for (Edge& e : m.edges) {
        if (e.faces.size() < 2 || e.isNonManifold) e.sharpness = kInfinite;
    }
    for (int v = 0; v < m.NumVertices(); ++v) {
        auto const& edges = m.vertexEdges[U(v)];
        std::size_t const numFaces = m.vertexFaces[U(v)].size();
        std::size_t numNonManifold = 0;
        for (int e : edges) numNonManifold += m.edges[U(e)].isNonManifold ? 1U : 0U;
        bool const isFin = numNonManifold == 2 && !m.IsBoundary(v) && numFaces > edges.size();
        bool const isOneFace = numFaces == 1 && edges.size() == 2;
        if ((isOneFace && mesh.rules.boundary == Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER) ||
            (m.isNonManifold[U(v)] && !isFin)) {
            m.vertexSharpness[U(v)] = kInfinite;
        }
    }
    FindKindsAndRegions(m);
    return m;
}

float Decremented(float s) { return s >= kInfinite ? kInfinite : std::max(0.0F, s - 1); }

/// Sharpness of the child of `edge` at its end `vertex`.
float ChildSharpness(SubdivisionRules const& rules, Level const& m, Edge const& edge, int vertex) {
    float const s = edge.sharpness;
    if (rules.creasing == Sdc::Options::CREASE_UNIFORM || s <= 0 || s >= kInfinite) return Decremented(s);
    float sum = 0;
    int count = 0;
    for (int e : m.vertexEdges[U(vertex)]) {
        float const other = m.edges[U(e)].sharpness;
        if (other > 0 && other < kInfinite) {
            sum += other;
            ++count;
        }
    }
    float const blurred = count > 1 ? 0.75F * s + 0.25F * ((sum - s) / static_cast<float>(count - 1)) : s;
    return std::max(0.0F, blurred - 1);
}

void Add(Mask& mask, double factor, Mask const& other) {
    for (auto const& [v, w] : other) mask[v] += factor * w;
}

Mask FaceMask(std::vector<int> const& face) {
    Mask mask;
    for (int v : face) mask[v] = 1 / static_cast<double>(face.size());
    return mask;
}

Mask SmoothEdgeMask(SubdivisionRules const& rules, Level const& m, Edge const& edge) {
    Mask mask;
    if (IsLoop(rules)) {
        for (int v : edge.vertices) mask[v] += 3 / 8.0;
        for (int f : edge.faces) {
            for (int v : m.faces[U(f)]) {
                if (v != edge.vertices[0] && v != edge.vertices[1]) mask[v] += 1 / 8.0;
            }
        }
        return mask;
    }
    // The rule for triangles: a triangle counts for .47 instead of 1/4, averaged over the two faces.
    double faceWeight = 0;
    for (int f : edge.faces) {
        bool const isSpecial = rules.triangles == Sdc::Options::TRI_SUB_SMOOTH && m.faces[U(f)].size() == 3;
        faceWeight += 0.5 * (isSpecial ? 0.47 : 0.25);
    }
    for (int v : edge.vertices) mask[v] += 0.5 - faceWeight;
    for (int f : edge.faces) Add(mask, faceWeight, FaceMask(m.faces[U(f)]));
    return mask;
}

/// The vertex rule of `kind`; a crease runs along `crease`, two edges.
Mask VertexMask(SubdivisionRules const& rules, Level const& m, int vertex, Kind kind,
                std::vector<int> const& crease) {
    Mask mask;
    if (kind == Kind::Corner) {
        mask[vertex] = 1;
    } else if (kind == Kind::Crease) {
        mask[vertex] = 3 / 4.0;
        for (int e : crease) mask[OtherEnd(m.edges[U(e)], vertex)] += 1 / 8.0;
    } else {
        auto const& edges = m.vertexEdges[U(vertex)];
        double const n = static_cast<double>(edges.size());
        double const root = 3 / 8.0 + std::cos(2 * kPi / n) / 4;
        double const each = IsLoop(rules) ? (5 / 8.0 - root * root) / n : 1 / (n * n);
        mask[vertex] = IsLoop(rules) ? 1 - n * each : (n - 2) / n;
        for (int e : edges) mask[OtherEnd(m.edges[U(e)], vertex)] += each;
        if (!IsLoop(rules)) {
            for (int f : m.vertexFaces[U(vertex)]) Add(mask, each, FaceMask(m.faces[U(f)]));
        }
    }
    return mask;
}

/// The faces of the next level, in OpenSubdiv's order. Its vertices are the children of vertices, edges and faces.
void SplitFaces(SubdivisionRules const& rules, Level const& m, Level& child) {
    int const firstEdge = m.NumVertices(), firstFace = firstEdge + NumEdges(m);
    for (int f = 0; f < m.NumFaces(); ++f) {
        auto const& face = m.faces[U(f)];
        std::size_t const n = face.size();
        std::vector<int> e;
        for (int edge : m.faceEdges[U(f)]) e.push_back(firstEdge + edge);
        std::vector<std::vector<int>> pieces;
        if (IsLoop(rules)) {
            pieces = {{face[0], e[0], e[2]}, {e[0], face[1], e[1]}, {e[2], e[1], face[2]}, {e[1], e[2], e[0]}};
        } else {
            for (std::size_t i = 0; i < n; ++i) {
                pieces.push_back({face[i], e[i], firstFace + f, e[(i + n - 1) % n]});
                // A quad's children keep its orientation: vertex i of child i is the child of vertex i.
                if (n == 4) std::rotate(pieces[i].begin(), pieces[i].end() - static_cast<int>(i), pieces[i].end());
            }
        }
        for (auto& piece : pieces) {
            child.faces.push_back(piece);
            child.isHole.push_back(m.isHole[U(f)]);
            child.baseFaces.push_back(m.baseFaces[U(f)]);
            child.parentFaces.push_back(f);
        }
    }
}

Level ChildLevel(SubdivisionRules const& rules, Level const& m) {
    Level child;
    int const numVertices = m.NumVertices(), numEdges = NumEdges(m);
    SplitFaces(rules, m, child);
    child.positions.resize(U(numVertices + numEdges + (IsLoop(rules) ? 0 : m.NumFaces())));
    child.vertexSharpness.resize(child.positions.size(), 0);
    child.isNonManifold.resize(child.positions.size(), 0);
    child.parents.resize(child.positions.size(), -1);
    for (int v = 0; v < numVertices; ++v) {
        child.parents[U(v)] = v;
        child.vertexSharpness[U(v)] = Decremented(m.vertexSharpness[U(v)]);
        child.isNonManifold[U(v)] = m.isNonManifold[U(v)];
    }
    FindEdgesAndRings(child, [&](int a, int b) { return IsLoop(rules) && a >= numVertices && b >= numVertices; });
    for (int e = 0; e < numEdges; ++e) {
        Edge const& edge = m.edges[U(e)];
        child.isNonManifold[U(numVertices + e)] = edge.isNonManifold;
        for (int v : edge.vertices) {
            child.edges[U(child.EdgeBetween(v, numVertices + e))].sharpness = ChildSharpness(rules, m, edge, v);
        }
    }
    FindKindsAndRegions(child);

    for (int v = 0; v < numVertices; ++v) {
        Kind const before = m.kinds[U(v)], after = child.kinds[U(v)];
        Mask mask = VertexMask(rules, m, v, before, SharpEdges(m, v));
        if (before >= Kind::Crease && before != after) {
            // The sharpness that ends here, on average, is the share of the old rule.
            float sum = 0;
            int count = 0;
            std::vector<int> stillSharp;
            for (int e : m.vertexEdges[U(v)]) {
                float const s = m.edges[U(e)].sharpness, left = ChildSharpness(rules, m, m.edges[U(e)], v);
                bool const ends =
                    rules.creasing == Sdc::Options::CREASE_UNIFORM ? s > 0 && s <= 1 : s > 0 && left <= 0;
                if (ends) {
                    sum += s;
                    ++count;
                }
                if (left > 0) stillSharp.push_back(e);
            }
            if (m.vertexSharpness[U(v)] > 0 && child.vertexSharpness[U(v)] <= 0) {
                sum += m.vertexSharpness[U(v)];
                ++count;
            }
            double const share =
                count == 0 ? 0 : static_cast<double>(std::min(1.0F, sum / static_cast<float>(count)));
            Mask blended;
            Add(blended, share, mask);
            Add(blended, 1 - share, VertexMask(rules, m, v, after, stillSharp));
            mask = blended;
        }
        child.masks.push_back(mask);
        child.flatMasks.push_back({{v, 1.0}});
    }
    for (int e = 0; e < numEdges; ++e) {
        Edge const& edge = m.edges[U(e)];
        Mask const sharp{{edge.vertices[0], 0.5}, {edge.vertices[1], 0.5}};
        Mask mask;
        if (edge.sharpness > 0 && child.kinds[U(numVertices + e)] >= Kind::Crease) {
            mask = sharp;
        } else if (edge.sharpness > 0) {
            // Unclamped as in OpenSubdiv, whose Chaikin creases overshoot here.
            double const s = static_cast<double>(edge.sharpness);
            Add(mask, s, sharp);
            Add(mask, 1 - s, SmoothEdgeMask(rules, m, edge));
        } else {
            mask = SmoothEdgeMask(rules, m, edge);
        }
        child.masks.push_back(mask);
        child.flatMasks.push_back(sharp);
    }
    if (!IsLoop(rules)) {
        for (auto const& face : m.faces) {
            child.masks.push_back(FaceMask(face));
            child.flatMasks.push_back(FaceMask(face));
        }
    }
    for (std::size_t c = 0; c < child.masks.size(); ++c) {
        for (auto& masks : {&child.masks[c], &child.flatMasks[c]}) {
            std::erase_if(*masks, [](auto const& term) { return term.second == 0; });
        }
        for (auto const& [v, w] : child.masks[c]) child.positions[c] = child.positions[c] + w * m.positions[U(v)];
    }
    return child;
}

}  // namespace

bool IsLoop(SubdivisionRules const& rules) { return rules.scheme == Sdc::SCHEME_LOOP; }

int PlaceOf(std::vector<int> const& face, int vertex) {
    return static_cast<int>(std::find(face.begin(), face.end(), vertex) - face.begin());
}

int After(std::vector<int> const& face, int vertex, int steps) {
    return face[U(PlaceOf(face, vertex) + steps) % face.size()];
}

int OtherEnd(Edge const& edge, int vertex) { return edge.vertices[edge.vertices[0] == vertex ? 1 : 0]; }

bool Level::IsBoundary(int vertex) const {
    auto const& around = vertexEdges[U(vertex)];
    return std::any_of(around.begin(), around.end(), [&](int e) { return edges[U(e)].faces.size() == 1; });
}

int Level::EdgeBetween(int a, int b) const {
    for (int e : vertexEdges[U(a)]) {
        if (OtherEnd(edges[U(e)], a) == b) return e;
    }
    return -1;
}

bool IsExtraordinary(SubdivisionRules const& rules, Level const& m, int v) {
    int const valence = static_cast<int>(m.vertexEdges[U(v)].size());
    if (valence == 0) return false;
    if (!m.IsBoundary(v)) return valence != (IsLoop(rules) ? 6 : 4);
    if (m.vertexFaces[U(v)].size() == 1 && m.kinds[U(v)] == Kind::Corner) return false;
    return valence != (IsLoop(rules) ? 4 : 3);
}

Mask LimitMask(SubdivisionRules const& rules, Level const& m, int vertex) {
    auto const& edges = m.vertexEdges[U(vertex)];
    Kind const kind = m.kinds[U(vertex)];
    Mask mask;
    if (kind == Kind::Crease) {
        mask[vertex] = 2 / 3.0;
        for (int e : SharpEdges(m, vertex)) mask[OtherEnd(m.edges[U(e)], vertex)] += 1 / 6.0;
        return mask;
    }
    double const n = static_cast<double>(edges.size());
    // OpenSubdiv leaves Catmull-Clark's interior vertices of valence 2 in place.
    if (kind == Kind::Corner || edges.empty() || (!IsLoop(rules) && edges.size() == 2)) return {{vertex, 1.0}};
    double const root = 3 / 8.0 + std::cos(2 * kPi / n) / 4;
    double const each = IsLoop(rules) ? 1 / (n + 3 / (8 * (5 / 8.0 - root * root) / n)) : 4 / (n * (n + 5));
    mask[vertex] = 1 - n * each;
    for (int e : edges) mask[OtherEnd(m.edges[U(e)], vertex)] += each;
    if (!IsLoop(rules)) {
        for (int f : m.vertexFaces[U(vertex)]) {
            mask[After(m.faces[U(f)], vertex, 2)] += each / 4;
            mask[vertex] -= each / 4;
        }
    }
    return mask;
}

Hierarchy Refine(osd_shading::ControlMesh const& mesh, osd_shading::PointView<double> const& positions, int last) {
    Hierarchy hierarchy{mesh.rules, {ControlLevel(mesh, positions)}};
    for (int l = 0; l < last; ++l) hierarchy.levels.push_back(ChildLevel(mesh.rules, hierarchy.levels.back()));
    return hierarchy;
}

std::vector<Vec3> LimitPositions(SubdivisionRules const& rules, Level const& level) {
    std::vector<Vec3> limits(level.positions.size());
    for (int v = 0; v < level.NumVertices(); ++v) {
        for (auto const& [u, w] : LimitMask(rules, level, v))
            limits[U(v)] = limits[U(v)] + w * level.positions[U(u)];
    }
    return limits;
}

}  // namespace naive
