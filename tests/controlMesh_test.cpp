// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/controlMesh.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "tests/sampleSize.h"
#include "tests/testHelpers.h"

namespace {

using namespace osd_shading;
using namespace osd_shading::tests;

std::string ErrorIn(ControlMesh const& mesh) {
    return ErrorOf<InvalidControlMesh>([&] { ValidateControlMesh(mesh); });
}
std::string ErrorIn(Shape const& shape) { return ErrorIn(shape.Mesh()); }

float const kNan = std::numeric_limits<float>::quiet_NaN();
float const kInfinity = std::numeric_limits<float>::infinity();

TEST(ControlMesh, RulesDefaultToCatmullClarkWithSharpBoundaryCorners) {
    SubdivisionRules const rules;
    EXPECT_EQ(rules.scheme, Sdc::SCHEME_CATMARK);
    EXPECT_EQ(rules.boundary, Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    EXPECT_EQ(rules.faceVarying, Sdc::Options::FVAR_LINEAR_ALL);
    EXPECT_EQ(rules.creasing, Sdc::Options::CREASE_UNIFORM);
    EXPECT_EQ(rules.triangles, Sdc::Options::TRI_SUB_CATMARK);
}

TEST(ControlMesh, EveryShapeIsAccepted) {
    for (Shape const& shape : AllShapes()) EXPECT_EQ(ErrorIn(shape), "no error") << shape.name;
}

TEST(ControlMesh, EveryRandomShapeIsAccepted) {
    for (std::uint64_t seed = 0; seed < SampleSize(50); ++seed) {
        shapes::RandomShapeOptions options;
        options.nonManifold = seed % 2 == 0;
        EXPECT_EQ(ErrorIn(shapes::RandomShape(seed, options)), "no error") << seed;
    }
}

TEST(ControlMesh, EdgesOfSharpnessAreAccepted) {
    for (float const sharpness : {0.0F, -0.0F, 10.0F, 1e30F, kInfinity, std::numeric_limits<float>::denorm_min()}) {
        EXPECT_EQ(ErrorIn(shapes::Cube().Crease(0, 1, sharpness).Corner(3, sharpness)), "no error") << sharpness;
    }
}

TEST(ControlMesh, CreasesMayRunInEitherDirectionAndRepeat) {
    EXPECT_EQ(ErrorIn(shapes::Cube().Crease(0, 1).Crease(1, 0, 2).Corner(3).Corner(3, 1).Hole(2).Hole(2)),
              "no error");
}

TEST(ControlMesh, AllFacesMayBeHoles) {
    Shape shape = shapes::Cube();
    for (int f = 0; f < 6; ++f) shape.Hole(f);
    EXPECT_EQ(ErrorIn(shape), "no error");
}

TEST(ControlMesh, TheLargestFaceIsAccepted) {
    Shape shape;
    std::vector<int> face;
    for (int i = 0; i < 65535; ++i) {
        shape.Vertex(i, 0, 0);
        face.push_back(i);
    }
    EXPECT_EQ(ErrorIn(shape.Face(face)), "no error");
    shape.Vertex(0, 0, 0);
    face.push_back(65535);
    shape.SetFaces({face});
    EXPECT_EQ(ErrorIn(shape), "face 0 has 65536 vertices; OpenSubdiv takes at most 65535");
}

TEST(ControlMesh, TheLargestValenceIsAccepted) {
    // An open fan has one edge more than faces.
    Shape shape;
    shape.Vertex(0, 0, 0).Vertex(0, 0, 0);
    for (int i = 0; i < 65534; ++i) shape.Vertex(0, 0, 0).Face({0, i + 1, i + 2});
    EXPECT_EQ(ErrorIn(shape), "no error");
    shape.Face({0, 65535, 1});  // closes it
    EXPECT_EQ(ErrorIn(shape), "no error");
    shape.Vertex(0, 0, 0).Face({0, 1, 65536});
    EXPECT_EQ(ErrorIn(shape), "vertex 0 has more than 65535 faces, more than OpenSubdiv takes");
    shape.faceSizes.pop_back();
    shape.faceVertices.resize(shape.faceVertices.size() - 3);
    shape.faceVertices.back() = 65536;  // opens it again
    EXPECT_EQ(ErrorIn(shape), "vertex 0 has more than 65535 edges, more than OpenSubdiv takes");
}

TEST(ControlMesh, NullViewsAreNamed) {
    Shape const cube = shapes::Cube();
    auto const errorWith = [&](auto const& change) {
        ControlMesh mesh = cube.Mesh();
        change(mesh);
        return ErrorIn(mesh);
    };
    int const* const noInts = nullptr;
    float const* const noFloats = nullptr;
    EXPECT_EQ(errorWith([&](ControlMesh& m) {
                  m.faceSizes = {noInts, 6};
              }),
              "faceSizes has 6 elements but its pointer is null");
    EXPECT_EQ(errorWith([&](ControlMesh& m) {
                  m.faceVertices = {noInts, 24};
              }),
              "faceVertices has 24 elements but its pointer is null");
    EXPECT_EQ(errorWith([&](ControlMesh& m) {
                  m.creaseVertices = {noInts, 2};
              }),
              "creaseVertices has 2 elements but its pointer is null");
    EXPECT_EQ(errorWith([&](ControlMesh& m) {
                  m.creaseSharpness = {noFloats, 1};
              }),
              "creaseSharpness has 1 elements but its pointer is null");
    EXPECT_EQ(errorWith([&](ControlMesh& m) {
                  m.cornerVertices = {noInts, 1};
              }),
              "cornerVertices has 1 elements but its pointer is null");
    EXPECT_EQ(errorWith([&](ControlMesh& m) {
                  m.cornerSharpness = {noFloats, 1};
              }),
              "cornerSharpness has 1 elements but its pointer is null");
    EXPECT_EQ(errorWith([&](ControlMesh& m) {
                  m.holes = {noInts, 1};
              }),
              "holes has 1 elements but its pointer is null");
}

TEST(ControlMesh, ViewsBeyondOpenSubdivsIndicesAreRefused) {
    Shape const cube = shapes::Cube();
    ControlMesh mesh = cube.Mesh();
    mesh.faceVertices = {cube.faceVertices.data(), std::size_t{1} << 31};
    EXPECT_EQ(ErrorIn(mesh), "faceVertices has 2147483648 elements; OpenSubdiv takes at most 1073741823");
}

TEST(ControlMesh, TheBilinearSchemeIsRefused) {
    Shape cube = shapes::Cube();
    cube.rules.scheme = Sdc::SCHEME_BILINEAR;
    EXPECT_EQ(ErrorIn(cube), "the bilinear scheme has no normals to subdivide; use Catmull-Clark or Loop");
}

TEST(ControlMesh, AMeshNeedsVerticesAndFaces) {
    EXPECT_EQ(ErrorIn(ControlMesh{}), "numVertices is 0; a mesh needs vertices");
    ControlMesh mesh;
    mesh.numVertices = -1;
    EXPECT_EQ(ErrorIn(mesh), "numVertices is -1; a mesh needs vertices");
    EXPECT_EQ(ErrorIn(Shape().Vertex(0, 0, 0)), "the mesh has no faces");
}

TEST(ControlMesh, FacesOfFewerThanThreeVerticesAreRefused) {
    EXPECT_EQ(ErrorIn(shapes::Cube().Face({0, 1})), "face 6 has 2 vertices; a face needs 3 or more");
    EXPECT_EQ(ErrorIn(shapes::Cube().Face({})), "face 6 has 0 vertices; a face needs 3 or more");
    Shape shape = shapes::Cube();
    shape.faceSizes[1] = -4;
    EXPECT_EQ(ErrorIn(shape), "face 1 has -4 vertices; a face needs 3 or more");
}

TEST(ControlMesh, LoopTakesTrianglesOnly) {
    Shape cube = shapes::Cube();
    cube.rules.scheme = Sdc::SCHEME_LOOP;
    EXPECT_EQ(ErrorIn(cube),
              "face 0 has 4 vertices; Loop subdivision takes triangles only (triangulate, or use Catmull-Clark)");
}

TEST(ControlMesh, FaceVerticesMustBeAsManyAsFaceSizesAddUpTo) {
    Shape shape = shapes::Cube();
    shape.faceVertices.pop_back();
    EXPECT_EQ(ErrorIn(shape), "faceVertices has 23 elements, fewer than faceSizes adds up to (it ends in face 5)");
    shape = shapes::Cube();
    shape.faceVertices.push_back(0);
    EXPECT_EQ(ErrorIn(shape), "faceVertices has 25 elements; faceSizes adds up to 24");
}

TEST(ControlMesh, FacesNameVerticesThatExist) {
    EXPECT_EQ(ErrorIn(shapes::Cube().Face({0, 1, 8})), "face 6 names vertex 8; there are 8 vertices");
    EXPECT_EQ(ErrorIn(shapes::Cube().Face({0, 1, -1})), "face 6 names vertex -1; there are 8 vertices");
    EXPECT_EQ(ErrorIn(shapes::Cube().Face({0, 1, std::numeric_limits<int>::min()})),
              "face 6 names vertex -2147483648; there are 8 vertices");
}

TEST(ControlMesh, FacesNameAVertexOnce) {
    EXPECT_EQ(ErrorIn(shapes::Cube().Face({3, 1, 2, 1})), "face 6 names vertex 1 twice");
}

TEST(ControlMesh, CreasesHaveTwoVerticesPerSharpness) {
    Shape shape = shapes::Cube().Crease(0, 1);
    shape.creaseVertices.pop_back();
    EXPECT_EQ(ErrorIn(shape), "creaseVertices has 1 elements; 1 sharpnesses need two each");
    shape = shapes::Cube();
    shape.creaseVertices = {0, 1};
    EXPECT_EQ(ErrorIn(shape), "creaseVertices has 2 elements; 0 sharpnesses need two each");
}

TEST(ControlMesh, CreasesRunAlongEdges) {
    EXPECT_EQ(ErrorIn(shapes::Cube().Crease(0, 1).Crease(0, 6)),
              "crease 1 names vertices 0 and 6, which no edge joins");
    EXPECT_EQ(ErrorIn(shapes::Cube().Crease(4, 6)), "crease 0 names vertices 4 and 6, which no edge joins");
    EXPECT_EQ(ErrorIn(shapes::Cube().Crease(4, 4)), "crease 0 names vertices 4 and 4, which no edge joins");
    EXPECT_EQ(ErrorIn(shapes::Cube().Crease(8, 0)),
              "crease 0 (vertices 8, 0) names vertex 8; there are 8 vertices");
    EXPECT_EQ(ErrorIn(shapes::Cube().Crease(0, -1)),
              "crease 0 (vertices 0, -1) names vertex -1; there are 8 vertices");
}

TEST(ControlMesh, SharpnessIsANumberAndNotNegative) {
    EXPECT_EQ(ErrorIn(shapes::Cube().Crease(0, 1, kNan)),
              "sharpness of crease 0 (vertices 0, 1) is not a number; give 0 or more");
    EXPECT_EQ(ErrorIn(shapes::Cube().Crease(0, 1, -0.5F)),
              "sharpness of crease 0 (vertices 0, 1) is -0.5; give 0 or more");
    EXPECT_EQ(ErrorIn(shapes::Cube().Corner(5, kNan)),
              "sharpness of corner 0 (vertex 5) is not a number; give 0 or more");
    EXPECT_EQ(ErrorIn(shapes::Cube().Corner(5, -2)), "sharpness of corner 0 (vertex 5) is -2; give 0 or more");
    EXPECT_EQ(ErrorIn(shapes::Cube().Crease(0, 1, -kInfinity)),
              "sharpness of crease 0 (vertices 0, 1) is -inf; give 0 or more");
}

TEST(ControlMesh, CornersNameVerticesThatExist) {
    EXPECT_EQ(ErrorIn(shapes::Cube().Corner(8)), "corner 0 (vertex 8) is out of range; there are 8 vertices");
    EXPECT_EQ(ErrorIn(shapes::Cube().Corner(0).Corner(-1)),
              "corner 1 (vertex -1) is out of range; there are 8 vertices");
    Shape shape = shapes::Cube().Corner(0);
    shape.cornerSharpness.clear();
    EXPECT_EQ(ErrorIn(shape), "cornerVertices has 1 elements, cornerSharpness 0");
}

TEST(ControlMesh, HolesNameFacesThatExist) {
    EXPECT_EQ(ErrorIn(shapes::Cube().Hole(6)), "hole 0 names face 6; there are 6 faces");
    EXPECT_EQ(ErrorIn(shapes::Cube().Hole(5).Hole(-1)), "hole 1 names face -1; there are 6 faces");
}

}  // namespace
