// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace osd_shading {
inline namespace v1 {
namespace tables {

/// Threads that wait from frame to frame, so that a frame starts none.
class FrameThreads {
public:
    explicit FrameThreads(int numThreads) {
        try {
            for (int i = 1; i < numThreads; ++i) {
                _threads.emplace_back([this, i] { serve(i); });
            }
        } catch (...) {
            // A system that is short of threads gets the same result from fewer.
        }
    }
    ~FrameThreads() {
        {
            std::lock_guard<std::mutex> const lock(_mutex);
            _isEnding = true;
        }
        _wake.notify_all();
        for (std::thread& thread : _threads) thread.join();
    }
    FrameThreads(FrameThreads const&) = delete;
    FrameThreads& operator=(FrameThreads const&) = delete;

    int NumThreads() const { return static_cast<int>(_threads.size()) + 1; }

    /// Calls `body(chunk, thread)` for each chunk of [0, numChunks); `thread` counts from 0. Allocates nothing.
    template <typename Body>
    void Run(int numChunks, Body const& body) {
        if (_threads.empty() || numChunks <= 1) {
            for (int chunk = 0; chunk < numChunks; ++chunk) body(chunk, 0);
            return;
        }
        {
            std::lock_guard<std::mutex> const lock(_mutex);
            _call = [](void const* context, int chunk, int thread) {
                (*static_cast<Body const*>(context))(chunk, thread);
            };
            _context = &body;
            _numChunks = numChunks;
            _next = 0;
            _numServing = static_cast<int>(_threads.size());
            _failure = nullptr;
            ++_run;
        }
        _wake.notify_all();
        work(0);
        std::unique_lock<std::mutex> lock(_mutex);
        _done.wait(lock, [this] { return _numServing == 0; });
        if (_failure) std::rethrow_exception(_failure);
    }

private:
    void serve(int thread) {
        std::uint64_t lastRun = 0;
        std::unique_lock<std::mutex> lock(_mutex);
        for (;;) {
            _wake.wait(lock, [&] { return _isEnding || _run != lastRun; });
            if (_isEnding) return;
            lastRun = _run;
            lock.unlock();
            work(thread);
            lock.lock();
            if (--_numServing == 0) _done.notify_one();
        }
    }
    void work(int thread) {
        try {
            for (int chunk = _next++; chunk < _numChunks; chunk = _next++) _call(_context, chunk, thread);
        } catch (...) {
            std::lock_guard<std::mutex> const lock(_mutex);
            _failure = std::current_exception();
            _next = _numChunks;
        }
    }

    std::vector<std::thread> _threads;
    std::mutex _mutex;
    std::condition_variable _wake, _done;
    void (*_call)(void const*, int, int) = nullptr;
    void const* _context = nullptr;
    std::atomic<int> _next{0};
    int _numChunks = 0, _numServing = 0;
    std::uint64_t _run = 0;
    bool _isEnding = false;
    std::exception_ptr _failure;
};

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
