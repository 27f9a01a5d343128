// SPDX-License-Identifier: Apache-2.0

// The program osd_shade, run as people run it.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/ioFiles.h"
#include "tests/toolProgram.h"

namespace {

namespace fs = std::filesystem;
using ioFiles::ReadBytes;
using ioFiles::TemporaryFolder;
using ioFiles::WriteBytes;
using nlohmann::json;
using namespace toolProgram;

/// Runs the program with a report, and returns that; fails the test where the program does.
json ReportOf(Words words) {
    TemporaryFolder const folder;
    words.insert(words.end(), {"--quiet", "--report", folder.File("report.json")});
    Outcome const outcome = RunTool(words);
    EXPECT_EQ(outcome.status, 0) << CommandOf(words) << "\n" << outcome.error;
    return json::parse(ReadBytes(folder.File("report.json")), nullptr, false);
}

constexpr char kOneQuad[] = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST(CommandLine, CountsACubeByHand) {
    // Level 2 of a cube: 6 * 16 faces, and by Euler 98 vertices, of which the 8 corners have valence 3.
    json const report = ReportOf({ModelPath("cube_uvs"), "--level", "2", "--crease-scale", "0"});
    EXPECT_EQ(report["faces"], 96);
    EXPECT_EQ(report["vertices"], 98);
    EXPECT_EQ(report["values"], 98);
    EXPECT_EQ(report["extraordinary"], json({{"3", 8}}));
    EXPECT_EQ(report["boundary_extraordinary"], json::object());
}

TEST(CommandLine, TakesEachValueOfEachOptionAndReportsIt) {
    struct Choice {
        std::string option, key;
        Words values;
    };
    std::vector<Choice> const choices = {
        {"--normals-from", "normals_from", {"0", "1", "2"}},
        {"--weights-from", "weights_from", {"0", "1", "2"}},
        {"--sharp-vertices", "sharp_vertices", {"zero", "smooth", "per-region"}},
        {"--darts", "darts", {"smooth", "sharp"}},
        {"--weights", "weights", {"one-ring", "ev-only", "bilinear", "inverse-limit", "one"}},
        {"--exponent", "exponent", {"0.5", "1", "+2", "1e1"}},
        {"--start-normals", "start_normals", {"uniform", "corner-area", "angle", "limit", "limit-smoothed"}},
        {"--averaging", "averaging", {"linear", "renormalised", "spherical"}},
        {"--limit-normals", "limit_normals", {"limit", "face-average", "exact"}},
        {"--positions", "positions", {"limit", "refined"}},
        {"--boundary", "boundary", {"none", "edge-only", "edge-and-corner"}},
        {"--creasing", "creasing", {"uniform", "chaikin"}},
        {"--precision", "precision", {"float", "double"}},
        {"--triangles", "triangles", {"catmark", "smooth"}},
        {"--spherical-steps", "spherical_steps", {"0", "3", "100"}},
    };
    for (Choice const& choice : choices) {
        for (std::string const& value : choice.values) {
            json const report = ReportOf({ModelPath("tetrahedron_dart"), "--level", "2", choice.option, value});
            json const& told = report["options"][choice.key];
            if (told.is_number()) {
                EXPECT_EQ(told.get<double>(), std::stod(value)) << choice.option;
            } else {
                EXPECT_EQ(told, value) << choice.option;
            }
        }
    }
    for (char const* scheme : {"catmark", "loop"}) {
        EXPECT_EQ(ReportOf({ModelPath("tetrahedron_dart"), "--scheme", scheme})["scheme"], scheme);
    }
    for (char const* level : {"1", "2", "3", "4", "5"}) {
        json const report = ReportOf({ModelPath("tetrahedron_dart"), "--scheme", "loop", "--level", level});
        EXPECT_EQ(report["level"], std::stoi(level));
        EXPECT_EQ(report["faces"], 4 << (2 * std::stoi(level)));
    }
    for (char const* threads : {"0", "1", "2"}) ReportOf({ModelPath("cube_dart"), "--threads", threads});
    for (char const* limit : {"1000000000", "1000000K", "1000m", "1G", "1T"}) {
        ReportOf({ModelPath("cube_dart"), "--memory-limit", limit});
    }
}

TEST(CommandLine, DefaultsAreThePapersRecommendation) {
    json const report = ReportOf({ModelPath("cube_dart")});
    EXPECT_EQ(report["scheme"], "catmark");
    EXPECT_EQ(report["level"], 4);
    json const expected = {{"normals_from", 1},          {"weights_from", 1},      {"sharp_vertices", "zero"},
                           {"darts", "smooth"},          {"weights", "one-ring"},  {"exponent", 1.0},
                           {"start_normals", "uniform"}, {"averaging", "linear"},  {"spherical_steps", 3},
                           {"limit_normals", "limit"},   {"positions", "limit"},   {"boundary", "edge-and-corner"},
                           {"creasing", "uniform"},      {"triangles", "catmark"}, {"precision", "double"}};
    EXPECT_EQ(report["options"], expected);
    EXPECT_EQ(ReportOf({ModelPath("cube_dart"), "--preset", "paper"})["options"], expected);
}

TEST(CommandLine, AGivenOptionWinsOverThePresetWhateverTheirOrder) {
    json const smooth = ReportOf({ModelPath("cube_dart"), "--preset", "smooth"})["options"];
    EXPECT_EQ(smooth["start_normals"], "limit-smoothed");
    EXPECT_EQ(smooth["normals_from"], 2);
    EXPECT_EQ(smooth["weights"], "one");
    EXPECT_EQ(ReportOf({ModelPath("cube_dart"), "--preset", "smooth", "--level", "1"})["options"]["normals_from"],
              1);

    for (Words const& words :
         {Words{"--preset", "smooth", "--start-normals", "angle", "--normals-from", "0", "--weights", "ev-only"},
          Words{"--start-normals", "angle", "--normals-from", "0", "--weights", "ev-only", "--preset", "smooth"}}) {
        Words all = {ModelPath("cube_dart")};
        all.insert(all.end(), words.begin(), words.end());
        json const options = ReportOf(all)["options"];
        EXPECT_EQ(options["start_normals"], "angle");
        EXPECT_EQ(options["normals_from"], 0);
        EXPECT_EQ(options["weights"], "ev-only");
    }
}

TEST(CommandLine, RefusesBadValuesInOneLineThatNamesTheOption) {
    struct Case {
        Words words;
        std::string part;
    };
    std::vector<Case> const cases = {
        {{"--level", "16"}, "--level: '16'"},
        {{"--level", "-1"}, "--level: '-1'"},
        {{"--level", "2.5"}, "--level: '2.5'"},
        {{"--level", "0x2"}, "--level"},
        {{"--level", "99999999999999999999"}, "--level"},
        {{"--level", ""}, "--level"},
        {{"--level"}, "--level"},
        {{"--level", "2", "--level", "3"}, "--level"},
        {{"--level", "2", "--normals-from", "3"}, "--normals-from: 3 lies above the last level, 2"},
        {{"--level", "2", "--weights-from", "3"}, "--weights-from: 3 lies above the last level, 2"},
        {{"--normals-from", "-1"}, "--normals-from"},
        {{"--tessellate", "0"}, "--tessellate: '0' is not screen, curvature or a number from 1 to 1024"},
        {{"--tessellate", "1025"}, "--tessellate: '1025'"},
        {{"--tessellate", "smooth"}, "--tessellate: 'smooth'"},
        {{"--tessellate"}, "--tessellate"},
        {{"--max-angle", "5"}, "--max-angle: nothing is tessellated"},
        {{"--tessellate", "curvature", "--max-angle", "0"}, "--max-angle"},
        {{"--tessellate", "screen", "--max-angle", "5"}, "--max-angle: goes with --tessellate curvature"},
        {{"--tessellate", "4", "--max-pixels", "5"}, "--max-pixels: goes with --tessellate screen"},
        {{"--tessellate", "screen", "--eye", "1,2"}, "--eye: '1,2' is not a point X,Y,Z"},
        {{"--tessellate", "screen", "--eye", "1,2,inf"}, "--eye"},
        {{"--tessellate", "curvature", "--eye", "1,2,3"}, "--eye: goes with --tessellate screen"},
        {{"--tessellate", "4", "--check"}, "--check: needs a uniform level"},
        {{"--tessellate", "4", "--frames", "2"}, "--frames: needs a uniform level"},
        {{"--tessellate", "4", "--positions", "refined"}, "limit positions only"},
        {{"--tessellate", "4", "--level", "11"}, "at most 10"},
        {{"--exponent", "0"}, "--exponent: '0'"},
        {{"--exponent", "-2"}, "--exponent: '-2'"},
        {{"--exponent", "nan"}, "--exponent: 'nan'"},
        {{"--exponent", "inf"}, "--exponent"},
        {{"--exponent", "1x"}, "--exponent"},
        {{"--scheme", "bilinear"}, "--scheme: 'bilinear' is not one of catmark|loop"},
        {{"--sharp-vertices", "B"}, "--sharp-vertices"},
        {{"--darts", "none"}, "--darts"},
        {{"--weights", "onering"}, "--weights"},
        {{"--start-normals", "user"}, "--start-normals"},
        {{"--preset", "rough"}, "--preset"},
        {{"--averaging", "cubic"}, "--averaging"},
        {{"--limit-normals", "precise"}, "--limit-normals"},
        {{"--positions", "control"}, "--positions"},
        {{"--boundary", "corner"}, "--boundary"},
        {{"--creasing", "Chaikin"}, "--creasing"},
        {{"--precision", "half"}, "--precision"},
        {{"--triangles", "loop"}, "--triangles"},
        {{"--spherical-steps", "-1"}, "--spherical-steps"},
        {{"--threads", "-1"}, "--threads"},
        {{"--threads", "many"}, "--threads"},
        {{"--crease-angle", "181"}, "--crease-angle"},
        {{"--crease-angle", "nan"}, "--crease-angle"},
        {{"--crease-scale", "-1"}, "--crease-scale"},
        {{"--crease-scale", "inf"}, "--crease-scale"},
        {{"--tolerance", "nan", "--check"}, "--tolerance"},
        {{"--tolerance", "-1", "--check"}, "--tolerance"},
        {{"--memory-limit", "0"}, "--memory-limit"},
        {{"--memory-limit", "-5"}, "--memory-limit"},
        {{"--memory-limit", "1.5G"}, "--memory-limit"},
        {{"--memory-limit", "99999999999T"}, "--memory-limit"},
        {{"--start-normals", "file", "--normals-from", "1"}, "--normals-from"},
        {{"--colour", "red"}, "--colour"},
        {{"--frames", "0"}, "--frames: '0'"},
        {{"--frames", "1000001"}, "--frames"},
        {{"--frames", "2", "--deform", "melt"}, "--deform: 'melt' is not one of bend|twist|wave"},
        {{"--deform", "bend"}, "--deform: there are no frames"},
        {{"--frames", "2", "--averaging", "spherical"}, "--averaging"},
        {{"--stats", "--averaging", "renormalised"}, "--averaging"},
        {{"another.obj"}, "another.obj"},
        {{"--ascii"}, "--ascii"},
        {{"--cage"}, "--cage"},
        {{"-o"}, "-o"},
        {{"-o", ""}, "-o"},
    };
    for (Case const& bad : cases) {
        Words words = {ModelPath("cube_dart")};
        words.insert(words.end(), bad.words.begin(), bad.words.end());
        ExpectRefused(words, bad.part);
    }
    ExpectRefused({}, "MODEL");
}

TEST(CommandLine, RefusesAnUnknownEndingBeforeItReadsTheModel) {
    ExpectRefused({"absent.obj", "-o", "out.stl"}, "out.stl");
    ExpectRefused({"absent.obj", "-o", "out"}, ".ply, .obj or .usda");
    ExpectRefused({"absent.obj", "-o", "out.ply"}, "absent.obj");
    ExpectRefused({"absent.obj", "-o", "out.obj", "--ascii"}, "--ascii");
    ExpectRefused({"absent.obj", "-o", "out.ply", "--cage"}, "--cage");
}

TEST(CommandLine, PrintsHelpWithEveryOptionAndTheVersion) {
    Outcome const help = RunTool({"--help"});
    EXPECT_EQ(help.status, 0);
    for (char const* option : {"--scheme",          "--level",        "--normals-from", "--weights-from",
                               "--sharp-vertices",  "--darts",        "--weights",      "--exponent",
                               "--start-normals",   "--preset",       "--averaging",    "--limit-normals",
                               "--positions",       "--boundary",     "--creasing",     "--sharpness",
                               "--crease-angle",    "--crease-scale", "--precision",    "--triangles",
                               "--spherical-steps", "--threads",      "--check",        "--tolerance",
                               "--ascii",           "--cage",         "--report",       "--quiet",
                               "--memory-limit",    "--frames",       "--deform",       "--stats",
                               "--tessellate",      "--max-angle",    "--max-pixels",   "--eye",
                               "--version"}) {
        EXPECT_NE(help.out.find(option), std::string::npos) << option;
    }
    Outcome const version = RunTool({"--version"});
    EXPECT_EQ(version.status, 0);
    EXPECT_EQ(version.out.rfind("osd_shade ", 0), 0U) << version.out;
}

TEST(CommandLine, TagsOfTheFileHoldUntilAnOptionIsGiven) {
    TemporaryFolder const folder;
    std::string const model = folder.File("tagged.obj");
    WriteBytes(model, std::string(kOneQuad) +
                          "f 1 2 3 4\nt interpolateboundary 1/0/0 2\nt creasemethod 0/0/1 chaikin\n"
                          "t smoothtriangles 0/0/1 smooth\n");
    json options = ReportOf({model})["options"];
    EXPECT_EQ(options["boundary"], "edge-only");
    EXPECT_EQ(options["creasing"], "chaikin");
    EXPECT_EQ(options["triangles"], "smooth");

    options = ReportOf({model, "--boundary", "edge-and-corner"})["options"];
    EXPECT_EQ(options["boundary"], "edge-and-corner");
    EXPECT_EQ(options["creasing"], "chaikin");
    options = ReportOf({model, "--creasing", "uniform", "--triangles", "catmark"})["options"];
    EXPECT_EQ(options["boundary"], "edge-only");
    EXPECT_EQ(options["creasing"], "uniform");
    EXPECT_EQ(options["triangles"], "catmark");
}

TEST(CommandLine, SharpnessComesFromFilesAnglesAndScales) {
    TemporaryFolder const folder;
    std::string const cube = ModelPath("cube_uvs");  // a crease of 2 round its top: gone at level 2
    EXPECT_EQ(ReportOf({cube, "--level", "1"})["sharp_vertices"], 8);
    EXPECT_EQ(ReportOf({cube, "--level", "2"})["sharp_vertices"], 0);
    EXPECT_EQ(ReportOf({cube, "--level", "2", "--crease-scale", "2"})["sharp_vertices"], 16);
    // All 12 edges of a cube turn by 90 degrees: at level 1 they hold 8 + 12 vertices.
    EXPECT_EQ(ReportOf({cube, "--level", "1", "--crease-angle", "89"})["sharp_vertices"], 20);
    EXPECT_EQ(ReportOf({cube, "--level", "1", "--crease-angle", "91"})["sharp_vertices"], 8);
    WriteBytes(folder.File("round.sharp"), "as 6 0\n");
    EXPECT_EQ(ReportOf({cube, "--level", "1", "--sharpness", folder.File("round.sharp")})["sharp_vertices"], 0);
    WriteBytes(folder.File("first.sharp"), "fs 4 4 4 4\n");
    EXPECT_EQ(ReportOf({cube, "--level", "1", "--sharpness", folder.File("first.sharp")})["sharp_vertices"], 8);
    WriteBytes(folder.File("bad.sharp"), "fs 4 -4\n");
    ExpectRefused({cube, "--sharpness", folder.File("bad.sharp")}, "bad.sharp:1");
    ExpectRefused({cube, "--sharpness", folder.File("absent.sharp")}, "absent.sharp");
}

TEST(CommandLine, StartNormalsComeFromTheFileAndAMissingOneNamesTheFace) {
    TemporaryFolder const folder;
    std::string const model = folder.File("normals.obj"), out = folder.File("out.obj");
    // Two faces bent along y, all with the normal (0.6, 0, 0.8), of another length in each corner.
    std::string const points = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 1\nv 2 1 1\nvn .6 0 .8\nvn 3 0 4\n";
    WriteBytes(model, points + "f 1//1 2//2 3//1 4//2\nf 2//2 5//2 6//2 3//1\n");
    for (char const* precision : {"float", "double"}) {
        Outcome const outcome = RunTool({model, "--start-normals", "file", "--weights", "one", "--level", "3",
                                         "--precision", precision, "-o", out, "--quiet"});
        EXPECT_EQ(outcome.status, 0) << outcome.error;
        std::istringstream lines(ReadBytes(out));
        std::string word;
        int numNormals = 0;
        for (std::string line; std::getline(lines, line);) {
            std::istringstream words(line);
            double x = 0, y = 0, z = 0;
            if (!(words >> word >> x >> y >> z) || word != "vn") continue;
            ++numNormals;
            EXPECT_NEAR(x, 0.6, 1e-6);
            EXPECT_NEAR(y, 0.0, 1e-6);
            EXPECT_NEAR(z, 0.8, 1e-6);
        }
        EXPECT_GT(numNormals, 0);
    }
    EXPECT_EQ(ReportOf({model, "--start-normals", "file"})["options"]["normals_from"], 0);
    EXPECT_EQ(ReportOf({model, "--start-normals", "file", "--normals-from", "0"})["options"]["normals_from"], 0);
    EXPECT_EQ(ReportOf({model, "--preset", "smooth", "--start-normals", "file"})["options"]["weights"], "one");

    WriteBytes(model, points + "f 1//1 2//2 3//1 4//2\nf 2//2 5 6//2 3//1\n");
    ExpectRefused({model, "--start-normals", "file"}, ": the face has a corner without a normal");
    ExpectRefused({ModelPath("cube_dart"), "--start-normals", "file"}, ": the face has a corner without a normal");
}

TEST(CommandLine, BadModelsAreRefusedInOneLineThatNamesTheFile) {
    TemporaryFolder const folder;
    std::string const model = folder.File("bad.obj");
    for (auto const& [text, part] : std::vector<std::pair<std::string, std::string>>{
             {"", "bad.obj"},
             {"v 1 2\n", "bad.obj:1"},
             {"v 0 0 nan\n", "bad.obj:1"},
             {std::string(kOneQuad) + "f 1 2 9\n", "bad.obj:5"},
             {std::string(kOneQuad) + "f 1 2\n", "bad.obj:5"},
             {std::string(kOneQuad) + "f 1 2 2\n", "bad.obj:5"},
             {std::string(100000, '\1'), "bad.obj"},
         }) {
        WriteBytes(model, text);
        ExpectRefused({model}, part);
    }
    ExpectRefused({folder.Path()}, folder.Path());
    ExpectRefused({""}, "MODEL");
    ExpectRefused({ModelPath("mug"), "--scheme", "loop"}, "mug.obj:454: the face has 4 vertices; Loop");
    ExpectRefused({ModelPath("pencil_ngons"), "--level", "0"}, "level");
}

TEST(CommandLine, NumbersTooLargeForFloatAreNamedAndNeverInTheResult) {
    TemporaryFolder const folder;
    std::string const model = folder.File("large.obj"), out = folder.File("large.obj.obj");
    std::string const face = "f 1/1/1 2/2/1 3/1/1 4/2/1\n", rest = "vt 0 0\nvt 1 0\nvn 0 0 1\n";
    Words const inFloat = {model, "--precision", "float", "--start-normals", "file", "-o", out};
    for (auto const& [text, part] : std::vector<std::pair<std::string, std::string>>{
             {"v 0 0 0\nv 1 0 0\nv 1e99 1 0\nv 0 1 0\n" + rest + face, "the position of vertex 2 (from 0)"},
             {std::string(kOneQuad) + "vt 0 0\nvt 1 1e39\nvn 0 0 1\n" + face, "vt 1 (from 0)"},
             {std::string(kOneQuad) + "vt 0 0\nvt 1 0\nvn 0 0 -1e39\n" + face, "vn 0 (from 0)"},
         }) {
        WriteBytes(model, text);
        ExpectRefused(inFloat, part);
        EXPECT_EQ(RunTool({model, "-o", out, "--quiet"}).status, 0);  // double holds them
        fs::remove(out);
    }
}

TEST(CommandLine, ReportsWarningsOfTheReaderOneALine) {
    TemporaryFolder const folder;
    std::string const model = folder.File("odd.obj");
    WriteBytes(model, std::string(kOneQuad) + "vt 0 0\nstrange words\nf 1/1 2/1 3/1 4\n");
    Outcome const outcome = RunTool({model, "--quiet", "-o", folder.File("out.ply")});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.NumErrorLines(), 2U) << outcome.error;
    EXPECT_NE(outcome.error.find("odd.obj:6"), std::string::npos) << outcome.error;
    EXPECT_NE(outcome.error.find("texture coordinates are left out"), std::string::npos) << outcome.error;
    EXPECT_EQ(ReadBytes(folder.File("out.ply")).find("property float s\n"), std::string::npos);
}

