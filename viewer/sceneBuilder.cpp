// SPDX-License-Identifier: Apache-2.0
#include "sceneBuilder.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

#include "memory.h"
#include "modelInput.h"
#include "osd_shading/subdivisionShading.h"
#include "requestShading.h"
#include "sceneFields.h"
#include "surfaceTopology.h"

namespace osd_shading::viewer {

namespace {

using Clock = std::chrono::steady_clock;

template <typename Real>
glm::vec3 ToGlm(Vec3<Real> const& v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

std::vector<glm::dvec3> PointsOf(io::Model const& model, glm::dvec3 const& origin) {
    std::vector<glm::dvec3> points;
    points.reserve(model.positions.size() / 3);
    for (std::size_t i = 0; i < model.positions.size(); i += 3) {
        points.push_back(glm::dvec3(model.positions[i], model.positions[i + 1], model.positions[i + 2]) - origin);
    }
    return points;
}

// Points of glm as the library views them.
template <typename Point>
auto ViewOf(std::vector<Point> const& points) {
    return PointView<typename Point::value_type>(&points[0].x, points.size());
}

CageShape MakeCage(io::Model const& model, std::vector<glm::vec3> const& points) {
    CageShape cage{points, {}};
    std::size_t first = 0;
    for (int size : model.faceSizes) {
        auto const count = static_cast<std::size_t>(size);
        for (std::size_t i = 0; i < count; ++i) {
            int const a = model.faceVertices[first + i], b = model.faceVertices[first + (i + 1) % count];
            cage.edges.push_back({std::min(a, b), std::max(a, b)});
        }
        first += count;
    }
    std::sort(cage.edges.begin(), cage.edges.end());
    cage.edges.erase(std::unique(cage.edges.begin(), cage.edges.end()), cage.edges.end());
    return cage;
}

template <typename Real>
std::vector<SurfaceVertex> VerticesOf(ShadingResult<Real> const& result) {
    std::vector<SurfaceVertex> vertices(result.valueVertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        auto const vertex = static_cast<std::size_t>(result.valueVertices[i]);
        vertices[i] = {ToGlm(result.positions[vertex]), ToGlm(result.limitNormals[i]),
                       ToGlm(result.subdividedNormals[i]), ToGlm(result.blendedNormals[i]),
                       static_cast<float>(result.blendWeights[i])};
    }
    return vertices;
}

bool IsSame(SubdivisionRules const& a, SubdivisionRules const& b) {
    return a.scheme == b.scheme && a.boundary == b.boundary && a.faceVarying == b.faceVarying &&
           a.creasing == b.creasing && a.triangles == b.triangles;
}

bool HasTables(SceneRequest const& request) {
    return !request.tessellation && request.options.subdividedNormals.averaging == NormalAveraging::Linear &&
           request.options.startNormals.kind != StartNormalKind::User &&
           request.precision == tool::Precision::Float;
}

// What of the options a table depends on; `execution` changes no number.
auto Essence(ShadingOptions const& o) {
    return std::tuple(o.level, o.startNormals.kind, o.startNormals.level, o.weights.scheme, o.weights.sharpVertices,
                      o.weights.darts, o.weights.level, o.weights.exponent, o.limits.positions, o.limits.normals);
}

ShadingEvaluator MakeEvaluator(SceneRequest const& request, ShadingOptions const& options) {
    ShadingTable const table(request.model->Mesh(request.rules), options, ValueOrder::OpenSubdiv);
    return ShadingEvaluator(table, {options.execution.numThreads, InstructionSet::Best});
}

// A quarter of what is free is left to others, where the user has not said more.
ShadingOptions WithExecution(ShadingOptions options, std::function<bool(double)> progress) {
    std::uint64_t const free = tool::FreeMemory();
    if (options.execution.memoryLimit == 0) options.execution.memoryLimit = free - free / 4;
    options.execution.progress = std::move(progress);
    return options;
}

}  // namespace

std::shared_ptr<Scene const> SceneBuilder::Build(SceneRequest const& request,
                                                 std::function<bool(double)> const& progress) {
    auto const start = Clock::now();
    io::Model const& model = *request.model;
    tool::RequireTriangles(request.file, request.rules.scheme, model);

    // Bring the points to where they are shown.
    glm::dvec3 const origin = OriginOf(model);
    std::vector<glm::dvec3> exact = PointsOf(model, origin);
    std::vector<glm::vec3> points(exact.begin(), exact.end());
    Deform(request.deformation, points);

    bool const isMoved = request.deformation.kind != DeformationKind::None;
    std::shared_ptr<Scene> scene;
    if (request.precision == tool::Precision::Double) {
        if (isMoved) exact.assign(points.begin(), points.end());
        scene = shade(request, ViewOf(exact), progress);
    } else {
        scene = isMoved && HasTables(request) ? evaluate(request, points, progress)
                                              : shade(request, ViewOf(points), progress);
    }
    scene->origin = origin;
    scene->bounds = SphereAround(scene->vertices, [](SurfaceVertex const& vertex) { return vertex.position; });
    scene->cage = MakeCage(model, points);
    scene->seconds = std::chrono::duration<double>(Clock::now() - start).count();
    return scene;
}

template <typename Real>
std::shared_ptr<Scene> SceneBuilder::shade(SceneRequest const& request, PointView<Real> const& points,
                                           std::function<bool(double)> const& progress) {
    auto scene = std::make_shared<Scene>();
    io::Model const& model = *request.model;
    tool::RunInput<Real> run = tool::MakeInput<Real>(request.file, model, request.options.startNormals.kind);
    run.input.positions = points;
    run.input.faceVaryingData.clear();

    // Shade, a second time with weight 1 where N_S is wanted everywhere; other normals would be cut otherwise.
    bool const needsSecond =
        request.allSubdivided && !request.tessellation && request.options.weights.scheme != WeightScheme::One;
    ShadingResult<Real> result = ShadeRequest(
        request, run.input,
        WithExecution(request.options, [&](double share) { return progress(needsSecond ? share / 2 : share); }),
        glm::dvec3(0));
    scene->vertices = VerticesOf(result);
    scene->hasAllSubdivided = needsSecond || result.options.weights.scheme == WeightScheme::One;
    if (needsSecond) {
        ShadingOptions everywhere =
            WithExecution(request.options, [&](double share) { return progress(0.5 + share / 2); });
        everywhere.weights.scheme = WeightScheme::One;
        ShadingResult<Real> const second = ShadeRequest(request, run.input, everywhere, glm::dvec3(0));
        for (std::size_t i = 0; i < scene->vertices.size(); ++i) {
            scene->vertices[i].subdividedNormal = ToGlm(second.subdividedNormals[i]);
        }
    }
    scene->options = result.options;
    scene->options.execution.progress = nullptr;
    scene->report = std::move(result.report);

    // Collect what is drawn; the connectivity stays while options of the shading alone change.
    bool const keepsTopology = !request.tessellation && _topology && _model == request.model &&
                               IsSame(_rules, request.rules) && _level == scene->options.level;
    if (!keepsTopology) {
        _topology = MakeSurfaceTopology(std::move(result), model.NumVertices());
        _model = request.model;
        _rules = request.rules;
        _level = request.tessellation ? -1 : scene->options.level;
    }
    scene->topology = _topology;
    return scene;
}

bool SceneBuilder::keepsTables(SceneRequest const& request) const {
    return _tables && _tables->request.model == request.model && IsSame(_tables->request.rules, request.rules) &&
           Essence(_tables->request.options) == Essence(request.options) &&
           (_tables->allSubdivided || !request.allSubdivided);
}

std::shared_ptr<Scene> SceneBuilder::evaluate(SceneRequest const& request, std::vector<glm::vec3> const& points,
                                              std::function<bool(double)> const& progress) {
    if (!keepsTables(request)) {
        _tables.reset();
        SceneRequest still = request;
        still.deformation = {};
        std::vector<glm::dvec3> const exact = PointsOf(*request.model, OriginOf(*request.model));
        std::vector<glm::vec3> const stillPoints(exact.begin(), exact.end());
        auto rest = shade(still, ViewOf(stillPoints), [&](double share) { return progress(share / 2); });
        ShadingOptions const options =
            WithExecution(request.options, [&](double share) { return progress(0.5 + share / 4); });
        ShadingOptions everywhere =
            WithExecution(request.options, [&](double share) { return progress(0.75 + share / 4); });
        everywhere.weights.scheme = WeightScheme::One;
        _tables.emplace(Tables{std::move(still), std::move(rest), MakeEvaluator(request, options), std::nullopt});
        if (request.allSubdivided) _tables->allSubdivided = MakeEvaluator(request, everywhere);
    }

    // One frame, straight into what the renderer takes.
    Scene const& rest = *_tables->rest;
    auto scene = std::make_shared<Scene>(rest);
    std::size_t const count = scene->vertices.size();
    constexpr std::size_t kStride = sizeof(SurfaceVertex) / sizeof(float);
    SurfaceVertex& first = scene->vertices[0];
    ShadingOutputs outputs;
    outputs.positions = {&first.position.x, count, kStride};
    outputs.limitNormals = {&first.limitNormal.x, count, kStride};
    outputs.subdividedNormals = {&first.subdividedNormal.x, count, kStride};
    outputs.blendedNormals = {&first.blendedNormal.x, count, kStride};
    PointView<float> const controlPoints(&points[0].x, points.size());
    _tables->evaluator.Evaluate(controlPoints, outputs);
    if (request.allSubdivided) {
        ShadingOutputs all;
        all.subdividedNormals = outputs.subdividedNormals;
        _tables->allSubdivided->Evaluate(controlPoints, all);
    }
    AngleStatistics const angles = CompareNormals(*scene, NormalChoice::Limit, NormalChoice::Blended);
    scene->report.meanAngle = angles.mean;
    scene->report.maxAngle = angles.max;
    scene->report.maxAngleValue = angles.maxValue;
    return scene;
}

}  // namespace osd_shading::viewer
