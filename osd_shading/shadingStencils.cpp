// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/shadingStencils.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "osd_shading/blendWeights.h"
#include "osd_shading/composedRows.h"
#include "osd_shading/limitFrames.h"
#include "osd_shading/oneShotShading.h"
#include "osd_shading/startNormals.h"
#include "osd_shading/vectorMath.h"

namespace osd_shading {
inline namespace v1 {

namespace {

using Terms = std::vector<std::pair<int, double>>;

template <int Width>
StencilRows toStencils(SparseRows<float, Width>&& rows, int numSources) {
    // The estimate refuses such tables beforehand; what it does not foresee stops here.
    if (rows.sources.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
        throw MemoryLimitExceeded(
            "a stencil table would have more indices than 32 bits can number; use a lower level",
            rows.sources.size() * (sizeof(int) + Width * sizeof(float)));
    }
    StencilRows stencils;
    stencils.numSources = numSources;
    stencils.sizes.reserve(rows.offsets.size() - 1);
    stencils.offsets.reserve(rows.offsets.size() - 1);
    for (std::size_t i = 0; i + 1 < rows.offsets.size(); ++i) {
        stencils.offsets.push_back(static_cast<int>(rows.offsets[i]));
        stencils.sizes.push_back(static_cast<int>(rows.offsets[i + 1] - rows.offsets[i]));
    }
    stencils.indices = std::move(rows.sources);
    stencils.weights = std::move(rows.weights[0]);
    if constexpr (Width == 3) {
        stencils.duWeights = std::move(rows.weights[1]);
        stencils.dvWeights = std::move(rows.weights[2]);
    }
    return stencils;
}

std::vector<int> verticesOfValues(CreaseRegions const& regions) {
    std::vector<int> vertices(static_cast<std::size_t>(regions.NumValues()));
    for (int v = 0; v < regions.NumVertices(); ++v) {
        std::fill(vertices.begin() + regions.FirstValue(v), vertices.begin() + regions.FirstValue(v + 1), v);
    }
    return vertices;
}

/// Whether du or dv of the row vanishes, or both are along each other, for all positions; then both are set to
/// zero.
///
/// Weights that cancelled are rounding of a zero, which would be a direction like any other to who normalises it.
bool dropDegenerateTangents(RowSum<3>& sum, LimitFrame<double> const& frame) {
    auto const lengthOf = [](std::vector<double> const& weights) {
        return std::sqrt(std::inner_product(weights.begin(), weights.end(), weights.begin(), 0.0));
    };
    std::array<double, 3> const smallest{0, kVanishing<double> * lengthOf(frame.tangent1),
                                         kVanishing<double> * lengthOf(frame.tangent2)};
    double squareU = 0, product = 0;
    for (auto& term : sum.Terms()) {
        double &u = term.weights[1], &v = term.weights[2];
        if (std::fabs(u) <= smallest[1]) u = 0;
        if (std::fabs(v) <= smallest[2]) v = 0;
        squareU += u * u;
        product += u * v;
    }
    // What is left of dv across du.
    double across = 0;
    for (auto const& term : sum.Terms()) {
        double const left = term.weights[2] - (squareU > 0 ? product / squareU : 0) * term.weights[1];
        across += left * left;
    }
    if (squareU > 0 && std::sqrt(across) > smallest[2]) return false;
    for (auto& term : sum.Terms()) term.weights[1] = term.weights[2] = 0;
    return true;
}

/// P, du and dv of every value; marks those without tangents in `isAverage`.
StencilRows makeFrames(LimitStep<double> const& limit, std::vector<int> const& valueVertices,
                       ComposedLevel const& points, PositionKind positions, ValueMarks& isAverage, int numThreads) {
    isAverage.assign(valueVertices.size(), 0);
    auto const makeFill = [&] {
        return [&, frames = std::vector<LimitFrame<double>>{}, terms = Terms{}, vertex = -1](
                   int value, RowSum<3>& sum) mutable {
            // The values of a vertex follow each other.
            if (vertex != valueVertices[static_cast<std::size_t>(value)]) {
                vertex = valueVertices[static_cast<std::size_t>(value)];
                FindLimitFrames(limit, vertex, frames);
                terms.clear();
                if (positions == PositionKind::Limit) {
                    limit.AppendVertexTerms(vertex, terms);
                } else {
                    terms.emplace_back(vertex, 1);
                }
            }
            for (auto const& [u, weight] : terms) points.AddTo<3>(sum, u, {weight, 0, 0});
            LimitFrame<double> const& frame =
                frames[static_cast<std::size_t>(value - limit.Regions().FirstValue(vertex))];
            for (std::size_t i = 0; i < frame.vertices.size(); ++i) {
                points.AddTo<3>(sum, frame.vertices[i], {0, frame.tangent1[i], frame.tangent2[i]});
            }
            if (frame.isAverage || dropDegenerateTangents(sum, frame)) {
                isAverage[static_cast<std::size_t>(value)] = 1;
            }
        };
    };
    int const numValues = static_cast<int>(valueVertices.size());
    return toStencils(BuildRows<float, 3>(numValues, points.numSources, numThreads, makeFill), points.numSources);
}

/// The corners that each value in `marks` averages (empty: all values), and the faces that they belong to: all
/// where all values are wanted, otherwise those that are needed. Lists their points in `pointVertices`.
FaceAverages makeAverages(Far::TopologyLevel const& level, CreaseRegions const& regions, StartNormalKind weight,
                          ValueMarks const& marks, std::vector<int>& pointVertices) {
    FaceAverages averages;
    averages.weight = weight;
    averages.offsets.push_back(0);
    auto const isWanted = [&](int value) { return marks.empty() || marks[static_cast<std::size_t>(value)]; };

    // Take down the corners, with faces as the level numbers them.
    std::vector<RegionFan> fans;
    for (int v = 0; v < regions.NumVertices(); ++v) {
        bool isAnyWanted = false;
        for (int value = regions.FirstValue(v); value < regions.FirstValue(v + 1); ++value) {
            isAnyWanted |= isWanted(value);
        }
        if (!isAnyWanted) continue;
        FindRegionFans(level, regions, v, fans);
        for (int i = 0; i < regions.NumVertexValues(v); ++i) {
            RegionFan const& fan = fans[static_cast<std::size_t>(i)];
            if (!isWanted(fan.value)) continue;
            averages.normals.push_back(fan.value);
            averages.faces.insert(averages.faces.end(), fan.faces.begin(), fan.faces.end());
            averages.corners.insert(averages.corners.end(), fan.corners.begin(), fan.corners.end());
            averages.offsets.push_back(static_cast<int>(averages.faces.size()));
        }
    }

    // Number the faces and the points that they need, in the level's order.
    std::vector<int> newFaces(static_cast<std::size_t>(level.GetNumFaces()), marks.empty() ? 0 : -1);
    std::vector<int> newPoints(static_cast<std::size_t>(level.GetNumVertices()), marks.empty() ? 0 : -1);
    for (int const f : averages.faces) {
        newFaces[static_cast<std::size_t>(f)] = 0;
        for (int const v : level.GetFaceVertices(f)) newPoints[static_cast<std::size_t>(v)] = 0;
    }
    int numFaces = 0;
    for (int& face : newFaces) face = face < 0 ? -1 : numFaces++;
    for (int v = 0; v < level.GetNumVertices(); ++v) {
        int& point = newPoints[static_cast<std::size_t>(v)];
        if (point < 0) continue;
        point = static_cast<int>(pointVertices.size());
        pointVertices.push_back(v);
    }
    for (int f = 0; f < level.GetNumFaces(); ++f) {
        if (newFaces[static_cast<std::size_t>(f)] < 0) continue;
        Far::ConstIndexArray const vertices = level.GetFaceVertices(f);
        averages.faceSizes.push_back(vertices.size());
        for (int const v : vertices) averages.faceVertices.push_back(newPoints[static_cast<std::size_t>(v)]);
    }
    for (int& face : averages.faces) face = newFaces[static_cast<std::size_t>(face)];
    return averages;
}

StencilRows makePoints(ComposedLevel const& level, std::vector<int> const& vertices, int numThreads) {
    auto const fill = [&](int row, RowSum<1>& sum) {
        level.AddTo<1>(sum, vertices[static_cast<std::size_t>(row)], {1});
    };
    return toStencils(
        BuildRows<float, 1>(static_cast<int>(vertices.size()), level.numSources, numThreads, [&] { return fill; }),
        level.numSources);
}

/// Start normals: no frames where all are averages of faces.
NormalStencils makeStarts(StartNormalKind kind, RefinedTopology const& topology, int levelIndex,
                          CreaseRegions const& regions, ComposedLevel const& points, int numThreads) {
    NormalStencils starts;
    starts.vertices = verticesOfValues(regions);
    ValueMarks isAverage;
    if (kind == StartNormalKind::Limit || kind == StartNormalKind::LimitSmoothed) {
        LimitStep<double> const limit(topology, levelIndex, regions, numThreads);
        starts.frames = makeFrames(limit, starts.vertices, points, PositionKind::Limit, isAverage, numThreads);
        kind = StartNormalKind::Uniform;
    }
    starts.averages = makeAverages(topology.Level(levelIndex), regions, kind, isAverage, starts.pointVertices);
    starts.points = makePoints(points, starts.pointVertices, numThreads);
    return starts;
}

NormalStencils makeLimits(ShadingOptions const& options, LimitStep<double> const& limit,
                          ComposedLevel const& points) {
    int const numThreads = options.execution.numThreads;
    NormalStencils limits;
    limits.vertices = verticesOfValues(limit.Regions());
    ValueMarks isAverage;
    limits.frames = makeFrames(limit, limits.vertices, points, options.limits.positions, isAverage, numThreads);
    StartNormalKind weight = StartNormalKind::Uniform;
    if (options.limits.normals == LimitNormalKind::FaceAverage) {
        bool const isByCorner = FaceWeightOf(options.startNormals.kind) != FaceWeight::Uniform;
        if (isByCorner) weight = options.startNormals.kind;
        isAverage.clear();
    }
    limits.averages = makeAverages(limit.Level(), limit.Regions(), weight, isAverage, limits.pointVertices);
    limits.points = makePoints(points, limits.pointVertices, numThreads);
    return limits;
}

StencilRows makeSmoothing(LimitStep<double> const& limit, std::vector<int> const& valueVertices, int numThreads) {
    ValueMarks const marks = MarkSmoothed(limit);
    int const numValues = static_cast<int>(valueVertices.size());
    auto const makeFill = [&] {
        return [&, terms = Terms{}](int value, RowSum<1>& sum) mutable {
            if (!marks[static_cast<std::size_t>(value)]) {
                sum.Add(value, {1});
                return;
            }
            terms.clear();
            limit.AppendTerms(valueVertices[static_cast<std::size_t>(value)], value, terms);
            for (auto const& [source, weight] : terms) sum.Add(source, {weight});
        };
    };
    return toStencils(BuildRows<float, 1>(numValues, numValues, numThreads, makeFill), numValues);
}

/// The sums of the normals given at the corners of the control mesh, by value.
StencilRows makeUserSums(Far::TopologyLevel const& level, CreaseRegions const& regions, int numThreads) {
    std::vector<std::vector<int>> cornersOfValue(static_cast<std::size_t>(regions.NumValues()));
    int corner = 0;
    for (int f = 0; f < level.GetNumFaces(); ++f) {
        for (int i = 0; i < level.GetFaceVertices(f).size(); ++i) {
            cornersOfValue[static_cast<std::size_t>(regions.CornerValue(f, i))].push_back(corner++);
        }
    }
    auto const fill = [&](int value, RowSum<1>& sum) {
        for (int const at : cornersOfValue[static_cast<std::size_t>(value)]) sum.Add(at, {1});
    };
    return toStencils(BuildRows<float, 1>(regions.NumValues(), corner, numThreads, [&] { return fill; }), corner);
}

/// N_S of the values where b > 0, over the start normals, level by level.
StencilRows makeSubdivided(ShadingOptions const& options, FieldLevels<double> const& levels,
                           LimitStep<double> const& limit, std::vector<double> const& weights) {
    int const numThreads = options.execution.numThreads, first = options.startNormals.level, last = options.level;

    // Trace back what they need.
    ValueMarks marks(weights.size());
    for (std::size_t value = 0; value < weights.size(); ++value) marks[value] = weights[value] > 0;
    if (std::find(marks.begin(), marks.end(), 1) == marks.end()) {
        return toStencils(SparseRows<float, 1>{}, levels.Regions(first).NumValues());
    }
    std::vector<ValueMarks> needed(static_cast<std::size_t>(last) + 1);
    limit.MarkSources(marks, needed[static_cast<std::size_t>(last)]);
    for (int level = last; level > first; --level) {
        levels.Step(level).MarkSources(needed[static_cast<std::size_t>(level)],
                                       needed[static_cast<std::size_t>(level) - 1]);
    }

    auto const compose = [&](ComposedLevel const& parent, CreaseRegions const& regions, ValueMarks const& wanted,
                             auto const& step, auto weight) {
        std::vector<int> const vertices = verticesOfValues(regions);
        auto const makeFill = [&] {
            return [&, terms = Terms{}](int value, RowSum<1>& sum) mutable {
                if (!wanted[static_cast<std::size_t>(value)]) return;
                terms.clear();
                step.AppendTerms(vertices[static_cast<std::size_t>(value)], value, terms);
                for (auto const& [source, w] : terms) parent.AddTo<1>(sum, source, {w});
            };
        };
        return BuildRows<decltype(weight), 1>(regions.NumValues(), parent.numSources, numThreads, makeFill);
    };
    ComposedLevel normals = IdentityLevel(levels.Regions(first).NumValues());
    for (int level = first + 1; level <= last; ++level) {
        ComposedLevel next;
        next.numSources = normals.numSources;
        next.plain = compose(normals, levels.Regions(level), needed[static_cast<std::size_t>(level)],
                             levels.Step(level), 0.0);
        next.rows.resize(static_cast<std::size_t>(levels.Regions(level).NumValues()));
        std::iota(next.rows.begin(), next.rows.end(), 0);
        normals = std::move(next);
    }
    return toStencils(compose(normals, limit.Regions(), marks, limit, 0.0F), normals.numSources);
}

std::vector<int> collectFaceValues(Far::TopologyLevel const& level, CreaseRegions const& regions) {
    std::vector<int> faceValues;
    for (int f = 0; f < level.GetNumFaces(); ++f) {
        if (level.IsFaceHole(f)) continue;
        int const* const values = regions.FaceValues(f);
        faceValues.insert(faceValues.end(), values, values + level.GetFaceVertices(f).size());
    }
    return faceValues;
}

/// Refuses what would take too much, before any of it is taken.
void checkSize(Far::TopologyRefiner const& refiner, ShadingOptions const& options) {
    RowEstimate const estimate(refiner);
    int const start = options.startNormals.level;
    bool const averagesAll = options.limits.normals == LimitNormalKind::FaceAverage;
    // Bytes, as measured: a term of the frames is an index and three weights, and while they are built one in
    // double and what is not yet joined; of other tables an index and a weight; lists of faces have some 30 a
    // corner.
    double const limits = estimate.PointTerms(options.level), starts = estimate.PointTerms(start);
    double const normals = estimate.NormalTerms(options);
    double const corners = 4 * (estimate.NumFaces(start) + (averagesAll ? estimate.NumFaces(options.level) : 0));
    double const bytes = (16 + 24 + (averagesAll ? 8 : 0)) * limits + 16 * starts + 8 * normals + 30 * corners;
    estimate.Check(options, std::max({limits, starts, normals}), std::max(bytes, 23 * normals));
}

void checkView(PointView<float> const& view, int count, char const* name) {
    std::string const what = name;
    if (view.size() != static_cast<std::size_t>(count)) {
        throw InvalidOptions(what + " has " + std::to_string(view.size()) + " elements; its table has " +
                             std::to_string(count) + " rows");
    }
    if (count == 0) return;
    if (view.data() == nullptr) throw InvalidOptions(what + ": its pointer is null");
    if (view.stride() < 3) {
        throw InvalidOptions(what + ": its stride is " + std::to_string(view.stride()) + "; give 3 or more");
    }
}

// "Without control vertices" from stencil 0 on: with them, OpenSubdiv expects their own stencils to come first.
struct FarTable : Far::StencilTable {
    explicit FarTable(StencilRows const& rows)
        : Far::StencilTable(rows.numSources, rows.offsets, rows.sizes, rows.indices, rows.weights, false, 0) {}
};

struct FarLimitTable : Far::LimitStencilTable {
    explicit FarLimitTable(StencilRows const& rows)
        : Far::LimitStencilTable(rows.numSources, rows.offsets, rows.sizes, rows.indices, rows.weights,
                                 rows.duWeights, rows.dvWeights, {}, {}, {}, false, 0) {}
};

}  // namespace

std::unique_ptr<Far::StencilTable const> MakeFarStencilTable(StencilRows const& rows) {
    return std::make_unique<FarTable>(rows);
}

std::unique_ptr<Far::LimitStencilTable const> MakeFarLimitStencilTable(StencilRows const& rows) {
    return std::make_unique<FarLimitTable>(rows);
}

ShadingStencils BuildShadingStencils(ControlMesh const& mesh, ShadingOptions const& options) {
    CheckVertexMemory(mesh, options.execution.memoryLimit);
    RefinedTopology const base(mesh, 0);
    return BuildShadingStencils(base.Refiner(), options);
}

ShadingStencils BuildShadingStencils(Far::TopologyRefiner const& refiner, ShadingOptions const& options) {
    StageClock clock(options.execution.progress);
    ValidateRefiner(refiner);
    ShadingStencils stencils;
    stencils.options = ResolveOptions(options, refiner);
    ShadingOptions const& resolved = stencils.options;
    if (resolved.subdividedNormals.averaging != NormalAveraging::Linear) {
        throw InvalidOptions("stencils hold linear averaging of normals only; use ShadeSubdivision for the others");
    }
    checkSize(refiner, resolved);
    clock.End("validation", 0.02);

    int const numThreads = resolved.execution.numThreads, start = resolved.startNormals.level;
    RefinedTopology const topology(refiner, resolved.level);
    stencils.faceSize = topology.IsCatmark() ? 4 : 3;
    clock.End("refining", 0.1);
    int const firstLevel =
        resolved.weights.scheme == WeightScheme::One ? start : std::min(start, resolved.weights.level);
    FieldLevels<double> const levels(topology, firstLevel, numThreads);
    CreaseRegions const& regions = levels.Regions(resolved.level);
    LimitStep<double> const limit(topology, resolved.level, regions, numThreads, resolved.limits.normals);
    stencils.faceValues = collectFaceValues(topology.Level(resolved.level), regions);
    clock.End("masks and regions", 0.2);

    // Weights, and the normals that they ask for.
    std::vector<double> const weights = ComputeBlendWeights(resolved.weights, topology, levels, limit, numThreads);
    for (double const b : weights) stencils.blendWeights.push_back(static_cast<float>(b));
    stencils.subdividedNormals = makeSubdivided(resolved, levels, limit, weights);
    clock.End("subdivided normals", 0.4);

    // Points, level by level.
    StartNormalKind const kind = resolved.startNormals.kind;
    ComposedLevel points = IdentityLevel(topology.Level(0).GetNumVertices());
    for (int level = 0;; ++level) {
        if (level == start) {
            CreaseRegions const& startRegions = levels.Regions(level);
            if (kind == StartNormalKind::User) {
                stencils.starts.vertices = verticesOfValues(startRegions);
                stencils.userNormals = makeUserSums(topology.Level(0), startRegions, numThreads);
            } else {
                stencils.starts = makeStarts(kind, topology, level, startRegions, points, numThreads);
            }
            if (kind == StartNormalKind::LimitSmoothed) {
                LimitStep<double> const startLimit(topology, level, startRegions, numThreads);
                stencils.startSmoothing = makeSmoothing(startLimit, stencils.starts.vertices, numThreads);
            }
        }
        if (level == resolved.level) break;
        points = level + 1 > firstLevel
                     ? ComposeVertices(points, levels.Masks(level + 1), numThreads)
                     : ComposeVertices(points, topology.RecordMasks<double>(level + 1), numThreads);
        clock.End("points", 0.4 + 0.3 * (level + 1) / resolved.level);
    }
    stencils.limits = makeLimits(resolved, limit, points);
    stencils.options.execution.progress = nullptr;  // what it holds is the caller's
    clock.End("limits", 1);
    return stencils;
}

void ComputeUnitNormals(NormalStencils const& stencils, PointView<float> du, PointView<float> dv,
                        PointView<float> points, std::vector<Vec3<float>>& normals) {
    checkView(du, stencils.frames.NumRows(), "du");
    checkView(dv, stencils.frames.NumRows(), "dv");
    checkView(points, stencils.points.NumRows(), "points");
    normals.assign(stencils.vertices.size(), {});
    for (std::size_t i = 0; i < du.size(); ++i) {
        normals[i] = NormalizedSum(Cross(Normalized(du[i]), Normalized(dv[i])), 1.0F);
    }

    FaceAverages const& averages = stencils.averages;
    std::vector<Vec3<float>> facePoints(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) facePoints[i] = points[i];
    std::vector<Far::ConstIndexArray> faces;
    std::vector<Vec3<float>> faceNormals;
    int const* vertices = averages.faceVertices.data();
    for (int const size : averages.faceSizes) {
        faces.emplace_back(vertices, size);
        faceNormals.push_back(UnitFaceNormal(facePoints, faces.back()));
        vertices += size;
    }
    std::vector<PolygonCorner> corners;
    std::vector<float> weights;
    for (std::size_t i = 0; i < averages.normals.size(); ++i) {
        auto const begin = static_cast<std::size_t>(averages.offsets[i]);
        auto const end = static_cast<std::size_t>(averages.offsets[i + 1]);
        corners.clear();
        for (std::size_t k = begin; k < end; ++k) {
            corners.push_back({faces[static_cast<std::size_t>(averages.faces[k])], averages.corners[k]});
        }
        WeighCorners(facePoints, FaceWeightOf(averages.weight), corners, weights);
        NormalSum<float> sum;
        for (std::size_t k = begin; k < end; ++k) {
            sum.Add(faceNormals[static_cast<std::size_t>(averages.faces[k])], weights[k - begin]);
        }
        normals[static_cast<std::size_t>(averages.normals[i])] = sum.Unit();
    }
}

}  // namespace v1
}  // namespace osd_shading
