// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>

// clang has no macro of its own for it.
#if defined(__has_feature)
#    if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#        define OSD_SHADING_UNDER_SANITIZER 1
#    endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#    define OSD_SHADING_UNDER_SANITIZER 1
#endif

namespace osd_shading::tests {

/// Whether `./dev test --full` runs: everything, not CI's sample.
inline bool IsFullRun() { return std::getenv("OSD_SHADING_TEST_FULL") != nullptr; }

inline bool IsSanitizerRun() {
#if defined(OSD_SHADING_UNDER_SANITIZER)
    return true;
#else
    return false;
#endif
}

/// How many cases a random test runs: the first `sample` of its fixed sequence; ten times as many in a full run; a
/// tenth under sanitizers, which make a case as much slower and look for what does not depend on many.
inline std::uint64_t SampleSize(std::uint64_t sample) {
    if (IsFullRun()) return 10 * sample;
    return IsSanitizerRun() ? std::max<std::uint64_t>(sample / 10, 4) : sample;
}

}  // namespace osd_shading::tests
