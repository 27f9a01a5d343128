// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/primvarTable.h"

#include <opensubdiv/far/primvarRefiner.h>

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "osd_shading/composedRows.h"
#include "osd_shading/oneShotShading.h"
#include "osd_shading/refinedPrimvars.h"

namespace osd_shading {
inline namespace v1 {

template <typename Real>
struct PrimvarRows<Real>::Data {
    SparseRows<Real, 1> rows;
    int numControlValues = 0;
};

namespace {

// --- Evaluation -------------------------------------------------------------------------------------------------

/// `Width` numbers of each row, one after the other: the same sums in the same order for any range and width.
template <int Width, typename Real>
void evaluateColumns(SparseRows<Real, 1> const& rows, Real const* control, std::size_t controlStride, Real* refined,
                     std::size_t stride, int begin, int end) {
    int const* const sources = rows.sources.data();
    Real const* const weights = rows.weights[0].data();
    for (auto row = static_cast<std::size_t>(begin); row < static_cast<std::size_t>(end); ++row) {
        std::array<Real, Width> sum{};
        for (std::size_t t = rows.offsets[row]; t < rows.offsets[row + 1]; ++t) {
            Real const* const source = control + static_cast<std::size_t>(sources[t]) * controlStride;
            for (std::size_t i = 0; i < Width; ++i) sum[i] += weights[t] * source[i];
        }
        std::copy(sum.begin(), sum.end(), refined + row * stride);
    }
}

template <typename Real>
void evaluateRows(SparseRows<Real, 1> const& rows, PrimvarView<Real> const& control, Real* refined,
                  std::size_t stride, int begin, int end) {
    Real const* from = control.data();
    int left = control.width();
    for (; left > 4; left -= 4, from += 4, refined += 4) {
        evaluateColumns<4>(rows, from, control.stride(), refined, stride, begin, end);
    }
    auto const evaluate = left == 1   ? evaluateColumns<1, Real>
                          : left == 2 ? evaluateColumns<2, Real>
                          : left == 3 ? evaluateColumns<3, Real>
                                      : evaluateColumns<4, Real>;
    evaluate(rows, from, control.stride(), refined, stride, begin, end);
}

/// Returns the stride of `refined`.
template <typename Real>
std::size_t checkViews(PrimvarRows<Real> const& rows, PrimvarView<Real> const& control,
                       PrimvarSpan<Real> const& refined) {
    auto const check = [](char const* what, std::size_t size, int numWanted, void const* data, std::size_t stride,
                          int width) {
        std::string const name = what;
        if (size != static_cast<std::size_t>(numWanted)) {
            throw InvalidOptions(name + " has " + std::to_string(size) + " elements; the table has " +
                                 std::to_string(numWanted));
        }
        if (size > 0 && data == nullptr) throw InvalidOptions(name + ": its pointer is null");
        if (stride < static_cast<std::size_t>(width)) {
            throw InvalidOptions(name + ": its stride, " + std::to_string(stride) + ", is less than the width, " +
                                 std::to_string(width));
        }
    };
    int const width = control.width();
    if (width < 1) throw InvalidOptions("control: its width is " + std::to_string(width) + "; give 1 or more");
    std::size_t const stride = refined.stride == 0 ? static_cast<std::size_t>(width) : refined.stride;
    check("control", control.size(), rows.NumControlValues(), control.data(), control.stride(), width);
    check("refined", refined.count, rows.NumRows(), refined.data, stride, width);
    return stride;
}

// --- Building ---------------------------------------------------------------------------------------------------

/// Masks as PrimvarRefiner applies them, each in one go.
struct RecordedMasks {
    std::vector<std::size_t> begins;  // by target
    std::vector<int> sizes;
    std::vector<int> terms;  // sources, or complements of targets
    std::vector<double> weights;

    explicit RecordedMasks(int numTargets)
        : begins(static_cast<std::size_t>(numTargets), 0), sizes(static_cast<std::size_t>(numTargets), 0) {}

    MaskTerms operator()(int target) const {
        auto const i = static_cast<std::size_t>(target);
        return {terms.data() + begins[i], weights.data() + begins[i], sizes[i]};
    }
    void add(int target, int term, double weight) {
        auto const i = static_cast<std::size_t>(target);
        assert(begins[i] + static_cast<std::size_t>(sizes[i]) == terms.size());
        if (weight == 0) return;
        ++sizes[i];
        terms.push_back(term);
        weights.push_back(weight);
    }
};

struct MaskSource {
    int index;
};
struct MaskSources {
    MaskSource operator[](int i) const { return {i}; }
};
struct MaskTarget {
    RecordedMasks* masks;
    int index;

    void Clear() {
        masks->begins[static_cast<std::size_t>(index)] = masks->terms.size();
        masks->sizes[static_cast<std::size_t>(index)] = 0;
    }
    template <typename Weight>
    void AddWithWeight(MaskSource source, Weight weight) {
        masks->add(index, source.index, static_cast<double>(weight));
    }
    template <typename Weight>
    void AddWithWeight(MaskTarget const& other, Weight weight) {
        masks->add(index, ~other.index, static_cast<double>(weight));
    }
};
struct MaskTargets {
    RecordedMasks* masks;
    MaskTarget operator[](int i) const { return {masks, i}; }
};

/// Records what `apply(sources, targets)`, a call of PrimvarRefiner, does.
template <typename Apply>
RecordedMasks record(int numTargets, Apply const& apply) {
    RecordedMasks masks(numTargets);
    MaskSources const sources;
    MaskTargets targets{&masks};
    apply(sources, targets);
    return masks;
}

/// The rows of all elements of the last level: vertices, or values of a channel.
template <typename Real, typename CountOf, typename Interpolate, typename Limit>
PrimvarRows<Real> makeRows(ShadingOptions const& options, bool takesLimit, CountOf const& countOf,
                           Interpolate const& interpolate, Limit const& limit) {
    int const numThreads = options.execution.numThreads;
    ComposedLevel refined = IdentityLevel(countOf(0));
    for (int level = 1; level <= options.level; ++level) {
        RecordedMasks const masks = record(
            countOf(level), [&](auto const& sources, auto& targets) { interpolate(level, sources, targets); });
        refined = ComposeLevel(refined, countOf(level), masks, numThreads);
    }
    int const numElements = refined.NumElements();
    auto data = std::make_shared<typename PrimvarRows<Real>::Data>();
    data->numControlValues = refined.numSources;
    if (takesLimit) {
        RecordedMasks const masks = record(numElements, limit);
        auto const fill = [&](int element, RowSum<1>& sum) {
            MaskTerms const mask = masks(element);
            for (int t = 0; t < mask.size; ++t) refined.AddTo<1>(sum, mask.terms[t], {mask.weights[t]});
        };
        data->rows = BuildRows<Real, 1>(numElements, refined.numSources, numThreads, [&] { return fill; });
    } else {
        auto const fill = [&](int element, RowSum<1>& sum) { refined.AddTo<1>(sum, element, {1}); };
        data->rows = BuildRows<Real, 1>(numElements, refined.numSources, numThreads, [&] { return fill; });
    }
    return PrimvarRows<Real>(std::move(data));
}

template <typename Real>
PrimvarTable<Real> build(Far::TopologyRefiner const& base, int numChannels, ShadingOptions const& options) {
    StageClock clock(options.execution.progress);
    ValidateRefiner(base);
    // What only shading looks at can't be wrong here.
    ShadingOptions own;
    own.level = options.level;
    own.limits.positions = options.limits.positions;
    own.execution = options.execution;
    own = ResolveOptions(own, base);
    // Bytes: while a level is composed there is one of it and of its parent, in double, beside what was built.
    RowEstimate const estimate(base);
    double const terms = estimate.PointTerms(own.level);
    estimate.Check(own, 0, terms * (15 + static_cast<double>(4 + sizeof(Real)) * (1 + numChannels)));
    clock.End("validation", 0.02);

    RefinedTopology const topology(base, own.level);
    Far::PrimvarRefinerReal<double> const refiner(topology.Refiner());
    clock.End("refining", 0.2);
    PrimvarTable<Real> table;
    table.faceSize = topology.IsCatmark() ? 4 : 3;
    bool const takesLimit = own.limits.positions == PositionKind::Limit;
    table.vertexData = makeRows<Real>(
        own, takesLimit, [&](int level) { return topology.Level(level).GetNumVertices(); },
        [&](int level, auto const& sources, auto& targets) { refiner.Interpolate(level, sources, targets); },
        [&](auto const& sources, auto& targets) { refiner.Limit(sources, targets); });
    clock.End("vertex rows", 0.2 + 0.8 / (1 + numChannels));

    Far::TopologyLevel const& last = topology.Level(own.level);
    auto const appendCorners = [&](std::vector<int>& corners, auto const& cornersOf) {
        for (int f = 0; f < last.GetNumFaces(); ++f) {
            if (last.IsFaceHole(f)) continue;
            Far::ConstIndexArray const ofFace = cornersOf(f);
            corners.insert(corners.end(), ofFace.begin(), ofFace.begin() + ofFace.size());
        }
    };
    appendCorners(table.faceVertices, [&](int f) { return last.GetFaceVertices(f); });
    for (int channel = 0; channel < numChannels; ++channel) {
        FaceVaryingRows<Real> rows;
        rows.values = makeRows<Real>(
            own, takesLimit && HasFaceVaryingLimit(topology),
            [&](int level) { return topology.Level(level).GetNumFVarValues(channel); },
            [&](int level, auto const& sources, auto& targets) {
                refiner.InterpolateFaceVarying(level, sources, targets, channel);
            },
            [&](auto const& sources, auto& targets) { refiner.LimitFaceVarying(sources, targets, channel); });
        appendCorners(rows.faceIndices, [&](int f) { return last.GetFaceFVarValues(f, channel); });
        table.faceVarying.push_back(std::move(rows));
        clock.End("face-varying rows", 0.2 + 0.8 * (channel + 2) / (1 + numChannels));
    }
    return table;
}

}  // namespace

template <typename Real>
PrimvarRows<Real>::PrimvarRows() : _data(std::make_shared<Data>()) {}
template <typename Real>
PrimvarRows<Real>::PrimvarRows(std::shared_ptr<Data const> data) : _data(std::move(data)) {}
template <typename Real>
PrimvarRows<Real>::~PrimvarRows() = default;
template <typename Real>
PrimvarRows<Real>::PrimvarRows(PrimvarRows const&) = default;
template <typename Real>
PrimvarRows<Real>::PrimvarRows(PrimvarRows&&) noexcept = default;
template <typename Real>
PrimvarRows<Real>& PrimvarRows<Real>::operator=(PrimvarRows const&) = default;
template <typename Real>
PrimvarRows<Real>& PrimvarRows<Real>::operator=(PrimvarRows&&) noexcept = default;

template <typename Real>
int PrimvarRows<Real>::NumControlValues() const {
    return _data->numControlValues;
}

template <typename Real>
int PrimvarRows<Real>::NumRows() const {
    return _data->rows.NumRows();
}

template <typename Real>
std::size_t PrimvarRows<Real>::NumBytes() const {
    SparseRows<Real, 1> const& rows = _data->rows;
    return rows.offsets.size() * sizeof(std::size_t) + rows.sources.size() * (sizeof(int) + sizeof(Real));
}

template <typename Real>
PrimvarRows<Real> PrimvarRows<Real>::Reordered(ArrayView<int> wanted) const {
    SparseRows<Real, 1> const& from = _data->rows;
    auto data = std::make_shared<Data>();
    data->numControlValues = _data->numControlValues;
    SparseRows<Real, 1>& rows = data->rows;
    rows.offsets.reserve(wanted.size() + 1);
    std::size_t numTerms = 0;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        if (wanted[i] < 0 || wanted[i] >= NumRows()) {
            throw InvalidOptions("element " + std::to_string(i) + " asks for row " + std::to_string(wanted[i]) +
                                 "; there are " + std::to_string(NumRows()));
        }
        auto const row = static_cast<std::size_t>(wanted[i]);
        numTerms += from.offsets[row + 1] - from.offsets[row];
        rows.offsets.push_back(numTerms);
    }
    rows.sources.reserve(numTerms);
    rows.weights[0].reserve(numTerms);
    for (int const i : wanted) {
        auto const row = static_cast<std::size_t>(i);
        for (std::size_t t = from.offsets[row]; t < from.offsets[row + 1]; ++t) {
            rows.sources.push_back(from.sources[t]);
            rows.weights[0].push_back(from.weights[0][t]);
        }
    }
    return PrimvarRows(std::move(data));
}

template <typename Real>
void PrimvarRows<Real>::Evaluate(PrimvarView<Real> control, PrimvarSpan<Real> refined, int numThreads) const {
    std::size_t const stride = checkViews(*this, control, refined);
    if (numThreads < 0) {
        throw InvalidOptions("numThreads is " + std::to_string(numThreads) + "; it must be 0 or more");
    }
    if (numThreads == 0) numThreads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    ParallelFor(NumRows(), numThreads, [&](int begin, int end, int) {
        evaluateRows(_data->rows, control, refined.data, stride, begin, end);
    });
}

template <typename Real>
void PrimvarRows<Real>::EvaluateRange(PrimvarView<Real> control, PrimvarSpan<Real> refined, int begin,
                                      int end) const {
    std::size_t const stride = checkViews(*this, control, refined);
    if (begin < 0 || end < begin || end > NumRows()) {
        throw InvalidOptions("rows " + std::to_string(begin) + " to " + std::to_string(end) +
                             " are no range of the table's " + std::to_string(NumRows()));
    }
    evaluateRows(_data->rows, control, refined.data, stride, begin, end);
}

template <typename Real>
PrimvarTable<Real> BuildPrimvarTable(ControlMesh const& mesh, std::vector<FaceVaryingChannel> const& channels,
                                     ShadingOptions const& options) {
    std::vector<ArrayView<int>> indices;
    std::vector<int> counts;
    for (std::size_t i = 0; i < channels.size(); ++i) {
        FaceVaryingChannel const& channel = channels[i];
        std::string const name = "channel " + std::to_string(i);
        if (!channel.indices.empty() && channel.indices.data() == nullptr) {
            throw InvalidControlMesh(name + ": the pointer of its indices is null");
        }
        if (channel.indices.size() != mesh.faceVertices.size()) {
            throw InvalidControlMesh(name + " has " + std::to_string(channel.indices.size()) +
                                     " indices; the mesh has " + std::to_string(mesh.faceVertices.size()) +
                                     " face corners");
        }
        for (std::size_t k = 0; k < channel.indices.size(); ++k) {
            if (channel.indices[k] >= 0 && channel.indices[k] < channel.numValues) continue;
            throw InvalidControlMesh(name + ": face corner " + std::to_string(k) + " names value " +
                                     std::to_string(channel.indices[k]) + "; there are " +
                                     std::to_string(channel.numValues));
        }
        indices.push_back(channel.indices);
        counts.push_back(channel.numValues);
    }
    CheckVertexMemory(mesh, options.execution.memoryLimit);
    RefinedTopology const base(mesh, 0, indices, counts);
    return build<Real>(base.Refiner(), static_cast<int>(channels.size()), options);
}

template <typename Real>
PrimvarTable<Real> BuildPrimvarTable(Far::TopologyRefiner const& refiner, ShadingOptions const& options) {
    return build<Real>(refiner, refiner.GetNumFVarChannels(), options);
}

std::vector<int> MatchFaceCorners(ArrayView<int> faces, ArrayView<int> wanted, int faceSize) {
    auto const size = static_cast<std::size_t>(faceSize);
    if (faceSize < 3) throw InvalidOptions("faceSize is " + std::to_string(faceSize) + "; give 3 or more");
    if (faces.size() % size != 0 || wanted.size() % size != 0) {
        throw InvalidOptions("an index buffer has a size that is no multiple of " + std::to_string(faceSize));
    }
    auto const sideOf = [size](ArrayView<int> const& buffer, std::size_t corner) {
        std::size_t const next = (corner + 1) % size == 0 ? corner + 1 - size : corner + 1;
        return std::make_pair(buffer[corner], buffer[next]);
    };
    std::vector<std::pair<std::pair<int, int>, int>> sides(faces.size());
    for (std::size_t i = 0; i < sides.size(); ++i) sides[i] = {sideOf(faces, i), static_cast<int>(i)};
    std::sort(sides.begin(), sides.end());

    std::vector<unsigned char> isTaken(faces.size() / size, 0);
    std::vector<int> corners(wanted.size());
    for (std::size_t first = 0; first < wanted.size(); first += size) {
        auto const side = sideOf(wanted, first);
        auto found = std::lower_bound(sides.begin(), sides.end(), std::make_pair(side, 0));
        // Several faces share a side only where the buffer is not manifold.
        bool isFound = false;
        for (; !isFound && found != sides.end() && found->first == side; ++found) {
            auto const corner = static_cast<std::size_t>(found->second), face = corner / size;
            isFound = !isTaken[face];
            for (std::size_t i = 0; isFound && i < size; ++i) {
                std::size_t const at = face * size + (corner + i) % size;
                isFound = faces[at] == wanted[first + i];
                corners[first + i] = static_cast<int>(at);
            }
            if (isFound) isTaken[face] = 1;
        }
        if (!isFound) {
            throw InvalidOptions("face " + std::to_string(first / size) +
                                 " of the wanted order is none of the faces");
        }
    }
    return corners;
}

#define OSD_SHADING_INSTANTIATE(Real)                                                          \
    template class PrimvarRows<Real>;                                                          \
    template OSD_SHADING_API PrimvarTable<Real> BuildPrimvarTable(                             \
        ControlMesh const&, std::vector<FaceVaryingChannel> const&, ShadingOptions const&);    \
    template OSD_SHADING_API PrimvarTable<Real> BuildPrimvarTable(Far::TopologyRefiner const&, \
                                                                  ShadingOptions const&);
OSD_SHADING_INSTANTIATE(float)
OSD_SHADING_INSTANTIATE(double)
#undef OSD_SHADING_INSTANTIATE

}  // namespace v1
}  // namespace osd_shading
