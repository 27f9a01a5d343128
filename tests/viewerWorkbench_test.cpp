// SPDX-License-Identifier: Apache-2.0

// The workbench: what keys, panel and files do, and the work in the background.

#include <gtest/gtest.h>

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
#include "viewer/keys.h"
#include "viewer/offscreen.h"
#include "viewer/workbench.h"

namespace osd_shading::viewer {
namespace {

using ioFiles::TemporaryFolder;

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
