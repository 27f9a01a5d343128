// SPDX-License-Identifier: Apache-2.0
#pragma once

/// \file
/// What the tests of `osd_shading/io` share: a folder that cleans up, files as strings, a result made by hand.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "osd_shading/io/objReader.h"
#include "osd_shading/shadingResult.h"

namespace ioFiles {

/// A new folder, removed with all that is in it.
class TemporaryFolder {
public:
    TemporaryFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "osd_shading_XXXXXX").string();
        if (!mkdtemp(name.data())) throw std::runtime_error("can't make a temporary folder");
        _path = name;
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(_path, ignored);
    }
    TemporaryFolder(TemporaryFolder const&) = delete;
    TemporaryFolder& operator=(TemporaryFolder const&) = delete;

    std::string File(std::string const& name) const { return (_path / name).string(); }
    std::string Path() const { return _path.string(); }

    std::size_t NumFiles() const {
        auto const files = std::filesystem::directory_iterator(_path);
        return static_cast<std::size_t>(std::distance(begin(files), end(files)));
    }

private:
    std::filesystem::path _path;
};

inline std::string ReadBytes(std::string const& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream bytes;
    bytes << file.rdbuf();
    return bytes.str();
}

inline void WriteBytes(std::string const& path, std::string const& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

/// The text of the `Expected` that `call` throws; anything else fails the test.
template <typename Expected, typename Call>
std::string ErrorOf(Call const& call) {
    try {
        call();
    } catch (Expected const& error) {
        return error.what();
    } catch (std::exception const& error) {
        ADD_FAILURE() << "another exception: " << error.what();
        return {};
    }
    ADD_FAILURE() << "no exception";
    return {};
}

/// All `.obj` files under `folder`, sorted; none where it is absent.
inline std::vector<std::string> ObjFilesIn(std::string const& folder) {
    std::vector<std::string> paths;
    std::error_code absent;
    for (auto const& entry : std::filesystem::recursive_directory_iterator(folder, absent)) {
        if (entry.path().extension() == ".obj") paths.push_back(entry.path().string());
    }
    std::sort(paths.begin(), paths.end());
    return paths;
}

#if defined(OSD_SHADING_MODELS)
/// The models that the project ships.
inline std::vector<std::string> OwnModels() { return ObjFilesIn(OSD_SHADING_MODELS); }
#endif

/// The shared models; none where their folder is absent.
inline std::vector<std::string> SharedModels() {
#if defined(OSD_SHADING_EXTRA_MODELS)
    return ObjFilesIn(OSD_SHADING_EXTRA_MODELS);
#else
    return {};
#endif
}

constexpr char kNoSharedModels[] = "the shared models are absent: set OSD_SHADING_EXTRA_MODELS to their folder";

/// Two unit squares that meet in a sharp edge over the y axis, one along x, one along z:
///
///     vertices 0 (0,0,0), 1 (0,1,0) on the edge with two values each; 2 (1,0,0), 3 (1,1,0), 4 (0,0,1), 5 (0,1,1);
///     6 (5,5,5) alone, without a value
///     values   0, 1: of vertex 0; 2, 3: of vertex 1; 4 to 7: of vertices 2 to 5; the first region is along x
///     faces    0 2 3 1 with values 0 4 5 2; 0 1 5 4 with values 1 3 7 6
template <typename Real>
osd_shading::ShadingResult<Real> TwoSquares() {
    osd_shading::ShadingResult<Real> result;
    result.faceSize = 4;
    result.positions = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 1}, {0, 1, 1}, {5, 5, 5}};
    result.positions[2].x = Real(1) / Real(3);  // a number that few digits don't hold
    result.vertexTags.resize(7);
    result.vertexValues = {0, 2, 4, 5, 6, 7, 8, 8};
    result.valueVertices = {0, 0, 1, 1, 2, 3, 4, 5};
    result.faceVertices = {0, 2, 3, 1, 0, 1, 5, 4};
    result.faceValues = {0, 4, 5, 2, 1, 3, 7, 6};
    result.baseFaces = {0, 1};
    for (int value = 0; value < 8; ++value) {
        bool const isAlongX = value == 0 || value == 2 || value == 4 || value == 5;
        osd_shading::Vec3<Real> normal;
        (isAlongX ? normal.z : normal.x) = 1;
        result.limitNormals.push_back(normal);
        result.blendedNormals.push_back(normal);
        result.blendWeights.push_back(value == 4 ? Real(0.1) : Real(0));
        result.subdividedNormals.push_back(value == 4 ? osd_shading::Vec3<Real>{0, Real(0.6), Real(0.8)}
                                                      : osd_shading::Vec3<Real>{});
    }
    return result;
}

/// TwoSquares with UVs, behind a primvar of three numbers that is none. Each value has one UV; vertex 1 has the
/// same in both faces, vertex 4 the one that vertex 2 has.
template <typename Real>
osd_shading::ShadingResult<Real> TwoSquaresWithUvs() {
    auto result = TwoSquares<Real>();
    osd_shading::RefinedFaceVarying<Real> other, uvs;
    other.width = 3;
    other.values = {1, 2, 3};
    other.faceIndices.assign(8, 0);
    uvs.width = 2;
    uvs.values = {0, 0, 1, 0, 1, 1, 0, 1, Real(0.1), Real(0.25)};
    uvs.faceIndices = {0, 1, 2, 3, 0, 3, 4, 1};
    result.faceVaryingData = {other, uvs};
    return result;
}

}  // namespace ioFiles
