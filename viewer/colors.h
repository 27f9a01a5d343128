// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <glm/glm.hpp>

#include "viewOptions.h"

namespace osd_shading::viewer {

// Colours that pictures and their legends share.

/// A scale of colours with five stops at equal distances.
using ColorScale = std::array<glm::vec3, 5>;

/// Angles: from dark to bright, as the eye orders it.
inline constexpr ColorScale kAngleScale = {{{0.267F, 0.005F, 0.329F},
                                            {0.231F, 0.322F, 0.545F},
                                            {0.129F, 0.569F, 0.549F},
                                            {0.369F, 0.788F, 0.384F},
                                            {0.992F, 0.906F, 0.145F}}};

/// Curvature: hollow, flat, bulging.
inline constexpr ColorScale kCurvatureScale = {{{0.13F, 0.25F, 0.66F},
                                                {0.50F, 0.66F, 0.90F},
                                                {0.95F, 0.95F, 0.93F},
                                                {0.94F, 0.60F, 0.46F},
                                                {0.70F, 0.08F, 0.13F}}};

/// Blend weights: blue 0, red 1, straight between them.  [ZBK23]
inline constexpr ColorScale kWeightScale = {
    {{0, 0, 1}, {0.25F, 0, 0.75F}, {0.5F, 0, 0.5F}, {0.75F, 0, 0.25F}, {1, 0, 0}}};

/// Sharpness of creases, 0 to 10.
inline constexpr ColorScale kSharpnessScale = {{{1.00F, 0.85F, 0.20F},
                                                {1.00F, 0.55F, 0.05F},
                                                {0.93F, 0.22F, 0.10F},
                                                {0.75F, 0.02F, 0.40F},
                                                {0.35F, 0.00F, 0.50F}}};
inline constexpr glm::vec3 kBoundaryColor(0.05F, 0.35F, 0.10F);

inline constexpr glm::vec3 kLimitNormalColor(0.10F, 0.35F, 0.95F), kSubdividedNormalColor(0.05F, 0.60F, 0.20F),
    kBlendedNormalColor(0.90F, 0.10F, 0.10F);
inline constexpr glm::vec3 kEvColor(0.95F, 0.45F, 0.05F), kRegularSharpColor(0.35F, 0.35F, 0.40F),
    kDartColor(0.00F, 0.55F, 0.60F), kCornerColor(0.55F, 0.15F, 0.65F), kSelectionColor(1.00F, 0.10F, 0.75F);

/// Regions of a vertex, one after the other.
inline constexpr std::array<glm::vec3, 6> kRegionColors = {{{0.98F, 0.75F, 0.20F},
                                                            {0.35F, 0.70F, 0.90F},
                                                            {0.60F, 0.80F, 0.40F},
                                                            {0.90F, 0.50F, 0.60F},
                                                            {0.70F, 0.60F, 0.90F},
                                                            {0.75F, 0.70F, 0.60F}}};

/// The colour at `share`, 0 to 1.
inline glm::vec3 ColorAt(ColorScale const& scale, float share) {
    float const x = glm::clamp(share, 0.0F, 1.0F) * 4;
    auto const i = static_cast<std::size_t>(glm::min(x, 3.0F));
    return glm::mix(scale[i], scale[i + 1], x - static_cast<float>(i));
}

inline glm::vec3 BackgroundColor(Background background) {
    return background == Background::Light ? glm::vec3(1) : glm::vec3(0.11F, 0.12F, 0.14F);
}
inline glm::vec3 TextColor(Background background) {
    return background == Background::Light ? glm::vec3(0.08F) : glm::vec3(0.92F);
}

}  // namespace osd_shading::viewer
