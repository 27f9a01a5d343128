// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/io/fileReplacement.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include "osd_shading/io/errors.h"

#if defined(_WIN32)
#    include <io.h>
#    include <process.h>
#else
#    include <pthread.h>
#    include <signal.h>
#    include <unistd.h>
#endif

namespace osd_shading {
inline namespace v1 {
namespace io {

namespace {

constexpr std::size_t kBufferSize = std::size_t{1} << 20;

#if defined(_WIN32)

constexpr int kWriteFlags = _O_WRONLY | _O_BINARY;
constexpr int kCreateFlags = kWriteFlags | _O_CREAT | _O_EXCL;
constexpr unsigned kNewFileMode = _S_IREAD | _S_IWRITE;
using OpenMode = int;

long writePiece(int file, void const* data, std::size_t size) {
    return ::_write(file, data, static_cast<unsigned>(std::min(size, kBufferSize)));
}
int syncFile(int file) { return ::_commit(file); }
int openFile(char const* path, int flags, OpenMode mode = 0) { return ::_open(path, flags, mode); }
int closeNumber(int file) { return ::_close(file); }
bool isWritable(char const* path) { return ::_access(path, 2) == 0; }
bool setMode(int, unsigned) { return true; }
long processNumber() { return ::_getpid(); }
std::optional<int> standardStream(std::string const&) { return std::nullopt; }

#else

constexpr int kWriteFlags = O_WRONLY | O_CLOEXEC | O_NOCTTY;
constexpr int kCreateFlags = kWriteFlags | O_CREAT | O_EXCL;
constexpr unsigned kNewFileMode = 0666;  // less what the user's umask takes away
using OpenMode = mode_t;

// Turns the signals that a failing write raises into its error code: blocked while it lives, and taken off the
// queue again where they were not pending before.
class WithoutWriteSignals {
public:
    WithoutWriteSignals() {
        sigemptyset(&_signals);
        sigaddset(&_signals, SIGPIPE);
        sigaddset(&_signals, SIGXFSZ);
        sigpending(&_pending);
        pthread_sigmask(SIG_BLOCK, &_signals, &_previous);
    }
    ~WithoutWriteSignals() {
        int const error = errno;
        for (int const signal : {SIGPIPE, SIGXFSZ}) take(signal);
        pthread_sigmask(SIG_SETMASK, &_previous, nullptr);
        errno = error;
    }
    WithoutWriteSignals(WithoutWriteSignals const&) = delete;
    WithoutWriteSignals& operator=(WithoutWriteSignals const&) = delete;

private:
    void take(int signal) const {
        sigset_t now;
        sigpending(&now);
        if (sigismember(&_pending, signal) || !sigismember(&now, signal)) return;
        sigset_t one;
        sigemptyset(&one);
        sigaddset(&one, signal);
        int taken = 0;
        sigwait(&one, &taken);
    }

    sigset_t _signals{}, _pending{}, _previous{};
};

long writePiece(int file, void const* data, std::size_t size) {
    WithoutWriteSignals const quiet;
    return ::write(file, data, size);
}
int syncFile(int file) { return ::fsync(file); }
int openFile(char const* path, int flags, OpenMode mode = 0) { return ::open(path, flags, mode); }
int closeNumber(int file) { return ::close(file); }
bool isWritable(char const* path) { return ::access(path, W_OK) == 0; }
bool setMode(int file, unsigned mode) { return ::fchmod(file, static_cast<mode_t>(mode)) == 0; }
long processNumber() { return ::getpid(); }

// The number of an open file that `path` is a name of. Such a name may lead to a regular file (a redirected
// stdout), which must be written on where it stands, neither replaced nor begun again.
std::optional<int> standardStream(std::string const& path) {
    if (path == "/dev/stdout") return 1;
    if (path == "/dev/stderr") return 2;
    for (std::string const prefix : {"/dev/fd/", "/proc/self/fd/"}) {
        if (path.compare(0, prefix.size(), prefix) != 0) continue;
        std::string const number = path.substr(prefix.size());
        bool const isNumber =
            !number.empty() && number.size() < 7 &&
            std::all_of(number.begin(), number.end(), [](char c) { return c >= '0' && c <= '9'; });
        if (isNumber) return std::stoi(number);
    }
    return std::nullopt;
}

#endif

// The path behind all links, also where nothing is there yet. Sets `error` when the links never end.
std::string followLinks(std::string const& path, int& error) {
    namespace fs = std::filesystem;
    fs::path current = path;
    constexpr int kMostLinks = 40;  // as Linux
    for (int i = 0; i < kMostLinks; ++i) {
        std::error_code failed;
        if (!fs::is_symlink(fs::symlink_status(current, failed))) return current.string();
        fs::path const next = fs::read_symlink(current, failed);
        if (failed) {
            error = failed.value();
            return {};
        }
        // Links count from the folder they lie in; operator/ keeps an absolute one as it is.
        current = current.parent_path() / next;
        if (standardStream(current.string())) return current.string();
    }
    error = ELOOP;
    return {};
}

}  // namespace

FileReplacement::FileReplacement(std::string const& path) : _path(path), _buffer(kBufferSize) {
    if (path.empty()) throw WriteError("''", "the name of the file is empty");

    // Find what is to be written: an open file, something that is there, or a name.
    int error = 0;
    _target = standardStream(path) ? path : followLinks(path, error);
    if (error != 0) fail(error);
    if (auto const stream = standardStream(_target)) {
        openDirectly(*stream);
        return;
    }
    struct stat status {};
    bool const exists = ::stat(_target.c_str(), &status) == 0;
    if (exists && (status.st_mode & S_IFMT) == S_IFDIR) throw WriteError(path, "it is a folder, not a file");
    if (exists && (status.st_mode & S_IFMT) != S_IFREG) {
        openDirectly(-1);
        return;
    }

    // Replacing takes no permission to write the old file; but its owner withdrew that for a reason.
    if (exists && !isWritable(_target.c_str())) fail(errno);
    openTemporary(exists ? static_cast<unsigned>(status.st_mode) & 07777u : kNewFileMode, exists);
}

FileReplacement::~FileReplacement() {
    if (_file >= 0) closeNumber(_file);
    if (!_temporary.empty()) std::remove(_temporary.c_str());
}

// `existing`: the number of an open file, -1: open the target.
void FileReplacement::openDirectly(int existing) {
#if !defined(_WIN32)
    if (existing >= 0) {
        _file = ::fcntl(existing, F_DUPFD_CLOEXEC, 3);
        if (_file < 0) fail(errno);
        return;
    }
#endif
    (void)existing;
    _file = openFile(_target.c_str(), kWriteFlags);
    if (_file < 0) fail(errno);
}

void FileReplacement::openTemporary(unsigned mode, bool replaces) {
    // Short, so that a target whose name is as long as names can be has room; hidden; new in each process and call.
    static std::atomic<unsigned> numCalls{0};
    auto const folder = std::filesystem::path(_target).parent_path();
    constexpr int kMostTries = 100;
    for (int i = 0; i < kMostTries && _file < 0; ++i) {
        auto const now = std::chrono::steady_clock::now().time_since_epoch().count();
        std::string const name = ".osd_shading_" + std::to_string(processNumber()) + "_" +
                                 std::to_string(numCalls++) + "_" + std::to_string(now) + ".tmp";
        std::string temporary = (folder / name).string();
        _file = openFile(temporary.c_str(), kCreateFlags, static_cast<OpenMode>(kNewFileMode));
        // Moved, for a copy could run out of memory, and leave the file that nobody knows of.
        if (_file >= 0) _temporary = std::move(temporary);
        if (_file < 0 && errno != EEXIST) fail(errno);
    }
    if (_file < 0) fail(EEXIST);
    if (replaces && !setMode(_file, mode)) fail(errno);
}

void FileReplacement::writeLarge(void const* data, std::size_t size) {
    writeOut(_buffer.data(), _used);
    _used = 0;
    if (size <= _buffer.size()) {
        Write(data, size);
    } else {
        writeOut(data, size);
    }
}

void FileReplacement::writeOut(void const* data, std::size_t size) {
    auto at = static_cast<char const*>(data);
    while (size > 0) {
        auto const written = writePiece(_file, at, size);
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) fail(errno);
        at += written;
        size -= static_cast<std::size_t>(written);
    }
}

void FileReplacement::closeFile() {
    int const file = _file;
    _file = -1;
    // Also on an error the number is free again: closing twice could close another thread's file.
    if (closeNumber(file) != 0 && errno != EINTR) fail(errno);
}

void FileReplacement::Commit() {
    writeOut(_buffer.data(), _used);
    _used = 0;
    if (_temporary.empty()) {
        closeFile();
        return;
    }

    // Some systems tell of a full disk only when the bytes must reach it.
    if (syncFile(_file) != 0) fail(errno);
    closeFile();
    std::error_code failed;
    std::filesystem::rename(_temporary, _target, failed);
    if (failed) fail(failed.value());
    _temporary.clear();
}

// A constructor that throws runs no destructor: clean up here.
void FileReplacement::fail(int error) {
    if (_file >= 0) closeNumber(_file);
    _file = -1;
    if (!_temporary.empty()) std::remove(_temporary.c_str());
    _temporary.clear();
    throw WriteError(_path, std::generic_category().message(error));
}

}  // namespace io
}  // namespace v1
}  // namespace osd_shading