TEST(Report, HasExactlyTheKeysThatScriptsRelyOn) {
    json const report = ReportOf({ModelPath("letter_a_dart"), "--check"});
    for (char const* key :
         {"vertices", "faces", "values", "sharp_vertices", "darts", "boundary_vertices", "vertices_with_weight",
          "zero_normals", "fallback_normals", "averaged_normals", "opposed_normals", "peak_bytes"}) {
        EXPECT_TRUE(report[key].is_number_integer()) << key;
    }
    for (char const* key : {"min_subdivided_length", "mean_angle_deg", "max_angle_deg"}) {
        EXPECT_TRUE(report[key].is_number()) << key;
    }
    EXPECT_TRUE(report["extraordinary"].is_object());
    EXPECT_TRUE(report["boundary_extraordinary"].is_object());
    EXPECT_GT(report["darts"], 0);
    EXPECT_GT(report["peak_bytes"], 1000000);
    EXPECT_GT(report["seconds"]["total"], 0.0);
    EXPECT_TRUE(report["seconds"].contains("reading"));
    for (auto const& [stage, seconds] : report["seconds"].items()) {
        EXPECT_GE(seconds, 0.0);
        EXPECT_EQ(stage.find_first_not_of("abcdefghijklmnopqrstuvwxyz_0123456789"), std::string::npos) << stage;
    }

    json const& check = report["check"];
    EXPECT_EQ(check["passed"], true);
    EXPECT_EQ(check["tolerance"], 1e-12);
    EXPECT_GT(check["model_size"], 1.0);
    for (char const* name : {"stencils", "limit", "bfr", "limit_normals"}) {
        json const& comparison = check["comparisons"][name];
        EXPECT_GT(comparison["compared"], 0) << name;
        EXPECT_LE(comparison["compared"], comparison["total"]) << name;
        EXPECT_LE(comparison["largest"], 1e-9) << name;
    }
    EXPECT_TRUE(ReportOf({ModelPath("letter_a_dart")})["check"].is_null());
}

