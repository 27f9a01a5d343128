// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/io/objReader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "ioFiles.h"
#include "osd_shading/io/errors.h"
#include "osd_shading/io/sharpReader.h"

using namespace osd_shading;
using namespace osd_shading::io;
using ioFiles::ErrorOf;

namespace {

using Ints = std::vector<int>;

std::string const kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
std::string const kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
std::string const kTetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 3 2 4\nf 1 2 3\nf 4 2 1\nf 1 3 4\n";

Model parse(std::string const& text) { return ParseObj(text, "m.obj"); }

std::string errorOf(std::string const& text) {
    return ErrorOf<ParseError>([&] { parse(text); });
}

std::int64_t errorLineOf(std::string const& text) {
    try {
        parse(text);
    } catch (ParseError const& error) {
        EXPECT_EQ(error.File(), "m.obj");
        return error.Line();
    }
    return -1;
}

// Sharpness of each edge, the highest of its entries; lower vertex first.
std::map<std::pair<int, int>, float> creasesOf(Model const& model) {
    std::map<std::pair<int, int>, float> creases;
    for (std::size_t i = 0; i < model.creaseSharpness.size(); ++i) {
        auto const ends = std::minmax(model.creaseVertices[2 * i], model.creaseVertices[2 * i + 1]);
        float& sharpness = creases[{ends.first, ends.second}];
        sharpness = std::max(sharpness, model.creaseSharpness[i]);
    }
    return creases;
}

using Creases = std::map<std::pair<int, int>, float>;

}  // namespace

TEST(ObjReader, EachFaceKnowsItsLine) {
    io::Model const model = io::ParseObj("v 0 0 0\nv 1 0 0\nv 0 1 0\n\nf 1 2 3\n# two\nf 1 \\\n 3 2\n", "m.obj");
    EXPECT_EQ(model.faceLines, (std::vector<std::int64_t>{5, 7}));
}

TEST(ObjReader, ATriangleWithUvsAndNormalsIsReadAsItStands) {
    Model const model = parse(kTriangle + "vt 0 0.5\nvt 1\nvt 1 1 7\nvn 0 0 1\nf 1/3/1 2/1/1 3/2/1\n");
    EXPECT_EQ(model.name, "m");
    EXPECT_EQ(model.positions, (std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0}));
    EXPECT_EQ(model.uvs, (std::vector<double>{0, 0.5, 1, 0, 1, 1}));
    EXPECT_EQ(model.normals, (std::vector<double>{0, 0, 1}));
    EXPECT_EQ(model.faceSizes, (Ints{3}));
    EXPECT_EQ(model.faceVertices, (Ints{0, 1, 2}));
    EXPECT_EQ(model.uvIndices, (Ints{2, 0, 1}));
    EXPECT_EQ(model.normalIndices, (Ints{0, 0, 0}));
    EXPECT_TRUE(model.warnings.empty());
    EXPECT_FALSE(model.boundary || model.faceVarying || model.creasing || model.triangles);
}

TEST(ObjReader, AllFourFormsOfFaceCornersMayStandInOneFile) {
    Model const model =
        parse(kSquare + "vt 0 0\nvn 0 0 1\nf 1 2 3\nf 1/1 2 3/1\nf 1//1 2//1 3//1\nf 1/1/1 2/1/1 4\n");
    EXPECT_EQ(model.uvIndices, (Ints{-1, -1, -1, 0, -1, 0, -1, -1, -1, 0, 0, -1}));
    EXPECT_EQ(model.normalIndices, (Ints{-1, -1, -1, -1, -1, -1, 0, 0, 0, 0, 0, -1}));
}

TEST(ObjReader, CompleteUvsGivesCornersWithoutOneTheirOwnZeroUv) {
    Model model = parse(kTriangle + "vt 1 1\nf 1/1 2 3/1\n");
    model.CompleteUvs();
    EXPECT_EQ(model.uvIndices, (Ints{0, 1, 0}));
    EXPECT_EQ(model.uvs, (std::vector<double>{1, 1, 0, 0}));
    model.CompleteUvs();
    EXPECT_EQ(model.uvs.size(), 4u);
}

