// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace osd_shading::viewer {

/// A sphere that holds what is to be seen.
struct Sphere {
    glm::vec3 center{0};
    float radius = 1;
};

/// An eye that looks at a target from a direction and a distance; y is up.
struct Camera {
    float yaw = 35, pitch = 22;  ///< degrees: of the eye round the target, and above it
    glm::vec3 target{0};
    float distance = 4;
    float fieldOfView = 30;  ///< degrees, of the view's height

    glm::mat4 View() const;
    /// Near and far planes enclose `scene`.
    glm::mat4 Projection(float aspect, Sphere const& scene) const;
    glm::vec3 Eye() const;

    /// Looks at all of `sphere`, from where the eye is.
    void Frame(Sphere const& sphere, float aspect);

    void Orbit(float yawDegrees, float pitchDegrees);
    /// Moves the target with the view plane; `shift` in shares of the view's height, as the mouse moved.
    void Pan(glm::vec2 shift);
    /// Comes nearer by `factor` (< 1) to the point under `cursor` (-1 to 1 in both directions), which stays there.
    void Zoom(float factor, glm::vec2 cursor, float aspect);

    /// As text that one can paste: orbit?yaw=35&pitch=22&distance=4&target=0,0,0&fov=30
    std::string Text() const;

    bool operator==(Camera const&) const = default;
};

/// What was asked for on the command line or typed: a whole camera, or a direction only.
struct CameraChoice {
    Camera camera;
    bool isFramed = false;  ///< target and distance are given, not to be found

    /// The camera for a scene that is shown with `aspect`.
    Camera For(Sphere const& scene, float aspect) const;

    std::string Text() const;
};

/// Reads `Camera::Text()`, parts of it, or front, back, left, right, top, bottom, corner. Nothing where it is
/// neither.
std::optional<CameraChoice> ParseCamera(std::string_view text);

}  // namespace osd_shading::viewer
