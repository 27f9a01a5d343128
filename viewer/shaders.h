// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "viewOptions.h"

namespace osd_shading::viewer {

struct ShaderPair {
    std::string vertex, fragment;
};

/// The surface in one shading mode, with normals per vertex or per face.
ShaderPair SurfaceShaders(ShadingMode mode, bool leftIsFace, bool rightIsFace);
/// Lines of some pixels' width between points of a buffer.
ShaderPair LineShaders();
/// Discs on points of a buffer, with a number on them.
ShaderPair MarkShaders();
/// Triangles in one colour.
ShaderPair FlatShaders();

}  // namespace osd_shading::viewer
