// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/io/errors.h"

namespace osd_shading {
inline namespace v1 {
namespace io {

namespace {

std::string locate(std::string const& file, std::int64_t line, std::string const& text) {
    return line > 0 ? file + ":" + std::to_string(line) + ": " + text : file + ": " + text;
}

}  // namespace

ParseError::ParseError(std::string const& file, std::int64_t line, std::string const& text)
    : Error(locate(file, line, text)), _file(file), _line(line) {}

ReadError::ReadError(std::string const& file, std::string const& reason)
    : Error(file + ": can't be read: " + reason) {}

WriteError::WriteError(std::string const& file, std::string const& reason)
    : Error(file + ": can't be written: " + reason) {}

// Defined here so that each class has one home for its type information.
ParseError::~ParseError() = default;
ReadError::~ReadError() = default;
WriteError::~WriteError() = default;

}  // namespace io
}  // namespace v1
}  // namespace osd_shading
