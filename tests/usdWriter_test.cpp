// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/io/usdWriter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "ioFiles.h"
#include "osd_shading/errors.h"
#include "osd_shading/io/errors.h"
#include "osd_shading/io/objReader.h"

using namespace osd_shading;
using namespace osd_shading::io;
using ioFiles::TwoSquares;
using ioFiles::TwoSquaresWithUvs;

namespace {

using Attributes = std::map<std::string, std::string>;

template <typename Real>
std::string written(ShadingResult<Real> const& result, UsdOptions const& options = {},
                    std::string const& name = "two squares.usda") {
    ioFiles::TemporaryFolder const folder;
    WriteUsd(folder.File(name), result, options);
    return ioFiles::ReadBytes(folder.File(name));
}

void checkNesting(std::string const& text) {
    std::string open;
    bool isQuoted = false;
    for (char c : text) {
        if (c == '"') isQuoted = !isQuoted;
        if (isQuoted) continue;
        if (c == '{' || c == '(' || c == '[') open += c;
        for (std::string const pair : {"{}", "()", "[]"}) {
            if (c != pair[1]) continue;
            ASSERT_FALSE(open.empty());
            ASSERT_EQ(open.back(), pair[0]);
            open.pop_back();
        }
    }
    EXPECT_TRUE(open.empty() && !isQuoted);
}

// The attributes of a Mesh, "type name" to value; its interpolation as "NAME interpolation".
Attributes attributesOf(std::string const& text, std::string const& mesh) {
    checkNesting(text);
    Attributes attributes;
    std::size_t const at = text.find("    def Mesh \"" + mesh + "\"\n    {\n");
    if (at == std::string::npos) return attributes;
    std::istringstream lines(text.substr(at));
    std::string line, last;
    while (std::getline(lines, line) && line != "    }") {
        std::size_t const sign = line.find(" = ");
        if (sign == std::string::npos) continue;
        std::string value = line.substr(sign + 3);
        if (line.compare(0, 12, "            ") == 0) {
            attributes[last + ' ' + line.substr(12, sign - 12)] = value;
            continue;
        }
        if (value.back() == '(') value.resize(value.size() - 2);
        last = line.substr(8, sign - 8);
        EXPECT_TRUE(attributes.emplace(last, value).second) << last;
    }
    return attributes;
}

std::size_t numElements(std::string const& array) {
    if (array.find('(') != std::string::npos) {
        return static_cast<std::size_t>(std::count(array.begin(), array.end(), '('));
    }
    return array == "[]" ? 0 : static_cast<std::size_t>(std::count(array.begin(), array.end(), ',')) + 1;
}

// A cage with everything that a subdivision mesh can say.
Model taggedModel() {
    return ParseObj(
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
        "f 1/1 2/2 3/3 4/4\nf 2/1 5/2 6/3 3/4\n"
        "t crease 2/1/0 1 2 2.5\nt crease 2/1/0 2 1 1\nl 1 2\nt corner 1/1/0 0 3\nt corner 1/1/0 0 1.5\n"
        "t hole 1/0/0 1\nt interpolateboundary 1/0/0 2\nt facevaryinginterpolateboundary 1/0/0 1\n"
        "t smoothtriangles 0/0/1 smooth\nt creasemethod 0/0/1 chaikin\n",
        "m.obj");
}

UsdOptions cageOf(Model const& model, ControlMesh const& mesh) {
    UsdOptions options;
    options.cage = &mesh;
    options.cagePositions = {model.positions.data(), model.positions.size() / 3};
    options.cageUvs = {model.uvIndices, {model.uvs.data(), model.uvs.size() / 2, 2}};
    return options;
}

}  // namespace

TEST(UsdWriter, TheFileBeginsWithItsDefaultPrimNamedForIt) {
    std::string const head =
        "#usda 1.0\n(\n    defaultPrim = \"two_squares\"\n    metersPerUnit = 1\n    upAxis = \"Y\"\n)\n\n"
        "def Xform \"two_squares\"\n{\n    def Mesh \"shaded\"\n    {\n";
    EXPECT_EQ(written(TwoSquares<float>()).substr(0, head.size()), head);
    EXPECT_NE(written(TwoSquares<float>(), {}, "3d.usda").find("defaultPrim = \"_3d\""), std::string::npos);
    EXPECT_NE(written(TwoSquares<float>(), {}, "\xC3\xA9.x.usda").find("defaultPrim = \"___x\""),
              std::string::npos);
}

