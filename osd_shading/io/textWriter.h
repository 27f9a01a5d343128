// SPDX-License-Identifier: Apache-2.0
#pragma once

/// \file
/// Not needed by ordinary clients: what the writers of text formats share.

#include <charconv>
#include <string_view>
#include <type_traits>

#include "osd_shading/io/fileReplacement.h"
#include "osd_shading/views.h"

namespace osd_shading {
inline namespace v1 {
namespace io {

/// Writes text and numbers to an FileReplacement. Numbers are the shortest that read back as the same bits, with a
/// point whatever the locale.
class TextWriter {
public:
    explicit TextWriter(FileReplacement& file) : _file(file) {}

    /// Writes the parts one after the other, with nothing between them.
    template <typename... Parts>
    void Add(Parts const&... parts) {
        (add(parts), ...);
    }

private:
    template <typename Part>
    void add(Part const& part) {
        if constexpr (std::is_same_v<Part, char>) {
            _file.Write(&part, 1);
        } else if constexpr (std::is_arithmetic_v<Part>) {
            char digits[32];  // the longest double takes 24
            auto const result = std::to_chars(digits, digits + sizeof(digits), part);
            _file.Write(digits, static_cast<std::size_t>(result.ptr - digits));
        } else {
            std::string_view const text(part);
            _file.Write(text.data(), text.size());
        }
    }

    FileReplacement& _file;
};

}  // namespace io
}  // namespace v1
}  // namespace osd_shading
