// SPDX-License-Identifier: Apache-2.0
#include "window.h"

#include <epoxy/gl.h>
// After the loader.
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <tuple>

#include "annotations.h"
#include "builtInModels.h"
#include "colors.h"
#include "frameTarget.h"
#include "keys.h"
#include "panel.h"
#include "renderer.h"
#include "textLayer.h"
#include "windowLayout.h"
#include "workbench.h"

namespace osd_shading::viewer {

namespace {

using Clock = std::chrono::steady_clock;

constexpr glm::ivec2 kDefaultSize(1280, 800);
constexpr float kPickReach = 8, kDragStart = 3, kSplitReach = 6;  // units of the screen
constexpr float kOrbitPerUnit = 0.4F, kZoomPerNotch = 0.88F;
constexpr double kDoubleClick = 0.35, kPeriod = 3;  // seconds
// Before any click: GLFW's clock begins at 0 when the program does, so that 0 would be a click just then.
constexpr double kNoClick = -kDoubleClick;
constexpr int kSettlingFrames = 3;  // Dear ImGui needs some frames until its layout rests

std::string GlfwMessage() {
    char const* text = nullptr;
    glfwGetError(&text);
    return text ? std::string(": ") + text : std::string();
}

/// GLFW and its one window.
class GlfwWindow {
public:
    explicit GlfwWindow(glm::ivec2 size) {
        if (!glfwInit()) {
            throw GraphicsError("no window can be opened" + GlfwMessage() +
                                "; --image FILE.png makes a picture without one");
        }
        glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
        glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
        glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
        glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
        glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
        _window = glfwCreateWindow(size.x, size.y, "osd_shading", nullptr, nullptr);
        if (!_window) {
            std::string const message = GlfwMessage();
            glfwTerminate();
            throw GraphicsError("no window with OpenGL 3.3 can be opened" + message);
        }
        glfwMakeContextCurrent(_window);
        glfwSwapInterval(1);
    }
    ~GlfwWindow() {
        glfwDestroyWindow(_window);
        glfwTerminate();
    }
    GlfwWindow(GlfwWindow const&) = delete;
    GlfwWindow& operator=(GlfwWindow const&) = delete;

    GLFWwindow* Get() const { return _window; }

private:
    GLFWwindow* _window;
};

/// The panels' Dear ImGui context.
class PanelContext {
public:
    PanelContext(GLFWwindow* window, float letterScale) {
        ImGui::CreateContext();
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = nullptr;
        ImFontConfig font;
        font.SizePixels = std::round(13 * letterScale);
        io.Fonts->AddFontDefault(&font);
        ImGui::GetStyle().ScaleAllSizes(letterScale);
        // Chains to the callbacks that are set already.
        ImGui_ImplGlfw_InitForOpenGL(window, true);
        ImGui_ImplOpenGL3_Init("#version 330 core");
    }
    ~PanelContext() {
        ImGui_ImplOpenGL3_Shutdown();
        ImGui_ImplGlfw_Shutdown();
        ImGui::DestroyContext();
    }
    PanelContext(PanelContext const&) = delete;
    PanelContext& operator=(PanelContext const&) = delete;
};

/// Ties window, workbench, panels and renderer.
class Application {
public:
    Application(CommandLine const& line, std::shared_ptr<Document> const& document)
        : _line(line),
          _window(line.size.value_or(kDefaultSize)),
          _bench(line.settings, document, [] { glfwPostEmptyEvent(); }) {
        GLFWwindow* const window = _window.Get();
        glfwSetWindowUserPointer(window, this);
        glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int, int action, int modifiers) {
            self(w).onKey(key, action, modifiers);
        });
        glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int modifiers) {
            self(w).onButton(button, action, modifiers);
        });
        glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) { self(w).onMove({x, y}); });
        glfwSetScrollCallback(window, [](GLFWwindow* w, double, double y) { self(w).onScroll(y); });
        glfwSetDropCallback(window, [](GLFWwindow* w, int count, char const** paths) {
            self(w)._bench.OpenDropped({paths, paths + count});
            self(w).touch();
        });
        glfwSetWindowRefreshCallback(window, [](GLFWwindow* w) { self(w).touch(); });
        glfwSetFramebufferSizeCallback(window, [](GLFWwindow* w, int, int) { self(w).touch(); });
        glfwSetWindowFocusCallback(window, [](GLFWwindow* w, int) {
            self(w)._drag = Drag::None;
            self(w).touch();
        });
        measure();
        _panelContext.emplace(window, _layout.UnitScale());
        _renderer.emplace();
        _text.emplace(_layout.PixelScale());
        _panel.showsHud = true;
    }

    void Run() {
        while (!glfwWindowShouldClose(_window.Get()) && !_panel.wantsQuit) {
            waitForEvents();
            if (_bench.Update()) touch();
            advanceMovement();
            if (_bench.BusySeconds() > 0) touch();
            measure();
            if (!_layout.IsVisible()) continue;  // minimised
            if (_frames > 0) {
                --_frames;
                drawFrame();
            }
            reportState();
        }
    }

