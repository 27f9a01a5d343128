// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/io/modelWriter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "osd_shading/io/errors.h"
#include "osd_shading/io/objReader.h"
#include "osd_shading/io/sharpReader.h"
#include "tests/ioFiles.h"

namespace osd_shading::io {
namespace {

using ioFiles::TemporaryFolder;

void ExpectSame(Model const& a, Model const& b) {
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.faceSizes, b.faceSizes);
    EXPECT_EQ(a.faceVertices, b.faceVertices);
    EXPECT_EQ(a.creaseVertices, b.creaseVertices);
    EXPECT_EQ(a.creaseSharpness, b.creaseSharpness);
    EXPECT_EQ(a.cornerVertices, b.cornerVertices);
    EXPECT_EQ(a.cornerSharpness, b.cornerSharpness);
    EXPECT_EQ(a.holes, b.holes);
    EXPECT_EQ(a.uvs, b.uvs);
    EXPECT_EQ(a.uvIndices, b.uvIndices);
    EXPECT_EQ(a.normals, b.normals);
    EXPECT_EQ(a.normalIndices, b.normalIndices);
    EXPECT_EQ(a.boundary, b.boundary);
    EXPECT_EQ(a.faceVarying, b.faceVarying);
    EXPECT_EQ(a.creasing, b.creasing);
    EXPECT_EQ(a.triangles, b.triangles);
}

using Sharpness = std::map<std::pair<int, int>, float>;

Sharpness SharpnessOf(Model const& model) {
    Sharpness sharpness;
    for (std::size_t i = 0; i < model.creaseSharpness.size(); ++i) {
        auto const [low, high] = std::minmax(model.creaseVertices[2 * i], model.creaseVertices[2 * i + 1]);
        if (model.creaseSharpness[i] > 0) {
            float& highest = sharpness[{low, high}];
            highest = std::max(highest, model.creaseSharpness[i]);
        }
    }
    return sharpness;
}

TEST(ModelWriter, WritesEveryTagAndIndexAsTheReaderKnowsThem) {
    Model const model = ParseObj(
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.1 -1e-300 2\nvt 0 0\nvt 0.25 1\nvn 0 0 1\n"
        "f 1/1/1 2/2/1 3//1\nf 1/2 3/1 4\nf 1 2 5\nt interpolateboundary 1/0/0 2\n"
        "t facevaryinginterpolateboundary 1/0/0 3\nt creasemethod 0/0/1 chaikin\nt smoothtriangles 0/0/1 smooth\n"
        "t crease 2/1/0 0 1 2.25\nt crease 2/1/0 1 0 0.1\nt corner 1/1/0 3 10\nt hole 1/0/0 1\n",
        "all.obj");
    TemporaryFolder const folder;
    WriteModel(folder.File("model.obj"), model);
    Model const read = ReadObj(folder.File("model.obj"));
    ExpectSame(read, model);
    EXPECT_TRUE(read.warnings.empty());
}

TEST(ModelWriter, WritesAllOurModelsSoThatTheyReadBackTheSame) {
    TemporaryFolder const folder;
    int numModels = 0;
    for (std::string const& file : ioFiles::OwnModels()) {
        SCOPED_TRACE(file);
        Model const model = ReadObj(file);
        WriteModel(folder.File("model.obj"), model);
        ExpectSame(ReadObj(folder.File("model.obj")), model);

        // The same sharpness of edges by way of a .sharp file, whatever was there before.
        WriteSharpFile(folder.File("model.sharp"), model);
        Model other = model;
        other.creaseSharpness.assign(other.creaseSharpness.size(), 9);
        ApplySharpFile(folder.File("model.sharp"), other);
        EXPECT_EQ(SharpnessOf(other), SharpnessOf(model));
        EXPECT_EQ(other.cornerSharpness, model.cornerSharpness);
        ++numModels;
    }
    EXPECT_GT(numModels, 10);
}

TEST(ModelWriter, SaysWhatCantBeWrittenAndLeavesNothing) {
    Model const model = ParseObj("v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n", "triangle.obj");
    TemporaryFolder const folder;
    std::string const file = folder.File("no/folder.obj");
    EXPECT_NE(ioFiles::ErrorOf<WriteError>([&] { WriteModel(file, model); }).find(file), std::string::npos);
    EXPECT_NE(ioFiles::ErrorOf<WriteError>([&] { WriteSharpFile(file, model); }).find(file), std::string::npos);
    EXPECT_EQ(folder.NumFiles(), 0U);
}

}  // namespace
}  // namespace osd_shading::io
