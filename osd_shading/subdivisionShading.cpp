// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/subdivisionShading.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "osd_shading/inputChecks.h"
#include "osd_shading/oneShotShading.h"

namespace osd_shading {
inline namespace v1 {

namespace {

[[noreturn]] void fail(std::string const& text) { throw InvalidControlMesh(text); }

template <typename Real>
void checkPrimvar(PrimvarView<Real> const& view, std::string const& name) {
    if (view.width() < 1) fail(name + ": its width is " + std::to_string(view.width()) + "; give 1 or more");
    if (view.stride() < static_cast<std::size_t>(view.width())) {
        fail(name + ": its stride, " + std::to_string(view.stride()) + ", is less than its width, " +
             std::to_string(view.width()));
    }
    if (view.size() > 0 && view.data() == nullptr) fail(name + ": its pointer is null");
    if (view.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) fail(name + ": too many values");
}

/// Conditions on the numbers that hold for either kind of topology.
template <typename Real>
void checkInput(ShadingInput<Real> const& input, std::size_t numVertices, std::size_t numFaceCorners,
                ShadingOptions const& options) {
    if (options.startNormals.kind == StartNormalKind::User) CheckUserNormals(input, numVertices, numFaceCorners);
    for (std::size_t i = 0; i < input.vertexData.size(); ++i) {
        std::string const name = "vertexData " + std::to_string(i);
        checkPrimvar(input.vertexData[i], name);
        if (input.vertexData[i].size() != numVertices) {
            fail(name + " has " + std::to_string(input.vertexData[i].size()) + " elements; the mesh has " +
                 std::to_string(numVertices) + " vertices");
        }
    }
    for (std::size_t i = 0; i < input.faceVaryingData.size(); ++i) {
        checkPrimvar(input.faceVaryingData[i].values, "faceVaryingData " + std::to_string(i));
    }
}

template <typename Real>
void addPrimvars(ShadingInput<Real> const& input, MeshSize& size) {
    size.numFaceVarying = static_cast<std::int64_t>(input.faceVaryingData.size());
    for (FaceVaryingView<Real> const& data : input.faceVaryingData) size.faceVaryingWidth += data.values.width();
    for (PrimvarView<Real> const& data : input.vertexData) size.vertexDataWidth += data.width();
}

/// Near a crease each vertex round an n-gon has a row over all its corners.
void addNgon(int numCorners, ShadingOptions const& options, MeshSize& size) {
    if (numCorners <= 4 || std::min(options.startNormals.level, options.weights.level) > 0) return;
    size.numNgonTerms += static_cast<std::int64_t>(numCorners) * numCorners;
}

double numFacesAt(MeshSize const& size, int level) {
    if (level == 0) return static_cast<double>(size.numFaces);
    double const first = size.scheme == Sdc::SCHEME_CATMARK ? static_cast<double>(size.numFaceCorners)
                                                            : 4 * static_cast<double>(size.numFaces);
    return first * std::pow(4.0, level - 1.0);
}

void checkMemory(MeshSize const& size, std::size_t realSize, ShadingOptions const& options) {
    std::uint64_t const bytes = EstimateShadingBytes(size, options.level, realSize);
    std::string const takes =
        "level " + std::to_string(options.level) + " would take about " + std::to_string(bytes) + " bytes";
    // Masks have up to 6 terms a face, and both they and OpenSubdiv count in 32 bits.
    if (numFacesAt(size, options.level) > static_cast<double>(std::numeric_limits<int>::max()) / 6) {
        throw MemoryLimitExceeded(takes + " and more elements than 32-bit indices can number; use a lower level",
                                  bytes);
    }
    if (options.execution.memoryLimit != 0 && bytes > options.execution.memoryLimit) {
        throw MemoryLimitExceeded(takes + ", more than the limit of " +
                                      std::to_string(options.execution.memoryLimit) +
                                      "; use a lower level or raise the limit",
                                  bytes);
    }
}

}  // namespace

std::uint64_t EstimateShadingBytes(MeshSize const& size, int level, std::size_t realSize) {
    // Peaks measured by tests/perf, rounded up: bytes by face of the last level, ...
    bool const isFloat = realSize <= sizeof(float), isCatmark = size.scheme == Sdc::SCHEME_CATMARK;
    double perFace = isCatmark ? (isFloat ? 560 : 655) : (isFloat ? 385 : 440);
    double const width = static_cast<double>(size.faceVaryingWidth) + static_cast<double>(size.vertexDataWidth);
    perFace += 110.0 * static_cast<double>(size.numFaceVarying) + 3.0 * static_cast<double>(realSize) * width;
    // ... by edge of the last level on a crease, and on what may be a boundary, ...
    double const perCreaseEdge = isFloat ? 900 : 1300, perBoundaryEdge = isFloat ? 60 : 100;
    double const edges = std::pow(2.0, level);
    // ... and by vertex of each level where it may be isolated.
    double const perVertex = 130.0 * (level + 2.0);
    double const bytes = perFace * numFacesAt(size, level) +
                         perCreaseEdge * edges * static_cast<double>(size.numCreases) +
                         perBoundaryEdge * edges * static_cast<double>(size.numFaceCorners) +
                         perVertex * static_cast<double>(size.numVertices) +
                         2.0 * static_cast<double>(4 + realSize) * static_cast<double>(size.numNgonTerms) + 2e6;
    // Also where infinite factors met zero ones.
    constexpr double kMost = 9.2e18;
    return static_cast<std::uint64_t>(bytes < kMost ? std::max(bytes, 0.0) : kMost);
}

template <typename Real>
ShadingResult<Real> ShadeSubdivision(ControlMesh const& mesh, ShadingInput<Real> const& input,
                                     ShadingOptions const& options) {
    StageClock clock(options.execution.progress);
    // Before anything is sized by it: a number of vertices without their points is a mistake.
    if (mesh.numVertices > 0) {
        CheckPoints(input.positions, static_cast<std::size_t>(mesh.numVertices), "positions", "vertex");
    }
    ValidateControlMesh(mesh);
    ShadingOptions const resolved = ResolveOptions(options, mesh);
    checkInput(input, static_cast<std::size_t>(mesh.numVertices), mesh.faceVertices.size(), resolved);

    std::vector<ArrayView<int>> indices;
    std::vector<int> counts;
    for (std::size_t i = 0; i < input.faceVaryingData.size(); ++i) {
        FaceVaryingView<Real> const& data = input.faceVaryingData[i];
        std::string const name = "faceVaryingData " + std::to_string(i);
        if (!data.indices.empty() && data.indices.data() == nullptr) {
            fail(name + ": the pointer of its indices is null");
        }
        if (data.indices.size() != mesh.faceVertices.size()) {
            fail(name + " has " + std::to_string(data.indices.size()) + " indices; the mesh has " +
                 std::to_string(mesh.faceVertices.size()) + " face corners");
        }
        for (std::size_t k = 0; k < data.indices.size(); ++k) {
            if (data.indices[k] < 0 || static_cast<std::size_t>(data.indices[k]) >= data.values.size()) {
                fail(name + ": face corner " + std::to_string(k) + " names value " +
                     std::to_string(data.indices[k]) + "; there are " + std::to_string(data.values.size()));
            }
        }
        indices.push_back(data.indices);
        counts.push_back(static_cast<int>(data.values.size()));
    }
    MeshSize size;
    size.scheme = mesh.rules.scheme;
    size.numVertices = mesh.numVertices;
    size.numFaces = static_cast<std::int64_t>(mesh.faceSizes.size());
    size.numFaceCorners = static_cast<std::int64_t>(mesh.faceVertices.size());
    // Entries may repeat an edge; there are no more edges than corners.
    size.numCreases = static_cast<std::int64_t>(std::min(mesh.creaseSharpness.size(), mesh.faceVertices.size()));
    for (int const numCorners : mesh.faceSizes) addNgon(numCorners, resolved, size);
    addPrimvars(input, size);
    checkMemory(size, sizeof(Real), resolved);
    clock.End("validation", 0.02);

    RefinedTopology const topology(mesh, resolved.level, indices, counts);
    clock.End("refining", 0.3);
    return ShadeOnce(topology, input, resolved, clock);
}

template <typename Real>
ShadingResult<Real> ShadeSubdivision(Far::TopologyRefiner const& refiner, ShadingInput<Real> const& input,
                                     ShadingOptions const& options) {
    StageClock clock(options.execution.progress);
    ValidateRefiner(refiner);
    Far::TopologyLevel const base = refiner.GetLevel(0);
    ShadingOptions const resolved = ResolveOptions(options, refiner);
    auto const numFaceCorners = static_cast<std::size_t>(base.GetNumFaceVertices());
    CheckPoints(input.positions, static_cast<std::size_t>(base.GetNumVertices()), "positions", "vertex");
    checkInput(input, static_cast<std::size_t>(base.GetNumVertices()), numFaceCorners, resolved);
    for (std::size_t i = 0; i < input.faceVaryingData.size(); ++i) {
        FaceVaryingView<Real> const& data = input.faceVaryingData[i];
        int const channel = static_cast<int>(i);
        std::string const name = "faceVaryingData " + std::to_string(i);
        if (!data.indices.empty())
            fail(name + " has indices; those of the refiner's channel are used, leave them empty");
        if (channel >= base.GetNumFVarChannels()) {
            fail(name + ": the refiner has only " + std::to_string(base.GetNumFVarChannels()) + " channels");
        }
        if (data.values.size() != static_cast<std::size_t>(base.GetNumFVarValues(channel))) {
            fail(name + " has " + std::to_string(data.values.size()) + " values; the refiner's channel has " +
                 std::to_string(base.GetNumFVarValues(channel)));
        }
    }
    MeshSize size;
    size.scheme = refiner.GetSchemeType();
    size.numVertices = base.GetNumVertices();
    size.numFaces = base.GetNumFaces();
    size.numFaceCorners = base.GetNumFaceVertices();
    for (int e = 0; e < base.GetNumEdges(); ++e) {
        size.numCreases += base.GetEdgeSharpness(e) > 0 && !base.IsEdgeBoundary(e);
    }
    for (int f = 0; f < base.GetNumFaces(); ++f) addNgon(base.GetFaceVertices(f).size(), resolved, size);
    addPrimvars(input, size);
    checkMemory(size, sizeof(Real), resolved);
    clock.End("validation", 0.02);

    RefinedTopology const topology(refiner, resolved.level);
    clock.End("refining", 0.3);
    return ShadeOnce(topology, input, resolved, clock);
}

#define OSD_SHADING_INSTANTIATE(Real)                                                                            \
    template OSD_SHADING_API ShadingResult<Real> ShadeSubdivision(ControlMesh const&, ShadingInput<Real> const&, \
                                                                  ShadingOptions const&);                        \
    template OSD_SHADING_API ShadingResult<Real> ShadeSubdivision(                                               \
        Far::TopologyRefiner const&, ShadingInput<Real> const&, ShadingOptions const&);
OSD_SHADING_INSTANTIATE(float)
OSD_SHADING_INSTANTIATE(double)
#undef OSD_SHADING_INSTANTIATE

}  // namespace v1
}  // namespace osd_shading