TEST(ObjReader, NegativeIndicesCountBackFromTheLastVertex) {
    Model const model = parse(kTriangle + "f -3 -2 -1\n" + kTriangle + "vt 0 0\nf -3/-1 -2/-1 -1/-1\n");
    EXPECT_EQ(model.faceVertices, (Ints{0, 1, 2, 3, 4, 5}));
    EXPECT_EQ(model.uvIndices, (Ints{-1, -1, -1, 0, 0, 0}));
}

TEST(ObjReader, FacesMayStandBeforeTheirVertices) {
    Model const model = parse("f 1/1 2/1 3/1\nt crease 2/1/0 0 1 2\np 3\n" + kTriangle + "vt 0 0\n");
    EXPECT_EQ(model.faceVertices, (Ints{0, 1, 2}));
    EXPECT_EQ(creasesOf(model), (Creases{{{0, 1}, 2.0f}}));
}

TEST(ObjReader, AfterOffZeroIndicesCountFromZero) {
    Model const model = parse("OFF 0\n" + kTriangle + "f 0 1 2\nl 0 1\nOFF 1\nf 3 2 1\n");
    EXPECT_EQ(model.faceVertices, (Ints{0, 1, 2, 2, 1, 0}));
    EXPECT_EQ(creasesOf(model), (Creases{{{0, 1}, 10.0f}}));
}

TEST(ObjReader, NumbersAreReadExactly) {
    Model const model = parse("v 0.1 -1e-3 +2.5E+2\nv 1e-400 123456789.123456789 .5\nv 5. -0 1e0\nf 1 2 3\n");
    EXPECT_EQ(model.positions, (std::vector<double>{0.1, -1e-3, 250, 0, 123456789.123456789, 0.5, 5, 0, 1}));
}

TEST(ObjReader, WeightsAndColoursBehindCoordinatesAreIgnored) {
    Model const model = parse("v 0 0 0 1.0\nv 1 0 0 0.5 0.5 0.5\nv 0 1 0 1 2 3 4\nf 1 2 3\n");
    EXPECT_EQ(model.NumVertices(), 3);
    EXPECT_EQ(model.positions[3], 1);
}

TEST(ObjReader, PolylinesAndPointsAreInfinitelySharp) {
    Model const model = parse(kSquare + "vt 0 0\nf 1 2 3 4\nl 1/1 2/1 3\np 4 -3\n");
    EXPECT_EQ(creasesOf(model), (Creases{{{0, 1}, 10.0f}, {{1, 2}, 10.0f}}));
    EXPECT_EQ(model.cornerVertices, (Ints{3, 1}));
    EXPECT_EQ(model.cornerSharpness, (std::vector<float>{10, 10}));
}

TEST(ObjReader, FaceSharpnessBeginsAtTheEdgeBeforeTheLastVertex) {
    // The example of the format: f 3 2 4 with fs 1 2 3: edge 2-4 has 1, 4-3 has 2, 3-2 has 3.
    Model const model = parse(kTetrahedron + "fs 1 2 3\n");
    EXPECT_EQ(creasesOf(model), (Creases{{{1, 3}, 1.0f}, {{2, 3}, 2.0f}, {{1, 2}, 3.0f}}));
}

TEST(ObjReader, FaceSharpnessOfAQuadAndOfAPentagonFollowsTheSameRule) {
    Model const quad = parse(kSquare + "f 1 2 3 4\nfs 1 2 3 4\n");
    EXPECT_EQ(creasesOf(quad), (Creases{{{2, 3}, 1.0f}, {{0, 3}, 2.0f}, {{0, 1}, 3.0f}, {{1, 2}, 4.0f}}));
    Model const pentagon = parse(kSquare + "v 0 0.5 0\nf 1 2 3 4 5\nfs 0 0 7 # only the first edge\n");
    EXPECT_EQ(creasesOf(pentagon), (Creases{{{0, 1}, 7.0f}}));
}

