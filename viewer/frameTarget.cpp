// SPDX-License-Identifier: Apache-2.0
#include "frameTarget.h"

#include <algorithm>
#include <string>

namespace osd_shading::viewer {

namespace {

constexpr GLint kSamples = 4;

void RequireComplete(glm::ivec2 size) {
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE && glGetError() == GL_NO_ERROR) return;
    throw GraphicsError("the graphics driver has no framebuffer of " + std::to_string(size.x) + " x " +
                        std::to_string(size.y) + " pixels");
}

}  // namespace

FrameTarget::FrameTarget(glm::ivec2 size) : _size(size) {
    GLint maxSamples = 0, maxSize = 0;
    glGetIntegerv(GL_MAX_SAMPLES, &maxSamples);
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &maxSize);
    if (size.x > maxSize || size.y > maxSize) {
        throw GraphicsError("a picture of " + std::to_string(size.x) + " x " + std::to_string(size.y) +
                            " pixels is too large: the graphics driver ends at " + std::to_string(maxSize));
    }
    while (glGetError() != GL_NO_ERROR) {
    }

    GLint const samples = std::min(kSamples, maxSamples);
    glBindRenderbuffer(GL_RENDERBUFFER, _color.Id());
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_RGBA8, size.x, size.y);
    glBindRenderbuffer(GL_RENDERBUFFER, _depth.Id());
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_DEPTH_COMPONENT24, size.x, size.y);
    glBindFramebuffer(GL_FRAMEBUFFER, _drawn.Id());
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, _color.Id());
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, _depth.Id());
    RequireComplete(size);

    glBindRenderbuffer(GL_RENDERBUFFER, _resolvedColor.Id());
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, size.x, size.y);
    glBindFramebuffer(GL_FRAMEBUFFER, _resolved.Id());
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, _resolvedColor.Id());
    RequireComplete(size);
}

void FrameTarget::Bind() const {
    glBindFramebuffer(GL_FRAMEBUFFER, _drawn.Id());
    glViewport(0, 0, _size.x, _size.y);
}

void FrameTarget::resolve() const {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, _drawn.Id());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, _resolved.Id());
    glBlitFramebuffer(0, 0, _size.x, _size.y, 0, 0, _size.x, _size.y, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

void FrameTarget::Show(glm::ivec2 corner) const {
    resolve();
    glBindFramebuffer(GL_READ_FRAMEBUFFER, _resolved.Id());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    glBlitFramebuffer(0, 0, _size.x, _size.y, corner.x, corner.y, corner.x + _size.x, corner.y + _size.y,
                      GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

Image FrameTarget::Read() const {
    resolve();
    glBindFramebuffer(GL_READ_FRAMEBUFFER, _resolved.Id());
    Image flipped(_size, glm::vec3(0)), image(_size, glm::vec3(0));
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, _size.x, _size.y, GL_RGB, GL_UNSIGNED_BYTE, flipped.pixels.data());
    for (int y = 0; y < _size.y; ++y) {
        std::copy_n(flipped.Row(_size.y - 1 - y), 3 * static_cast<std::size_t>(_size.x), image.Row(y));
    }
    return image;
}

}  // namespace osd_shading::viewer
