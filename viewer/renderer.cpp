// SPDX-License-Identifier: Apache-2.0
#include "renderer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/gtc/type_ptr.hpp>
#include <string>
#include <utility>

#include "colors.h"
#include "shaders.h"

namespace osd_shading::viewer {

namespace {

constexpr int kVertexFloats = sizeof(SurfaceVertex) / sizeof(float);
constexpr float kLift = 0.002F;  // of the scene's radius, at its centre: lines lie this far above the surface
constexpr float kMarkLift = 15;  // times that: discs face the eye, and would dive into the surface

GLint Location(GlProgram const& program, char const* name) { return glGetUniformLocation(program.Id(), name); }

void SetMatrix(GlProgram const& program, char const* name, glm::mat4 const& matrix) {
    glUniformMatrix4fv(Location(program, name), 1, GL_FALSE, glm::value_ptr(matrix));
}

void SetFloats(GLuint location, int count, std::size_t offset) {
    glEnableVertexAttribArray(location);
    // GL takes the offset into the buffer as a pointer.
    glVertexAttribPointer(location, count, GL_FLOAT, GL_FALSE, sizeof(SurfaceVertex),
                          reinterpret_cast<void const*>(offset));
}

std::size_t OffsetOf(NormalChoice choice) {
    switch (choice) {
        case NormalChoice::Limit:
            return offsetof(SurfaceVertex, limitNormal);
        case NormalChoice::Subdivided:
            return offsetof(SurfaceVertex, subdividedNormal);
        case NormalChoice::Blended:
        case NormalChoice::Face:
            break;
    }
    return offsetof(SurfaceVertex, blendedNormal);
}

ColorScale const& ScaleOf(ShadingMode mode) {
    if (mode == ShadingMode::Weight) return kWeightScale;
    return mode == ShadingMode::Curvature ? kCurvatureScale : kAngleScale;
}

// 1, 2 or 5 times a power of ten, at least `x`.
float RoundedUp(float x) {
    float const power = std::pow(10.0F, std::floor(std::log10(std::max(x, 1e-3F))));
    for (float step : {1.0F, 2.0F, 5.0F}) {
        if (x <= step * power * 1.0001F) return step * power;
    }
    return 10 * power;
}

}  // namespace

std::vector<Viewport> ViewportsOf(ViewOptions const& view, glm::ivec2 size) {
    // The difference is one picture of both normals.
    if (view.split == SplitKind::None || view.shading == ShadingMode::Difference) {
        return {{{0, 0}, size, {0, 0}, size, view.normals}};
    }
    if (view.split == SplitKind::SideBySide) {
        glm::ivec2 const left(std::max(size.x / 2, 1), size.y), right(std::max(size.x - left.x, 1), size.y);
        return {{{0, 0}, left, {0, 0}, left, view.left}, {{left.x, 0}, right, {left.x, 0}, right, view.right}};
    }
    int const at = std::clamp(static_cast<int>(view.splitPosition * static_cast<float>(size.x)), 0, size.x);
    return {{{0, 0}, size, {0, 0}, {at, size.y}, view.left},
            {{0, 0}, size, {at, 0}, {size.x - at, size.y}, view.right}};
}

ViewFacts FindViewFacts(Scene const& scene, ViewOptions const& view) {
    ViewFacts facts;
    if (view.shading == ShadingMode::Difference) {
        facts.angles = CompareNormals(scene, view.left, view.right);
        facts.range = view.range.value_or(RoundedUp(static_cast<float>(facts.angles.max)));
    } else {
        facts.range = view.range.value_or(4);
    }
    if (view.Has(kRegions)) {
        SurfaceTopology const& topology = *scene.topology;
        int const wanted = view.vertex.value_or(-1);
        bool const isThere = wanted >= 0 && wanted < topology.NumVertices() && !topology.IsIsolated(wanted);
        facts.regionVertex = isThere ? wanted : InterestingVertex(scene);
    }
    return facts;
}

/// What all drawing of one view needs.
struct Renderer::Frame {
    glm::mat4 view, projection;
    glm::vec2 viewport;
    float near, lift, scale;
    ViewOptions const& options;
    ViewFacts const& facts;
};

struct Renderer::LineStyle {
    float width, opacity;
    bool isHidden;   // draws also what lies behind the surface
    float lift = 1;  // times that of the frame
};

Renderer::Renderer()
    : _lineProgram(MakeProgram(LineShaders().vertex, LineShaders().fragment)),
      _markProgram(MakeProgram(MarkShaders().vertex, MarkShaders().fragment)),
      _flatProgram(MakeProgram(FlatShaders().vertex, FlatShaders().fragment)) {}

Renderer::~Renderer() = default;

GlProgram const& Renderer::surfaceProgram(ShadingMode mode, bool leftIsFace, bool rightIsFace) {
    std::tuple const key(mode, leftIsFace, rightIsFace);
    auto found = _surfacePrograms.find(key);
    if (found == _surfacePrograms.end()) {
        ShaderPair const shaders = SurfaceShaders(mode, leftIsFace, rightIsFace);
        found = _surfacePrograms.emplace(key, MakeProgram(shaders.vertex, shaders.fragment)).first;
    }
    return found->second;
}

void Renderer::setScene(std::shared_ptr<Scene const> const& scene, ViewOptions const& view) {
    if (_scene != scene) {
        GLint maxTexels = 0;
        glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &maxTexels);
        if (scene->vertices.size() * kVertexFloats > static_cast<std::size_t>(maxTexels)) {
            throw GraphicsError("the result is too large for the graphics driver: choose a lower level");
        }
        Upload(_vertices, GL_ARRAY_BUFFER, scene->vertices);
        _surfacePoints.Attach(_vertices, GL_R32F);
        _hasFaceNormals = false;
        _curvatureOf.reset();
        _overlayKey.reset();
        if (_topology != scene->topology) {
            glBindVertexArray(_surfaceArray.Id());
            Upload(_triangles, GL_ELEMENT_ARRAY_BUFFER, scene->topology->triangles);
            _topology = scene->topology;
        }
        _scene = scene;
    }
    if (!_hasFaceNormals && view.Shows(NormalChoice::Face)) {
        _faceNormals.Upload(FaceNormals(*scene), GL_RGBA32F);
        _hasFaceNormals = true;
    }
}

