// SPDX-License-Identifier: Apache-2.0
//
// Tutorial 1: shade a mesh.
//
// New here:
//   - a control mesh is a struct of views over your own arrays
//   - one call refines it, and gives positions and blended normals on the limit surface
//   - the result is what a renderer draws: one normal for each value, one value for each corner of a face
//   - what can't be used is refused in words

#include <osd_shading/subdivisionShading.h>

#include <cstddef>
#include <cstdio>
#include <vector>

int main() {
    // A cube: vertices, then quads, counter-clockwise seen from outside.
    std::vector<double> const points = {-1, -1, -1, 1, -1, -1, 1, 1, -1, -1, 1, -1,
                                        -1, -1, 1,  1, -1, 1,  1, 1, 1,  -1, 1, 1};
    std::vector<int> const faceSizes = {4, 4, 4, 4, 4, 4};
    std::vector<int> faceVertices = {4, 5, 6, 7, 3, 2, 1, 0, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7};

    // Views: nothing is copied, so the arrays must live until the call returns.
    osd_shading::ControlMesh mesh;
    mesh.numVertices = 8;
    mesh.faceSizes = faceSizes;
    mesh.faceVertices = faceVertices;

    osd_shading::ShadingInput<double> input;
    input.positions = {points.data(), 8};

    // Level 4: every quad of the cube becomes 16 x 16 quads.
    auto const shaded = osd_shading::ShadeSubdivision(mesh, input, osd_shading::PaperPreset(4));
    std::printf("%d vertices, %d faces, %d values\n", shaded.NumVertices(), shaded.NumFaces(), shaded.NumValues());

    // A vertex of the control mesh keeps its number. The cube's corner (1, 1, 1) has three edges, so it is
    // extraordinary: there, N_B is the subdivided normal. Its limit position is (0.5, 0.5, 0.5).
    std::size_t const vertex = 6;
    auto const value = static_cast<std::size_t>(shaded.vertexValues[vertex]);
    auto const& p = shaded.positions[vertex];
    auto const& n = shaded.blendedNormals[value];
    std::printf("vertex %zu: position %.4f %.4f %.4f, normal %.4f %.4f %.4f, blend weight %.4f\n", vertex, p.x, p.y,
                p.z, n.x, n.y, n.z, shaded.blendWeights[value]);

    // Its counts and figures say how much the blend has changed.
    std::printf("valence 3: %d vertices; from limit to blended normal: %.2f degrees at most\n",
                static_cast<int>(shaded.report.extraordinary.at(3)), shaded.report.maxAngle);

    // Corner k of a face has the position of faceVertices[k] and the normal of faceValues[k].
    auto const corner = static_cast<std::size_t>(shaded.faceValues[0]);
    std::printf("face 0 of the result lies on face %d of the cube; its first corner is value %zu of vertex %d\n",
                shaded.baseFaces[0], corner, shaded.valueVertices[corner]);

    // Every error is an osd_shading::Error, thrown before any work.
    faceVertices[3] = 8;
    try {
        osd_shading::ShadeSubdivision(mesh, input);
    } catch (osd_shading::Error const& error) {
        std::printf("refused: %s\n", error.what());
    }
}
