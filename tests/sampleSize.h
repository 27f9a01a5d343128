// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
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

/// How many cases a sweep over all shapes compares at least: a tenth under sanitizers, which see fewer shapes.
inline std::int64_t Fewest(std::int64_t count) { return IsSanitizerRun() ? count / 10 : count; }

/// The level of a sweep's results: one less under sanitizers, which run through the same code there.
inline int SweepLevel(int level) { return IsSanitizerRun() && !IsFullRun() ? level - 1 : level; }

/// Picks cases of a sweep: each in a full run, else each `step`th; under sanitizers each ninth of those. Steps
/// without a common factor with the numbers of shapes and options change from one to the next.
class SweepSample {
public:
    explicit SweepSample(std::uint64_t step) : _step(IsFullRun() ? 1 : IsSanitizerRun() ? 9 * step : step) {}
    bool Takes() { return _turn++ % _step == 0; }

private:
    std::uint64_t _step, _turn = 0;
};

/// The last level that a test takes a model of so many face corners to: `last` in a full run; else not further than
/// where it has some 15,000 faces (500 under sanitizers), but level 1 always.
inline int LastLevelOf(std::size_t numCorners, int last) {
    if (IsFullRun()) return last;
    std::size_t const mostFaces = IsSanitizerRun() ? 500 : 15000;
    int level = std::min(last, 1);
    for (std::size_t faces = 4 * numCorners; level < last && faces <= mostFaces; faces *= 4) ++level;
    return level;
}

}  // namespace osd_shading::tests