void Renderer::fill(Batch& batch, std::vector<OverlayItem> const& items) {
    batch.count = items.size();
    glBindVertexArray(batch.array.Id());
    Upload(batch.instances, GL_ARRAY_BUFFER, items);
    glEnableVertexAttribArray(0);
    glVertexAttribIPointer(0, 2, GL_INT, sizeof(OverlayItem), nullptr);
    glEnableVertexAttribArray(1);
    glVertexAttribPointer(1, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(OverlayItem),
                          reinterpret_cast<void const*>(offsetof(OverlayItem, color)));
    glVertexAttribDivisor(0, 1);
    glVertexAttribDivisor(1, 1);
}

void Renderer::setOverlays(ViewOptions const& view, ViewFacts const& facts, Selection const& selection) {
    std::tuple const key(view.overlays, facts.regionVertex, selection);
    if (_overlayKey == key) return;
    _overlayKey = key;

    Scene const& scene = *_scene;
    auto const itemsIf = [](bool isWanted, auto const& make) {
        return isWanted ? make() : std::vector<OverlayItem>();
    };
    fill(_wires, itemsIf(view.Has(kWireframe), [&] { return WireItems(scene); }));
    fill(_cage, itemsIf(view.Has(kCage), [&] { return CageItems(scene); }));
    if (view.Has(kCage)) _cagePoints.Upload(scene.cage.points, GL_R32F);
    fill(_creases, itemsIf(view.Has(kCreases), [&] { return CreaseItems(scene); }));
    fill(_marks, MarkItems(scene, view.overlays));
    fill(_selection, itemsIf(view.Has(kSelection), [&] { return SelectionItems(scene, selection); }));
    fill(_selectionMarks, itemsIf(view.Has(kSelection), [&] { return SelectionMarks(scene, selection); }));

    _regionEnds.clear();
    ArrowShape arrows;
    if (facts.regionVertex >= 0) {
        RegionShape const regions = RegionsOf(scene, facts.regionVertex);
        std::vector<std::uint32_t> triangles;
        for (auto const& region : regions.triangles) {
            triangles.insert(triangles.end(), region.begin(), region.end());
            _regionEnds.push_back(triangles.size());
        }
        glBindVertexArray(_regionArray.Id());
        Upload(_regionTriangles, GL_ELEMENT_ARRAY_BUFFER, triangles);
        glBindBuffer(GL_ARRAY_BUFFER, _vertices.Id());
        SetFloats(0, 3, offsetof(SurfaceVertex, position));
        arrows = RegionArrows(scene, regions);
        _arrowPoints.Upload(arrows.points, GL_R32F);
    }
    fill(_arrows, arrows.items);
}

