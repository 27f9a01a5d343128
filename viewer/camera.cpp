// SPDX-License-Identifier: Apache-2.0
#include "camera.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <glm/gtc/matrix_transform.hpp>
#include <utility>

namespace osd_shading::viewer {

namespace {

constexpr float kMaxPitch = 90;

struct StandardView {
    std::string_view name;
    float yaw, pitch;
};
constexpr std::array<StandardView, 7> kStandardViews = {{{"front", 0, 0},
                                                         {"back", 180, 0},
                                                         {"left", -90, 0},
                                                         {"right", 90, 0},
                                                         {"top", 0, 90},
                                                         {"bottom", 0, -90},
                                                         {"corner", 35, 22}}};

bool ReadNumber(std::string_view text, float& number) {
    char const* const end = text.data() + text.size();
    auto const [rest, error] = std::from_chars(text.data(), end, number);
    return error == std::errc() && rest == end && std::isfinite(number);
}

// The text up to `separator`, which is taken from `rest` with it.
std::string_view TakePart(std::string_view& rest, char separator) {
    std::size_t const end = std::min(rest.find(separator), rest.size());
    std::string_view const part = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    return part;
}

bool ReadPoint(std::string_view text, glm::vec3& point) {
    for (int i = 0; i < 3; ++i) {
        if (!ReadNumber(TakePart(text, ','), point[i])) return false;
    }
    return text.empty();
}

// Directions of the eye: to the right, up, and from the target to the eye.
glm::mat3 Axes(Camera const& camera) {
    float const yaw = glm::radians(camera.yaw), pitch = glm::radians(camera.pitch);
    glm::vec3 const right(std::cos(yaw), 0, -std::sin(yaw));
    glm::vec3 const back(std::sin(yaw) * std::cos(pitch), std::sin(pitch), std::cos(yaw) * std::cos(pitch));
    return {right, glm::cross(back, right), back};
}

}  // namespace

glm::vec3 Camera::Eye() const { return target + Axes(*this)[2] * distance; }

glm::mat4 Camera::View() const {
    glm::mat3 const axes = Axes(*this);
    glm::mat4 view(glm::transpose(axes));
    view[3] = glm::vec4(-(glm::transpose(axes) * Eye()), 1);
    return view;
}

glm::mat4 Camera::Projection(float aspect, Sphere const& scene) const {
    float const toCenter = glm::length(scene.center - Eye());
    float const far = std::max(toCenter + scene.radius * 1.5F, scene.radius * 1e-3F);
    float const near = std::max(toCenter - scene.radius * 1.5F, far * 1e-3F);
    return glm::perspective(glm::radians(fieldOfView), aspect, near, far);
}

void Camera::Frame(Sphere const& sphere, float aspect) {
    float const half = std::tan(glm::radians(fieldOfView) / 2) * std::min(aspect, 1.0F);
    target = sphere.center;
    distance = sphere.radius / std::sin(std::atan(half));
}

void Camera::Orbit(float yawDegrees, float pitchDegrees) {
    yaw = std::remainder(yaw + yawDegrees, 360.0F);
    pitch = std::clamp(pitch + pitchDegrees, -kMaxPitch, kMaxPitch);
}

void Camera::Pan(glm::vec2 shift) {
    glm::mat3 const axes = Axes(*this);
    float const height = 2 * distance * std::tan(glm::radians(fieldOfView) / 2);
    target -= (axes[0] * shift.x - axes[1] * shift.y) * height;
}

void Camera::Zoom(float factor, glm::vec2 cursor, float aspect) {
    glm::mat3 const axes = Axes(*this);
    float const half = distance * std::tan(glm::radians(fieldOfView) / 2);
    glm::vec3 const point = target + axes[0] * (cursor.x * half * aspect) + axes[1] * (cursor.y * half);
    target = point + (target - point) * factor;
    distance *= factor;
}

std::string Camera::Text() const { return CameraChoice{*this, true}.Text(); }

std::string CameraChoice::Text() const {
    std::array<char, 200> text{};
    auto const number = [](float x) { return static_cast<double>(x); };
    std::snprintf(text.data(), text.size(), "orbit?yaw=%.6g&pitch=%.6g&fov=%.6g", number(camera.yaw),
                  number(camera.pitch), number(camera.fieldOfView));
    std::string all = text.data();
    if (isFramed) {
        std::snprintf(text.data(), text.size(), "&distance=%.6g&target=%.6g,%.6g,%.6g", number(camera.distance),
                      number(camera.target.x), number(camera.target.y), number(camera.target.z));
        all += text.data();
    }
    return all;
}

Camera CameraChoice::For(Sphere const& scene, float aspect) const {
    Camera framed = camera;
    if (!isFramed) framed.Frame(scene, aspect);
    return framed;
}

std::optional<CameraChoice> ParseCamera(std::string_view text) {
    CameraChoice choice;
    for (StandardView const& view : kStandardViews) {
        if (view.name != text) continue;
        choice.camera.yaw = view.yaw;
        choice.camera.pitch = view.pitch;
        return choice;
    }

    if (!text.starts_with("orbit?")) return std::nullopt;
    text.remove_prefix(std::string_view("orbit?").size());
    bool hasDistance = false, hasTarget = false;
    while (!text.empty()) {
        std::string_view value = TakePart(text, '&');
        std::string_view const name = TakePart(value, '=');
        Camera& camera = choice.camera;
        bool isRead = false;
        if (name == "yaw") isRead = ReadNumber(value, camera.yaw);
        if (name == "pitch") isRead = ReadNumber(value, camera.pitch) && std::abs(camera.pitch) <= kMaxPitch;
        if (name == "distance") isRead = hasDistance = ReadNumber(value, camera.distance) && camera.distance > 0;
        if (name == "target") isRead = hasTarget = ReadPoint(value, camera.target);
        if (name == "fov") {
            isRead = ReadNumber(value, camera.fieldOfView) && camera.fieldOfView >= 1 && camera.fieldOfView <= 120;
        }
        if (!isRead) return std::nullopt;
    }
    // Where to look and from how far belong together: one without the other would be neither view.
    if (hasDistance != hasTarget) return std::nullopt;
    choice.isFramed = hasDistance;
    return choice;
}

}  // namespace osd_shading::viewer
