// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <cmath>
#include <cstddef>
#include <string>

#include "osd_shading/errors.h"
#include "osd_shading/shadingInput.h"

namespace osd_shading {
inline namespace v1 {

/// Throws InvalidControlMesh unless `view` holds `count` finite points.
template <typename Real>
void CheckPoints(PointView<Real> const& view, std::size_t count, char const* name, char const* element) {
    auto const fail = [](std::string const& text) { throw InvalidControlMesh(text); };
    std::string const what = name;
    if (view.size() != count) {
        fail(what + " has " + std::to_string(view.size()) + " elements; the mesh needs " + std::to_string(count) +
             ", one per " + element);
    }
    if (view.size() > 0 && view.data() == nullptr) fail(what + ": its pointer is null");
    if (view.stride() < 3) fail(what + ": its stride is " + std::to_string(view.stride()) + "; give 3 or more");
    for (std::size_t i = 0; i < count; ++i) {
        Vec3<Real> const p = view[i];
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
            fail(what + ": " + element + " " + std::to_string(i) + " is not finite");
        }
    }
}

/// The same for the normals of StartNormalKind::User: one kind of them must be there.
template <typename Real>
void CheckUserNormals(ShadingInput<Real> const& input, std::size_t numVertices, std::size_t numFaceCorners) {
    bool const perVertex = !input.vertexNormals.empty(), perCorner = !input.faceVaryingNormals.empty();
    if (perVertex == perCorner) {
        throw InvalidControlMesh(
            perVertex ? "both vertexNormals and faceVaryingNormals are given; give one"
                      : "user start normals need vertexNormals or faceVaryingNormals; both are empty");
    }
    if (perVertex) CheckPoints(input.vertexNormals, numVertices, "vertexNormals", "vertex");
    if (perCorner) CheckPoints(input.faceVaryingNormals, numFaceCorners, "faceVaryingNormals", "face corner");
}

}  // namespace v1
}  // namespace osd_shading