TEST(ObjReader, TheHigherSharpnessOfTwoFacesWins) {
    // Edge 2-3 has 3 by face 0; by face 1, f 1 2 3, it is the first: 0.5.
    EXPECT_EQ(creasesOf(parse(kTetrahedron + "fs 0 0 3\nfs 0.5\n")), (Creases{{{1, 2}, 3.0f}}));
}

TEST(ObjReader, RepeatedSharpnessStandsForThatManyLines) {
    Model const twice = parse(kTetrahedron + "as 3 0 0 2.5#all of them\nfs 1\n");
    Model const single = parse(kTetrahedron + "fs 0 0 2.5\nfs 0 0 2.5\nfs 0 0 2.5\nfs 1\n");
    EXPECT_EQ(twice.creaseVertices, single.creaseVertices);
    EXPECT_EQ(twice.creaseSharpness, single.creaseSharpness);
    EXPECT_EQ(single.creaseSharpness.size(), 4u);
}

TEST(ObjReader, ZerosPastTheLastEdgeAreIgnoredAndMissingValuesAreZero) {
    EXPECT_TRUE(parse(kTetrahedron + "fs 0 0 0 0\nfs\n").creaseSharpness.empty());
    EXPECT_EQ(parse(kTetrahedron + "fs\nfs 1\n").creaseSharpness, (std::vector<float>{1}));
}

TEST(ObjReader, SharpnessLinesMayStandBeforeTheFaces) {
    EXPECT_EQ(creasesOf(parse("fs 1 2 3\n" + kTetrahedron)), creasesOf(parse(kTetrahedron + "fs 1 2 3\n")));
}

TEST(ObjReader, SharpnessOfTenAndMoreIsInfinite) {
    Model const model = parse(kSquare + "f 1 2 3 4\nfs inf 1e30 10 9.5\nt corner 2/2/0 0 1 Infinity 1e999\n");
    EXPECT_EQ(model.creaseSharpness, (std::vector<float>{10, 10, 10, 9.5f}));
    EXPECT_EQ(model.cornerSharpness, (std::vector<float>{10, 10}));
}

TEST(ObjReader, TagsCarryCreasesCornersAndHoles) {
    Model const model = parse(kTetrahedron +
                              "t crease 4/2/0 0 1 1 2 1.5 2.5 # two edges\n"
                              "t crease 4/1/0 2 3 3 0 4\n"
                              "t corner 2/1/0 0 3 0.75\nt hole 2/0/0 3 1\n");
    EXPECT_EQ(creasesOf(model), (Creases{{{0, 1}, 1.5f}, {{1, 2}, 2.5f}, {{2, 3}, 4.0f}, {{0, 3}, 4.0f}}));
    EXPECT_EQ(model.cornerVertices, (Ints{0, 3}));
    EXPECT_EQ(model.cornerSharpness, (std::vector<float>{0.75f, 0.75f}));
    EXPECT_EQ(model.holes, (Ints{3, 1}));
}

