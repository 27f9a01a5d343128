// SPDX-License-Identifier: Apache-2.0
#include "tests/shapes.h"

#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace shapes {

namespace {

constexpr double kTau = 6.283185307179586;

Shape Named(char const* name) {
    Shape shape;
    shape.name = name;
    return shape;
}

std::size_t Index(int i) { return static_cast<std::size_t>(i); }

}  // namespace

osd_shading::ControlMesh Shape::Mesh() const {
    osd_shading::ControlMesh mesh;
    mesh.numVertices = NumVertices();
    mesh.faceSizes = faceSizes;
    mesh.faceVertices = faceVertices;
    mesh.creaseVertices = creaseVertices;
    mesh.creaseSharpness = creaseSharpness;
    mesh.cornerVertices = cornerVertices;
    mesh.cornerSharpness = cornerSharpness;
    mesh.holes = holes;
    mesh.rules = rules;
    return mesh;
}

osd_shading::PointView<double> Shape::Points() const { return {positions.data(), positions.size() / 3}; }

std::vector<float> Shape::FloatPositions() const {
    std::vector<float> result;
    for (double x : positions) result.push_back(static_cast<float>(x));
    return result;
}

std::vector<std::vector<int>> Shape::Faces() const {
    std::vector<std::vector<int>> faces;
    auto next = faceVertices.begin();
    for (int size : faceSizes) {
        faces.emplace_back(next, next + size);
        next += size;
    }
    return faces;
}

void Shape::SetFaces(std::vector<std::vector<int>> const& faces) {
    faceSizes.clear();
    faceVertices.clear();
    for (auto const& face : faces) Face(face);
}

std::vector<std::vector<int>> Shape::Edges() const {
    std::set<std::vector<int>> edges;
    for (auto const& face : Faces()) {
        for (std::size_t i = 0; i < face.size(); ++i) {
            int a = face[i], b = face[(i + 1) % face.size()];
            edges.insert({std::min(a, b), std::max(a, b)});
        }
    }
    return {edges.begin(), edges.end()};
}

Shape& Shape::Vertex(double x, double y, double z) {
    positions.insert(positions.end(), {x, y, z});
    return *this;
}

Shape& Shape::Face(std::vector<int> const& vertices) {
    faceSizes.push_back(static_cast<int>(vertices.size()));
    faceVertices.insert(faceVertices.end(), vertices.begin(), vertices.end());
    return *this;
}

Shape& Shape::Crease(int a, int b, float sharpness) {
    creaseVertices.insert(creaseVertices.end(), {a, b});
    creaseSharpness.push_back(sharpness);
    return *this;
}

Shape& Shape::CreasePath(std::vector<int> const& vertices, float sharpness) {
    for (std::size_t i = 0; i + 1 < vertices.size(); ++i) Crease(vertices[i], vertices[i + 1], sharpness);
    return *this;
}

Shape& Shape::CreaseLoop(std::vector<int> const& vertices, float sharpness) {
    CreasePath(vertices, sharpness);
    return Crease(vertices.back(), vertices.front(), sharpness);
}

Shape& Shape::CreaseAll(float sharpness) {
    for (auto const& edge : Edges()) Crease(edge[0], edge[1], sharpness);
    return *this;
}

Shape& Shape::Corner(int vertex, float sharpness) {
    cornerVertices.push_back(vertex);
    cornerSharpness.push_back(sharpness);
    return *this;
}

Shape& Shape::Hole(int face) {
    holes.push_back(face);
    return *this;
}

Shape& Shape::Loop() {
    rules.scheme = Sdc::SCHEME_LOOP;
    std::vector<std::vector<int>> triangles;
    std::vector<int> newHoles;
    auto const faces = Faces();
    for (std::size_t f = 0; f < faces.size(); ++f) {
        bool isHole = std::find(holes.begin(), holes.end(), static_cast<int>(f)) != holes.end();
        for (std::size_t i = 1; i + 1 < faces[f].size(); ++i) {
            if (isHole) newHoles.push_back(static_cast<int>(triangles.size()));
            triangles.push_back({faces[f][0], faces[f][i], faces[f][i + 1]});
        }
    }
    SetFaces(triangles);
    holes = newHoles;
    return *this;
}

