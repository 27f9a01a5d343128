// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/io/textFile.h"

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>

#include "osd_shading/io/errors.h"

namespace osd_shading {
inline namespace v1 {
namespace io {

namespace {

struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
};

std::string reasonOf(int error) { return std::generic_category().message(error); }

}  // namespace

std::string ReadTextFile(std::string const& path) {
    // Some systems open a folder without complaint and fail at the first read in words that say less.
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored)) throw ReadError(path, "it is a folder, not a file");

    errno = 0;
    std::unique_ptr<std::FILE, CloseFile> const file(std::fopen(path.c_str(), "rb"));
    if (!file) throw ReadError(path, reasonOf(errno));

    constexpr std::size_t kPiece = std::size_t{1} << 20;
    std::string text;
    auto const size = std::filesystem::file_size(path, ignored);
    if (!ignored && size < text.max_size() - kPiece) text.reserve(static_cast<std::size_t>(size) + kPiece);
    for (std::size_t used = 0;;) {
        text.resize(used + kPiece);
        std::size_t const got = std::fread(text.data() + used, 1, kPiece, file.get());
        int const error = errno;
        used += got;
        text.resize(used);
        if (std::ferror(file.get())) throw ReadError(path, reasonOf(error));
        if (got < kPiece) return text;
    }
}

}  // namespace io
}  // namespace v1
}  // namespace osd_shading
