// SPDX-License-Identifier: Apache-2.0
#include "windowLayout.h"

#include <algorithm>

#include "renderer.h"

namespace osd_shading::viewer {

WindowLayout::WindowLayout(glm::ivec2 size, glm::ivec2 frameSize, float contentScale, float panelWidth)
    : _size(size), _frameSize(frameSize), _pixelScale(std::max(contentScale, 0.5F)) {
    if (size.x > 0 && frameSize.x > 0)
        _pixelsPerUnit = static_cast<float>(frameSize.x) / static_cast<float>(size.x);
    _unitScale = _pixelScale / _pixelsPerUnit;
    _left = std::min(panelWidth * _unitScale, _size.x);
}

glm::ivec2 WindowLayout::SceneSize() const {
    int const panel = static_cast<int>(_left * _pixelsPerUnit);
    return {std::max(_frameSize.x - panel, 1), std::max(_frameSize.y, 1)};
}

std::optional<WindowLayout::Place> WindowLayout::PlaceOf(ViewOptions const& view, glm::vec2 cursor) const {
    glm::vec2 const pixel = (cursor - glm::vec2(_left, 0)) * _pixelsPerUnit;
    for (Viewport const& viewport : ViewportsOf(view, SceneSize())) {
        glm::vec2 const inCut = pixel - glm::vec2(viewport.cutCorner);
        bool const isInside = inCut.x >= 0 && inCut.y >= 0 && inCut.x < static_cast<float>(viewport.cutSize.x) &&
                              inCut.y < static_cast<float>(viewport.cutSize.y);
        if (isInside) return Place{pixel - glm::vec2(viewport.corner), glm::vec2(viewport.size)};
    }
    return std::nullopt;
}

float WindowLayout::SplitPosition(float x) const {
    return std::clamp((x - _left) / std::max(_size.x - _left, 1.0F), 0.0F, 1.0F);
}

}  // namespace osd_shading::viewer
