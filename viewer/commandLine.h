// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "settings.h"

namespace osd_shading::viewer {

/// What the user asks for.
struct CommandLine {
    Settings settings;

    std::string imageFile;      ///< empty: no single picture
    std::string figuresFolder;  ///< empty: no figures
    std::string extraModels;    ///< folder with further models for the figures; may be absent
    std::optional<glm::ivec2> size;
    float scale = 1;      ///< pixels per unit of letters and lines
    bool hasHud = false;  ///< counts and times in the picture
    bool reportsState = false;
};

/// Reads the command line, words of a settings file first. Nothing when that asked for help or the version, which
/// is then printed.
///
/// ERRORS: UsageError; io::ReadError and io::ParseError for a settings file.
std::optional<CommandLine> ParseCommandLine(std::vector<std::string> const& words);

}  // namespace osd_shading::viewer
