// SPDX-License-Identifier: Apache-2.0
//
// Tutorial 4: UVs and other primvars along with the normals.
//
// New here:
//   - face-varying primvars (UVs), with indices of their own, refined by OpenSubdiv's face-varying rules
//   - vertex primvars (colours, weights), refined as positions are
//   - joining the index buffers for normals and UVs, for renderers that know only one

#include <osd_shading/subdivisionShading.h>

#include <cstddef>
#include <cstdio>
#include <map>
#include <utility>
#include <vector>

int main() {
    // A cube, each side a square of its own in a texture of 3 x 2 squares: 24 UVs, a seam along every edge.
    std::vector<double> const points = {-1, -1, -1, 1, -1, -1, 1, 1, -1, -1, 1, -1,
                                        -1, -1, 1,  1, -1, 1,  1, 1, 1,  -1, 1, 1};
    std::vector<int> const faceSizes = {4, 4, 4, 4, 4, 4};
    std::vector<int> const faceVertices = {4, 5, 6, 7, 3, 2, 1, 0, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7};
    std::vector<double> uvs;
    std::vector<int> uvIndices;
    for (int side = 0; side < 6; ++side) {
        double const u = (side % 3) / 3.0, v = (side / 3) / 2.0;
        uvs.insert(uvs.end(), {u, v, u + 1 / 3.0, v, u + 1 / 3.0, v + 0.5, u, v + 0.5});
        for (int corner = 0; corner < 4; ++corner) uvIndices.push_back(4 * side + corner);
    }
    // Colours: red above, blue below.
    std::vector<double> const colours = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0};

    osd_shading::ControlMesh mesh;
    mesh.numVertices = 8;
    mesh.faceSizes = faceSizes;
    mesh.faceVertices = faceVertices;
    // How UVs behave at seams is OpenSubdiv's option: here seams are smoothed, and only corners are held.
    mesh.rules.faceVarying = osd_shading::Sdc::Options::FVAR_LINEAR_CORNERS_ONLY;

    // As many primvars as you like, of any width; a further argument gives the stride.
    osd_shading::ShadingInput<double> input;
    input.positions = {points.data(), 8};
    input.vertexData = {{colours.data(), 8, /*width=*/3}};
    input.faceVaryingData = {{uvIndices, {uvs.data(), uvs.size() / 2, /*width=*/2}}};

    auto const shaded = osd_shading::ShadeSubdivision(mesh, input, osd_shading::PaperPreset(3));
    auto const& colour = shaded.vertexData[0].values;
    auto const& uv = shaded.faceVaryingData[0];
    std::printf("%d vertices, %d normals, %zu uvs\n", shaded.NumVertices(), shaded.NumValues(),
                uv.values.size() / 2);

    // Vertex 6 is a corner of the cube, where three UV squares meet: one normal and one colour, but three UVs.
    // faceVertices, faceValues and faceIndices have an entry each for every corner of a face.
    std::printf("vertex 6: colour %.3f %.3f %.3f\n", colour[18], colour[19], colour[20]);
    for (std::size_t i = 0; i < shaded.faceVertices.size(); ++i) {
        if (shaded.faceVertices[i] != 6) continue;
        auto const& n = shaded.blendedNormals[static_cast<std::size_t>(shaded.faceValues[i])];
        auto const index = static_cast<std::size_t>(uv.faceIndices[i]);
        std::printf("  on side %d: normal %.3f %.3f %.3f, uv %.3f %.3f\n", shaded.baseFaces[i / 4], n.x, n.y, n.z,
                    uv.values[2 * index], uv.values[2 * index + 1]);
    }

    // One index buffer: a vertex for every pair of a normal and a UV that some corner has.
    std::map<std::pair<int, int>, int> renderVertices;
    std::vector<int> renderIndices;
    for (std::size_t i = 0; i < shaded.faceValues.size(); ++i) {
        std::pair<int, int> const key(shaded.faceValues[i], uv.faceIndices[i]);
        renderIndices.push_back(renderVertices.emplace(key, static_cast<int>(renderVertices.size())).first->second);
    }
    std::printf("joined: %zu vertices, %zu indices\n", renderVertices.size(), renderIndices.size());
}