void Renderer::drawSurface(Frame const& frame, Viewport const& viewport) {
    ViewOptions const& options = frame.options;
    bool const isDifference = options.shading == ShadingMode::Difference;
    NormalChoice const left = isDifference ? options.left : viewport.normals;
    NormalChoice const right = isDifference ? options.right : viewport.normals;

    GlProgram const& program =
        surfaceProgram(options.shading, left == NormalChoice::Face, right == NormalChoice::Face);
    glUseProgram(program.Id());
    SetMatrix(program, "view", frame.view);
    SetMatrix(program, "projection", frame.projection);
    glUniform1i(Location(program, "faceNormals"), 0);
    glUniform1i(Location(program, "trianglesPerFace"), _topology->faceSize - 2);
    glUniform1f(Location(program, "lineCount"), static_cast<float>(options.lineCount));
    glUniform1f(Location(program, "lineAngle"), glm::radians(options.lineAngle));
    glUniform1f(Location(program, "roughness"), options.roughness);
    glUniform1f(Location(program, "range"), frame.facts.range);
    glUniform3fv(Location(program, "scale"), 5, glm::value_ptr(ScaleOf(options.shading)[0]));
    if (_hasFaceNormals) _faceNormals.Bind(0);

    glBindVertexArray(_surfaceArray.Id());
    glBindBuffer(GL_ARRAY_BUFFER, _vertices.Id());
    SetFloats(0, 3, offsetof(SurfaceVertex, position));
    SetFloats(1, 3, OffsetOf(left));
    SetFloats(2, 3, OffsetOf(right));
    SetFloats(3, 1, offsetof(SurfaceVertex, weight));
    if (options.shading == ShadingMode::Curvature) {
        if (_curvatureOf != left) {
            Upload(_curvature, GL_ARRAY_BUFFER, NormalFieldCurvature(*_scene, left));
            _curvatureOf = left;
        }
        glBindBuffer(GL_ARRAY_BUFFER, _curvature.Id());
        glEnableVertexAttribArray(4);
        glVertexAttribPointer(4, 1, GL_FLOAT, GL_FALSE, 0, nullptr);
    } else {
        glDisableVertexAttribArray(4);
    }
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(_topology->triangles.size()), GL_UNSIGNED_INT, nullptr);
}

void Renderer::drawRegions(Frame const& frame) {
    if (_regionEnds.empty()) return;
    glUseProgram(_flatProgram.Id());
    SetMatrix(_flatProgram, "view", frame.view);
    SetMatrix(_flatProgram, "projection", frame.projection);
    glUniform1f(Location(_flatProgram, "lift"), frame.lift / 2);
    glBindVertexArray(_regionArray.Id());
    std::size_t begin = 0;
    for (std::size_t i = 0; i < _regionEnds.size(); ++i) {
        glm::vec4 const color(kRegionColors[i % kRegionColors.size()], 0.7F);
        glUniform4fv(Location(_flatProgram, "flatColor"), 1, glm::value_ptr(color));
        glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(_regionEnds[i] - begin), GL_UNSIGNED_INT,
                       reinterpret_cast<void const*>(begin * sizeof(std::uint32_t)));
        begin = _regionEnds[i];
    }
}

