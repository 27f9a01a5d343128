// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <memory>

namespace osd_shading {
inline namespace v1 {
namespace tables {

/// Threads that wait from frame to frame, so that a frame starts none: oneTBB's, where the library is built with
/// it, else its own.
class FrameThreads {
public:
    /// `numThreads`: 1 or more, the caller's among them. A system that is short of threads gives fewer;
    /// oneTBB no more than the machine has, the library itself no more than that or 256.
    explicit FrameThreads(int numThreads);
    ~FrameThreads();
    FrameThreads(FrameThreads const&) = delete;
    FrameThreads& operator=(FrameThreads const&) = delete;

    int NumThreads() const { return _numThreads; }

    /// Calls `body(chunk, thread)` for each chunk of [0, numChunks), some at the same time, and returns when all
    /// are done. `thread` is 0 to NumThreads() - 1, and one at a time has each. An exception ends the run early
    /// and is rethrown. Allocates nothing of its own. One Run at a time.
    template <typename Body>
    void Run(int numChunks, Body const& body) {
        if (_numThreads == 1 || numChunks <= 1) {
            for (int chunk = 0; chunk < numChunks; ++chunk) body(chunk, 0);
            return;
        }
        run(
            numChunks,
            [](void const* context, int chunk, int thread) { (*static_cast<Body const*>(context))(chunk, thread); },
            &body);
    }

private:
    using Call = void (*)(void const* context, int chunk, int thread);
    struct Impl;

    void run(int numChunks, Call call, void const* context);

    int _numThreads = 1;
    std::unique_ptr<Impl> _impl;  // null with one thread
};

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
