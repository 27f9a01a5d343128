// SPDX-License-Identifier: Apache-2.0

// Pictures that osd_shading_viewer makes without a display: what their pixels must say, whatever the driver.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <tuple>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#include "tests/viewerProgram.h"
#include "viewer/builtInModels.h"
#include "viewer/picking.h"
#include "viewer/sceneBuilder.h"

namespace {

using namespace viewerTest;
using ioFiles::TemporaryFolder;
namespace viewer = osd_shading::viewer;

[[maybe_unused]] testing::Environment* const kDrawing = testing::AddGlobalTestEnvironment(new Drawing);

constexpr int kWidth = 200, kHeight = 150;
Words const kSmall = {"--size", "200x150", "--level", "3", "--legend", "off"};

Words Joined(Words words, Words const& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

Words const kModes = {"lit",    "highlight", "isophotes", "zebra",     "normal",
                      "weight", "curvature", "facing",    "difference"};

std::shared_ptr<viewer::Scene const> SceneOf(std::string const& name, int level,
                                             osd_shading::Sdc::SchemeType scheme) {
    auto const model = std::make_shared<osd_shading::io::Model>(viewer::LoadModel(ModelPath(name)));
    osd_shading::SubdivisionRules rules;
    rules.scheme = scheme;
    viewer::SceneRequest const request{model, name, model->Rules(rules), osd_shading::PaperPreset(level),
                                       false, {}};
    viewer::SceneBuilder builder;
    return builder.Build(request, [](double) { return true; });
}

// --- Every mode and overlay, on models that both schemes take ---------------------------------------------------

class Pictures : public testing::TestWithParam<std::tuple<std::string, std::string>> {
protected:
    Words words() const {
        auto const& [model, scheme] = GetParam();
        return Joined({ModelPath(model), "--scheme", scheme}, kSmall);
    }
};

TEST_P(Pictures, EachModeCoversTheSamePixelsInItsOwnWay) {
    Picture const silhouette = Draw(Joined(words(), {"--shading", "weight"}));
    int const covered = silhouette.NumCovered();
    EXPECT_GT(covered, kWidth * kHeight / 10);
    EXPECT_LT(covered, kWidth * kHeight * 7 / 10);

    std::vector<Picture> pictures;
    for (std::string const& mode : kModes) {
        SCOPED_TRACE(mode);
        pictures.push_back(Draw(Joined(words(), {"--shading", mode})));
        Picture const& picture = pictures.back();

        // Background that the silhouette does not touch stays as it is, and within it nothing shows through (a
        // white light of some pixels excepted).
        int touched = 0, holes = 0;
        for (int y = 1; y + 1 < kHeight; ++y) {
            for (int x = 1; x + 1 < kWidth; ++x) {
                bool isOutside = true, isInside = true;
                for (auto const& [dx, dy] : {std::pair(0, 0), {1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
                    bool const isCovered = silhouette.At(x + dx, y + dy) != kWhite;
                    isOutside = isOutside && !isCovered;
                    isInside = isInside && isCovered;
                }
                touched += isOutside && picture.At(x, y) != kWhite ? 1 : 0;
                holes += isInside && picture.At(x, y) == kWhite ? 1 : 0;
            }
        }
        EXPECT_EQ(touched, 0);
        EXPECT_LT(holes, covered / 50);
        for (std::size_t i = 0; i + 1 < pictures.size(); ++i) {
            EXPECT_GT(NumDifferent(picture, pictures[i], 20), covered / 4) << "as " << kModes[i];
        }
    }
}

TEST_P(Pictures, EachOverlayAddsItsColoursAndNothingElse) {
    Words const plain = Joined(words(), {"--shading", "facing"});
    Picture const before = Draw(plain);
    struct Case {
        std::string overlay;
        std::vector<Color> colors;  // of which one must appear
        int atLeast;
    };
    std::vector<Case> const cases = {
        // Yellow to violet by sharpness, or green at boundaries.
        {"creases", {{255, 217, 51}, {255, 140, 13}, {237, 56, 26}, {191, 5, 102}, {89, 0, 128}, {13, 89, 26}}, 15},
        {"wireframe", {{60, 75, 95}}, 0},
        {"cage", {{26, 89, 191}}, 50},
        {"ev", {{242, 115, 13}, {89, 89, 102}}, 20},
        {"regions", {{230, 174, 57}, {90, 150, 200}}, 1}};
    for (Case const& one : cases) {
        SCOPED_TRACE(one.overlay);
        Picture const picture = Draw(Joined(plain, {"--overlay", one.overlay}));
        int const changed = NumDifferent(picture, before, 4);
        EXPECT_GT(changed, 20);
        EXPECT_LT(changed, kWidth * kHeight / 2);
        int colored = 0;
        for (Color const& color : one.colors) colored += picture.NumNear(color, 40) - before.NumNear(color, 40);
        EXPECT_GE(colored, one.atLeast);
    }

    // Darts where there are some: before they are released.
    auto const& [model, scheme] = GetParam();
    bool const hasDarts =
        SceneOf(model, 1, scheme == "loop" ? osd_shading::Sdc::SCHEME_LOOP : osd_shading::Sdc::SCHEME_CATMARK)
            ->report.darts > 0;
    Words const early = Joined(plain, {"--level", "1", "--camera", "orbit?yaw=35&pitch=50"});
    Picture const bare = Draw(early), darts = Draw(Joined(early, {"--overlay", "darts"}));
    EXPECT_EQ(NumDifferent(darts, bare, 4) > 0, hasDarts);
    EXPECT_EQ(darts.NumNear({0, 140, 153}, 20) > 20, hasDarts);
}

TEST_P(Pictures, AreThoseOfTheProgram) {
    Words const all = Joined(words(), {"--split", "limit,blended", "--overlay", "creases,ev", "--hud", "--caption",
                                       "words", "--legend", "on", "--scale", "1.5"});
    EXPECT_EQ(NumDifferent(DrawByProgram(words()), Draw(words()), 0), 0);
    // The time that shading took stands in the picture: a line of it may differ.
    EXPECT_LT(NumDifferent(DrawByProgram(all), Draw(all), 0), 500);
}

INSTANTIATE_TEST_SUITE_P(All, Pictures,
                         testing::Combine(testing::Values("tetrahedron", "cross_triangles", "hat"),
                                          testing::Values("catmark", "loop")),
                         [](auto const& test) { return std::get<0>(test.param) + "_" + std::get<1>(test.param); });

TEST(CornerPicture, MarksCornersWhereThereAreSome) {
    for (auto const& [model, hasSome] : {std::pair<std::string, bool>("ring", true), {"mug", false}}) {
        Words const words = Joined({ModelPath(model), "--shading", "facing"}, kSmall);
        Picture const bare = Draw(words), corners = Draw(Joined(words, {"--overlay", "corners"}));
        EXPECT_EQ(NumDifferent(corners, bare, 4) > 0, hasSome) << model;
        EXPECT_EQ(corners.NumNear({140, 38, 166}, 20) > 20, hasSome) << model;
    }
}

// --- Pixels that mean something ---------------------------------------------------------------------------------

// The pixel of a control vertex that is turned to the eye and for which `isWanted` holds.
template <typename Predicate>
std::optional<glm::ivec2> PixelOf(viewer::Scene const& scene, viewer::Camera const& camera, glm::vec2 size,
                                  Predicate const& isWanted) {
    viewer::SurfaceTopology const& topology = *scene.topology;
    for (int vertex = 0; vertex < topology.numControlVertices; ++vertex) {
        if (!isWanted(topology.vertexTags[static_cast<std::size_t>(vertex)])) continue;
        glm::vec3 const point = scene.Position(topology.FirstValue(vertex));
        float facing = -1;
        for (int value = topology.FirstValue(vertex); value < topology.FirstValue(vertex + 1); ++value) {
            glm::vec3 const normal = scene.vertices[static_cast<std::size_t>(value)].blendedNormal;
            facing = std::max(facing, glm::dot(normal, glm::normalize(camera.Eye() - point)));
        }
        if (facing < 0.3F) continue;
        auto const at = viewer::Project(camera, scene.bounds, size, point);
        viewer::Pick const pick = viewer::PickAt(scene, camera, size, *at, 2);
        if (pick.controlVertex == vertex && pick.point) return glm::ivec2(at->x, at->y);
    }
    return std::nullopt;
}

TEST(WeightPicture, IsRedAtASmoothExtraordinaryVertexAndBlueAtASharpOneUnderVariantB) {
    // Without darts, whose weight reaches creases. At level 2 its semi-sharp creases are still sharp.
    auto const scene = SceneOf("cube_creased", 2, osd_shading::Sdc::SCHEME_CATMARK);
    glm::vec2 const size(400, 400);
    viewer::CameraChoice choice;
    choice.camera.pitch = 18;
    viewer::Camera const camera = choice.For(scene->bounds, 1);
    ASSERT_EQ(scene->report.darts, 0);
    auto const isSharp = [](osd_shading::VertexTag const& tag) {
        return tag.kind >= osd_shading::VertexKind::Crease;
    };
    auto const sharp = PixelOf(*scene, camera, size, isSharp);
    auto const smooth = PixelOf(*scene, camera, size, [&](osd_shading::VertexTag const& tag) {
        return tag.isExtraordinary && !isSharp(tag);
    });
    ASSERT_TRUE(sharp && smooth);

    Words const words = {ModelPath("cube_creased"),
                         "--level",
                         "2",
                         "--size",
                         "400x400",
                         "--shading",
                         "weight",
                         "--legend",
                         "off",
                         "--camera",
                         camera.Text()};
    Picture const picture = Draw(words);
    Color const red = picture.At(smooth->x, smooth->y), blue = picture.At(sharp->x, sharp->y);
    EXPECT_GE(red.red, 245);
    EXPECT_LE(red.blue, 10);
    EXPECT_GE(blue.blue, 230);
    EXPECT_LE(blue.red, 25);

    // Under variant A sharp extraordinary vertices are red too.
    Picture const variantA = Draw(Joined(words, {"--sharp-vertices", "smooth"}));
    EXPECT_GE(variantA.At(sharp->x, sharp->y).red, 245);
}

TEST(SplitPicture, HalvesDifferNearExtraordinaryVerticesAndAreEqualFarFromThem) {
    for (std::string const model : {"mug", "axe", "letter_a"}) {
        SCOPED_TRACE(model);
        Words const base = {ModelPath(model),       "--level", "3", "--legend", "off", "--camera",
                            "orbit?yaw=60&pitch=15"};
        Picture const split = Draw(Joined(base, {"--size", "600x300", "--split", "limit,blended"}));
        Picture const weight = Draw(Joined(base, {"--size", "300x300", "--shading", "weight"}));
        int far = 0, farDifferent = 0, near = 0, nearDifferent = 0;
        // Below the words over the views.
        for (int y = 30; y < 298; ++y) {
            for (int x = 2; x < 297; ++x) {
                bool isFar = true;
                for (int dy = -2; dy <= 2; ++dy) {
                    for (int dx = -2; dx <= 2; ++dx) {
                        isFar = isFar && weight.At(x + dx, y + dy) == Color{0, 0, 255};
                    }
                }
                bool const isNear = weight.At(x, y) != kWhite && weight.At(x, y).red > 200;
                bool const isDifferent = split.At(x, y).Distance(split.At(x + 300, y)) > 6;
                far += isFar ? 1 : 0;
                farDifferent += isFar && isDifferent ? 1 : 0;
                near += isNear ? 1 : 0;
                nearDifferent += isNear && isDifferent ? 1 : 0;
            }
        }
        EXPECT_GT(far, 500);
        EXPECT_LE(farDifferent, far / 500);
        EXPECT_GT(near, 300);
        EXPECT_GT(nearDifferent, near / 10);
    }
}

TEST(SplitPicture, ALineDividesOneViewBetweenTheTwoNormals) {
    Words const base = Joined({ModelPath("mug"), "--camera", "orbit?yaw=60&pitch=15"}, kSmall);
    Picture const left = Draw(Joined(base, {"--normals", "limit"}));
    Picture const right = Draw(Joined(base, {"--normals", "blended"}));
    Picture const both = Draw(Joined(base, {"--split", "limit,blended", "--split-line", "0.5"}));
    ASSERT_GT(NumDifferent(left, right, 6), 50);
    for (int y = 30; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            if (std::abs(x - kWidth / 2) < 4) continue;
            Picture const& expected = x < kWidth / 2 ? left : right;
            ASSERT_LE(both.At(x, y).Distance(expected.At(x, y)), 2) << x << ", " << y;
        }
    }
}

TEST(NormalPicture, ShowsTheNormalsOfAnAxisAsItsColour) {
    // The floor of an upright closed cube under sharp edges: flat faces, whose normals are the axes.
    TemporaryFolder const folder;
    std::string const file = folder.File("cube.obj");
    std::string text =
        "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
        "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    ioFiles::WriteBytes(file, text);
    struct Case {
        std::string camera, normals;
        Color color;
    };
    for (Case const& one : {Case{"front", "limit", {128, 128, 255}}, Case{"right", "subdivided", {255, 128, 128}},
                            Case{"top", "blended", {128, 255, 128}}, Case{"left", "face", {0, 128, 128}},
                            Case{"bottom", "limit", {128, 0, 128}}, Case{"back", "face", {128, 128, 0}}}) {
        SCOPED_TRACE(one.camera);
        Picture const picture = Draw({file, "--size", "60x60", "--crease-angle", "40", "--shading", "normal",
                                      "--normals", one.normals, "--camera", one.camera});
        EXPECT_LE(picture.At(30, 30).Distance(one.color), 1);
        EXPECT_EQ(picture.At(1, 1), kWhite);
    }
}

TEST(CurvaturePicture, SeesOneOnASphereAndTwiceThatHalfWay) {
    // Smoothed normals of a subdivided cube are close to a sphere's; the scale's middle is flat, its end 2.
    Picture const picture = Draw({ModelPath("cube_uvs"), "--crease-scale", "0", "--size", "60x60", "--shading",
                                  "curvature", "--range", "2", "--legend", "off", "--camera", "front"});
    // Half way between flat and the end: the fourth of five stops.
    EXPECT_LE(picture.At(30, 30).Distance({240, 153, 117}), 45);
}

TEST(DifferencePicture, IsDarkWhereNormalsAgreeAndBrightWhereTheyDiffer) {
    Words const words =
        Joined({ModelPath("mug"), "--shading", "difference", "--camera", "orbit?yaw=60&pitch=15"}, kSmall);
    Picture const same = Draw(Joined(words, {"--split", "limit,limit", "--range", "1"}));
    Color const dark{68, 1, 84};
    EXPECT_EQ(same.NumNear(dark, 2),
              Draw(Joined(words, {"--split", "limit,blended", "--range", "90000"})).NumNear(dark, 2));
    Picture const different = Draw(Joined(words, {"--split", "limit,blended", "--range", "1"}));
    EXPECT_GT(different.NumNear({253, 231, 37}, 10), 200);
    EXPECT_GT(different.NumNear(dark, 2), 500);
}

// --- The whole picture ------------------------------------------------------------------------------------------

// `model` with x turned round, and faces so that they look outwards again.
std::string MirroredObj(std::string const& model) {
    std::ifstream file(ModelPath(model));
    std::string line, mirrored;
    while (std::getline(file, line)) {
        std::istringstream words(line);
        std::string word;
        words >> word;
        if (word == "v") {
            double x = 0, y = 0, z = 0;
            words >> x >> y >> z;
            std::ostringstream text;
            text.precision(17);
            text << "v " << -x << ' ' << y << ' ' << z;
            line = text.str();
        } else if (word == "f") {
            std::string corners;
            while (words >> word) corners = " " + word + corners;
            line = "f" + corners;
        }
        mirrored += line + "\n";
    }
    return mirrored;
}

TEST(WholePicture, IsMirroredWhenTheModelIs) {
    TemporaryFolder const folder;
    // Of these the sharpness stands in tags, which don't depend on the order of a face's corners.
    for (std::string const model : {"mug", "cube_dart"}) {
        std::string const file = folder.File(model + ".obj");
        ioFiles::WriteBytes(file, MirroredObj(model));
        for (std::string const mode : {"highlight", "weight"}) {
            SCOPED_TRACE(model + mode);
            // Fine quads: how they are cut into triangles is not symmetric.
            Words const words = {"--size", "200x150", "--level", "4",         "--legend",
                                 "off",    "--lines", "8",       "--shading", mode};
            Picture const picture = Draw(Joined({ModelPath(model), "--camera", "orbit?yaw=35&pitch=20"}, words));
            Picture const mirrored = Draw(Joined({file, "--camera", "orbit?yaw=-35&pitch=20"}, words));
            int different = 0;
            for (int y = 0; y < kHeight; ++y) {
                for (int x = 0; x < kWidth; ++x) {
                    different += picture.At(x, y).Distance(mirrored.At(kWidth - 1 - x, y)) > 24 ? 1 : 0;
                }
            }
            // Samples of a pixel don't lie symmetrically: thin bands differ a little.
            EXPECT_LT(different, picture.NumCovered() / 25);
        }
    }
}

TEST(WholePicture, DoesNotDependOnWhereTheModelLiesOrHowLargeItIs) {
    TemporaryFolder const folder;
    std::string const file = folder.File("far.obj");
    osd_shading::io::Model const model = viewer::LoadModel(ModelPath("cross_quads"));
    std::ostringstream text;
    text.precision(17);
    for (std::size_t i = 0; i < model.positions.size(); i += 3) {
        text << "v " << 1e6 + 3 * model.positions[i] << ' ' << 3 * model.positions[i + 1] - 5e6 << ' '
             << 3 * model.positions[i + 2] << "\n";
    }
    std::string const original = ioFiles::ReadBytes(ModelPath("cross_quads"));
    std::istringstream lines(original);
    for (std::string line; std::getline(lines, line);) {
        if (line.rfind("v ", 0) != 0) text << line << "\n";
    }
    ioFiles::WriteBytes(file, text.str());
    Picture const near = Draw(Joined({ModelPath("cross_quads")}, kSmall)), far = Draw(Joined({file}, kSmall));
    EXPECT_LT(NumDifferent(near, far, 12), near.NumCovered() / 200);
}

TEST(WholePicture, HasTheSizeAskedForAndScaledLetters) {
    Picture const small = DrawByProgram({"mug", "--level", "2", "--size", "301x77"});
    EXPECT_EQ(small.Width(), 301);
    EXPECT_EQ(small.Height(), 77);
    Words const words = {"tetrahedron", "--level", "2", "--size", "400x400", "--shading", "weight"};
    auto const numDark = [](Picture const& picture) {
        return picture.Count([](Color const& c) { return c.Distance({20, 20, 20}) < 40; });
    };
    EXPECT_GT(numDark(Draw(Joined(words, {"--scale", "2"}))), 2 * numDark(Draw(words)));
    EXPECT_EQ(numDark(Draw(Joined(words, {"--legend", "off"}))), 0);
    EXPECT_GT(numDark(Draw(Joined(words, {"--legend", "off", "--hud"}))), 300);
    EXPECT_GT(numDark(Draw(Joined(words, {"--legend", "off", "--caption", "words"}))), 20);
}

TEST(WholePicture, IsTheSameInBothPrecisionsButForTheEdgesOfBands) {
    for (std::string const model : {"mug", "hat"}) {
        Words const words = Joined(
            {ModelPath(model), "--split", "subdivided,blended", "--deform", "bend", "--phase", "0.25"}, kSmall);
        Picture const single = Draw(Joined(words, {"--precision", "float"}));
        Picture const exact = Draw(Joined(words, {"--precision", "double", "--memory-limit", "1G"}));
        EXPECT_LT(NumDifferent(single, exact, 24), 20) << model;
        EXPECT_GT(exact.NumCovered(), 2000) << model;
    }
}

TEST(WholePicture, IsTheSameOfAdaptiveTrianglesThatAreFine) {
    for (std::string const model : {"mug", "letter_a"}) {
        Words const words = Joined({ModelPath(model), "--shading", "lit", "--overlay", "creases"}, kSmall);
        Picture const uniform = Draw(Joined(words, {"--level", "5"}));
        for (Words const& cut :
             {Words{"32"}, Words{"screen", "--max-pixels", "1"}, Words{"curvature", "--max-angle", "2"}}) {
            SCOPED_TRACE(model + " " + cut[0]);
            Picture const adaptive = Draw(Joined(Joined(words, {"--tessellate"}), cut));
            EXPECT_LT(NumDifferent(uniform, adaptive, 24), uniform.NumCovered() / 50);
        }
    }
}

TEST(WholePicture, MovesWithTheModel) {
    Words const words = Joined({ModelPath("letter_a")}, kSmall);
    Picture const rest = Draw(words);
    for (std::string const movement : {"bend", "twist", "wave"}) {
        SCOPED_TRACE(movement);
        Picture const moved = Draw(Joined(words, {"--deform", movement, "--phase", "0.25"}));
        EXPECT_GT(NumDifferent(rest, moved, 20), rest.NumCovered() / 10);
    }
    // Tables round differently: some pixels at the edges of bands.
    EXPECT_LT(NumDifferent(rest, Draw(Joined(words, {"--deform", "bend", "--phase", "0"})), 24), 10);
}

// --- The paper's figures
// ------------------------------------------------------------------------------------------

TEST(Figures, AreWrittenEachThatOurOwnModelsCanShow) {
    TemporaryFolder const folder;
    Outcome const outcome = RunViewer({"--figures", folder.File("new/folder"), "--scale", "0.5"});
    EXPECT_EQ(outcome.status, 0) << outcome.error;
    std::istringstream lines(outcome.out);
    std::set<std::string> names;
    for (std::string file; std::getline(lines, file);) {
        SCOPED_TRACE(file);
        std::string const name = std::filesystem::path(file).stem().string();
        names.insert(name);
        Picture const picture(file);
        EXPECT_GT(picture.NumCovered(), picture.Width() * picture.Height() / 10);
        EXPECT_LT(picture.NumCovered(), picture.Width() * picture.Height() * 7 / 10);
        if (name != "figure2") continue;
        // The same shape left and right, in other lines.
        int different = 0, onlyOneIsWhite = 0;
        int const panel = picture.Width() / 2;
        for (int y = 0; y < 180; ++y) {
            for (int x = 0; x < panel; ++x) {
                Color const left = picture.At(x, y), right = picture.At(x + panel, y);
                different += left.Distance(right) > 60 ? 1 : 0;
                onlyOneIsWhite += (left == kWhite) != (right == kWhite) ? 1 : 0;
            }
        }
        EXPECT_GT(different, 3000);
        EXPECT_LT(onlyOneIsWhite, 20);
    }
    EXPECT_EQ(names, (std::set<std::string>{"side_by_side", "figure1", "figure2", "figure3", "figure4", "figure5",
                                            "figure6", "figure10", "figure11", "figure12", "figure13"}));
}

// --- Settings and what goes wrong -------------------------------------------------------------------------------

TEST(SettingsFile, GivesTheSamePictureAsTheOptionsAndLosesAgainstThem) {
    TemporaryFolder const folder;
    std::string const file = folder.File("settings.txt");
    ioFiles::WriteBytes(
        file, "# a comment\nmodel cross_quads\n\nlevel 2\nshading zebra\nlines 12\nlegend off\nsize 200x150\n");
    Picture const bySettings = DrawByProgram({"--settings", file});
    Picture const byOptions = Draw({"cross_quads", "--level", "2", "--shading", "zebra", "--lines", "12",
                                    "--legend", "off", "--size", "200x150"});
    EXPECT_EQ(NumDifferent(bySettings, byOptions, 0), 0);
    Picture const other = Draw({"--settings", file, "--shading", "weight"});
    EXPECT_GT(NumDifferent(bySettings, other, 20), 1000);
}

struct Refusal {
    Words words;
    std::string part;
};

TEST(BadInput, IsRefusedInOneLineWithStatus2) {
    TemporaryFolder const folder;
    std::string const image = folder.File("picture.png"), broken = folder.File("broken.obj"),
                      settings = folder.File("settings.txt");
    ioFiles::WriteBytes(broken, "v 0 0 0\nf 1 2 3\n");
    ioFiles::WriteBytes(settings, "level 2\nshading\n");
    for (Refusal const& one :
         std::vector<Refusal>{{{"no_such_model"}, "no_such_model"},
                              {{broken}, "broken.obj:2"},
                              {{ModelPath("mug"), "--scheme", "loop"}, "Loop subdivision takes triangles only"},
                              {{"mug", "--shading", "shiny"}, "--shading: 'shiny' is not one of lit|"},
                              {{"mug", "--normals", "other"}, "--normals"},
                              {{"mug", "--split", "limit"}, "--split: 'limit' is not a pair"},
                              {{"mug", "--overlay", "creases,hats"}, "--overlay: 'hats'"},
                              {{"mug", "--size", "0x10"}, "--size: '0x10'"},
                              {{"mug", "--size", "99999x10"}, "--size"},
                              {{"mug", "--camera", "orbit?yaw=high"}, "--camera"},
                              {{"mug", "--level", "2", "--weights-from", "3"}, "--weights-from: 3 lies above"},
                              {{"mug", "--exponent", "0"}, "--exponent"},
                              {{"mug", "--start-normals", "file"}, "without a normal"},
                              {{"pencil_ngons", "--level", "0"}, "level"},
                              {{"mug", "--settings", folder.File("none.txt")}, "none.txt"},
                              {{"mug", "--settings", settings}, "settings.txt:2"},
                              {{"mug", "--wings", "2"}, "--wings"},
                              {{"mug", "--precision", "half"}, "--precision: 'half'"},
                              {{"mug", "--memory-limit", "1.5G"}, "--memory-limit: '1.5G'"},
                              {{"mug", "--level", "6", "--memory-limit", "1M"}, "1048576"},
                              {{"mug", "--threads", "-1"}, "--threads"},
                              {{"mug", "--screenshot-multiple", "9"}, "--screenshot-multiple"},
                              {{"mug", "--image", folder.File("no/folder.png")}, "no/folder.png"}}) {
        SCOPED_TRACE(one.part);
        Words words = one.words;
        bool const hasImage = std::find(words.begin(), words.end(), "--image") != words.end();
        if (!hasImage) words.insert(words.end(), {"--image", image});
        Outcome const outcome = RunViewer(words);
        EXPECT_EQ(outcome.status, 2);
        EXPECT_EQ(outcome.error.rfind("osd_shading_viewer: error: ", 0), 0U) << outcome.error;
        EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
        EXPECT_NE(outcome.error.find(one.part), std::string::npos) << outcome.error;
    }
    EXPECT_EQ(folder.NumFiles(), 2U);
}

TEST(BadInput, AWindowWithoutADisplayIsRefusedAndPointsToTheWayWithoutOne) {
    Outcome const outcome = RunViewer({"mug"});
    EXPECT_EQ(outcome.status, 2);
    EXPECT_NE(outcome.error.find("--image"), std::string::npos) << outcome.error;
}

TEST(Help, NamesTheMethodOptionsOfOsdShadeAndTheBuiltInModels) {
    Outcome const outcome = RunViewer({"--help"});
    EXPECT_EQ(outcome.status, 0);
    for (std::string const word : {"--scheme",        "--sharpness",
                                   "--crease-angle",  "--crease-scale",
                                   "--boundary",      "--creasing",
                                   "--triangles",     "--level",
                                   "--preset",        "--start-normals",
                                   "--normals-from",  "--weights ",
                                   "--weights-from",  "--sharp-vertices",
                                   "--darts",         "--exponent",
                                   "--averaging",     "--spherical-steps",
                                   "--limit-normals", "--positions",
                                   "--precision",     "--threads",
                                   "--memory-limit",  "--image",
                                   "--split",         "mug",
                                   "letter_a_dart"}) {
        EXPECT_NE(outcome.out.find(word), std::string::npos) << word;
    }
}

}  // namespace
