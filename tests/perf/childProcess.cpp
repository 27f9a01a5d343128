// SPDX-License-Identifier: Apache-2.0
#include "childProcess.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <fstream>
#include <stdexcept>

#ifdef __GLIBC__
#    include <malloc.h>
#endif

namespace perf {

namespace {

void writeAll(int file, std::string const& text) {
    std::size_t written = 0;
    while (written < text.size()) {
        ssize_t const count = write(file, text.data() + written, text.size() - written);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return;
        written += static_cast<std::size_t>(count);
    }
}

std::string readAll(int file) {
    std::string text;
    char buffer[4096];
    for (;;) {
        ssize_t const count = read(file, buffer, sizeof buffer);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return text;
        text.append(buffer, static_cast<std::size_t>(count));
    }
}

}  // namespace

ChildOutcome RunInChild(std::function<std::string()> const& work) {
    int ends[2];
    if (pipe(ends) != 0) throw std::runtime_error("no pipe to a child process");
    pid_t const child = fork();
    if (child < 0) throw std::runtime_error("no child process");
    if (child == 0) {
        close(ends[0]);
        int status = EXIT_SUCCESS;
        std::string text;
        try {
            text = work();
        } catch (std::exception const& error) {
            text = error.what();
            status = EXIT_FAILURE;
        }
        writeAll(ends[1], text);
        // Without the parent's destructors and buffers.
        _exit(status);
    }
    close(ends[1]);
    ChildOutcome outcome;
    outcome.text = readAll(ends[0]);
    close(ends[0]);

    int status = 0;
    rusage usage{};
    while (wait4(child, &status, 0, &usage) < 0 && errno == EINTR) {
    }
    outcome.succeeded = WIFEXITED(status) && WEXITSTATUS(status) == EXIT_SUCCESS;
    if (WIFSIGNALED(status)) outcome.text = "ended by signal " + std::to_string(WTERMSIG(status));
#ifdef __APPLE__
    outcome.peakBytes = usage.ru_maxrss;
#else
    outcome.peakBytes = static_cast<std::int64_t>(usage.ru_maxrss) * 1024;
#endif
    return outcome;
}

std::uint64_t AvailableBytes() {
    std::ifstream file("/proc/meminfo");
    std::string word;
    std::uint64_t kilobytes = 0;
    while (file >> word) {
        if (word == "MemAvailable:" && file >> kilobytes) return kilobytes * 1024;
    }
    auto const pages = sysconf(_SC_PHYS_PAGES), size = sysconf(_SC_PAGESIZE);
    return pages > 0 && size > 0 ? static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(size) : 0;
}

double ProcessorSeconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void ReturnFreedMemory() {
#ifdef __GLIBC__
    malloc_trim(0);
#endif
}

void KeepFreedMemory() {
#ifdef __GLIBC__
    constexpr int kNever = 2'000'000'000;
    mallopt(M_TRIM_THRESHOLD, kNever);
    mallopt(M_MMAP_MAX, 0);
#endif
}

}  // namespace perf
