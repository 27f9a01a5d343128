// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/composedRows.h"

#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "osd_shading/errors.h"
#include "osd_shading/subdivisionShading.h"

namespace osd_shading {
inline namespace v1 {

ComposedLevel IdentityLevel(int numElements) {
    ComposedLevel level;
    auto const size = static_cast<std::size_t>(numElements);
    level.numSources = numElements;
    level.rows.resize(size);
    std::iota(level.rows.begin(), level.rows.end(), 0);
    level.plain.sources = level.rows;
    level.plain.weights[0].assign(size, 1);
    level.plain.offsets.resize(size + 1);
    std::iota(level.plain.offsets.begin(), level.plain.offsets.end(), std::size_t{0});
    return level;
}

ComposedLevel ComposeVertices(ComposedLevel const& parent, LevelMasks<double> const& masks, int numThreads) {
    auto const maskOf = [&](int vertex) {
        auto const row = static_cast<std::size_t>(masks.Row(vertex));
        int const first = masks.offsets[row];
        return MaskTerms{masks.terms.data() + first, masks.weights.data() + first, masks.offsets[row + 1] - first};
    };
    return ComposeLevel(parent, masks.numChildVertices, maskOf, numThreads);
}

RowEstimate::RowEstimate(Far::TopologyRefiner const& refiner)
    : _refiner(refiner),
      _base(refiner.GetLevel(0)),
      _isCatmark(refiner.GetSchemeType() == Sdc::SCHEME_CATMARK),
      _ringSizes(static_cast<std::size_t>(_base.GetNumVertices())),
      _isSharp(_ringSizes.size(), 0) {
    for (int v = 0; v < _base.GetNumVertices(); ++v) {
        auto const vertex = static_cast<std::size_t>(v);
        Far::ConstIndexArray const edges = _base.GetVertexEdges(v);
        _ringSizes[vertex] = edges.size();
        for (int const f : _base.GetVertexFaces(v)) _ringSizes[vertex] += _base.GetFaceVertices(f).size() - 3;
        bool isSharp = _base.GetVertexSharpness(v) > 0 || _base.IsVertexNonManifold(v);
        for (int const e : edges) isSharp |= IsSharpEdge(_base, e);
        _isSharp[vertex] = isSharp;
    }
}

double RowEstimate::NumFaces(int level) const {
    if (level == 0) return _base.GetNumFaces();
    double const first = _isCatmark ? static_cast<double>(_base.GetNumFaceVertices())
                                    : 4.0 * static_cast<double>(_base.GetNumFaces());
    return first * std::pow(4.0, level - 1);
}

/// The vertices of the faces round those of `face`: all that lies on it is made of them.
double RowEstimate::supportOf(int face, std::vector<int>& lastFaces) const {
    Far::ConstIndexArray const vertices = _base.GetFaceVertices(face);
    double numFaces = 0;
    for (int const v : vertices) numFaces += _base.GetVertexFaces(v).size();
    constexpr double kMostFaces = 256;
    double support = 0;
    if (numFaces <= kMostFaces) {
        for (int const v : vertices) {
            for (int const f : _base.GetVertexFaces(v)) {
                for (int const u : _base.GetFaceVertices(f)) {
                    int& last = lastFaces[static_cast<std::size_t>(u)];
                    support += last != face;
                    last = face;
                }
            }
        }
        return support;
    }
    // Round a pole counting would take the square of its faces: rings, less what two neighbours both see (not round
    // the whole face, as they may see the same).
    double const size = vertices.size();
    support = size;
    for (int const v : vertices) support += _ringSizes[static_cast<std::size_t>(v)] - (size - 1);
    Far::ConstIndexArray const edges = _base.GetFaceEdges(face);
    for (int i = 1; i < edges.size(); ++i) {
        for (int const other : _base.GetEdgeFaces(edges[i])) {
            if (other == face) continue;
            support -= _base.GetFaceVertices(other).size() - 2;
            break;
        }
    }
    return std::min(std::max(support, size), static_cast<double>(_base.GetNumVertices()));
}

double RowEstimate::PointTerms(int level) const {
    double const perEdge = std::pow(2.0, level) - 1, half = std::pow(2.0, level - 1);
    double terms = 0;
    if (level == 0) {
        for (int v = 0; v < _base.GetNumVertices(); ++v) {
            int numSharp = 0;
            for (int const e : _base.GetVertexEdges(v)) numSharp += IsSharpEdge(_base, e);
            int const numRegions = _base.IsVertexNonManifold(v) ? _base.GetVertexFaces(v).size() : 1 + numSharp;
            terms += numRegions * (1 + _ringSizes[static_cast<std::size_t>(v)]);
        }
        return terms;
    }
    std::vector<int> lastFaces(_ringSizes.size(), -1);
    for (int f = 0; f < _base.GetNumFaces(); ++f) {
        Far::ConstIndexArray const vertices = _base.GetFaceVertices(f), edges = _base.GetFaceEdges(f);
        double const size = vertices.size();
        double rows = _isCatmark ? 1 + size * half * (half - 1) : perEdge * (perEdge - 1) / 2;
        for (int const v : vertices) {
            rows += isSharp(v) ? 1 : 1.0 / _base.GetVertexFaces(v).size();
        }
        for (int const e : edges) {
            rows += IsSharpEdge(_base, e) ? perEdge : perEdge / _base.GetEdgeFaces(e).size();
        }
        terms += rows * supportOf(f, lastFaces);
    }
    return terms;
}

/// The share of each control face on which b may be above zero: within three rings of level w from a vertex that
/// may be eligible (its ring, and two more that this is refined into).
std::vector<double> RowEstimate::findWeightedShares(ShadingOptions const& options) const {
    auto const numFaces = static_cast<std::size_t>(_base.GetNumFaces());
    BlendWeightOptions const& weights = options.weights;
    if (weights.scheme == WeightScheme::One) return std::vector<double>(numFaces, 1);
    std::vector<unsigned char> isNear(_ringSizes.size(), 0);
    for (int v = 0; v < _base.GetNumVertices(); ++v) {
        bool const isBoundary = _base.IsVertexBoundary(v);
        int const regular = _isCatmark ? (isBoundary ? 3 : 4) : (isBoundary ? 4 : 6);
        bool const isSharpSeed = weights.sharpVertices == SharpVertexWeight::PerRegion && isSharp(v);
        isNear[static_cast<std::size_t>(v)] = isSharpSeed || _base.GetVertexEdges(v).size() != regular;
    }
    auto const grow = [&] {
        std::vector<unsigned char> const from = isNear;
        for (int f = 0; f < _base.GetNumFaces(); ++f) {
            Far::ConstIndexArray const vertices = _base.GetFaceVertices(f);
            bool const touches = std::any_of(vertices.begin(), vertices.begin() + vertices.size(),
                                             [&](int v) { return from[static_cast<std::size_t>(v)] != 0; });
            for (int i = 0; i < vertices.size() && touches; ++i) isNear[static_cast<std::size_t>(vertices[i])] = 1;
        }
    };
    std::vector<double> shares(numFaces, 0);
    auto const addTouched = [&](double share) {
        for (int f = 0; f < _base.GetNumFaces(); ++f) {
            double& own = shares[static_cast<std::size_t>(f)];
            for (int const v : _base.GetFaceVertices(f)) {
                if (isNear[static_cast<std::size_t>(v)]) own = std::max(own, share);
            }
        }
    };
    if (weights.level == 0) {
        grow();
        grow();
    }
    // Faces that are no quads have an extraordinary point in their middle, whose three rings are those of level 1.
    std::vector<unsigned char> const ofVertices = isNear;
    for (int f = 0; f < _base.GetNumFaces() && _isCatmark; ++f) {
        Far::ConstIndexArray const vertices = _base.GetFaceVertices(f);
        if (vertices.size() == 4) continue;
        for (int const v : vertices) isNear[static_cast<std::size_t>(v)] = 1;
    }
    addTouched(1);
    if (weights.level == 1) {
        // Two rings of level 1 fill the faces at a vertex; the third takes one side of those round them.
        isNear = ofVertices;
        grow();
        addTouched(_isCatmark ? 0.5 : 0.75);
    }
    return shares;
}

double RowEstimate::NormalTerms(ShadingOptions const& options) const {
    int const level = options.level, start = options.startNormals.level;
    std::vector<double> const shares = findWeightedShares(options);
    // Each corner of a face is a quad of level 1 (in Loop a triangle, beside the one in the middle), which holds
    // `numCells` faces of the start level and `numRows` values of the last.
    double const numCells = std::pow(4.0, std::max(start, 1) - 1);
    double const side = std::pow(2.0, std::max(level, 1) - 1), all = _isCatmark ? side * side : side * side / 2;
    double const withBorder = _isCatmark ? (side + 1) * (side + 1) : (side + 1) * (side + 2) / 2;
    double terms = 0;
    std::vector<int> lastFaces(_ringSizes.size(), -1);
    std::vector<unsigned char> seesSharp(_ringSizes.size(), 0);  // by vertex: one of its faces has a sharp vertex
    auto const touches = [&](int f, auto const& isMarked) {
        Far::ConstIndexArray const vertices = _base.GetFaceVertices(f);
        return std::any_of(vertices.begin(), vertices.begin() + vertices.size(), isMarked);
    };
    for (int f = 0; f < _base.GetNumFaces(); ++f) {
        if (!touches(f, [&](int v) { return isSharp(v); })) continue;
        for (int const v : _base.GetFaceVertices(f)) seesSharp[static_cast<std::size_t>(v)] = 1;
    }
    for (int f = 0; f < _base.GetNumFaces(); ++f) {
        double const share = shares[static_cast<std::size_t>(f)];
        if (share == 0) continue;
        Far::ConstIndexArray const vertices = _base.GetFaceVertices(f);
        bool const touchesSharp = touches(f, [&](int v) { return isSharp(v); });
        double const numRows = touchesSharp ? withBorder : all, size = vertices.size();
        double faceTerms = 0;
        for (int const v : vertices) {
            double const valence = _base.GetVertexEdges(v).size();
            if (!_isCatmark) {
                faceTerms += (valence + 6 + 12 * (numCells - 1)) / numCells;
            } else if (numCells < 2) {
                faceTerms += 2 * (valence + size);
            } else {
                faceTerms += (2 * valence + 8 + 2 * size + 8 + 16 * (numCells - 2)) / numCells;
            }
        }
        if (!_isCatmark) faceTerms += 12;
        if (start == 0) faceTerms = (_isCatmark ? size : 4) * supportOf(f, lastFaces);
        // Released creases and darts take in both sides.
        bool const takesBothSides = touches(f, [&](int v) { return seesSharp[static_cast<std::size_t>(v)] != 0; });
        terms += share * (numRows + 1) * faceTerms * (takesBothSides ? 2 : 1);
    }
    return terms;
}

void RowEstimate::Check(ShadingOptions const& options, double mostTerms, double bytes) const {
    MeshSize size;
    size.scheme = _refiner.GetSchemeType();
    size.numVertices = _base.GetNumVertices();
    size.numFaces = _base.GetNumFaces();
    size.numFaceCorners = _base.GetNumFaceVertices();
    for (int e = 0; e < _base.GetNumEdges(); ++e)
        size.numCreases += IsSharpEdge(_base, e) && !_base.IsEdgeBoundary(e);
    bool const startsAtZero = std::min(options.startNormals.level, options.weights.level) == 0;
    for (int f = 0; f < _base.GetNumFaces() && startsAtZero; ++f) {
        std::int64_t const numCorners = _base.GetFaceVertices(f).size();
        if (numCorners > 4) size.numNgonTerms += numCorners * numCorners;
    }
    bytes += static_cast<double>(EstimateShadingBytes(size, options.level, sizeof(double)));
    auto const total = static_cast<std::uint64_t>(std::min(bytes, 9.2e18));

    std::string const takes =
        "level " + std::to_string(options.level) + " would take about " + std::to_string(total) + " bytes";
    constexpr double kMost = std::numeric_limits<int>::max();
    // As in ShadeSubdivision, masks have up to 6 terms a face.
    if (NumFaces(options.level) > kMost / 6 || mostTerms > kMost) {
        throw MemoryLimitExceeded(takes + " and more indices than 32 bits can number; use a lower level", total);
    }
    if (options.execution.memoryLimit != 0 && total > options.execution.memoryLimit) {
        throw MemoryLimitExceeded(takes + ", more than the limit of " +
                                      std::to_string(options.execution.memoryLimit) +
                                      "; use a lower level or raise the limit",
                                  total);
    }
}

}  // namespace v1
}  // namespace osd_shading
