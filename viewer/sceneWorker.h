// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "outputTarget.h"
#include "sceneBuilder.h"

namespace osd_shading::viewer {

/// What came of a request.
struct WorkResult {
    std::int64_t request = 0;
    std::shared_ptr<Scene const> scene;  ///< null: failed, abandoned, or a file was asked for
    std::string error;                   ///< in words; empty where there is none
    std::string savedFile;               ///< of a request for a file
    bool isAbandoned = false;
};

/// Computes scenes and files on a thread of its own, one at a time. Of scenes only the last that is asked for
/// counts.
class SceneWorker {
public:
    /// `wake` is called, from that thread, when there is a result.
    explicit SceneWorker(std::function<void()> wake);
    ~SceneWorker();
    SceneWorker(SceneWorker const&) = delete;
    SceneWorker& operator=(SceneWorker const&) = delete;

    /// Numbers count up. Work that has run for long on an older request is abandoned; short work comes to its end,
    /// so that a slider that is dragged shows what it does.
    std::int64_t RequestScene(SceneRequest request);
    /// The result of `request`, at rest, as a file in the format that `path` ends in.
    std::int64_t RequestFile(SceneRequest request, std::string path, tool::OutputFormat format);
    /// Gives up what runs.
    void Abandon();

    std::optional<WorkResult> Take();
    bool IsBusy() const;
    double Progress() const { return _progress; }
    /// How long the work that runs has done so; 0: none runs.
    double BusySeconds() const;

private:
    using Clock = std::chrono::steady_clock;
    struct Job {
        std::int64_t number;
        SceneRequest request;
        std::string path;  // empty: a scene
        tool::OutputFormat format;
    };

    void run();
    WorkResult work(Job const& job);

    std::function<void()> _wake;
    mutable std::mutex _mutex;
    std::condition_variable _changed;
    std::optional<Job> _nextScene, _nextFile;
    std::optional<WorkResult> _sceneResult, _fileResult;
    std::int64_t _numRequests = 0;
    std::optional<Clock::time_point> _start;
    bool _runsScene = false, _isEnding = false;
    std::atomic<bool> _isAbandoned = false;
    std::atomic<double> _progress = 0;
    SceneBuilder _builder;
    std::thread _thread;
};

}  // namespace osd_shading::viewer
