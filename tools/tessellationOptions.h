// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "optionParsing.h"
#include "osd_shading/limitTessellation.h"

namespace osd_shading::tool {

/// How the limit surface is cut into triangles; unset: it is not, or the library's default.
struct TessellationChoice {
    std::optional<TessellationKind> kind;
    std::optional<int> rate;  ///< where `kind` is Uniform
    std::optional<double> maxAngle, maxPixels;

    bool IsScreen() const { return kind == TessellationKind::Screen; }

    /// Nothing where no `kind` is chosen.
    ///
    /// ERRORS: UsageError where options contradict each other.
    std::optional<TessellationOptions> Resolve() const;

    bool operator==(TessellationChoice const&) const = default;
};

/// The words of `--tessellate`, beside a number.
inline constexpr OptionNames<TessellationKind, 2> kTessellationNames = {
    {{"screen", TessellationKind::Screen}, {"curvature", TessellationKind::Curvature}}};

/// The options, in a group of the help that the program may add to.
inline constexpr char kTessellationGroup[] = "Adaptive triangles";
void AddTessellationOptions(CLI::App& app, TessellationChoice& given);

}  // namespace osd_shading::tool
