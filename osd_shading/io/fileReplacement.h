// SPDX-License-Identifier: Apache-2.0
#pragma once

/// \file
/// Not needed by ordinary clients: how the writers bring bytes to a file, whole or not at all. The one room that
/// talks to the operating system.

#include <cstddef>
#include <cstring>
#include <string>
#include <vector>

#include "osd_shading/export.h"

namespace osd_shading {
inline namespace v1 {
namespace io {

/// A file that appears complete or not at all.
///
///     FileReplacement file(path);
///     file.Write(bytes.data(), bytes.size());
///     file.Commit();
///
/// What is written goes to a temporary file in the same folder; `Commit` makes sure that it is on the disk and
/// gives it the name `path`, with the permissions of the file it replaces. Destroyed before that, it leaves
/// nothing. A link stays, and what it points to is replaced. What exists and is no regular file (a pipe,
/// /dev/stdout, /dev/null) is written directly.
///
/// ERRORS: WriteError from each function, also where the system would by default end the process by a signal (a
/// file beyond the process's limit, a closed pipe).
class OSD_SHADING_API FileReplacement {
public:
    explicit FileReplacement(std::string const& path);
    ~FileReplacement();
    FileReplacement(FileReplacement const&) = delete;
    FileReplacement& operator=(FileReplacement const&) = delete;

    void Write(void const* data, std::size_t size) {
        if (size > _buffer.size() - _used) {
            writeLarge(data, size);
            return;
        }
        if (size > 0) std::memcpy(_buffer.data() + _used, data, size);
        _used += size;
    }

    void Commit();

private:
    void writeLarge(void const* data, std::size_t size);
    void writeOut(void const* data, std::size_t size);
    void openDirectly(int existing);
    void openTemporary(unsigned mode, bool replaces);
    void closeFile();
    [[noreturn]] void fail(int error);

    std::string _path;       // as the caller names it, for messages
    std::string _target;     // what is replaced: the path behind all links
    std::string _temporary;  // empty: written directly, or renamed
    int _file = -1;
    std::vector<char> _buffer;
    std::size_t _used = 0;
};

}  // namespace io
}  // namespace v1
}  // namespace osd_shading
