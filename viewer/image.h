// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace osd_shading::viewer {

/// Pixels of three bytes, rows from the top.
struct Image {
    glm::ivec2 size{0};
    std::vector<std::uint8_t> pixels;

    Image() = default;
    Image(glm::ivec2 imageSize, glm::vec3 color);

    std::uint8_t* Row(int y) {
        return pixels.data() + 3 * static_cast<std::size_t>(y) * static_cast<std::size_t>(size.x);
    }
    std::uint8_t const* Row(int y) const {
        return pixels.data() + 3 * static_cast<std::size_t>(y) * static_cast<std::size_t>(size.x);
    }
    /// Copies `part`, which must fit, with its upper left corner to `corner`.
    void Paste(Image const& part, glm::ivec2 corner);
};

/// Writes a PNG, complete or not at all.     ERRORS: io::WriteError
void WritePng(std::string const& path, Image const& image);

}  // namespace osd_shading::viewer
