// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/blendWeights.h"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cassert>
#include <optional>

#include "osd_shading/extraordinaryVertices.h"
#include "osd_shading/vectorMath.h"
#include "osd_shading/vertexTags.h"

namespace osd_shading {
inline namespace v1 {

namespace {

/// The last of all levels that weights go through.
struct LastLevel {
    CreaseRegions const& regions;  // of the topology's last one
    int numBelow;                  // levels below that
};

/// What the vertex-vertex child of `vertex` is at the last level.
VertexKind kindAtLastLevel(RefinedTopology const& topology, int level, int vertex, LastLevel const& last) {
    for (int l = level; l < topology.LastLevel(); ++l) vertex = topology.Level(l).GetVertexChildVertex(vertex);
    if (last.numBelow > 0) return KindBelow(topology, topology.LastLevel(), vertex, last.numBelow);
    return last.regions.Kind(vertex);
}

void markRegionsOf(BlendWeightOptions const& options, RefinedTopology const& topology, int levelIndex,
                   CreaseRegions const& regions, LastLevel const& last, ValueMarks& eligible) {
    Far::TopologyLevel const& level = topology.Level(levelIndex);
    std::vector<RegionFan> fans;
    for (int v = 0; v < regions.NumVertices(); ++v) {
        if (regions.NumVertexValues(v) == 0) continue;
        VertexKind const kind = regions.Kind(v);
        auto const first = static_cast<std::size_t>(regions.FirstValue(v));
        if (kind == VertexKind::Smooth) {
            eligible[first] = IsExtraordinary(topology, level, v);
        } else if (kind == VertexKind::Dart) {
            eligible[first] = options.darts == DartWeight::LikeSmooth &&
                              (IsExtraordinary(topology, level, v) ||
                               kindAtLastLevel(topology, levelIndex, v, last) == VertexKind::Dart);
        } else if (kindAtLastLevel(topology, levelIndex, v, last) >= VertexKind::Crease) {
            FindRegionFans(level, regions, v, fans);
            for (RegionFan const& fan : fans) {
                bool const isRegular = kind == VertexKind::Corner
                                           ? fan.faces.size() == 1
                                           : IsRegularCreaseRegion(topology.IsCatmark(), fan.faces.size());
                eligible[static_cast<std::size_t>(fan.value)] = !isRegular;
            }
        }
    }
}

ValueMarks findEligible(BlendWeightOptions const& options, RefinedTopology const& topology, int levelIndex,
                        CreaseRegions const& regions, LastLevel const& last) {
    ValueMarks eligible(static_cast<std::size_t>(regions.NumValues()), 0);
    if (options.sharpVertices == SharpVertexWeight::PerRegion) {
        markRegionsOf(options, topology, levelIndex, regions, last, eligible);
        return eligible;
    }
    Far::TopologyLevel const& level = topology.Level(levelIndex);
    for (int v = 0; v < regions.NumVertices(); ++v) {
        if (options.sharpVertices == SharpVertexWeight::Zero && CountsAsSharp(options, regions.Kind(v))) continue;
        if (!IsExtraordinary(topology, level, v)) continue;
        for (int i = 0; i < regions.NumVertexValues(v); ++i) {
            eligible[static_cast<std::size_t>(regions.FirstValue(v) + i)] = 1;
        }
    }
    return eligible;
}

/// The vertices with an eligible value.
template <typename Visit>
void forEachMarkedVertex(CreaseRegions const& regions, ValueMarks const& marks, Visit const& visit) {
    for (int v = 0; v < regions.NumVertices(); ++v) {
        for (int value = regions.FirstValue(v); value < regions.FirstValue(v + 1); ++value) {
            if (marks[static_cast<std::size_t>(value)]) {
                visit(v);
                break;
            }
        }
    }
}

}  // namespace

template <typename Real>
void SeedRings(BlendWeightOptions const& options, Far::TopologyLevel const& level, CreaseRegions const& regions,
               ValueMarks const& eligible, std::vector<Real>& weights) {
    bool const isPerRegion = options.sharpVertices == SharpVertexWeight::PerRegion;
    bool const skipsSharp = options.sharpVertices == SharpVertexWeight::Zero;
    forEachMarkedVertex(regions, eligible, [&](int v) {
        Far::ConstIndexArray const faces = level.GetVertexFaces(v);
        Far::ConstLocalIndexArray const corners = level.GetVertexFaceLocalIndices(v);
        for (int i = 0; i < faces.size(); ++i) {
            if (!eligible[static_cast<std::size_t>(regions.CornerValue(faces[i], corners[i]))]) continue;
            Far::ConstIndexArray const vertices = level.GetFaceVertices(faces[i]);
            for (int k = 0; k < vertices.size(); ++k) {
                int const u = vertices[k];
                if (isPerRegion) {
                    weights[static_cast<std::size_t>(regions.CornerValue(faces[i], k))] = 1;
                } else if (!skipsSharp || !CountsAsSharp(options, regions.Kind(u))) {
                    std::fill(weights.begin() + regions.FirstValue(u), weights.begin() + regions.FirstValue(u + 1),
                              Real(1));
                }
            }
        }
    });
}

namespace {

/// Eligible values whose vertex was not yet eligible at the level before: no region that they came from was.
ValueMarks findNewlyEligible(RefinedTopology const& topology, int levelIndex, CreaseRegions const& parentRegions,
                             CreaseRegions const& regions, ValueMarks const& parentEligible,
                             ValueMarks const& eligible) {
    Far::TopologyLevel const& parent = topology.Level(levelIndex - 1);
    Far::TopologyLevel const& level = topology.Level(levelIndex);
    ValueMarks isNew = eligible;
    forEachMarkedVertex(regions, eligible, [&](int v) {
        if (v >= parent.GetNumVertices()) return;  // the child of a face or an edge
        Far::ConstIndexArray const faces = level.GetVertexFaces(v);
        Far::ConstLocalIndexArray const corners = level.GetVertexFaceLocalIndices(v);
        Far::ConstLocalIndexArray const parentCorners = parent.GetVertexFaceLocalIndices(v);
        for (int i = 0; i < faces.size(); ++i) {
            // The faces of a vertex and of its child have the same order.
            int const parentFace = level.GetFaceParentFace(faces[i]);
            assert(parentFace == parent.GetVertexFaces(v)[i]);
            if (parentEligible[static_cast<std::size_t>(parentRegions.CornerValue(parentFace, parentCorners[i]))]) {
                isNew[static_cast<std::size_t>(regions.CornerValue(faces[i], corners[i]))] = 0;
            }
        }
    });
    return isNew;
}

/// Values at the eligible vertices such that the limit of b is 1 at each. [BBK18]
///
/// One unknown per vertex, or per region in variant C. The system can be singular (a cube at level 0): of all that
/// satisfy it best, the solution of least norm is taken.
template <typename Real>
void seedInverseLimit(BlendWeightOptions const& options, LimitStep<Real> const& limit, ValueMarks const& eligible,
                      std::vector<Real>& weights) {
    CreaseRegions const& regions = limit.Regions();
    bool const isPerRegion = options.sharpVertices == SharpVertexWeight::PerRegion;

    // Number the unknowns.
    std::vector<int> unknownOfValue(weights.size(), -1);
    std::vector<std::pair<int, int>> equations;  // vertex, value
    forEachMarkedVertex(regions, eligible, [&](int v) {
        for (int value = regions.FirstValue(v); value < regions.FirstValue(v + 1); ++value) {
            if (!eligible[static_cast<std::size_t>(value)]) continue;
            if (isPerRegion || value == regions.FirstValue(v)) equations.emplace_back(v, value);
            unknownOfValue[static_cast<std::size_t>(value)] = static_cast<int>(equations.size()) - 1;
        }
    });
    if (equations.empty()) return;

    // Each limit is what the unknowns add to it and what is there already.
    auto const size = static_cast<Eigen::Index>(equations.size());
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd right = Eigen::VectorXd::Ones(size);
    std::vector<std::pair<int, Real>> terms;
    for (int row = 0; row < static_cast<int>(equations.size()); ++row) {
        terms.clear();
        limit.AppendTerms(equations[static_cast<std::size_t>(row)].first,
                          equations[static_cast<std::size_t>(row)].second, terms);
        for (auto const& [value, weight] : terms) {
            int const unknown = unknownOfValue[static_cast<std::size_t>(value)];
            if (unknown >= 0) {
                entries.emplace_back(row, unknown, static_cast<double>(weight));
            } else {
                right[row] -=
                    static_cast<double>(weight) * static_cast<double>(weights[static_cast<std::size_t>(value)]);
            }
        }
    }
    Eigen::SparseMatrix<double, Eigen::RowMajor> matrix(size, size);
    matrix.setFromTriplets(entries.begin(), entries.end());

    // Conjugate gradients from zero find the solution of least norm; a second round takes off the first one's
    // rounding.
    Eigen::LeastSquaresConjugateGradient<decltype(matrix), Eigen::IdentityPreconditioner> solver(matrix);
    solver.setTolerance(1e-14);
    solver.setMaxIterations(1000);
    Eigen::VectorXd solution = solver.solve(right);
    Eigen::VectorXd const residual = right - matrix * solution;
    solution += solver.solve(residual);

    for (std::size_t value = 0; value < weights.size(); ++value) {
        if (unknownOfValue[value] >= 0) weights[value] = static_cast<Real>(solution[unknownOfValue[value]]);
    }
}

/// b of the last level before its limit. `limit`: the last level's, made here where it is null and needed.
/// `history`: takes what each level had, unless it is null.
template <typename Real>
std::vector<Real> refineWeights(BlendWeightOptions const& options, RefinedTopology const& topology,
                                FieldLevels<Real> const& levels, WeightLevels<Real> const& part,
                                LimitStep<Real> const* limit, WeightHistory<Real>* history, int numThreads) {
    auto const numValuesOf = [&](int level) { return static_cast<std::size_t>(levels.Regions(level).NumValues()); };
    int const lastLevel = topology.LastLevel();
    LastLevel const last{levels.Regions(lastLevel), part.numBelow};
    if (options.scheme == WeightScheme::One) return std::vector<Real>(numValuesOf(lastLevel), Real(1));

    std::vector<Real> weights =
        part.given != nullptr ? *part.given : std::vector<Real>(numValuesOf(options.level), Real(0));
    ValueMarks parentEligible;
    for (int level = options.level; level <= lastLevel; ++level) {
        CreaseRegions const& here = levels.Regions(level);
        bool const isFirst = level == options.level;

        // Refine what there is.
        if (!isFirst) {
            std::vector<Real> refined(numValuesOf(level));
            if (options.scheme == WeightScheme::Bilinear) {
                LevelMasks<Real> const masks = topology.RecordMasks<Real>(level, MaskKind::Varying);
                FieldStep<Real> const step(topology, level, masks, levels.Regions(level - 1), here, numThreads);
                step.Apply(weights, refined, {}, numThreads);
            } else {
                levels.Step(level).Apply(weights, refined, {}, numThreads);
            }
            weights.swap(refined);
        }

        // Seed on top of it.
        std::vector<Real> const before = history != nullptr ? weights : std::vector<Real>{};
        auto const keep = [&] {
            if (history == nullptr) return;
            ValueMarks changed(weights.size(), 0);
            for (std::size_t i = 0; i < weights.size(); ++i) {
                changed[i] = std::fabs(weights[i] - before[i]) > kVanishing<Real>;
            }
            history->weights.push_back(weights);
            history->changed.push_back(std::move(changed));
        };
        ValueMarks eligible = findEligible(options, topology, level, here, last);
        if (isFirst && part.given != nullptr) {
            parentEligible.swap(eligible);
            keep();
            continue;
        }
        if (options.scheme == WeightScheme::OneRing) {
            SeedRings(options, topology.Level(level), here, eligible, weights);
            keep();
            continue;
        }
        ValueMarks const isNew =
            isFirst ? eligible
                    : findNewlyEligible(topology, level, levels.Regions(level - 1), here, parentEligible, eligible);
        if (options.scheme == WeightScheme::InverseLimit) {
            if (std::find(isNew.begin(), isNew.end(), 1) != isNew.end()) {
                std::optional<LimitStep<Real>> own;
                if (level != lastLevel || limit == nullptr) own.emplace(topology, level, here, numThreads);
                seedInverseLimit(options, own ? *own : *limit, eligible, weights);
            }
        } else {
            for (std::size_t value = 0; value < weights.size(); ++value) {
                if (isNew[value]) weights[value] = 1;
            }
        }
        parentEligible.swap(eligible);
        keep();
    }
    return weights;
}

}  // namespace

template <typename Real>
WeightHistory<Real> ComputeWeightHistory(BlendWeightOptions const& options, RefinedTopology const& topology,
                                         FieldLevels<Real> const& levels, WeightLevels<Real> const& part,
                                         int numThreads) {
    WeightHistory<Real> history;
    refineWeights<Real>(options, topology, levels, part, nullptr, &history, numThreads);
    return history;
}

template <typename Real>
std::vector<Real> ComputeBlendWeights(BlendWeightOptions const& options, RefinedTopology const& topology,
                                      FieldLevels<Real> const& levels, LimitStep<Real> const& limit,
                                      int numThreads) {
    std::vector<Real> weights = refineWeights<Real>(options, topology, levels, {}, &limit, nullptr, numThreads);
    if (options.scheme == WeightScheme::One) return weights;
    if (options.scheme != WeightScheme::Bilinear) {
        std::vector<Real> limits(weights.size());
        limit.Apply(weights, limits, {}, numThreads);
        weights.swap(limits);
    }
    for (Real& b : weights) b = std::min(std::max(b, Real(0)), Real(1));
    return weights;
}

#define OSD_SHADING_INSTANTIATE(Real)                                                                            \
    template WeightHistory<Real> ComputeWeightHistory(BlendWeightOptions const&, RefinedTopology const&,         \
                                                      FieldLevels<Real> const&, WeightLevels<Real> const&, int); \
    template std::vector<Real> ComputeBlendWeights(BlendWeightOptions const&, RefinedTopology const&,            \
                                                   FieldLevels<Real> const&, LimitStep<Real> const&, int);       \
    template void SeedRings(BlendWeightOptions const&, Far::TopologyLevel const&, CreaseRegions const&,          \
                            ValueMarks const&, std::vector<Real>&);
OSD_SHADING_INSTANTIATE(float)
OSD_SHADING_INSTANTIATE(double)
#undef OSD_SHADING_INSTANTIATE

}  // namespace v1
}  // namespace osd_shading
