// SPDX-License-Identifier: Apache-2.0
#include "sceneBuilder.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <utility>
#include <vector>

#include "memory.h"
#include "modelInput.h"
#include "osd_shading/io/errors.h"
#include "osd_shading/subdivisionShading.h"
#include "surfaceTopology.h"

namespace osd_shading::viewer {

namespace {

using Clock = std::chrono::steady_clock;

glm::vec3 ToGlm(Vec3<float> const& v) { return {v.x, v.y, v.z}; }

// The middle of the model's box. Single precision shows a model anywhere as well as at the origin.
glm::dvec3 OriginOf(io::Model const& model) {
    glm::dvec3 low(0), high(0);
    for (std::size_t i = 0; i < model.positions.size(); i += 3) {
        glm::dvec3 const p(model.positions[i], model.positions[i + 1], model.positions[i + 2]);
        low = i == 0 ? p : glm::min(low, p);
        high = i == 0 ? p : glm::max(high, p);
    }
    return low + (high - low) / 2.0;
}

std::vector<glm::vec3> PointsOf(io::Model const& model, glm::dvec3 const& origin) {
    std::vector<glm::vec3> points;
    points.reserve(model.positions.size() / 3);
    for (std::size_t i = 0; i < model.positions.size(); i += 3) {
        points.emplace_back(
            glm::dvec3(model.positions[i], model.positions[i + 1], model.positions[i + 2]) - origin);
    }
    return points;
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

std::vector<SurfaceVertex> VerticesOf(ShadingResult<float> const& result) {
    std::vector<SurfaceVertex> vertices(result.valueVertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        auto const vertex = static_cast<std::size_t>(result.valueVertices[i]);
        vertices[i] = {ToGlm(result.positions[vertex]), ToGlm(result.limitNormals[i]),
                       ToGlm(result.subdividedNormals[i]), ToGlm(result.blendedNormals[i]), result.blendWeights[i]};
    }
    return vertices;
}

Sphere BoundsOf(std::vector<SurfaceVertex> const& vertices) {
    if (vertices.empty()) return {};
    glm::vec3 low = vertices[0].position, high = low;
    for (SurfaceVertex const& vertex : vertices) {
        low = glm::min(low, vertex.position);
        high = glm::max(high, vertex.position);
    }
    Sphere sphere{(low + high) / 2.0F, 0};
    for (SurfaceVertex const& vertex : vertices) {
        sphere.radius = std::max(sphere.radius, glm::distance(vertex.position, sphere.center));
    }
    if (!(sphere.radius > 0)) sphere.radius = 1;  // all in one point
    return sphere;
}

bool IsSame(SubdivisionRules const& a, SubdivisionRules const& b) {
    return a.scheme == b.scheme && a.boundary == b.boundary && a.faceVarying == b.faceVarying &&
           a.creasing == b.creasing && a.triangles == b.triangles;
}

ShadingResult<float> Shade(SceneRequest const& request, ShadingInput<float> const& input,
                           ShadingOptions const& options) {
    try {
        return ShadeSubdivision(request.model->Mesh(request.rules), input, options);
    } catch (InvalidControlMesh const& error) {
        throw io::ParseError(request.file, 0, error.what());  // the library knows no files
    }
}

}  // namespace

std::shared_ptr<Scene const> SceneBuilder::Build(SceneRequest const& request,
                                                 std::function<bool(double)> const& progress) {
    auto const start = Clock::now();
    auto scene = std::make_shared<Scene>();
    io::Model const& model = *request.model;

    // Bring the points to where they are shown.
    tool::RequireTriangles(request.file, request.rules.scheme, model);
    scene->origin = OriginOf(model);
    std::vector<glm::vec3> points = PointsOf(model, scene->origin);
    Deform(request.deformation, points);
    tool::RunInput<float> run = tool::MakeInput<float>(request.file, model, request.options.startNormals.kind);
    run.input.positions = {&points[0].x, points.size()};
    run.input.faceVaryingData.clear();

    // Shade, a second time with weight 1 where N_S is wanted everywhere.
    ShadingOptions options = request.options;
    bool const needsSecond = request.allSubdivided && options.weights.scheme != WeightScheme::One;
    std::uint64_t const free = tool::FreeMemory();
    if (options.execution.memoryLimit == 0) options.execution.memoryLimit = free - free / 4;
    options.execution.progress = [&](double share) { return progress(needsSecond ? share / 2 : share); };
    ShadingResult<float> result = Shade(request, run.input, options);
    scene->vertices = VerticesOf(result);
    scene->hasAllSubdivided = request.allSubdivided || result.options.weights.scheme == WeightScheme::One;
    if (needsSecond) {
        ShadingOptions everywhere = options;
        everywhere.weights.scheme = WeightScheme::One;
        everywhere.execution.progress = [&](double share) { return progress(0.5 + share / 2); };
        ShadingResult<float> const second = Shade(request, run.input, everywhere);
        for (std::size_t i = 0; i < scene->vertices.size(); ++i) {
            scene->vertices[i].subdividedNormal = ToGlm(second.subdividedNormals[i]);
        }
    }
    scene->options = result.options;
    scene->options.execution.progress = nullptr;
    scene->report = std::move(result.report);

    // Collect what is drawn; the connectivity stays while options of the shading alone change.
    bool const keepsTopology = _topology && _model == request.model && IsSame(_rules, request.rules) &&
                               _level == scene->options.level;
    if (!keepsTopology) {
        _topology = MakeSurfaceTopology(std::move(result), model.NumVertices());
        _model = request.model;
        _rules = request.rules;
        _level = scene->options.level;
    }
    scene->topology = _topology;
    scene->bounds = BoundsOf(scene->vertices);
    scene->cage = MakeCage(model, points);
    scene->seconds = std::chrono::duration<double>(Clock::now() - start).count();
    return scene;
}

}  // namespace osd_shading::viewer
