// SPDX-License-Identifier: Apache-2.0
//
// A user of the library: shades a cube, and catches an error that the library throws.
#include <osd_shading/geometryCheck.h>
#include <osd_shading/primvarTable.h>
#include <osd_shading/shadingEvaluator.h>
#include <osd_shading/subdivisionShading.h>

#ifdef WITH_FILES
#    include <osd_shading/io/objReader.h>
#endif

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <vector>

int main() {
    std::vector<double> const points = {-1, -1, -1, 1, -1, -1, 1, 1, -1, -1, 1, -1,
                                        -1, -1, 1,  1, -1, 1,  1, 1, 1,  -1, 1, 1};
    std::vector<int> const faceSizes = {4, 4, 4, 4, 4, 4};
    std::vector<int> const faceVertices = {4, 5, 6, 7, 3, 2, 1, 0, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7};
    osd_shading::ControlMesh mesh;
    mesh.numVertices = 8;
    mesh.faceSizes = faceSizes;
    mesh.faceVertices = faceVertices;
    osd_shading::ShadingInput<double> input;
    input.positions = {points.data(), 8};
    auto const shaded = osd_shading::ShadeSubdivision(mesh, input);
    auto const check = osd_shading::CheckGeometry(mesh, input.positions, shaded);
    std::printf("C++%ld, %d faces, %s\n", __cplusplus / 100 % 100, shaded.NumFaces(),
                check.Passes(1e-12) ? "as OpenSubdiv" : "unlike OpenSubdiv");

    // The same as a frame of a moving mesh, on two threads.
    osd_shading::ShadingTable const table(mesh);
    osd_shading::EvaluatorOptions options;
    options.numThreads = 2;
    osd_shading::ShadingEvaluator evaluator(table, options);
    std::vector<float> const floats(points.begin(), points.end());
    std::vector<float> normals(3 * static_cast<std::size_t>(table.NumValues()));
    osd_shading::ShadingOutputs outputs;
    outputs.blendedNormals = {normals.data(), normals.size() / 3, 3};
    evaluator.Evaluate({floats.data(), 8}, outputs);
    std::vector<int> const values = table.ResultValues();
    double largest = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        auto const& n = shaded.blendedNormals[static_cast<std::size_t>(values[i])];
        largest = std::fmax(largest, std::fabs(n.x - double{normals[3 * i]}));
        largest = std::fmax(largest, std::fabs(n.y - double{normals[3 * i + 1]}));
        largest = std::fmax(largest, std::fabs(n.z - double{normals[3 * i + 2]}));
    }
    auto const primvars = osd_shading::BuildPrimvarTable<float>(mesh, {});
    std::puts(largest < 1e-5 &&
                      primvars.vertexData.Reordered(table.RefinedVertices()).NumRows() == table.NumValues()
                  ? "frame"
                  : "another frame");

    mesh.rules.scheme = osd_shading::Sdc::SCHEME_LOOP;
    try {
        osd_shading::ShadeSubdivision(mesh, input);
    } catch (osd_shading::InvalidControlMesh const&) {
        std::puts("refused");
    }
#ifdef WITH_FILES
    auto const model = osd_shading::io::ParseObj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "triangle.obj");
    std::printf("%s of %d face\n", model.name.c_str(), model.NumFaces());
#endif
}
