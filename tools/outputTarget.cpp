// SPDX-License-Identifier: Apache-2.0
#include "outputTarget.h"

#include <pthread.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <filesystem>
#include <system_error>

#include "osd_shading/io/errors.h"

namespace osd_shading::tool {

namespace fs = std::filesystem;

namespace {

// What exists and is neither a regular file nor a folder: pipes, terminals, devices.
bool IsStream(std::string const& path) {
    struct stat status {};
    return stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode);
}

bool IsNullDevice(struct stat const& status) {
    struct stat null {};
    return S_ISCHR(status.st_mode) && stat("/dev/null", &null) == 0 && null.st_rdev == status.st_rdev;
}

sigset_t DeferrableSignals() {
    sigset_t signals;
    sigemptyset(&signals);
    for (int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&signals, signal);
    return signals;
}

}  // namespace

OutputFormat FormatOf(std::string const& path) {
    std::string suffix = fs::path(path).extension().string();
    std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (suffix == ".ply") return OutputFormat::Ply;
    if (suffix == ".obj") return OutputFormat::Obj;
    if (suffix == ".usda") return OutputFormat::Usda;
    return suffix.empty() && (IsStream(path) || IsStandardOutput(path)) ? OutputFormat::Ply : OutputFormat::None;
}

bool IsSameFile(std::string const& left, std::string const& right) {
    if (left.empty() || right.empty() || IsStream(left) || IsStream(right)) return false;
    std::error_code ignored;
    if (fs::equivalent(left, right, ignored)) return true;
    return fs::weakly_canonical(left, ignored) == fs::weakly_canonical(right, ignored);
}

bool IsStandardOutput(std::string const& path) {
    struct stat target {};
    struct stat output {};
    if (path.empty() || stat(path.c_str(), &target) != 0 || fstat(STDOUT_FILENO, &output) != 0) return false;
    return target.st_dev == output.st_dev && target.st_ino == output.st_ino && !IsNullDevice(target);
}

void RequireWritable(std::string const& path) {
    if (path.empty()) return;
    auto const refuse = [&](int error) { throw io::WriteError(path, std::generic_category().message(error)); };
    std::error_code ignored;
    if (fs::is_directory(path, ignored)) refuse(EISDIR);
    if (IsStream(path)) {
        if (access(path.c_str(), W_OK) != 0) refuse(errno);
        return;
    }
    // A new file is made in the folder and renamed: its permissions count. Links are followed.
    fs::path const target = fs::weakly_canonical(path, ignored);
    // An old file that its owner made read-only stays.
    if (access(path.c_str(), F_OK) == 0 && access(path.c_str(), W_OK) != 0) refuse(errno);
    fs::path const folder = (target.empty() ? fs::path(path) : target).parent_path();
    // Of a file in its place, access would only say that it can't be searched.
    if (fs::exists(folder, ignored) && !fs::is_directory(folder, ignored)) refuse(ENOTDIR);
    if (!folder.empty() && access(folder.c_str(), W_OK | X_OK) != 0) refuse(errno);
}

DeferredSignals::DeferredSignals(std::string const& path) : _isActive(!IsStream(path)) {
    if (!_isActive) return;
    sigset_t const signals = DeferrableSignals();
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
}

DeferredSignals::~DeferredSignals() {
    if (!_isActive) return;
    sigset_t const signals = DeferrableSignals();
    pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
}

}  // namespace osd_shading::tool
