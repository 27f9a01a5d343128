// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/tables/frameThreads.h"

#ifdef OSD_SHADING_WITH_TBB

#    include <oneapi/tbb/global_control.h>
#    include <oneapi/tbb/parallel_for.h>
#    include <oneapi/tbb/partitioner.h>
#    include <oneapi/tbb/task_arena.h>

#    include <algorithm>

#else

#    include <algorithm>
#    include <atomic>
#    include <condition_variable>
#    include <cstdint>
#    include <exception>
#    include <mutex>
#    include <thread>
#    include <vector>

#endif

namespace osd_shading {
inline namespace v1 {
namespace tables {

#ifdef OSD_SHADING_WITH_TBB

// An arena of the caller's number of threads, taken from those that the program's other TBB work shares. A slot of
// it is one thread's at a time: its index names the thread.
struct FrameThreads::Impl {
    explicit Impl(int numThreads) : arena(std::min(numThreads, MostThreads())) { arena.initialize(); }

    /// The program's own limit, else as many as the machine has: oneTBB prints a warning where it is asked for
    /// more.
    static int MostThreads() {
        using Control = oneapi::tbb::global_control;
        return static_cast<int>(
            std::min<std::size_t>(Control::active_value(Control::max_allowed_parallelism), 1 << 16));
    }

    int NumThreads() const { return arena.max_concurrency(); }
    void Run(int numChunks, Call call, void const* context) {
        arena.execute([&] {
            // One chunk a task: a chunk is some ten microseconds of work, and which thread takes it changes
            // nothing.
            oneapi::tbb::parallel_for(
                0, numChunks,
                [&](int chunk) { call(context, chunk, oneapi::tbb::this_task_arena::current_thread_index()); },
                oneapi::tbb::simple_partitioner());
        });
    }

    oneapi::tbb::task_arena arena;
};

#else

struct FrameThreads::Impl {
    explicit Impl(int numThreads) {
        // A number that is a mistake must not take all threads of the system.
        constexpr unsigned kMany = 256;
        numThreads = std::min(numThreads, static_cast<int>(std::max(kMany, std::thread::hardware_concurrency())));
        try {
            for (int i = 1; i < numThreads; ++i) {
                _threads.emplace_back([this, i] { serve(i); });
            }
        } catch (...) {
            // The same result from fewer.
        }
    }
    ~Impl() {
        {
            std::lock_guard<std::mutex> const lock(_mutex);
            _isEnding = true;
        }
        _wake.notify_all();
        for (std::thread& thread : _threads) thread.join();
    }
    Impl(Impl const&) = delete;
    Impl& operator=(Impl const&) = delete;

    int NumThreads() const { return static_cast<int>(_threads.size()) + 1; }
    void Run(int numChunks, Call call, void const* context) {
        {
            std::lock_guard<std::mutex> const lock(_mutex);
            _call = call;
            _context = context;
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
    Call _call = nullptr;
    void const* _context = nullptr;
    std::atomic<int> _next{0};
    int _numChunks = 0, _numServing = 0;
    std::uint64_t _run = 0;
    bool _isEnding = false;
    std::exception_ptr _failure;
};

#endif

FrameThreads::FrameThreads(int numThreads) {
    if (numThreads <= 1) return;
    _impl = std::make_unique<Impl>(numThreads);
    _numThreads = _impl->NumThreads();
}

FrameThreads::~FrameThreads() = default;

void FrameThreads::run(int numChunks, Call call, void const* context) { _impl->Run(numChunks, call, context); }

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
