// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/tables/tableEstimate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "osd_shading/creaseRegions.h"
#include "osd_shading/errors.h"
#include "osd_shading/subdivisionShading.h"
#include "osd_shading/tables/borderOwners.h"
#include "osd_shading/tables/tileWeights.h"

namespace osd_shading {
inline namespace v1 {
namespace tables {

namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

bool isLimitKind(StartNormalKind kind) {
    return kind == StartNormalKind::Limit || kind == StartNormalKind::LimitSmoothed;
}

/// Whether every level must be refined as a whole.
bool needsWholeLevels(RefinedTopology const& base, ShadingOptions const& options, ValueOrder order) {
    bool const hasGlobalWeights =
        options.weights.scheme != WeightScheme::One && !HasLocalWeights(options.weights, base.Refiner());
    return order == ValueOrder::OpenSubdiv || hasGlobalWeights || NeedsAllLevels(base.Refiner());
}

double numFacesAt(RefinedTopology const& base, int level) {
    Far::TopologyLevel const& mesh = base.Level(0);
    if (level == 0) return mesh.GetNumFaces();
    double const first = base.IsCatmark() ? static_cast<double>(mesh.GetNumFaceVertices())
                                          : 4.0 * static_cast<double>(mesh.GetNumFaces());
    return first * std::pow(4.0, level - 1);
}

/// Counts of a control mesh that the size of its table depends on.
struct MeshCounts {
    double ringVertices = 0;       ///< round each face, over all of them
    double irregularRings = 0;     ///< the same of those that are no splines
    double numIrregularFaces = 0;  ///< of those
    double blendedShare = 0;       ///< of all faces: near a vertex that may seed b
};

MeshCounts countMesh(RefinedTopology const& base, ShadingOptions const& options) {
    Far::TopologyLevel const& level = base.Level(0);
    bool const isCatmark = base.IsCatmark();
    auto const numVertices = index(level.GetNumVertices());
    std::vector<double> rings(numVertices);
    std::vector<unsigned char> isIrregular(numVertices, 0), mayBlend(numVertices, 0);
    for (int v = 0; v < level.GetNumVertices(); ++v) {
        Far::ConstIndexArray const edges = level.GetVertexEdges(v), faces = level.GetVertexFaces(v);
        bool const isBoundary = level.IsVertexBoundary(v);
        bool isSharp = level.GetVertexSharpness(v) > 0 || level.IsVertexNonManifold(v), hasNgon = false;
        for (int const e : edges) isSharp |= IsSharpEdge(level, e);
        double ring = edges.size();
        for (int const f : faces) {
            int const size = level.GetFaceVertices(f).size();
            ring += size - 3;
            hasNgon |= isCatmark && size != 4;
        }
        rings[index(v)] = ring;
        int const regular = isCatmark ? (isBoundary ? 3 : 4) : (isBoundary ? 4 : 6);
        bool const isExtraordinary = edges.size() != regular || hasNgon;
        isIrregular[index(v)] = isSharp || isExtraordinary;
        mayBlend[index(v)] =
            isExtraordinary || (isSharp && options.weights.sharpVertices == SharpVertexWeight::PerRegion);
    }
    // From level 0 on b reaches further.
    for (int grown = options.weights.level == 0 ? 0 : 1; grown < 2; ++grown) {
        std::vector<unsigned char> const from = mayBlend;
        for (int f = 0; f < level.GetNumFaces(); ++f) {
            Far::ConstIndexArray const vertices = level.GetFaceVertices(f);
            bool const touches = std::any_of(vertices.begin(), vertices.begin() + vertices.size(),
                                             [&](int v) { return from[index(v)] != 0; });
            for (int i = 0; i < vertices.size() && touches; ++i) mayBlend[index(vertices[i])] = 1;
        }
    }

    MeshCounts counts;
    double numBlended = 0;
    for (int f = 0; f < level.GetNumFaces(); ++f) {
        double ring = 0;
        bool isRegular = true, blends = false;
        for (int const v : level.GetFaceVertices(f)) {
            ring += rings[index(v)];
            isRegular &= !isIrregular[index(v)];
            blends |= mayBlend[index(v)] != 0;
        }
        ring = std::min(ring, static_cast<double>(level.GetNumVertices()));
        counts.ringVertices += ring;
        numBlended += blends;
        if (isRegular) continue;
        counts.irregularRings += ring;
        ++counts.numIrregularFaces;
    }
    if (options.weights.scheme != WeightScheme::One) counts.blendedShare = numBlended / level.GetNumFaces();
    return counts;
}

}  // namespace

std::uint64_t EstimateTableBytes(RefinedTopology const& base, ShadingOptions const& options, ValueOrder order) {
    Far::TopologyLevel const& mesh = base.Level(0);
    int const start = options.startNormals.level;
    MeshCounts const counts = countMesh(base, options);
    double const numFaces = mesh.GetNumFaces(), numValues = numFacesAt(base, options.level);

    // Bytes, as measured and rounded up: for each face of level 0; each vertex in the ring of one; each irregular
    // face at each level down to the matrices, which has some classes of its own in the worst of cases, and each
    // vertex round that.
    constexpr double kPerFace = 700, kPerRingVertex = 16, kPerIrregular = 5000, kPerIrregularRing = 900;
    double const numSplits = std::min(options.level, 6);
    double bytes =
        1e6 + kPerFace * numFaces + kPerRingVertex * counts.ringVertices +
        numSplits * (kPerIrregular * counts.numIrregularFaces + kPerIrregularRing * counts.irregularRings);
    // Start normals and their sources: for each face of the start level and the edges round it.
    constexpr double kPerStartFace = 1400;
    bytes += kPerStartFace * (numFacesAt(base, start) + 4 * std::pow(2.0, start) * numFaces);
    if (isLimitKind(options.startNormals.kind)) {
        bytes += kPerIrregular * counts.numIrregularFaces + kPerIrregularRing * counts.irregularRings +
                 kPerStartFace * numFacesAt(base, start);
    }
    // b, while it is found and when it is kept.
    double const perWeight = options.weights.exponent == 1 ? 28 : 32;
    bytes += perWeight * counts.blendedShare * numValues;
    if (order == ValueOrder::OpenSubdiv) bytes += 16 * numValues;
    if (needsWholeLevels(base, options, order)) {
        MeshSize size;
        size.scheme = base.Scheme();
        size.numVertices = mesh.GetNumVertices();
        size.numFaces = mesh.GetNumFaces();
        size.numFaceCorners = mesh.GetNumFaceVertices();
        for (int e = 0; e < mesh.GetNumEdges(); ++e) {
            size.numCreases += IsSharpEdge(mesh, e) && !mesh.IsEdgeBoundary(e);
        }
        bytes += static_cast<double>(EstimateShadingBytes(size, options.level, sizeof(double)));
    }
    constexpr double kMost = 9.2e18;
    return static_cast<std::uint64_t>(std::min(bytes, kMost));
}

void CheckTableMemory(RefinedTopology const& base, ShadingOptions const& options, ValueOrder order) {
    std::uint64_t const bytes = EstimateTableBytes(base, options, order);
    std::string const takes = "a table of level " + std::to_string(options.level) + " would take about " +
                              std::to_string(bytes) + " bytes";
    // As in ShadeSubdivision, masks of whole levels have up to 6 terms a face.
    int const wholeLevel = needsWholeLevels(base, options, order) ? options.level : options.startNormals.level;
    if (numFacesAt(base, wholeLevel) > static_cast<double>(std::numeric_limits<int>::max()) / 6) {
        throw MemoryLimitExceeded(takes + " and more indices than 32 bits can number; use a lower level", bytes);
    }
    if (options.execution.memoryLimit != 0 && bytes > options.execution.memoryLimit) {
        throw MemoryLimitExceeded(takes + ", more than the limit of " +
                                      std::to_string(options.execution.memoryLimit) +
                                      "; use a lower level or raise the limit",
                                  bytes);
    }
}

void BuildProgress::Enter(double begin, double end) {
    _begin = begin;
    _end = end;
    Tell(0);
}

void BuildProgress::Tell(double share) {
    constexpr double kStep = 1.0 / 256;
    double const done = _begin + share * (_end - _begin);
    if (!_progress || (done < _told + kStep && done < 1)) return;
    _told = done;
    if (!_progress(done)) throw Cancelled("the build was abandoned");
}

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
