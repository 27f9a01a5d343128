// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "panel.h"

namespace osd_shading::viewer {

// What keys do, and what buttons that do the same call.

/// The highest level that panel and keys offer; the command line goes further.
inline constexpr int kMaxViewerLevel = 7;

struct KeyHelp {
    char const *key, *meaning;
};
std::vector<KeyHelp> const& KeyHelpLines();

/// Does what `key` (GLFW's number) with `modifiers` stands for; false where that is nothing.
bool HandleKey(Workbench& bench, PanelState& state, int key, int modifiers);

/// Sets the last level, and lowers start levels that would lie above it.
void SetLevel(tool::ShadingChoice& shading, int level);
void SetStandardView(Workbench& bench, char const* name);
/// Takes a camera as text; says so where it is none. Null counts as none.
void PasteCamera(Workbench& bench, char const* text);
void TogglePlay(Workbench& bench, PanelState& state);

}  // namespace osd_shading::viewer
