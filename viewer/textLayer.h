// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>

struct ImDrawList;
struct ImGuiContext;

namespace osd_shading::viewer {

/// Text and plain shapes over a picture, in pixels from the upper left corner. Needs a current GL context as long
/// as it lives. Independent of the window's panels, so that pictures without a window have the same legends.
class TextLayer {
public:
    /// `scale`: pixels per unit, the size of letters.
    explicit TextLayer(float scale);
    ~TextLayer();
    TextLayer(TextLayer const&) = delete;
    TextLayer& operator=(TextLayer const&) = delete;

    float Scale() const { return _scale; }

    /// Begins a layer for a target of `size` pixels; `End` draws it into the target that is bound.
    ImDrawList& Begin(glm::ivec2 size);
    void End();

private:
    ImGuiContext* _context;
    ImGuiContext* _outer = nullptr;
    float _scale;
};

}  // namespace osd_shading::viewer
