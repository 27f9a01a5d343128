// SPDX-License-Identifier: Apache-2.0
#include "progressBar.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <string>

namespace osd_shading::tool {

namespace {

constexpr std::chrono::milliseconds kFirstDraw(1000);
constexpr std::chrono::milliseconds kDrawInterval(100);
constexpr int kWidth = 40;

}  // namespace

ProgressBar::ProgressBar(bool isWanted)
    : _isEnabled(isWanted && isatty(STDERR_FILENO) != 0), _nextDraw(Clock::now() + kFirstDraw) {}

ProgressBar::~ProgressBar() {
    if (_isDrawn) std::fputs("\r\033[K", stderr);
}

void ProgressBar::Show(double share) {
    if (!_isEnabled || Clock::now() < _nextDraw) return;
    _nextDraw = Clock::now() + kDrawInterval;
    _isDrawn = true;
    int const done = static_cast<int>(std::clamp(share, 0.0, 1.0) * kWidth);
    std::string const bar = std::string(static_cast<std::size_t>(done), '=') +
                            std::string(static_cast<std::size_t>(kWidth - done), ' ');
    std::fprintf(stderr, "\r[%s] %3d%%", bar.c_str(), static_cast<int>(100 * std::clamp(share, 0.0, 1.0)));
    std::fflush(stderr);
}

}  // namespace osd_shading::tool
