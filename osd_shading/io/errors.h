// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "osd_shading/errors.h"
#include "osd_shading/export.h"

namespace osd_shading {
inline namespace v1 {
namespace io {

/// A file was read but does not say what it should. The text is "FILE:LINE: what is wrong and what to do", or
/// "FILE: ..." where no single line is at fault.
class OSD_SHADING_API ParseError : public Error {
public:
    /// `line` counts from 1; 0 where the file as a whole is at fault. `text`: what is wrong and what to do.
    ParseError(std::string const& file, std::int64_t line, std::string const& text);
    ~ParseError() override;

    /// As it was given to the reader.
    std::string const& File() const { return _file; }

    /// Counts from 1; 0 where the file as a whole is at fault.
    std::int64_t Line() const { return _line; }

private:
    std::string _file;
    std::int64_t _line;
};

/// A file can't be opened or read; names it and says why, in the system's words.
class OSD_SHADING_API ReadError : public Error {
public:
    /// `reason`: in the system's words.
    ReadError(std::string const& file, std::string const& reason);
    ~ReadError() override;
};

/// A file can't be written; names it and says why. Nothing half-written is left.
class OSD_SHADING_API WriteError : public Error {
public:
    /// `reason`: in the system's words where it gave any.
    WriteError(std::string const& file, std::string const& reason);
    ~WriteError() override;
};

}  // namespace io
}  // namespace v1
}  // namespace osd_shading