TEST(Report, HasNoSmallestLengthWhereNoVertexHasWeight) {
    TemporaryFolder const folder;
    WriteBytes(folder.File("quad.obj"), std::string(kOneQuad) + "f 1 2 3 4\n");
    json const report = ReportOf({folder.File("quad.obj")});
    EXPECT_EQ(report["vertices_with_weight"], 0);
    EXPECT_TRUE(report["min_subdivided_length"].is_null());
    EXPECT_EQ(report["boundary_vertices"], 64);
}

TEST(Report, LeavesHolesOutOfTheFaces) {
    EXPECT_EQ(ReportOf({ModelPath("cube_hole"), "--level", "1"})["faces"], 4 * 53);
}

TEST(Report, TableSaysTheSameAsTheJsonAndIsAbsentWhenQuiet) {
    TemporaryFolder const folder;
    std::string const path = folder.File("report.json");
    Outcome const loud = RunTool({ModelPath("mug"), "--level", "2", "--report", path, "--check"});
    json const report = json::parse(ReadBytes(path));
    EXPECT_EQ(loud.status, 0);
    EXPECT_EQ(loud.error, "");
    for (std::string const& part :
         {std::string("16 (8 of valence 3, 8 of valence 5)"), report["vertices_with_weight"].dump(),
          "at vertex " + report["max_angle_vertex"].dump(), std::string("passed"), std::string("peak memory")}) {
        EXPECT_NE(loud.out.find(part), std::string::npos) << part << " is not in\n" << loud.out;
    }
    EXPECT_EQ(RunTool({ModelPath("mug"), "--level", "2", "--quiet", "--check"}).out, "");
}

