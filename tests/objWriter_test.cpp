// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/io/objWriter.h"

#include <gtest/gtest.h>

#include <clocale>
#include <random>
#include <string>
#include <vector>

#include "ioFiles.h"
#include "osd_shading/io/errors.h"

using namespace osd_shading;
using namespace osd_shading::io;
using ioFiles::TwoSquares;
using ioFiles::TwoSquaresWithUvs;

namespace {

template <typename Real>
std::string written(ShadingResult<Real> const& result) {
    ioFiles::TemporaryFolder const folder;
    WriteObj(folder.File("out.obj"), result);
    return ioFiles::ReadBytes(folder.File("out.obj"));
}

}  // namespace

TEST(ObjWriter, TheTextIsAsExpected) {
    EXPECT_EQ(written(TwoSquares<float>()),
              "# osd_shading: 7 vertices, 2 faces\n"
              "v 0 0 0\nv 0 1 0\nv 0.33333334 0 0\nv 1 1 0\nv 0 0 1\nv 0 1 1\nv 5 5 5\n"
              "vn 0 0 1\nvn 1 0 0\nvn 0 0 1\nvn 1 0 0\nvn 0 0 1\nvn 0 0 1\nvn 1 0 0\nvn 1 0 0\n"
              "f 1//1 3//5 4//6 2//3\nf 1//2 2//4 6//8 5//7\n");
}

TEST(ObjWriter, OurReaderGetsBackEveryBit) {
    auto result = TwoSquaresWithUvs<double>();
    std::mt19937_64 random(1);
    for (auto& point : result.positions) {
        for (double* x : {&point.x, &point.y, &point.z}) *x = static_cast<double>(random()) * 1e-19 / 3;
    }
    result.positions[0] = {1e300, -5e-324, 0.1};
    Model const model = ParseObj(written(result), "out.obj");
    ASSERT_EQ(model.NumVertices(), 7);
    for (std::size_t i = 0; i < 7; ++i) {
        EXPECT_EQ(model.positions[3 * i], result.positions[i].x);
        EXPECT_EQ(model.positions[3 * i + 1], result.positions[i].y);
        EXPECT_EQ(model.positions[3 * i + 2], result.positions[i].z);
    }
    EXPECT_EQ(model.uvs, result.faceVaryingData[1].values);
    EXPECT_EQ(model.faceVertices, result.faceVertices);
    EXPECT_EQ(model.uvIndices, result.faceVaryingData[1].faceIndices);
    EXPECT_EQ(model.normalIndices, result.faceValues);
    EXPECT_EQ(model.normals.size(), 24u);
    EXPECT_TRUE(model.warnings.empty());
}

TEST(ObjWriter, TrianglesHaveThreeCorners) {
    auto result = TwoSquares<float>();
    result.faceSize = 3;
    result.faceVertices = {0, 2, 3, 0, 3, 1};
    result.faceValues = {0, 4, 5, 0, 5, 2};
    Model const model = ParseObj(written(result), "out.obj");
    EXPECT_EQ(model.faceSizes, (std::vector<int>{3, 3}));
    EXPECT_EQ(model.faceVertices, result.faceVertices);
}

TEST(ObjWriter, AFileThatCannotBeWrittenIsAnError) {
    ioFiles::TemporaryFolder const folder;
    EXPECT_THROW(WriteObj(folder.File("no/out.obj"), TwoSquares<float>()), WriteError);
    EXPECT_EQ(folder.NumFiles(), 0u);
}