TEST(UsdWriter, TheShadedMeshIsNoSubdivisionSurface) {
    Attributes const mesh = attributesOf(written(TwoSquares<float>()), "shaded");
    EXPECT_EQ(mesh,
              (Attributes{
                  {"uniform token subdivisionScheme", "\"none\""},
                  {"int[] faceVertexCounts", "[4, 4]"},
                  {"int[] faceVertexIndices", "[0, 2, 3, 1, 0, 1, 5, 4]"},
                  {"float3[] extent", "[(0, 0, 0), (5, 5, 5)]"},
                  {"point3f[] points",
                   "[(0, 0, 0), (0, 1, 0), (0.33333334, 0, 0), (1, 1, 0), (0, 0, 1), (0, 1, 1), (5, 5, 5)]"},
                  {"normal3f[] normals",
                   "[(0, 0, 1), (0, 0, 1), (0, 0, 1), (0, 0, 1), (1, 0, 0), (1, 0, 0), (1, 0, 0), (1, 0, 0)]"},
                  {"normal3f[] normals interpolation", "\"faceVarying\""},
                  {"float[] primvars:blendWeight", "[0, 0, 0, 0, 0.1, 0, 0, 0]"},
                  {"float[] primvars:blendWeight interpolation", "\"faceVarying\""},
                  {"int[] primvars:blendWeight:indices", "[0, 4, 5, 2, 1, 3, 7, 6]"},
              }));
}

TEST(UsdWriter, UvsAreAnIndexedPrimvarPerFaceCorner) {
    Attributes const mesh = attributesOf(written(TwoSquaresWithUvs<double>()), "shaded");
    EXPECT_EQ(mesh.at("texCoord2f[] primvars:st"), "[(0, 0), (1, 0), (1, 1), (0, 1), (0.1, 0.25)]");
    EXPECT_EQ(mesh.at("texCoord2f[] primvars:st interpolation"), "\"faceVarying\"");
    EXPECT_EQ(mesh.at("int[] primvars:st:indices"), "[0, 1, 2, 3, 0, 3, 4, 1]");
}

TEST(UsdWriter, TheCageIsASubdivisionMeshWithTheHighestSharpnessOfEachEdge) {
    Model const model = taggedModel();
    ControlMesh const mesh = model.Mesh(model.Rules({}));
    std::string const text = written(TwoSquaresWithUvs<double>(), cageOf(model, mesh));
    EXPECT_EQ(attributesOf(text, "cage"),
              (Attributes{
                  {"uniform token purpose", "\"guide\""},
                  {"uniform token subdivisionScheme", "\"catmullClark\""},
                  {"token interpolateBoundary", "\"edgeOnly\""},
                  {"token faceVaryingLinearInterpolation", "\"cornersOnly\""},
                  {"token triangleSubdivisionRule", "\"smooth\""},
                  {"custom uniform token osd_shading:creasingMethod", "\"chaikin\""},
                  {"int[] faceVertexCounts", "[4, 4]"},
                  {"int[] faceVertexIndices", "[0, 1, 2, 3, 1, 4, 5, 2]"},
                  {"float3[] extent", "[(0, 0, 0), (2, 1, 0)]"},
                  {"point3f[] points", "[(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 0, 0), (2, 1, 0)]"},
                  {"int[] holeIndices", "[1]"},
                  {"int[] creaseIndices", "[0, 1, 1, 2]"},
                  {"int[] creaseLengths", "[2, 2]"},
                  {"float[] creaseSharpnesses", "[10, 2.5]"},
                  {"int[] cornerIndices", "[0]"},
                  {"float[] cornerSharpnesses", "[3]"},
                  {"texCoord2f[] primvars:st", "[(0, 0), (1, 0), (1, 1), (0, 1)]"},
                  {"texCoord2f[] primvars:st interpolation", "\"faceVarying\""},
                  {"int[] primvars:st:indices", "[0, 1, 2, 3, 0, 1, 2, 3]"},
              }));
    EXPECT_EQ(attributesOf(text, "shaded").size(), 13u);
}