TEST(Report, IsTheSameForAnyNumberOfThreadsButForTimeAndMemory) {
    json one = ReportOf({ModelPath("ring"), "--threads", "1"});
    json two = ReportOf({ModelPath("ring"), "--threads", "2"});
    for (json* report : {&one, &two}) {
        report->erase("seconds");
        report->erase("peak_bytes");
    }
    EXPECT_EQ(one, two);
}

TEST(Frames, AreTimedAndTheirTableIsCounted) {
    for (char const* deform : {"bend", "twist", "wave"}) {
        json const report = ReportOf({ModelPath("mug"), "--level", "3", "--frames", "5", "--deform", deform});
        json const& frames = report["frames"];
        EXPECT_EQ(frames["count"], 5);
        EXPECT_EQ(frames["deform"], deform);
        EXPECT_GE(frames["threads"], 1);
        EXPECT_FALSE(frames["instruction_set"].get<std::string>().empty());
        EXPECT_GT(frames["ms_min"], 0.0);
        EXPECT_LE(frames["ms_min"], frames["ms_median"]);
        EXPECT_NEAR(frames["ns_per_value_min"].get<double>(),
                    1e6 * frames["ms_min"].get<double>() / report["values"].get<double>(), 1e-6);
        EXPECT_LE(frames["ns_per_value_min"], frames["ns_per_value_median"]);
        EXPECT_EQ(frames["zero_start_normals"], 0);
        EXPECT_TRUE(frames["fallback_normals"].is_number_integer());

        json const& table = report["table"];
        EXPECT_EQ(table["values"], report["values"]);
        EXPECT_EQ(table["faces"], report["faces"]);
        for (char const* key : {"tiles", "classes", "blended_tiles", "blended_values", "dense_matrices",
                                "start_normals", "bytes", "dictionary_bytes"}) {
            EXPECT_GT(table[key], 0) << key;
        }
        EXPECT_LE(table["regular_tiles"], table["tiles"]);
        EXPECT_GT(table["build_seconds"], 0.0);
    }
    EXPECT_EQ(ReportOf({ModelPath("mug"), "--frames", "1", "--threads", "2"})["frames"]["threads"], 2);
    json const normals =
        ReportOf({ModelPath("cube_dart"), "--frames", "1", "--scheme", "catmark", "--preset", "smooth"});
    EXPECT_EQ(normals["table"]["blended_values"], normals["values"]);
}

