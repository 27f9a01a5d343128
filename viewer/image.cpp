// SPDX-License-Identifier: Apache-2.0
#include "image.h"

#include <algorithm>
#include <cstddef>

#include "osd_shading/io/errors.h"
#include "osd_shading/io/fileReplacement.h"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb_image_write.h>

namespace osd_shading::viewer {

Image::Image(glm::ivec2 imageSize, glm::vec3 color) : size(imageSize) {
    pixels.resize(3 * static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y));
    glm::vec3 const bytes = glm::round(glm::clamp(color, 0.0F, 1.0F) * 255.0F);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        pixels[i] = static_cast<std::uint8_t>(bytes[static_cast<int>(i % 3)]);
    }
}

void Image::Paste(Image const& part, glm::ivec2 corner) {
    for (int y = 0; y < part.size.y; ++y) {
        std::copy_n(part.Row(y), 3 * static_cast<std::size_t>(part.size.x), Row(corner.y + y) + 3 * corner.x);
    }
}

void WritePng(std::string const& path, Image const& image) {
    // Compress first: the file is then written at once.
    std::vector<char> bytes;
    auto const append = [](void* target, void* data, int size) {
        auto const* const first = static_cast<char const*>(data);
        static_cast<std::vector<char>*>(target)->insert(static_cast<std::vector<char>*>(target)->end(), first,
                                                        first + size);
    };
    if (!stbi_write_png_to_func(append, &bytes, image.size.x, image.size.y, 3, image.pixels.data(),
                                3 * image.size.x)) {
        throw io::WriteError(path, "the picture can't be compressed");
    }
    io::FileReplacement file(path);
    file.Write(bytes.data(), bytes.size());
    file.Commit();
}

}  // namespace osd_shading::viewer
