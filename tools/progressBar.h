// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace osd_shading::tool {

/// A bar on the terminal for work that takes longer than a second; gone when it ends. Draws nothing when stderr is
/// no terminal.
class ProgressBar {
public:
    explicit ProgressBar(bool isWanted);
    ~ProgressBar();
    ProgressBar(ProgressBar const&) = delete;
    ProgressBar& operator=(ProgressBar const&) = delete;

    bool IsEnabled() const { return _isEnabled; }

    /// Shows `share`, from 0 to 1.
    void Show(double share);

private:
    using Clock = std::chrono::steady_clock;

    bool _isEnabled;
    bool _isDrawn = false;
    Clock::time_point _nextDraw;
};

}  // namespace osd_shading::tool