void Renderer::drawBatch(Frame const& frame, GlProgram const& program, Batch const& batch,
                         TextureBuffer const& points, int stride, LineStyle const& style) {
    if (batch.count == 0) return;
    glUseProgram(program.Id());
    SetMatrix(program, "view", frame.view);
    SetMatrix(program, "projection", frame.projection);
    glUniform2fv(Location(program, "viewport"), 1, glm::value_ptr(frame.viewport));
    glUniform1f(Location(program, "lift"), frame.lift * style.lift);
    glUniform1f(Location(program, "near"), frame.near);
    glUniform1f(Location(program, "width"), style.width * frame.scale);
    glUniform1f(Location(program, "opacity"), style.opacity);
    glUniform1i(Location(program, "points"), 0);
    glUniform1i(Location(program, "stride"), stride);
    glUniform1i(Location(program, "first"), 0);
    points.Bind(0);
    glBindVertexArray(batch.array.Id());
    if (style.isHidden) glDisable(GL_DEPTH_TEST);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(batch.count));
    glEnable(GL_DEPTH_TEST);
}

void Renderer::drawOverlays(Frame const& frame) {
    drawRegions(frame);
    drawBatch(frame, _lineProgram, _wires, _surfacePoints, kVertexFloats, {1, 1, false});
    drawBatch(frame, _lineProgram, _cage, _cagePoints, 3, {1.5F, 0.25F, true});
    drawBatch(frame, _lineProgram, _cage, _cagePoints, 3, {1.5F, 1, false});
    drawBatch(frame, _lineProgram, _creases, _surfacePoints, kVertexFloats, {3, 1, false});
    drawBatch(frame, _lineProgram, _selection, _surfacePoints, kVertexFloats, {5, 1, false});
    drawBatch(frame, _lineProgram, _arrows, _arrowPoints, 3, {3, 1, false});
    drawBatch(frame, _markProgram, _marks, _surfacePoints, kVertexFloats, {16, 1, false, kMarkLift});
    drawBatch(frame, _markProgram, _selectionMarks, _surfacePoints, kVertexFloats, {12, 1, false, kMarkLift});
}

void Renderer::Draw(std::shared_ptr<Scene const> const& scene, Camera const& camera, ViewOptions const& view,
                    ViewFacts const& facts, Selection const& selection, glm::ivec2 size, float scale) {
    setScene(scene, view);
    setOverlays(view, facts, selection);

    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    glDisable(GL_CULL_FACE);
    glEnable(GL_MULTISAMPLE);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glm::vec3 const background = BackgroundColor(view.background);
    glClearColor(background.r, background.g, background.b, 1);
    glDisable(GL_SCISSOR_TEST);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);

    // The arrows may reach beyond the surface.
    Sphere bounds = scene->bounds;
    bounds.radius *= 1.4F;
    glEnable(GL_SCISSOR_TEST);
    for (Viewport const& viewport : ViewportsOf(view, size)) {
        if (viewport.cutSize.x <= 0 || viewport.cutSize.y <= 0) continue;
        glViewport(viewport.corner.x, viewport.corner.y, viewport.size.x, viewport.size.y);
        glScissor(viewport.cutCorner.x, viewport.cutCorner.y, viewport.cutSize.x, viewport.cutSize.y);
        float const toCenter = std::max(glm::distance(camera.Eye(), bounds.center), bounds.radius / 4);
        float const lift = std::min(kLift * bounds.radius / toCenter, 0.02F);
        glm::mat4 const projection = camera.Projection(viewport.Aspect(), bounds);
        float const near = projection[3][2] / (projection[2][2] - 1);
        Frame const frame{camera.View(), projection, glm::vec2(viewport.size), near, lift, scale, view, facts};
        // Half of the triangles need not be drawn where nobody can see them.
        bool const isOutside = glm::distance(camera.Eye(), scene->bounds.center) > scene->bounds.radius;
        if (_topology->hidesBackFaces && isOutside) glEnable(GL_CULL_FACE);
        drawSurface(frame, viewport);
        glDisable(GL_CULL_FACE);
        drawOverlays(frame);
    }
    glDisable(GL_SCISSOR_TEST);
    glViewport(0, 0, size.x, size.y);
}

}  // namespace osd_shading::viewer
