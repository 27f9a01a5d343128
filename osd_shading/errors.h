// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

#include "osd_shading/export.h"

namespace osd_shading {
inline namespace v1 {

/// The one way in which this library fails: an exception derived from `Error`, thrown at the doors
/// (before any work), whose text names the element at fault and what to do. std::bad_alloc passes through.
class OSD_SHADING_API Error : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
    ~Error() override;
};

/// The control mesh, its points or its primvars can't be used; names the face, edge or vertex.
class OSD_SHADING_API InvalidControlMesh : public Error {
public:
    using Error::Error;
    ~InvalidControlMesh() override;
};

/// An option is outside its range or contradicts another; names the option.
class OSD_SHADING_API InvalidOptions : public Error {
public:
    using Error::Error;
    ~InvalidOptions() override;
};

/// The result would take more memory than `ExecutionOptions::memoryLimit`, or more elements than 32-bit
/// indices can number. Thrown before refining.
class OSD_SHADING_API MemoryLimitExceeded : public Error {
public:
    /// `text` says what was refused, `bytes` what it would take.
    MemoryLimitExceeded(std::string const& text, std::uint64_t bytes) : Error(text), _bytes(bytes) {}
    ~MemoryLimitExceeded() override;

    /// Bytes that the run would take (an estimate from above).
    std::uint64_t Bytes() const { return _bytes; }

private:
    std::uint64_t _bytes;
};

/// `ExecutionOptions::progress` returned false.
class OSD_SHADING_API Cancelled : public Error {
public:
    using Error::Error;
    ~Cancelled() override;
};

}  // namespace v1
}  // namespace osd_shading
