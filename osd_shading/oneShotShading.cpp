// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/oneShotShading.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>
#include <thread>

#include "osd_shading/blendWeights.h"
#include "osd_shading/blendedNormals.h"
#include "osd_shading/errors.h"
#include "osd_shading/limitFrames.h"
#include "osd_shading/numberText.h"
#include "osd_shading/parallel.h"
#include "osd_shading/refinedPrimvars.h"
#include "osd_shading/startNormals.h"
#include "osd_shading/subdividedNormals.h"
#include "osd_shading/vertexTags.h"

namespace osd_shading {
inline namespace v1 {

void StageClock::End(char const* name, double done) {
    auto const now = std::chrono::steady_clock::now();
    _seconds.emplace_back(name, std::chrono::duration<double>(now - _start).count());
    _start = now;
    if (_progress && !_progress(done)) throw Cancelled("the run was abandoned");
}

ShadingOptions ResolveOptions(ShadingOptions options, bool hasIrregularFaces, Sdc::SchemeType scheme) {
    auto const fail = [](std::string const& text) { throw InvalidOptions(text); };
    bool const hasNgons = hasIrregularFaces && scheme == Sdc::SCHEME_CATMARK;
    auto const checkEnum = [&](auto value, auto last, char const* name) {
        int const number = static_cast<int>(value);
        if (number >= 0 && number <= static_cast<int>(last)) return;
        fail(std::string(name) + " is " + std::to_string(number) + ", none that there is");
    };
    checkEnum(options.startNormals.kind, StartNormalKind::User, "startNormals.kind");
    checkEnum(options.subdividedNormals.averaging, NormalAveraging::Spherical, "subdividedNormals.averaging");
    checkEnum(options.weights.scheme, WeightScheme::One, "weights.scheme");
    checkEnum(options.weights.sharpVertices, SharpVertexWeight::PerRegion, "weights.sharpVertices");
    checkEnum(options.weights.darts, DartWeight::LikeSharp, "weights.darts");
    checkEnum(options.limits.positions, PositionKind::Refined, "limits.positions");
    checkEnum(options.limits.normals, LimitNormalKind::Exact, "limits.normals");
    int const level = options.level;
    if (level < 0 || level > 15) fail("level is " + std::to_string(level) + "; it must be 0 to 15");
    if (level == 0 && hasNgons) {
        fail("level is 0, but the mesh has faces other than quads, where limits exist from level 1 on");
    }
    auto const resolve = [&](int& start, char const* name) {
        if (start == kDefaultStartLevel) start = std::min(1, level);
        if (start < 0 || start > level) {
            fail(std::string(name) + " is " + std::to_string(start) + "; it must be 0 to the level, " +
                 std::to_string(level));
        }
    };
    StartNormalOptions& start = options.startNormals;
    if (start.kind == StartNormalKind::User) {
        if (start.level != kDefaultStartLevel && start.level != 0) {
            fail("the start level of normals is " + std::to_string(start.level) +
                 ", but user normals are those of level 0");
        }
        start.level = 0;
    }
    resolve(start.level, "the start level of normals");
    resolve(options.weights.level, "the start level of weights");
    bool const usesLimits = start.kind == StartNormalKind::Limit || start.kind == StartNormalKind::LimitSmoothed;
    if (usesLimits && start.level == 0 && hasNgons) {
        fail("limit normals can't start at level 0, where the mesh has faces other than quads; start at level 1");
    }
    if (options.weights.scheme == WeightScheme::InverseLimit && options.weights.level == 0 && hasNgons) {
        fail("inverse-limit weights can't start at level 0, where the mesh has faces other than quads; start at 1");
    }
    double const exponent = options.weights.exponent;
    if (!(exponent > 0) || !std::isfinite(exponent)) {
        fail("the exponent of the blend weight is " + NumberText(exponent) + "; it must be positive");
    }
    int const steps = options.subdividedNormals.sphericalSteps;
    if (steps < 0 || steps > 100) fail("sphericalSteps is " + std::to_string(steps) + "; it must be 0 to 100");
    int& numThreads = options.execution.numThreads;
    if (numThreads < 0) fail("numThreads is " + std::to_string(numThreads) + "; it must be 0 or more");
    if (numThreads == 0) numThreads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    return options;
}

ShadingOptions ResolveOptions(ShadingOptions const& options, ControlMesh const& mesh) {
    bool const hasIrregularFaces =
        std::any_of(mesh.faceSizes.begin(), mesh.faceSizes.end(), [](int size) { return size != 4; });
    return ResolveOptions(options, hasIrregularFaces, mesh.rules.scheme);
}

ShadingOptions ResolveOptions(ShadingOptions const& options, Far::TopologyRefiner const& refiner) {
    Far::TopologyLevel const base = refiner.GetLevel(0);
    bool hasIrregularFaces = false;
    for (int f = 0; f < base.GetNumFaces(); ++f) hasIrregularFaces |= base.GetFaceVertices(f).size() != 4;
    return ResolveOptions(options, hasIrregularFaces, refiner.GetSchemeType());
}

namespace {

template <typename Real>
std::vector<Vec3<Real>> copyPoints(PointView<Real> const& view) {
    std::vector<Vec3<Real>> points(view.size());
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = view[i];
    return points;
}

/// The points of the levels that the method looks at.
template <typename Real>
struct LevelPoints {
    std::vector<Vec3<Real>> start;  ///< of the start level of normals; empty where they are given
    std::vector<Vec3<Real>> last;
};

template <typename Real>
LevelPoints<Real> refinePoints(RefinedTopology const& topology, FieldLevels<Real> const& levels,
                               PointView<Real> const& control, ShadingOptions const& options) {
    int const numThreads = options.execution.numThreads;
    LevelPoints<Real> points;
    points.last = copyPoints(control);
    for (int level = 0;; ++level) {
        if (level == options.startNormals.level && options.startNormals.kind != StartNormalKind::User) {
            points.start = points.last;
        }
        if (level == topology.LastLevel()) break;
        points.last = level + 1 > levels.FirstLevel()
                          ? RefinePoints(levels.Masks(level + 1), points.last, numThreads)
                          : RefinePoints(topology.RecordMasks<Real>(level + 1), points.last, numThreads);
    }
    return points;
}

/// Edges of the last level on sharp edges of the control mesh.
std::vector<CreaseEdge> collectCreaseEdges(RefinedTopology const& topology) {
    struct Descendant {
        int edge;
        float controlSharpness;
        bool isBoundary;
    };
    std::vector<Descendant> edges, children;
    Far::TopologyLevel const& base = topology.Level(0);
    for (int e = 0; e < base.GetNumEdges(); ++e) {
        if (IsSharpEdge(base, e)) edges.push_back({e, base.GetEdgeSharpness(e), base.IsEdgeBoundary(e)});
    }
    for (int level = 0; level < topology.LastLevel(); ++level) {
        children.clear();
        for (Descendant const& parent : edges) {
            for (int const child : topology.Level(level).GetEdgeChildEdges(parent.edge)) {
                if (child >= 0) children.push_back({child, parent.controlSharpness, parent.isBoundary});
            }
        }
        edges.swap(children);
    }
    Far::TopologyLevel const& last = topology.Level(topology.LastLevel());
    std::vector<CreaseEdge> creases;
    creases.reserve(edges.size());
    for (Descendant const& edge : edges) {
        Far::ConstIndexArray const ends = last.GetEdgeVertices(edge.edge);
        creases.push_back(
            {{ends[0], ends[1]}, edge.controlSharpness, last.GetEdgeSharpness(edge.edge), edge.isBoundary});
    }
    return creases;
}

/// Faces of the last level without holes, and the control face of each.
template <typename Real>
void collectFaces(RefinedTopology const& topology, CreaseRegions const& regions, ShadingResult<Real>& result) {
    // Control faces, level by level.
    int const lastLevel = topology.LastLevel();
    std::vector<int> base(static_cast<std::size_t>(topology.Level(0).GetNumFaces())), next;
    for (std::size_t f = 0; f < base.size(); ++f) base[f] = static_cast<int>(f);
    for (int level = 1; level <= lastLevel; ++level) {
        Far::TopologyLevel const& here = topology.Level(level);
        next.resize(static_cast<std::size_t>(here.GetNumFaces()));
        for (int f = 0; f < here.GetNumFaces(); ++f) {
            next[static_cast<std::size_t>(f)] = base[static_cast<std::size_t>(here.GetFaceParentFace(f))];
        }
        base.swap(next);
    }

    Far::TopologyLevel const& last = topology.Level(lastLevel);
    auto const size = static_cast<std::size_t>(result.faceSize);
    if (!topology.Refiner().HasHoles()) {
        result.faceVertices.reserve(base.size() * size);
        for (int f = 0; f < last.GetNumFaces(); ++f) {
            Far::ConstIndexArray const vertices = last.GetFaceVertices(f);
            result.faceVertices.insert(result.faceVertices.end(), vertices.begin(),
                                       vertices.begin() + vertices.size());
        }
        result.faceValues = regions.CornerValues();
        result.baseFaces.swap(base);
        return;
    }
    for (int f = 0; f < last.GetNumFaces(); ++f) {
        if (last.IsFaceHole(f)) continue;
        Far::ConstIndexArray const vertices = last.GetFaceVertices(f);
        int const* const values = regions.FaceValues(f);
        result.faceVertices.insert(result.faceVertices.end(), vertices.begin(), vertices.begin() + vertices.size());
        result.faceValues.insert(result.faceValues.end(), values, values + result.faceSize);
        result.baseFaces.push_back(base[static_cast<std::size_t>(f)]);
        result.refinerFaces.push_back(f);
    }
}

/// Tags of the vertices of the last level, and their counts.
template <typename Real>
void tagVertices(RefinedTopology const& topology, ShadingResult<Real>& result) {
    Far::TopologyLevel const& last = topology.Level(topology.LastLevel());
    ShadingReport& report = result.report;
    result.vertexTags.resize(static_cast<std::size_t>(last.GetNumVertices()));
    for (int v = 0; v < last.GetNumVertices(); ++v) {
        VertexTag& tag = result.vertexTags[static_cast<std::size_t>(v)];
        tag = TagOf(topology.IsCatmark(), last, v);
        CountTag(tag, report);
    }
    for (int e = 0; e < last.GetNumEdges(); ++e) report.nonManifoldEdges += last.IsEdgeNonManifold(e);
}

struct BlendCounts {
    std::int64_t subdivided = 0, zero = 0, opposed = 0;
    double shortest = -1, angleSum = 0, largestAngle = 0;
    std::int64_t largestValue = -1;

    void add(BlendCounts const& other) {
        subdivided += other.subdivided;
        zero += other.zero;
        opposed += other.opposed;
        angleSum += other.angleSum;
        if (other.shortest >= 0 && (shortest < 0 || other.shortest < shortest)) shortest = other.shortest;
        if (other.largestValue >= 0 && (largestValue < 0 || other.largestAngle > largestAngle)) {
            largestAngle = other.largestAngle;
            largestValue = other.largestValue;
        }
    }
};

/// Normalises N_S, lets it stand in for N_L where nothing else can, and blends; everything is counted.
template <typename Real>
void blend(ShadingOptions const& options, std::vector<int> const& missing, ShadingResult<Real>& result) {
    int const numValues = static_cast<int>(result.blendWeights.size());
    std::vector<BlendCounts> chunks(static_cast<std::size_t>(NumChunks(numValues)));
    result.blendedNormals.resize(static_cast<std::size_t>(numValues));
    ParallelFor(numValues, options.execution.numThreads, [&](int begin, int end, int chunk) {
        BlendCounts& counts = chunks[static_cast<std::size_t>(chunk)];
        for (int i = begin; i < end; ++i) {
            auto const value = static_cast<std::size_t>(i);
            Real const b = result.blendWeights[value];
            Vec3<Real>& subdivided = result.subdividedNormals[value];
            Vec3<Real>& limit = result.limitNormals[value];
            bool const isMissing = std::binary_search(missing.begin(), missing.end(), i);
            if (b > 0 || isMissing) {
                Real const length = Length(subdivided);
                // Weights and normals are at most 1, so a sum vanishes against 1.
                subdivided = length > kVanishing<Real>
                                 ? Vec3<Real>{subdivided.x / length, subdivided.y / length, subdivided.z / length}
                                 : Vec3<Real>{};
                ++counts.subdivided;
                if (b > 0 && (counts.shortest < 0 || static_cast<double>(length) < counts.shortest)) {
                    counts.shortest = static_cast<double>(length);
                }
            }
            if (isMissing) limit = subdivided;
            if (b > 0) {
                counts.opposed += Dot(limit, subdivided) < 0;
            } else {
                subdivided = {};
            }
            Vec3<Real> const blended = BlendNormals(limit, subdivided, b, options.weights.exponent);
            result.blendedNormals[value] = blended;
            counts.zero += IsZero(blended);
            double const angle = b > 0 ? AngleBetween(limit, blended) : 0;
            counts.angleSum += angle;
            if (counts.largestValue < 0 || angle > counts.largestAngle) {
                counts.largestAngle = angle;
                counts.largestValue = i;
            }
        }
    });
    BlendCounts counts;
    for (BlendCounts const& chunk : chunks) counts.add(chunk);

    constexpr double kDegrees = 180 / 3.14159265358979323846;
    ShadingReport& report = result.report;
    report.subdividedValues = counts.subdivided;
    report.zeroNormals = counts.zero;
    report.opposedNormals = counts.opposed;
    report.minSubdividedLength = counts.shortest;
    report.meanAngle = numValues > 0 ? kDegrees * counts.angleSum / numValues : 0;
    report.maxAngle = kDegrees * counts.largestAngle;
    report.maxAngleValue = counts.largestValue;
}

/// The values whose N_S is needed: where b > 0, and where N_L has no other stand-in. Empty: all; nullopt: none.
template <typename Real>
std::optional<ValueMarks> markSubdivided(std::vector<Real> const& weights, std::vector<int> const& missing) {
    ValueMarks marks(weights.size());
    std::size_t numMarked = 0;
    for (std::size_t value = 0; value < weights.size(); ++value) marks[value] = weights[value] > 0;
    for (int const value : missing) marks[static_cast<std::size_t>(value)] = 1;
    for (unsigned char const mark : marks) numMarked += mark;
    if (numMarked == 0) return std::nullopt;
    if (numMarked == marks.size()) return ValueMarks{};
    return marks;
}

}  // namespace

template <typename Real>
ShadingResult<Real> ShadeOnce(RefinedTopology const& topology, ShadingInput<Real> const& input,
                              ShadingOptions const& options, StageClock& clock) {
    int const numThreads = options.execution.numThreads, lastLevel = options.level;
    ShadingResult<Real> result;
    result.options = options;
    result.options.execution.progress = nullptr;  // what it holds is the caller's
    result.faceSize = topology.IsCatmark() ? 4 : 3;

    // Regions of each level, and its masks by region.
    int const firstLevel = options.weights.scheme == WeightScheme::One
                               ? options.startNormals.level
                               : std::min(options.startNormals.level, options.weights.level);
    FieldLevels<Real> const levels(topology, firstLevel, numThreads);
    CreaseRegions const& regions = levels.Regions(lastLevel);
    LimitStep<Real> const limit(topology, lastLevel, regions, numThreads, options.limits.normals);
    clock.End("masks and regions", 0.5);

    // Positions, and the normals of their limit.
    LevelPoints<Real> points = refinePoints(topology, levels, input.positions, options);
    LimitNormals<Real> limitNormals =
        options.limits.normals == LimitNormalKind::FaceAverage
            ? ComputeFaceAverageNormals(limit, points.last, FaceWeightOf(options.startNormals.kind), numThreads)
            : ComputeLimitNormals(limit, points.last, numThreads);
    if (options.limits.positions == PositionKind::Limit) {
        limit.ApplyToPoints(points.last, result.positions, numThreads);
        points.last = {};
    } else {
        result.positions.swap(points.last);
    }
    result.limitNormals.swap(limitNormals.normals);
    result.report.fallbackNormals = limitNormals.numFallbacks;
    result.report.averagedNormals = limitNormals.numAverages;
    clock.End("positions and limit normals", 0.65);

    // Blend weights; then the subdivided normals where they count.
    result.blendWeights = ComputeBlendWeights(options.weights, topology, levels, limit, numThreads);
    clock.End("blend weights", 0.75);
    StartNormals<Real> start =
        options.startNormals.kind == StartNormalKind::User
            ? GatherUserNormals(topology, levels.Regions(0), input.vertexNormals, input.faceVaryingNormals)
            : ComputeStartNormals(options.startNormals.kind, topology, options.startNormals.level,
                                  levels.Regions(options.startNormals.level), points.start, numThreads);
    points.start = {};
    result.report.zeroStartNormals = start.numZero;
    std::optional<ValueMarks> const marks = markSubdivided(result.blendWeights, limitNormals.missing);
    if (marks) {
        result.subdividedNormals =
            ComputeSubdividedNormals(options.subdividedNormals, levels, options.startNormals.level, limit,
                                     std::move(start.normals), *marks, numThreads);
    } else {
        result.subdividedNormals.resize(result.blendWeights.size());
    }
    clock.End("subdivided normals", 0.85);
    blend(options, limitNormals.missing, result);
    clock.End("blend", 0.9);

    // What a renderer needs besides.
    result.vertexValues = regions.FirstValues();
    result.valueVertices.resize(result.blendWeights.size());
    for (int v = 0; v < regions.NumVertices(); ++v) {
        std::fill(result.valueVertices.begin() + regions.FirstValue(v),
                  result.valueVertices.begin() + regions.FirstValue(v + 1), v);
    }
    collectFaces(topology, regions, result);
    tagVertices(topology, result);
    result.creaseEdges = collectCreaseEdges(topology);
    for (PrimvarView<Real> const& data : input.vertexData) {
        result.vertexData.push_back(RefineVertexData(topology, data, options.limits.positions));
    }
    for (std::size_t i = 0; i < input.faceVaryingData.size(); ++i) {
        result.faceVaryingData.push_back(RefineFaceVaryingData(
            topology, static_cast<int>(i), input.faceVaryingData[i].values, options.limits.positions));
    }
    clock.End("faces, tags and primvars", 1);

    ShadingReport& report = result.report;
    report.vertices = result.NumVertices();
    report.faces = result.NumFaces();
    report.values = result.NumValues();
    for (int v = 0; v < result.NumVertices(); ++v) {
        auto const first = result.blendWeights.begin() + regions.FirstValue(v);
        auto const last = result.blendWeights.begin() + regions.FirstValue(v + 1);
        report.verticesWithWeight += std::any_of(first, last, [](Real b) { return b > 0; });
    }
    report.seconds = clock.Seconds();
    return result;
}

#define OSD_SHADING_INSTANTIATE(Real)                                                         \
    template ShadingResult<Real> ShadeOnce(RefinedTopology const&, ShadingInput<Real> const&, \
                                           ShadingOptions const&, StageClock&);
OSD_SHADING_INSTANTIATE(float)
OSD_SHADING_INSTANTIATE(double)
#undef OSD_SHADING_INSTANTIATE

}  // namespace v1
}  // namespace osd_shading