TEST(Tessellation, IsReportedAndWrittenAsTriangles) {
    json const uniform = ReportOf({ModelPath("cube_dart"), "--tessellate", "4"});
    EXPECT_EQ(uniform["faces"], 6 * 4 * 4 * 2);
    EXPECT_EQ(uniform["vertices"], 8 + 12 * 3 + 6 * 9);
    // Eight corners, one of which is a crease vertex; three points on each of three edges that are creases.
    EXPECT_EQ(uniform["extraordinary"], json({{"3", 8}}));
    EXPECT_EQ(uniform["sharp_vertices"], 1 + 3 * 3);
    EXPECT_EQ(uniform["darts"], 4);
    EXPECT_TRUE(uniform["fallback_normals"].is_null());
    EXPECT_GT(uniform["seconds"]["tessellation"], 0.0);
    json const coarse = ReportOf({ModelPath("mug"), "--tessellate", "curvature", "--max-angle", "20"}),
               fine = ReportOf({ModelPath("mug"), "--tessellate", "curvature", "--max-angle", "5"});
    EXPECT_GT(fine["faces"], 4 * coarse["faces"].get<int>());
    // From far away it is small on the screen.
    json const near = ReportOf({ModelPath("mug"), "--tessellate", "screen"}),
               far = ReportOf({ModelPath("mug"), "--tessellate", "screen", "--eye", "0,0,900"});
    EXPECT_GT(near["faces"], 4 * far["faces"].get<int>());

    TemporaryFolder const folder;
    Outcome const written = RunTool({ModelPath("mug"), "--tessellate", "curvature", "-o", folder.File("mug.obj")});
    EXPECT_EQ(written.status, 0) << written.error;
    // What is written is a mesh that can be read.
    json const again = ReportOf({folder.File("mug.obj"), "--scheme", "loop", "--level", "1"});
    json const first = ReportOf({ModelPath("mug"), "--tessellate", "curvature"});
    EXPECT_EQ(again["faces"], 4 * first["faces"].get<int>());
}

