// SPDX-License-Identifier: Apache-2.0
#include "perfMeshes.h"

#include <cmath>
#include <filesystem>
#include <initializer_list>

#include "osd_shading/io/objReader.h"

namespace perf {

using osd_shading::io::Model;

namespace {

void addFace(Model& model, std::initializer_list<int> vertices) {
    model.faceSizes.push_back(static_cast<int>(vertices.size()));
    model.faceVertices.insert(model.faceVertices.end(), vertices);
}

/// Puts a quad of half the size into the quad `outer`, and four quads round it.
void addInset(Model& model, int const (&outer)[4]) {
    double center[3] = {0, 0, 0};
    for (int const v : outer) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            center[axis] += model.positions[3 * static_cast<std::size_t>(v) + axis] / 4;
        }
    }
    int const first = model.NumVertices();
    for (int const v : outer) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            double const corner = model.positions[3 * static_cast<std::size_t>(v) + axis];
            model.positions.push_back((corner + center[axis]) / 2);
        }
    }
    for (int i = 0; i < 4; ++i) {
        int const next = (i + 1) % 4;
        addFace(model, {outer[i], outer[next], first + next, first + i});
    }
    addFace(model, {first, first + 1, first + 2, first + 3});
}

}  // namespace

Model CreasedTorus(int around, int up, int spacing) {
    Model model;
    model.name = "torus";
    double const turn = 2 * std::acos(-1.0);
    for (int i = 0; i < around; ++i) {
        for (int j = 0; j < up; ++j) {
            double const a = turn * i / around, b = turn * j / up, radius = 3 + std::cos(b);
            model.positions.insert(model.positions.end(),
                                   {radius * std::cos(a), radius * std::sin(a), std::sin(b)});
        }
    }
    auto const vertex = [&](int i, int j) { return (i % around) * up + j % up; };
    for (int i = 0; i < around; ++i) {
        for (int j = 0; j < up; ++j) {
            int const quad[4] = {vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)};
            if (i % spacing == spacing / 2 && j % spacing == spacing / 2) {
                addInset(model, quad);
            } else {
                addFace(model, {quad[0], quad[1], quad[2], quad[3]});
            }
        }
    }
    for (int i = 1, ring = 0; i < around; i += 8, ++ring) {
        int const length = ring % 2 == 0 ? up : up / 2;
        for (int j = 0; j < length; ++j) {
            model.creaseVertices.insert(model.creaseVertices.end(), {vertex(i, j), vertex(i, j + 1)});
            model.creaseSharpness.push_back(1.5f + static_cast<float>(ring % 3));
        }
    }
    return model;
}

Model Triangulated(Model const& model) {
    Model triangles = model;
    triangles.faceSizes.clear();
    triangles.faceVertices.clear();
    std::size_t first = 0;
    for (int const size : model.faceSizes) {
        for (std::size_t i = 1; i + 1 < static_cast<std::size_t>(size); ++i) {
            addFace(triangles,
                    {model.faceVertices[first], model.faceVertices[first + i], model.faceVertices[first + i + 1]});
        }
        first += static_cast<std::size_t>(size);
    }
    return triangles;
}

Model ReadSpot(std::string const& extraModels) {
    std::filesystem::path const spot = std::filesystem::path(extraModels) / "zbk" / "spot.obj";
    std::error_code ignored;
    if (std::filesystem::exists(spot, ignored)) return osd_shading::io::ReadObj(spot.string());
    return osd_shading::io::ReadObj(std::string(OSD_SHADING_MODELS) + "/mug.obj");
}

}  // namespace perf
