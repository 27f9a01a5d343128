// SPDX-License-Identifier: Apache-2.0
#include "keys.h"

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace osd_shading::viewer {

namespace {

constexpr float kOrbitStep = 5, kPanStep = 0.05F, kZoomStep = 0.9F, kSharpnessStep = 0.25F;

void MoveCamera(Camera& camera, int key, bool pans) {
    glm::vec2 direction(0);
    if (key == GLFW_KEY_LEFT) direction.x = -1;
    if (key == GLFW_KEY_RIGHT) direction.x = 1;
    if (key == GLFW_KEY_UP) direction.y = -1;
    if (key == GLFW_KEY_DOWN) direction.y = 1;
    if (pans) {
        camera.Pan(direction * kPanStep);
    } else {
        camera.Orbit(direction.x * kOrbitStep, -direction.y * kOrbitStep);
    }
}

template <typename T, std::size_t N>
T Next(OptionNames<T, N> const& names, T value) {
    for (std::size_t i = 0; i < N; ++i) {
        if (names[i].second == value) return names[(i + 1) % N].second;
    }
    return names[0].second;
}

void ChangeLevel(Workbench& bench, int step) {
    int const level = bench.ChosenLevel() + step;
    if (level < 0 || level > kMaxViewerLevel) return;
    SetLevel(bench.settings.shading, level);
    bench.Apply();
}

// Presses that follow each other are one change.
void ChangeSharpness(Workbench& bench, float step) {
    constexpr int kKeyGesture = -1;
    std::optional<float> const sharpness = bench.SelectedSharpness();
    bench.SetSelectedSharpness(sharpness.value_or(0) + step, kKeyGesture);
}

bool HandleControlKey(Workbench& bench, PanelState& state, int key, bool isShifted) {
    switch (key) {
        case GLFW_KEY_Z:
            isShifted ? bench.Redo() : bench.Undo();
            return true;
        case GLFW_KEY_Y:
            bench.Redo();
            return true;
        case GLFW_KEY_S:
            bench.SaveCage(state.cageFile);
            return true;
        case GLFW_KEY_C:
            ImGui::SetClipboardText(bench.settings.camera.Text().c_str());
            return true;
        case GLFW_KEY_V:
            PasteCamera(bench, ImGui::GetClipboardText());
            return true;
        case GLFW_KEY_A:
            bench.SelectAllCreases();
            return true;
        case GLFW_KEY_Q:
            state.wantsQuit = true;
            return true;
        default:
            return false;
    }
}

bool HandleViewKey(Workbench& bench, PanelState& state, int key, bool isShifted) {
    ViewOptions& view = bench.settings.view;
    if (key >= GLFW_KEY_1 && key < GLFW_KEY_1 + static_cast<int>(kShadingNames.size())) {
        view.shading = kShadingNames[static_cast<std::size_t>(key - GLFW_KEY_1)].second;
        if (view.Shows(NormalChoice::Subdivided)) bench.Apply();
        return true;
    }
    if (key >= GLFW_KEY_F1 && key <= GLFW_KEY_F7) {
        static constexpr std::array<char const*, 7> kViews = {"front", "back",   "left",  "right",
                                                              "top",   "bottom", "corner"};
        SetStandardView(bench, kViews[static_cast<std::size_t>(key - GLFW_KEY_F1)]);
        return true;
    }
    switch (key) {
        case GLFW_KEY_N: {
            bool const isPair = view.split != SplitKind::None || view.shading == ShadingMode::Difference;
            NormalChoice& normals = !isPair ? view.normals : isShifted ? view.left : view.right;
            normals = Next(kNormalNames, normals);
            if (normals == NormalChoice::Subdivided) bench.Apply();
            return true;
        }
        case GLFW_KEY_S:
            view.split = Next(kSplitNames, view.split);
            return true;
        case GLFW_KEY_R:
            view.overlays ^= kCreases;
            return true;
        case GLFW_KEY_W:
            view.overlays ^= kWireframe;
            return true;
        case GLFW_KEY_C:
            view.overlays ^= kCage;
            return true;
        case GLFW_KEY_E:
            view.overlays ^= kEv | kDarts | kCorners;
            return true;
        case GLFW_KEY_G:
            view.overlays ^= kRegions;
            return true;
        case GLFW_KEY_B:
            view.background = Next(kBackgroundNames, view.background);
            return true;
        case GLFW_KEY_EQUAL:
            bench.settings.camera.camera.Zoom(kZoomStep, glm::vec2(0), 1);
            return true;
        case GLFW_KEY_MINUS:
            bench.settings.camera.camera.Zoom(1 / kZoomStep, glm::vec2(0), 1);
            return true;
        case GLFW_KEY_LEFT:
        case GLFW_KEY_RIGHT:
        case GLFW_KEY_UP:
        case GLFW_KEY_DOWN:
            MoveCamera(bench.settings.camera.camera, key, isShifted);
            return true;
        case GLFW_KEY_F:
            state.wantsFrame = true;
            return true;
        case GLFW_KEY_I:
            state.showsHud = !state.showsHud;
            return true;
        default:
            return false;
    }
}

}  // namespace

std::vector<KeyHelp> const& KeyHelpLines() {
    static std::vector<KeyHelp> const kLines = {
        {"drag, arrows", "turn"},
        {"right drag, Shift+arrows", "shift"},
        {"wheel, = and -", "come nearer (to the cursor), go away"},
        {"F", "see all that is selected, or all"},
        {"F1 .. F7", "front, back, left, right, top, bottom, corner"},
        {"Ctrl+C, Ctrl+V", "copy the camera as text, paste it"},
        {"1 .. 9", "lit, highlight lines, isophotes, zebra, normal, weight, curvature, facing, difference"},
        {"S", "two views, one with a line (drag it), one view"},
        {"N, Shift+N", "other normals: right, left"},
        {"R W C E G", "creases, wireframe, cage, extraordinary vertices, regions"},
        {"[ ]", "level"},
        {"click, Shift+click", "select an edge or a vertex, one more"},
        {"double click, L", "the whole crease or loop"},
        {", .", "edge before, next edge; with Shift: vertex"},
        {"Page up, Page down", "sharpness of what is selected, by 1/4"},
        {"Home, Delete", "infinitely sharp, smooth"},
        {"Ctrl+A, Escape", "select all creases, nothing"},
        {"Ctrl+Z, Ctrl+Y", "undo, redo"},
        {"Ctrl+S", "save the cage"},
        {"Space", "play the movement, or stop"},
        {"P", "screenshot"},
        {"I, M, B", "figures, panel, background"},
        {"F10", "keyboard to the panel (arrows, Space, Enter); Escape: back"},
        {"H or ?", "this list"},
        {"Ctrl+Q", "quit"}};
    return kLines;
}

bool HandleKey(Workbench& bench, PanelState& state, int key, int modifiers) {
    bool const isShifted = (modifiers & GLFW_MOD_SHIFT) != 0;
    if (modifiers & GLFW_MOD_CONTROL) return HandleControlKey(bench, state, key, isShifted);
    switch (key) {
        case GLFW_KEY_H:
        case GLFW_KEY_SLASH:
            state.showsHelp = !state.showsHelp;
            return true;
        case GLFW_KEY_LEFT_BRACKET:
            ChangeLevel(bench, -1);
            return true;
        case GLFW_KEY_RIGHT_BRACKET:
            ChangeLevel(bench, 1);
            return true;
        case GLFW_KEY_L:
            bench.ExtendToChains();
            return true;
        case GLFW_KEY_COMMA:
            isShifted ? bench.SelectNextVertex(-1) : bench.SelectNextEdge(-1);
            return true;
        case GLFW_KEY_PERIOD:
            isShifted ? bench.SelectNextVertex(1) : bench.SelectNextEdge(1);
            return true;
        case GLFW_KEY_PAGE_UP:
            ChangeSharpness(bench, kSharpnessStep);
            return true;
        case GLFW_KEY_PAGE_DOWN:
            ChangeSharpness(bench, -kSharpnessStep);
            return true;
        case GLFW_KEY_HOME:
            bench.SetSelectedSharpness(io::kInfiniteSharpness);
            return true;
        case GLFW_KEY_DELETE:
            bench.SetSelectedSharpness(0);
            return true;
        case GLFW_KEY_ESCAPE:
            if (state.showsHelp) {
                state.showsHelp = false;
            } else if (bench.BusySeconds() > 0) {
                bench.Abandon();
            } else {
                bench.SelectNone();
                bench.Say({});
            }
            return true;
        case GLFW_KEY_SPACE:
            TogglePlay(bench, state);
            return true;
        case GLFW_KEY_P:
            state.wantsScreenshot = true;
            return true;
        case GLFW_KEY_M:
            state.isVisible = !state.isVisible;
            state.hasKeyboard = false;
            return true;
        case GLFW_KEY_F10:
            state.isVisible = state.takesFocus = state.hasKeyboard = true;
            return true;
        default:
            return HandleViewKey(bench, state, key, isShifted);
    }
}

void SetLevel(tool::ShadingChoice& shading, int level) {
    shading.level = level;
    for (std::optional<int>* start : {&shading.normalsFrom, &shading.weightsFrom}) {
        if (*start) *start = std::min(**start, level);
    }
}

void SetStandardView(Workbench& bench, char const* name) {
    if (auto const view = ParseCamera(name)) {
        Camera& camera = bench.settings.camera.camera;
        camera.yaw = view->camera.yaw;
        camera.pitch = view->camera.pitch;
    }
}

void PasteCamera(Workbench& bench, char const* text) {
    // Spaces and the end of a line come along with what is copied.
    static constexpr std::string_view kSpace = " \t\r\n";
    std::string_view words = text ? text : "";
    words.remove_prefix(std::min(words.find_first_not_of(kSpace), words.size()));
    words = words.substr(0, words.find_last_not_of(kSpace) + 1);
    std::optional<CameraChoice> const camera = ParseCamera(words);
    if (camera) {
        bench.settings.camera = *camera;
    } else {
        bench.Say("what was copied is no camera, such as " + bench.settings.camera.Text());
    }
}

void TogglePlay(Workbench& bench, PanelState& state) {
    state.isPlaying = !state.isPlaying;
    Deformation& deformation = bench.settings.deformation;
    if (state.isPlaying && deformation.kind == DeformationKind::None) deformation.kind = DeformationKind::Bend;
}

}  // namespace osd_shading::viewer
