// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opensubdiv/far/topologyRefiner.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "osd_shading/controlMesh.h"
#include "osd_shading/views.h"

/// Small control meshes as functions named for the feature that they test.
namespace shapes {

namespace Sdc = osd_shading::Sdc;
namespace Far = OpenSubdiv::OPENSUBDIV_VERSION::Far;

constexpr float kInfinite = 10.0F;  ///< OpenSubdiv's infinite sharpness

/// A control mesh that owns its arrays. Faces are counter-clockwise seen from outside.
struct Shape {
    std::string name;
    std::vector<double> positions;  ///< 3 per vertex
    std::vector<int> faceSizes;
    std::vector<int> faceVertices;
    std::vector<int> creaseVertices;  ///< 2 per crease
    std::vector<float> creaseSharpness;
    std::vector<int> cornerVertices;
    std::vector<float> cornerSharpness;
    std::vector<int> holes;
    osd_shading::SubdivisionRules rules;

    int NumVertices() const { return static_cast<int>(positions.size() / 3); }
    int NumFaces() const { return static_cast<int>(faceSizes.size()); }

    /// Views over this shape's arrays, valid as long as it is and is not changed.
    osd_shading::ControlMesh Mesh() const;
    osd_shading::PointView<double> Points() const;
    std::vector<float> FloatPositions() const;

    /// Vertices of each face.
    std::vector<std::vector<int>> Faces() const;
    void SetFaces(std::vector<std::vector<int>> const& faces);

    /// Every edge once, smaller vertex first, in ascending order.
    std::vector<std::vector<int>> Edges() const;

    // Building: each returns the shape itself, so that calls can be chained.
    Shape& Vertex(double x, double y, double z);
    Shape& Face(std::vector<int> const& vertices);
    Shape& Crease(int a, int b, float sharpness = kInfinite);
    Shape& CreasePath(std::vector<int> const& vertices, float sharpness = kInfinite);
    Shape& CreaseLoop(std::vector<int> const& vertices, float sharpness = kInfinite);
    Shape& CreaseAll(float sharpness = kInfinite);
    Shape& Corner(int vertex, float sharpness = kInfinite);
    Shape& Hole(int face);

    /// Loop rules; every larger face is cut into triangles from its first vertex.
    Shape& Loop();
    Shape& Chaikin();
    Shape& SmoothTriangles();
    Shape& Boundary(Sdc::Options::VtxBoundaryInterpolation boundary);

    /// Moves every vertex by up to `amount` in each axis, from a fixed seed: breaks symmetry and planarity.
    Shape& Jitter(double amount, std::uint32_t seed = 1);
};

/// Repeatable random numbers, the same on every platform (splitmix64).
class Random {
public:
    explicit Random(std::uint64_t seed) : _state(seed) {}
    std::uint64_t Bits();
    double Uniform(double low, double high);
    int Below(int count);  ///< 0 to count - 1
    bool Chance(double probability) { return Uniform(0, 1) < probability; }

private:
    std::uint64_t _state;
};

// Closed
Shape Cube();                     ///< 6 quads; face 0 is the top (vertices 4 5 6 7), face 1 the bottom
Shape Tetrahedron();              ///< 4 triangles
Shape Octahedron();               ///< 8 triangles, valence 4
Shape Icosahedron();              ///< 20 triangles, valence 5
Shape Pyramid(int sides);         ///< apex 0 over a base of one n-gon (the last face)
Shape Bipyramid(int sides);       ///< apices 0 and 1 over and under a ring 2 .. sides + 1
Shape Torus(int around, int up);  ///< quads, all of valence 4: vertex (i, j) is i * up + j
Shape Cross();                    ///< prism over a plus sign, quads: reflex vertical edges
Shape Pillow();                   ///< two quads back to back: every edge normal cancels, valence 2
Shape ValenceTwo();               ///< cube whose top is cut in two quads meeting at vertex 8, of valence 2
Shape MixedPolygons();            ///< triangles, quads, pentagons and a hexagon; vertex 12 has valence 2

// Open
Shape OpenBox();                        ///< the cube without its top
Shape QuadGrid(int columns, int rows);  ///< flat in z = 0: vertex (i, j) is j * (columns + 1) + i
Shape Tube(int around, int up);         ///< open at both ends: vertex (i, j) is j * around + i
Shape TriangleFan(int sides);           ///< centre 0, rim 1 .. sides; a shallow cone
Shape QuadFan(int sides);               ///< centre 0, quads (0, 2k + 1, 2k + 2, 2k + 3); a shallow cone
Shape LoneTriangle();
Shape LoneQuad();

// Creased
Shape CubeWithSharpTop(float sharpness = kInfinite);     ///< closed crease 4 5 6 7
Shape GridWithDart(float sharpness = kInfinite);         ///< 4 x 4 grid, crease from the left side to the centre 12
Shape GridWithDartToDart(float sharpness = kInfinite);   ///< 4 x 4 grid, one lone sharp edge 12 13
Shape TorusWithCreaseRing(float sharpness = kInfinite);  ///< 6 x 4, creases at i = 0 and i = 3

// Beyond manifolds
Shape TwoBoxesSharingAnEdge();
Shape TwoBoxesSharingAVertex();
Shape FinnedGrid();               ///< a grid with a third sheet on its middle row: interior non-manifold crease
Shape FlippedFace();              ///< two quads that run along their common edge in the same direction
Shape BowTieAndIsolatedVertex();  ///< as many (vertex, region) pairs as vertices, though not one each
Shape IsolatedVertex();           ///< cube and a vertex 8 of no face

struct RandomShapeOptions {
    bool triangles = false;    ///< for Loop
    bool nonManifold = false;  ///< may weld vertices together
    bool chaikin = false;
    bool infiniteOnly = false;  ///< every crease infinitely sharp
};

/// A jittered mesh of up to some 40 faces with random holes, openings, splits, creases and corners. Sharpness is
/// a multiple of 1/8, so that sums of it are exact in float in any order.
Shape RandomShape(std::uint64_t seed, RandomShapeOptions const& options = {});

/// Every shape above that Catmull-Clark takes, plain and creased, each with its name.
std::vector<Shape> CatmarkShapes();
/// Those that make sense as triangles.
std::vector<Shape> LoopShapes();

/// OpenSubdiv's own refiner of a shape, refined uniformly with full topology. `faceVarying`: a value per face
/// corner, 0 to `numValues` - 1, of one face-varying channel; empty for none.
std::unique_ptr<Far::TopologyRefiner> MakeRefiner(Shape const& shape, int level,
                                                  std::vector<int> const& faceVarying = {}, int numValues = 0);

}  // namespace shapes
