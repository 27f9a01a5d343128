// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace osd_shading::tool {

/// Bytes that this process could still take: the least of what the system has available, of what is left under
/// the limits of the control groups (versions 1 and 2) it is in, and under its own RLIMIT_AS and RLIMIT_DATA.
/// 0 where nothing of this is known.
std::uint64_t FreeMemory();

/// The most memory that this process has had, in bytes; 0 where that isn't known.
std::uint64_t PeakMemory();

/// A number of bytes for people: "512 bytes", "1.5 MiB".
std::string BytesText(std::uint64_t bytes);

}  // namespace osd_shading::tool
