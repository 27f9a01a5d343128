// SPDX-License-Identifier: Apache-2.0
//
// Tutorial 5: creases: fractional, released, Chaikin.
//
// New here:
//   - sharpness 10 and more is infinite: a normal on each side, for good
//   - a smaller sharpness holds for that many levels, then the crease is released: the sides and their normals
//     grow together; fractions lie between
//   - Chaikin's rule, which averages a sharpness that varies along a crease
//   - what is left of each crease, for display

#include <osd_shading/subdivisionShading.h>

#include <cstdio>
#include <vector>

// Shades a cube whose top is creased all round, and prints a line about it.
static void shadeCube(char const* title, std::vector<float> const& sharpness,
                      osd_shading::Sdc::Options::CreasingMethod creasing) {
    std::vector<double> const points = {-1, -1, -1, 1, -1, -1, 1, 1, -1, -1, 1, -1,
                                        -1, -1, 1,  1, -1, 1,  1, 1, 1,  -1, 1, 1};
    std::vector<int> const faceSizes = {4, 4, 4, 4, 4, 4};
    std::vector<int> const faceVertices = {4, 5, 6, 7, 3, 2, 1, 0, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7};
    std::vector<int> const creaseVertices = {4, 5, 5, 6, 6, 7, 7, 4};  // two for each crease

    osd_shading::ControlMesh mesh;
    mesh.numVertices = 8;
    mesh.faceSizes = faceSizes;
    mesh.faceVertices = faceVertices;
    mesh.creaseVertices = creaseVertices;
    mesh.creaseSharpness = sharpness;  // one for each crease
    mesh.rules.creasing = creasing;
    osd_shading::ShadingInput<double> input;
    input.positions = {points.data(), 8};

    // A level of at least the largest finite sharpness: a crease that isn't released by then counts as infinite.
    auto const shaded = osd_shading::ShadeSubdivision(mesh, input, osd_shading::PaperPreset(4));

    // Edges of level 4 that lie on the four creases, and how many of them are still sharp.
    int sharpEdges = 0;
    for (osd_shading::CreaseEdge const& edge : shaded.creaseEdges) sharpEdges += edge.sharpness > 0;

    // A vertex with a normal for each side has two values.
    int const numValues = shaded.vertexValues[5] - shaded.vertexValues[4];
    std::printf("%-20s %2d of %zu edges sharp, %2d values more than vertices; vertex 4: height %.4f, %d normal%s\n",
                title, sharpEdges, shaded.creaseEdges.size(), shaded.NumValues() - shaded.NumVertices(),
                shaded.positions[4].z, numValues, numValues == 1 ? "" : "s");
}

int main() {
    auto const uniform = osd_shading::Sdc::Options::CREASE_UNIFORM;
    auto const chaikin = osd_shading::Sdc::Options::CREASE_CHAIKIN;

    // From no crease to an infinite one: the corner rises with every step.
    shadeCube("smooth", {0, 0, 0, 0}, uniform);
    shadeCube("fractional, 0.5", {0.5F, 0.5F, 0.5F, 0.5F}, uniform);
    shadeCube("released at level 1", {1, 1, 1, 1}, uniform);
    shadeCube("fractional, 1.5", {1.5F, 1.5F, 1.5F, 1.5F}, uniform);
    shadeCube("released at level 2", {2, 2, 2, 2}, uniform);
    shadeCube("infinite", {10, 10, 10, 10}, uniform);

    // Two sides of sharpness 2, two of 4: each edge counts down on its own, or they are averaged along the crease.
    shadeCube("varying, uniform", {2, 4, 2, 4}, uniform);
    shadeCube("varying, Chaikin", {2, 4, 2, 4}, chaikin);
}
