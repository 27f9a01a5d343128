// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "osd_shading/fieldRefiner.h"
#include "osd_shading/parallel.h"
#include "osd_shading/shadingOptions.h"

namespace osd_shading {
inline namespace v1 {

/// Sums over sources: row i is made of `sources` from offsets[i] to offsets[i + 1], which ascend, each with `Width`
/// weights (position and two tangents, say).
template <typename Weight, int Width>
struct SparseRows {
    std::vector<std::size_t> offsets{0};
    std::vector<int> sources;
    std::array<std::vector<Weight>, Width> weights;

    int NumRows() const { return static_cast<int>(offsets.size()) - 1; }
};

/// One row while it is added up, in double.
template <int Width>
class RowSum {
public:
    using Weights = std::array<double, Width>;

    explicit RowSum(int numSources) : _termOfSource(static_cast<std::size_t>(numSources), -1) {}

    void Add(int source, Weights const& weights) {
        int& term = _termOfSource[static_cast<std::size_t>(source)];
        if (term < 0) {
            term = static_cast<int>(_terms.size());
            _terms.push_back({source, weights});
            return;
        }
        Weights& sums = _terms[static_cast<std::size_t>(term)].weights;
        for (std::size_t i = 0; i < Width; ++i) sums[i] += weights[i];
    }

    /// One source of the row, with what was added for it.
    struct Term {
        int source;
        Weights weights;
    };
    /// What was added so far, in no order; weights may be changed.
    std::vector<Term>& Terms() { return _terms; }

    /// Appends what was added as a row, rounded once, and starts anew. Terms without weight are left out.
    template <typename Weight>
    void MoveTo(SparseRows<Weight, Width>& rows) {
        std::sort(_terms.begin(), _terms.end(), [](Term const& a, Term const& b) { return a.source < b.source; });
        for (Term const& term : _terms) {
            _termOfSource[static_cast<std::size_t>(term.source)] = -1;
            if (std::all_of(term.weights.begin(), term.weights.end(), [](double w) { return w == 0; })) continue;
            rows.sources.push_back(term.source);
            for (std::size_t i = 0; i < Width; ++i) {
                rows.weights[i].push_back(static_cast<Weight>(term.weights[i]));
            }
        }
        rows.offsets.push_back(rows.sources.size());
        _terms.clear();
    }

private:
    std::vector<int> _termOfSource;  // -1: not in the row
    std::vector<Term> _terms;
};

/// `numRows` rows over `numSources` sources. `makeFill()`, called once per chunk, returns what adds up a row:
/// fill(row, sum). The result does not depend on the threads.
template <typename Weight, int Width, typename MakeFill>
SparseRows<Weight, Width> BuildRows(int numRows, int numSources, int numThreads, MakeFill const& makeFill) {
    // A sum is as large as there are sources: each thread goes on with one that another chunk has left.
    std::mutex mutex;
    std::vector<std::unique_ptr<RowSum<Width>>> idle;
    std::vector<SparseRows<Weight, Width>> chunks(static_cast<std::size_t>(NumChunks(numRows)));
    ParallelFor(numRows, numThreads, [&](int begin, int end, int chunk) {
        std::unique_ptr<RowSum<Width>> sum;
        {
            std::lock_guard<std::mutex> const lock(mutex);
            if (!idle.empty()) {
                sum = std::move(idle.back());
                idle.pop_back();
            }
        }
        if (!sum) sum = std::make_unique<RowSum<Width>>(numSources);
        auto fill = makeFill();
        for (int row = begin; row < end; ++row) {
            fill(row, *sum);
            sum->MoveTo(chunks[static_cast<std::size_t>(chunk)]);
        }
        std::lock_guard<std::mutex> const lock(mutex);
        idle.push_back(std::move(sum));
    });
    if (chunks.size() == 1) return std::move(chunks[0]);

    // Join them, and let each go when it is copied.
    SparseRows<Weight, Width> rows;
    std::size_t numTerms = 0;
    for (auto const& chunk : chunks) numTerms += chunk.sources.size();
    rows.offsets.reserve(static_cast<std::size_t>(numRows) + 1);
    rows.sources.reserve(numTerms);
    for (auto& weights : rows.weights) weights.reserve(numTerms);
    for (auto& chunk : chunks) {
        std::size_t const first = rows.sources.size();
        for (std::size_t i = 1; i < chunk.offsets.size(); ++i) rows.offsets.push_back(first + chunk.offsets[i]);
        rows.sources.insert(rows.sources.end(), chunk.sources.begin(), chunk.sources.end());
        for (std::size_t i = 0; i < Width; ++i) {
            rows.weights[i].insert(rows.weights[i].end(), chunk.weights[i].begin(), chunk.weights[i].end());
        }
        chunk = {};
    }
    return rows;
}

/// The terms of one mask: of the level before (>= 0), or of the mask's own level (complement, < 0).
struct MaskTerms {
    int const* terms;
    double const* weights;
    int size;
};

/// Every element of a level (vertices, or values of a channel) as a sum over those of the control mesh.
struct ComposedLevel {
    SparseRows<double, 1> plain;    ///< of those whose masks refer to the level before alone
    SparseRows<double, 1> derived;  ///< of those whose masks refer to some of them (Catmull-Clark's face points)
    std::vector<int> rows;          ///< by element: row of `plain`, or complement of a row of `derived`
    int numSources = 0;

    int NumElements() const { return static_cast<int>(rows.size()); }

    /// Adds `weights` times the row of `element`.
    template <int Width>
    void AddTo(RowSum<Width>& sum, int element, std::array<double, Width> const& weights) const {
        int const at = rows[static_cast<std::size_t>(element)];
        SparseRows<double, 1> const& from = at >= 0 ? plain : derived;
        auto const row = static_cast<std::size_t>(at >= 0 ? at : ~at);
        for (std::size_t t = from.offsets[row]; t < from.offsets[row + 1]; ++t) {
            std::array<double, Width> product{};
            for (std::size_t i = 0; i < Width; ++i) product[i] = from.weights[0][t] * weights[i];
            sum.Add(from.sources[t], product);
        }
    }
};

/// The control mesh itself.
ComposedLevel IdentityLevel(int numElements);

/// The level after `parent`, whose element i has the mask `maskOf(i)`.
template <typename MaskOf>
ComposedLevel ComposeLevel(ComposedLevel const& parent, int numElements, MaskOf const& maskOf, int numThreads) {
    ComposedLevel level;
    level.numSources = parent.numSources;
    level.rows.resize(static_cast<std::size_t>(numElements));
    std::vector<int> plain, derived;
    for (int i = 0; i < numElements; ++i) {
        MaskTerms const mask = maskOf(i);
        bool const isDerived = std::any_of(mask.terms, mask.terms + mask.size, [](int term) { return term < 0; });
        std::vector<int>& own = isDerived ? derived : plain;
        level.rows[static_cast<std::size_t>(i)] =
            isDerived ? ~static_cast<int>(own.size()) : static_cast<int>(own.size());
        own.push_back(i);
    }
    auto const build = [&](std::vector<int> const& elements) {
        auto const fill = [&](int row, RowSum<1>& sum) {
            MaskTerms const mask = maskOf(elements[static_cast<std::size_t>(row)]);
            for (int t = 0; t < mask.size; ++t) {
                int const term = mask.terms[t];
                assert(term >= 0 || level.rows[static_cast<std::size_t>(~term)] >= 0);
                (term >= 0 ? parent : level).AddTo<1>(sum, term >= 0 ? term : ~term, {mask.weights[t]});
            }
        };
        return BuildRows<double, 1>(static_cast<int>(elements.size()), parent.numSources, numThreads,
                                    [&] { return fill; });
    };
    level.plain = build(plain);
    level.derived = build(derived);
    return level;
}

/// The vertices of the level after `parent`.
ComposedLevel ComposeVertices(ComposedLevel const& parent, LevelMasks<double> const& masks, int numThreads);

/// What rows may take, from the control mesh alone: estimates from above, but for meshes whose faces at a vertex
/// meet in odd ways.
class RowEstimate {
public:
    explicit RowEstimate(Far::TopologyRefiner const& refiner);

    /// Terms of one row per (vertex, region) of `level` over the control vertices around it.
    double PointTerms(int level) const;
    /// Terms of the rows of N_S over start normals.
    double NormalTerms(ShadingOptions const& options) const;
    /// Faces of `level`.
    double NumFaces(int level) const;

    /// Throws MemoryLimitExceeded where the level has more elements than 32-bit indices can number, a table has
    /// more terms (`mostTerms`), or all takes more than `options.execution.memoryLimit`: `bytes`, besides what a
    /// shading run takes.
    void Check(ShadingOptions const& options, double mostTerms, double bytes) const;

private:
    bool isSharp(int vertex) const { return _isSharp[static_cast<std::size_t>(vertex)] != 0; }
    double supportOf(int face, std::vector<int>& lastFaces) const;
    std::vector<double> findWeightedShares(ShadingOptions const& options) const;

    Far::TopologyRefiner const& _refiner;
    Far::TopologyLevel _base;
    bool _isCatmark;
    std::vector<double> _ringSizes;       // by vertex
    std::vector<unsigned char> _isSharp;  // by vertex: an edge or the vertex itself is
};

}  // namespace v1
}  // namespace osd_shading