TEST(UsdWriter, ACageWithoutTagsHasTheDefaultRules) {
    Model const model = ParseObj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "m.obj");
    SubdivisionRules rules;
    rules.scheme = Sdc::SCHEME_LOOP;
    ControlMesh const mesh = model.Mesh(rules);
    Attributes const cage = attributesOf(written(TwoSquares<float>(), cageOf(model, mesh)), "cage");
    EXPECT_EQ(cage.at("uniform token subdivisionScheme"), "\"loop\"");
    EXPECT_EQ(cage.at("token interpolateBoundary"), "\"edgeAndCorner\"");
    EXPECT_EQ(cage.at("token faceVaryingLinearInterpolation"), "\"all\"");
    EXPECT_EQ(cage.at("token triangleSubdivisionRule"), "\"catmullClark\"");
    for (char const* const name : {"int[] creaseIndices", "int[] cornerIndices", "int[] holeIndices",
                                   "texCoord2f[] primvars:st", "custom uniform token osd_shading:creasingMethod"}) {
        EXPECT_EQ(cage.count(name), 0u) << name;
    }
}

TEST(UsdWriter, TheLengthsOfArraysFitTogether) {
    auto const result = TwoSquaresWithUvs<float>();
    Attributes const mesh = attributesOf(written(result), "shaded");
    std::size_t const numCorners = result.faceVertices.size();
    EXPECT_EQ(numElements(mesh.at("int[] faceVertexIndices")), numCorners);
    EXPECT_EQ(numElements(mesh.at("normal3f[] normals")), numCorners);
    EXPECT_EQ(numElements(mesh.at("int[] primvars:st:indices")), numCorners);
    EXPECT_EQ(numElements(mesh.at("int[] primvars:blendWeight:indices")), numCorners);
    EXPECT_EQ(numElements(mesh.at("float[] primvars:blendWeight")), result.blendWeights.size());
    EXPECT_EQ(numElements(mesh.at("point3f[] points")), result.positions.size());
}

TEST(UsdWriter, AnEmptyResultIsStillAFile) {
    Attributes const mesh = attributesOf(written(ShadingResult<float>()), "shaded");
    EXPECT_EQ(mesh.at("point3f[] points"), "[]");
    EXPECT_EQ(mesh.at("float3[] extent"), "[(0, 0, 0), (0, 0, 0)]");
}

TEST(UsdWriter, ACageWhoseArraysDoNotFitIsRefusedAndNothingIsWritten) {
    ioFiles::TemporaryFolder const folder;
    Model const model = taggedModel();
    ControlMesh const mesh = model.Mesh({});
    auto const errorOf = [&](UsdOptions const& options) {
        return ioFiles::ErrorOf<InvalidControlMesh>(
            [&] { WriteUsd(folder.File("out.usda"), TwoSquares<float>(), options); });
    };
    UsdOptions options = cageOf(model, mesh);
    options.cagePositions = {model.positions.data(), 5};
    EXPECT_EQ(errorOf(options), "the cage has 6 vertices, but 5 positions are given");
    options = cageOf(model, mesh);
    std::vector<int> const indices(8, 4);
    options.cageUvs.indices = indices;
    EXPECT_EQ(errorOf(options), "the cage's UVs take two numbers a value, and a valid index per face corner");
    ControlMesh broken = mesh;
    broken.creaseSharpness = {};
    options = cageOf(model, broken);
    EXPECT_EQ(errorOf(options), "the cage has other numbers of creases or corners than of their sharpness");

    Model large = model;
    large.positions[7] = 1e39;
    EXPECT_EQ(ioFiles::ErrorOf<WriteError>(
                  [&] { WriteUsd(folder.File("out.usda"), TwoSquares<float>(), cageOf(large, mesh)); }),
              folder.File("out.usda") +
                  ": can't be written: the position of the cage's vertex 2 is too large for the 32-bit numbers of "
                  "this format: scale the model, or write OBJ");
    auto result = TwoSquaresWithUvs<double>();
    result.faceVaryingData[1].values[3] = 1e50;
    EXPECT_THROW(WriteUsd(folder.File("out.usda"), result), WriteError);
    EXPECT_EQ(folder.NumFiles(), 0u);
}
