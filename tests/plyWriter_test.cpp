// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/io/plyWriter.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

#include "ioFiles.h"
#include "osd_shading/io/errors.h"

using namespace osd_shading;
using namespace osd_shading::io;
using ioFiles::TwoSquares;
using ioFiles::TwoSquaresWithUvs;

namespace {

struct Ply {
    std::string format;
    std::vector<std::string> properties;  // "float x"
    std::vector<std::vector<double>> vertices;
    std::vector<std::vector<int>> faces;
};

template <typename Number>
Number take(std::string const& bytes, std::size_t& at) {
    Number number{};
    EXPECT_LE(at + sizeof(number), bytes.size());
    if (at + sizeof(number) <= bytes.size()) std::memcpy(&number, bytes.data() + at, sizeof(number));
    at += sizeof(number);
    return number;
}

// Reads what WritePly may write, on a little-endian machine.
Ply readPly(std::string const& bytes) {
    Ply ply;
    std::string const headEnd = "end_header\n";
    std::size_t at = bytes.find(headEnd);
    EXPECT_NE(at, std::string::npos);
    std::istringstream head(bytes.substr(0, at));
    at += headEnd.size();
    std::string line;
    std::getline(head, line);
    EXPECT_EQ(line, "ply");
    std::size_t numVertices = 0, numFaces = 0;
    while (std::getline(head, line)) {
        std::istringstream words(line);
        std::string word, kind;
        words >> word >> kind;
        if (word == "format") {
            ply.format = kind;
        } else if (word == "element") {
            words >> (kind == "vertex" ? numVertices : numFaces);
        } else if (word == "property" && kind == "list") {
            EXPECT_EQ(line, "property list uchar int vertex_indices");
        } else if (word == "property") {
            std::string name;
            words >> name;
            ply.properties.push_back(kind + ' ' + name);
        } else {
            EXPECT_EQ(word, "comment");
        }
    }

    bool const isText = ply.format == "ascii";
    std::istringstream text(isText ? bytes.substr(at) : std::string());
    for (std::size_t i = 0; i < numVertices; ++i) {
        ply.vertices.emplace_back();
        for (auto const& property : ply.properties) {
            double value = 0;
            if (isText) {
                text >> value;
                if (property[0] == 'f') value = static_cast<float>(value);
            } else if (property[0] == 'f') {
                value = take<float>(bytes, at);
            } else {
                value = take<std::int32_t>(bytes, at);
            }
            ply.vertices.back().push_back(value);
        }
    }
    for (std::size_t i = 0; i < numFaces; ++i) {
        int size = 0;
        if (isText) {
            text >> size;
        } else {
            size = take<std::uint8_t>(bytes, at);
        }
        ply.faces.emplace_back(static_cast<std::size_t>(size));
        for (int& index : ply.faces.back()) {
            if (isText) {
                text >> index;
            } else {
                index = take<std::int32_t>(bytes, at);
            }
        }
    }
    if (isText) {
        EXPECT_TRUE(text);
        text >> line;
        EXPECT_TRUE(text.eof());
    } else {
        EXPECT_EQ(at, bytes.size());
    }
    return ply;
}

template <typename Real>
Ply written(ShadingResult<Real> const& result, PlyFormat format) {
    ioFiles::TemporaryFolder const folder;
    WritePly(folder.File("out.ply"), result, {format});
    EXPECT_EQ(folder.NumFiles(), 1u);
    return readPly(ioFiles::ReadBytes(folder.File("out.ply")));
}

// Two flat quads side by side, without creases; UVs differ along their common edge at vertex 1 alone, while vertex
// 4 has two UV values with the same numbers.
ShadingResult<double> stripWithSeam() {
    ShadingResult<double> result;
    result.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}};
    result.vertexValues = {0, 1, 2, 3, 4, 5, 6};
    result.valueVertices = {0, 1, 2, 3, 4, 5};
    result.faceVertices = result.faceValues = {0, 1, 4, 3, 1, 2, 5, 4};
    result.limitNormals.assign(6, {0, 0, 1});
    result.blendedNormals = result.limitNormals;
    result.subdividedNormals.assign(6, {});
    result.blendWeights.assign(6, 0);
    result.faceVaryingData.resize(1);
    result.faceVaryingData[0].width = 2;
    result.faceVaryingData[0].values = {0, 0, 0.5, 0, 0.5, 1, 0, 1, 0.75, 0, 1, 0, 1, 1, 0.5, 1};
    result.faceVaryingData[0].faceIndices = {0, 1, 2, 3, 4, 5, 6, 7};
    return result;
}

