// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/io/model.h"

#include <algorithm>

namespace osd_shading {
inline namespace v1 {
namespace io {

SubdivisionRules Model::Rules(SubdivisionRules rules) const {
    rules.boundary = boundary.value_or(rules.boundary);
    rules.faceVarying = faceVarying.value_or(rules.faceVarying);
    rules.creasing = creasing.value_or(rules.creasing);
    rules.triangles = triangles.value_or(rules.triangles);
    return rules;
}

ControlMesh Model::Mesh(SubdivisionRules const& rules) const {
    ControlMesh mesh;
    mesh.numVertices = NumVertices();
    mesh.faceSizes = faceSizes;
    mesh.faceVertices = faceVertices;
    mesh.creaseVertices = creaseVertices;
    mesh.creaseSharpness = creaseSharpness;
    mesh.cornerVertices = cornerVertices;
    mesh.cornerSharpness = cornerSharpness;
    mesh.holes = holes;
    mesh.rules = rules;
    return mesh;
}

void Model::CompleteUvs() {
    if (std::find(uvIndices.begin(), uvIndices.end(), -1) == uvIndices.end()) return;
    int const added = static_cast<int>(uvs.size() / 2);
    uvs.insert(uvs.end(), {0.0, 0.0});
    std::replace(uvIndices.begin(), uvIndices.end(), -1, added);
}

}  // namespace io
}  // namespace v1
}  // namespace osd_shading
