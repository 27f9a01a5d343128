// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace osd_shading::tests {

/// How often memory was taken with `new` since the program began, in a program that links countedAllocations.cpp:
/// a file of its own, for a compiler that sees `free` next to what it was called on takes it for a mistake.
std::int64_t NumAllocations();

/// How many of those were not given back yet.
std::int64_t NumLiveAllocations();

/// Lets the allocation `number` from now on fail, 1 being the next; 0: none.
void FailAllocation(std::int64_t number);

}  // namespace osd_shading::tests
