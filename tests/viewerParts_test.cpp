// SPDX-License-Identifier: Apache-2.0

// Parts of the viewer that know no window: camera, settings, editing, picking.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <string>

#include "osd_shading/io/sharpReader.h"
#include "tests/ioFiles.h"
#include "tests/viewerModels.h"
#include "viewer/commandLine.h"
#include "viewer/document.h"
#include "viewer/edgeChains.h"
#include "viewer/keys.h"
#include "viewer/picking.h"
#include "viewer/windowLayout.h"

namespace osd_shading::viewer {
namespace {

using ioFiles::TemporaryFolder;

// --- Camera -----------------------------------------------------------------------------------------------------

TEST(ViewerCamera, ItsTextGivesTheSameCamera) {
    Camera camera;
    camera.yaw = -123.5F;
    camera.pitch = 12.25F;
    camera.target = {1, -2.5F, 1e-3F};
    camera.distance = 7;
    camera.fieldOfView = 40;
    auto const read = ParseCamera(camera.Text());
    ASSERT_TRUE(read);
    EXPECT_TRUE(read->isFramed);
    EXPECT_EQ(read->camera, camera);
}

TEST(ViewerCamera, WhatIsNoCameraIsNone) {
    for (char const* text :
         {"", "above", "orbit?", "orbit?yaw=1&pitch=91", "orbit?yaw=nan", "orbit?yaw=1&yaw", "orbit?distance=2",
          "orbit?target=0,0,0", "orbit?distance=-1&target=0,0,0", "orbit?distance=1&target=0,0", "orbit?roll=3"}) {
        bool const isEmptyView = std::string(text) == "orbit?";
        EXPECT_EQ(ParseCamera(text).has_value(), isEmptyView) << text;
    }
}

TEST(ViewerCamera, FramesASphereSoThatItTouchesTheEdgesOfTheView) {
    for (float aspect : {0.5F, 1.0F, 2.0F}) {
        Sphere const sphere{{1, 2, 3}, 5};
        Camera camera;
        camera.Frame(sphere, aspect);
        // The cone round the view that just holds the sphere is as wide as the narrower side.
        float const cone = std::asin(sphere.radius / glm::distance(camera.Eye(), sphere.center));
        float const half = std::tan(glm::radians(camera.fieldOfView) / 2) * std::min(aspect, 1.0F);
        EXPECT_NEAR(std::tan(cone), half, 1e-4F);
    }
}

TEST(ViewerCamera, ZoomKeepsThePointUnderTheCursor) {
    Camera camera;
    camera.target = {0.3F, 0.1F, -0.2F};
    Sphere const bounds{{0, 0, 0}, 2};
    glm::vec2 const cursor(0.4F, -0.6F), size(800, 400);
    // The point of the target's plane that is seen there.
    float const half = camera.distance * std::tan(glm::radians(camera.fieldOfView) / 2);
    glm::mat3 const axes = glm::transpose(glm::mat3(camera.View()));
    glm::vec3 const point = camera.target + axes[0] * (cursor.x * half * 2) + axes[1] * (cursor.y * half);
    auto const before = Project(camera, bounds, size, point);
    camera.Zoom(0.5F, cursor, 2);
    auto const after = Project(camera, bounds, size, point);
    ASSERT_TRUE(before && after);
    EXPECT_NEAR(before->x, after->x, 0.01F);
    EXPECT_NEAR(before->y, after->y, 0.01F);
    EXPECT_NEAR(after->z, before->z / 2, 1e-4F);
}

// --- The window's layout
// ------------------------------------------------------------------------------------------

TEST(WindowLayout, OfADenseScreenHasTheSameShareOfPanelAndSceneInMorePixels) {
    ViewOptions view;
    view.split = SplitKind::SideBySide;
    WindowLayout const plain({900, 600}, {900, 600}, 1, 300);
    EXPECT_EQ(plain.Left(), 300);
    EXPECT_EQ(plain.SceneSize(), glm::ivec2(600, 600));
    // Twice as many pixels as units: letters of twice the pixels are as large in units as they were.
    WindowLayout const dense({900, 600}, {1800, 1200}, 2, 300);
    EXPECT_EQ(dense.Left(), 300);
    EXPECT_EQ(dense.UnitScale(), 1);
    EXPECT_EQ(dense.PixelScale(), 2);
    EXPECT_EQ(dense.SceneSize(), glm::ivec2(1200, 1200));
    // Units that are pixels, and letters twice as large: so is the panel.
    WindowLayout const large({1800, 1200}, {1800, 1200}, 2, 300);
    EXPECT_EQ(large.Left(), 600);
    EXPECT_EQ(large.UnitScale(), 2);
    EXPECT_EQ(large.SceneSize(), glm::ivec2(1200, 1200));

    // The same place of the right view under the cursor.
    for (auto const& [layout, cursor] : {std::pair(dense, glm::vec2(700, 150)), {large, glm::vec2(1400, 300)}}) {
        auto const place = layout.PlaceOf(view, cursor);
        ASSERT_TRUE(place);
        EXPECT_EQ(place->at, glm::vec2(200, 300));
        EXPECT_EQ(place->size, glm::vec2(600, 1200));
    }
    EXPECT_FALSE(dense.PlaceOf(view, {299, 150}));
    EXPECT_FALSE(dense.PlaceOf(view, {901, 150}));
}

TEST(WindowLayout, SplitLineAndItsPlaceBelongTogether) {
    WindowLayout const layout({900, 600}, {1800, 1200}, 2, 300);
    EXPECT_EQ(layout.SplitX(0.25F), 450);
    EXPECT_EQ(layout.SplitPosition(450), 0.25F);
    EXPECT_EQ(layout.SplitPosition(10), 0);
    EXPECT_EQ(layout.SplitPosition(2000), 1);
}

TEST(WindowLayout, OfATinyOrMinimisedWindowStillLeavesAPixelToTheScene) {
    for (glm::ivec2 const size : {glm::ivec2(0, 0), {1, 1}, {200, 100}}) {
        WindowLayout const layout(size, size, 1, 300);
        EXPECT_EQ(layout.IsVisible(), size.x > 0);
        EXPECT_GE(layout.SceneSize().x, 1);
        EXPECT_GE(layout.SceneSize().y, 1);
        EXPECT_LE(layout.Left(), static_cast<float>(size.x));
    }
}

// --- Settings ---------------------------------------------------------------------------------------------------

TEST(ViewerSettings, TheirTextGivesTheSameSettings) {
    TemporaryFolder const folder;
    std::vector<std::string> const words = {"mug",
                                            "--scheme",
                                            "loop",
                                            "--level",
                                            "3",
                                            "--preset",
                                            "smooth",
                                            "--exponent",
                                            "2.5",
                                            "--darts",
                                            "sharp",
                                            "--boundary",
                                            "none",
                                            "--split",
                                            "subdivided,face",
                                            "--split-line",
                                            "0.25",
                                            "--overlay",
                                            "ev,cage",
                                            "--shading",
                                            "zebra",
                                            "--camera",
                                            "orbit?yaw=10&pitch=20&distance=3&target=1,2,3",
                                            "--lines",
                                            "7",
                                            "--roughness",
                                            "0.5",
                                            "--range",
                                            "12",
                                            "--vertex",
                                            "3",
                                            "--background",
                                            "dark",
                                            "--legend",
                                            "off",
                                            "--caption",
                                            "two words",
                                            "--deform",
                                            "twist",
                                            "--phase",
                                            "0.5",
                                            "--amount",
                                            "0.75",
                                            "--crease-angle",
                                            "30",
                                            "--threads",
                                            "2",
                                            "--precision",
                                            "double",
                                            "--memory-limit",
                                            "2G",
                                            "--tessellate",
                                            "curvature",
                                            "--max-angle",
                                            "7.5",
                                            "--screenshot-multiple",
                                            "3"};
    auto const given = ParseCommandLine(words);
    ASSERT_TRUE(given);
    std::string const text = SettingsText(given->settings);
    ioFiles::WriteBytes(folder.File("settings.txt"), text);
    auto const read = ParseCommandLine({"--settings", folder.File("settings.txt")});
    ASSERT_TRUE(read);
    EXPECT_EQ(SettingsText(read->settings), text);
    EXPECT_EQ(read->settings.view, given->settings.view);
    EXPECT_EQ(read->settings.camera.camera, given->settings.camera.camera);
    EXPECT_EQ(read->settings.run, given->settings.run);
    EXPECT_EQ(read->settings.run.memoryLimit, std::uint64_t{2} << 30);
    EXPECT_EQ(read->settings.tessellation, given->settings.tessellation);
    EXPECT_EQ(read->settings.tessellation.Resolve()->maxAngle, 7.5);
    EXPECT_EQ(read->settings.screenshotMultiple, 3);
    EXPECT_EQ(read->settings.shading.exponent, 2.5);
    EXPECT_EQ(read->settings.mesh.creaseAngle, 30.0);
}

// --- Editing ----------------------------------------------------------------------------------------------------

TEST(Document, KnowsTheFilesBesideIt) {
    TemporaryFolder const folder;
    for (char const* name : {"b.obj", "a.obj", "c.ply"}) ioFiles::WriteBytes(folder.File(name), "v 0 0 0\n");
    std::filesystem::create_directory(folder.File("d.obj"));
    EXPECT_EQ(FilesBeside(folder.File("b.obj")),
              (std::vector<std::string>{folder.File("a.obj"), folder.File("b.obj")}));
    // No file, as what is built in: those of the current folder, which may have none.
    EXPECT_NO_THROW(FilesBeside("mug"));
    EXPECT_NO_THROW(FilesBeside(folder.File("no/such.obj")));
}

TEST(Document, UndoesAndRedoesWhatWasChanged) {
    Document document("cube_creased", {});
    Creases const before = document.CurrentCreases();
    EXPECT_FALSE(document.CanUndo() || document.CanRedo() || document.IsChanged());
    Creases changed = before;
    changed.edges[{0, 1}] = 7.5F;
    document.Change(changed);
    EXPECT_TRUE(document.CanUndo() && document.IsChanged());
    io::Model const& model = *document.Model();
    bool isThere = false;
    for (std::size_t i = 0; i < model.creaseSharpness.size(); ++i) {
        isThere = isThere || (model.creaseVertices[2 * i] == 0 && model.creaseVertices[2 * i + 1] == 1 &&
                              model.creaseSharpness[i] == 7.5F);
    }
    EXPECT_TRUE(isThere);
    document.Undo();
    EXPECT_EQ(document.CurrentCreases(), before);
    EXPECT_FALSE(document.CanUndo());
    document.Redo();
    EXPECT_EQ(document.CurrentCreases(), changed);
    document.Redo();
    EXPECT_EQ(document.CurrentCreases(), changed);
}

TEST(Document, ADragIsOneStepBackAndAChangeAfterUndoingForgetsWhatWasUndone) {
    Document document("cube_uvs", {});
    Creases const before = document.CurrentCreases();
    for (int i = 1; i <= 5; ++i) {
        Creases creases = before;
        creases.edges[{0, 1}] = static_cast<float>(i);
        document.Change(creases, 9);
    }
    document.Undo();
    EXPECT_EQ(document.CurrentCreases(), before);
    Creases other = before;
    other.vertices[3] = 2;
    document.Change(other);
    EXPECT_FALSE(document.CanRedo());
    EXPECT_EQ(document.Model()->cornerVertices, std::vector<int>{3});
}

TEST(EdgeChains, FollowACreaseRoundAndALoopAcross) {
    // The cube's top: four edges of sharpness 2.5.
    Document const document("cube_creased", {});
    for (auto const& [edge, sharpness] : document.CurrentCreases().edges) {
        std::vector<EdgeKey> const chain = ChainOf(*document.Model(), document.CurrentCreases(), edge);
        EXPECT_EQ(chain.size(), 4U);
        EXPECT_EQ(chain.front(), edge);
        for (EdgeKey const& other : chain) EXPECT_EQ(document.CurrentCreases().edges.at(other), sharpness);
    }
    // A grid of 3 x 3 faces: the two inner rows of edges are loops of three.
    io::Model grid;
    for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 4; ++x) grid.positions.insert(grid.positions.end(), {double(x), double(y), 0});
    }
    for (int y = 0; y < 3; ++y) {
        for (int x = 0; x < 3; ++x) {
            int const i = 4 * y + x;
            grid.faceSizes.push_back(4);
            grid.faceVertices.insert(grid.faceVertices.end(), {i, i + 1, i + 5, i + 4});
        }
    }
    EXPECT_EQ(ChainOf(grid, {}, {5, 6}), (std::vector<EdgeKey>{{5, 6}, {4, 5}, {6, 7}}));
    EXPECT_EQ(ChainOf(grid, {}, {1, 5}), (std::vector<EdgeKey>{{1, 5}, {5, 9}, {9, 13}}));
    // Straight on between triangles: opposite of six edges.
    Document const triangles("cross_triangles", {});
    for (EdgeKey const& edge : EdgesOf(*triangles.Model())) {
        std::vector<EdgeKey> const chain = ChainOf(*triangles.Model(), {}, edge);
        EXPECT_EQ(std::set<EdgeKey>(chain.begin(), chain.end()).size(), chain.size());
    }
}

