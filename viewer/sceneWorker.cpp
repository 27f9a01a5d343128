// SPDX-License-Identifier: Apache-2.0
#include "sceneWorker.h"

#include <exception>
#include <new>
#include <utility>

#include "memory.h"
#include "modelInput.h"
#include "osd_shading/io/objWriter.h"
#include "osd_shading/io/plyWriter.h"
#include "osd_shading/io/usdWriter.h"
#include "requestShading.h"

namespace osd_shading::viewer {

namespace {

constexpr std::chrono::milliseconds kShortWork(250);

// Writes what osd_shade would write.
template <typename Real>
void SaveResult(SceneRequest const& request, std::string const& path, tool::OutputFormat format) {
    io::Model const& model = *request.model;
    tool::RequireTriangles(request.file, request.rules.scheme, model);
    auto const run = tool::MakeInput<Real>(request.file, model, request.options.startNormals.kind);
    ShadingResult<Real> const result = ShadeRequest(request, run.input, request.options, OriginOf(model));
    switch (format) {
        case tool::OutputFormat::None:
            break;
        case tool::OutputFormat::Ply:
            io::WritePly(path, result);
            break;
        case tool::OutputFormat::Obj:
            io::WriteObj(path, result);
            break;
        case tool::OutputFormat::Usda:
            io::WriteUsd(path, result);
            break;
    }
}

}  // namespace

SceneWorker::SceneWorker(std::function<void()> wake) : _wake(std::move(wake)), _thread([this] { run(); }) {}

SceneWorker::~SceneWorker() {
    {
        std::lock_guard const lock(_mutex);
        _isEnding = true;
        _isAbandoned = true;
    }
    _changed.notify_one();
    _thread.join();
}

std::int64_t SceneWorker::RequestScene(SceneRequest request) {
    std::lock_guard const lock(_mutex);
    _nextScene = Job{++_numRequests, std::move(request), {}, tool::OutputFormat::None};
    if (_start && _runsScene && Clock::now() - *_start > kShortWork) _isAbandoned = true;
    _changed.notify_one();
    return _numRequests;
}

std::int64_t SceneWorker::RequestFile(SceneRequest request, std::string path, tool::OutputFormat format) {
    std::lock_guard const lock(_mutex);
    _nextFile = Job{++_numRequests, std::move(request), std::move(path), format};
    _changed.notify_one();
    return _numRequests;
}

void SceneWorker::Abandon() { _isAbandoned = true; }

std::optional<WorkResult> SceneWorker::Take() {
    std::lock_guard const lock(_mutex);
    if (_sceneResult) return std::exchange(_sceneResult, std::nullopt);
    return std::exchange(_fileResult, std::nullopt);
}

bool SceneWorker::IsBusy() const {
    std::lock_guard const lock(_mutex);
    return _start || _nextScene || _nextFile || _sceneResult || _fileResult;
}

double SceneWorker::BusySeconds() const {
    std::lock_guard const lock(_mutex);
    return _start ? std::chrono::duration<double>(Clock::now() - *_start).count() : 0;
}

void SceneWorker::run() {
    std::unique_lock lock(_mutex);
    for (;;) {
        _changed.wait(lock, [this] { return _isEnding || _nextScene || _nextFile; });
        if (_isEnding) return;
        std::optional<Job>& next = _nextScene ? _nextScene : _nextFile;
        Job const job = *std::exchange(next, std::nullopt);
        _runsScene = job.path.empty();
        _isAbandoned = false;
        _progress = 0;
        _start = Clock::now();

        lock.unlock();
        WorkResult result = work(job);
        lock.lock();

        _start.reset();
        std::optional<WorkResult>& place = job.path.empty() ? _sceneResult : _fileResult;
        place = std::move(result);
        if (!_isEnding) _wake();
    }
}

WorkResult SceneWorker::work(Job const& job) {
    WorkResult result;
    result.request = job.number;
    result.savedFile = job.path;
    auto const progress = [this](double share) {
        _progress = share;
        return !_isAbandoned;
    };
    try {
        if (job.path.empty()) {
            result.scene = _builder.Build(job.request, progress);
        } else {
            SceneRequest request = job.request;
            request.options.execution.progress = progress;
            if (request.precision == tool::Precision::Double) {
                SaveResult<double>(request, job.path, job.format);
            } else {
                SaveResult<float>(request, job.path, job.format);
            }
        }
    } catch (Cancelled const&) {
        result.isAbandoned = true;
    } catch (std::bad_alloc const&) {
        result.error = "out of memory; a lower level takes a quarter";
    } catch (std::exception const& error) {
        result.error = error.what();
    }
    return result;
}

}  // namespace osd_shading::viewer
