// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/limitMasks.h"

#include <opensubdiv/sdc/catmarkScheme.h>
#include <opensubdiv/sdc/loopScheme.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "osd_shading/exactLimitMasks.h"
#include "osd_shading/parallel.h"
#include "osd_shading/vectorMath.h"

namespace osd_shading {
inline namespace v1 {

namespace {

/// A fan of faces as Sdc::Scheme asks about it.
struct FanNeighborhood {
    int numEdges, numFaces;

    int GetNumEdges() const { return numEdges; }
    int GetNumFaces() const { return numFaces; }
    float* GetSharpnessPerEdge(float* sharpness) const {
        std::fill(sharpness, sharpness + numEdges, 0.0f);
        if (numEdges > numFaces) {
            sharpness[0] = sharpness[numEdges - 1] = Sdc::Crease::SHARPNESS_INFINITE;
        }
        return sharpness;
    }
};

template <typename Real>
struct SdcMask {
    using Weight = Real;
    explicit SdcMask(int size) : edges(static_cast<std::size_t>(size)), faces(static_cast<std::size_t>(size)) {}

    int GetNumVertexWeights() const { return 1; }
    int GetNumEdgeWeights() const { return numEdges; }
    int GetNumFaceWeights() const { return numFaces; }
    void SetNumVertexWeights(int) {}
    void SetNumEdgeWeights(int n) { numEdges = n; }
    void SetNumFaceWeights(int n) { numFaces = n; }
    Weight const& VertexWeight(int) const { return vertex; }
    Weight const& EdgeWeight(int i) const { return edges[static_cast<std::size_t>(i)]; }
    Weight const& FaceWeight(int i) const { return faces[static_cast<std::size_t>(i)]; }
    Weight& VertexWeight(int) { return vertex; }
    Weight& EdgeWeight(int i) { return edges[static_cast<std::size_t>(i)]; }
    Weight& FaceWeight(int i) { return faces[static_cast<std::size_t>(i)]; }
    bool AreFaceWeightsForFaceCenters() const { return false; }
    void SetFaceWeightsForFaceCenters(bool) {}

    Weight vertex = 0;
    std::vector<Weight> edges, faces;
    int numEdges = 0, numFaces = 0;
};

/// Fills in what follows from the weights.
template <typename Real>
void complete(LimitMask<Real>& mask) {
    // A tangent's weights under the precision are rounding of a zero.
    Real squares1 = 0, squares2 = 0;
    auto const add = [&](typename LimitMask<Real>::Weights& w, bool isVertex) {
        for (Real* const tangent : {&w.tangent1, &w.tangent2}) {
            if (std::fabs(*tangent) < kVanishing<Real>) *tangent = 0;
        }
        if (isVertex) return;
        squares1 += w.tangent1 * w.tangent1;
        squares2 += w.tangent2 * w.tangent2;
        mask.positions.push_back(w.position);
    };
    mask.positions.clear();
    add(mask.vertex, true);
    for (auto& w : mask.faces) add(w, false);
    for (auto& w : mask.edges) add(w, false);
    mask.tangentNorms = std::sqrt(squares1 * squares2);
}

template <typename Real>
std::unique_ptr<LimitMask<Real>> computeMask(Sdc::SchemeType scheme, int numFaces, bool isRing) {
    FanNeighborhood const fan{isRing ? numFaces : numFaces + 1, numFaces};
    Sdc::Crease::Rule const rule = isRing ? Sdc::Crease::RULE_SMOOTH : Sdc::Crease::RULE_CREASE;
    SdcMask<Real> position(fan.numEdges), tangent1(fan.numEdges), tangent2(fan.numEdges);
    if (scheme == Sdc::SCHEME_CATMARK) {
        Sdc::Scheme<Sdc::SCHEME_CATMARK>().ComputeVertexLimitMask(fan, position, tangent1, tangent2, rule);
    } else {
        Sdc::Scheme<Sdc::SCHEME_LOOP>().ComputeVertexLimitMask(fan, position, tangent1, tangent2, rule);
    }
    auto mask = std::make_unique<LimitMask<Real>>();
    mask->vertex = {position.vertex, tangent1.vertex, tangent2.vertex};
    mask->edges.resize(static_cast<std::size_t>(fan.numEdges));
    mask->faces.resize(scheme == Sdc::SCHEME_CATMARK ? static_cast<std::size_t>(numFaces) : 0);
    auto const weight = [](std::vector<Real> const& weights, int count, std::size_t i) {
        return i < static_cast<std::size_t>(count) ? weights[i] : Real(0);
    };
    for (std::size_t i = 0; i < mask->edges.size(); ++i) {
        mask->edges[i] = {weight(position.edges, position.numEdges, i),
                          weight(tangent1.edges, tangent1.numEdges, i),
                          weight(tangent2.edges, tangent2.numEdges, i)};
    }
    for (std::size_t i = 0; i < mask->faces.size(); ++i) {
        mask->faces[i] = {weight(position.faces, position.numFaces, i),
                          weight(tangent1.faces, tangent1.numFaces, i),
                          weight(tangent2.faces, tangent2.numFaces, i)};
    }
    complete(*mask);
    return mask;
}

/// Whether OpenSubdiv's mask is not the limit of its own rules. (A fan of one face is: its corner is planar.)
bool needsExactMask(Sdc::SchemeType scheme, int numFaces, RingKind kind) {
    switch (kind) {
        case RingKind::Ring:
            return numFaces == 2;
        case RingKind::Dart:
            return numFaces >= 2 && numFaces <= kLargestExactDart;
        default:
            return numFaces >= (scheme == Sdc::SCHEME_CATMARK ? 3 : 4);
    }
}

/// Puts exact weights in the place of OpenSubdiv's; a fan keeps its position, which is exact.
template <typename Real>
void makeExact(LimitMask<Real>& mask, Sdc::SchemeType scheme, int numFaces, RingKind kind) {
    // No larger fan has a tangent plane.
    constexpr int kLargestFan = 8;
    if (kind == RingKind::Fan && numFaces > kLargestFan) {
        mask.hasTangents = false;
        return;
    }
    ExactLimitMask const exact = FindExactLimitMask(scheme, numFaces, kind);
    mask.hasTangents = exact.hasTangentPlane;
    auto const set = [&](typename LimitMask<Real>::Weights& w, auto const& at) {
        if (kind != RingKind::Fan) w.position = static_cast<Real>(at(exact.position));
        if (!exact.hasTangentPlane) return;
        w.tangent1 = static_cast<Real>(at(exact.tangent1));
        w.tangent2 = static_cast<Real>(at(exact.tangent2));
    };
    using Weights = ExactLimitMask::Weights;
    set(mask.vertex, [](Weights const& w) { return w.vertex; });
    for (std::size_t i = 0; i < mask.edges.size(); ++i)
        set(mask.edges[i], [i](Weights const& w) { return w.edges[i]; });
    for (std::size_t i = 0; i < mask.faces.size(); ++i)
        set(mask.faces[i], [i](Weights const& w) { return w.faces[i]; });
    complete(mask);
}

template <typename Real>
void provide(std::vector<std::unique_ptr<LimitMask<Real>>>& masks, Sdc::SchemeType scheme, int numFaces,
             RingKind kind, bool isExact) {
    auto const i = static_cast<std::size_t>(numFaces);
    if (masks.size() <= i) masks.resize(i + 1);
    if (masks[i]) return;
    masks[i] = computeMask<Real>(scheme, numFaces, kind != RingKind::Fan);
    if (isExact && needsExactMask(scheme, numFaces, kind)) makeExact(*masks[i], scheme, numFaces, kind);
}

}  // namespace

template <typename Real>
LimitMasks<Real>::LimitMasks(RefinedTopology const& topology, int levelIndex, CreaseRegions const& regions,
                             LimitNormalKind limitKind) {
    Far::TopologyLevel const& level = topology.Level(levelIndex);
    bool const isExact = limitKind == LimitNormalKind::Exact;
    auto const need = [&](auto& masks, int numFaces, RingKind kind) {
        provide(masks, topology.Scheme(), numFaces, kind, isExact);
    };
    need(_fans, 1, RingKind::Fan);
    std::vector<int> facesOfRegion;
    for (int v = 0; v < level.GetNumVertices(); ++v) {
        int const numFaces = level.GetVertexFaces(v).size();
        VertexKind const kind = regions.Kind(v);
        if (numFaces == 0 || kind == VertexKind::Corner) continue;
        if (kind != VertexKind::Crease) {
            need(_rings, numFaces, RingKind::Ring);
            if (isExact && kind == VertexKind::Dart &&
                needsExactMask(topology.Scheme(), numFaces, RingKind::Dart)) {
                need(_darts, numFaces, RingKind::Dart);
            }
            continue;
        }
        facesOfRegion.assign(static_cast<std::size_t>(regions.NumVertexValues(v)), 0);
        Far::ConstIndexArray const faces = level.GetVertexFaces(v);
        Far::ConstLocalIndexArray const corners = level.GetVertexFaceLocalIndices(v);
        for (int i = 0; i < numFaces; ++i) {
            ++facesOfRegion[static_cast<std::size_t>(regions.CornerValue(faces[i], corners[i]) -
                                                     regions.FirstValue(v))];
        }
        for (int const count : facesOfRegion) need(_fans, count, RingKind::Fan);
    }
}

int FindDartStart(Far::TopologyLevel const& level, int vertex) {
    Far::ConstIndexArray const faces = level.GetVertexFaces(vertex), edges = level.GetVertexEdges(vertex);
    if (level.IsVertexNonManifold(vertex) || faces.size() != edges.size()) return -1;
    for (int i = 0; i < edges.size(); ++i) {
        if (IsSharpEdge(level, edges[i])) return i;
    }
    return -1;
}

void GatherFan(Far::TopologyLevel const& level, RegionFan const& fan, bool isCatmark, std::vector<int>& neighbors) {
    int const size = isCatmark ? 4 : 3;
    neighbors.clear();
    auto const append = [&](std::size_t i, int ahead) {
        neighbors.push_back(level.GetFaceVertices(fan.faces[i])[(fan.corners[i] + ahead) % size]);
    };
    for (std::size_t i = 0; i < fan.faces.size() && isCatmark; ++i) append(i, 2);
    for (std::size_t i = 0; i < fan.faces.size(); ++i) append(i, 1);
    if (!fan.isClosed) append(fan.faces.size() - 1, size - 1);
}

template <typename Real>
void LimitStep<Real>::gatherRings(int numThreads) {
    int const numVertices = _regions->NumVertices();
    _ringOffsets.resize(static_cast<std::size_t>(numVertices) + 1);
    std::uint32_t numNeighbors = 0;
    for (int v = 0; v < numVertices; ++v) {
        int const numFaces = _level->GetVertexFaces(v).size();
        VertexKind const kind = _regions->Kind(v);
        if (numFaces > 0 && kind != VertexKind::Corner) {
            // The mask of a crease names its two sharp edges and is the same for every fan.
            numNeighbors +=
                kind == VertexKind::Crease ? 2U : static_cast<std::uint32_t>(numFaces) * (_isCatmark ? 2 : 1);
        }
        _ringOffsets[static_cast<std::size_t>(v) + 1] = numNeighbors;
    }
    _ringVertices.resize(numNeighbors);
    ParallelFor(numVertices, numThreads, [&](int begin, int end, int) {
        for (int v = begin; v < end; ++v) {
            int const size = Ring(v).size;
            if (size == 0) continue;
            int* ring = _ringVertices.data() + _ringOffsets[static_cast<std::size_t>(v)];
            if (_regions->Kind(v) == VertexKind::Crease) {
                for (int const edge : _level->GetVertexEdges(v)) {
                    if (!IsSharpEdge(*_level, edge)) continue;
                    Far::ConstIndexArray const ends = _level->GetEdgeVertices(edge);
                    *ring++ = ends[0] == v ? ends[1] : ends[0];
                }
                assert(ring == Ring(v).vertices + 2);  // OpenSubdiv calls a vertex a crease for just two
                continue;
            }
            Far::ConstIndexArray const faces = _level->GetVertexFaces(v);
            Far::ConstLocalIndexArray const corners = _level->GetVertexFaceLocalIndices(v);
            // An exact mask of a dart begins at its sharp edge.
            int const numFaces = faces.size();
            int const first = _regions->Kind(v) == VertexKind::Dart && _masks.Dart(numFaces) != nullptr
                                  ? std::max(0, FindDartStart(*_level, v))
                                  : 0;
            // As OpenSubdiv does, the second corner on counts as opposite in faces that are no quads (level 0).
            auto const ahead = [&](int i, int steps) {
                int const local = first + i < numFaces ? first + i : first + i - numFaces;
                Far::ConstIndexArray const vertices = _level->GetFaceVertices(faces[local]);
                int const corner = corners[local] + steps;
                return vertices[corner < vertices.size() ? corner : corner - vertices.size()];
            };
            for (int i = 0; i < numFaces && _isCatmark; ++i) *ring++ = ahead(i, 2);
            for (int i = 0; i < numFaces; ++i) *ring++ = ahead(i, 1);
        }
    });
}

template <typename Real>
template <typename Visit>
void LimitStep<Real>::forEachVertexTerm(int vertex, Visit const& visit) const {
    RingView const ring = Ring(vertex);
    if (ring.size == 0) {
        visit(vertex, Real(1));
        return;
    }
    LimitMask<Real> const* mask;
    Real const* weights;
    if (_regions->Kind(vertex) == VertexKind::Crease) {
        mask = &_masks.Fan(1);
        // Both ends weigh the same; its face has no weight.
        weights = mask->positions.data() + mask->faces.size();
    } else {
        mask = &RingMask(vertex);
        weights = mask->positions.data();
    }
    for (int i = 0; i < ring.size; ++i) visit(ring.vertices[i], weights[i]);
    visit(vertex, mask->vertex.position);
}

template <typename Real>
LimitStep<Real>::LimitStep(RefinedTopology const& topology, int level, CreaseRegions const& regions, int numThreads,
                           LimitNormalKind kind)
    : _topology(&topology),
      _level(&topology.Level(level)),
      _regions(&regions),
      _masks(topology, level, regions, kind),
      _isCatmark(topology.IsCatmark()) {
    gatherRings(numThreads);
    int const numVertices = regions.NumVertices();
    bool const isPlain = regions.HasOneValuePerVertex();

    // Find the vertices in whose faces a vertex has several regions, or none.
    std::vector<std::vector<int>> specialOfChunk(static_cast<std::size_t>(NumChunks(numVertices)));
    ParallelFor(numVertices, numThreads, [&](int begin, int end, int chunk) {
        for (int v = begin; v < end; ++v) {
            bool isPlainVertex = regions.NumVertexValues(v) == 1;
            if (isPlainVertex && !isPlain) {
                for (int const face : _level->GetVertexFaces(v)) isPlainVertex &= regions.IsPlainFace(face);
            }
            if (!isPlainVertex) specialOfChunk[static_cast<std::size_t>(chunk)].push_back(v);
        }
    });

    std::unique_ptr<RegionRule<Real>> rule;
    std::vector<std::vector<int>> facesOfRegion;
    for (std::vector<int> const& special : specialOfChunk) {
        if (special.empty()) continue;
        if (!rule) {
            rule = std::make_unique<RegionRule<Real>>(*_level, regions);
            _isSpecial.assign(static_cast<std::size_t>(numVertices), 0);
        }
        for (int const v : special) {
            _isSpecial[static_cast<std::size_t>(v)] = 1;
            if (regions.NumVertexValues(v) == 0) continue;
            rule->Clear();
            forEachVertexTerm(v, [&](int u, Real weight) { rule->AddVertex(u, weight); });
            FindRegionFaces(*_level, regions, v, facesOfRegion);
            for (int i = 0; i < regions.NumVertexValues(v); ++i) {
                rule->AppendRow(regions.FirstValue(v) + i, facesOfRegion[static_cast<std::size_t>(i)], _special);
            }
        }
    }
}

template <typename Real>
void LimitStep<Real>::ApplyToPoints(std::vector<Vec3<Real>> const& points, std::vector<Vec3<Real>>& limits,
                                    int numThreads) const {
    limits.resize(points.size());
    ParallelFor(_regions->NumVertices(), numThreads, [&](int begin, int end, int) {
        for (int v = begin; v < end; ++v) {
            Vec3<Real> sum{};
            forEachVertexTerm(v, [&](int u, Real weight) { sum += weight * points[static_cast<std::size_t>(u)]; });
            limits[static_cast<std::size_t>(v)] = sum;
        }
    });
}

template <typename Real>
template <typename T>
void LimitStep<Real>::Apply(std::vector<T> const& field, std::vector<T>& limits, ValueMarks const& marks,
                            int numThreads) const {
    auto const isNeeded = [&](int value) { return marks.empty() || marks[static_cast<std::size_t>(value)]; };
    _special.Apply(field, limits, marks, numThreads);
    ParallelFor(_regions->NumVertices(), numThreads, [&](int begin, int end, int) {
        for (int v = begin; v < end; ++v) {
            if (isSpecial(v)) continue;
            int const value = _regions->FirstValue(v);
            if (!isNeeded(value)) continue;
            T sum{};
            forEachVertexTerm(v, [&](int u, Real weight) {
                sum += weight * field[static_cast<std::size_t>(_regions->FirstValue(u))];
            });
            limits[static_cast<std::size_t>(value)] = sum;
        }
    });
}

template <typename Real>
void LimitStep<Real>::MarkSources(ValueMarks const& marks, ValueMarks& sources) const {
    sources.assign(static_cast<std::size_t>(_regions->NumValues()), 0);
    _special.MarkSources(marks, sources);
    for (int v = 0; v < _regions->NumVertices(); ++v) {
        if (isSpecial(v) || !marks[static_cast<std::size_t>(_regions->FirstValue(v))]) continue;
        forEachVertexTerm(v, [&](int u, Real) { sources[static_cast<std::size_t>(_regions->FirstValue(u))] = 1; });
    }
}

template <typename Real>
void LimitStep<Real>::AppendTerms(int vertex, int value, std::vector<std::pair<int, Real>>& terms) const {
    if (isSpecial(vertex)) {
        _special.AppendTerms(value, terms);
        return;
    }
    forEachVertexTerm(vertex, [&](int u, Real weight) { terms.emplace_back(_regions->FirstValue(u), weight); });
}

template <typename Real>
void LimitStep<Real>::AppendVertexTerms(int vertex, std::vector<std::pair<int, Real>>& terms) const {
    forEachVertexTerm(vertex, [&](int u, Real weight) { terms.emplace_back(u, weight); });
}

#define OSD_SHADING_INSTANTIATE(Real)                                                                          \
    template class LimitMasks<Real>;                                                                           \
    template class LimitStep<Real>;                                                                            \
    template void LimitStep<Real>::Apply(std::vector<Real> const&, std::vector<Real>&, ValueMarks const&, int) \
        const;                                                                                                 \
    template void LimitStep<Real>::Apply(std::vector<Vec3<Real>> const&, std::vector<Vec3<Real>>&,             \
                                         ValueMarks const&, int) const;
OSD_SHADING_INSTANTIATE(float)
OSD_SHADING_INSTANTIATE(double)
#undef OSD_SHADING_INSTANTIATE

}  // namespace v1
}  // namespace osd_shading