Shape& Shape::Chaikin() {
    rules.creasing = Sdc::Options::CREASE_CHAIKIN;
    return *this;
}

Shape& Shape::SmoothTriangles() {
    rules.triangles = Sdc::Options::TRI_SUB_SMOOTH;
    return *this;
}

Shape& Shape::Boundary(Sdc::Options::VtxBoundaryInterpolation boundary) {
    rules.boundary = boundary;
    return *this;
}

Shape& Shape::Jitter(double amount, std::uint32_t seed) {
    Random random(seed);
    for (double& x : positions) x += random.Uniform(-amount, amount);
    return *this;
}

Shape Cube() {
    Shape s = Named("Cube");
    s.Vertex(-1, -1, -1).Vertex(1, -1, -1).Vertex(1, 1, -1).Vertex(-1, 1, -1);
    s.Vertex(-1, -1, 1).Vertex(1, -1, 1).Vertex(1, 1, 1).Vertex(-1, 1, 1);
    s.Face({4, 5, 6, 7}).Face({0, 3, 2, 1});
    s.Face({0, 1, 5, 4}).Face({1, 2, 6, 5}).Face({2, 3, 7, 6}).Face({3, 0, 4, 7});
    return s;
}

Shape Tetrahedron() {
    Shape s = Named("Tetrahedron");
    s.Vertex(1, 1, 1).Vertex(-1, -1, 1).Vertex(-1, 1, -1).Vertex(1, -1, -1);
    return s.Face({0, 2, 1}).Face({0, 1, 3}).Face({0, 3, 2}).Face({1, 2, 3});
}

Shape Octahedron() {
    Shape s = Bipyramid(4);
    s.name = "Octahedron";
    return s;
}

