// SPDX-License-Identifier: Apache-2.0

// The parts of the viewer that know no window: camera, settings, editing, picking, and the work in the background.

#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <thread>

#include "osd_shading/io/sharpReader.h"
#include "tests/ioFiles.h"
#include "tests/sampleSize.h"
#include "viewer/builtInModels.h"
#include "viewer/commandLine.h"
#include "viewer/edgeChains.h"
#include "viewer/keys.h"
#include "viewer/offscreen.h"
#include "viewer/picking.h"
#include "viewer/sceneFields.h"
#include "viewer/windowLayout.h"
#include "viewer/workbench.h"

namespace osd_shading::viewer {
namespace {

using ioFiles::TemporaryFolder;

std::shared_ptr<Scene const> SceneOf(std::string const& name, int level,
                                     Sdc::SchemeType scheme = Sdc::SCHEME_CATMARK, bool allSubdivided = false) {
    auto const model = std::make_shared<io::Model>(LoadModel(name));
    SubdivisionRules rules;
    rules.scheme = scheme;
    SceneBuilder builder;
    return builder.Build({model, name, model->Rules(rules), PaperPreset(level), allSubdivided, {}},
                         [](double) { return true; });
}

std::set<EdgeKey> EdgesOf(io::Model const& model) {
    std::set<EdgeKey> edges;
    std::size_t first = 0;
    for (int size : model.faceSizes) {
        auto const count = static_cast<std::size_t>(size);
        for (std::size_t i = 0; i < count; ++i) {
            edges.insert(MakeEdgeKey(model.faceVertices[first + i], model.faceVertices[first + (i + 1) % count]));
        }
        first += count;
    }
    return edges;
}

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

// --- The surface's connectivity ---------------------------------------------------------------------------------

TEST(SurfaceTopology, HasEachControlEdgeAsACurveBetweenItsVertices) {
    for (std::string const name : {"cube_creased", "mug", "pencil_ngons", "hat", "open_box", "ring", "letter_a"}) {
        for (int level : {1, 3}) {
            SCOPED_TRACE(name + std::to_string(level));
            std::shared_ptr<Scene const> const scene = SceneOf(name, level);
            std::set<EdgeKey> curves;
            for (ControlCurve const& curve : scene->topology->curves) {
                curves.insert(curve.vertices);
                EXPECT_EQ(curve.count, (std::size_t{1} << level) + 1);
                auto const vertexAt = [&](std::size_t i) {
                    int const value = scene->topology->curveValues[curve.first + i];
                    return scene->topology->valueVertices[static_cast<std::size_t>(value)];
                };
                EXPECT_EQ(vertexAt(0), curve.vertices[0]);
                EXPECT_EQ(vertexAt(curve.count - 1), curve.vertices[1]);
            }
            EXPECT_EQ(curves, EdgesOf(LoadModel(name)));
            EXPECT_EQ(curves.size(), scene->topology->curves.size());
        }
    }
}

TEST(SurfaceTopology, HasControlEdgesAsCurvesOnAdaptiveTrianglesToo) {
    for (std::string const name : {"cube_creased", "mug", "pencil_ngons", "hat", "open_box", "ring"}) {
        for (std::string const cut : {"curvature", "screen", "5"}) {
            SCOPED_TRACE(name + " " + cut);
            auto const line = ParseCommandLine({name, "--tessellate", cut});
            auto const model = std::make_shared<io::Model>(LoadModel(name));
            SceneBuilder builder;
            auto const scene =
                builder.Build(MakeRequest(line->settings, model, name, {640, 400}), [](double) { return true; });
            EXPECT_EQ(scene->topology->faceSize, 3);
            std::set<EdgeKey> curves;
            for (ControlCurve const& curve : scene->topology->curves) curves.insert(curve.vertices);
            EXPECT_EQ(curves, EdgesOf(LoadModel(name)));
            EXPECT_EQ(curves.size(), scene->topology->curves.size());
        }
    }
}

TEST(SceneBuilder, CutsFinerForALargerScreen) {
    auto const line = ParseCommandLine({"mug", "--tessellate", "screen"});
    auto const model = std::make_shared<io::Model>(LoadModel("mug"));
    auto const facesOn = [&](glm::ivec2 size) {
        SceneBuilder builder;
        return builder.Build(MakeRequest(line->settings, model, "mug", size), [](double) { return true; })
            ->report.faces;
    };
    EXPECT_GT(facesOn({1280, 800}), 2 * facesOn({320, 200}));
}

TEST(SurfaceTopology, HasEachEdgeOnce) {
    // Euler: a closed surface of genus g has 2 - 2 g = V - E + F; the mug's handle makes it a torus.
    for (auto const& [name, euler] : {std::pair("cube_creased", 2), {"mug", 0}, {"cross_triangles", 2}}) {
        SCOPED_TRACE(name);
        std::shared_ptr<Scene const> const scene = SceneOf(name, 2);
        SurfaceTopology const& topology = *scene->topology;
        EXPECT_EQ(topology.NumVertices() - static_cast<int>(topology.wires.size()) +
                      static_cast<int>(topology.NumFaces()),
                  euler);
    }
}

TEST(SurfaceTopology, KnowsWhereNoBackOfAFaceCanBeSeen) {
    for (auto const& [name, isClosed] : {std::pair("mug", true),
                                         {"cross_triangles", true},
                                         {"ring", true},
                                         {"hat", false},
                                         {"open_box", false},
                                         {"cube_hole", false}}) {
        EXPECT_EQ(SceneOf(name, 2)->topology->hidesBackFaces, isClosed) << name;
    }
    // Turned inside out, closed as it is, its backs are what one sees.
    auto const model = std::make_shared<io::Model>(LoadModel("cube_uvs"));
    std::reverse(model->faceVertices.begin(), model->faceVertices.end());
    SceneBuilder builder;
    auto const scene = builder.Build({model, "reversed", model->Rules({}), PaperPreset(2), false, {}},
                                     [](double) { return true; });
    EXPECT_FALSE(scene->topology->hidesBackFaces);
}

TEST(SceneBuilder, HasSubdividedNormalsEverywhereWhereTheyAreAskedFor) {
    auto const count = [](Scene const& scene) {
        std::size_t missing = 0;
        for (SurfaceVertex const& vertex : scene.vertices) {
            missing += glm::length(vertex.subdividedNormal) < 0.5F ? 1U : 0U;
        }
        return missing;
    };
    EXPECT_GT(count(*SceneOf("mug", 3)), 1000U);
    EXPECT_EQ(count(*SceneOf("mug", 3, Sdc::SCHEME_CATMARK, true)), 0U);
}

TEST(SceneBuilder, MovesByTablesAsItWouldLevelByLevel) {
    for (auto const& [name, scheme] : {std::pair("mug", Sdc::SCHEME_CATMARK),
                                       {"letter_a_dart", Sdc::SCHEME_CATMARK},
                                       {"hat", Sdc::SCHEME_LOOP},
                                       {"pencil_ngons", Sdc::SCHEME_CATMARK}}) {
        SCOPED_TRACE(name);
        auto const model = std::make_shared<io::Model>(LoadModel(name));
        SubdivisionRules rules;
        rules.scheme = scheme;
        SceneRequest request{model,          name, model->Rules(rules),
                             PaperPreset(3), true, {DeformationKind::Bend, 0.2F, 1}};
        auto const build = [](SceneBuilder& builder, SceneRequest const& wanted) {
            return builder.Build(wanted, [](double) { return true; });
        };
        // Deformed beforehand, and then shaded as any model.
        std::vector<glm::vec3> points;
        auto const scene = SceneOf(name, 1, scheme);
        auto moved = std::make_shared<io::Model>(*model);
        for (glm::vec3 const& p : scene->cage.points) points.push_back(p);
        Deform(request.deformation, points);
        for (std::size_t i = 0; i < points.size(); ++i) {
            for (int k = 0; k < 3; ++k) {
                moved->positions[3 * i + static_cast<std::size_t>(k)] = static_cast<double>(points[i][k]);
            }
        }
        SceneRequest still = request;
        still.model = moved;
        still.deformation = {};
        SceneBuilder byTables, byLevels;
        auto const expected = build(byLevels, still);
        request.deformation.phase = 0.7F;
        build(byTables, request);
        request.deformation.phase = 0.2F;  // from the tables of the frame before
        auto const actual = build(byTables, request);
        ASSERT_EQ(actual->vertices.size(), expected->vertices.size());
        glm::vec3 const shift(expected->origin);
        int numOff = 0;
        for (std::size_t i = 0; i < actual->vertices.size(); ++i) {
            SurfaceVertex const &a = actual->vertices[i], &b = expected->vertices[i];
            ASSERT_LT(glm::distance(a.position, b.position + shift), 1e-5F * expected->bounds.radius);
            ASSERT_EQ(a.weight, b.weight);
            // Of zero length where there is none; a few are badly conditioned.
            for (NormalChoice choice : {NormalChoice::Limit, NormalChoice::Subdivided, NormalChoice::Blended}) {
                numOff += glm::distance(NormalOf(a, choice), NormalOf(b, choice)) > 1e-3F ? 1 : 0;
            }
        }
        EXPECT_LE(numOff, static_cast<int>(actual->vertices.size() / 1000));
    }
}

TEST(SceneFields, AgreeWithTheLibrarysReport) {
    std::shared_ptr<Scene const> const scene = SceneOf("cross_quads", 3);
    AngleStatistics const angles = CompareNormals(*scene, NormalChoice::Limit, NormalChoice::Blended);
    EXPECT_NEAR(angles.max, scene->report.maxAngle, 1e-3);
    EXPECT_NEAR(angles.mean, scene->report.meanAngle, 1e-3);
    EXPECT_EQ(angles.maxValue, scene->report.maxAngleValue);
    EXPECT_EQ(CompareNormals(*scene, NormalChoice::Face, NormalChoice::Face).max, 0);
}

TEST(SceneFields, RegionsOfAControlVertexAreItsFacesBetweenSharpEdges) {
    std::shared_ptr<Scene const> const scene = SceneOf("open_box", 2);
    SurfaceTopology const& topology = *scene->topology;
    for (int vertex = 0; vertex < topology.numControlVertices; ++vertex) {
        RegionShape const regions = RegionsOf(*scene, vertex);
        EXPECT_EQ(static_cast<int>(regions.values.size()),
                  topology.FirstValue(vertex + 1) - topology.FirstValue(vertex));
        for (auto const& triangles : regions.triangles) {
            // Whole control faces: 4^2 quads of two triangles each.
            EXPECT_GT(triangles.size(), 0U);
            EXPECT_EQ(triangles.size() % (16 * 2 * 3), 0U);
        }
    }
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

// --- The workbench ----------------------------------------------------------------------------------------------

class WorkbenchTest : public testing::Test {
protected:
    static std::unique_ptr<Workbench> open(std::string const& name, int level = 2) {
        Settings settings;
        settings.shading.level = level;
        auto bench = std::make_unique<Workbench>(settings, std::make_shared<Document>(name, settings.mesh), [] {});
        settle(*bench);
        return bench;
    }
    static void settle(Workbench& bench) {
        auto const end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
        while (bench.IsBusy() && std::chrono::steady_clock::now() < end) {
            bench.Update();
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        bench.Update();
        ASSERT_FALSE(bench.IsBusy());
    }
};

TEST_F(WorkbenchTest, EditsWhatIsSelectedAndUndoesIt) {
    auto const bench = open("cube_uvs");
    bench->SelectNextEdge(1);
    ASSERT_EQ(bench->SelectedEdges().size(), 1U);
    auto const before = bench->CurrentScene();
    float const sharpness = bench->SelectedSharpness().value();
    bench->SetSelectedSharpness(3.25F);
    settle(*bench);
    EXPECT_NE(bench->CurrentScene(), before);
    EXPECT_EQ(bench->SelectedSharpness(), 3.25F);
    bench->Undo();
    settle(*bench);
    EXPECT_EQ(bench->SelectedSharpness(), sharpness);
    for (std::size_t i = 0; i < before->vertices.size(); ++i) {
        ASSERT_EQ(bench->CurrentScene()->vertices[i].position, before->vertices[i].position);
    }
    bench->SelectNextVertex(1);
    bench->SetSelectedSharpness(20);
    EXPECT_EQ(bench->SelectedSharpness(), 10.0F);
    auto const state = nlohmann::json::parse(bench->StateText());
    EXPECT_EQ(state["corners"], 1);
    EXPECT_EQ(state["undo"], true);
}

TEST_F(WorkbenchTest, AModelThatCantBeLoadedIsSaidAndTheOldOneStays) {
    TemporaryFolder const folder;
    ioFiles::WriteBytes(folder.File("broken.obj"), "v 0 0 0\nf 1 2 3\n");
    auto const bench = open("mug");
    auto const scene = bench->CurrentScene();
    for (std::string const& file : {folder.File("broken.obj"), folder.File("none.obj"), folder.Path()}) {
        bench->Open(file);
        settle(*bench);
        EXPECT_NE(bench->Message().find(file), std::string::npos) << bench->Message();
        EXPECT_EQ(bench->CurrentScene(), scene);
        EXPECT_EQ(bench->CurrentDocument()->Name(), "mug");
    }
    bench->Open("ring");
    settle(*bench);
    EXPECT_EQ(bench->CurrentDocument()->Name(), "ring");
    EXPECT_NE(bench->CurrentScene(), scene);
}

TEST_F(WorkbenchTest, OptionsThatAModelCantTakeAreSaidAndGivenUp) {
    auto const bench = open("mug");
    auto const scene = bench->CurrentScene();
    bench->settings.mesh.scheme = Sdc::SCHEME_LOOP;
    bench->Apply();
    settle(*bench);
    EXPECT_NE(bench->Message().find("triangles only"), std::string::npos) << bench->Message();
    EXPECT_EQ(bench->CurrentScene(), scene);
    EXPECT_EQ(bench->settings.mesh.Scheme(), Sdc::SCHEME_CATMARK);

    // A model of quads opens although Loop was chosen for another.
    auto const other = open("hat");
    other->settings.mesh.scheme = Sdc::SCHEME_LOOP;
    other->Apply();
    settle(*other);
    EXPECT_EQ(other->CurrentScene()->topology->faceSize, 3);
    other->Open("mug");
    settle(*other);
    EXPECT_EQ(other->CurrentDocument()->Name(), "mug");
}

TEST_F(WorkbenchTest, LongWorkIsAbandonedAndWhatIsShownStays) {
    auto const bench = open("mug");
    auto const scene = bench->CurrentScene();
    bench->settings.shading.level = 7;
    bench->Apply();
    while (bench->BusySeconds() == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    bench->Abandon();
    settle(*bench);
    EXPECT_EQ(bench->Message(), "abandoned");
    EXPECT_EQ(bench->CurrentScene(), scene);
    EXPECT_EQ(bench->settings.shading.level, 2);
}

TEST_F(WorkbenchTest, OfManyChangesTheLastOneIsShown) {
    auto const bench = open("mug");
    for (int i = 1; i <= 50; ++i) {
        bench->settings.shading.exponent = 0.1 * i;
        bench->Apply();
    }
    settle(*bench);
    EXPECT_DOUBLE_EQ(bench->CurrentScene()->options.weights.exponent, 5.0);
}

TEST_F(WorkbenchTest, SavesCageAndResultAsTheyAreShown) {
    TemporaryFolder const folder;
    auto const bench = open("mug");
    bench->SelectNextEdge(1);
    bench->SetSelectedSharpness(4.5F);
    settle(*bench);
    for (char const* name : {"cage.obj", "cage.sharp"}) bench->SaveCage(folder.File(name));
    EXPECT_FALSE(bench->CurrentDocument()->IsChanged());
    Document const saved(folder.File("cage.obj"), {});
    EXPECT_EQ(saved.CurrentCreases(), bench->CurrentDocument()->CurrentCreases());
    io::Model model = LoadModel("mug");
    io::ApplySharpFile(folder.File("cage.sharp"), model);
    for (std::size_t i = 0; i < model.creaseSharpness.size(); ++i) {
        EdgeKey const edge = MakeEdgeKey(model.creaseVertices[2 * i], model.creaseVertices[2 * i + 1]);
        EXPECT_EQ(bench->CurrentDocument()->CurrentCreases().edges.at(edge), model.creaseSharpness[i]);
    }
    for (char const* name : {"result.ply", "result.obj", "result.usda"}) {
        bench->SaveResult(folder.File(name));
        settle(*bench);
        EXPECT_EQ(bench->Message(), "written: " + folder.File(name));
        EXPECT_GT(ioFiles::ReadBytes(folder.File(name)).size(), 10000U);
    }
    bench->SaveResult(folder.File("result.txt"));
    EXPECT_NE(bench->Message().find("ends in .ply"), std::string::npos);
    bench->SaveCage(folder.File("no/cage.obj"));
    EXPECT_NE(bench->Message().find("no/cage.obj"), std::string::npos);
}

TEST_F(WorkbenchTest, SavesResultsInDoubleUnlessFloatIsAskedFor) {
    TemporaryFolder const folder;
    auto const bench = open("hat", 1);
    auto const save = [&](std::optional<tool::Precision> precision) {
        bench->settings.run.precision = precision;
        bench->SaveResult(folder.File("result.obj"));
        settle(*bench);
        return ioFiles::ReadBytes(folder.File("result.obj"));
    };
    // Each number is written with the digits that it has.
    std::string const byDefault = save(std::nullopt), exact = save(tool::Precision::Double),
                      single = save(tool::Precision::Float);
    EXPECT_EQ(byDefault, exact);
    EXPECT_LT(single.size(), exact.size() * 4 / 5);
}

TEST_F(WorkbenchTest, WhatTakesMoreThanTheMemoryLimitIsSaidAndTheOldOneStays) {
    auto const bench = open("mug");
    auto const scene = bench->CurrentScene();
    bench->settings.run.memoryLimit = 1 << 20;
    bench->settings.shading.level = 6;
    bench->Apply();
    settle(*bench);
    EXPECT_NE(bench->Message().find("1048576"), std::string::npos) << bench->Message();
    EXPECT_EQ(bench->CurrentScene(), scene);
}

TEST_F(WorkbenchTest, OpensTheFirstOfTheFilesThatAreDropped) {
    TemporaryFolder const folder;
    auto const bench = open("mug");
    bench->OpenDropped({});
    settle(*bench);
    EXPECT_EQ(bench->CurrentDocument()->Name(), "mug");
    std::string const model = std::string(OSD_SHADING_MODELS) + "/hat.obj";
    bench->OpenDropped({model, "no such file"});
    settle(*bench);
    EXPECT_EQ(bench->CurrentDocument()->Name(), model);
    EXPECT_EQ(bench->Message(), "");
    bench->OpenDropped({folder.Path()});
    settle(*bench);
    EXPECT_EQ(bench->CurrentDocument()->Name(), model);
    EXPECT_NE(bench->Message().find(folder.Path()), std::string::npos) << bench->Message();
    ioFiles::WriteBytes(folder.File("settings.txt"), "model ring\nshading zebra\n");
    bench->OpenDropped({folder.File("settings.txt")});
    settle(*bench);
    EXPECT_EQ(bench->CurrentDocument()->Name(), "ring");
    EXPECT_EQ(bench->settings.view.shading, ShadingMode::Zebra);
}

TEST_F(WorkbenchTest, TakesACameraThatIsPastedAndSaysWhatIsNone) {
    auto const bench = open("mug");
    PasteCamera(*bench, "orbit?yaw=10&pitch=20&distance=3&target=1,2,3");
    EXPECT_EQ(bench->settings.camera.camera.yaw, 10);
    EXPECT_EQ(bench->settings.camera.camera.target, glm::vec3(1, 2, 3));
    EXPECT_TRUE(bench->settings.camera.isFramed);
    EXPECT_EQ(bench->Message(), "");
    Camera const kept = bench->settings.camera.camera;
    for (char const* text : {static_cast<char const*>(nullptr), "", "a shopping list"}) {
        bench->Say({});
        PasteCamera(*bench, text);
        EXPECT_EQ(bench->settings.camera.camera, kept);
        EXPECT_NE(bench->Message().find("is no camera"), std::string::npos);
    }
    // As it is copied out of a line of text.
    PasteCamera(*bench, "  top\n");
    EXPECT_EQ(bench->settings.camera.camera.pitch, 90);
}

TEST_F(WorkbenchTest, SavesSettingsAndReadsThem) {
    TemporaryFolder const folder;
    std::string const file = folder.File("settings.txt");
    auto const bench = open("mug");
    bench->settings.view.shading = ShadingMode::Zebra;
    bench->SaveSettings(file);
    auto const other = open("ring", 1);
    other->LoadSettings(file);
    settle(*other);
    EXPECT_EQ(other->CurrentDocument()->Name(), "mug");
    EXPECT_EQ(other->CurrentScene()->options.level, 2);
    EXPECT_EQ(other->settings.view.shading, ShadingMode::Zebra);
    other->LoadSettings(folder.File("none.txt"));
    EXPECT_NE(other->Message().find("none.txt"), std::string::npos);
}

TEST_F(WorkbenchTest, SelectsByPicksChainsAndKeys) {
    auto const bench = open("cube_creased");
    Pick pick;
    pick.curve = 0;
    bench->Select(pick, false);
    pick.curve = 1;
    bench->Select(pick, true);
    EXPECT_EQ(bench->SelectedEdges().size(), 2U);
    EXPECT_EQ(bench->ShownSelection().curves, (std::vector<int>{0, 1}));
    bench->Select(pick, true);
    EXPECT_EQ(bench->SelectedEdges().size(), 1U);
    bench->Select({}, false);
    EXPECT_TRUE(bench->SelectedEdges().empty());
    bench->SelectAllCreases();
    EXPECT_EQ(bench->SelectedEdges().size(), bench->CurrentDocument()->CurrentCreases().edges.size());
    bench->ClearAllSharpness();
    bench->CreaseByAngle(40);
    EXPECT_EQ(bench->CurrentDocument()->CurrentCreases().edges.size(), 12U);
    settle(*bench);
}

// --- Memory -----------------------------------------------------------------------------------------------------

std::size_t ResidentBytes() {
    std::ifstream file("/proc/self/statm");
    std::size_t total = 0, resident = 0;
    file >> total >> resident;
    return resident * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

TEST_F(WorkbenchTest, FiftyModelsInARowDoNotGrowTheProcess) {
#if defined(OSD_SHADING_UNDER_SANITIZER)
    GTEST_SKIP() << "the sanitizer keeps freed memory";
#endif
    OffscreenContext const context;
    PictureMaker maker(1);
    auto const bench = open("mug", 3);
    std::vector<BuiltInModel> const& models = BuiltInModels();
    std::size_t afterFirst = 0;
    std::size_t const numModels = models.size();
    for (std::size_t i = 0; i < numModels + 50; ++i) {
        bench->Open(std::string(models[i % numModels].name));
        settle(*bench);
        ViewOptions view;
        view.overlays = kCreases | kWireframe | kCage | kEv | kRegions;
        maker.Make(bench->CurrentScene(), {}, view, {200, 150});
        if (i + 1 == numModels) afterFirst = ResidentBytes();  // every model was there once
    }
    EXPECT_LT(ResidentBytes(), afterFirst + (std::size_t{12} << 20));
}

}  // namespace
}  // namespace osd_shading::viewer
