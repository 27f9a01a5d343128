// SPDX-License-Identifier: Apache-2.0

// Arguments that nobody means well with, at every door of the library: each with the exact words of its refusal,
// the same at all doors that it can come through, or with what comes out.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "osd_shading/geometryCheck.h"
#include "osd_shading/limitSurface.h"
#include "osd_shading/primvarTable.h"
#include "osd_shading/shadingEvaluator.h"
#include "osd_shading/shadingStencils.h"
#include "tests/testHelpers.h"

namespace osd_shading::tests {
namespace {

constexpr int kLeast = std::numeric_limits<int>::min(), kMost = std::numeric_limits<int>::max();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();
constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

/// All that the doors take, right as it stands: a cube.
struct Arguments {
    Shape cube = shapes::Cube();
    std::vector<double> uvs = std::vector<double>(16, 0.5);
    std::vector<double> normals = std::vector<double>(72, 0.5);
    ControlMesh mesh = cube.Mesh();
    ShadingInput<double> input;
    ShadingOptions options = PaperPreset(1);

    Arguments() { input.positions = cube.Points(); }
    Arguments(Arguments const&) = delete;
    Arguments& operator=(Arguments const&) = delete;

    /// The views once more, after the cube has changed.
    void See() {
        mesh = cube.Mesh();
        input.positions = cube.Points();
    }
};

using Change = std::function<void(Arguments&)>;
struct Case {
    char const* name;
    Change change;
    std::string expected;
};

/// The words of whatever error of the library `call` throws.
template <typename Call>
std::string wordsOf(Call const& call) {
    return ErrorOf<Error>(call);
}

std::string oneShotWords(Arguments const& a) {
    return wordsOf([&] { ShadeSubdivision(a.mesh, a.input, a.options); });
}
std::string tableWords(Arguments const& a) {
    return wordsOf([&] { ShadingTable(a.mesh, a.options); });
}
std::string stencilWords(Arguments const& a) {
    return wordsOf([&] { BuildShadingStencils(a.mesh, a.options); });
}
std::string surfaceWords(Arguments const& a) {
    return wordsOf([&] { LimitSurface<double>(a.mesh, a.input, a.options).Evaluate(0, 0, 0); });
}
std::string primvarWords(Arguments const& a) {
    return wordsOf([&] { BuildPrimvarTable<float>(a.mesh, {}, a.options); });
}

Change toCube(std::function<void(Shape&)> const& change) {
    return [change](Arguments& a) {
        change(a.cube);
        a.See();
    };
}

TEST(HostileApi, MeshesThatCannotBeAreRefusedInTheSameWordsAtEveryDoor) {
    int const one[] = {0};
    std::vector<Case> const cases = {
        {"default", [](Arguments& a) { a.mesh = {}; }, "numVertices is 0; a mesh needs vertices"},
        {"least vertices", [](Arguments& a) { a.mesh.numVertices = kLeast; },
         "numVertices is -2147483648; a mesh needs vertices"},
        {"no faces", [](Arguments& a) { a.mesh.faceSizes = {}; }, "the mesh has no faces"},
        {"no face vertices", [](Arguments& a) { a.mesh.faceVertices = {}; },
         "faceVertices has 0 elements, fewer than faceSizes adds up to (it ends in face 0)"},
        {"sizes beyond 32 bits together",
         [](Arguments& a) {
             a.cube.faceSizes.assign(6, 65535);
             a.See();
         },
         "faceVertices has 24 elements, fewer than faceSizes adds up to (it ends in face 0)"},
        {"largest size", toCube([](Shape& s) { s.faceSizes[2] = kMost; }),
         "face 2 has 2147483647 vertices; OpenSubdiv takes at most 65535"},
        {"least size", toCube([](Shape& s) { s.faceSizes[2] = kLeast; }),
         "face 2 has -2147483648 vertices; a face needs 3 or more"},
        {"digon", toCube([](Shape& s) { s.faceSizes[0] = 2; }), "face 0 has 2 vertices; a face needs 3 or more"},
        {"largest vertex", toCube([](Shape& s) { s.faceVertices[23] = kMost; }),
         "face 5 names vertex 2147483647; there are 8 vertices"},
        {"repeated at the ends", toCube([](Shape& s) { s.faceVertices[3] = s.faceVertices[0]; }),
         "face 0 names vertex 4 twice"},
        {"repeated side by side", toCube([](Shape& s) { s.faceVertices[5] = s.faceVertices[4]; }),
         "face 1 names vertex 0 twice"},
        {"largest crease", toCube([](Shape& s) { s.Crease(kMost, 0); }),
         "crease 0 (vertices 2147483647, 0) names vertex 2147483647; there are 8 vertices"},
        {"least crease", toCube([](Shape& s) { s.Crease(0, 1).Crease(1, kLeast); }),
         "crease 1 (vertices 1, -2147483648) names vertex -2147483648; there are 8 vertices"},
        {"a face's diagonal", toCube([](Shape& s) { s.Crease(5, 7); }),
         "crease 0 names vertices 5 and 7, which no edge joins"},
        {"NaN behind a good entry of the edge", toCube([](Shape& s) { s.Crease(0, 1, 2).Crease(1, 0, kNan); }),
         "sharpness of crease 1 (vertices 1, 0) is not a number; give 0 or more"},
        {"least sharpness", toCube([](Shape& s) { s.Crease(0, 1, std::numeric_limits<float>::lowest()); }),
         "sharpness of crease 0 (vertices 0, 1) is -3.40282e+38; give 0 or "
         "more"},
        {"barely negative corner", toCube([](Shape& s) { s.Corner(2, -1e-30F); }),
         "sharpness of corner 0 (vertex 2) is -1e-30; give 0 or more"},
        {"minus infinite corner", toCube([](Shape& s) { s.Corner(2, -kInfinity); }),
         "sharpness of corner 0 (vertex 2) is -inf; give 0 or more"},
        {"largest corner", toCube([](Shape& s) { s.Corner(kMost, 1); }),
         "corner 0 (vertex 2147483647) is out of range; there are 8 vertices"},
        {"corners without sharpness",
         [&](Arguments& a) {
             a.mesh.cornerVertices = {one, 1};
         },
         "cornerVertices has 1 elements, cornerSharpness 0"},
        {"least hole", toCube([](Shape& s) { s.Hole(kLeast); }),
         "hole 0 names face -2147483648; there are 6 faces"},
        {"largest hole", toCube([](Shape& s) { s.Hole(0).Hole(kMost); }),
         "hole 1 names face 2147483647; there are 6 faces"},
        {"null faces",
         [](Arguments& a) {
             a.mesh.faceVertices = {nullptr, 24};
         },
         "faceVertices has 24 elements but its pointer is null"},
        {"views of all 64 bits",
         [&](Arguments& a) {
             a.mesh.holes = {one, ~std::size_t{0}};
         },
         "holes has 18446744073709551615 elements; OpenSubdiv takes at most 1073741823"},
        {"more holes than OpenSubdiv counts",
         [&](Arguments& a) {
             a.mesh.holes = {one, std::size_t{1} << 30};
         },
         "holes has 1073741824 elements; OpenSubdiv takes at most 1073741823"},
        {"a scheme that there is not", [](Arguments& a) { a.mesh.rules.scheme = static_cast<Sdc::SchemeType>(3); },
         "rules.scheme is 3, none that OpenSubdiv has"},
        {"a boundary rule that there is not",
         [](Arguments& a) { a.mesh.rules.boundary = static_cast<Sdc::Options::VtxBoundaryInterpolation>(3); },
         "rules.boundary is 3, none that OpenSubdiv has"},
        {"a face-varying rule that there is not",
         [](Arguments& a) { a.mesh.rules.faceVarying = static_cast<Sdc::Options::FVarLinearInterpolation>(7); },
         "rules.faceVarying is 7, none that OpenSubdiv has"},
        {"every edge against its neighbour", toCube([](Shape& s) {
             auto faces = s.Faces();
             for (std::size_t f = 0; f < 6; f += 2) faces[f] = {faces[f].rbegin(), faces[f].rend()};
             s.SetFaces(faces);
         }),
         "no error"},
        {"a face four times", toCube([](Shape& s) {
             for (int i = 0; i < 3; ++i) s.Face({4, 5, 6, 7});
         }),
         "no error"},
        {"all sharpness infinite", toCube([](Shape& s) { s.CreaseAll(kInfinity).Corner(0, kInfinity); }),
         "no error"},
        {"all faces holes twice", toCube([](Shape& s) {
             for (int f = 0; f < 12; ++f) s.Hole(f % 6);
         }),
         "no error"},
    };
    for (Case const& c : cases) {
        Arguments a;
        c.change(a);
        EXPECT_EQ(wordsOf([&] { ValidateControlMesh(a.mesh); }), c.expected) << c.name;
        EXPECT_EQ(oneShotWords(a), c.expected) << c.name;
        EXPECT_EQ(tableWords(a), c.expected) << c.name;
        EXPECT_EQ(stencilWords(a), c.expected) << c.name;
        EXPECT_EQ(surfaceWords(a), c.expected) << c.name;
        EXPECT_EQ(primvarWords(a), c.expected) << c.name;
    }
}

TEST(HostileApi, MoreVerticesThanOpenSubdivCountsAreRefusedBeforeMemoryIsTaken) {
    Arguments a;
    a.mesh.numVertices = 1 << 30;
    std::string const tooMany = "numVertices is 1073741824; OpenSubdiv takes at most 1073741823";
    EXPECT_EQ(tableWords(a), tooMany);
    EXPECT_EQ(stencilWords(a), tooMany);
    EXPECT_EQ(primvarWords(a), tooMany);
    EXPECT_EQ(wordsOf([&] { ValidateControlMesh(a.mesh); }), tooMany);
    // A limit is kept before anything is counted, also with fewer.
    a.mesh.numVertices = 1000000000;
    a.options.execution.memoryLimit = 1 << 28;
    std::string const tooMuch =
        "the 1000000000 vertices of level 0 would take about 30000000000 bytes, more than the limit of 268435456";
    EXPECT_EQ(ErrorOf<MemoryLimitExceeded>([&] { ShadingTable(a.mesh, a.options); }), tooMuch);
    EXPECT_EQ(ErrorOf<MemoryLimitExceeded>([&] { BuildShadingStencils(a.mesh, a.options); }), tooMuch);
    EXPECT_EQ(ErrorOf<MemoryLimitExceeded>([&] { BuildPrimvarTable<float>(a.mesh, {}, a.options); }), tooMuch);
    // There its points are asked for first.
    EXPECT_EQ(oneShotWords(a), "positions has 8 elements; the mesh needs 1000000000, one per vertex");
}

TEST(HostileApi, OptionsThatCannotBeAreRefusedInTheSameWordsAtEveryDoor) {
    std::vector<Case> const cases = {
        {"level -1", [](Arguments& a) { a.options.level = -1; }, "level is -1; it must be 0 to 15"},
        {"level 16", [](Arguments& a) { a.options.level = 16; }, "level is 16; it must be 0 to 15"},
        {"level 10^9", [](Arguments& a) { a.options.level = 1000000000; },
         "level is 1000000000; it must be 0 to 15"},
        {"least level", [](Arguments& a) { a.options.level = kLeast; }, "level is -2147483648; it must be 0 to 15"},
        {"a preset's level -1", [](Arguments& a) { a.options = SmoothPreset(-1); },
         "level is -1; it must be 0 to 15"},
        {"level 0 with a triangle",
         [](Arguments& a) {
             a.cube = shapes::Tetrahedron();
             a.See();
             a.options.level = 0;
         },
         "level is 0, but the mesh has faces other than quads, where limits exist from level 1 on"},
        {"threads -1", [](Arguments& a) { a.options.execution.numThreads = -1; },
         "numThreads is -1; it must be 0 or more"},
        {"least threads", [](Arguments& a) { a.options.execution.numThreads = kLeast; },
         "numThreads is -2147483648; it must be 0 or more"},
        {"positions that there are not", [](Arguments& a) { a.options.limits.positions = PositionKind(9); },
         "limits.positions is 9, none that there is"},
    };
    std::vector<Case> const shadingCases = {
        {"start level -2", [](Arguments& a) { a.options.startNormals.level = -2; },
         "the start level of normals is -2; it must be 0 to the level, 1"},
        {"largest start level", [](Arguments& a) { a.options.startNormals.level = kMost; },
         "the start level of normals is 2147483647; it must be 0 to the level, 1"},
        {"weights from 2 of 1", [](Arguments& a) { a.options.weights.level = 2; },
         "the start level of weights is 2; it must be 0 to the level, 1"},
        {"least level of weights", [](Arguments& a) { a.options.weights.level = kLeast; },
         "the start level of weights is -2147483648; it must be 0 to the level, 1"},
        {"exponent 0", [](Arguments& a) { a.options.weights.exponent = 0; },
         "the exponent of the blend weight is 0; it must be positive"},
        {"exponent NaN", [](Arguments& a) { a.options.weights.exponent = kNotANumber; },
         "the exponent of the blend weight is nan; it must be positive"},
        {"exponent infinite", [](Arguments& a) { a.options.weights.exponent = double{kInfinity}; },
         "the exponent of the blend weight is inf; it must be positive"},
        {"exponent negative", [](Arguments& a) { a.options.weights.exponent = -1e-300; },
         "the exponent of the blend weight is -1e-300; it must be positive"},
        {"steps -1", [](Arguments& a) { a.options.subdividedNormals.sphericalSteps = -1; },
         "sphericalSteps is -1; it must be 0 to 100"},
        {"steps 101", [](Arguments& a) { a.options.subdividedNormals.sphericalSteps = 101; },
         "sphericalSteps is 101; it must be 0 to 100"},
        {"start normals that there are not", [](Arguments& a) { a.options.startNormals.kind = StartNormalKind(6); },
         "startNormals.kind is 6, none that there is"},
        {"averaging that there is not",
         [](Arguments& a) { a.options.subdividedNormals.averaging = NormalAveraging(-1); },
         "subdividedNormals.averaging is -1, none that there is"},
        {"weights that there are not", [](Arguments& a) { a.options.weights.scheme = WeightScheme(5); },
         "weights.scheme is 5, none that there is"},
        {"sharp vertices that there are not",
         [](Arguments& a) { a.options.weights.sharpVertices = SharpVertexWeight(3); },
         "weights.sharpVertices is 3, none that there is"},
        {"darts that there are not", [](Arguments& a) { a.options.weights.darts = DartWeight(kMost); },
         "weights.darts is 2147483647, none that there is"},
        {"limit normals that there are not", [](Arguments& a) { a.options.limits.normals = LimitNormalKind(3); },
         "limits.normals is 3, none that there is"},
    };
    auto const expectAtDoors = [](Case const& c) {
        Arguments a;
        c.change(a);
        EXPECT_EQ(oneShotWords(a), c.expected) << c.name;
        EXPECT_EQ(tableWords(a), c.expected) << c.name;
        EXPECT_EQ(stencilWords(a), c.expected) << c.name;
        // There level -1 is left to the library.
        if (a.options.level != kDefaultSurfaceLevel) {
            EXPECT_EQ(surfaceWords(a), c.expected) << c.name;
        }
        auto const refiner = shapes::MakeRefiner(a.cube, 0);
        EXPECT_EQ(wordsOf([&] { ShadeSubdivision(*refiner, a.input, a.options); }), c.expected) << c.name;
        EXPECT_EQ(wordsOf([&] { ShadingTable(*refiner, a.options); }), c.expected) << c.name;
    };
    for (Case const& c : cases) {
        expectAtDoors(c);
        Arguments a;
        c.change(a);
        EXPECT_EQ(primvarWords(a), c.expected) << c.name;
    }
    for (Case const& c : shadingCases) expectAtDoors(c);
}

TEST(HostileApi, NumbersThatCannotBeAreRefusedAtTheirPlace) {
    std::vector<Case> const cases = {
        {"no points", [](Arguments& a) { a.input.positions = {}; },
         "positions has 0 elements; the mesh needs 8, one per vertex"},
        {"all 64 bits",
         [](Arguments& a) {
             a.input.positions = {a.uvs.data(), ~std::size_t{0}};
         },
         "positions has 18446744073709551615 elements; the mesh needs 8, one per vertex"},
        {"stride 0",
         [](Arguments& a) {
             a.input.positions = {a.cube.positions.data(), 8, 0};
         },
         "positions: its stride is 0; give 3 or more"},
        {"first NaN", [](Arguments& a) { a.cube.positions[0] = kNotANumber; }, "positions: vertex 0 is not finite"},
        {"y infinite", [](Arguments& a) { a.cube.positions[10] = double{kInfinity}; },
         "positions: vertex 3 is not finite"},
        {"z minus infinite", [](Arguments& a) { a.cube.positions[23] = -double{kInfinity}; },
         "positions: vertex 7 is not finite"},
        {"normals of vertices short",
         [](Arguments& a) {
             a.options.startNormals.kind = StartNormalKind::User;
             a.input.vertexNormals = {a.normals.data(), 7};
         },
         "vertexNormals has 7 elements; the mesh needs 8, one per vertex"},
        {"normals of vertices NaN",
         [](Arguments& a) {
             a.options.startNormals.kind = StartNormalKind::User;
             a.normals[4] = kNotANumber;
             a.input.vertexNormals = {a.normals.data(), 8};
         },
         "vertexNormals: vertex 1 is not finite"},
        {"normals of corners infinite",
         [](Arguments& a) {
             a.options.startNormals.kind = StartNormalKind::User;
             a.normals[71] = double{kInfinity};
             a.input.faceVaryingNormals = {a.normals.data(), 24};
         },
         "faceVaryingNormals: face corner 23 is not finite"},
        {"normals of corners, stride 0",
         [](Arguments& a) {
             a.options.startNormals.kind = StartNormalKind::User;
             a.input.faceVaryingNormals = {a.normals.data(), 24, 0};
         },
         "faceVaryingNormals: its stride is 0; give 3 or more"},
        {"normals of vertices null",
         [](Arguments& a) {
             a.options.startNormals.kind = StartNormalKind::User;
             a.input.vertexNormals = {nullptr, 8};
         },
         "vertexNormals: its pointer is null"},
        {"least width",
         [](Arguments& a) {
             a.input.vertexData = {{a.uvs.data(), 8, kLeast, 2}};
         },
         "vertexData 0: its width is -2147483648; give 1 or more"},
        {"stride 0 of vertex data",
         [](Arguments& a) {
             a.input.vertexData = {{a.uvs.data(), 8, 2, 0}};
         },
         "vertexData 0: its stride, 0, is less than its width, 2"},
        {"no vertex data", [](Arguments& a) { a.input.vertexData = {{}}; },
         "vertexData 0: its width is 0; give 1 or more"},
        {"values of all 64 bits",
         [](Arguments& a) {
             a.input.faceVaryingData = {{a.cube.faceVertices, {a.uvs.data(), ~std::size_t{0}, 2}}};
         },
         "faceVaryingData 0: too many values"},
        {"indices null",
         [](Arguments& a) {
             a.input.faceVaryingData = {{{nullptr, 24}, {a.uvs.data(), 8, 2}}};
         },
         "faceVaryingData 0: the pointer of its indices is null"},
        {"values none",
         [](Arguments& a) {
             a.input.faceVaryingData = {{a.cube.faceVertices, {a.uvs.data(), 0, 2}}};
         },
         "faceVaryingData 0: face corner 0 names value 4; there are 0"},
        {"zero normals",
         [](Arguments& a) {
             a.options.startNormals.kind = StartNormalKind::User;
             a.normals.assign(24, 0.0);
             a.input.vertexNormals = {a.normals.data(), 8};
         },
         "no error"},
        {"huge normals",
         [](Arguments& a) {
             a.options.startNormals.kind = StartNormalKind::User;
             a.normals.assign(24, 1e300);
             a.input.vertexNormals = {a.normals.data(), 8};
         },
         "no error"},
    };
    for (Case const& c : cases) {
        Arguments a;
        c.change(a);
        EXPECT_EQ(oneShotWords(a), c.expected) << c.name;
        // A surface carries no data along.
        bool const isOfData =
            c.expected.find("Data") != std::string::npos || std::string(c.name) == "no vertex data";
        EXPECT_EQ(surfaceWords(a), isOfData ? "no error" : c.expected) << c.name;
    }
}

}  // namespace
}  // namespace osd_shading::tests
