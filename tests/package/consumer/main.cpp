// SPDX-License-Identifier: Apache-2.0
//
// A user of the library: shades a cube, and catches an error that the library throws.
#include <osd_shading/geometryCheck.h>
#include <osd_shading/subdivisionShading.h>

#ifdef WITH_FILES
#    include <osd_shading/io/objReader.h>
#endif

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