Shape Icosahedron() {
    Shape s = Named("Icosahedron");
    double const g = (1 + std::sqrt(5.0)) / 2;
    s.Vertex(-1, g, 0).Vertex(1, g, 0).Vertex(-1, -g, 0).Vertex(1, -g, 0);
    s.Vertex(0, -1, g).Vertex(0, 1, g).Vertex(0, -1, -g).Vertex(0, 1, -g);
    s.Vertex(g, 0, -1).Vertex(g, 0, 1).Vertex(-g, 0, -1).Vertex(-g, 0, 1);
    for (auto const& f : std::vector<std::vector<int>>{
             {0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
             {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
             {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}) {
        s.Face(f);
    }
    return s;
}

Shape Pyramid(int sides) {
    Shape s = Named("Pyramid");
    s.name += std::to_string(sides);
    s.Vertex(0, 0, 1);
    std::vector<int> base;
    for (int i = 0; i < sides; ++i) {
        s.Vertex(std::cos(kTau * i / sides), std::sin(kTau * i / sides), 0);
        s.Face({0, i + 1, (i + 1) % sides + 1});
        base.insert(base.begin(), i + 1);
    }
    return s.Face(base);
}

Shape Bipyramid(int sides) {
    Shape s = Named("Bipyramid");
    s.name += std::to_string(sides);
    s.Vertex(0, 0, 1).Vertex(0, 0, -1);
    for (int i = 0; i < sides; ++i) {
        s.Vertex(std::cos(kTau * i / sides), std::sin(kTau * i / sides), 0);
        int a = i + 2, b = (i + 1) % sides + 2;
        s.Face({0, a, b}).Face({1, b, a});
    }
    return s;
}

Shape Torus(int around, int up) {
    Shape s = Named("Torus");
    for (int i = 0; i < around; ++i) {
        for (int j = 0; j < up; ++j) {
            double u = kTau * i / around, v = kTau * j / up, r = 2 + std::cos(v);
            s.Vertex(r * std::cos(u), r * std::sin(u), std::sin(v));
        }
    }
    auto at = [=](int i, int j) { return i % around * up + j % up; };
    for (int i = 0; i < around; ++i) {
        for (int j = 0; j < up; ++j) s.Face({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
    return s;
}

Shape Cross() {
    Shape s = Named("Cross");
    double const outline[12][2] = {{1, 1},   {1, 3},   {-1, 3}, {-1, 1}, {-3, 1}, {-3, -1},
                                   {-1, -1}, {-1, -3}, {1, -3}, {1, -1}, {3, -1}, {3, 1}};
    for (double z : {0.0, 2.0}) {
        for (auto const& p : outline) s.Vertex(p[0], p[1], z);
    }
    for (int side = 0; side < 12; ++side) {
        int next = (side + 1) % 12;
        s.Face({side, next, next + 12, side + 12});
    }
    for (auto const& f :
         std::vector<std::vector<int>>{{0, 3, 6, 9}, {0, 1, 2, 3}, {3, 4, 5, 6}, {6, 7, 8, 9}, {9, 10, 11, 0}}) {
        s.Face({f[0] + 12, f[1] + 12, f[2] + 12, f[3] + 12});
        s.Face({f[3], f[2], f[1], f[0]});
    }
    return s;
}

Shape Pillow() {
    Shape s = Named("Pillow");
    s.Vertex(0, 0, 0).Vertex(2, 0, 0.3).Vertex(2.2, 1, -0.2).Vertex(0, 1.1, 0.1);
    return s.Face({0, 1, 2, 3}).Face({3, 2, 1, 0});
}

Shape ValenceTwo() {
    Shape s = Cube();
    s.name = "ValenceTwo";
    auto faces = s.Faces();
    faces[0] = {4, 5, 6, 8};
    faces.push_back({4, 8, 6, 7});
    s.SetFaces(faces);
    return s.Vertex(0.1, -0.2, 1.3);
}

Shape MixedPolygons() {
    // A hexagonal prism: the top stays one hexagon, the bottom is cut in quads, one side in triangles, and one
    // side gains a vertex on its lower edge, which makes it and its neighbour below pentagons.
    Shape s = Named("MixedPolygons");
    for (double z : {-1.0, 1.0}) {
        for (int i = 0; i < 6; ++i) {
            s.Vertex(std::cos(kTau * i / 6), std::sin(kTau * i / 6), z + 0.1 * i);
        }
    }
    s.Vertex(-0.8, -0.5, -0.9);
    s.Face({6, 7, 8, 9, 10, 11});
    s.Face({0, 3, 2, 1}).Face({0, 5, 4, 12, 3});
    s.Face({0, 1, 7, 6}).Face({1, 2, 8}).Face({1, 8, 7}).Face({2, 3, 9, 8});
    return s.Face({3, 12, 4, 10, 9}).Face({4, 5, 11, 10}).Face({5, 0, 6, 11});
}

Shape OpenBox() {
    Shape s = Cube();
    s.name = "OpenBox";
    auto faces = s.Faces();
    faces.erase(faces.begin());
    s.SetFaces(faces);
    return s;
}

Shape QuadGrid(int columns, int rows) {
    Shape s = Named("QuadGrid");
    int const stride = columns + 1;
    for (int j = 0; j <= rows; ++j) {
        for (int i = 0; i <= columns; ++i) s.Vertex(i, j, 0);
    }
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            int v = j * stride + i;
            s.Face({v, v + 1, v + stride + 1, v + stride});
        }
    }
    return s;
}

Shape Tube(int around, int up) {
    Shape s = Named("Tube");
    for (int j = 0; j <= up; ++j) {
        for (int i = 0; i < around; ++i) s.Vertex(std::cos(kTau * i / around), std::sin(kTau * i / around), j);
    }
    for (int j = 0; j < up; ++j) {
        for (int i = 0; i < around; ++i) {
            int a = j * around + i, b = j * around + (i + 1) % around;
            s.Face({a, b, b + around, a + around});
        }
    }
    return s;
}

Shape TriangleFan(int sides) {
    Shape s = Named("TriangleFan");
    s.name += std::to_string(sides);
    s.Vertex(0, 0, 0.4);
    for (int i = 0; i < sides; ++i) {
        s.Vertex(std::cos(kTau * i / sides), std::sin(kTau * i / sides), 0);
        s.Face({0, i + 1, (i + 1) % sides + 1});
    }
    return s;
}

Shape QuadFan(int sides) {
    Shape s = Named("QuadFan");
    s.name += std::to_string(sides);
    s.Vertex(0, 0, 0.4);
    for (int i = 0; i < 2 * sides; ++i) {
        double r = i % 2 == 0 ? 1 : 1.2, a = kTau * i / (2 * sides);
        s.Vertex(r * std::cos(a), r * std::sin(a), 0);
    }
    for (int i = 0; i < sides; ++i) s.Face({0, 2 * i + 1, 2 * i + 2, (2 * i + 2) % (2 * sides) + 1});
    return s;
}

Shape LoneTriangle() {
    Shape s = Named("LoneTriangle");
    return s.Vertex(0, 0, 0).Vertex(2, 0, 0).Vertex(0, 1, 0.5).Face({0, 1, 2});
}

Shape LoneQuad() {
    Shape s = Named("LoneQuad");
    return s.Vertex(0, 0, 0).Vertex(2, 0, 0).Vertex(2, 1, 0.5).Vertex(0, 1, 0).Face({0, 1, 2, 3});
}

Shape CubeWithSharpTop(float sharpness) {
    Shape s = Cube();
    s.name = "CubeWithSharpTop";
    return s.CreaseLoop({4, 5, 6, 7}, sharpness);
}

Shape GridWithDart(float sharpness) {
    Shape s = QuadGrid(4, 4);
    s.Jitter(0.2, 7);
    s.name = "GridWithDart";
    return s.CreasePath({10, 11, 12}, sharpness);
}

Shape GridWithDartToDart(float sharpness) {
    Shape s = QuadGrid(4, 4);
    s.Jitter(0.2, 8);
    s.name = "GridWithDartToDart";
    return s.Crease(12, 13, sharpness);
}

Shape TorusWithCreaseRing(float sharpness) {
    Shape s = Torus(6, 4);
    s.name = "TorusWithCreaseRing";
    return s.CreaseLoop({0, 1, 2, 3}, sharpness).CreaseLoop({12, 13, 14, 15}, sharpness);
}

Shape TwoBoxesSharingAnEdge() {
    Shape s = Cube();
    s.name = "TwoBoxesSharingAnEdge";
    // The second box is the first one moved by (2, 2, 0): its edge 0 4 falls on the first one's edge 2 6.
    Shape const box = Cube();
    int const map[8] = {2, 8, 9, 10, 6, 11, 12, 13};
    for (int v : {1, 2, 3, 5, 6, 7}) {
        double const* p = &box.positions[3 * Index(v)];
        s.Vertex(p[0] + 2, p[1] + 2, p[2]);
    }
    for (auto face : box.Faces()) {
        for (int& v : face) v = map[v];
        s.Face(face);
    }
    return s;
}

Shape TwoBoxesSharingAVertex() {
    Shape s = Cube();
    s.name = "TwoBoxesSharingAVertex";
    Shape const box = Cube();
    for (int v = 1; v < 8; ++v) {
        double const* p = &box.positions[3 * Index(v)];
        s.Vertex(p[0] + 2, p[1] + 2, p[2] + 2);
    }
    for (auto face : box.Faces()) {
        for (int& v : face) v = v == 0 ? 6 : 7 + v;
        s.Face(face);
    }
    return s;
}

Shape FinnedGrid() {
    Shape s = QuadGrid(4, 2);
    s.name = "FinnedGrid";
    // The fin stands on the whole middle row, vertices 5 to 9.
    for (int i = 0; i <= 4; ++i) s.Vertex(i, 1, 1);
    for (int i = 0; i < 4; ++i) s.Face({5 + i, 6 + i, 16 + i, 15 + i});
    return s;
}

Shape FlippedFace() {
    Shape s = QuadGrid(2, 1);
    s.name = "FlippedFace";
    auto faces = s.Faces();
    std::reverse(faces[1].begin(), faces[1].end());
    s.SetFaces(faces);
    return s;
}

Shape IsolatedVertex() {
    Shape s = Cube();
    s.name = "IsolatedVertex";
    return s.Vertex(3, 3, 3);
}

Shape BowTieAndIsolatedVertex() {
    Shape s = TwoBoxesSharingAVertex();
    s.name = "BowTieAndIsolatedVertex";
    return s.Vertex(5, 5, 5);
}

namespace {

std::vector<Shape> PlainShapes() {
    std::vector<Shape> all{Cube(),
                           Tetrahedron(),
                           Octahedron(),
                           Icosahedron(),
                           Pyramid(5),
                           Pyramid(6),
                           Bipyramid(7),
                           Torus(5, 4),
                           Cross(),
                           MixedPolygons(),
                           OpenBox(),
                           QuadGrid(3, 2).Jitter(0.2),
                           Tube(5, 2),
                           TriangleFan(5),
                           QuadFan(5),
                           LoneTriangle(),
                           CubeWithSharpTop(),
                           GridWithDart(),
                           GridWithDartToDart(),
                           TorusWithCreaseRing(),
                           TwoBoxesSharingAnEdge().Jitter(0.1),
                           TwoBoxesSharingAVertex().Jitter(0.1),
                           FinnedGrid().Jitter(0.1),
                           FlippedFace().Jitter(0.1),
                           IsolatedVertex(),
                           BowTieAndIsolatedVertex().Jitter(0.1)};
    auto add = [&](Shape shape, char const* name) {
        shape.name = name;
        all.push_back(shape);
    };
    add(CubeWithSharpTop(2), "CubeWithTopOfSharpness2");
    add(CubeWithSharpTop(1.25F), "CubeWithTopOfSharpness1.25");
    add(CubeWithSharpTop(2.75F).Crease(0, 4, 0.5F).Crease(2, 6), "CubeWithMixedSharpness");
    add(CubeWithSharpTop(2.5F).Crease(0, 4, 1.5F).Chaikin(), "CubeWithChaikinCreases");
    add(Cube().CreaseAll(), "CubeWithAllEdgesSharp");
    add(Cube().CreaseAll(1.5F), "CubeWithAllEdgesSemiSharp");
    add(Cube().Corner(6).Corner(0, 1.5F), "CubeWithCorners");
    add(GridWithDart(1.5F), "GridWithSemiSharpDart");
    add(GridWithDartToDart(2.25F), "GridWithSemiSharpLoneEdge");
    add(TorusWithCreaseRing(1.75F), "TorusWithSemiSharpRings");
    add(Icosahedron().CreaseLoop({11, 5, 1, 7, 10}, 2), "IcosahedronWithCreaseRing");
    add(OpenBox().Boundary(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY), "OpenBoxEdgeOnly");
    add(QuadGrid(4, 3).Jitter(0.2).Boundary(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY), "GridEdgeOnly");
    add(QuadGrid(4, 4).Jitter(0.2).Boundary(Sdc::Options::VTX_BOUNDARY_NONE), "GridWithoutBoundary");
    add(Torus(5, 4).Hole(3).Hole(7).Crease(1, 2, 1.5F), "TorusWithHoles");
    add(TwoBoxesSharingAnEdge().Jitter(0.1).CreaseLoop({4, 5, 6, 7}, 1.5F), "CreasedTwoBoxesSharingAnEdge");
    return all;
}

}  // namespace

std::vector<Shape> CatmarkShapes() {
    std::vector<Shape> all = PlainShapes();
    all.push_back(ValenceTwo());
    all.push_back(LoneQuad());
    all.push_back(Pyramid(5).SmoothTriangles());
    all.back().name = "PyramidWithSmoothTriangles";
    all.push_back(Icosahedron().SmoothTriangles().CreasePath({0, 1, 8}, 1.5F));
    all.back().name = "IcosahedronWithSmoothTriangles";
    return all;
}

std::vector<Shape> LoopShapes() {
    std::vector<Shape> all = PlainShapes();
    for (Shape& shape : all) {
        shape.Loop();
        shape.name += "AsTriangles";
    }
    return all;
}

std::unique_ptr<Far::TopologyRefiner> MakeRefiner(Shape const& shape, int level,
                                                  std::vector<int> const& faceVarying, int numValues) {
    Far::TopologyDescriptor descriptor;
    descriptor.numVertices = shape.NumVertices();
    descriptor.numFaces = shape.NumFaces();
    descriptor.numVertsPerFace = shape.faceSizes.data();
    descriptor.vertIndicesPerFace = shape.faceVertices.data();
    // OpenSubdiv takes the last entry of an edge or vertex, we the highest: name each once.
    std::map<std::pair<int, int>, float> creases;
    for (std::size_t i = 0; i < shape.creaseSharpness.size(); ++i) {
        float& s = creases[std::minmax(shape.creaseVertices[2 * i], shape.creaseVertices[2 * i + 1])];
        s = std::max(s, shape.creaseSharpness[i]);
    }
    std::map<int, float> corners;
    for (std::size_t i = 0; i < shape.cornerSharpness.size(); ++i) {
        float& s = corners[shape.cornerVertices[i]];
        s = std::max(s, shape.cornerSharpness[i]);
    }
    std::vector<int> pairs, vertices;
    std::vector<float> creaseWeights, cornerWeights;
    for (auto const& [pair, s] : creases) {
        pairs.insert(pairs.end(), {pair.first, pair.second});
        creaseWeights.push_back(s);
    }
    for (auto const& [vertex, s] : corners) {
        vertices.push_back(vertex);
        cornerWeights.push_back(s);
    }
    descriptor.numCreases = static_cast<int>(creaseWeights.size());
    descriptor.creaseVertexIndexPairs = pairs.data();
    descriptor.creaseWeights = creaseWeights.data();
    descriptor.numCorners = static_cast<int>(cornerWeights.size());
    descriptor.cornerVertexIndices = vertices.data();
    descriptor.cornerWeights = cornerWeights.data();
    descriptor.numHoles = static_cast<int>(shape.holes.size());
    descriptor.holeIndices = shape.holes.data();
    Far::TopologyDescriptor::FVarChannel channel;
    channel.numValues = numValues;
    channel.valueIndices = faceVarying.data();
    descriptor.numFVarChannels = faceVarying.empty() ? 0 : 1;
    descriptor.fvarChannels = &channel;

    Sdc::Options rules;
    rules.SetVtxBoundaryInterpolation(shape.rules.boundary);
    rules.SetFVarLinearInterpolation(shape.rules.faceVarying);
    rules.SetCreasingMethod(shape.rules.creasing);
    rules.SetTriangleSubdivision(shape.rules.triangles);
    using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
    std::unique_ptr<Far::TopologyRefiner> refiner(
        Factory::Create(descriptor, Factory::Options(shape.rules.scheme, rules)));
    Far::TopologyRefiner::UniformOptions uniform(level);
    uniform.fullTopologyInLastLevel = true;
    refiner->RefineUniform(uniform);
    return refiner;
}

}  // namespace shapes
