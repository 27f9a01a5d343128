// SPDX-License-Identifier: Apache-2.0
#include "memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>

namespace osd_shading::tool {

namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

std::uint64_t Difference(std::uint64_t limit, std::uint64_t used) { return limit > used ? limit - used : 0; }

// The first number of a file; nothing where there is no file or it says "max".
std::optional<std::uint64_t> ReadNumber(fs::path const& file) {
    std::uint64_t number = 0;
    if (std::ifstream(file) >> number) return number;
    return std::nullopt;
}

// The number after `key` in a file of lines "key number ..".
std::optional<std::uint64_t> ReadEntry(fs::path const& file, std::string const& key) {
    std::ifstream in(file);
    std::string line;
    while (std::getline(in, line)) {
        std::istringstream words(line);
        std::string word;
        std::uint64_t number = 0;
        if (words >> word && word == key && words >> number) return number;
    }
    return std::nullopt;
}

// What is left in one control group. Cached files count as used there, but the system drops them when needed.
std::uint64_t FreeInGroup(fs::path const& group, char const* limitName, char const* usageName,
                          char const* cacheKey) {
    std::optional<std::uint64_t> const limit = ReadNumber(group / limitName);
    std::optional<std::uint64_t> const used = ReadNumber(group / usageName);
    if (!limit || !used) return kUnlimited;
    return Difference(*limit, Difference(*used, ReadEntry(group / "memory.stat", cacheKey).value_or(0)));
}

// The group that `path` names below `root`, and those around it: the tightest counts. Inside a container a path
// may name a group of the host that can't be seen; the groups above it can.
std::uint64_t FreeInGroups(fs::path const& root, std::string const& path, char const* limitName,
                           char const* usageName, char const* cacheKey) {
    std::uint64_t free = FreeInGroup(root, limitName, usageName, cacheKey);
    fs::path group = root;
    for (fs::path const& part : fs::path(path).relative_path()) {
        group /= part;
        free = std::min(free, FreeInGroup(group, limitName, usageName, cacheKey));
    }
    return free;
}

// Lines of /proc/self/cgroup: "0::/path" (version 2), "7:memory:/path" or "7:cpu,memory:/path" (version 1).
std::uint64_t FreeInControlGroups() {
    std::uint64_t free = kUnlimited;
    std::ifstream in("/proc/self/cgroup");
    std::string line;
    while (std::getline(in, line)) {
        std::size_t const first = line.find(':');
        std::size_t const second = line.find(':', first + 1);
        if (first == std::string::npos || second == std::string::npos) continue;
        std::string const controllers = "," + line.substr(first + 1, second - first - 1) + ",";
        std::string const path = line.substr(second + 1);
        if (controllers == ",,") {
            for (char const* root : {"/sys/fs/cgroup", "/sys/fs/cgroup/unified"}) {
                free = std::min(free, FreeInGroups(root, path, "memory.max", "memory.current", "inactive_file"));
            }
        } else if (controllers.find(",memory,") != std::string::npos) {
            free = std::min(free, FreeInGroups("/sys/fs/cgroup/memory", path, "memory.limit_in_bytes",
                                               "memory.usage_in_bytes", "total_inactive_file"));
        }
    }
    return free;
}

std::uint64_t FreeUnderLimit(int resource, std::uint64_t used) {
    rlimit limit{};
    if (getrlimit(static_cast<decltype(RLIMIT_AS)>(resource), &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) {
        return kUnlimited;
    }
    return Difference(limit.rlim_cur, used);
}

std::uint64_t FreeOfProcess() {
    constexpr std::uint64_t kKibi = 1024;
    std::uint64_t const all = kKibi * ReadEntry("/proc/self/status", "VmSize:").value_or(0);
    std::uint64_t const data = kKibi * ReadEntry("/proc/self/status", "VmData:").value_or(0);
    return std::min(FreeUnderLimit(RLIMIT_AS, all), FreeUnderLimit(RLIMIT_DATA, data));
}

std::uint64_t FreeOfSystem() {
    if (std::optional<std::uint64_t> const kibi = ReadEntry("/proc/meminfo", "MemAvailable:")) {
        return 1024 * *kibi;
    }
    // Not Linux: all there is, for want of what is free.
    long const pages = sysconf(_SC_PHYS_PAGES);
    long const pageSize = sysconf(_SC_PAGESIZE);
    if (pages <= 0 || pageSize <= 0) return kUnlimited;
    return static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(pageSize);
}

}  // namespace

std::uint64_t FreeMemory() {
    std::uint64_t const free = std::min({FreeOfSystem(), FreeInControlGroups(), FreeOfProcess()});
    if (free == kUnlimited) return 0;
    // 0 means "not known": nothing left is one byte.
    return std::max<std::uint64_t>(free, 1);
}

std::uint64_t PeakMemory() {
    // getrusage would count what this process was before it became this program.
    if (std::optional<std::uint64_t> const kibi = ReadEntry("/proc/self/status", "VmHWM:")) return 1024 * *kibi;
    rusage usage{};
    if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
#if defined(__APPLE__)
    return static_cast<std::uint64_t>(usage.ru_maxrss);
#else
    return 1024 * static_cast<std::uint64_t>(usage.ru_maxrss);
#endif
}

std::string BytesText(std::uint64_t bytes) {
    static constexpr std::array kUnits = {"bytes", "KiB", "MiB", "GiB", "TiB", "PiB", "EiB"};
    if (bytes < 1024) return std::to_string(bytes) + " bytes";
    double amount = static_cast<double>(bytes);
    std::size_t unit = 0;
    while (amount >= 1024 && unit + 1 < kUnits.size()) {
        amount /= 1024;
        ++unit;
    }
    char text[32];
    std::snprintf(text, sizeof text, "%.1f %s", amount, kUnits[unit]);
    return text;
}

}  // namespace osd_shading::tool