TEST(Frames, StatsAloneBuildTheTable) {
    json const report = ReportOf({ModelPath("ring"), "--stats"});
    EXPECT_TRUE(report["frames"].is_null());
    EXPECT_EQ(report["table"]["values"], report["values"]);
    json const plain = ReportOf({ModelPath("ring")});
    EXPECT_TRUE(plain["table"].is_null());
    EXPECT_TRUE(plain["frames"].is_null());
    Outcome const printed = RunTool({ModelPath("ring"), "--stats", "--frames", "2", "--threads", "1"});
    for (char const* part :
         {"classes", "tiles", "support", "bytes a value", "2, bend, 1 thread", "median", "least"}) {
        EXPECT_NE(printed.out.find(part), std::string::npos) << part << " is not in\n" << printed.out;
    }
}

TEST(Check, PassesOnAllOurModelsInBothPrecisions) {
    int numModels = 0;
    for (std::string const& file : ioFiles::OwnModels()) {
        ++numModels;
        for (char const* precision : {"float", "double"}) {
            json const report = ReportOf({file, "--level", "3", "--check", "--precision", precision});
            EXPECT_EQ(report["zero_normals"], 0) << file;
        }
    }
    EXPECT_GE(numModels, 18);
}

TEST(Check, AFailureIsStatusThreeAfterTheResultIsWritten) {
    TemporaryFolder const folder;
    std::string const out = folder.File("out.ply"), path = folder.File("report.json");
    Outcome const outcome =
        RunTool({ModelPath("mug"), "--check", "--tolerance", "0", "-o", out, "--report", path, "--quiet"});
    EXPECT_EQ(outcome.status, 3);
    EXPECT_EQ(outcome.NumErrorLines(), 1U) << outcome.error;
    EXPECT_GT(fs::file_size(out), 0U);
    EXPECT_EQ(json::parse(ReadBytes(path))["check"]["passed"], false);
}

