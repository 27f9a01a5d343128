// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>

#include "glObjects.h"
#include "image.h"

namespace osd_shading::viewer {

/// Where pictures are drawn: pixels of several samples, resolved before anybody reads them.
class FrameTarget {
public:
    /// ERRORS: GraphicsError where the driver has no target of that size.
    explicit FrameTarget(glm::ivec2 size);

    glm::ivec2 Size() const { return _size; }
    /// Makes it the target of drawing.
    void Bind() const;
    /// Resolves, and copies to the window's framebuffer, with its lower left corner to `corner`.
    void Show(glm::ivec2 corner) const;
    Image Read() const;

private:
    void resolve() const;

    glm::ivec2 _size;
    GlFramebuffer _drawn, _resolved;
    GlRenderbuffer _color, _depth, _resolvedColor;
};

}  // namespace osd_shading::viewer
