// SPDX-License-Identifier: Apache-2.0
#include "deformation.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace osd_shading::tool {

namespace {

constexpr double kPi = 3.14159265358979323846;

}  // namespace

DeformationFrame FrameOf(PointView<float> rest) {
    double low[3], high[3], length[3];
    std::fill_n(low, 3, std::numeric_limits<double>::infinity());
    std::fill_n(high, 3, -std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < rest.size(); ++i) {
        Vec3<float> const p = rest[i];
        float const at[3] = {p.x, p.y, p.z};
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], double{at[axis]});
            high[axis] = std::max(high[axis], double{at[axis]});
        }
    }
    DeformationFrame frame;
    if (rest.empty()) return frame;
    frame.middle = {(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, (low[2] + high[2]) / 2};
    for (int axis = 0; axis < 3; ++axis) length[axis] = high[axis] - low[axis];
    frame.longAxis = static_cast<int>(std::max_element(length, length + 3) - length);
    frame.sideAxis = (frame.longAxis + 1) % 3;
    if (length[(frame.longAxis + 2) % 3] < length[frame.sideAxis]) frame.sideAxis = (frame.longAxis + 2) % 3;
    if (length[frame.longAxis] > 0) frame.length = length[frame.longAxis];
    return frame;
}

Vec3<float> Deformed(DeformationKind kind, DeformationFrame const& frame, Vec3<float> const& rest, double time) {
    double at[3] = {rest.x - frame.middle.x, rest.y - frame.middle.y, rest.z - frame.middle.z};
    int const otherAxis = 3 - frame.longAxis - frame.sideAxis;
    double &along = at[frame.longAxis], &side = at[frame.sideAxis], &other = at[otherAxis];
    double const swing = std::sin(2 * kPi * time);
    switch (kind) {
        case DeformationKind::Bend: {
            // The middle line becomes an arc of this curvature, and keeps its length.
            double const curvature = kPi / 2 * swing / frame.length, angle = curvature * along;
            double const half = std::sin(angle / 2);
            double const arc = std::fabs(angle) < 1e-9 ? along : std::sin(angle) / curvature;
            double const rise = std::fabs(angle) < 1e-9 ? 0 : 2 * half * half / curvature;
            along = arc - side * std::sin(angle);
            side = rise + side * std::cos(angle);
            break;
        }
        case DeformationKind::Twist: {
            double const angle = kPi * swing * along / frame.length;
            double const turned = side * std::cos(angle) - other * std::sin(angle);
            other = side * std::sin(angle) + other * std::cos(angle);
            side = turned;
            break;
        }
        case DeformationKind::Wave:
            side += frame.length / 20 * std::sin(2 * kPi * (2 * along / frame.length - time));
            break;
    }
    return {static_cast<float>(at[0] + frame.middle.x), static_cast<float>(at[1] + frame.middle.y),
            static_cast<float>(at[2] + frame.middle.z)};
}

}  // namespace osd_shading::tool
