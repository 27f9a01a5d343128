// SPDX-License-Identifier: Apache-2.0
//
// Tutorial 3: a mesh that moves: tables, built once, and an evaluator for every frame.
//
// New here:
//   - a ShadingTable holds all that does not depend on positions; a ShadingEvaluator turns control points into
//     positions and normals, in a vertex buffer of your own, without allocating
//   - the table's own order of values, with its index buffer; faces of one control face lie together
//   - UVs and other primvars along, in that order

#include <osd_shading/primvarTable.h>
#include <osd_shading/shadingEvaluator.h>

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <map>
#include <utility>
#include <vector>

// A square tower of four storeys, 20 vertices: 16 walls, a floor and a roof.
struct Tower {
    std::vector<float> points;
    std::vector<int> faceSizes, faceVertices, creaseVertices, uvIndices;
    std::vector<float> creaseSharpness, uvs, heat;
};

static Tower makeTower() {
    Tower tower;
    for (int storey = 0; storey <= 4; ++storey) {
        for (int corner = 0; corner < 4; ++corner) {
            float const x = corner == 0 || corner == 3 ? -1.0F : 1.0F, y = corner < 2 ? -1.0F : 1.0F;
            tower.points.insert(tower.points.end(), {x, y, 2.0F * static_cast<float>(storey)});
            tower.heat.push_back(static_cast<float>(storey));
        }
        // Five UVs for each ring: the walls go once round the texture, and the seam has both its ends.
        for (int i = 0; i <= 4; ++i) {
            tower.uvs.insert(tower.uvs.end(), {static_cast<float>(i) / 4, static_cast<float>(storey) / 4});
        }
    }
    for (int storey = 0; storey < 4; ++storey) {
        for (int i = 0; i < 4; ++i) {
            int const a = 4 * storey + i, b = 4 * storey + (i + 1) % 4, u = 5 * storey + i;
            tower.faceVertices.insert(tower.faceVertices.end(), {a, b, b + 4, a + 4});
            tower.uvIndices.insert(tower.uvIndices.end(), {u, u + 1, u + 6, u + 5});
        }
    }
    tower.faceVertices.insert(tower.faceVertices.end(), {3, 2, 1, 0, 16, 17, 18, 19});
    tower.uvIndices.insert(tower.uvIndices.end(), {3, 2, 1, 0, 20, 21, 22, 23});
    tower.faceSizes.assign(18, 4);
    tower.creaseVertices = {16, 17, 17, 18, 18, 19, 19, 16};  // the roof's edge: two normals on it
    tower.creaseSharpness = {10, 10, 10, 10};
    return tower;
}

// The tower bent to an arc: `angle` from its foot to its top.
static std::vector<float> bend(std::vector<float> const& points, float angle) {
    std::vector<float> bent = points;
    for (std::size_t i = 0; i < bent.size(); i += 3) {
        float const x = points[i], z = points[i + 2], a = angle * z / 8;
        if (angle == 0) continue;
        bent[i] = 8 / angle - (8 / angle - x) * std::cos(a);
        bent[i + 2] = (8 / angle - x) * std::sin(a);
    }
    return bent;
}

// To two digits, and without a minus before zero.
static double rounded(float x) { return std::round(100 * double{x}) / 100 + 0.0; }

