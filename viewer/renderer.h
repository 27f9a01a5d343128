// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <optional>
#include <tuple>
#include <vector>

#include "camera.h"
#include "glObjects.h"
#include "overlays.h"
#include "scene.h"
#include "sceneFields.h"

namespace osd_shading::viewer {

/// The part of a target that one view covers; origin below left, as in GL.
struct Viewport {
    glm::ivec2 corner, size;        ///< of the whole view
    glm::ivec2 cutCorner, cutSize;  ///< what of it is shown
    NormalChoice normals;

    float Aspect() const { return static_cast<float>(size.x) / static_cast<float>(size.y); }
};

/// One view, or the two of a split, for a target of `size` pixels.
std::vector<Viewport> ViewportsOf(ViewOptions const& view, glm::ivec2 size);

/// What a picture needs to know of its scene beyond the scene: found once, for drawing and for legends.
struct ViewFacts {
    AngleStatistics angles;  ///< between the normals of the split
    float range = 1;         ///< end of the colour scale
    int regionVertex = -1;   ///< -1: none
};
ViewFacts FindViewFacts(Scene const& scene, ViewOptions const& view);

/// Draws scenes with OpenGL 3.3. Needs a current context as long as it lives.
class Renderer {
public:
    Renderer();
    ~Renderer();

    /// Gives the graphics driver what `Draw` with the same arguments would give it first.     ERRORS: GraphicsError
    void Prepare(std::shared_ptr<Scene const> const& scene, ViewOptions const& view) { setScene(scene, view); }
    /// Draws into the target that is bound, `size` pixels large. `scale`: pixels per unit of line widths and marks.
    ///
    /// ERRORS: GraphicsError
    void Draw(std::shared_ptr<Scene const> const& scene, Camera const& camera, ViewOptions const& view,
              ViewFacts const& facts, Selection const& selection, glm::ivec2 size, float scale);

private:
    struct Frame;
    struct LineStyle;
    struct Batch {
        GlVertexArray array;
        GlBuffer instances;
        std::size_t count = 0;
    };

    void setScene(std::shared_ptr<Scene const> const& scene, ViewOptions const& view);
    void setOverlays(ViewOptions const& view, ViewFacts const& facts, Selection const& selection);
    void fill(Batch& batch, std::vector<OverlayItem> const& items);
    GlProgram const& surfaceProgram(ShadingMode mode, bool leftIsFace, bool rightIsFace);
    void drawSurface(Frame const& frame, Viewport const& viewport);
    void drawRegions(Frame const& frame);
    void drawBatch(Frame const& frame, GlProgram const& program, Batch const& batch, TextureBuffer const& points,
                   int stride, LineStyle const& style);
    void drawOverlays(Frame const& frame);

    std::map<std::tuple<ShadingMode, bool, bool>, GlProgram> _surfacePrograms;
    GlProgram _lineProgram, _markProgram, _flatProgram;

    std::shared_ptr<Scene const> _scene;
    std::shared_ptr<SurfaceTopology const> _topology;
    GlVertexArray _surfaceArray, _regionArray;
    GlBuffer _vertices, _curvature, _triangles, _regionTriangles;
    TextureBuffer _surfacePoints, _faceNormals, _cagePoints, _arrowPoints;
    bool _hasFaceNormals = false;
    std::optional<NormalChoice> _curvatureOf;

    // What the overlays were made for.
    std::optional<std::tuple<std::uint32_t, int, Selection>> _overlayKey;
    Batch _wires, _cage, _creases, _marks, _selection, _selectionMarks, _arrows;
    std::vector<std::size_t> _regionEnds;
};

}  // namespace osd_shading::viewer
