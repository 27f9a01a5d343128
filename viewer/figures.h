// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace osd_shading::viewer {

/// Writes the figures of [ZBK23], made anew on our own models, as figureN.png into `folder`, and side_by_side.png:
/// highlight lines of N_L and N_B beside each other. `extraModels` is the folder with the paper's robot and Spot;
/// figures 8 and 9 are left out where it lacks them. Needs a current context. `scale` as in PictureMaker.
///
/// Returns the names of the files that were written.     ERRORS: io::WriteError, GraphicsError, errors of reading
std::vector<std::string> WriteFigures(std::string const& folder, std::string const& extraModels, float scale);

}  // namespace osd_shading::viewer