TEST(ObjReader, TagsCarryOptionsThatTakeThePlaceOfTheCallers) {
    Model const model = parse(kTetrahedron +
                              "t interpolateboundary 1/0/0 2\nt facevaryinginterpolateboundary 1/0/0 3\n"
                              "t creasemethod 0/0/1 chaikin\nt smoothtriangles 0/0/1 smooth\n");
    SubdivisionRules callers;
    callers.scheme = Sdc::SCHEME_LOOP;
    SubdivisionRules const rules = model.Rules(callers);
    EXPECT_EQ(rules.scheme, Sdc::SCHEME_LOOP);
    EXPECT_EQ(rules.boundary, Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    EXPECT_EQ(rules.faceVarying, Sdc::Options::FVAR_LINEAR_CORNERS_PLUS2);
    EXPECT_EQ(rules.creasing, Sdc::Options::CREASE_CHAIKIN);
    EXPECT_EQ(rules.triangles, Sdc::Options::TRI_SUB_SMOOTH);

    callers.boundary = Sdc::Options::VTX_BOUNDARY_NONE;
    EXPECT_EQ(parse(kTetrahedron).Rules(callers).boundary, Sdc::Options::VTX_BOUNDARY_NONE);
}

TEST(ObjReader, TheMeshIsViewsOverTheModel) {
    Model const model = parse(kTetrahedron + "fs 1\np 1\nt hole 1/0/0 2\n");
    ControlMesh const mesh = model.Mesh({});
    EXPECT_EQ(mesh.numVertices, 4);
    EXPECT_EQ(mesh.faceVertices.data(), model.faceVertices.data());
    EXPECT_EQ(mesh.faceSizes.size(), 4u);
    EXPECT_EQ(mesh.creaseSharpness[0], 1);
    EXPECT_EQ(mesh.creaseVertices.size(), 2u);
    EXPECT_EQ(mesh.cornerSharpness.size(), 1u);
    EXPECT_EQ(mesh.holes[0], 2);
}

TEST(ObjReader, LineEndsByteOrderMarkCommentsAndJoinedLinesChangeNothing) {
    Model const plain = parse(kTetrahedron + "fs 1 2 3\n");
    std::string unusual = "\xEF\xBB\xBF" + kTetrahedron + "fs 1 2 3";
    for (char const* const lineEnd : {"\r\n", "\r", " # a comment\n\n", " # a path\\\n", "\t \n  \t"}) {
        std::string text;
        for (char c : unusual) c == '\n' ? text += lineEnd : text += c;
        Model const model = parse(text);
        EXPECT_EQ(model.positions, plain.positions) << lineEnd;
        EXPECT_EQ(model.faceVertices, plain.faceVertices) << lineEnd;
        EXPECT_EQ(model.creaseSharpness, plain.creaseSharpness) << lineEnd;
        EXPECT_TRUE(model.warnings.empty()) << lineEnd;
    }
    EXPECT_EQ(parse(kSquare + "f 1 \\\n2\\\r\n 3 \\\r4").faceVertices, (Ints{0, 1, 2, 3}));
}

TEST(ObjReader, LineNumbersCountEveryKindOfLineEndOnce) {
    EXPECT_EQ(errorLineOf("v 0 0 0\r\nv 1 0 0\rv 0 1 0\n\n# c\\\nf 1 2\n"), 6);
    EXPECT_EQ(errorLineOf("v 0 \\\n 0 \\\n0\nv x"), 4);
    EXPECT_EQ(errorLineOf("v 0 0 0\nf 1 \\\n2\n"), 2);
}

TEST(ObjReader, WordsOfTheFormatThatSayNothingHereAreSkippedInSilence) {
    Model const model =
        parse("mtllib a b.mtl\no name#1\ng\ns off\nusemtl x\nvp 1\ncstype bspline\nend\n" + kTetrahedron);
    EXPECT_EQ(model.NumFaces(), 4);
    EXPECT_TRUE(model.warnings.empty());
}

TEST(ObjReader, OneWarningNamesTheFirstLineWithAnUnknownWord) {
    Model const model = parse("v 0 0 0\nfoo 1 2\nbar\n" + kTetrahedron + "foo\n");
    ASSERT_EQ(model.warnings.size(), 1u);
    EXPECT_EQ(model.warnings[0], "m.obj:2: skipped, as all lines with an unknown first word: 'foo'");
}

TEST(ObjReader, HierarchicalEditsAndUnknownTagsAreReportedAsIgnored) {
    Model const model = parse(kTetrahedron +
                              "t vertexedit 4/3/3 3 0 1 0 0 0 1 add P value\nt edgeedit x\nt faceedit\n"
                              "t colour 1/0/0 5\nt colour 1/0/0 5\n");
    ASSERT_EQ(model.warnings.size(), 2u);
    EXPECT_EQ(model.warnings[0], "m.obj:9: ignored, as all hierarchical edits: 'vertexedit'");
    EXPECT_EQ(model.warnings[1], "m.obj:12: ignored, as all unknown tags: 'colour'");
}

TEST(ObjReader, AFaceMayHaveTenThousandVertices) {
    std::string text, face = "f";
    for (int i = 1; i <= 10000; ++i) {
        text += "v " + std::to_string(i) + " 0 0\n";
        face += ' ' + std::to_string(i);
    }
    EXPECT_EQ(parse(text + face).faceSizes, (Ints{10000}));
    EXPECT_EQ(errorOf(text + face + " 77\n"),
              "m.obj:10001: the face has vertex 77 more than once: remove the repetition, or the face");
}

TEST(ObjReader, ALineOfTenMegabytesIsReadInLinearTime) {
    std::string text = kTetrahedron + "foo " + std::string(10'000'000, 'x') + "\n#" + std::string(10'000'000, '\\');
    text += "\nv" + std::string(5'000'000, ' ') + "0 0 0\nfs";
    for (int i = 0; i < 3'000'000; ++i) text += " 0";
    auto const start = std::chrono::steady_clock::now();
    EXPECT_EQ(parse(text).NumVertices(), 5);
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
}

TEST(ObjReader, IsolatedVerticesAndRepeatedFacesStay) {
    Model const model = parse(kSquare + "f 1 2 3\nf 1 2 3\nf 3 2 1\n");
    EXPECT_EQ(model.NumVertices(), 4);
    EXPECT_EQ(model.NumFaces(), 3);
}

TEST(ObjReader, ErrorsNameFileAndLineAndTheWordAtFault) {
    EXPECT_EQ(errorOf("v 0 0 0\nv 1 abc 0\n"), "m.obj:2: 'abc' is not a number: v takes three numbers, x y z");
    EXPECT_EQ(errorOf("v 0 0\n"), "m.obj:1: has only 2 numbers: v takes three numbers, x y z");
    EXPECT_EQ(errorOf("v 0 0 nan\n"), "m.obj:1: 'nan' is not finite: v takes three numbers, x y z");
    EXPECT_EQ(errorOf("v 0 0 -1e999\n"), "m.obj:1: '-1e999' is not finite: v takes three numbers, x y z");
    EXPECT_EQ(errorOf(kTriangle + "f 1 2 x\n"),
              "m.obj:4: 'x' is no index: f takes v, v/vt, v//vn or v/vt/vn for each corner");
    EXPECT_EQ(errorOf(kTriangle + "f 1 2\n"), "m.obj:4: the face has 2 vertices: it takes three or more");
    EXPECT_EQ(errorOf(kTriangle + "f 1 2 1\n"),
              "m.obj:4: the face has vertex 1 more than once: remove the repetition, or the face");
    EXPECT_EQ(errorOf(kTriangle + "f 0 1 2\n"),
              "m.obj:4: no vertex has the index in '0': indices count from 1 (from 0 after a line OFF 0)");
    EXPECT_EQ(errorOf(kTriangle + "f 1 2 99999999999\n"),
              "m.obj:4: no vertex has the index in '99999999999': it is too large");
    EXPECT_EQ(errorOf(kTriangle + "f 1 2 -4\n"),
              "m.obj:4: no vertex has the index in '-4': it counts back past the first of the 3 so far");
    EXPECT_EQ(errorOf(kTriangle + "f 1 2 4\nf 1 2 3\n"),
              "m.obj:4: no vertex has the index 4 (counted from 1): the file has 3");
    EXPECT_EQ(errorOf(kTriangle + "f 1/1 2/1 3/1\n"),
              "m.obj:4: no vt has the index 1 (counted from 1): the file has 0");
}

TEST(ObjReader, WhatIsNoIndexIsAnError) {
    for (char const* const word :
         {"1/1/1/1", "/1", "//1", "1.5", "1e0", "1-", "+-1", "--1", "1/x", "1//x", "1///", "/"}) {
        EXPECT_EQ(errorLineOf(kTriangle + "vt 0 0\nvn 0 0 1\nf 2 3 " + word + "\n"), 6) << word;
    }
    for (char const* const word :
         {"9223372036854775808", "-9223372036854775809", "2147483648", "99999999999999999999999"}) {
        EXPECT_EQ(errorLineOf(kTriangle + "f 2 3 " + word + "\n"), 4) << word;
        EXPECT_EQ(errorLineOf("OFF 0\n" + kTriangle + "f 1 2 " + word + "\n"), 5) << word;
    }
}

TEST(ObjReader, WhatIsNoNumberIsAnError) {
    for (char const* const word : {"1,5", "0x10", "1.0f", "--1", "+-1", "+", "1e", ".", "e5", "\xEF\xBB\xBF"}) {
        EXPECT_EQ(errorLineOf("v 0 0 " + std::string(word)), 1) << word;
        EXPECT_EQ(errorLineOf("v 0 0 0 " + std::string(word)), 1) << word;
        EXPECT_EQ(errorLineOf("vt 0 " + std::string(word)), 1) << word;
    }
    EXPECT_EQ(errorLineOf("vt"), 1);
    EXPECT_EQ(errorLineOf("vn 0 1"), 1);
}

TEST(ObjReader, SharpnessLinesThatCannotBeMeantAreErrors) {
    EXPECT_EQ(errorOf(kTetrahedron + "fs 0 0 0 1\n"),
              "m.obj:9: sharpness number 4 is not 0, but face 0 (from 0) has only 3 edges: remove it, or check the "
              "order of the lines");
    EXPECT_EQ(errorOf(kTetrahedron + "as 4 1\nfs 0\n"),
              "m.obj:10: fs and as lines stand for more faces than the 4 of the model: remove them, or check that "
              "they belong to this model");
    EXPECT_EQ(errorLineOf(kTetrahedron + "as 9000000000000000000 1\n"), 9);
    EXPECT_EQ(errorOf(kTetrahedron + "fs -1\n"),
              "m.obj:9: sharpness '-1' is negative: give 0 (smooth) to 10 (infinite)");
    EXPECT_EQ(errorOf(kTetrahedron + "fs nan\n"),
              "m.obj:9: sharpness 'nan' is not a number: give 0 (smooth) to 10 (infinite)");
    EXPECT_EQ(errorLineOf(kTetrahedron + "fs one\n"), 9);
    EXPECT_EQ(errorOf(kTetrahedron + "as\n"),
              "m.obj:9: as has neither count nor values: write as COUNT SHARPNESS..");
    EXPECT_EQ(errorOf(kTetrahedron + "as 2\n"),
              "m.obj:9: as has a count but no values: write as COUNT SHARPNESS..");
    for (char const* const count : {"0", "-1", "1.5", "x"}) {
        EXPECT_EQ(errorLineOf(kTetrahedron + "as " + count + " 1\n"), 9) << count;
    }
}

TEST(ObjReader, TagsThatDoNotKeepTheirFormAreErrors) {
    for (char const* const tag : {"",
                                  "crease",
                                  "crease 2",
                                  "crease 2/1",
                                  "crease 2/1/0/0 0 1 1",
                                  "crease 2/1/0",
                                  "crease 2/1/0 0 1",
                                  "crease 2/1/0 0 1 1 1",
                                  "crease -2/1/0 0 1 1",
                                  "crease 3/1/0 0 1 2 1",
                                  "crease 2/0/0 0 1",
                                  "crease 4/3/0 0 1 1 2 1 1 1",
                                  "crease 2/1/0 0 1 nan",
                                  "crease 2/1/0 0 1 -1",
                                  "crease 2/1/0 0 1.5 1",
                                  "crease 999999999999/1/0 0 1 1",
                                  "crease 2/1/0 0 99999999999 1",
                                  "crease 2/1/0 -1 1 1",
                                  "corner 1/1/0 5 1",
                                  "corner 2/3/0 0 1 1 1 1",
                                  "hole 1/0/0 4",
                                  "hole 1/0/0 -1",
                                  "interpolateboundary 1/0/0 3",
                                  "interpolateboundary 0/0/0",
                                  "creasemethod 0/0/1 sharp",
                                  "creasemethod 0/0/0",
                                  "smoothtriangles 0/0/1 x",
                                  "facevaryinginterpolateboundary 1/0/0 6"}) {
        EXPECT_EQ(errorLineOf(kTetrahedron + "t " + tag + "\nv 0 0 0\n"), 9) << tag;
    }
}

TEST(ObjReader, ACreaseThatIsNoEdgeIsAnErrorWithItsLine) {
    std::string const square = kSquare + "f 1 2 3 4\n";
    EXPECT_EQ(errorOf(square + "t crease 2/1/0 0 2 1\n"),
              "m.obj:6: the crease from vertex 0 to 2 (from 0) is no edge of a face: name the two ends of an edge");
    EXPECT_EQ(errorLineOf(square + "l 1 2 4\n"), 6);
    EXPECT_EQ(errorLineOf(square + "l 1 1\n"), 6);
    EXPECT_EQ(errorLineOf(square + "l 1 5\n"), 6);
    EXPECT_EQ(errorLineOf(square + "l 1\n"), 6);
    EXPECT_EQ(errorLineOf(square + "p\n"), 6);
    EXPECT_EQ(errorLineOf(square + "p 5\n"), 6);
}

TEST(ObjReader, AFileThatIsNoModelSaysSo) {
    std::string const noFace = "m.obj: has no face (a line that begins with f): it is no OBJ model";
    EXPECT_EQ(errorOf(""), noFace);
    EXPECT_EQ(errorOf("# only a comment"), noFace);
    EXPECT_EQ(errorOf(kTriangle), noFace);
    EXPECT_EQ(errorOf(std::string(1000, '\0')), noFace);
    EXPECT_EQ(errorOf("\\"), noFace);
    EXPECT_EQ(errorOf("OFF\n8 6 12\n"),
              "m.obj:1: OFF takes the index of the first vertex, 0 or 1 (files in the OFF format are not read)");
}

TEST(ObjReader, UnprintableAndLongWordsAreShownSafely) {
    std::string const error = errorOf("v 0 0 " + std::string("\0\x1b[31m\xff", 7) + std::string(1000, 'x'));
    EXPECT_EQ(error, "m.obj:1: '\\x00\\x1b[31m\\xff" + std::string(33, 'x') +
                         "...' is not a number: v takes three numbers, x y z");
}

TEST(ObjReader, FilesThatCannotBeReadSayWhy) {
    ioFiles::TemporaryFolder const folder;
    EXPECT_EQ(ErrorOf<ReadError>([&] { ReadObj(folder.Path()); }),
              folder.Path() + ": can't be read: it is a folder, not a file");
    EXPECT_EQ(ErrorOf<ReadError>([&] { ReadObj(folder.File("none.obj")); }),
              folder.File("none.obj") + ": can't be read: No such file or directory");
    ioFiles::WriteBytes(folder.File("a b.obj"), kTetrahedron);
    EXPECT_EQ(ReadObj(folder.File("a b.obj")).name, "a b");
}

TEST(ObjReader, AllSharedModelsAreReadExceptThoseWithRepeatedVertices) {
    auto const paths = ioFiles::SharedModels();
    if (paths.empty()) GTEST_SKIP() << ioFiles::kNoSharedModels;
    std::vector<std::string> refused;
    for (auto const& path : paths) {
        try {
            Model const model = ReadObj(path);
            EXPECT_EQ(model.warnings.size(), path.find("hedit") == std::string::npos ? 0u : 1u) << path;
            EXPECT_GT(model.NumFaces(), 0) << path;
        } catch (ParseError const& error) {
            EXPECT_NE(std::string(error.what()).find("more than once"), std::string::npos) << error.what();
            EXPECT_GT(error.Line(), 0);
            refused.push_back(std::filesystem::path(path).stem().string());
        }
    }
    EXPECT_EQ(refused, (std::vector<std::string>{"catmark_nonman_edges", "catmark_nonman_quadpole64",
                                                 "catmark_nonman_quadpole8", "loop_nonman_edges"}));
}

TEST(ObjReader, TheSharedModelsQuirksComeOutRight) {
    if (ioFiles::SharedModels().empty()) GTEST_SKIP() << ioFiles::kNoSharedModels;
#if defined(OSD_SHADING_EXTRA_MODELS)
    std::string const folder = OSD_SHADING_EXTRA_MODELS;
    Model const spot = ReadObj(folder + "/zbk/spot.obj");
    EXPECT_EQ(spot.NumVertices(), 188);
    EXPECT_EQ(std::count(spot.faceSizes.begin(), spot.faceSizes.end(), 4), 160);
    EXPECT_EQ(std::count(spot.faceSizes.begin(), spot.faceSizes.end(), 5), 16);
    EXPECT_EQ(std::count(spot.faceSizes.begin(), spot.faceSizes.end(), 3), 4);

    Model const robot = ReadObj(folder + "/zbk/robot.obj");  // OFF 0
    EXPECT_EQ(*std::min_element(robot.faceVertices.begin(), robot.faceVertices.end()), 0);
    EXPECT_EQ(robot.NumVertices(), 685);
    EXPECT_EQ(robot.NumFaces(), 1247);

    Model const cube = ReadObj(folder + "/zbk/cube.obj");  // byte-order mark; sharp rims of two faces
    EXPECT_EQ(creasesOf(cube).size(), 7u);

    Model const holes = ReadObj(folder + "/osd/catmark_hole_test3.obj");
    EXPECT_EQ(holes.holes, (Ints{15, 2, 7, 8, 9, 5, 13, 14}));
    EXPECT_EQ(ReadObj(folder + "/osd/catmark_chaikin1.obj").creasing, Sdc::Options::CREASE_CHAIKIN);
#endif
}

TEST(ObjReader, RandomChangesToAFileGiveAModelOrAParseError) {
    std::vector<std::string> texts = {kTetrahedron +
                                      "vt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 4/1/1\nl 1 2\np 3\nfs 1 2 3\n"
                                      "as 2 1 0\nt crease 2/1/0 0 1 2\nt corner 1/1/0 0 2\n"
                                      "t hole 1/0/0 0\nt creasemethod 0/0/1 chaikin\nOFF 0\nf 0 1 2\n"};
    for (auto const& path : ioFiles::SharedModels()) {
        std::string text = ioFiles::ReadBytes(path);
        if (text.size() < 4000) texts.push_back(std::move(text));
    }
    std::mt19937 random(1);
    char const interesting[] = "0123456789-+.e/# \t\r\n\\vftlpnsa\0\xff";
    for (auto const& text : texts) {
        for (int i = 0; i < 200; ++i) {
            std::string changed = text;
            for (auto edits = random() % 5 + 1; edits > 0 && !changed.empty(); --edits) {
                std::size_t const at = random() % changed.size();
                char const c = interesting[random() % (sizeof(interesting) - 1)];
                switch (random() % 4) {
                    case 0:
                        changed[at] = c;
                        break;
                    case 1:
                        changed.insert(at, 1, c);
                        break;
                    case 2:
                        changed.erase(at, random() % 4 + 1);
                        break;
                    default:
                        changed.resize(at + 1);
                        break;
                }
            }
            try {
                Model model = parse(changed);
                // What came through keeps the promises of Model.
                auto const isIn = [](Ints const& indices, int least, std::size_t count) {
                    return std::all_of(indices.begin(), indices.end(), [&](int index) {
                        return index >= least && index < static_cast<int>(count);
                    });
                };
                auto const numVertices = model.positions.size() / 3;
                ASSERT_TRUE(isIn(model.faceVertices, 0, numVertices) &&
                            isIn(model.creaseVertices, 0, numVertices) &&
                            isIn(model.cornerVertices, 0, numVertices));
                ASSERT_TRUE(isIn(model.holes, 0, model.faceSizes.size()));
                ASSERT_TRUE(isIn(model.uvIndices, -1, model.uvs.size() / 2));
                ASSERT_TRUE(isIn(model.normalIndices, -1, model.normals.size() / 3));
                ASSERT_TRUE(model.uvIndices.empty() || model.uvIndices.size() == model.faceVertices.size());
                for (double const x : model.positions) ASSERT_TRUE(std::isfinite(x));
                for (float const s : model.creaseSharpness) ASSERT_TRUE(s >= 0 && s <= 10);
                ApplySharpText(changed, "m.sharp", model);
            } catch (ParseError const&) {
            }
        }
    }
}
