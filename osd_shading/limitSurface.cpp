// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/limitSurface.h"

#include <opensubdiv/bfr/parameterization.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "osd_shading/backToBack.h"
#include "osd_shading/inputChecks.h"
#include "osd_shading/oneShotShading.h"
#include "osd_shading/surface/cutOut.h"
#include "osd_shading/surface/faceClass.h"
#include "osd_shading/surface/facePoints.h"

namespace osd_shading {
inline namespace v1 {

namespace Bfr = OpenSubdiv::OPENSUBDIV_VERSION::Bfr;

namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// The highest levels, left to the library and given, where a neighbourhood may have to be refined whole: each
/// above takes four times as long to build.
constexpr int kMostDefaultWhole = 6, kMostWhole = 8;
/// The most memory in neighbourhoods that are kept for other faces: some 100 kilobytes each, a megabyte and more
/// where creases fade far down.
constexpr std::size_t kMostKeptBytes = std::size_t{256} << 20;

/// Round non-manifold creases what still fades can't be cut out anew.
bool mayBeWhole(Far::TopologyLevel const& base) {
    for (int v = 0; v < base.GetNumVertices(); ++v) {
        if (base.IsVertexNonManifold(v) && base.GetVertexFaces(v).size() > 0) return true;
    }
    return false;
}

int findDefaultLevel(Far::TopologyLevel const& base, ShadingOptions const& options) {
    float sharpest = 0;
    auto const add = [&](float sharpness) {
        if (sharpness < Sdc::Crease::SHARPNESS_INFINITE) sharpest = std::max(sharpest, sharpness);
    };
    for (int e = 0; e < base.GetNumEdges(); ++e) add(base.GetEdgeSharpness(e));
    for (int v = 0; v < base.GetNumVertices(); ++v) add(base.GetVertexSharpness(v));
    int const released = std::min(static_cast<int>(std::ceil(sharpest)), kMaxSurfaceLevel);
    bool const isTooDeep = released > kMostDefaultWhole && mayBeWhole(base);
    return std::max(
        {1, options.startNormals.level, options.weights.level, isTooDeep ? kMostDefaultWhole : released});
}

ShadingOptions resolve(ShadingOptions options, Far::TopologyRefiner const& refiner) {
    if (options.level == kDefaultSurfaceLevel) options.level = findDefaultLevel(refiner.GetLevel(0), options);
    options = ResolveOptions(options, refiner);
    options.execution.progress = nullptr;
    auto const fail = [](std::string const& text) { throw InvalidOptions("a limit surface " + text); };
    if (options.level > kMaxSurfaceLevel) {
        fail("has a level of at most " + std::to_string(kMaxSurfaceLevel) + ", not " +
             std::to_string(options.level));
    }
    if (options.level > kMostWhole && mayBeWhole(refiner.GetLevel(0))) {
        fail("of a mesh with non-manifold vertices has a level of at most " + std::to_string(kMostWhole) +
             ", not " + std::to_string(options.level));
    }
    if (options.subdividedNormals.averaging != NormalAveraging::Linear) {
        fail("has linear averaging of normals only; use ShadeSubdivision for the others");
    }
    if (options.limits.positions != PositionKind::Limit) fail("has limit positions only");
    if (options.limits.normals == LimitNormalKind::FaceAverage) {
        fail("has no faces to average for N_L; take limit or exact limit normals");
    }
    if (options.weights.scheme == WeightScheme::InverseLimit) {
        fail("has no inverse-limit weights, which depend on the whole mesh; take another scheme");
    }
    if (options.weights.scheme == WeightScheme::Bilinear) {
        fail("has no bilinear weights, which have no limit; take another scheme");
    }
    return options;
}

}  // namespace

/// What does not depend on positions.
template <typename Real>
struct LimitSurface<Real>::Topology {
    RefinedTopology mesh;  // level 0
    Far::TopologyLevel const& base;
    surface::FaceClassOptions options;
    std::vector<std::size_t> cornerOffsets;

    mutable std::mutex mutex;
    mutable surface::LimitClasses limitClasses;
    mutable std::unordered_map<std::vector<std::int32_t>, std::shared_ptr<surface::FaceClass const>,
                               tables::KeyHash>
        classes;
    mutable std::size_t keptBytes = 0;

