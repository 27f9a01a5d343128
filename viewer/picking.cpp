// SPDX-License-Identifier: Apache-2.0
#include "picking.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace osd_shading::viewer {

namespace {

// What lies this much deeper than the surface at the cursor is still on it: the cursor is some pixels away.
constexpr float kDepthTolerance = 0.06F;  // of the scene's radius

struct Hit {
    float distance = std::numeric_limits<float>::infinity();
    std::size_t triangle = 0;
};

// The first triangle along a ray.   Moeller, Trumbore: Fast, Minimum Storage Ray/Triangle Intersection. 1997
std::optional<Hit> Cast(Scene const& scene, glm::vec3 const& origin, glm::vec3 const& direction) {
    Hit best;
    std::vector<std::uint32_t> const& triangles = scene.topology->triangles;
    for (std::size_t i = 0; i < triangles.size(); i += 3) {
        glm::vec3 const a = scene.vertices[triangles[i]].position;
        glm::vec3 const u = scene.vertices[triangles[i + 1]].position - a;
        glm::vec3 const v = scene.vertices[triangles[i + 2]].position - a;
        glm::vec3 const p = glm::cross(direction, v);
        float const determinant = glm::dot(u, p);
        if (determinant == 0) continue;
        glm::vec3 const t = origin - a;
        float const x = glm::dot(t, p) / determinant;
        if (x < 0 || x > 1) continue;
        glm::vec3 const q = glm::cross(t, u);
        float const y = glm::dot(direction, q) / determinant;
        if (y < 0 || x + y > 1) continue;
        float const distance = glm::dot(v, q) / determinant;
        if (distance > 0 && distance < best.distance) best = {distance, i};
    }
    if (!std::isfinite(best.distance)) return std::nullopt;
    return best;
}

glm::vec2 NearestOnSegment(glm::vec2 a, glm::vec2 b, glm::vec2 p, float& share) {
    float const squared = glm::dot(b - a, b - a);
    share = squared > 0 ? glm::clamp(glm::dot(p - a, b - a) / squared, 0.0F, 1.0F) : 0;
    return glm::mix(a, b, share);
}

}  // namespace

std::optional<glm::vec3> Project(Camera const& camera, Sphere const& bounds, glm::vec2 size,
                                 glm::vec3 const& point) {
    glm::vec4 const eye = camera.View() * glm::vec4(point, 1);
    if (!(eye.z < 0)) return std::nullopt;
    glm::vec4 const clip = camera.Projection(size.x / size.y, bounds) * eye;
    glm::vec2 const place = glm::vec2(clip) / clip.w;
    return glm::vec3((place.x + 1) / 2 * size.x, (1 - place.y) / 2 * size.y, -eye.z);
}

Pick PickAt(Scene const& scene, Camera const& camera, glm::vec2 size, glm::vec2 cursor, float reach) {
    Pick pick;
    SurfaceTopology const& topology = *scene.topology;

    // Find the surface under the cursor.
    glm::mat4 const view = camera.View();
    float const half = std::tan(glm::radians(camera.fieldOfView) / 2);
    glm::vec2 const place((2 * cursor.x / size.x - 1) * size.x / size.y, 1 - 2 * cursor.y / size.y);
    glm::vec3 const direction = glm::transpose(glm::mat3(view)) * glm::vec3(place * half, -1);
    float depth = std::numeric_limits<float>::infinity();
    if (std::optional<Hit> const hit = Cast(scene, camera.Eye(), direction)) {
        pick.point = camera.Eye() + direction * hit->distance;
        depth = hit->distance + kDepthTolerance * scene.bounds.radius;
        float nearest = std::numeric_limits<float>::infinity();
        for (std::size_t k = 0; k < 3; ++k) {
            auto const value = static_cast<int>(topology.triangles[hit->triangle + k]);
            float const distance = glm::distance(scene.Position(value), *pick.point);
            if (distance >= nearest) continue;
            nearest = distance;
            pick.vertex = topology.valueVertices[static_cast<std::size_t>(value)];
        }
    }

    // Then the control vertices and edges near it; of those equally near, what lies in front.
    auto const project = [&](int value) { return Project(camera, scene.bounds, size, scene.Position(value)); };
    float nearest = reach;
    for (int vertex = 0; vertex < std::min(topology.numControlVertices, topology.NumVertices()); ++vertex) {
        if (topology.IsIsolated(vertex)) continue;
        auto const at = project(topology.FirstValue(vertex));
        if (!at || at->z > depth || glm::distance(glm::vec2(*at), cursor) >= nearest) continue;
        nearest = glm::distance(glm::vec2(*at), cursor);
        pick.controlVertex = vertex;
    }
    if (pick.controlVertex >= 0) return pick;
    for (std::size_t i = 0; i < topology.curves.size(); ++i) {
        ControlCurve const& curve = topology.curves[i];
        auto from = project(topology.curveValues[curve.first]);
        for (std::size_t k = 1; k < curve.count; ++k) {
            auto const to = project(topology.curveValues[curve.first + k]);
            if (from && to) {
                float share = 0;
                glm::vec2 const on = NearestOnSegment(*from, *to, cursor, share);
                bool const isVisible = glm::mix(from->z, to->z, share) <= depth;
                if (isVisible && glm::distance(on, cursor) < nearest) {
                    nearest = glm::distance(on, cursor);
                    pick.curve = static_cast<int>(i);
                }
            }
            from = to;
        }
    }
    return pick;
}

}  // namespace osd_shading::viewer
