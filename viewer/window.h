// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "commandLine.h"

namespace osd_shading::viewer {

/// Opens the window and runs until it is closed.
///
/// ERRORS: GraphicsError where there is no display or no OpenGL 3.3; those of reading the model.
void RunWindow(CommandLine const& line);

}  // namespace osd_shading::viewer
