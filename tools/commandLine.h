// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "methodOptions.h"
#include "osd_shading/limitTessellation.h"
#include "osd_shading/shadingOptions.h"
#include "outputTarget.h"

namespace osd_shading::tool {

/// What the user asks for, checked as far as that goes without reading a file.
struct CommandLine : MeshOptions {
    std::string modelFile;

    std::string outputFile;  ///< empty: the table and the report are all
    OutputFormat format = OutputFormat::None;
    bool ascii = false;  ///< PLY as text
    bool cage = false;   ///< USD: the control cage too

    Precision precision = Precision::Double;
    ShadingOptions shading;
    std::optional<std::uint64_t> memoryLimit;  ///< unset: what the system can spare

    bool check = false;
    double tolerance = 0;  ///< of the check: share of the model's size

    int numFrames = 0;  ///< to be timed; 0: none
    DeformationKind deformation = DeformationKind::Bend;
    bool stats = false;  ///< what a table holds

    /// Cut the limit surface adaptively in place of a uniform level; unset: no. Screen: seen from `eye`, or, where
    /// that is unset, from the front, far enough to see all of the model.
    std::optional<TessellationOptions> tessellation;
    std::optional<Vec3<double>> eye;

    std::string reportFile;  ///< empty: none
    bool quiet = false;
};

/// Reads the command line; nothing when that asked for help or the version, which is then printed.
///
/// ERRORS: UsageError.
std::optional<CommandLine> ParseCommandLine(int argc, char const* const* argv);

}  // namespace osd_shading::tool
