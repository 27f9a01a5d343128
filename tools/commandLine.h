// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "optionNames.h"
#include "osd_shading/errors.h"
#include "osd_shading/io/model.h"
#include "osd_shading/shadingOptions.h"

namespace osd_shading::tool {

/// What was typed can't be done; says which option is at fault.
class UsageError : public Error {
public:
    using Error::Error;
};

enum class OutputFormat { None, Ply, Obj, Usda };

/// What the user asks for, checked as far as that goes without reading a file.
struct CommandLine {
    std::string modelFile;

    std::string outputFile;  ///< empty: the table and the report are all
    OutputFormat format = OutputFormat::None;
    bool ascii = false;  ///< PLY as text
    bool cage = false;   ///< USD: the control cage too

    std::string sharpnessFile;  ///< empty: as the model has it
    std::optional<double> creaseAngle;
    std::optional<double> creaseScale;

    Sdc::SchemeType scheme = Sdc::SCHEME_CATMARK;
    std::optional<Sdc::Options::VtxBoundaryInterpolation> boundary;
    std::optional<Sdc::Options::CreasingMethod> creasing;
    std::optional<Sdc::Options::TriangleSubdivision> triangles;

    Precision precision = Precision::Double;
    ShadingOptions shading;
    std::optional<std::uint64_t> memoryLimit;  ///< unset: what the system can spare

    bool check = false;
    double tolerance = 0;  ///< of the check: share of the model's size

    int numFrames = 0;  ///< to be timed; 0: none
    DeformationKind deformation = DeformationKind::Bend;
    bool stats = false;  ///< what a table holds

    std::string reportFile;  ///< empty: none
    bool quiet = false;

    /// How OpenSubdiv is to refine `model`: what is given here, else its tags, else the library's defaults.
    SubdivisionRules Rules(io::Model const& model) const;
};

/// Reads the command line; nothing when that asked for help or the version, which is then printed.
///
/// ERRORS: UsageError.
std::optional<CommandLine> ParseCommandLine(int argc, char const* const* argv);

}  // namespace osd_shading::tool
