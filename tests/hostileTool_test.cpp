// SPDX-License-Identifier: Apache-2.0

// The program osd_shade under what nobody wishes it: files that are none, a full disk, and too little memory.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/ioFiles.h"
#include "tests/sampleSize.h"
#include "tests/toolProgram.h"

namespace {

namespace fs = std::filesystem;
using ioFiles::ReadBytes;
using ioFiles::TemporaryFolder;
using ioFiles::WriteBytes;
using namespace toolProgram;

std::string const kQuad = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";

TEST(HostileTool, ModelsThatCannotBeAreRefusedInTheReadersWords) {
    struct Case {
        std::string text;
        Words options;
        std::string part;
    };
    std::string fan = "v 0 0 0\n";
    for (int i = 0; i < 65537; ++i) fan += "v 1 " + std::to_string(i) + " 0\n";
    for (int i = 2; i <= 65537; ++i) fan += "f 1 " + std::to_string(i) + " " + std::to_string(i + 1) + "\n";
    std::vector<Case> const cases = {
        {kQuad + "t crease 2/1/0 0 2 1\n",
         {},
         "m.obj:6: the crease from vertex 0 to 2 (from 0) is no edge of a face"},
        {kQuad + "t crease 2/1/0 0 1 -1\n", {}, "m.obj:6: sharpness '-1' is negative"},
        {kQuad + "t hole 1/0/0 7\n", {}, "m.obj:6: no face has the index 7 (counted from 0): the file has 1"},
        {kQuad + "fs 0 0 0 0 1\n", {}, "m.obj:6: sharpness number 5 is not 0"},
        {kQuad + "as 9999999999 1\n", {}, "m.obj:6: fs and as lines stand for more faces than the 1 of the model"},
        {kQuad, {"--scheme", "loop"}, "m.obj:5: the face has 4 vertices; Loop"},
        {kQuad + "f 1 2 3\n", {"--scheme", "loop"}, "m.obj:5: the face has 4 vertices; Loop"},
        {kQuad + "f 1 2 3\n", {"--level", "0"}, "level is 0, but the mesh has faces other than quads"},
        {fan, {"--level", "1"}, "m.obj: vertex 0 has more than 65535"},
        {"v 0 0 " + std::string(10'000'000, 'x'), {}, "m.obj:1: '" + std::string(40, 'x') + "...' is not a number"},
        {"\x7f"
         "ELF\x02\x01\x01",
         {},
         "m.obj: has no face (a line that begins with f): it is no OBJ model"},
        {std::string(1000, '\0'), {}, "m.obj: has no face (a line that begins with f): it is no OBJ model"},
        {"f 1 2 3\n", {}, "m.obj:1: no vertex has the index 1 (counted from 1): the file has 0"},
    };
    TemporaryFolder const folder;
    std::string const model = folder.File("m.obj");
    for (Case const& c : cases) {
        WriteBytes(model, c.text);
        Words words = {model, "-o", folder.File("out.ply"), "--report", folder.File("out.json")};
        words.insert(words.end(), c.options.begin(), c.options.end());
        ExpectRefused(words, c.part);
        EXPECT_EQ(folder.NumFiles(), 1U) << c.part;
    }
}

TEST(HostileTool, FilesThatAreNoneAreRefusedWithTheSystemsReason) {
    TemporaryFolder const folder;
    std::string const model = folder.File("m.obj");
    WriteBytes(model, kQuad);
    fs::create_symlink("loop", folder.File("loop"));
    fs::create_symlink("nowhere", folder.File("dangling"));
    std::string const longName(300, 'n'), out = folder.File("out.ply");
    ExpectRefused({folder.File("loop"), "-o", out}, "Too many levels of symbolic links");
    ExpectRefused({folder.File("dangling"), "-o", out}, "No such file or directory");
    ExpectRefused({folder.File(longName), "-o", out}, "File name too long");
    ExpectRefused({model + "/m.obj", "-o", out}, "Not a directory");
    ExpectRefused({"/dev/null", "-o", out}, "/dev/null: has no face");
    ExpectRefused({folder.File("a\nb.obj"), "-o", out}, "a b.obj");
    ExpectRefused({model, "--sharpness", folder.Path(), "-o", out}, "it is a folder, not a file");
    ExpectRefused({model, "--sharpness", model, "-o", out}, "m.obj: has no fs or as line: it is no .sharp file");
    ExpectRefused({model, "--sharpness", folder.File("loop"), "-o", out}, "Too many levels of symbolic links");
    ExpectRefused({model, "-o", folder.File(longName + ".ply")}, "File name too long");
    ExpectRefused({model, "-o", model + "/out.ply"}, "Not a directory");
    ExpectRefused({model, "-o", folder.File("loop/out.ply")}, "Too many levels of symbolic links");
    ExpectRefused({model, "--report", folder.File("loop")}, "Too many levels of symbolic links");
    ExpectRefused({model, "--level", std::string(100000, '9')}, "--level");
    EXPECT_EQ(folder.NumFiles(), 3U);

    Outcome const piped =
        RunShell("cat " + Quoted(model) + " | " + CommandOf({"/dev/stdin", "-o", out, "--quiet"}));
    EXPECT_EQ(piped.status, 0) << piped.error;
    EXPECT_TRUE(fs::exists(out));
}

TEST(HostileTool, AFullDiskLeavesTheOldFileAndNothingElse) {
    // 4 blocks of 512 or of 1024 bytes, by shell: less than any of these files.
    for (Words const& words : {Words{"out.ply"}, Words{"out.ply", "--ascii"}, Words{"out.obj"}, Words{"out.usda"},
                               Words{"out.usda", "--cage"}, Words{"out.ply", "--check"}}) {
        for (bool const isThere : {true, false}) {
            TemporaryFolder const folder;
            std::string const out = folder.File(words[0]);
            if (isThere) WriteBytes(out, "old");
            Words all = {ModelPath("mug"), "--quiet", "-o", out};
            all.insert(all.end(), words.begin() + 1, words.end());
            Outcome const outcome = RunShell("ulimit -f 4; " + CommandOf(all));
            EXPECT_EQ(outcome.status, 2) << CommandOf(all);
            EXPECT_EQ(outcome.error, "osd_shade: error: " + out + ": can't be written: File too large\n");
            EXPECT_EQ(folder.NumFiles(), isThere ? 1U : 0U);
            if (isThere) {
                EXPECT_EQ(ReadBytes(out), "old");
            }
        }
    }
    TemporaryFolder const folder;
    std::string const report = folder.File("report.json");
    Outcome const outcome =
        RunShell("ulimit -f 1; " + CommandOf({ModelPath("mug"), "--quiet", "--report", report}));
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(outcome.error, "osd_shade: error: " + report + ": can't be written: File too large\n");
    EXPECT_EQ(folder.NumFiles(), 0U);
}

constexpr char kNeedsAddresses[] = "sanitizers take more addresses than any such limit";

/// The least limit of addresses in KiB, to a sixteenth, under which the program still says its version.
int LeastAddresses() {
    int kibi = 1 << 13;
    while (RunShell("ulimit -v " + std::to_string(kibi) + "; " + CommandOf({"--version"})).status != 0) {
        kibi += kibi / 16;
    }
    return kibi;
}

TEST(HostileTool, TooFewAddressesAreAnErrorInOneLineAndLeaveNoFile) {
    if (osd_shading::tests::IsSanitizerRun()) GTEST_SKIP() << kNeedsAddresses;
    int const least = LeastAddresses();
    std::string const outOfMemory = "osd_shade: error: out of memory; a lower --level takes a quarter\n";
    // Memory that the estimates allow, so that it is the system that refuses.
    for (Words const& words : {Words{"mug", "out.ply", "--level", "5"},
                               Words{"mug", "out.usda", "--level", "4", "--cage", "--threads", "4"},
                               Words{"mug", "out.obj", "--level", "4", "--check"},
                               Words{"axe", "out.ply", "--level", "4", "--frames", "2", "--precision", "float"},
                               Words{"hat", "out.ply", "--level", "4", "--scheme", "loop", "--stats"}}) {
        TemporaryFolder const folder;
        std::string const out = folder.File(words[1]);
        Words all = {ModelPath(words[0]), "--quiet", "--memory-limit", "1T", "-o", out};
        all.insert(all.end(), words.begin() + 2, words.end());
        int numFailures = 0;
        bool isDone = false;
        for (int kibi = least; !isDone && kibi < (1 << 23); kibi += kibi / 8) {
            Outcome const outcome = RunShell("ulimit -v " + std::to_string(kibi) + "; " + CommandOf(all));
            isDone = outcome.status == 0;
            EXPECT_EQ(folder.NumFiles(), isDone ? 1U : 0U) << kibi << " KiB: " << CommandOf(all);
            if (isDone) break;
            ++numFailures;
            EXPECT_EQ(outcome.status, 2) << kibi << " KiB: " << CommandOf(all) << "\n" << outcome.error;
            EXPECT_EQ(outcome.error, outOfMemory) << kibi << " KiB: " << CommandOf(all);
        }
        EXPECT_TRUE(isDone) << CommandOf(all);
        EXPECT_GE(numFailures, 1) << CommandOf(all);
    }
}

TEST(HostileTool, AnEndlessModelEndsWithTheMemory) {
    if (osd_shading::tests::IsSanitizerRun()) GTEST_SKIP() << kNeedsAddresses;
    TemporaryFolder const folder;
    Outcome const outcome =
        RunShell("ulimit -v 300000; " + CommandOf({"/dev/zero", "--quiet", "-o", folder.File("out.ply")}));
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(outcome.NumErrorLines(), 1U) << outcome.error;
    EXPECT_NE(outcome.error.find("out of memory"), std::string::npos) << outcome.error;
    EXPECT_EQ(folder.NumFiles(), 0U);
}

}  // namespace
