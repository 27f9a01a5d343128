// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "workbench.h"

namespace osd_shading::viewer {

/// What the panel and the keys change besides the workbench.
struct PanelState {
    bool isVisible = true, showsHelp = false, showsHud = true, isPlaying = false;
    bool hasKeyboard = false;  ///< keys move in the panel
    bool takesFocus = false;   ///< the panel is to be focused; reset when done
    bool wantsScreenshot = false, wantsFrame = false, wantsQuit = false;  ///< reset when done
    double updateSeconds = 0, drawSeconds = 0;                            ///< of the last frame, for display

    // What is typed in.
    std::vector<std::string> filesBeside;  ///< the model's file; as the list was opened
    std::string openFile, cageFile = "creased.obj", resultFile = "shaded.ply", settingsFile = "viewer_settings.txt";
    std::string cameraText;
    float creaseAngle = 40;
};

/// Draws all panels into the current Dear ImGui frame, for a window of `size` units. `scale`: units per letter
/// size. The part of the window that is left for the scene begins at `PanelWidth`.
void DrawPanels(Workbench& bench, PanelState& state, glm::vec2 size, float scale);

/// Units that the panel covers at the left.
float PanelWidth(PanelState const& state, float scale);

}  // namespace osd_shading::viewer
