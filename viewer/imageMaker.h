// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>

#include "commandLine.h"
#include "offscreen.h"
#include "sceneBuilder.h"

namespace osd_shading::viewer {

/// Makes the pictures that command lines with `--image` ask for. What does not change from one to the next is kept:
/// the graphics context, its shaders, and the connectivity of the last model.
class ImageMaker {
public:
    /// `warn` takes what the model's file says that is no error, one line a call.
    ///
    /// ERRORS: those of reading the model and of SceneBuilder; GraphicsError where there is no driver.
    Image Make(CommandLine const& line, std::function<void(std::string const&)> const& warn);

private:
    SceneBuilder _builder;
    std::optional<OffscreenContext> _context;  // outlives what lies in it
    std::map<float, PictureMaker> _makers;     // by scale
};

}  // namespace osd_shading::viewer
