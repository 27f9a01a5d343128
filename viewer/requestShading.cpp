// SPDX-License-Identifier: Apache-2.0
#include "requestShading.h"

#include <cstddef>
#include <glm/gtc/matrix_transform.hpp>

#include "osd_shading/io/errors.h"
#include "osd_shading/limitSurface.h"
#include "osd_shading/subdivisionShading.h"

namespace osd_shading::viewer {

namespace {

/// What the camera sees of points that lie `origin` away from where it has them.
template <typename Real>
std::array<double, 16> ViewProjection(SceneRequest const& request, PointView<Real> const& points,
                                      glm::dvec3 const& origin) {
    std::vector<glm::vec3> shown;
    for (std::size_t i = 0; i < points.size(); ++i) {
        Vec3<Real> const p = points[i];
        shown.emplace_back(glm::dvec3(p.x, p.y, p.z) - origin);
    }
    Sphere const bounds = SphereAround(shown, [](glm::vec3 const& p) { return p; });
    float const aspect =
        static_cast<float>(request.tessellation->width) / static_cast<float>(request.tessellation->height);
    Camera const camera = request.camera.For(bounds, aspect);
    glm::dmat4 const matrix = glm::dmat4(camera.Projection(aspect, bounds)) * glm::dmat4(camera.View()) *
                              glm::translate(glm::dmat4(1), -origin);
    std::array<double, 16> numbers{};
    for (std::size_t i = 0; i < 16; ++i) {
        numbers[i] = matrix[static_cast<glm::length_t>(i / 4)][static_cast<glm::length_t>(i % 4)];
    }
    return numbers;
}

}  // namespace

glm::dvec3 OriginOf(io::Model const& model) {
    glm::dvec3 low(0), high(0);
    for (std::size_t i = 0; i < model.positions.size(); i += 3) {
        glm::dvec3 const p(model.positions[i], model.positions[i + 1], model.positions[i + 2]);
        low = i == 0 ? p : glm::min(low, p);
        high = i == 0 ? p : glm::max(high, p);
    }
    return low + (high - low) / 2.0;
}

template <typename Real>
ShadingResult<Real> ShadeRequest(SceneRequest const& request, ShadingInput<Real> const& input,
                                 ShadingOptions const& options, glm::dvec3 const& origin) {
    try {
        ControlMesh const mesh = request.model->Mesh(request.rules);
        if (!request.tessellation) return ShadeSubdivision(mesh, input, options);
        TessellationOptions tessellation = *request.tessellation;
        tessellation.progress = options.execution.progress;
        if (tessellation.kind == TessellationKind::Screen) {
            tessellation.viewProjection = ViewProjection(request, input.positions, origin);
        }
        return TessellateLimitSurface(LimitSurface<Real>(mesh, input, options), tessellation);
    } catch (InvalidControlMesh const& error) {
        throw io::ParseError(request.file, 0, error.what());  // the library knows no files
    }
}

template ShadingResult<float> ShadeRequest(SceneRequest const&, ShadingInput<float> const&, ShadingOptions const&,
                                           glm::dvec3 const&);
template ShadingResult<double> ShadeRequest(SceneRequest const&, ShadingInput<double> const&, ShadingOptions const&,
                                            glm::dvec3 const&);

}  // namespace osd_shading::viewer
