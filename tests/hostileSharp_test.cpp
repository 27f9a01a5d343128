// SPDX-License-Identifier: Apache-2.0

// `.sharp` texts that nobody means well with: each with the exact words of its refusal, or with what is read.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include "osd_shading/io/errors.h"
#include "osd_shading/io/objReader.h"
#include "osd_shading/io/sharpReader.h"
#include "tests/ioFiles.h"

namespace {

using namespace osd_shading;

/// A quad and a triangle, with one crease that every refusal must leave.
io::Model quadAndTriangle() {
    return io::ParseObj("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nf 1 2 3 4\nf 2 5 3\nfs 7\n", "m.obj");
}

/// The error's words; or the sharpness of the crease entries, and the warnings.
std::string outcomeOf(std::string const& text) {
    io::Model model = quadAndTriangle();
    try {
        io::ApplySharpText(text, "m.sharp", model);
    } catch (io::ParseError const& error) {
        io::Model const before = quadAndTriangle();
        bool const isLeft = model.creaseVertices == before.creaseVertices &&
                            model.creaseSharpness == before.creaseSharpness && model.warnings.empty();
        return error.what() + std::string(isLeft ? "" : " (and the model has changed)");
    }
    std::string outcome;
    for (std::size_t i = 0; i < model.creaseSharpness.size(); ++i) {
        outcome += std::to_string(model.creaseVertices[2 * i]) + "-" +
                   std::to_string(model.creaseVertices[2 * i + 1]) + "=" +
                   std::to_string(model.creaseSharpness[i]).substr(0, 4) + " ";
    }
    for (std::string const& warning : model.warnings) outcome += "; " + warning;
    return outcome;
}

struct Case {
    char const* name;
    std::string text, expected;
};

void expectOutcomes(std::vector<Case> const& cases) {
    for (Case const& c : cases) EXPECT_EQ(outcomeOf(c.text), c.expected) << c.name;
}

constexpr char kNoSharpFile[] = "m.sharp: has no fs or as line: it is no .sharp file";

TEST(HostileSharp, ValuesThatAreNoSharpnessAreRefused) {
    std::string const allowed = ": give 0 (smooth) to 10 (infinite)";
    std::string const words = ": fs and as take one sharpness per edge of the face";
    expectOutcomes({
        {"not a number", "fs nan\n", "m.sharp:1: sharpness 'nan' is not a number" + allowed},
        {"not a number with a payload", "fs 0 nan(7)\n", "m.sharp:1: sharpness 'nan(7)' is not a number" + allowed},
        {"minus infinite", "fs 0 0 -inf\n", "m.sharp:1: sharpness '-inf' is negative" + allowed},
        {"below double", "fs 1\nfs -1e999\n", "m.sharp:2: sharpness '-1e999' is negative" + allowed},
        {"barely negative", "fs -1e-300\n", "m.sharp:1: sharpness '-1e-300' is negative" + allowed},
        {"a word", "fs 1 sharp\n", "m.sharp:1: 'sharp' is not a number" + words},
        {"a comma", "fs 1,2\n", "m.sharp:1: '1,2' is not a number" + words},
        {"a slash", "fs 1/2\n", "m.sharp:1: '1/2' is not a number" + words},
        {"a zero byte", std::string("fs 1\0\n", 6), "m.sharp:1: '1\\x00' is not a number" + words},
        {"a value in an as line", "as 2 0 -3\n", "m.sharp:1: sharpness '-3' is negative" + allowed},
        {"minus zero is zero", "fs -0\n", ""},
        {"too little is zero", "fs -1e-999 1e-999\n", ""},
        {"too much is infinite", "fs 1e999 1e30 inf 10.5\n", "2-3=10.0 3-0=10.0 0-1=10.0 1-2=10.0 "},
        {"a denormal stays", "fs 1e-40\n", "2-3=0.00 "},
    });
}

TEST(HostileSharp, CountsThatDoNotFitTheModelAreRefused) {
    std::string const more =
        ": fs and as lines stand for more faces than the 2 of the model: remove them, or check that they belong to "
        "this model";
    std::string const first = ": as takes the number of faces first";
    std::string const least = ": it takes the number of faces, 1 or more";
    auto const beyond = [](int number, int face, int edges) {
        return ": sharpness number " + std::to_string(number) + " is not 0, but face " + std::to_string(face) +
               " (from 0) has only " + std::to_string(edges) + " edges: remove it, or check the order of the lines";
    };
    expectOutcomes({
        {"a third line", "fs 1\nfs 1\nfs 1\n", "m.sharp:3" + more},
        {"a third line without values", "fs 1\nfs 1\n\n\nfs\n", "m.sharp:5" + more},
        {"all 64 bits", "as 9223372036854775807 0\n", "m.sharp:1" + more},
        {"all 64 bits twice", "as 1 0\nas 9223372036854775807 0\n", "m.sharp:2" + more},
        {"beyond 64 bits", "as 18446744073709551618 1\n", "m.sharp:1" + more},
        {"no faces", "as 0 1\n", "m.sharp:1: as has the count '0'" + least},
        {"fewer than none", "as -1 1\n", "m.sharp:1: as has the count '-1'" + least},
        {"the least of 64 bits", "as -9223372036854775808 1\n",
         "m.sharp:1: as has the count '-9223372036854775808'" + least},
        {"half a face", "as 1.5 1\n", "m.sharp:1: '1.5' is not a whole number" + first},
        {"an exponent", "as 1e0 1\n", "m.sharp:1: '1e0' is not a whole number" + first},
        {"no count", "as\n", "m.sharp:1: as has neither count nor values: write as COUNT SHARPNESS.."},
        {"a count in a comment", "as # 2 1\n",
         "m.sharp:1: as has neither count nor values: write as COUNT SHARPNESS.."},
        {"no values", "as 2 # 1\n", "m.sharp:1: as has a count but no values: write as COUNT SHARPNESS.."},
        {"a fifth edge of a quad", "fs 0 0 0 0 1\n", "m.sharp:1" + beyond(5, 0, 4)},
        {"a fourth edge of the triangle in a repeated line", "as 2 0 0 0 1\n", "m.sharp:1" + beyond(4, 1, 3)},
        {"a denormal beyond", "fs\nfs 0 0 0 1e-40\n", "m.sharp:2" + beyond(4, 1, 3)},
        {"fewer lines than faces", "fs 2\n", "2-3=2.00 "},
        {"zeros beyond", "as 2 0 0 3 0 0 0 0\n", "0-1=3.00 1-4=3.00 "},
        {"a plus sign", "as +2 +1\n", "2-3=1.00 4-2=1.00 "},
    });
}

TEST(HostileSharp, FilesOfAnotherKindSaySo) {
    expectOutcomes({
        {"an OBJ", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", kNoSharpFile},
        {"capitals", "FS 1\nAS 2 1\n", kNoSharpFile},
        {"JSON", "{\"fs\": [1, 2, 3]}\n", kNoSharpFile},
        {"zero bytes", std::string(5000, '\0'), kNoSharpFile},
        {"bytes above 127", std::string(5000, '\xfe'), kNoSharpFile},
        {"half a byte-order mark", "\xEF\xBB", kNoSharpFile},
        {"UTF-16",
         std::string("\xff\xfe"
                     "f\0s\0 \0001\0\n\0",
                     12),
         kNoSharpFile},
        {"a word glued to its value", "fs1 2 3\n", kNoSharpFile},
        {"nothing", "", ""},
        {"a byte-order mark alone", "\xEF\xBB\xBF", ""},
        {"a join alone", "\\", ""},
        {"comments alone", "# fs 1\r\n#as 2 1\r\n", ""},
    });
}

TEST(HostileSharp, OddLinesAreReadForWhatTheyAre) {
    expectOutcomes({
        {"carriage returns", "fs 1\rfs 2\r", "2-3=1.00 4-2=2.00 "},
        {"carriage returns and line feeds", "fs 1\r\nfs 2\r\n", "2-3=1.00 4-2=2.00 "},
        {"joined lines", "fs 1 \\\n 2 \\\r\n 3\n", "2-3=1.00 3-0=2.00 0-1=3.00 "},
        {"comments behind values", "fs 1#2\nfs#1\n", "2-3=1.00 "},
        {"no line end", "fs 1 2", "2-3=1.00 3-0=2.00 "},
        {"blanks of all kinds", "\t fs\v1\f2\n", "2-3=1.00 3-0=2.00 "},
        {"a line of another kind between", "fs 1\nf 1 2 3\nfs 2\n",
         "2-3=1.00 4-2=2.00 ; m.sharp:2: skipped, and all lines like it: a .sharp file has no 'f' lines"},
    });
}

TEST(HostileSharp, LinesOfTenMegabytesAreReadInLinearTime) {
    std::size_t const kMany = 10'000'000;
    std::string zeros = "fs 5";
    while (zeros.size() < kMany) zeros += " 0";
    std::string many;
    while (many.size() < kMany) many += "as 1000000000000 0\n";
    auto const start = std::chrono::steady_clock::now();
    expectOutcomes({
        {"zeros", zeros, "2-3=5.00 "},
        {"digits", "fs " + std::string(kMany, '9'), "2-3=10.0 "},
        {"a word", "fs " + std::string(kMany, 'q'),
         "m.sharp:1: '" + std::string(40, 'q') +
             "...' is not a number: fs and as take one sharpness per edge of the "
             "face"},
        {"blanks", "fs" + std::string(kMany, ' ') + "5", "2-3=5.00 "},
        {"a comment", "fs 5 #" + std::string(kMany, '#'), "2-3=5.00 "},
        {"lines that stand for more faces than there are", many,
         "m.sharp:1: fs and as lines stand for more faces than the 2 of the model: remove them, or check that they "
         "belong to this model"},
    });
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(60));
}

TEST(HostileSharp, EveryBeginningOfAFileIsReadOrRefusedWithItsLastLine) {
    std::string const text = "# two faces\r\nfs 1 2.5e0 3 4\nas 1 0.5 \\\n 0 inf\n";
    for (std::size_t size = 0; size <= text.size(); ++size) {
        std::string const outcome = outcomeOf(text.substr(0, size));
        bool const isError = outcome.rfind("m.sharp", 0) == 0;
        if (!isError) continue;
        bool const isWordCut = outcome == kNoSharpFile;
        EXPECT_TRUE(isWordCut || outcome.rfind("m.sharp:2: ", 0) == 0 || outcome.rfind("m.sharp:3: ", 0) == 0)
            << size << ": " << outcome;
    }
    EXPECT_EQ(outcomeOf(text), "2-3=1.00 3-0=2.50 0-1=3.00 1-2=4.00 4-2=0.50 1-4=10.0 ");
}

TEST(HostileSharp, FilesThatCannotBeReadLeaveTheModel) {
    ioFiles::TemporaryFolder const folder;
    io::Model model = quadAndTriangle();
    for (auto const& [path, reason] : std::vector<std::pair<std::string, std::string>>{
             {folder.Path(), "it is a folder, not a file"},
             {folder.File("none/m.sharp"), "No such file or directory"},
             {folder.File(std::string(300, 'n')), "File name too long"},
             {"", "No such file or directory"},
         }) {
        EXPECT_EQ(ioFiles::ErrorOf<io::ReadError>([&, &path = path] { io::ApplySharpFile(path, model); }),
                  path + ": can't be read: " + reason);
    }
    EXPECT_EQ(model.creaseSharpness, quadAndTriangle().creaseSharpness);
}

}  // namespace