std::vector<std::string> const kProperties = {"float x",
                                              "float y",
                                              "float z",
                                              "float nx",
                                              "float ny",
                                              "float nz",
                                              "float blend_weight",
                                              "float limit_nx",
                                              "float limit_ny",
                                              "float limit_nz",
                                              "float subdivided_nx",
                                              "float subdivided_ny",
                                              "float subdivided_nz",
                                              "int vertex",
                                              "int region"};

}  // namespace

TEST(PlyWriter, EachValueIsAVertexWithAllItsNumbersInTheAgreedOrder) {
    for (PlyFormat const format : {PlyFormat::Binary, PlyFormat::Ascii}) {
        Ply const ply = written(TwoSquares<float>(), format);
        EXPECT_EQ(ply.format, format == PlyFormat::Ascii ? "ascii" : "binary_little_endian");
        EXPECT_EQ(ply.properties, kProperties);
        ASSERT_EQ(ply.vertices.size(), 8u);
        // Value 1: of vertex 0, the region along z.
        EXPECT_EQ(ply.vertices[1], (std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1}));
        // Value 4: of vertex 2, the one with a weight.
        EXPECT_EQ(ply.vertices[4],
                  (std::vector<double>{1.0f / 3.0f, 0, 0, 0, 0, 1, 0.1f, 0, 0, 1, 0, 0.6f, 0.8f, 2, 0}));
        EXPECT_EQ(ply.faces, (std::vector<std::vector<int>>{{0, 4, 5, 2}, {1, 3, 7, 6}}));
    }
}

TEST(PlyWriter, BinaryAndTextHoldTheSameNumbersInEitherPrecision) {
    Ply const binary = written(TwoSquaresWithUvs<double>(), PlyFormat::Binary);
    Ply const text = written(TwoSquaresWithUvs<double>(), PlyFormat::Ascii);
    Ply const single = written(TwoSquaresWithUvs<float>(), PlyFormat::Binary);
    EXPECT_EQ(binary.vertices, text.vertices);
    EXPECT_EQ(binary.vertices, single.vertices);
    EXPECT_EQ(binary.faces, text.faces);
}

TEST(PlyWriter, UvsStandLastAndTheFirstPrimvarOfTwoNumbersIsThem) {
    Ply const ply = written(TwoSquaresWithUvs<double>(), PlyFormat::Binary);
    ASSERT_EQ(ply.properties.size(), 17u);
    EXPECT_EQ(ply.properties[15], "float s");
    EXPECT_EQ(ply.properties[16], "float t");
    ASSERT_EQ(ply.vertices.size(), 8u);
    EXPECT_EQ(ply.vertices[7][15], 0.1f);
    EXPECT_EQ(ply.vertices[7][16], 0.25);
}

TEST(PlyWriter, AValueIsSplitWhereTheNumbersOfItsUvsDifferAndOnlyThere) {
    Ply const ply = written(stripWithSeam(), PlyFormat::Ascii);
    ASSERT_EQ(ply.vertices.size(), 7u);
    EXPECT_EQ(ply.faces, (std::vector<std::vector<int>>{{0, 1, 4, 3}, {6, 2, 5, 4}}));
    EXPECT_EQ(ply.vertices[1][15], 0.5);
    EXPECT_EQ(ply.vertices[6][15], 0.75);
    EXPECT_EQ(std::vector<double>(ply.vertices[6].begin(), ply.vertices[6].begin() + 15),
              std::vector<double>(ply.vertices[1].begin(), ply.vertices[1].begin() + 15));
}

TEST(PlyWriter, ValuesWithoutAFaceStay) {
    auto result = TwoSquaresWithUvs<float>();
    result.faceVertices.resize(4);
    result.faceValues.resize(4);
    result.faceVaryingData[1].faceIndices.resize(4);
    Ply const ply = written(result, PlyFormat::Binary);
    EXPECT_EQ(ply.vertices.size(), 8u);
    EXPECT_EQ(ply.faces.size(), 1u);
    result.faceVertices.clear();
    result.faceValues.clear();
    result.faceVaryingData.clear();
    EXPECT_EQ(written(result, PlyFormat::Ascii).faces.size(), 0u);
}

TEST(PlyWriter, PositionsTooLargeForFloatAreAnError) {
    ioFiles::TemporaryFolder const folder;
    auto result = TwoSquares<double>();
    result.positions[3].y = -1e39;
    EXPECT_EQ(
        ioFiles::ErrorOf<WriteError>([&] { WritePly(folder.File("out.ply"), result); }),
        folder.File("out.ply") +
            ": can't be written: the position of vertex 3 is too large for the 32-bit numbers of this format: "
            "scale the model, or write OBJ");
    EXPECT_EQ(folder.NumFiles(), 0u);
}
