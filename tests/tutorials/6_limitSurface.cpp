// SPDX-License-Identifier: Apache-2.0
//
// Tutorial 6: evaluating anywhere on the limit surface.
//
// New here:
//   - a `LimitSurface`: position, tangents, N_L, N_S, b and N_B at any point of any face
//   - the two sides of a crease
//   - derivatives of the shading normal, for curvature
//   - triangles cut as finely as the surface turns

#include <osd_shading/limitSurface.h>
#include <osd_shading/limitTessellation.h>

#include <cmath>
#include <cstdio>
#include <vector>

static void print(char const* what, osd_shading::Vec3<double> const& v) {
    // Rounded first, and + 0.0: prints no -0.
    auto const rounded = [](double x) { return std::round(x * 1e4) / 1e4 + 0.0; };
    std::printf("  %-4s %.4f %.4f %.4f\n", what, rounded(v.x), rounded(v.y), rounded(v.z));
}

int main() {
    // A cube whose top is bounded by an infinitely sharp crease.
    std::vector<double> const points = {-1, -1, -1, 1, -1, -1, 1, 1, -1, -1, 1, -1,
                                        -1, -1, 1,  1, -1, 1,  1, 1, 1,  -1, 1, 1};
    std::vector<int> const faceSizes = {4, 4, 4, 4, 4, 4};
    std::vector<int> const faceVertices = {4, 5, 6, 7, 3, 2, 1, 0, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7};
    std::vector<int> const creaseVertices = {4, 5, 5, 6, 6, 7, 7, 4};
    std::vector<float> const creaseSharpness = {10, 10, 10, 10};
    osd_shading::ControlMesh mesh;
    mesh.numVertices = 8;
    mesh.faceSizes = faceSizes;
    mesh.faceVertices = faceVertices;
    mesh.creaseVertices = creaseVertices;
    mesh.creaseSharpness = creaseSharpness;
    osd_shading::ShadingInput<double> input;
    input.positions = {points.data(), 8};

    // No level is needed: the surface is exact. (`Options().level` is where weights stop being seeded.) Exact limit
    // normals leave no jump at the irregular vertices of creases.
    osd_shading::ShadingOptions options = osd_shading::SurfacePreset();
    options.limits.normals = osd_shading::LimitNormalKind::Exact;
    osd_shading::LimitSurface<double> const surface(mesh, input, options);

    // Face 1 is the bottom, face 0 the top; u runs from a face's vertex 0 to 1, v from 0 to 3, as in OpenSubdiv's
    // Bfr.
    osd_shading::SurfacePoint<double> const p = surface.Evaluate(1, 0.25, 0.4);
    std::printf("bottom at (0.25, 0.4), b = %.4f\n", p.blendWeight);
    print("P  ", p.position);
    print("N_L", p.limitNormal);
    print("N_B", p.blendedNormal);

    // The middle of the edge between face 0 and face 2: one point, two normals.
    std::printf("on the crease\n");
    print("P  ", surface.Evaluate(0, 0.5, 0).position);
    print("top", surface.Evaluate(0, 0.5, 0).blendedNormal);
    print("side", surface.Evaluate(2, 0.5, 1).blendedNormal);

    // Derivatives of N_B say how the shading curves: here along u and v of a side.
    auto const curved = surface.Evaluate(2, 0.5, 0.5, osd_shading::SurfaceDerivatives::Second);
    std::printf("shading on a side\n");
    print("dN_B/du", curved.normalDu);
    print("dN_B/dv", curved.normalDv);

    // Triangles, no two neighbouring normals more than some 15 degrees apart.
    osd_shading::TessellationOptions tessellation;
    tessellation.kind = osd_shading::TessellationKind::Curvature;
    tessellation.maxAngle = 15;
    auto const triangles = osd_shading::TessellateLimitSurface(surface, tessellation);
    std::printf("%d triangles, %d vertices, %d normals\n", triangles.NumFaces(), triangles.NumVertices(),
                triangles.NumValues());
}