TEST(OutputTarget, WritesEachFormatByItsEndingInEitherCase) {
    TemporaryFolder const folder;
    Words const common = {ModelPath("mug"), "--level", "1", "--quiet", "-o"};
    auto const written = [&](std::string const& name, Words const& more) {
        Words words = common;
        words.push_back(folder.File(name));
        words.insert(words.end(), more.begin(), more.end());
        Outcome const outcome = RunTool(words);
        EXPECT_EQ(outcome.status, 0) << outcome.error;
        return ReadBytes(folder.File(name));
    };
    std::string const binary = written("a.ply", {}), ascii = written("b.PLY", {"--ascii"});
    EXPECT_EQ(binary.rfind("ply\nformat binary_", 0), 0U);
    EXPECT_EQ(ascii.rfind("ply\nformat ascii", 0), 0U);
    EXPECT_NE(ascii.find("property float s\n"), std::string::npos);
    std::string const obj = written("c.obj", {});
    EXPECT_NE(obj.find("\nvt "), std::string::npos);
    EXPECT_NE(obj.find("\nvn "), std::string::npos);
    EXPECT_EQ(written("d.usda", {}).rfind("#usda 1.0", 0), 0U);
    EXPECT_EQ(written("d.usda", {}).find("catmullClark"), std::string::npos);
    EXPECT_NE(written("e.usda", {"--cage"}).find("catmullClark"), std::string::npos);
    // The same bytes whatever the number of threads.
    EXPECT_EQ(written("f.ply", {"--threads", "1"}), written("g.ply", {"--threads", "2"}));
}

TEST(OutputTarget, ThatCanNotBeWrittenIsRefusedAndNothingIsLeft) {
    TemporaryFolder const folder;
    std::string const model = ModelPath("cube_dart");
    ExpectRefused({model, "-o", folder.File("absent/out.ply")}, "absent/out.ply");
    ExpectRefused({model, "--report", folder.File("absent/report.json")}, "absent/report.json");
    fs::create_directory(folder.File("folder.ply"));
    ExpectRefused({model, "-o", folder.File("folder.ply")}, "folder.ply");
    EXPECT_EQ(folder.NumFiles(), 1U);
    if (geteuid() != 0) {  // root may write everything
        std::string const locked = folder.File("locked.ply");
        WriteBytes(locked, "old");
        fs::permissions(locked, fs::perms::owner_read);
        ExpectRefused({folder.File("absent.obj"), "-o", locked}, "locked.ply");  // before the model is read
        EXPECT_EQ(ReadBytes(locked), "old");
    }
    if (fs::exists("/dev/full")) {
        fs::create_symlink("/dev/full", folder.File("full.ply"));
        ExpectRefused({model, "-o", folder.File("full.ply"), "--quiet"}, "full.ply");
        ExpectRefused({model, "--report", "/dev/full", "--quiet"}, "/dev/full");
        EXPECT_EQ(RunShell(CommandOf({model}) + " > /dev/full").status, 2);
    }
}

TEST(OutputTarget, NeverReplacesTheModelNorTheReport) {
    TemporaryFolder const folder;
    std::string const model = folder.File("model.obj");
    std::string const text = std::string(kOneQuad) + "f 1 2 3 4\n";
    WriteBytes(model, text);
    ExpectRefused({model, "-o", model}, "-o");
    ExpectRefused({model, "-o", folder.File("./model.obj")}, "-o");
    ExpectRefused({model, "--report", model}, "--report");
    ExpectRefused({model, "-o", folder.File("new.ply"), "--report", folder.File("new.ply")}, "--report");
    EXPECT_EQ(ReadBytes(model), text);
    EXPECT_EQ(folder.NumFiles(), 1U);

    // Nor the other file that is read.
    std::string const sharp = folder.File("sharp.ply");
    WriteBytes(sharp, "fs 1\n");
    ExpectRefused({model, "--sharpness", sharp, "-o", sharp}, "-o");
    ExpectRefused({model, "--sharpness", sharp, "--report", sharp}, "--report");
    EXPECT_EQ(ReadBytes(sharp), "fs 1\n");
}

