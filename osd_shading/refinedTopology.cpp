// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/refinedTopology.h"

#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/topologyDescriptor.h>

#include <algorithm>
#include <cassert>
#include <string>
#include <unordered_map>

#include "osd_shading/errors.h"

namespace osd_shading {
inline namespace v1 {

namespace {

/// Entries that name one element, joined to the highest sharpness: OpenSubdiv would take the last.
struct JoinedCreases {
    std::vector<int> vertices;
    std::vector<float> sharpness;

    JoinedCreases(ArrayView<int> pairs, ArrayView<float> values) {
        std::unordered_map<std::uint64_t, std::size_t> entries;
        entries.reserve(values.size());
        for (std::size_t i = 0; i < values.size(); ++i) {
            auto const [a, b] = std::minmax(pairs[2 * i], pairs[2 * i + 1]);
            auto const key = (static_cast<std::uint64_t>(a) << 32) | static_cast<std::uint32_t>(b);
            auto const [entry, isNew] = entries.emplace(key, sharpness.size());
            if (isNew) {
                vertices.insert(vertices.end(), {a, b});
                sharpness.push_back(values[i]);
            } else {
                sharpness[entry->second] = std::max(sharpness[entry->second], values[i]);
            }
        }
    }
};

struct JoinedCorners {
    std::vector<int> vertices;
    std::vector<float> sharpness;

    JoinedCorners(ArrayView<int> corners, ArrayView<float> values) {
        std::unordered_map<int, std::size_t> entries;
        for (std::size_t i = 0; i < values.size(); ++i) {
            auto const [entry, isNew] = entries.emplace(corners[i], sharpness.size());
            if (isNew) {
                vertices.push_back(corners[i]);
                sharpness.push_back(values[i]);
            } else {
                sharpness[entry->second] = std::max(sharpness[entry->second], values[i]);
            }
        }
    }
};

std::string faceName(int face) { return "face " + std::to_string(face); }

/// Takes down each mask as PrimvarRefiner applies it.
template <typename Real>
struct Recorder {
    LevelMasks<Real>* masks;
    int* term;
    Real* weight;

    void add(int source, Real w) {
        if (w == 0) return;  // crease masks name every edge, most with no weight
        *term++ = source;
        *weight++ = w;
    }
};

struct RecorderSource {
    int index;
};
struct RecorderSources {
    RecorderSource operator[](int i) const { return {i}; }
};

template <typename Real>
struct RecorderTarget {
    Recorder<Real>* recorder;
    int index;

    void Clear() {
        LevelMasks<Real>& masks = *recorder->masks;
        masks.offsets[static_cast<std::size_t>(masks.Row(index))] =
            static_cast<int>(recorder->term - masks.terms.data());
    }
    template <typename Weight>
    void AddWithWeight(RecorderSource source, Weight w) {
        recorder->add(source.index, static_cast<Real>(w));
    }
    template <typename Weight>
    void AddWithWeight(RecorderTarget const& facePoint, Weight w) {
        recorder->add(~facePoint.index, static_cast<Real>(w));
    }
};
template <typename Real>
struct RecorderTargets {
    Recorder<Real>* recorder;
    RecorderTarget<Real> operator[](int i) const { return {recorder, i}; }
};

}  // namespace

RefinedTopology::RefinedTopology(ControlMesh const& mesh, int level,
                                 std::vector<ArrayView<int>> const& faceVaryingIndices,
                                 std::vector<int> const& numFaceVaryingValues) {
    ValidateControlMesh(mesh);
    JoinedCreases const creases(mesh.creaseVertices, mesh.creaseSharpness);
    JoinedCorners const corners(mesh.cornerVertices, mesh.cornerSharpness);

    using Descriptor = Far::TopologyDescriptor;
    std::vector<Descriptor::FVarChannel> channels(faceVaryingIndices.size());
    for (std::size_t i = 0; i < channels.size(); ++i) {
        channels[i].numValues = numFaceVaryingValues[i];
        channels[i].valueIndices = faceVaryingIndices[i].data();
    }
    Descriptor descriptor;
    descriptor.numVertices = mesh.numVertices;
    descriptor.numFaces = static_cast<int>(mesh.faceSizes.size());
    descriptor.numVertsPerFace = mesh.faceSizes.data();
    descriptor.vertIndicesPerFace = mesh.faceVertices.data();
    descriptor.numCreases = static_cast<int>(creases.sharpness.size());
    descriptor.creaseVertexIndexPairs = creases.vertices.data();
    descriptor.creaseWeights = creases.sharpness.data();
    descriptor.numCorners = static_cast<int>(corners.sharpness.size());
    descriptor.cornerVertexIndices = corners.vertices.data();
    descriptor.cornerWeights = corners.sharpness.data();
    descriptor.numHoles = static_cast<int>(mesh.holes.size());
    descriptor.holeIndices = mesh.holes.data();
    descriptor.numFVarChannels = static_cast<int>(channels.size());
    descriptor.fvarChannels = channels.data();

    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(mesh.rules.boundary);
    options.SetFVarLinearInterpolation(mesh.rules.faceVarying);
    options.SetCreasingMethod(mesh.rules.creasing);
    options.SetTriangleSubdivision(mesh.rules.triangles);
    using Factory = Far::TopologyRefinerFactory<Descriptor>;
    _refiner.reset(Factory::Create(descriptor, Factory::Options(mesh.rules.scheme, options)));
    if (!_refiner) throw InvalidControlMesh("OpenSubdiv refuses the mesh's topology");
    refine(level);
}

RefinedTopology::RefinedTopology(Far::TopologyRefiner const& base, int level) {
    ValidateRefiner(base);
    _refiner.reset(Far::TopologyRefinerFactory<Far::TopologyDescriptor>::Create(base));
    if (!_refiner) throw InvalidControlMesh("OpenSubdiv can't share the topology of the given refiner");
    refine(level);
}

void RefinedTopology::refine(int level) {
    assert(level >= 0 && level <= 15);
    _lastLevel = level;
    if (level > 0) {
        Far::TopologyRefiner::UniformOptions options(level);
        options.fullTopologyInLastLevel = true;  // limits need the rings of the last level
        _refiner->RefineUniform(options);
    }
    for (int i = 0; i <= level; ++i) _levels.push_back(_refiner->GetLevel(i));

    Far::TopologyLevel const& base = Level(0);
    int const regularSize = IsCatmark() ? 4 : 3;
    for (int f = 0; f < base.GetNumFaces() && !_hasIrregularFaces; ++f) {
        _hasIrregularFaces = base.GetFaceVertices(f).size() != regularSize;
    }
    assert(level == 0 || base.GetVertexChildVertex(base.GetNumVertices() - 1) == base.GetNumVertices() - 1);
}

template <typename Real>
LevelMasks<Real> RefinedTopology::RecordMasks(int childLevel, MaskKind kind) const {
    Far::TopologyLevel const& parent = Level(childLevel - 1);
    Far::TopologyLevel const& child = Level(childLevel);

    LevelMasks<Real> masks;
    masks.numParentVertices = parent.GetNumVertices();
    masks.numChildVertices = child.GetNumVertices();
    masks.numFaceChildren = IsCatmark() ? parent.GetNumFaces() : 0;
    masks.offsets.resize(static_cast<std::size_t>(masks.numChildVertices) + 1);
    // Faces have their corners; edges two ends and two faces (or opposite vertices); vertices themselves and their
    // rings.
    std::size_t const numEdges = static_cast<std::size_t>(parent.GetNumEdges());
    std::size_t const numCorners = static_cast<std::size_t>(parent.GetNumFaceVertices());
    std::size_t const capacity = 2 * numCorners + 6 * numEdges + static_cast<std::size_t>(parent.GetNumVertices());
    masks.terms.resize(capacity);
    masks.weights.resize(capacity);

    Recorder<Real> recorder{&masks, masks.terms.data(), masks.weights.data()};
    RecorderSources const sources;
    RecorderTargets<Real> targets{&recorder};
    Far::PrimvarRefinerReal<Real> const refiner(*_refiner);
    if (kind == MaskKind::Vertex) {
        refiner.Interpolate(childLevel, sources, targets);
    } else {
        refiner.InterpolateVarying(childLevel, sources, targets);
    }
    auto const numTerms = static_cast<std::size_t>(recorder.term - masks.terms.data());
    assert(numTerms <= capacity);
    masks.offsets.back() = static_cast<int>(numTerms);
    masks.terms.resize(numTerms);
    masks.weights.resize(numTerms);
    return masks;
}

template LevelMasks<float> RefinedTopology::RecordMasks<float>(int, MaskKind) const;
template LevelMasks<double> RefinedTopology::RecordMasks<double>(int, MaskKind) const;

void CheckVertexMemory(ControlMesh const& mesh, std::uint64_t memoryLimit) {
    // What OpenSubdiv keeps of a vertex without faces, and what validation takes meanwhile: an estimate from below.
    constexpr std::uint64_t kPerVertex = 30;
    if (memoryLimit == 0 || mesh.numVertices <= 0) return;
    std::uint64_t const bytes = kPerVertex * static_cast<std::uint64_t>(mesh.numVertices);
    if (bytes <= memoryLimit) return;
    throw MemoryLimitExceeded("the " + std::to_string(mesh.numVertices) + " vertices of level 0 would take about " +
                                  std::to_string(bytes) + " bytes, more than the limit of " +
                                  std::to_string(memoryLimit),
                              bytes);
}

void ValidateRefiner(Far::TopologyRefiner const& refiner) {
    if (refiner.GetSchemeType() == Sdc::SCHEME_BILINEAR) {
        throw InvalidControlMesh("the bilinear scheme has no normals to subdivide; use Catmull-Clark or Loop");
    }
    Far::TopologyLevel const base = refiner.GetLevel(0);
    if (base.GetNumVertices() == 0 || base.GetNumFaces() == 0) {
        throw InvalidControlMesh("the refiner holds no mesh: its level 0 has no faces");
    }
    std::vector<int> lastFace(static_cast<std::size_t>(base.GetNumVertices()), -1);
    for (int f = 0; f < base.GetNumFaces(); ++f) {
        Far::ConstIndexArray const vertices = base.GetFaceVertices(f);
        if (vertices.size() < 3) {
            throw InvalidControlMesh(faceName(f) + " has " + std::to_string(vertices.size()) +
                                     " vertices; a face needs 3 or more");
        }
        if (refiner.GetSchemeType() == Sdc::SCHEME_LOOP && vertices.size() != 3) {
            throw InvalidControlMesh(faceName(f) + " has " + std::to_string(vertices.size()) +
                                     " vertices; Loop subdivision takes triangles only");
        }
        for (int const v : vertices) {
            if (v < 0 || v >= base.GetNumVertices()) {
                throw InvalidControlMesh(faceName(f) + " names vertex " + std::to_string(v) + "; there are " +
                                         std::to_string(base.GetNumVertices()) + " vertices");
            }
            int& last = lastFace[static_cast<std::size_t>(v)];
            if (last == f) throw InvalidControlMesh(faceName(f) + " names vertex " + std::to_string(v) + " twice");
            last = f;
        }
    }
    auto const checkSharpness = [](float sharpness, char const* kind, int index) {
        if (!(sharpness >= 0)) {
            throw InvalidControlMesh(std::string("sharpness of ") + kind + " " + std::to_string(index) +
                                     " of the refiner is negative or not a number; give 0 or more");
        }
    };
    for (int e = 0; e < base.GetNumEdges(); ++e) checkSharpness(base.GetEdgeSharpness(e), "edge", e);
    for (int v = 0; v < base.GetNumVertices(); ++v) checkSharpness(base.GetVertexSharpness(v), "vertex", v);
}

}  // namespace v1
}  // namespace osd_shading
