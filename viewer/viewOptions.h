// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "optionNames.h"

namespace osd_shading::viewer {

using tool::OptionNames;

/// What a pixel's colour says.
enum class ShadingMode {
    Lit,         ///< a headlight and a key light
    Highlight,   ///< reflected parallel line lights, in blue and cyan  [ZBK23]
    Isophotes,   ///< lines of equal angle to the view direction
    Zebra,       ///< reflected environment of black and white rings
    Normal,      ///< components as red, green and blue
    Weight,      ///< blend weight: blue 0, red 1
    Curvature,   ///< mean curvature of the normal field
    Facing,      ///< front or back, and normals that point away from the eye
    Difference,  ///< angle between the two normals of a split
};

enum class NormalChoice {
    Limit,       ///< N_L
    Subdivided,  ///< N_S, also where the blend doesn't need it
    Blended,     ///< N_B
    Face         ///< one per face of the result
};

enum class SplitKind {
    None,
    SideBySide,  ///< the whole view twice
    Line         ///< one view, divided by an upright line
};

enum class Background { Light, Dark };

/// Bits of ViewOptions::overlays.
enum Overlay : std::uint32_t {
    kCreases = 1,     ///< sharp edges, coloured by the sharpness of the control edge
    kWireframe = 2,   ///< edges of the result
    kCage = 4,        ///< edges of the control mesh
    kEv = 8,          ///< extraordinary vertices with their valence
    kDarts = 16,      ///< vertices where one sharp edge ends
    kCorners = 32,    ///< corner vertices
    kRegions = 64,    ///< regions of one vertex, with their normals
    kSelection = 128  ///< selected edges and vertices; no word of the command line
};

inline constexpr OptionNames<ShadingMode, 9> kShadingNames = {{{"lit", ShadingMode::Lit},
                                                               {"highlight", ShadingMode::Highlight},
                                                               {"isophotes", ShadingMode::Isophotes},
                                                               {"zebra", ShadingMode::Zebra},
                                                               {"normal", ShadingMode::Normal},
                                                               {"weight", ShadingMode::Weight},
                                                               {"curvature", ShadingMode::Curvature},
                                                               {"facing", ShadingMode::Facing},
                                                               {"difference", ShadingMode::Difference}}};

inline constexpr OptionNames<NormalChoice, 4> kNormalNames = {{{"limit", NormalChoice::Limit},
                                                               {"subdivided", NormalChoice::Subdivided},
                                                               {"blended", NormalChoice::Blended},
                                                               {"face", NormalChoice::Face}}};

inline constexpr OptionNames<Overlay, 7> kOverlayNames = {{{"creases", kCreases},
                                                           {"wireframe", kWireframe},
                                                           {"cage", kCage},
                                                           {"ev", kEv},
                                                           {"darts", kDarts},
                                                           {"corners", kCorners},
                                                           {"regions", kRegions}}};

inline constexpr OptionNames<Background, 2> kBackgroundNames = {
    {{"light", Background::Light}, {"dark", Background::Dark}}};

inline constexpr OptionNames<SplitKind, 3> kSplitNames = {
    {{"none", SplitKind::None}, {"side-by-side", SplitKind::SideBySide}, {"line", SplitKind::Line}}};

inline constexpr OptionNames<bool, 2> kSwitchNames = {{{"on", true}, {"off", false}}};

/// How a scene is shown.
struct ViewOptions {
    ShadingMode shading = ShadingMode::Highlight;
    NormalChoice normals = NormalChoice::Blended;
    SplitKind split = SplitKind::None;
    NormalChoice left = NormalChoice::Limit, right = NormalChoice::Blended;  ///< of a split, and of the difference
    float splitPosition = 0.5F;  ///< share of the width, SplitKind::Line
    std::uint32_t overlays = 0;
    int lineCount = 24;          ///< bands round the full circle, or isophotes from 0 to 180 degrees
    float lineAngle = 0;         ///< degrees; 0: the line lights run from left to right
    float roughness = 0.35F;     ///< of the lit surface, 0 to 1
    std::optional<float> range;  ///< end of the scale: degrees (difference), 1 / model size (curvature)
    std::optional<int> vertex;   ///< whose regions are shown
    Background background = Background::Light;
    bool legend = true;
    std::string caption;

    bool Has(Overlay overlay) const { return (overlays & overlay) != 0; }

    /// Whether some view, or the difference, shows `choice`.
    bool Shows(NormalChoice choice) const {
        bool const needsPair = split != SplitKind::None || shading == ShadingMode::Difference;
        return needsPair ? left == choice || right == choice : normals == choice;
    }

    bool operator==(ViewOptions const&) const = default;
};

}  // namespace osd_shading::viewer
