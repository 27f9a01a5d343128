// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <cstdio>
#include <string>

namespace osd_shading {
inline namespace v1 {

/// `number` for a message, six digits of it: std::to_string would show -1e-30 as -0.000000.
inline std::string NumberText(double number) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", number);
    return text;
}

}  // namespace v1
}  // namespace osd_shading