int main() {
    Tower const tower = makeTower();
    osd_shading::ControlMesh mesh;
    mesh.numVertices = 20;
    mesh.faceSizes = tower.faceSizes;
    mesh.faceVertices = tower.faceVertices;
    mesh.creaseVertices = tower.creaseVertices;
    mesh.creaseSharpness = tower.creaseSharpness;
    osd_shading::ShadingOptions const options = osd_shading::PaperPreset(3);

    // Once for a topology. A table is immutable: any number of evaluators may share it, one for each thread of
    // yours.
    osd_shading::ShadingTable const table(mesh, options);
    auto const numValues = static_cast<std::size_t>(table.NumValues());
    std::vector<int> const faceValues = table.FaceValues(), triangles = table.TriangleValues();
    std::printf("%d faces, %d values, %zu triangle corners\n", table.NumFaces(), table.NumValues(),
                triangles.size());

    // Vertex data, one row for each value: they go with positions and normals as they are.
    auto const primvars = osd_shading::BuildPrimvarTable<float>(mesh, {{tower.uvIndices, 25}}, options);
    std::vector<int> const vertices = table.RefinedVertices();
    auto const heatRows = primvars.vertexData.Reordered(vertices);
    std::vector<float> heat(numValues);
    heatRows.Evaluate({tower.heat.data(), 20, /*width=*/1}, {heat.data(), numValues});

    // UVs: find the table's faces among those of the primvars, then give each pair of value and UV a vertex. The
    // first UV of a value keeps its number; those of the seam follow at the end, as copies.
    std::vector<int> faceVertices;
    for (int const value : faceValues) faceVertices.push_back(vertices[static_cast<std::size_t>(value)]);
    std::vector<int> const corners =
        osd_shading::MatchFaceCorners(primvars.faceVertices, faceVertices, table.FaceSize());
    std::vector<int> uvRows(numValues, -1), copiedValues, indices;
    std::map<std::pair<int, int>, int> copies;
    for (std::size_t i = 0; i < faceValues.size(); ++i) {
        auto const value = static_cast<std::size_t>(faceValues[i]);
        int const uv = primvars.faceVarying[0].faceIndices[static_cast<std::size_t>(corners[i])];
        if (uvRows[value] < 0) uvRows[value] = uv;
        if (uvRows[value] == uv) {
            indices.push_back(faceValues[i]);
            continue;
        }
        auto const [copy, isNew] = copies.emplace(std::pair(faceValues[i], uv), static_cast<int>(uvRows.size()));
        if (isNew) {
            uvRows.push_back(uv);
            copiedValues.push_back(faceValues[i]);
        }
        indices.push_back(copy->second);
    }
    std::vector<float> uvs(2 * uvRows.size());
    primvars.faceVarying[0].values.Reordered(uvRows).Evaluate({tower.uvs.data(), 25, /*width=*/2},
                                                              {uvs.data(), uvRows.size()});
    std::printf("%zu render vertices, %zu of them copies at the seam\n", uvRows.size(), copiedValues.size());

    // For every frame: positions and normals into one buffer, x y z nx ny nz of each vertex.
    osd_shading::ShadingEvaluator evaluator(table);
    std::vector<float> buffer(6 * uvRows.size());
    osd_shading::ShadingOutputs outputs;
    outputs.positions = {buffer.data(), numValues, /*stride=*/6};
    outputs.blendedNormals = {buffer.data() + 3, numValues, 6};
    for (int frame = 0; frame < 4; ++frame) {
        std::vector<float> const points = bend(tower.points, 0.5F * static_cast<float>(frame));
        evaluator.Evaluate({points.data(), 20}, outputs);
        for (std::size_t i = 0; i < copiedValues.size(); ++i) {
            std::size_t const from = 6 * static_cast<std::size_t>(copiedValues[i]), to = 6 * (numValues + i);
            for (std::size_t k = 0; k < 6; ++k) buffer[to + k] = buffer[from + k];
        }

        // Refined vertex 17 is a corner of the roof: one value on the roof, one on the walls.
        std::printf("frame %d:", frame);
        for (std::size_t value = 0; value < numValues; ++value) {
            if (vertices[value] != 17) continue;
            float const* const v = &buffer[6 * value];
            std::printf("  (%.2f %.2f %.2f) normal (%.2f %.2f %.2f)", rounded(v[0]), rounded(v[1]), rounded(v[2]),
                        rounded(v[3]), rounded(v[4]), rounded(v[5]));
        }
        std::printf("\n");
    }
    std::printf("there: heat");
    for (std::size_t value = 0; value < numValues; ++value) {
        if (vertices[value] == 17) std::printf(" %.2f", double{heat[value]});
    }
    std::printf(", uv");
    for (std::size_t i = 0; i < uvRows.size(); ++i) {
        auto const value = i < numValues ? i : static_cast<std::size_t>(copiedValues[i - numValues]);
        if (vertices[value] == 17) std::printf(" (%.2f %.2f)", double{uvs[2 * i]}, double{uvs[2 * i + 1]});
    }
    std::printf("\n");
}
