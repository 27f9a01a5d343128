// SPDX-License-Identifier: Apache-2.0
#include "deformation.h"

#include <algorithm>
#include <cmath>

namespace osd_shading::viewer {

namespace {

constexpr float kTwoPi = 6.28318530718F;
constexpr float kBendAngle = kTwoPi / 6, kTwistAngle = kTwoPi / 3, kWaveHeight = 0.15F;

}  // namespace

void Deform(Deformation const& deformation, std::vector<glm::vec3>& points) {
    if (deformation.kind == DeformationKind::None || points.empty()) return;

    float half = 0;  // of the model's height
    for (glm::vec3 const& p : points) half = std::max(half, std::abs(p.y));
    if (!(half > 0)) return;

    float const swing = std::sin(kTwoPi * deformation.phase) * deformation.amount;
    for (glm::vec3& p : points) {
        float const height = p.y / half;  // -1 to 1
        switch (deformation.kind) {
            case DeformationKind::None:
                break;
            case DeformationKind::Bend: {
                float const angle = swing * kBendAngle;
                if (std::abs(angle) < 1e-4F) break;
                float const radius = half / angle;
                p = {radius - (radius - p.x) * std::cos(angle * height), (radius - p.x) * std::sin(angle * height),
                     p.z};
                break;
            }
            case DeformationKind::Twist: {
                float const angle = swing * kTwistAngle * height / 2;
                p = {p.x * std::cos(angle) + p.z * std::sin(angle), p.y,
                     p.z * std::cos(angle) - p.x * std::sin(angle)};
                break;
            }
            case DeformationKind::Wave:
                p.z +=
                    half * kWaveHeight * deformation.amount * std::sin(kTwoPi * (height / 2 - deformation.phase));
                break;
        }
    }
}

}  // namespace osd_shading::viewer
