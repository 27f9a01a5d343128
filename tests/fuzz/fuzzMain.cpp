// SPDX-License-Identifier: Apache-2.0

// libFuzzer's entry, compiled once for each target.

#include "fuzzTargets.h"

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
    fuzz::OSD_SHADING_FUZZ_TARGET(data, size);
    return 0;
}
