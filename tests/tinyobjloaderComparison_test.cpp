// SPDX-License-Identifier: Apache-2.0

// Our OBJ files beside tinyobjloader, which knows nothing of sharpness: positions, UVs, normals and faces must
// agree.
#include <gtest/gtest.h>
#include <tiny_obj_loader.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <string>
#include <vector>

#include "ioFiles.h"
#include "osd_shading/io/objReader.h"
#include "osd_shading/io/objWriter.h"

using namespace osd_shading;
using namespace osd_shading::io;

namespace {

// What both readers give: indices as in Model, -1 where a corner has none.
struct Plain {
    std::vector<int> faceSizes, vertices, uvs, normals;
    std::vector<double> positions;
};

Plain readWithTinyobj(std::string const& text) {
    tinyobj::ObjReaderConfig config;
    config.triangulate = false;
    config.vertex_color = false;
    tinyobj::ObjReader reader;
    EXPECT_TRUE(reader.ParseFromString(text, "", config)) << reader.Error();
    Plain plain;
    for (auto const x : reader.GetAttrib().vertices) plain.positions.push_back(x);
    for (auto const& shape : reader.GetShapes()) {
        for (auto const size : shape.mesh.num_face_vertices) plain.faceSizes.push_back(static_cast<int>(size));
        for (auto const& index : shape.mesh.indices) {
            plain.vertices.push_back(index.vertex_index);
            plain.uvs.push_back(index.texcoord_index);
            plain.normals.push_back(index.normal_index);
        }
    }
    return plain;
}

void expectAgreement(std::string const& text, std::string const& name) {
    Model const ours = ParseObj(text, name);
    Plain const theirs = readWithTinyobj(text);
    EXPECT_EQ(ours.faceSizes, theirs.faceSizes) << name;
    EXPECT_EQ(ours.faceVertices, theirs.vertices) << name;
    auto const orNone = [&](std::vector<int> indices) {
        if (indices.empty()) indices.assign(ours.faceVertices.size(), -1);
        return indices;
    };
    EXPECT_EQ(orNone(ours.uvIndices), theirs.uvs) << name;
    EXPECT_EQ(orNone(ours.normalIndices), theirs.normals) << name;
    ASSERT_EQ(ours.positions.size(), theirs.positions.size()) << name;
    for (std::size_t i = 0; i < ours.positions.size(); ++i) {
        // tinyobjloader keeps float, and reads its last digit only nearly.
        EXPECT_NEAR(ours.positions[i], theirs.positions[i], 1e-6 * (1 + std::abs(theirs.positions[i]))) << name;
    }
}

}  // namespace

TEST(TinyobjloaderComparison, BothReadAPlainFileAlike) {
    expectAgreement(
        "# plain\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv -1.5 2e-1 3\nvt 0 0\nvt 1 0\nvn 0 0 1\n"
        "f 1 2 3 4\nf 1/1 2/2 3/1\nf 1//1 2//1 5//1\nf -5/1/1 -4/2/1 -1/1/1\nf 1 2 3 4 5\n",
        "plain.obj");
}

TEST(TinyobjloaderComparison, BothReadTheSharedModelsAlike) {
    auto const paths = ioFiles::SharedModels();
    if (paths.empty()) GTEST_SKIP() << ioFiles::kNoSharedModels;
    int numCompared = 0;
    for (auto const& path : paths) {
        std::string text = ioFiles::ReadBytes(path);
        // Not plain: indices from 0; repeated vertices, which we refuse; a byte-order mark, which hides its line.
        if (text.compare(0, 3, "OFF") == 0 || text.compare(0, 1, "\xEF") == 0) continue;
        if (path.find("nonman_quadpole") != std::string::npos || path.find("nonman_edges") != std::string::npos) {
            continue;
        }
        // Tags are ours alone; tinyobjloader has lines of its own that begin with t.
        std::string plain;
        std::istringstream lines(text);
        for (std::string line; std::getline(lines, line);) {
            if (line.compare(0, 2, "t ") != 0 && line.compare(0, 6, "mtllib") != 0) plain += line + '\n';
        }
        expectAgreement(plain, path);
        ++numCompared;
    }
    EXPECT_GT(numCompared, 60);
}

TEST(TinyobjloaderComparison, WhatWeWriteItReads) {
    ioFiles::TemporaryFolder const folder;
    auto const result = ioFiles::TwoSquaresWithUvs<float>();
    WriteObj(folder.File("out.obj"), result);
    Plain const read = readWithTinyobj(ioFiles::ReadBytes(folder.File("out.obj")));
    EXPECT_EQ(read.faceSizes, (std::vector<int>{4, 4}));
    EXPECT_EQ(read.vertices, result.faceVertices);
    EXPECT_EQ(read.normals, result.faceValues);
    EXPECT_EQ(read.uvs, result.faceVaryingData[1].faceIndices);
}