TEST(OutputTarget, StandardOutputHasTheResultAndTheTableGoesElsewhere) {
    Outcome outcome = RunShell(CommandOf({ModelPath("cube_dart"), "-o", "/dev/stdout", "--ascii"}) + " | cat");
    EXPECT_EQ(outcome.out.rfind("ply\nformat ascii", 0), 0U) << outcome.out.substr(0, 80);
    EXPECT_EQ(outcome.out.find("peak memory"), std::string::npos);
    EXPECT_NE(outcome.error.find("peak memory"), std::string::npos);

    outcome = RunShell(CommandOf({ModelPath("cube_dart"), "--report", "/dev/stdout"}) + " | cat");
    EXPECT_EQ(json::parse(outcome.out, nullptr, false)["level"], 4);
    EXPECT_NE(outcome.error.find("peak memory"), std::string::npos);

    outcome = RunTool({ModelPath("cube_dart"), "-o", "/dev/null"});
    EXPECT_EQ(outcome.status, 0) << outcome.error;
    EXPECT_NE(outcome.out.find("peak memory"), std::string::npos);
}

TEST(OutputTarget, AReaderThatGoesAwayIsNoFailureOfTheTableButOneOfTheResult) {
    TemporaryFolder const folder;
    auto const statusBeforeClosedPipe = [&](Words const& words) {
        // The reader is gone before the program starts.
        RunShell("{ sleep 0.2; " + CommandOf(words) + "; echo $? > " + Quoted(folder.File("status")) + "; } | :");
        return ReadBytes(folder.File("status"));
    };
    EXPECT_EQ(statusBeforeClosedPipe({ModelPath("cube_dart")}), "0\n");
    EXPECT_EQ(statusBeforeClosedPipe({ModelPath("cube_dart"), "-o", "/dev/stdout"}), "2\n");
}

TEST(OutputTarget, AnInterruptLeavesTheWholeFileOrNone) {
    TemporaryFolder const folder;
    std::string const out = folder.File("out.ply"), model = ModelPath("mug");
    ASSERT_EQ(RunTool({model, "--level", "5", "-o", out, "--quiet"}).status, 0);
    auto const size = fs::file_size(out);
    for (char const* delay : {"0.02", "0.05", "0.1", "0.15", "0.2", "0.3"}) {
        fs::remove(out);
        RunShell(CommandOf({model, "--level", "5", "-o", out, "--quiet"}) + " & p=$!; sleep " + delay +
                 "; kill -TERM $p; wait $p");
        bool const isWritten = fs::exists(out);
        EXPECT_EQ(folder.NumFiles(), isWritten ? 1U : 0U);
        if (isWritten) {
            EXPECT_EQ(fs::file_size(out), size);
        }
    }
}

TEST(Memory, ALevelThatTakesMoreThanTheLimitIsRefusedWithTheNumber) {
    ExpectRefused({ModelPath("mug"), "--level", "6", "--memory-limit", "1M"}, "1048576");
    Outcome const outcome = RunTool({ModelPath("mug"), "--level", "6", "--memory-limit", "1M"});
    // The number it would take: it has as many digits as tens of megabytes have, and more than the limit's.
    std::string digits;
    std::size_t longest = 0;
    for (char c : outcome.error + " ") {
        if (c >= '0' && c <= '9') {
            digits += c;
        } else {
            longest = std::max(longest, digits.size());
            digits.clear();
        }
    }
    EXPECT_GE(longest, 8U) << outcome.error;
    ExpectRefused({ModelPath("mug"), "--level", "15"}, "level");
}

#if defined(__SANITIZE_ADDRESS__)
#    define OSD_SHADING_HAS_SHADOW_MEMORY
#elif defined(__has_feature)
#    if __has_feature(address_sanitizer)
#        define OSD_SHADING_HAS_SHADOW_MEMORY
#    endif
#endif
#if !defined(OSD_SHADING_HAS_SHADOW_MEMORY)  // which exceeds any such limit
TEST(Memory, TheProcesssOwnLimitCounts) {
    Outcome const outcome =
        RunShell("ulimit -v 400000; " + CommandOf({ModelPath("mug"), "--level", "7", "--quiet"}));
    EXPECT_EQ(outcome.status, 2) << outcome.error;
    EXPECT_EQ(outcome.NumErrorLines(), 1U) << outcome.error;
    EXPECT_NE(outcome.error.find("limit"), std::string::npos) << outcome.error;
}
#endif

TEST(ProgressBar, IsNotDrawnWhereStandardErrorIsNoTerminal) {
    EXPECT_EQ(RunTool({ModelPath("mug"), "--level", "5"}).error, "");
}

TEST(SharedModels, AreShadedWithoutZeroNormalsWhereTheyAreManifold) {
    std::vector<std::string> const models = ioFiles::SharedModels();
    if (models.empty()) GTEST_SKIP() << ioFiles::kNoSharedModels;
    for (std::string const& model : models) {
        Outcome const outcome = RunTool({model, "--level", "2", "--quiet", "--scheme",
                                         model.find("/loop_") == std::string::npos ? "catmark" : "loop"});
        // A face with a repeated vertex is refused; nothing else is.
        if (outcome.status == 2) {
            EXPECT_NE(outcome.error.find("more than once"), std::string::npos) << outcome.error;
        } else {
            EXPECT_EQ(outcome.status, 0) << model << "\n" << outcome.error;
        }
    }
}

}  // namespace
