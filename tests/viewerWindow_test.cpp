// SPDX-License-Identifier: Apache-2.0

// The viewer's window under Xvfb, with events of mouse and keyboard as the X server makes them.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#include "tests/viewerProgram.h"
#include "viewer/builtInModels.h"
#include "viewer/document.h"
#include "viewer/picking.h"
#include "viewer/sceneBuilder.h"

namespace {

using nlohmann::json;
using viewerTest::Words;
namespace viewer = osd_shading::viewer;

[[maybe_unused]] testing::Environment* const kDrawing = testing::AddGlobalTestEnvironment(new viewerTest::Drawing);

constexpr std::chrono::seconds kPatience(40);

/// A program whose output can be read line by line; ended when this is destroyed.
class Child {
public:
    /// `descriptor`: which of the program's outputs is read. `folder`: where it runs.
    Child(Words const& words, int descriptor, std::string const& folder) {
        std::array<int, 2> ends{};
        if (pipe(ends.data()) != 0) throw std::runtime_error("no pipe");
        _process = fork();
        if (_process == 0) {
            std::vector<char*> arguments;
            for (std::string const& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
            arguments.push_back(nullptr);
            dup2(ends[1], descriptor);
            if (ends[0] != descriptor) close(ends[0]);
            if (ends[1] != descriptor) close(ends[1]);
            if (chdir(folder.c_str()) == 0) execvp(arguments[0], arguments.data());
            _exit(127);
        }
        close(ends[1]);
        _output = ends[0];
    }
    ~Child() {
        if (_process > 0) {
            kill(_process, SIGTERM);
            waitpid(_process, nullptr, 0);
        }
        close(_output);
    }
    Child(Child const&) = delete;
    Child& operator=(Child const&) = delete;

    /// The next line; empty when there is none in time.
    std::string Line() {
        auto const end = std::chrono::steady_clock::now() + kPatience;
        for (;;) {
            std::size_t const newline = _read.find('\n');
            if (newline != std::string::npos) {
                std::string line = _read.substr(0, newline);
                _read.erase(0, newline + 1);
                return line;
            }
            auto const left =
                std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
            pollfd ready{_output, POLLIN, 0};
            if (left.count() <= 0 || poll(&ready, 1, static_cast<int>(left.count())) <= 0) return {};
            std::array<char, 4096> bytes{};
            ssize_t const count = read(_output, bytes.data(), bytes.size());
            if (count <= 0) return {};
            _read.append(bytes.data(), static_cast<std::size_t>(count));
        }
    }

    /// Waits for its end; the exit status, or -1.
    int Status() {
        auto const end = std::chrono::steady_clock::now() + kPatience;
        int status = 0;
        while (waitpid(_process, &status, WNOHANG) == 0) {
            if (std::chrono::steady_clock::now() > end) return -1;
            usleep(10000);
        }
        _process = -1;
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }

private:
    pid_t _process = -1;
    int _output = -1;
    std::string _read;
};

class Window : public testing::Test {
protected:
    static constexpr int kPanel = 300, kSide = 600;  // units that the panel covers; the scene's width and height

    Window()
        // -noreset: else the server forgets what was set when the program that set it is gone.
        : _server(
              {OSD_SHADING_XVFB, "-displayfd", "1", "-screen", "0", "1000x700x24", "-nolisten", "tcp", "-noreset"},
              1, "/") {
        std::string const number = _server.Line();
        EXPECT_FALSE(number.empty()) << "Xvfb does not start";
        setenv("DISPLAY", (":" + number).c_str(), 1);
    }

    /// `size`: of the window in units of the screen.
    void open(Words words, glm::ivec2 size = {kPanel + kSide, kSide}) {
        words.insert(words.begin(), OSD_SHADING_VIEWER_PROGRAM);
        words.insert(words.end(),
                     {"--report-state", "--size", std::to_string(size.x) + "x" + std::to_string(size.y)});
        _program = std::make_unique<Child>(words, STDOUT_FILENO, folder.Path());
    }

    /// Reads states until `isReached`; the last one otherwise, and fails.
    json waitFor(std::string const& what, std::function<bool(json const&)> const& isReached) {
        json state;
        for (;;) {
            std::string const line = _program->Line();
            if (line.empty()) {
                ADD_FAILURE() << what << " was not reached; last state " << state.dump();
                return state;
            }
            state = json::parse(line, nullptr, false);
            if (!state.is_discarded() && isReached(state)) return state;
        }
    }