    template <typename Source>
    Topology(Source const& source, ShadingOptions const& given)
        : mesh(source, 0),
          base(mesh.Level(0)),
          options{resolve(given, mesh.Refiner()), tables::RulesOf(mesh.Refiner())},
          limitClasses(mesh.Scheme()) {
        cornerOffsets.push_back(0);
        for (int f = 0; f < base.GetNumFaces(); ++f) {
            cornerOffsets.push_back(cornerOffsets.back() + index(base.GetFaceVertices(f).size()));
        }
        CheckBorders();
        if (!mesh.IsCatmark()) RefuseBackToBack(base, "and a limit surface can't tell their sides apart");
    }

    void CheckBorders() const {
        surface::OneBorder const found = surface::FindOneBorder(base);
        if (found.vertex < 0) return;
        Far::ConstIndexArray const ends = base.GetEdgeVertices(found.edge);
        throw InvalidControlMesh(
            "vertex " + std::to_string(found.vertex) +
            ": faces round it begin and end at the same non-manifold edge (vertices " + std::to_string(ends[0]) +
            ", " + std::to_string(ends[1]) +
            "), and its surface goes on along another one; a limit surface can't follow both, use "
            "ShadeSubdivision");
    }

    std::shared_ptr<surface::FaceClass const> FindClass(tables::TileRing const& cutOut) const {
        std::vector<std::int32_t> key;
        cutOut.AppendKey(key);
        std::lock_guard<std::mutex> const lock(mutex);
        auto const known = classes.find(key);
        if (known != classes.end()) return known->second;
        std::shared_ptr<surface::FaceClass const> made = surface::MakeFaceClass(options, cutOut, limitClasses);
        std::size_t const bytes = made->NumBytes() + key.capacity() * sizeof key[0];
        if (keptBytes + bytes <= kMostKeptBytes) {
            classes.emplace(std::move(key), made);
            keptBytes += bytes;
        }
        return made;
    }
};

/// What does: by face, built when it is asked for.
template <typename Real>
struct LimitSurface<Real>::Faces {
    ShadingInput<Real> input;
    std::size_t count;
    std::unique_ptr<std::atomic<surface::FacePoints<Real> const*>[]> faces;
    mutable std::atomic<std::int64_t> numBuilt{0};
    mutable std::atomic<std::size_t> numBytes{0};

    Faces(Topology const& topology, ShadingInput<Real> const& given)
        : input(given),
          count(index(topology.base.GetNumFaces())),
          faces(new std::atomic<surface::FacePoints<Real> const*>[count]()) {
        CheckPoints(input.positions, index(topology.base.GetNumVertices()), "positions", "vertex");
        if (topology.options.shading.startNormals.kind == StartNormalKind::User) {
            CheckUserNormals(input, index(topology.base.GetNumVertices()), topology.cornerOffsets.back());
        }
    }
    Faces(Faces const&) = delete;
    Faces& operator=(Faces const&) = delete;
    ~Faces() {
        for (std::size_t f = 0; f < count; ++f) delete faces[f].load(std::memory_order_relaxed);
    }

