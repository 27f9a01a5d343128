// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/io/sharpReader.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "ioFiles.h"
#include "osd_shading/io/errors.h"
#include "osd_shading/io/objReader.h"

using namespace osd_shading;
using namespace osd_shading::io;
using ioFiles::ErrorOf;

namespace {

// Two squares side by side: every kind of edge sharpness, and a sharp corner.
Model creasedModel() {
    return ParseObj(
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nf 1 2 3 4\nf 2 5 6 3\n"
        "fs 1\nl 2 3\nt crease 2/1/0 0 1 4\nt corner 1/1/0 0 5\n",
        "m.obj");
}

}  // namespace

TEST(SharpReader, ReplacesTheEdgeSharpnessOfAllSourcesAndKeepsThatOfVertices) {
    Model model = creasedModel();
    ASSERT_EQ(model.creaseSharpness.size(), 3u);
    ApplySharpText("# preset\nfs 1 2 3 4 # face 0\r\nfs 0 0 0 0.5", "m.sharp", model);
    // Edges of face 0: 2-3, 3-0, 0-1, 1-2; of face 1, f 1 4 5 2, the fourth: 4-5.
    EXPECT_EQ(model.creaseVertices, (std::vector<int>{2, 3, 3, 0, 0, 1, 1, 2, 4, 5}));
    EXPECT_EQ(model.creaseSharpness, (std::vector<float>{1, 2, 3, 4, 0.5f}));
    EXPECT_EQ(model.cornerSharpness, (std::vector<float>{5}));
    EXPECT_TRUE(model.warnings.empty());
}

TEST(SharpReader, RepeatedLinesCoverSeveralFaces) {
    Model model = creasedModel();
    ApplySharpText(
        "\xEF\xBB\xBF"
        "as 2 0 0 6",
        "m.sharp", model);
    EXPECT_EQ(model.creaseVertices, (std::vector<int>{0, 1, 1, 4}));
}

TEST(SharpReader, GivesWhatTheSameLinesInTheObjGive) {
    std::string const faces = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 3 2 4\nf 1 2 3\nf 4 2 1\nf 1 3 4\n";
    std::string const lines = "fs 1 2 3\nas 2 0.5\nfs 0 0 inf\n";
    Model const inside = ParseObj(faces + lines, "m.obj");
    Model beside = ParseObj(faces + "fs 9 9 9\n", "m.obj");
    ApplySharpText(lines, "m.sharp", beside);
    EXPECT_EQ(beside.creaseVertices, inside.creaseVertices);
    EXPECT_EQ(beside.creaseSharpness, inside.creaseSharpness);
}

TEST(SharpReader, AnEmptyFileMakesEveryEdgeSmooth) {
    Model model = creasedModel();
    ApplySharpText("\n# nothing\n", "m.sharp", model);
    EXPECT_TRUE(model.creaseVertices.empty());
    EXPECT_TRUE(model.creaseSharpness.empty());
}

TEST(SharpReader, OtherLinesAreSkippedWithOneWarning) {
    Model model = creasedModel();
    ApplySharpText("fs 1\nfoo\nbar\n", "m.sharp", model);
    EXPECT_EQ(
        model.warnings,
        (std::vector<std::string>{"m.sharp:2: skipped, and all lines like it: a .sharp file has no 'foo' lines"}));
}

TEST(SharpReader, ErrorsNameTheSharpFileAndLeaveTheModelAsItWas) {
    Model model = creasedModel();
    auto const errorOf = [&](std::string const& text) {
        return ErrorOf<ParseError>([&] { ApplySharpText(text, "m.sharp", model); });
    };
    EXPECT_EQ(
        errorOf("fs 1\nfs 0 0 0 0 2\n"),
        "m.sharp:2: sharpness number 5 is not 0, but face 1 (from 0) has only 4 edges: remove it, or check the "
        "order of the lines");
    EXPECT_EQ(errorOf("as 3 1\n"),
              "m.sharp:1: fs and as lines stand for more faces than the 2 of the model: remove them, or check that "
              "they belong to this model");
    EXPECT_EQ(errorOf("fs -1\n"), "m.sharp:1: sharpness '-1' is negative: give 0 (smooth) to 10 (infinite)");
    EXPECT_EQ(errorOf("PK\x03\x04 binary"), "m.sharp: has no fs or as line: it is no .sharp file");
    EXPECT_EQ(model.creaseVertices, creasedModel().creaseVertices);
    EXPECT_EQ(model.creaseSharpness, creasedModel().creaseSharpness);
    EXPECT_TRUE(model.warnings.empty());

    ioFiles::TemporaryFolder const folder;
    EXPECT_EQ(ErrorOf<ReadError>([&] { ApplySharpFile(folder.File("no.sharp"), model); }),
              folder.File("no.sharp") + ": can't be read: No such file or directory");
    ioFiles::WriteBytes(folder.File("m.sharp"), "fs 0 0 7\n");
    ApplySharpFile(folder.File("m.sharp"), model);
    EXPECT_EQ(model.creaseSharpness, (std::vector<float>{7}));
}
