// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "image.h"
#include "renderer.h"
#include "textLayer.h"

namespace osd_shading::viewer {

/// A current OpenGL 3.3 context without window or display.
class OffscreenContext {
public:
    /// ERRORS: GraphicsError where there is no driver for it.
    OffscreenContext();
    ~OffscreenContext();
    OffscreenContext(OffscreenContext const&) = delete;
    OffscreenContext& operator=(OffscreenContext const&) = delete;

private:
    void* _display;
    void* _context;
};

/// Makes pictures of scenes; needs a current context.
class PictureMaker {
public:
    /// `scale`: pixels per unit of letters and lines.
    explicit PictureMaker(float scale) : _text(scale) {}

    Image Make(std::shared_ptr<Scene const> const& scene, CameraChoice const& camera, ViewOptions const& view,
               glm::ivec2 size, Selection const& selection = {}, std::vector<std::string> const& lines = {});

private:
    Renderer _renderer;
    TextLayer _text;
};

/// The camera for a picture of `size`, whose views may be halves of it.
Camera CameraFor(CameraChoice const& choice, Scene const& scene, ViewOptions const& view, glm::ivec2 size);

}  // namespace osd_shading::viewer
