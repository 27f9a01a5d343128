// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "viewOptions.h"

namespace osd_shading::viewer {

/// Where panel and scene lie in a window. The mouse and the panels count in units of the screen, pictures in
/// pixels: on a dense screen a unit is several pixels, or letters are larger, or both.
class WindowLayout {
public:
    WindowLayout() = default;
    /// `size` in units, `frameSize` in pixels; `contentScale`: pixels of a letter's size of 1. The panel covers
    /// `panelWidth` letter sizes at the left.
    WindowLayout(glm::ivec2 size, glm::ivec2 frameSize, float contentScale, float panelWidth);

    glm::vec2 Size() const { return _size; }             ///< units
    glm::ivec2 FrameSize() const { return _frameSize; }  ///< pixels; 0 where the window is minimised
    float PixelScale() const { return _pixelScale; }     ///< pixels per letter size of 1
    float UnitScale() const { return _unitScale; }       ///< units per letter size of 1
    bool IsVisible() const { return _frameSize.x > 0 && _frameSize.y > 0; }

    float Left() const { return _left; }  ///< units that the panel covers
    /// Pixels that are left for the scene, at least one each way.
    glm::ivec2 SceneSize() const;

    /// A point of a view; positions and size in pixels, from the view's upper left corner.
    struct Place {
        glm::vec2 at, size;
    };
    /// What `cursor`, in units, points at; nothing beside the scene.
    std::optional<Place> PlaceOf(ViewOptions const& view, glm::vec2 cursor) const;

    /// Units from the window's left to the line that splits one view, and the share that stands for such a place.
    float SplitX(float position) const { return _left + position * (_size.x - _left); }
    float SplitPosition(float x) const;

private:
    glm::vec2 _size{0};
    glm::ivec2 _frameSize{0};
    float _pixelsPerUnit = 1, _pixelScale = 1, _unitScale = 1, _left = 0;
};

}  // namespace osd_shading::viewer
