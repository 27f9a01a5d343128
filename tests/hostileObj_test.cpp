// SPDX-License-Identifier: Apache-2.0

// OBJ texts that nobody means well with: each with the exact words of its refusal, or with what is read and shaded.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <vector>

#include "osd_shading/io/errors.h"
#include "osd_shading/io/objReader.h"
#include "osd_shading/subdivisionShading.h"

namespace {

using namespace osd_shading;

std::string const kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
std::string const kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
std::string const kQuad = kSquare + "f 1 2 3 4\n";
std::string const kCorners = kTriangle + "vt 0 0\nvn 0 0 1\n";  // one of each: five lines

/// Shades what was read, so that nothing that a reader lets through makes trouble later.
std::string shadingOf(io::Model const& model) {
    ControlMesh const mesh = model.Mesh(model.Rules({}));
    ShadingInput<double> input;
    input.positions = {model.positions.data(), model.positions.size() / 3};
    auto const result = ShadeSubdivision(mesh, input, PaperPreset(1));
    auto const isFinite = [](Vec3<double> const& p) { return std::isfinite(p.x + p.y + p.z); };
    bool const isGood = std::all_of(result.positions.begin(), result.positions.end(), isFinite) &&
                        std::all_of(result.blendedNormals.begin(), result.blendedNormals.end(), isFinite);
    return isGood ? "" : ", shaded with NaN";
}

/// The error's words; or the counts of what was read, and its warnings.
std::string outcomeOf(std::string const& text) {
    try {
        io::Model const model = io::ParseObj(text, "m.obj");
        std::string outcome = std::to_string(model.NumVertices()) + " vertices, " +
                              std::to_string(model.NumFaces()) + " faces, " +
                              std::to_string(model.creaseSharpness.size()) + " creases, " +
                              std::to_string(model.cornerSharpness.size()) + " corners" + shadingOf(model);
        for (std::string const& warning : model.warnings) outcome += "; " + warning;
        return outcome;
    } catch (io::ParseError const& error) {
        return error.what();
    }
}

struct Case {
    char const* name;
    std::string text, expected;
};

void expectOutcomes(std::vector<Case> const& cases) {
    for (Case const& c : cases) EXPECT_EQ(outcomeOf(c.text), c.expected) << c.name;
}

constexpr char kNoFace[] = "m.obj: has no face (a line that begins with f): it is no OBJ model";
constexpr char kOneTriangle[] = "3 vertices, 1 faces, 0 creases, 0 corners";
constexpr char kOneQuad[] = "4 vertices, 1 faces, 0 creases, 0 corners";
constexpr char kOneQuadOneCrease[] = "4 vertices, 1 faces, 1 creases, 0 corners";
constexpr char kZero[] = "indices count from 1 (from 0 after a line OFF 0)";

TEST(HostileObj, IndicesOutOfRangeAreNamedAtEachPlace) {
    expectOutcomes({
        {"vt zero", kCorners + "f 1/0 2/1 3/1\n", std::string("m.obj:6: no vt has the index in '1/0': ") + kZero},
        {"vn zero", kCorners + "f 1//0 2 3\n", std::string("m.obj:6: no vn has the index in '1//0': ") + kZero},
        {"vt past the first", kCorners + "f 1 2/-2 3\n",
         "m.obj:6: no vt has the index in '2/-2': it counts back past the first of the 1 so far"},
        {"vn past the first", kCorners + "f 1 2 3/1/-2\n",
         "m.obj:6: no vn has the index in '3/1/-2': it counts back past the first of the 1 so far"},
        {"vertex before any", "f -1 -2 -3\n" + kTriangle,
         "m.obj:1: no vertex has the index in '-1': it counts back past the first of the 0 so far"},
        {"vt behind the last", kCorners + "f 1/2 2/1 3/1\n",
         "m.obj:6: no vt has the index 2 (counted from 1): the file has 1"},
        {"vn behind the last", kCorners + "f 1//1 2//2 3//1\n",
         "m.obj:6: no vn has the index 2 (counted from 1): the file has 1"},
        {"vt beyond 32 bits", kCorners + "f 1/2147483649 2 3\n",
         "m.obj:6: no vt has the index in '1/2147483649': it is too large"},
        {"vn beyond 64 bits", kCorners + "f 1//99999999999999999999 2 3\n",
         "m.obj:6: no vn has the index in '1//99999999999999999999': it is too large"},
        {"the least of 64 bits", kCorners + "f 1 2 -9223372036854775808\n",
         "m.obj:6: no vertex has the index in '-9223372036854775808': it counts back past the first of the 3 so "
         "far"},
        {"from 0, one too far", "OFF 0\n" + kTriangle + "f 0 1 3\n",
         "m.obj:5: no vertex has the index 4 (counted from 1): the file has 3"},
        {"the largest of 32 bits", kTriangle + "f 1 2 2147483647\n",
         "m.obj:4: no vertex has the index 2147483647 (counted from 1): the file has 3"},
        {"l zero", kQuad + "l 0 1\n", std::string("m.obj:6: no vertex has the index in '0': ") + kZero},
        {"l past the first", kQuad + "l 1 -5\n",
         "m.obj:6: no vertex has the index in '-5': it counts back past the first of the 4 so far"},
        {"l behind the last", kQuad + "l 4 5\n",
         "m.obj:6: no vertex has the index 5 (counted from 1): the file has 4"},
        {"l with a vt that is not there", kQuad + "l 1/9 2\n",
         "m.obj:6: no vt has the index 9 (counted from 1): the file has 0"},
        {"l beyond 32 bits", kQuad + "l 1 4294967297\n",
         "m.obj:6: no vertex has the index in '4294967297': it is too large"},
        {"p zero", kQuad + "p 0\n", std::string("m.obj:6: no vertex has the index in '0': ") + kZero},
        {"p past the first", kQuad + "p -5\n",
         "m.obj:6: no vertex has the index in '-5': it counts back past the first of the 4 so far"},
        {"p beyond 32 bits", kQuad + "p 4294967297\n",
         "m.obj:6: no vertex has the index in '4294967297': it is too large"},
        {"crease behind the last", kQuad + "t crease 2/1/0 0 4 1\n",
         "m.obj:6: no vertex has the index 4 (counted from 0): the file has 4"},
        {"crease negative", kQuad + "t crease 2/1/0 -1 0 1\n",
         "m.obj:6: tag crease has the index -1: indices of tags count from 0"},
        {"crease beyond 32 bits", kQuad + "t crease 2/1/0 0 2147483648 1\n",
         "m.obj:6: tag crease has the index 2147483648: indices of tags count from 0"},
        {"corner behind the last", kQuad + "t corner 1/1/0 4 1\n",
         "m.obj:6: no vertex has the index 4 (counted from 0): the file has 4"},
        {"corner negative", kQuad + "t corner 1/1/0 -2147483648 1\n",
         "m.obj:6: tag corner has the index -2147483648: indices of tags count from 0"},
        {"corner, the largest of 32 bits", kQuad + "t corner 1/1/0 2147483647 1\n",
         "m.obj:6: no vertex has the index 2147483647 (counted from 0): the file has 4"},
        {"hole behind the last", kQuad + "t hole 1/0/0 1\n",
         "m.obj:6: no face has the index 1 (counted from 0): the file has 1"},
        {"hole negative", kQuad + "t hole 1/0/0 -1\n",
         "m.obj:6: tag hole has the index -1: indices of tags count from 0"},
        {"hole beyond 64 bits", kQuad + "t hole 1/0/0 99999999999999999999\n",
         "m.obj:6: tag hole has the index 9223372036854775807: indices of tags count from 0"},
    });
}

TEST(HostileObj, NumbersThatAreNoCoordinatesAreNamedAtEachPlace) {
    std::string const v = ": v takes three numbers, x y z";
    std::string const vt = ": vt takes one to three numbers, u v w", vn = ": vn takes three numbers, x y z";
    expectOutcomes({
        {"x infinite", "v inf 0 0\n", "m.obj:1: 'inf' is not finite" + v},
        {"y minus infinite", "v 0 -INF 0\n", "m.obj:1: '-INF' is not finite" + v},
        {"z not a number", "v 0 0 -nan\n", "m.obj:1: '-nan' is not finite" + v},
        {"NaN with a payload", "v nan(1) 0 0\n", "m.obj:1: 'nan(1)' is not finite" + v},
        {"infinity spelt out", "v 0 infinity 0\n", "m.obj:1: 'infinity' is not finite" + v},
        {"beyond double", "v 1e309 0 0\n", "m.obj:1: '1e309' is not finite" + v},
        {"an exponent beyond 64 bits", "v 1e99999999999999999999 0 0\n",
         "m.obj:1: '1e99999999999999999999' is not finite" + v},
        {"u not a number", "vt nan 0\n", "m.obj:1: 'nan' is not finite" + vt},
        {"v infinite", "vt 0 1e400\n", "m.obj:1: '1e400' is not finite" + vt},
        {"no u", "vt # 1 1\n", "m.obj:1: has only 0 numbers" + vt},
        {"normal infinite", "vn 0 0 -inf\n", "m.obj:1: '-inf' is not finite" + vn},
        {"normal without z", "vn 0 0\n", "m.obj:1: has only 2 numbers" + vn},
        {"nothing", "v\n", "m.obj:1: has only 0 numbers" + v},
        {"the rest in a comment", "v 0 0 #0\n", "m.obj:1: has only 2 numbers" + v},
        {"a comma for a point", "v 0,5 0 0\n", "m.obj:1: '0,5' is not a number" + v},
        {"Fortran's exponent", "v 1d3 0 0\n", "m.obj:1: '1d3' is not a number" + v},
        {"hexadecimal", "v 0x1p3 0 0\n", "m.obj:1: '0x1p3' is not a number" + v},
        {"a zero byte", std::string("v 0 0 0\0\n", 9), "m.obj:1: '0\\x00' is not a number" + v},
        {"NaN where it is ignored", kTriangle + "v 0 0 0 nan\nvt 0 0 inf\nf 1 2 3\n",
         "4 vertices, 1 faces, 0 creases, 0 corners"},
        {"an exponent below all", "v 1e-99999999999999999999 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", kOneTriangle},
        {"points of the largest float", "v -3e38 0 0\nv 3e38 0 0\nv 0 3e38 0\nf 1 2 3\n", kOneTriangle},
        {"points in one place", "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n", kOneTriangle},
        {"points on one line", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", kOneTriangle},
    });
}

TEST(HostileObj, FacesThatAreNoneAreRefusedWithTheirLine) {
    std::string const few = " vertices: it takes three or more";
    std::string const again = " more than once: remove the repetition, or the face";
    std::string const form = " is no index: f takes v, v/vt, v//vn or v/vt/vn for each corner";
    expectOutcomes({
        {"empty", kTriangle + "f\n", "m.obj:4: the face has 0" + few},
        {"a point", kTriangle + "f 1\n", "m.obj:4: the face has 1" + few},
        {"a digon with uvs", kCorners + "f 1/1 2/1\n", "m.obj:6: the face has 2" + few},
        {"the third in a comment", kTriangle + "f 1 2 # 3\n", "m.obj:4: the face has 2" + few},
        {"a comment at once behind", kTriangle + "f 1 2#3\n", "m.obj:4: the face has 2" + few},
        {"joined to a comment", kTriangle + "f 1 2 \\\n# 3\nf 1 2 3\n", "m.obj:4: the face has 2" + few},
        {"joined to an empty line", kTriangle + "f 1 2 \\\n\n3\n", "m.obj:4: the face has 2" + few},
        {"one vertex twice in a row", kTriangle + "f 1 1 2 3\n", "m.obj:4: the face has vertex 1" + again},
        {"closed explicitly", kTriangle + "f 1 2 3 1\n", "m.obj:4: the face has vertex 1" + again},
        {"one vertex by two names", kTriangle + "f 1 2 -3\n", "m.obj:4: the face has vertex 1" + again},
        {"one vertex with two uvs", kCorners + "vt 1 1\nf 1/1 2/1 1/2\n", "m.obj:7: the face has vertex 1" + again},
        {"from 0 by its own number", "OFF 0\n" + kTriangle + "f 0 2 2\n", "m.obj:5: the face has vertex 2" + again},
        {"a blank behind the backslash", kTriangle + "f 1 2 \\ \n3\n", "m.obj:4: '\\'" + form},
        {"a comma between", kTriangle + "f 1,2,3\n", "m.obj:4: '1,2,3'" + form},
        {"backslashes between", kTriangle + "f 1\\1 2 3\n", "m.obj:4: '1\\1'" + form},
        {"a word", kTriangle + "f one two three\n", "m.obj:4: 'one'" + form},
        {"a zero byte between", kTriangle + std::string("f 1\0 2 3\n", 9), "m.obj:4: '1\\x00'" + form},
        {"an escape sequence", kTriangle + "f 1 2 \x1b[2J\n", "m.obj:4: '\\x1b[2J'" + form},
        {"four indices in a corner", kCorners + "f 1/1/1/1 2 3\n", "m.obj:6: '1/1/1/1'" + form},
        {"the same direction twice", kSquare + "v 2 0 0\nv 2 1 0\nf 1 2 3 4\nf 6 5 2 3\n",
         "6 vertices, 2 faces, 0 creases, 0 corners"},
        {"one face three times", kTriangle + "f 1 2 3\nf 1 2 3\nf 2 3 1\n",
         "3 vertices, 3 faces, 0 creases, 0 corners"},
        {"a face and its back", kTriangle + "f 1 2 3\nf 3 2 1\n", "3 vertices, 2 faces, 0 creases, 0 corners"},
    });
}

TEST(HostileObj, SharpnessThatCannotBeIsRefusedAndMuchIsInfinite) {
    std::string const allowed = ": give 0 (smooth) to 10 (infinite)";
    std::string const form = ": a tag is t NAME ints/floats/strings and as many values of each";
    std::string const words = ": fs and as take one sharpness per edge of the face";
    expectOutcomes({
        {"crease minus infinite", kQuad + "t crease 2/1/0 0 1 -inf\n",
         "m.obj:6: sharpness '-inf' is negative" + allowed},
        {"crease not a number", kQuad + "t crease 2/1/0 0 1 nan\n",
         "m.obj:6: sharpness 'nan' is not a number" + allowed},
        {"crease in words", kQuad + "t crease 2/1/0 0 1 sharp\n", "m.obj:6: 'sharp' is not a number" + form},
        {"corner negative", kQuad + "t corner 1/1/0 0 -1e-30\n",
         "m.obj:6: sharpness '-1e-30' is negative" + allowed},
        {"corner not a number", kQuad + "t corner 1/1/0 0 -nan\n",
         "m.obj:6: sharpness '-nan' is not a number" + allowed},
        {"fs minus infinite", kQuad + "fs 0 -1e999\n", "m.obj:6: sharpness '-1e999' is negative" + allowed},
        {"as not a number", kQuad + "as 1 0 nan\n", "m.obj:6: sharpness 'nan' is not a number" + allowed},
        {"as in words", kQuad + "as 1 all\n", "m.obj:6: 'all' is not a number" + words},
        {"as of a hexadecimal count", kQuad + "as 0x1 1\n",
         "m.obj:6: '0x1' is not a whole number: as takes the number of faces first"},
        {"as of all 64 bits", kQuad + "as 9223372036854775807 1\n",
         "m.obj:6: fs and as lines stand for more faces than the 1 of the model: remove them, or check that they "
         "belong to this model"},
        {"as beyond 64 bits", kQuad + "as 99999999999999999999 0\n",
         "m.obj:6: fs and as lines stand for more faces than the 1 of the model: remove them, or check that they "
         "belong to this model"},
        {"as below 64 bits", kQuad + "as -99999999999999999999 0\n",
         "m.obj:6: as has the count '-99999999999999999999': it takes the number of faces, 1 or more"},
        {"a count of all 64 bits", kQuad + "t crease 9223372036854775807/1/0 0 1 1\n",
         "m.obj:6: tag crease has fewer values than its counts say" + form},
        {"minus zero", kQuad + "t crease 2/1/0 0 1 -0\n", kOneQuadOneCrease},
        {"too little for double", kQuad + "t crease 2/1/0 0 1 -1e-999\n", kOneQuadOneCrease},
        {"too much for double", kQuad + "t crease 2/1/0 0 1 1e999\n", kOneQuadOneCrease},
        {"no creases in a tag", kQuad + "t crease 0/0/0\nt corner 0/1/0 3\nt hole 0/0/0\n", kOneQuad},
        {"one edge a hundred times",
         kQuad +
             [] {
                 std::string lines;
                 for (int i = 0; i < 100; ++i)
                     lines += "t crease 2/1/0 " + std::string(i % 2 ? "0 1 " : "1 0 ") + "3\n";
                 return lines;
             }(),
         "4 vertices, 1 faces, 100 creases, 0 corners"},
        {"the only face a hole", kQuad + "t hole 3/0/0 0 0 0\n", kOneQuad},
    });
}

TEST(HostileObj, WhatIsOtherThanAnObjSaysSo) {
    std::string utf16 = "\xff\xfe";
    for (char c : kQuad) utf16 += {c, '\0'};
    std::string const unknown = "; m.obj:1: skipped, as all lines with an unknown first word: ";
    expectOutcomes({
        {"PNG", std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16), kNoFace},
        {"gzip", std::string("\x1f\x8b\x08\0\0\0\0\0\0\x03", 10), kNoFace},
        {"ELF", std::string("\x7f\x45\x4c\x46\x02\x01\x01\0\0\0\0\0", 12), kNoFace},
        {"glTF", std::string("glTF\x02\0\0\0\x10\0\0\0JSON{}", 18), kNoFace},
        {"PLY", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n0\n", kNoFace},
        {"STL", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nendloop\nendfacet\nendsolid a\n", kNoFace},
        {"UTF-16", utf16, kNoFace},
        {"all bytes",
         [] {
             std::string bytes;
             for (int i = 0; i < 65536; ++i) bytes += static_cast<char>(i * 7 + i / 256);
             return bytes;
         }(),
         kNoFace},
        {"capitals", "V 0 0 0\nF 1 2 3\n", kNoFace},
        {"a .sharp file", "fs 1 2 3\n", kNoFace},
        {"an empty line alone", "\n", kNoFace},
        {"a byte-order mark alone", "\xEF\xBB\xBF", kNoFace},
        {"half of one", "\xEF\xBB", kNoFace},
        {"OFF of one index", "OFF -1\n",
         "m.obj:1: OFF takes the index of the first vertex, 0 or 1 (files in the OFF "
         "format are not read)"},
        {"OFF in words", "OFF BINARY\n",
         "m.obj:1: OFF takes the index of the first vertex, 0 or 1 (files in the OFF "
         "format are not read)"},
        {"a byte-order mark between",
         kTriangle + "\xEF\xBB\xBF"
                     "f 1 2 3\n",
         kNoFace},
        {"a quad behind garbage", std::string("\x01\x02\x03\n") + kQuad, kOneQuad + unknown + "'\\x01\\x02\\x03'"},
        {"a quad behind a zero byte's line", std::string("\0\n", 2) + kQuad, kOneQuad + unknown + "'\\x00'"},
    });
}

TEST(HostileObj, OddLinesAreReadForWhatTheyAre) {
    expectOutcomes({
        {"carriage returns twice", "v 0 0 0\r\r\nv 1 0 0\r\r\nv 0 1 0\r\r\nf 1 2 3\r\r\n", kOneTriangle},
        {"line ends the wrong way round", "v 0 0 0\n\rv 1 0 0\n\rv 0 1 0\n\rf 1 2 3\n\r", kOneTriangle},
        {"comments at once behind words", "v 0 0 0#a\nv 1 0 0#b#\nv 0 1 0##\nf 1 2 3#f 1 2 3\n", kOneTriangle},
        {"a comment before every line", "#\n#v\nv 0 0 0\n#f 1 2 3\nv 1 0 0\n# \\\nv 0 1 0\nf 1 2 3", kOneTriangle},
        {"other blanks", "v\t0\v0\f0\nv 1 0 0\n v 0 1 0\n\t\v\ff 1 2 3", kOneTriangle},
        {"a join at the end of the file", kTriangle + "f 1 2 3\\", kOneTriangle},
        {"a join before the end of the file", kTriangle + "f 1 2 3 \\\n", kOneTriangle},
        {"a word on each line", "v \\\n0 \\\r\n0 \\\r0\nv 1 0 0\nv 0 1 0\nf \\\n1 \\\n2 \\\n3", kOneTriangle},
        {"no line end at all", "v 0 0 0\\", kNoFace},
        {"plus signs", "v +0 +0 +0\nv +1 0 0\nv 0 +1 0\nf +1 +2 +3\n", kOneTriangle},
        {"zeros in front", "v 000 0 0\nv 01 0 0\nv 0 1 0\nf 0001 02 3\n", kOneTriangle},
        {"all vertices behind", "f 3 2 1\n" + kTriangle, kOneTriangle},
    });
}

TEST(HostileObj, LinesOfTenMegabytesGiveTheirErrorSoonAndShort) {
    std::size_t const kMany = 10'000'000;
    std::string indices = "f";
    while (indices.size() < kMany) indices += " 1 2 3";
    std::string values = "t crease 9000000/1/0";
    while (values.size() < kMany) values += " 0 1";
    auto const start = std::chrono::steady_clock::now();
    expectOutcomes({
        {"a word", "v 0 0 " + std::string(kMany, 'x') + "\n",
         "m.obj:1: '" + std::string(40, 'x') + "...' is not a number: v takes three numbers, x y z"},
        {"digits", "v 0 0 " + std::string(kMany, '1') + "\n",
         "m.obj:1: '" + std::string(40, '1') + "...' is not finite: v takes three numbers, x y z"},
        {"digits behind the point", "v 0 0 0." + std::string(kMany, '1') + "\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
         kOneTriangle},
        {"an exponent", "v 0 0 1e" + std::string(kMany, '9') + "\n",
         "m.obj:1: '1e" + std::string(38, '9') + "...' is not finite: v takes three numbers, x y z"},
        {"an index", kTriangle + "f 1 2 " + std::string(kMany, '9') + "\n",
         "m.obj:4: no vertex has the index in '" + std::string(40, '9') + "...': it is too large"},
        {"zeros before an index", kTriangle + "f 1 2 " + std::string(kMany, '0') + "3\n", kOneTriangle},
        {"slashes", kTriangle + "f 1" + std::string(kMany, '/') + "\n",
         "m.obj:4: '1" + std::string(39, '/') +
             "...' is no index: f takes v, v/vt, v//vn or v/vt/vn for each corner"},
        {"a face", kTriangle + indices + "\n",
         "m.obj:4: the face has vertex 1 more than once: remove the repetition, or the face"},
        {"a tag", kQuad + values + "\n",
         "m.obj:6: tag crease has fewer values than its counts say: a tag is t NAME ints/floats/strings and as "
         "many "
         "values of each"},
        {"joined lines",
         kTriangle + "f 1 2 3 " +
             [&] {
                 std::string lines;
                 while (lines.size() < kMany) lines += "\\\n";
                 return lines;
             }(),
         kOneTriangle},
        {"zero bytes", std::string(kMany, '\0'), kNoFace},
        {"empty lines", std::string(kMany, '\n') + kQuad, kOneQuad},
    });
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(60));
}

TEST(HostileObj, EveryBeginningOfAFileIsAModelOrAnErrorThatNamesItsLastLine) {
    std::string const text =
        kSquare +
        "v 2 0 0\nv 2 1 0\nvt 0.5 0.25\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1 4/1/1\nf 2 5 6 3 # two\r\n"
        "fs 1 2 3\nas 1 0.5\nl 1 2\np 4\nt crease 2/1/0 1 2 2.5\nt corner 1/1/0 0 3\n"
        "t interpolateboundary 1/0/0 1\nt hole 1/0/0 0\n";
    for (std::size_t size = 0; size <= text.size(); ++size) {
        std::string const part = text.substr(0, size);
        auto const line =
            1 + std::count(part.begin(), part.end() - (size > 0 && part.back() == '\n' ? 1 : 0), '\n');
        std::string const outcome = outcomeOf(part);
        bool const isRead =
            outcome.find(" vertices, ") != std::string::npos && outcome.find("NaN") == std::string::npos;
        bool const isNamed = outcome == kNoFace || outcome.rfind("m.obj:" + std::to_string(line) + ": ", 0) == 0;
        EXPECT_TRUE(isRead || isNamed) << size << ": " << outcome;
    }
    EXPECT_EQ(outcomeOf(text), "6 vertices, 2 faces, 6 creases, 2 corners");
}

}  // namespace
