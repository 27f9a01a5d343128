// SPDX-License-Identifier: Apache-2.0
#include "tessellationOptions.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <string>

namespace osd_shading::tool {

std::optional<TessellationOptions> TessellationChoice::Resolve() const {
    if (!kind) {
        for (auto const& [option, value] : {std::pair{"--max-angle", maxAngle}, {"--max-pixels", maxPixels}}) {
            if (value) Refuse(option, "nothing is tessellated; give --tessellate");
        }
        return std::nullopt;
    }
    if (maxAngle && kind != TessellationKind::Curvature) {
        Refuse("--max-angle", "goes with --tessellate curvature");
    }
    if (maxPixels && kind != TessellationKind::Screen) Refuse("--max-pixels", "goes with --tessellate screen");
    TessellationOptions options;
    options.kind = *kind;
    Replace(options.rate, rate);
    Replace(options.maxAngle, maxAngle);
    Replace(options.maxPixels, maxPixels);
    return options;
}

void AddTessellationOptions(CLI::App& app, TessellationChoice& given) {
    auto const readKind = [&given](std::string const& text) {
        given.rate.reset();
        for (auto const& [name, kind] : kTessellationNames) {
            if (name != text) continue;
            given.kind = kind;
            return;
        }
        std::optional<int> const rate = ParseNumber<int>(text);
        if (!rate || *rate < 1 || *rate > 1024) {
            Refuse("--tessellate", "'" + text + "' is not screen, curvature or a number from 1 to 1024");
        }
        given.kind = TessellationKind::Uniform;
        given.rate = rate;
    };
    app.add_option_function<std::string>(
           "--tessellate", readKind,
           "In place of a uniform level: triangles on the limit surface, by the length of edges on a screen, by "
           "curvature, or N segments to each edge. --level is then that at which weights end (default: where all "
           "creases are released)")
        ->type_name("screen|curvature|N")
        ->group(kTessellationGroup);
    auto const isPositive = [](double x) { return std::isfinite(x) && x > 0; };
    AddNumber(app, "--max-angle", given.maxAngle, "a number above 0", isPositive,
              "curvature: degrees that the surface turns from point to point (default 10)")
        ->group(kTessellationGroup);
    AddNumber(app, "--max-pixels", given.maxPixels, "a number above 0", isPositive,
              "screen: length of a segment in pixels (default 8)")
        ->group(kTessellationGroup);
}

}  // namespace osd_shading::tool