    surface::FacePoints<Real> const& Get(Topology const& topology, int face) const {
        auto& place = faces[index(face)];
        surface::FacePoints<Real> const* built = place.load(std::memory_order_acquire);
        return built != nullptr ? *built : build(topology, face);
    }

private:
    surface::FacePoints<Real> const& build(Topology const& topology, int face) const {
        tables::TileRing const cutOut =
            surface::FindCutOut(topology.base, face, surface::NumRingsOf(topology.options));
        std::shared_ptr<surface::FaceClass const> const faceClass = topology.FindClass(cutOut);
        auto made = std::make_unique<surface::FacePoints<Real>>(topology.options.shading, *faceClass, cutOut, input,
                                                                topology.cornerOffsets);
        std::size_t const bytes = made->NumBytes();
        surface::FacePoints<Real> const* expected = nullptr;
        auto& place = faces[index(face)];
        if (!place.compare_exchange_strong(expected, made.get(), std::memory_order_acq_rel)) {
            return *expected;  // another thread was first, with the same numbers
        }
        ++numBuilt;
        numBytes += bytes;
        return *made.release();
    }
};

template <typename Real>
LimitSurface<Real>::LimitSurface(ControlMesh const& mesh, ShadingInput<Real> const& input,
                                 ShadingOptions const& options) {
    if (mesh.numVertices > 0) CheckPoints(input.positions, index(mesh.numVertices), "positions", "vertex");
    ValidateControlMesh(mesh);
    _topology = std::make_shared<Topology const>(mesh, options);
    _faces = std::make_shared<Faces const>(*_topology, input);
}

template <typename Real>
LimitSurface<Real>::LimitSurface(Far::TopologyRefiner const& refiner, ShadingInput<Real> const& input,
                                 ShadingOptions const& options) {
    ValidateRefiner(refiner);
    _topology = std::make_shared<Topology const>(refiner, options);
    _faces = std::make_shared<Faces const>(*_topology, input);
}

template <typename Real>
LimitSurface<Real> LimitSurface<Real>::Moved(ShadingInput<Real> const& input) const {
    LimitSurface moved;
    moved._topology = _topology;
    moved._faces = std::make_shared<Faces const>(*_topology, input);
    return moved;
}

template <typename Real>
ShadingInput<Real> const& LimitSurface<Real>::Input() const {
    return _faces->input;
}
template <typename Real>
ShadingOptions const& LimitSurface<Real>::Options() const {
    return _topology->options.shading;
}
template <typename Real>
Far::TopologyRefiner const& LimitSurface<Real>::Refiner() const {
    return _topology->mesh.Refiner();
}
template <typename Real>
int LimitSurface<Real>::NumFaces() const {
    return _topology->base.GetNumFaces();
}
template <typename Real>
int LimitSurface<Real>::FaceSize(int face) const {
    return _topology->base.GetFaceVertices(face).size();
}
template <typename Real>
bool LimitSurface<Real>::IsHole(int face) const {
    return _topology->base.IsFaceHole(face);
}

template <typename Real>
SurfacePoint<Real> LimitSurface<Real>::Evaluate(int face, Real u, Real v, SurfaceDerivatives derivatives) const {
    SurfaceParameter<Real> const parameter{u, v};
    SurfacePoint<Real> point;
    Evaluate(face, {&parameter, 1}, &point, derivatives);
    return point;
}

template <typename Real>
void LimitSurface<Real>::Evaluate(int face, ArrayView<SurfaceParameter<Real>> parameters,
                                  SurfacePoint<Real>* points, SurfaceDerivatives derivatives) const {
    if (face < 0 || face >= NumFaces()) {
        throw InvalidOptions("face " + std::to_string(face) + " is evaluated; the mesh has " +
                             std::to_string(NumFaces()));
    }
    surface::FacePoints<Real> const& built = _faces->Get(*_topology, face);
    ShadingOptions const& options = _topology->options.shading;
    bool const isCatmark = _topology->mesh.IsCatmark(), hasSecond = derivatives == SurfaceDerivatives::Second;
    int const size = FaceSize(face);
    Bfr::Parameterization const parametrization(_topology->mesh.Scheme(), size);
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        Real u = parameters[i].u, v = parameters[i].v, scale = 1;
        int root = 0;
        if (isCatmark && size != 4) {
            // The widest layout, of 65535 quads, has 256 to a side; NaN fails the comparisons.
            constexpr Real kWidest = 256;
            Real const given[2] = {u > 0 ? std::min(u, kWidest) : 0, v > 0 ? std::min(v, kWidest) : 0};
            Real inFace[2];
            root = std::min(std::max(parametrization.ConvertCoordToNormalizedSubFace(given, inFace), 0), size - 1);
            u = inFace[0];
            v = inFace[1];
            scale = 2;
        }
        u = u > 0 ? std::min(u, Real(1)) : Real(0);
        v = v > 0 ? std::min(v, Real(1)) : Real(0);
        if (!isCatmark && u + v > 1) {
            Real const excess = (u + v - 1) / 2;
            u = std::max(Real(0), std::min(Real(1), u - excess));
            v = 1 - u;
        }
        built.Evaluate(options.weights.exponent, root, u, v, scale, hasSecond, points[i]);
    }
}

template <typename Real>
LimitSurfaceStats LimitSurface<Real>::Stats() const {
    LimitSurfaceStats stats;
    stats.builtFaces = _faces->numBuilt;
    stats.bytes = _faces->numBytes;
    std::lock_guard<std::mutex> const lock(_topology->mutex);
    stats.faceClasses = static_cast<std::int64_t>(_topology->classes.size());
    stats.limitClasses = static_cast<std::int64_t>(_topology->limitClasses.NumClasses());
    return stats;
}

#define OSD_SHADING_INSTANTIATE(Real) template class OSD_SHADING_API LimitSurface<Real>;
OSD_SHADING_INSTANTIATE(float)
OSD_SHADING_INSTANTIATE(double)
#undef OSD_SHADING_INSTANTIATE

}  // namespace v1
}  // namespace osd_shading
