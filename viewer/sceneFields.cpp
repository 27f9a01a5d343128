// SPDX-License-Identifier: Apache-2.0
#include "sceneFields.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <tuple>

namespace osd_shading::viewer {

namespace {

constexpr double kDegreesPerRadian = 57.295779513082320877;

}  // namespace

std::vector<glm::vec4> FaceNormals(Scene const& scene) {
    SurfaceTopology const& topology = *scene.topology;
    auto const size = static_cast<std::size_t>(topology.faceSize);
    std::vector<glm::vec4> normals;
    normals.reserve(topology.NumFaces());
    for (std::size_t first = 0; first < topology.faceValues.size(); first += size) {
        auto const point = [&](std::size_t i) { return scene.Position(topology.faceValues[first + i]); };
        // The cross product of the diagonals is twice the vector area of a quad.
        glm::vec3 const area = size == 4 ? glm::cross(point(2) - point(0), point(3) - point(1))
                                         : glm::cross(point(1) - point(0), point(2) - point(0));
        float const length = glm::length(area);
        normals.emplace_back(length > 0 ? area / length : area, 0.0F);
    }
    return normals;
}

std::vector<float> NormalFieldCurvature(Scene const& scene, NormalChoice choice) {
    std::vector<float> curvature(scene.vertices.size(), 0), areas(scene.vertices.size(), 0);
    std::vector<std::uint32_t> const& triangles = scene.topology->triangles;
    if (choice == NormalChoice::Face) return curvature;
    for (std::size_t i = 0; i < triangles.size(); i += 3) {
        SurfaceVertex const& a = scene.vertices[triangles[i]];
        SurfaceVertex const& b = scene.vertices[triangles[i + 1]];
        SurfaceVertex const& c = scene.vertices[triangles[i + 2]];
        glm::vec3 const u = b.position - a.position, v = c.position - a.position, area = glm::cross(u, v);
        float const squared = glm::dot(area, area);
        if (!(squared > 0)) continue;
        // Divergence of the linear field: dual vectors of u and v in the triangle's plane.
        glm::vec3 const du = glm::cross(v, area) / squared, dv = glm::cross(area, u) / squared;
        glm::vec3 const normal = NormalOf(a, choice);
        float const divergence =
            glm::dot(NormalOf(b, choice) - normal, du) + glm::dot(NormalOf(c, choice) - normal, dv);
        float const weight = std::sqrt(squared);
        for (std::size_t k = 0; k < 3; ++k) {
            curvature[triangles[i + k]] += weight * divergence / 2;
            areas[triangles[i + k]] += weight;
        }
    }
    for (std::size_t i = 0; i < curvature.size(); ++i) {
        curvature[i] = areas[i] > 0 ? curvature[i] / areas[i] * scene.bounds.radius : 0;
    }
    return curvature;
}

AngleStatistics CompareNormals(Scene const& scene, NormalChoice left, NormalChoice right) {
    AngleStatistics statistics;
    SurfaceTopology const& topology = *scene.topology;
    double count = 0;
    auto const add = [&](glm::vec3 const& a, glm::vec3 const& b, int value) {
        if (glm::dot(a, a) == 0 || glm::dot(b, b) == 0) return;
        double const angle =
            std::atan2(static_cast<double>(glm::length(glm::cross(a, b))), static_cast<double>(glm::dot(a, b))) *
            kDegreesPerRadian;
        count += 1;
        statistics.mean += (angle - statistics.mean) / count;
        if (angle > statistics.max || statistics.maxValue < 0) {
            statistics.max = angle;
            statistics.maxValue = value;
        }
    };

    bool const hasFaces = left == NormalChoice::Face || right == NormalChoice::Face;
    if (!hasFaces) {
        for (std::size_t i = 0; i < scene.vertices.size(); ++i) {
            add(NormalOf(scene.vertices[i], left), NormalOf(scene.vertices[i], right), static_cast<int>(i));
        }
        return statistics;
    }
    // A face's normal is compared at each of its corners.
    std::vector<glm::vec4> const ofFaces = FaceNormals(scene);
    for (std::size_t corner = 0; corner < topology.faceValues.size(); ++corner) {
        int const value = topology.faceValues[corner];
        glm::vec3 const face(ofFaces[corner / static_cast<std::size_t>(topology.faceSize)]);
        SurfaceVertex const& vertex = scene.vertices[static_cast<std::size_t>(value)];
        add(left == NormalChoice::Face ? face : NormalOf(vertex, left),
            right == NormalChoice::Face ? face : NormalOf(vertex, right), value);
    }
    return statistics;
}

RegionShape RegionsOf(Scene const& scene, int vertex) {
    SurfaceTopology const& topology = *scene.topology;
    auto const size = static_cast<std::size_t>(topology.faceSize);
    int const firstValue = topology.FirstValue(vertex), endValue = topology.FirstValue(vertex + 1);

    RegionShape regions;
    for (int value = firstValue; value < endValue; ++value) regions.values.push_back(value);
    regions.triangles.resize(regions.values.size());

    // Find the faces at the vertex, and the region of each.
    std::vector<std::pair<int, std::size_t>> baseRegions;  // control face, region
    auto const addFace = [&](std::size_t face, std::size_t region) {
        std::size_t const perFace = (size - 2) * 3;
        auto const first = topology.triangles.begin() + static_cast<std::ptrdiff_t>(face * perFace);
        regions.triangles[region].insert(regions.triangles[region].end(), first,
                                         first + static_cast<std::ptrdiff_t>(perFace));
    };
    bool const isControlVertex = vertex < topology.numControlVertices;
    for (std::size_t corner = 0; corner < topology.faceValues.size(); ++corner) {
        int const value = topology.faceValues[corner];
        if (value < firstValue || value >= endValue) continue;
        auto const region = static_cast<std::size_t>(value - firstValue);
        if (isControlVertex) {
            baseRegions.emplace_back(topology.baseFaces[corner / size], region);
        } else {
            addFace(corner / size, region);
        }
    }
    for (std::size_t face = 0; !baseRegions.empty() && face < topology.NumFaces(); ++face) {
        for (auto const& [baseFace, region] : baseRegions) {
            if (baseFace == topology.baseFaces[face]) addFace(face, region);
        }
    }
    return regions;
}

int InterestingVertex(Scene const& scene) {
    SurfaceTopology const& topology = *scene.topology;
    int best = -1;
    std::tuple<int, bool, bool> bestRank;
    for (int vertex = 0; vertex < topology.NumVertices(); ++vertex) {
        if (topology.IsIsolated(vertex)) continue;
        VertexTag const& tag = topology.vertexTags[static_cast<std::size_t>(vertex)];
        std::tuple<int, bool, bool> const rank(topology.FirstValue(vertex + 1) - topology.FirstValue(vertex),
                                               tag.isExtraordinary, vertex < topology.numControlVertices);
        if (best < 0 || rank > bestRank) {
            best = vertex;
            bestRank = rank;
        }
    }
    return best;
}

}  // namespace osd_shading::viewer