TEST(Picking, FindsTheEdgeAndTheVertexThatAreSeenAndNotThoseBehind) {
    // A convex shape: what is turned to the eye is seen, what is turned away is not.
    std::shared_ptr<Scene const> const scene = SceneOf("cube_creased", 3);
    SurfaceTopology const& topology = *scene->topology;
    glm::vec2 const size(600, 600);
    int seen = 0, hidden = 0;
    for (float yaw : {35.0F, 125.0F, 260.0F}) {
        CameraChoice choice;
        choice.camera.yaw = yaw;
        Camera const camera = choice.For(scene->bounds, 1);
        auto const check = [&](int value, auto const& isPicked) {
            SurfaceVertex const& vertex = scene->vertices[static_cast<std::size_t>(value)];
            float const facing = glm::dot(vertex.blendedNormal, glm::normalize(camera.Eye() - vertex.position));
            if (std::abs(facing) < 0.25F) return;
            auto const at = Project(camera, scene->bounds, size, vertex.position);
            ASSERT_TRUE(at);
            EXPECT_EQ(isPicked(PickAt(*scene, camera, size, *at, 6)), facing > 0);
            ++(facing > 0 ? seen : hidden);
        };
        for (std::size_t i = 0; i < topology.curves.size(); ++i) {
            ControlCurve const& curve = topology.curves[i];
            check(topology.curveValues[curve.first + curve.count / 2],
                  [&](Pick const& pick) { return pick.curve == static_cast<int>(i); });
        }
        for (int vertex = 0; vertex < topology.numControlVertices; ++vertex) {
            check(topology.FirstValue(vertex), [&](Pick const& pick) { return pick.controlVertex == vertex; });
        }
        Pick const nothing = PickAt(*scene, camera, size, {2, 2}, 6);
        EXPECT_TRUE(nothing.curve < 0 && nothing.controlVertex < 0 && nothing.vertex < 0 && !nothing.point);
    }
    EXPECT_GT(seen, 10);
    EXPECT_GT(hidden, 10);
}

}  // namespace
}  // namespace osd_shading::viewer