    static void input(std::string const& command) {
        EXPECT_EQ(std::system((std::string(OSD_SHADING_XDOTOOL) + " " + command).c_str()), 0) << command;
    }
    static void moveTo(glm::vec2 pixel) {
        input("mousemove " + std::to_string(kPanel + static_cast<int>(pixel.x)) + " " +
              std::to_string(static_cast<int>(pixel.y)));
    }

    int status() { return _program->Status(); }
    /// Takes the program out, still running.
    std::unique_ptr<Child> keep() { return std::exchange(_program, nullptr); }

    ioFiles::TemporaryFolder folder;

private:
    Child _server;
    std::unique_ptr<Child> _program;
};

/// A control edge that is seen from the front, and the pixel of its middle: no vertex is within `reach` of it.
struct SeenEdge {
    viewer::EdgeKey edge{-1, -1};
    glm::vec2 pixel{0};
};
SeenEdge FindSeenEdge(std::string const& name, int level, glm::vec2 size, float reach) {
    auto const model = std::make_shared<osd_shading::io::Model>(viewer::LoadModel(name));
    viewer::SceneBuilder builder;
    auto const scene = builder.Build({model, name, model->Rules({}), osd_shading::PaperPreset(level), false, {}},
                                     [](double) { return true; });
    viewer::Camera const camera = viewer::ParseCamera("front")->For(scene->bounds, size.x / size.y);
    for (std::size_t i = 0; i < scene->topology->curves.size(); ++i) {
        viewer::ControlCurve const& curve = scene->topology->curves[i];
        glm::vec3 const middle = scene->Position(scene->topology->curveValues[curve.first + curve.count / 2]);
        auto const at = viewer::Project(camera, scene->bounds, size, middle);
        viewer::Pick const pick = viewer::PickAt(*scene, camera, size, *at, reach);
        if (pick.curve == static_cast<int>(i) && pick.point) return {curve.vertices, glm::vec2(*at)};
    }
    return {};
}

TEST_F(Window, LoadsPicksSharpensUndoesAndTakesAPicture) {
    SeenEdge const seen = FindSeenEdge("cube_uvs", 3, {kSide, kSide}, 8);
    ASSERT_GE(seen.edge[0], 0);
    open({"cube_uvs", "--level", "3", "--camera", "front", "--normals", "blended", "--split-kind", "none"});
    json const first = waitFor("the model", [](json const& s) { return s["faces"] == 384; });
    EXPECT_EQ(first["undo"], false);
    std::size_t const creases = first["creases"];

    moveTo(seen.pixel + glm::vec2(0, 60));
    moveTo(seen.pixel);
    waitFor("the edge under the cursor", [](json const& s) { return s["hover"][0].get<int>() >= 0; });
    input("click 1");
    json const picked = waitFor("the picked edge", [](json const& s) { return s["edges"].size() == 1; });
    EXPECT_EQ(picked["edges"][0].get<viewer::EdgeKey>(), seen.edge);
    double const before = picked["sharpness"];

    input("key Home");
    json const sharp = waitFor("the sharp edge", [](json const& s) { return s["sharpness"] == 10; });
    EXPECT_EQ(sharp["creases"], creases + (before > 0 ? 0 : 1));
    EXPECT_EQ(sharp["undo"], true);
    input("key ctrl+z");
    json const undone = waitFor("the edge as it was", [&](json const& s) { return s["sharpness"] == before; });
    EXPECT_EQ(undone["creases"], creases);
    EXPECT_EQ(undone["redo"], true);

    input("key p");
    waitFor("the picture", [](json const& s) { return s["message"] == "written: osd_shading_001.png"; });
    viewerTest::Picture const picture(folder.File("osd_shading_001.png"));
    EXPECT_EQ(picture.Width(), kSide);
    EXPECT_EQ(picture.Height(), kSide);
    EXPECT_GT(picture.NumCovered(), kSide * kSide / 8);

    input("key ctrl+q");
    EXPECT_EQ(status(), 0);
}

TEST_F(Window, WorksWithTheKeyboardAlone) {
    open({"cube_creased", "--level", "2"});
    waitFor("the model", [](json const& s) { return s["level"] == 2; });
    moveTo({300, 300});  // where the keyboard goes without a window manager
    input("key bracketright");
    waitFor("the next level", [](json const& s) { return s["level"] == 3; });
    input("key 4");
    waitFor("zebra", [](json const& s) { return s["shading"] == "zebra"; });
    input("key period");
    json const one = waitFor("an edge", [](json const& s) { return s["edges"].size() == 1; });
    input("key ctrl+a");
    json const creases = waitFor("all creases", [](json const& s) { return s["edges"].size() == s["creases"]; });
    EXPECT_GE(creases["edges"].size(), 4U);
    input("key Delete");
    waitFor("no crease", [](json const& s) { return s["creases"] == 0; });
    input("key Escape");
    waitFor("nothing selected", [](json const& s) { return s["edges"].empty(); });
    std::string const camera = one["camera"];
    input("key Left");
    waitFor("another view", [&](json const& s) { return s["camera"] != camera; });
    input("key ctrl+s");
    waitFor("the cage", [](json const& s) { return s["message"] == "written: creased.obj"; });
    EXPECT_GT(ioFiles::ReadBytes(folder.File("creased.obj")).size(), 100U);
    input("key ctrl+q");
    EXPECT_EQ(status(), 0);
}

TEST_F(Window, WhatIsUnderTheCursorIsFoundAnewWhenTheViewTurns) {
    SeenEdge const seen = FindSeenEdge("cube_uvs", 3, {kSide, kSide}, 8);
    open({"cube_uvs", "--level", "3", "--camera", "front", "--split-kind", "none"});
    waitFor("the model", [](json const& s) { return s["faces"] == 384; });
    moveTo(seen.pixel + glm::vec2(0, 60));
    moveTo(seen.pixel);
    json const first = waitFor("the edge", [](json const& s) { return s["hover"][0].get<int>() >= 0; });
    input("key F2");  // from the back: what was seen is on the other side
    json const other = waitFor("the back", [&](json const& s) { return s["camera"] != first["camera"]; });
    EXPECT_NE(other["hover"], first["hover"]);
    input("key F1");
    json const again = waitFor("the front", [&](json const& s) { return s["camera"] == first["camera"]; });
    EXPECT_EQ(again["hover"], first["hover"]);
    input("key ctrl+q");
    EXPECT_EQ(status(), 0);
}

TEST_F(Window, TakesScreenshotsAtAMultipleOfItsSize) {
    open({"ring", "--level", "2", "--screenshot-multiple", "3"});
    waitFor("the model", [](json const& s) { return s["level"] == 2; });
    moveTo({300, 300});
    input("key p");
    waitFor("the picture", [](json const& s) { return s["message"] == "written: osd_shading_001.png"; });
    viewerTest::Picture const large(folder.File("osd_shading_001.png"));
    EXPECT_EQ(large.Width(), 3 * kSide);
    EXPECT_EQ(large.Height(), 3 * kSide);
    // What is drawn is as large as in the window, letters and lines included.
    viewerTest::Picture const small =
        viewerTest::Draw({"ring", "--level", "2", "--split", "limit,blended", "--size",
                          std::to_string(kSide) + "x" + std::to_string(kSide), "--hud"});
    EXPECT_NEAR(large.NumCovered(), 9 * small.NumCovered(), small.NumCovered() / 2);
    input("key ctrl+q");
    EXPECT_EQ(status(), 0);
}

TEST_F(Window, PastesACameraThatAnotherWindowCopied) {
    std::string const camera = "orbit?yaw=77&pitch=11&fov=30&distance=6&target=0.5,0,0";
    open({"hat", "--level", "1", "--camera", camera});
    EXPECT_EQ(waitFor("the model", [](json const& s) { return s["level"] == 1; })["camera"], camera);
    moveTo({300, 300});
    input("key ctrl+c");
    std::unique_ptr<Child> const first = keep();
    open({"ring", "--level", "1", "--camera", "front"});
    waitFor("the other model", [](json const& s) { return s["model"] == "ring"; });
    moveTo({310, 310});
    input("key ctrl+v");
    waitFor("the camera of the first window", [&](json const& s) { return s["camera"] == camera; });
    input("key ctrl+q");
    EXPECT_EQ(status(), 0);
}

TEST_F(Window, TheSplitLineIsDragged) {
    open({"mug", "--level", "2", "--split-line", "0.5"});
    json const first = waitFor("the model", [](json const& s) { return s["level"] == 2; });
    EXPECT_EQ(first["splitLine"], 0.5);
    moveTo({kSide / 2, 100});
    input("mousedown 1");
    moveTo({kSide / 2 - 60, 140});
    moveTo({kSide / 4, 200});
    input("mouseup 1");
    json const dragged = waitFor("the line elsewhere", [](json const& s) { return s["splitLine"] == 0.25; });
    EXPECT_EQ(dragged["camera"], first["camera"]);  // what is dragged is the line and not the model
    // Beside the line it is the model that turns.
    moveTo({kSide / 2, 100});
    input("mousedown 1");
    moveTo({kSide / 2 + 50, 100});
    input("mouseup 1");
    json const turned = waitFor("another view", [&](json const& s) { return s["camera"] != first["camera"]; });
    EXPECT_EQ(turned["splitLine"], 0.25);
    input("key ctrl+q");
    EXPECT_EQ(status(), 0);
}

TEST_F(Window, OnADenseScreenEverythingIsLargerAndWhatOnePointsAtIsStillPicked) {
    if (std::string(OSD_SHADING_XPROP).empty()) GTEST_SKIP() << "there is no xprop to say that the screen is dense";
    // Of twice the usual dots an inch: the window of 450 x 300 takes 900 x 600, and the panel 600 of them.
    std::string const command =
        OSD_SHADING_XPROP " -root -f RESOURCE_MANAGER 8s -set RESOURCE_MANAGER 'Xft.dpi: 192'";
    ASSERT_EQ(std::system(command.c_str()), 0);
    glm::ivec2 const scene(300, 600);
    SeenEdge const seen = FindSeenEdge("cube_uvs", 3, scene, 16);
    ASSERT_GE(seen.edge[0], 0);
    open({"cube_uvs", "--level", "3", "--camera", "front", "--split-kind", "none"}, {450, 300});
    waitFor("the model", [](json const& s) { return s["faces"] == 384; });
    moveTo(seen.pixel + glm::vec2(kPanel, 60));
    moveTo(seen.pixel + glm::vec2(kPanel, 0));
    waitFor("the edge under the cursor", [](json const& s) { return s["hover"][0].get<int>() >= 0; });
    input("click 1");
    json const picked = waitFor("the picked edge", [](json const& s) { return s["edges"].size() == 1; });
    EXPECT_EQ(picked["edges"][0].get<viewer::EdgeKey>(), seen.edge);
    input("key p");
    waitFor("the picture", [](json const& s) { return s["message"] == "written: osd_shading_001.png"; });
    viewerTest::Picture const picture(folder.File("osd_shading_001.png"));
    EXPECT_EQ(picture.Width(), scene.x);
    EXPECT_EQ(picture.Height(), scene.y);
    input("key ctrl+q");
    EXPECT_EQ(status(), 0);
}

TEST_F(Window, SurvivesResizingUnmappingMovingModelsAndAVanishedFile) {
    std::string const file = folder.File("model.obj");
    ioFiles::WriteBytes(file, ioFiles::ReadBytes(viewerTest::ModelPath("hat")));
    open({file, "--level", "2"});
    json const first = waitFor("the model", [](json const& s) { return s["level"] == 2; });
    std::remove(file.c_str());
    std::string const window = "search --name osd_shading ";
    input(window + "windowsize 1 1");
    input(window + "windowsize 350 200");
    input(window + "windowunmap");
    input(window + "windowmap");
    input(window + "windowsize 900 600");
    // Only a pointer that enters a mapped window gives it the keyboard.
    moveTo({-300, 650});
    moveTo({300, 300});
    input("key space");  // it moves
    usleep(1000000);
    input("key space");
    input("click 4 click 4 click 5");
    input("key h");
    input("key h");
    input("key s");
    input("key F10");  // the panel has the keyboard: Down and Space are not for the scene
    input("key Down key space");
    usleep(300000);
    input("key Escape");
    input("key bracketright");
    json const last = waitFor("the next level", [](json const& s) { return s["level"] == 3; });
    EXPECT_EQ(last["faces"], 4 * first["faces"].get<int>());
    EXPECT_NE(last["camera"], first["camera"]);
    input("key ctrl+q");
    EXPECT_EQ(status(), 0);
}

}  // namespace
