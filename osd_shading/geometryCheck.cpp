// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/geometryCheck.h"

#include <opensubdiv/bfr/refinerSurfaceFactory.h>
#include <opensubdiv/bfr/surface.h>
#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/stencilTableFactory.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "osd_shading/fieldRefiner.h"
#include "osd_shading/inputChecks.h"
#include "osd_shading/limitMasks.h"
#include "osd_shading/oneShotShading.h"
#include "osd_shading/vectorMath.h"

namespace osd_shading {
inline namespace v1 {

namespace Bfr = OpenSubdiv::OPENSUBDIV_VERSION::Bfr;

namespace {

/// A point as OpenSubdiv's refiners and tables want to see it.
struct Point : Vec3<double> {
    void Clear() { *this = {}; }
    template <typename Weight>
    void AddWithWeight(Point const& other, Weight weight) {
        static_cast<Vec3<double>&>(*this) += static_cast<double>(weight) * static_cast<Vec3<double> const&>(other);
    }
};

using Points = std::vector<Point>;

/// How far ours is from theirs, which is always in double: float tables and patches of OpenSubdiv round more than
/// we do.
template <typename Real>
double distance(Vec3<Real> const& ours, Vec3<double> const& theirs) {
    return Length(Vec3<double>{double(ours.x), double(ours.y), double(ours.z)} - theirs);
}

void compare(GeometryComparison& comparison, double difference, int level, int vertex) {
    ++comparison.compared;
    // Not a number is the largest difference of all.
    if (std::isnan(difference)) difference = HUGE_VAL;
    if (comparison.level < 0 || difference > comparison.largest) {
        comparison.largest = difference;
        comparison.level = level;
        comparison.vertex = vertex;
    }
}

template <typename Real>
double sizeOf(PointView<Real> points) {
    Vec3<double> low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    for (std::size_t i = 0; i < points.size(); ++i) {
        Vec3<Real> const p = points[i];
        low = {std::fmin(low.x, double(p.x)), std::fmin(low.y, double(p.y)), std::fmin(low.z, double(p.z))};
        high = {std::fmax(high.x, double(p.x)), std::fmax(high.y, double(p.y)), std::fmax(high.z, double(p.z))};
    }
    double const size = Length(high - low);
    return size > 0 ? size : 1;
}

/// The refined points of one level against OpenSubdiv's factorised stencils.
template <typename Real>
GeometryComparison compareStencils(RefinedTopology const& topology, Points const& control,
                                   std::vector<std::vector<Vec3<Real>>> const& levelPoints, double size) {
    GeometryComparison comparison;
    comparison.name = "stencils";
    if (topology.LastLevel() == 0) return comparison;
    Far::StencilTableFactoryReal<double>::Options options;
    options.generateIntermediateLevels = true;
    options.generateOffsets = false;
    options.maxLevel = static_cast<unsigned int>(topology.LastLevel()) & 15u;
    std::unique_ptr<Far::StencilTableReal<double> const> const table(
        Far::StencilTableFactoryReal<double>::Create(topology.Refiner(), options));
    Points refined(static_cast<std::size_t>(table->GetNumStencils()));
    table->UpdateValues(control, refined);

    std::size_t first = 0;
    for (int level = 1; level <= topology.LastLevel(); ++level) {
        std::vector<Vec3<Real>> const& ours = levelPoints[static_cast<std::size_t>(level)];
        comparison.total += static_cast<std::int64_t>(ours.size());
        for (std::size_t v = 0; v < ours.size(); ++v) {
            compare(comparison, distance(ours[v], refined[first + v]) / size, level, static_cast<int>(v));
        }
        first += ours.size();
    }
    return comparison;
}

/// Whether OpenSubdiv's tangent masks fit the memory that it gives them, sized for as many faces as edges: at
/// non-manifold creases with more faces its `PrimvarRefiner::Limit` writes past the end (3.5 and 3.6).
bool tangentMasksFit(Far::TopologyLevel const& level) {
    int mostFaces = 0, mostEdges = 0;
    for (int v = 0; v < level.GetNumVertices(); ++v) {
        mostFaces = std::max(mostFaces, level.GetVertexFaces(v).size());
        mostEdges = std::max(mostEdges, level.GetVertexEdges(v).size());
    }
    return mostFaces <= mostEdges;
}

/// What OpenSubdiv's level-by-level refiner and its limit give at the last level.
struct OpenSubdivLimits {
    Points positions, tangents1, tangents2;  ///< tangents: empty where OpenSubdiv can't be asked

    OpenSubdivLimits(RefinedTopology const& topology, Points points) {
        Far::PrimvarRefinerReal<double> const refiner(topology.Refiner());
        for (int level = 1; level <= topology.LastLevel(); ++level) {
            Points refined(static_cast<std::size_t>(topology.Level(level).GetNumVertices()));
            refiner.Interpolate(level, points, refined);
            points.swap(refined);
        }
        positions.resize(points.size());
        if (!tangentMasksFit(topology.Level(topology.LastLevel()))) {
            refiner.Limit(points, positions);
            return;
        }
        tangents1.resize(points.size());
        tangents2.resize(points.size());
        refiner.Limit(points, positions, tangents1, tangents2);
    }
};

/// The face of the vertex's ring on whose side OpenSubdiv's tangents lie, or -1 where they have no meaning.
int sideOfTangents(Far::TopologyLevel const& level, CreaseRegions const& regions, int vertex) {
    Far::ConstIndexArray const faces = level.GetVertexFaces(vertex);
    Far::ConstIndexArray const edges = level.GetVertexEdges(vertex);
    if (faces.size() == 0 || level.IsVertexNonManifold(vertex)) return -1;
    switch (regions.Kind(vertex)) {
        case VertexKind::Crease: {
            int first = 0;
            while (!IsSharpEdge(level, edges[first])) ++first;
            return first;
        }
        case VertexKind::Corner:
            // They follow edges 0 and 1: the sector of face 0, a region only where both are sharp.
            return IsSharpEdge(level, edges[0]) && IsSharpEdge(level, edges[1]) ? 0 : -1;
        default:
            return 0;
    }
}

/// Whether exact masks may differ from OpenSubdiv's at a vertex: in tangents, or in positions alone.
bool departsFromMasks(ShadingOptions const& options, Far::TopologyLevel const& level, CreaseRegions const& regions,
                      int vertex, bool inTangents) {
    if (options.limits.normals != LimitNormalKind::Exact) return false;
    switch (regions.Kind(vertex)) {
        case VertexKind::Smooth:
            return level.GetVertexFaces(vertex).size() == 2;
        case VertexKind::Dart:
            return true;
        case VertexKind::Crease:
            return inTangents;
        default:
            return false;
    }
}

template <typename Real>
GeometryComparison compareLimitNormals(LimitStep<Real> const& limit, OpenSubdivLimits const& theirs,
                                       std::vector<Vec3<Real>> const& points, ShadingResult<Real> const& result) {
    GeometryComparison comparison;
    comparison.name = "limit_normals";
    comparison.total = static_cast<std::int64_t>(points.size());
    if (result.options.limits.normals == LimitNormalKind::FaceAverage || theirs.tangents1.empty())
        return comparison;
    Far::TopologyLevel const& level = limit.Level();
    CreaseRegions const& regions = limit.Regions();
    // Where the tangents' product has lost half its digits, two right computations differ more than is tolerated.
    Real const conditioned = std::sqrt(kVanishing<Real>);
    for (int v = 0; v < level.GetNumVertices(); ++v) {
        int const side = sideOfTangents(level, regions, v);
        if (side < 0 || departsFromMasks(result.options, level, regions, v, true)) continue;
        auto const i = static_cast<std::size_t>(v);
        Vec3<double> const normal = Cross<double>(theirs.tangents1[i], theirs.tangents2[i]);
        Real longest = 0;
        for (int const edge : level.GetVertexEdges(v)) {
            Far::ConstIndexArray const ends = level.GetEdgeVertices(edge);
            longest = std::max(longest, Length(points[static_cast<std::size_t>(ends[0])] -
                                               points[static_cast<std::size_t>(ends[1])]));
        }
        if (!(Length(normal) > conditioned * longest * longest)) continue;
        int const value =
            regions.CornerValue(level.GetVertexFaces(v)[side], level.GetVertexFaceLocalIndices(v)[side]);
        compare(comparison, AngleBetween(normal, result.limitNormals[static_cast<std::size_t>(value)]),
                result.options.level, v);
    }
    return comparison;
}

/// Whether Bfr's limit surface is exact at a vertex of the last level, whose masks take what is still sharp for
/// infinitely sharp, as ours do.
bool isBfrExactAt(RefinedTopology const& topology, Far::TopologyLevel const& level, int vertex) {
    if (level.GetVertexFaces(vertex).size() == 0) return false;
    float const vertexSharpness = level.GetVertexSharpness(vertex);
    if (vertexSharpness > 0 && !Sdc::Crease::IsInfinite(vertexSharpness)) return false;
    int numSharp = 0;
    for (int const edge : level.GetVertexEdges(vertex)) {
        float const sharpness = level.GetEdgeSharpness(edge);
        if (sharpness > 0 && !Sdc::Crease::IsInfinite(sharpness)) return false;
        numSharp += sharpness > 0;
    }
    // Darts have no exact mask; a Catmull-Clark vertex of valence 2 is given the mask of a corner.
    bool const isSmooth = numSharp == 0 && vertexSharpness <= 0;
    if (numSharp == 1 && vertexSharpness <= 0) return false;
    return !(isSmooth && topology.IsCatmark() && level.GetVertexFaces(vertex).size() == 2);
}

/// Whether Bfr is exact on a control face, and can be asked about it.
///
/// Bfr makes corners of some non-manifold vertices that Far leaves creases. With a corner of interior valence 2
/// beside a boundary and a crease, 3.5.0 reads memory that it never set (mended in 3.6.0). Under Chaikin's rule
/// sharpness depends on edges beyond the faces round a face, which Bfr does not see.
bool isBfrExactOn(RefinedTopology const& topology, int face) {
    Far::TopologyLevel const& base = topology.Level(0);
    bool const isChaikin =
        topology.Refiner().GetSchemeOptions().GetCreasingMethod() == Sdc::Options::CREASE_CHAIKIN;
    for (int const v : base.GetFaceVertices(face)) {
        if (base.IsVertexNonManifold(v)) return false;
        if (base.GetVertexFaces(v).size() == 2 && !base.IsVertexBoundary(v)) return false;
        if (!isChaikin) continue;
        for (int const edge : base.GetVertexEdges(v)) {
            if (base.IsEdgeSemiSharp(edge)) return false;
        }
    }
    return true;
}

/// The coordinates of a face's corners in its control face.
struct FaceCoordinates {
    double corners[4][2];
};

/// Coordinates of the faces of each level in their control faces, as Bfr parametrises them.
std::vector<FaceCoordinates> findCoordinates(RefinedTopology const& topology, std::vector<int>& baseFaces) {
    int const size = topology.IsCatmark() ? 4 : 3;
    Far::TopologyLevel const& base = topology.Level(0);
    auto const numBase = static_cast<std::size_t>(base.GetNumFaces());
    std::vector<FaceCoordinates> coordinates(numBase), children;
    std::vector<int> baseOfChildren;
    baseFaces.resize(numBase);
    for (std::size_t f = 0; f < numBase; ++f) {
        baseFaces[f] = static_cast<int>(f);
        Bfr::Parameterization const parameters(topology.Scheme(), base.GetFaceVertices(static_cast<int>(f)).size());
        if (parameters.HasSubFaces()) continue;
        for (int i = 0; i < size; ++i) parameters.GetVertexCoord(i, coordinates[f].corners[i]);
    }
    for (int level = 0; level < topology.LastLevel(); ++level) {
        Far::TopologyLevel const& here = topology.Level(level);
        auto const numChildren = static_cast<std::size_t>(topology.Level(level + 1).GetNumFaces());
        children.assign(numChildren, {});
        baseOfChildren.assign(numChildren, 0);
        for (int f = 0; f < here.GetNumFaces(); ++f) {
            Far::ConstIndexArray const faces = here.GetFaceChildFaces(f);
            int const numVertices = here.GetFaceVertices(f).size();
            Bfr::Parameterization const parameters(topology.Scheme(), numVertices);
            auto const& parent = coordinates[static_cast<std::size_t>(f)].corners;
            for (int child = 0; child < faces.size(); ++child) {
                auto const c = static_cast<std::size_t>(faces[child]);
                baseOfChildren[c] = baseFaces[static_cast<std::size_t>(f)];
                for (int i = 0; i < size; ++i) {
                    double* const uv = children[c].corners[i];
                    if (parameters.HasSubFaces()) {
                        // Sub-face i of an n-gon begins at its corner i.
                        double const unit[2] = {i == 1 || i == 2 ? 1.0 : 0.0, i >= 2 ? 1.0 : 0.0};
                        parameters.ConvertNormalizedSubFaceToCoord(child, unit, uv);
                        continue;
                    }
                    // Children keep their parent's orientation; Loop's middle one joins the opposite edges'
                    // midpoints.
                    bool const isMiddle = child == size;
                    int const a = isMiddle ? (i + 1) % 3 : child, b = isMiddle ? (i + 2) % 3 : i;
                    uv[0] = 0.5 * (parent[a][0] + parent[b][0]);
                    uv[1] = 0.5 * (parent[a][1] + parent[b][1]);
                }
            }
        }
        coordinates.swap(children);
        baseFaces.swap(baseOfChildren);
    }
    return coordinates;
}

template <typename Real>
GeometryComparison compareBfr(RefinedTopology const& topology, Points const& control,
                              std::vector<Vec3<Real>> const& limits, double size) {
    int const lastLevel = topology.LastLevel();
    Far::TopologyLevel const& last = topology.Level(lastLevel);
    Far::TopologyLevel const& base = topology.Level(0);
    GeometryComparison comparison;
    comparison.name = "bfr";
    comparison.total = static_cast<std::int64_t>(limits.size());

    // Patches as fine as the last level, so that its vertices are corners of patches, where they are exact.
    using Factory = Bfr::RefinerSurfaceFactory<>;
    Factory::Options options;
    int approximation = std::max(lastLevel, 1);
    auto const reach = [&](float sharpness) {
        if (Sdc::Crease::IsInfinite(sharpness)) return;
        approximation = std::max(approximation, static_cast<int>(std::ceil(sharpness)));
    };
    for (int e = 0; e < base.GetNumEdges(); ++e) reach(base.GetEdgeSharpness(e));
    for (int v = 0; v < base.GetNumVertices(); ++v) reach(base.GetVertexSharpness(v));
    constexpr int kFinest = 10;  // Bfr's own bound
    if (approximation > kFinest) return comparison;
    options.SetApproxLevelSmooth(approximation);
    options.SetApproxLevelSharp(approximation);
    Factory const factory(topology.Refiner(), options);

    // Evaluate each vertex in the first face that holds it, control face by control face.
    std::vector<int> baseFaces;
    std::vector<FaceCoordinates> const coordinates = findCoordinates(topology, baseFaces);
    std::vector<int> faces(baseFaces.size());
    for (std::size_t f = 0; f < faces.size(); ++f) faces[f] = static_cast<int>(f);
    std::stable_sort(faces.begin(), faces.end(), [&](int a, int b) {
        return baseFaces[static_cast<std::size_t>(a)] < baseFaces[static_cast<std::size_t>(b)];
    });
    std::vector<unsigned char> isDone(limits.size(), 0);
    Bfr::Surface<double> surface;
    std::vector<double> patchPoints;
    Bfr::Surface<double>::PointDescriptor const descriptor(3, 3);
    int current = -1;
    bool isValid = false;
    for (int const f : faces) {
        int const baseFace = baseFaces[static_cast<std::size_t>(f)];
        if (baseFace != current) {
            current = baseFace;
            isValid = isBfrExactOn(topology, baseFace) && factory.InitVertexSurface(baseFace, &surface);
            if (isValid) {
                patchPoints.resize(3 * static_cast<std::size_t>(surface.GetNumPatchPoints()));
                surface.PreparePatchPoints(&control[0].x, descriptor, patchPoints.data(), descriptor);
            }
        }
        if (!isValid) continue;
        Far::ConstIndexArray const vertices = last.GetFaceVertices(f);
        for (int i = 0; i < vertices.size(); ++i) {
            auto const v = static_cast<std::size_t>(vertices[i]);
            if (isDone[v] || !isBfrExactAt(topology, last, vertices[i])) continue;
            isDone[v] = 1;
            double const* const coordinate = coordinates[static_cast<std::size_t>(f)].corners[i];
            Vec3<double> theirs;
            surface.Evaluate(coordinate, patchPoints.data(), descriptor, &theirs.x);
            compare(comparison, distance(limits[v], theirs) / size, lastLevel, vertices[i]);
        }
    }
    return comparison;
}

template <typename Real>
GeometryCheck check(RefinedTopology const& topology, PointView<Real> positions, ShadingResult<Real> const& result) {
    // Refine our own way, keeping every level.
    std::vector<std::vector<Vec3<Real>>> levelPoints(1);
    for (std::size_t i = 0; i < positions.size(); ++i) levelPoints[0].push_back(positions[i]);
    for (int level = 1; level <= topology.LastLevel(); ++level) {
        levelPoints.push_back(RefinePoints(topology.RecordMasks<Real>(level), levelPoints.back(), 1));
    }
    CreaseRegions const regions(topology, topology.LastLevel(), 1);
    LimitStep<Real> const limit(topology, topology.LastLevel(), regions, 1, result.options.limits.normals);
    auto const requireCount = [](std::size_t have, int want, char const* what) {
        if (have == static_cast<std::size_t>(want)) return;
        throw InvalidOptions("the result was not shaded from this mesh: it has " + std::to_string(have) + " " +
                             what + ", not " + std::to_string(want));
    };
    requireCount(result.positions.size(), regions.NumVertices(), "vertices");
    requireCount(result.limitNormals.size(), regions.NumValues(), "limit normals");
    std::vector<Vec3<Real>> limits;
    if (result.options.limits.positions == PositionKind::Limit) {
        limits = result.positions;
    } else {
        limit.ApplyToPoints(levelPoints.back(), limits, 1);
        levelPoints.back() = result.positions;
    }

    GeometryCheck check;
    check.modelSize = sizeOf(positions);
    Points control(positions.size());
    for (std::size_t i = 0; i < control.size(); ++i) {
        Vec3<Real> const& p = levelPoints[0][i];
        control[i] = {{double(p.x), double(p.y), double(p.z)}};
    }
    check.comparisons.push_back(compareStencils(topology, control, levelPoints, check.modelSize));

    OpenSubdivLimits const theirs(topology, control);
    GeometryComparison positionsCompared;
    positionsCompared.name = "limit";
    positionsCompared.total = static_cast<std::int64_t>(limits.size());
    for (std::size_t v = 0; v < limits.size(); ++v) {
        if (departsFromMasks(result.options, topology.Level(topology.LastLevel()), regions, static_cast<int>(v),
                             false)) {
            continue;
        }
        compare(positionsCompared, distance(limits[v], theirs.positions[v]) / check.modelSize, topology.LastLevel(),
                static_cast<int>(v));
    }
    check.comparisons.push_back(positionsCompared);
    check.comparisons.push_back(compareBfr(topology, control, limits, check.modelSize));
    check.comparisons.push_back(compareLimitNormals(limit, theirs, levelPoints.back(), result));
    return check;
}

}  // namespace

bool GeometryCheck::Passes(double tolerance) const {
    return std::all_of(comparisons.begin(), comparisons.end(), [&](GeometryComparison const& comparison) {
        return comparison.largest <= (comparison.name == "limit_normals" ? 1000 * tolerance : tolerance);
    });
}

template <typename Real>
GeometryCheck CheckGeometry(ControlMesh const& mesh, PointView<Real> positions, ShadingResult<Real> const& result) {
    ValidateControlMesh(mesh);
    CheckPoints(positions, static_cast<std::size_t>(mesh.numVertices), "positions", "vertex");
    ResolveOptions(result.options, mesh);  // refuses what no result has
    return check(RefinedTopology(mesh, result.options.level), positions, result);
}

template <typename Real>
GeometryCheck CheckGeometry(Far::TopologyRefiner const& refiner, PointView<Real> positions,
                            ShadingResult<Real> const& result) {
    ValidateRefiner(refiner);
    CheckPoints(positions, static_cast<std::size_t>(refiner.GetLevel(0).GetNumVertices()), "positions", "vertex");
    ResolveOptions(result.options, refiner);
    return check(RefinedTopology(refiner, result.options.level), positions, result);
}

#define OSD_SHADING_INSTANTIATE(Real)                                                                  \
    template OSD_SHADING_API GeometryCheck CheckGeometry(ControlMesh const&, PointView<Real>,          \
                                                         ShadingResult<Real> const&);                  \
    template OSD_SHADING_API GeometryCheck CheckGeometry(Far::TopologyRefiner const&, PointView<Real>, \
                                                         ShadingResult<Real> const&);
OSD_SHADING_INSTANTIATE(float)
OSD_SHADING_INSTANTIATE(double)
#undef OSD_SHADING_INSTANTIATE

}  // namespace v1
}  // namespace osd_shading
