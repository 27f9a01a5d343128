// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "camera.h"
#include "deformation.h"
#include "methodOptions.h"
#include "tessellationOptions.h"
#include "viewOptions.h"

namespace osd_shading::viewer {

/// All that the panel edits, the command line sets and a settings file keeps.
struct Settings {
    std::string modelFile;  ///< or the name of a built-in model
    tool::MeshOptions mesh;
    tool::ShadingChoice shading;
    tool::TessellationChoice tessellation;
    ViewOptions view;
    CameraChoice camera;
    Deformation deformation;
    tool::RunChoice run;         ///< precision unset: float for what is shown, double for what is saved
    int screenshotMultiple = 1;  ///< size of screenshots, times the window's

    /// The method's options; the level is left to the library where it cuts triangles and none is given.
    ///
    /// ERRORS: UsageError where options contradict each other.
    ShadingOptions ResolveShading() const {
        return shading.Resolve(tessellation.kind ? kDefaultSurfaceLevel : ShadingOptions{}.level);
    }
};

inline constexpr int kMaxScreenshotMultiple = 8;

/// `settings` as text, a line for each option that is not at its default: the names of the command line without
/// dashes, a space, the value.
std::string SettingsText(Settings const& settings);

/// The words of a command line that stand for the settings file `file`.     ERRORS: io::ReadError, UsageError
std::vector<std::string> ReadSettingsFile(std::string const& file);

}  // namespace osd_shading::viewer
