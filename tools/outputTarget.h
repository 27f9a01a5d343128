// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace osd_shading::tool {

enum class OutputFormat { None, Ply, Obj, Usda };

/// The format that the ending of `path` names, in either case; PLY for a name without an ending that
/// is a pipe, a device or standard output. `None` where neither holds.
OutputFormat FormatOf(std::string const& path);

/// Whether both exist as, or would become, one regular file. False where one of the names is empty.
bool IsSameFile(std::string const& left, std::string const& right);

/// Whether writing to `path` is writing to where this program's standard output goes.
bool IsStandardOutput(std::string const& path);

/// Throws WriteError when it is plain already that `path` can't be written: no such folder, no permission.
/// Better known before an hour's work than after it.
void RequireWritable(std::string const& path);

/// While it lives, Ctrl-C and its like wait: a file that is being replaced is then either whole or as it was, and
/// no temporary one is left. Only for targets that are (to be) regular files; a write to a pipe may block for ever.
class DeferredSignals {
public:
    explicit DeferredSignals(std::string const& path);
    ~DeferredSignals();
    DeferredSignals(DeferredSignals const&) = delete;
    DeferredSignals& operator=(DeferredSignals const&) = delete;

private:
    bool _isActive;
};

}  // namespace osd_shading::tool