private:
    enum class Drag { None, Pending, Orbit, Pan, Split };

    static Application& self(GLFWwindow* window) {
        return *static_cast<Application*>(glfwGetWindowUserPointer(window));
    }

    void touch() { _frames = kSettlingFrames; }

    void waitForEvents() {
        bool const isMoving = _panel.isPlaying || _frames > 0;
        if (isMoving && _layout.IsVisible()) {
            glfwPollEvents();
        } else {
            // Some progress is to be seen, and a lost wake-up must not matter.
            glfwWaitEventsTimeout(_bench.IsBusy() ? 0.05 : 0.5);
        }
    }

    void measure() {
        glm::ivec2 size(0), frameSize(0);
        float scale = 1, ignored = 1;
        glfwGetWindowSize(_window.Get(), &size.x, &size.y);
        glfwGetFramebufferSize(_window.Get(), &frameSize.x, &frameSize.y);
        glfwGetWindowContentScale(_window.Get(), &scale, &ignored);
        _layout = WindowLayout(size, frameSize, scale, PanelWidth(_panel, 1));
    }

    Camera& camera() { return _bench.settings.camera.camera; }

    void onKey(int key, int action, int modifiers) {
        touch();
        _isHoverOld = true;  // the view may turn under the cursor
        if (action == GLFW_RELEASE) return;
        ImGuiIO const& io = ImGui::GetIO();
        bool const leavesPanel = key == GLFW_KEY_ESCAPE && _panel.hasKeyboard && !io.WantTextInput;
        if (leavesPanel) {
            _panel.hasKeyboard = false;
            return;
        }
        // A panel that has the keyboard takes the keys that move in it; chords still do what they do.
        bool const isForPanel = io.WantTextInput || (_panel.hasKeyboard && !(modifiers & GLFW_MOD_CONTROL));
        if (!isForPanel) HandleKey(_bench, _panel, key, modifiers);
    }

    void onButton(int button, int action, int modifiers) {
        touch();
        _isHoverOld = true;
        if (action == GLFW_RELEASE) {
            if (_drag == Drag::Pending) click(modifiers);
            _drag = Drag::None;
            return;
        }
        if (ImGui::GetIO().WantCaptureMouse) return;
        _dragStart = _cursor;
        bool const isOnSplit = _bench.settings.view.split == SplitKind::Line &&
                               std::abs(_cursor.x - _layout.SplitX(_bench.settings.view.splitPosition)) <
                                   kSplitReach * _layout.UnitScale();
        if (button == GLFW_MOUSE_BUTTON_LEFT) {
            _drag = isOnSplit ? Drag::Split : Drag::Pending;
        } else {
            _drag = Drag::Pan;
        }
    }

    void onMove(glm::dvec2 position) {
        touch();
        glm::vec2 const moved = glm::vec2(position) - _cursor;
        _cursor = position;
        bool const begins =
            _drag == Drag::Pending && glm::distance(_cursor, _dragStart) > kDragStart * _layout.UnitScale();
        if (begins) _drag = Drag::Orbit;
        switch (_drag) {
            case Drag::Orbit:
                camera().Orbit(-moved.x * kOrbitPerUnit, moved.y * kOrbitPerUnit);
                break;
            case Drag::Pan:
                camera().Pan(moved / std::max(_layout.Size().y, 1.0F));
                break;
            case Drag::Split:
                _bench.settings.view.splitPosition = _layout.SplitPosition(_cursor.x);
                break;
            case Drag::Pending:
                break;
            case Drag::None:
                _isHoverOld = true;
                break;
        }
    }

    void onScroll(double notches) {
        touch();
        _isHoverOld = true;
        if (ImGui::GetIO().WantCaptureMouse) return;
        std::optional<WindowLayout::Place> const place = _layout.PlaceOf(_bench.settings.view, _cursor);
        if (!place) return;
        glm::vec2 const centered(2 * place->at.x / place->size.x - 1, 1 - 2 * place->at.y / place->size.y);
        camera().Zoom(std::pow(kZoomPerNotch, static_cast<float>(notches)), centered,
                      place->size.x / place->size.y);
    }

    Pick pickAtCursor() const {
        std::optional<WindowLayout::Place> const place = _layout.PlaceOf(_bench.settings.view, _cursor);
        std::shared_ptr<Scene const> const& scene = _bench.CurrentScene();
        if (!place || !scene) return {};
        return PickAt(*scene, _bench.settings.camera.camera, place->size, place->at,
                      kPickReach * _layout.PixelScale());
    }

    void click(int modifiers) {
        double const now = glfwGetTime();
        bool const isDouble = now - _lastClick < kDoubleClick;
        _lastClick = isDouble ? kNoClick : now;
        if (isDouble) {
            _bench.ExtendToChains();
        } else {
            _bench.Select(pickAtCursor(), (modifiers & GLFW_MOD_SHIFT) != 0);
        }
    }

    void hover() {
        if (!std::exchange(_isHoverOld, false)) return;
        Pick const pick = ImGui::GetIO().WantCaptureMouse ? Pick{} : pickAtCursor();
        _bench.Hover(pick);
        int const vertex = pick.controlVertex >= 0 ? pick.controlVertex : pick.vertex;
        if (_bench.settings.view.Has(kRegions) && vertex >= 0) _bench.settings.view.vertex = vertex;
    }

    void advanceMovement() {
        Clock::time_point const now = Clock::now();
        double const passed = std::chrono::duration<double>(now - _lastMovement).count();
        if (!_panel.isPlaying || _bench.IsBusy()) {
            if (!_panel.isPlaying) _lastMovement = now;
            return;
        }
        _lastMovement = now;
        Deformation& deformation = _bench.settings.deformation;
        deformation.phase =
            static_cast<float>(std::fmod(static_cast<double>(deformation.phase) + passed / kPeriod, 1.0));
        _bench.Apply();
        touch();
    }

    void frameScene() {
        _bench.screen = ViewportsOf(_bench.settings.view, _layout.SceneSize())[0].size;
        Scene const& scene = *_bench.CurrentScene();
        if (_bench.IsNewModel()) {
            // The first model is seen as the command line says, later ones from where one looks.
            if (_hasShownModel) _bench.settings.camera.isFramed = false;
            _hasShownModel = true;
            std::string const title = "osd_shading: " + _bench.CurrentDocument()->Name();
            glfwSetWindowTitle(_window.Get(), title.c_str());
        }
        float const aspect = ViewportsOf(_bench.settings.view, _layout.SceneSize())[0].Aspect();
        if (std::exchange(_panel.wantsFrame, false)) camera().Frame(selectionBounds(scene), aspect);
        if (!_bench.settings.camera.isFramed) {
            _bench.settings.camera = {_bench.settings.camera.For(scene.bounds, aspect), true};
        }
    }

    Sphere selectionBounds(Scene const& scene) const {
        Selection const selection = _bench.ShownSelection();
        if (selection.IsEmpty()) return scene.bounds;
        std::vector<glm::vec3> points;
        for (int index : selection.curves) {
            ControlCurve const& curve = scene.topology->curves[static_cast<std::size_t>(index)];
            for (std::size_t i = 0; i < curve.count; ++i) {
                points.push_back(scene.Position(scene.topology->curveValues[curve.first + i]));
            }
        }
        for (int vertex : selection.vertices) points.push_back(scene.Position(scene.topology->FirstValue(vertex)));
        glm::vec3 low = points[0], high = points[0];
        for (glm::vec3 const& p : points) {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
        return {(low + high) / 2.0F, std::max(glm::distance(low, high) / 2, scene.bounds.radius / 10) * 1.2F};
    }

    // Draws the scene into `target`, which is bound, with its legends.
    void drawInto(FrameTarget const& target, TextLayer& text, ViewOptions const& view) {
        std::shared_ptr<Scene const> const& scene = _bench.CurrentScene();
        ViewFacts const facts = FindViewFacts(*scene, view);
        std::vector<std::string> lines;
        if (_panel.showsHud) lines = SceneLines(*scene);
        target.Bind();
        _renderer->Draw(scene, camera(), view, facts, _bench.ShownSelection(), target.Size(), text.Scale());
        ImDrawList& list = text.Begin(target.Size());
        Annotate(list, view, facts, target.Size(), text.Scale(), lines);
        text.End();
    }

    void drawScene() {
        ViewOptions view = _bench.settings.view;
        view.overlays |= kSelection;
        if (_layout.PixelScale() != _text->Scale()) _text.emplace(_layout.PixelScale());
        glm::ivec2 const size = _layout.SceneSize();
        std::tuple const drawn(_bench.CurrentScene(), camera(), view, _bench.ShownSelection(), size,
                               _panel.showsHud);
        if (_drawn == drawn) return;
        _drawn = drawn;
        if (!_target || _target->Size() != size) _target.emplace(size);
        auto const start = Clock::now();
        drawInto(*_target, *_text, view);
        glFinish();
        _panel.drawSeconds = std::chrono::duration<double>(Clock::now() - start).count();
        _panel.updateSeconds = _bench.CurrentScene()->seconds;
    }

    void takeScreenshot() {
        std::string file;
        std::error_code ignored;
        for (int i = 1; file.empty() || std::filesystem::exists(file, ignored); ++i) {
            std::string const number = std::to_string(i);
            file = "osd_shading_" + std::string(number.size() < 3 ? 3 - number.size() : 0, '0') + number + ".png";
        }
        try {
            int const multiple = _bench.settings.screenshotMultiple;
            FrameTarget const target(_layout.SceneSize() * multiple);
            TextLayer text(_layout.PixelScale() * static_cast<float>(multiple));
            drawInto(target, text, _bench.settings.view);
            WritePng(file, target.Read());
            _bench.Say("written: " + file);
        } catch (std::exception const& error) {
            _bench.Say(error.what());
        }
    }

    void drawFrame() {
        ImGui_ImplOpenGL3_NewFrame();
        ImGui_ImplGlfw_NewFrame();
        ImGui::NewFrame();
        // The keyboard belongs to the scene until the panel is asked for.
        ImGuiConfigFlags& flags = ImGui::GetIO().ConfigFlags;
        flags = _panel.hasKeyboard ? flags | ImGuiConfigFlags_NavEnableKeyboard
                                   : flags & ~ImGuiConfigFlags_NavEnableKeyboard;
        DrawPanels(_bench, _panel, _layout.Size(), _layout.UnitScale());
        hover();
        ImGui::Render();

        glm::vec3 const background = BackgroundColor(_bench.settings.view.background);
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
        glViewport(0, 0, _layout.FrameSize().x, _layout.FrameSize().y);
        glClearColor(background.r, background.g, background.b, 1);
        glClear(GL_COLOR_BUFFER_BIT);
        if (_bench.CurrentScene()) {
            try {
                frameScene();
                drawScene();
                if (std::exchange(_panel.wantsScreenshot, false)) takeScreenshot();
                _target->Show({_layout.FrameSize().x - _target->Size().x, 0});
            } catch (GraphicsError const& error) {
                _bench.Say(error.what());
            }
        }
        ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
        glfwSwapBuffers(_window.Get());
    }

    void reportState() {
        if (!_line.reportsState || _bench.IsBusy() || _frames > 0 || !_bench.CurrentScene()) return;
        std::string text = _bench.StateText();
        if (text == _reported) return;
        std::puts(text.c_str());
        std::fflush(stdout);
        _reported = std::move(text);
    }

    CommandLine const& _line;
    GlfwWindow _window;
    Workbench _bench;  // its thread wakes the window's event loop
    std::optional<PanelContext> _panelContext;
    std::optional<Renderer> _renderer;
    std::optional<TextLayer> _text;
    std::optional<FrameTarget> _target;
    PanelState _panel;

    WindowLayout _layout;
    int _frames = kSettlingFrames;
    std::optional<std::tuple<std::shared_ptr<Scene const>, Camera, ViewOptions, Selection, glm::ivec2, bool>>
        _drawn;

    glm::vec2 _cursor{0}, _dragStart{0};
    Drag _drag = Drag::None;
    double _lastClick = kNoClick;
    bool _isHoverOld = false, _hasShownModel = false;
    Clock::time_point _lastMovement = Clock::now();
    std::string _reported;
};

}  // namespace

void RunWindow(CommandLine const& line) {
    // What can't be read is said before a window opens.
    std::string const& name = line.settings.modelFile;
    auto const document =
        std::make_shared<Document>(name.empty() ? std::string(kFirstModel) : name, line.settings.mesh);
    Application application(line, document);
    application.Run();
}

}  // namespace osd_shading::viewer
