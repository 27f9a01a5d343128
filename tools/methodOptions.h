// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "optionParsing.h"
#include "osd_shading/io/model.h"
#include "osd_shading/shadingOptions.h"

namespace osd_shading::tool {

// The options of the method, which all programs have under the same names.

/// What happens to a model after it is read, and how OpenSubdiv refines it. Unset: as the file has it.
struct MeshOptions {
    std::string sharpnessFile;  ///< empty: as the model has it
    std::optional<double> creaseAngle;
    std::optional<double> creaseScale;

    std::optional<Sdc::SchemeType> scheme;
    std::optional<Sdc::Options::VtxBoundaryInterpolation> boundary;
    std::optional<Sdc::Options::CreasingMethod> creasing;
    std::optional<Sdc::Options::TriangleSubdivision> triangles;

    Sdc::SchemeType Scheme() const { return scheme.value_or(Sdc::SCHEME_CATMARK); }

    /// How OpenSubdiv is to refine `model`: what is given here, else its tags, else the library's defaults.
    SubdivisionRules Rules(io::Model const& model) const;
};

/// Options that a preset has an opinion on: what is given wins, so they are kept apart until all are known.
struct ShadingChoice {
    std::optional<bool> smoothPreset;
    std::optional<int> level, normalsFrom, weightsFrom, sphericalSteps;
    std::optional<SharpVertexWeight> sharpVertices;
    std::optional<DartWeight> darts;
    std::optional<WeightScheme> weights;
    std::optional<double> exponent;
    std::optional<StartNormalKind> startNormals;
    std::optional<NormalAveraging> averaging;
    std::optional<LimitNormalKind> limitNormals;
    std::optional<PositionKind> positions;

    /// `defaultLevel`: where none is given.
    ///
    /// ERRORS: UsageError where options contradict each other.
    ShadingOptions Resolve(int defaultLevel = ShadingOptions{}.level) const;
};

/// What a run may take and how it computes; unset: each program's default.
struct RunChoice {
    std::optional<Precision> precision;
    std::optional<int> threads;
    std::optional<std::uint64_t> memoryLimit;  ///< bytes, above 0

    bool operator==(RunChoice const&) const = default;
};

/// The words of `--preset`.
inline constexpr OptionNames<bool, 2> kPresetNames = {{{"paper", false}, {"smooth", true}}};

void AddMeshOptions(CLI::App& app, MeshOptions& mesh);
void AddShadingOptions(CLI::App& app, ShadingChoice& given);
/// `precisionDefault`: the program's own, in words.
void AddRunOptions(CLI::App& app, RunChoice& given, std::string const& precisionDefault);

}  // namespace osd_shading::tool
