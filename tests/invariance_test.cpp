// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <opensubdiv/far/primvarRefiner.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "osd_shading/subdivisionShading.h"
#include "tests/naiveReference.h"
#include "tests/sampleSize.h"
#include "tests/shapes.h"

// What must not change a result, and what every result must keep.

namespace {

using namespace osd_shading;
using shapes::Random;
using shapes::Shape;
using tests::SweepLevel;
using Vector = Vec3<double>;

std::size_t U(int i) { return static_cast<std::size_t>(i); }

Vector Minus(Vector a, Vector b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
double Length(Vector v) { return std::hypot(v.x, v.y, v.z); }

/// Two orders of adding up the same numbers, and normalising sums that partly cancel.
constexpr double kRounding = 1e-9;

ShadingResult<double> ShadeShape(Shape const& shape, ShadingOptions const& options,
                                 std::vector<Vector> const& faceVaryingNormals = {}) {
    ShadingInput<double> input;
    input.positions = shape.Points();
    input.faceVaryingNormals = faceVaryingNormals;
    return ShadeSubdivision(shape.Mesh(), input, options);
}

ShadingOptions Options(int level, SharpVertexWeight sharp) {
    ShadingOptions options = PaperPreset(level);
    options.weights.sharpVertices = sharp;
    return options;
}

/// The options that the invariances are tested with: each variant and some of the modes.
std::vector<ShadingOptions> SomeOptions(int level) {
    std::vector<ShadingOptions> all{Options(level, SharpVertexWeight::Zero),
                                    Options(level, SharpVertexWeight::Smooth),
                                    Options(level, SharpVertexWeight::PerRegion), SmoothPreset(level)};
    all.push_back(PaperPreset(level));
    all.back().weights.scheme = WeightScheme::InverseLimit;
    all.back().startNormals.kind = StartNormalKind::Angle;
    all.back().subdividedNormals.averaging = NormalAveraging::Spherical;
    all.push_back(PaperPreset(level));
    all.back().weights.scheme = WeightScheme::ExtraordinaryOnly;
    all.back().startNormals.kind = StartNormalKind::CornerArea;
    all.back().subdividedNormals.averaging = NormalAveraging::Renormalised;
    all.back().limits.normals = LimitNormalKind::FaceAverage;
    return all;
}

/// Without symmetries, so that every face corner has a place of its own, and without smooth vertices of interior
/// valence 2 in Catmull-Clark (vertex 12 of the mixed polygons is made sharp): see the test of those.
std::vector<Shape> SomeShapes() {
    return {shapes::CubeWithSharpTop(1.5F).Crease(0, 4).Jitter(0.2),
            shapes::MixedPolygons().CreasePath({1, 8, 9}, 2.5F).Corner(4, 1.5F).Corner(12).Jitter(0.05),
            shapes::GridWithDart(),
            shapes::OpenBox().Crease(0, 1, 1.25F).Jitter(0.2),
            shapes::Torus(4, 3).Jitter(0.2).CreaseLoop({0, 1, 2}).Crease(3, 4, 0.5F),
            shapes::TwoBoxesSharingAnEdge().Jitter(0.2),
            shapes::CubeWithSharpTop(2.5F).Crease(0, 4, 1.5F).Chaikin().Jitter(0.2),
            shapes::Icosahedron().CreasePath({0, 1, 8}, 1.5F).Jitter(0.1).Loop(),
            shapes::Tube(5, 2).Crease(0, 5).Jitter(0.2).Loop()};
}

/// One face corner of a result, with what tells it from the others: where it is and where its face is.
struct Corner {
    std::array<double, 6> place;
    Vector position, limit, subdivided, blended;
    double weight = 0;
};

std::vector<Corner> Corners(ShadingResult<double> const& result) {
    std::vector<Corner> corners;
    auto const size = U(result.faceSize);
    for (std::size_t first = 0; first < result.faceVertices.size(); first += size) {
        Vector centre;
        for (std::size_t i = first; i < first + size; ++i) {
            Vector const p = result.positions[U(result.faceVertices[i])];
            double const share = 1 / static_cast<double>(size);
            centre = {centre.x + share * p.x, centre.y + share * p.y, centre.z + share * p.z};
        }
        for (std::size_t i = first; i < first + size; ++i) {
            Vector const p = result.positions[U(result.faceVertices[i])];
            auto const value = U(result.faceValues[i]);
            corners.push_back({{p.x, p.y, p.z, centre.x, centre.y, centre.z},
                               p,
                               result.limitNormals[value],
                               result.subdividedNormals[value],
                               result.blendedNormals[value],
                               result.blendWeights[value]});
        }
    }
    return corners;
}

testing::AssertionResult SameCorner(Corner const& a, Corner const& b, double tolerance) {
    auto const differs = [&](double difference) { return !(difference <= tolerance); };  // NaN differs
    if (differs(Length(Minus(a.position, b.position)))) return testing::AssertionFailure() << "positions differ";
    if (differs(std::abs(a.weight - b.weight))) {
        return testing::AssertionFailure() << "weights " << a.weight << " and " << b.weight << " differ";
    }
    if (differs(Length(Minus(a.limit, b.limit)))) return testing::AssertionFailure() << "limit normals differ";
    if (differs(Length(Minus(a.subdivided, b.subdivided)))) {
        return testing::AssertionFailure() << "subdivided normals differ";
    }
    if (differs(Length(Minus(a.blended, b.blended))))
        return testing::AssertionFailure() << "blended normals differ";
    return testing::AssertionSuccess();
}

/// Corner by corner in the same order.
testing::AssertionResult SameCorners(std::vector<Corner> const& a, std::vector<Corner> const& b,
                                     double tolerance = kRounding) {
    if (a.size() != b.size()) return testing::AssertionFailure() << a.size() << " and " << b.size() << " corners";
    for (std::size_t i = 0; i < a.size(); ++i) {
        auto const same = SameCorner(a[i], b[i], tolerance);
        if (!same) return testing::AssertionFailure() << same.message() << " at face corner " << i;
    }
    return testing::AssertionSuccess();
}

/// Whatever the order: each corner of `a` with the one of `b` in the same place.
testing::AssertionResult SameCornersInAnyOrder(std::vector<Corner> const& a, std::vector<Corner> b,
                                               double tolerance = kRounding) {
    if (a.size() != b.size()) return testing::AssertionFailure() << a.size() << " and " << b.size() << " corners";
    std::vector<Corner> ordered;
    for (Corner const& corner : a) {
        auto const distance = [&](Corner const& other) {
            double sum = 0;
            for (std::size_t k = 0; k < 6; ++k) sum += std::abs(corner.place[k] - other.place[k]);
            return sum;
        };
        auto const nearest = std::min_element(
            b.begin(), b.end(), [&](Corner const& x, Corner const& y) { return distance(x) < distance(y); });
        ordered.push_back(*nearest);
        b.erase(nearest);
    }
    return SameCorners(a, ordered, tolerance);
}

/// The directions and places of corners under a linear map, which for directions must be orthogonal.
std::vector<Corner> Mapped(std::vector<Corner> corners, std::array<Vector, 3> const& columns, double scale,
                           Vector offset, double side) {
    auto const turn = [&](Vector v, double s) -> Vector {
        return {s * (columns[0].x * v.x + columns[1].x * v.y + columns[2].x * v.z),
                s * (columns[0].y * v.x + columns[1].y * v.y + columns[2].y * v.z),
                s * (columns[0].z * v.x + columns[1].z * v.y + columns[2].z * v.z)};
    };
    for (Corner& c : corners) {
        Vector p = turn(c.position, scale), f = turn({c.place[3], c.place[4], c.place[5]}, scale);
        p = {p.x + offset.x, p.y + offset.y, p.z + offset.z};
        f = {f.x + offset.x, f.y + offset.y, f.z + offset.z};
        c.position = p;
        c.place = {p.x, p.y, p.z, f.x, f.y, f.z};
        c.limit = turn(c.limit, side);
        c.subdivided = turn(c.subdivided, side);
        c.blended = turn(c.blended, side);
    }
    return corners;
}

Shape Moved(Shape shape, std::array<Vector, 3> const& columns, double scale, Vector offset) {
    for (std::size_t i = 0; i < shape.positions.size(); i += 3) {
        double const x = shape.positions[i], y = shape.positions[i + 1], z = shape.positions[i + 2];
        shape.positions[i] = scale * (columns[0].x * x + columns[1].x * y + columns[2].x * z) + offset.x;
        shape.positions[i + 1] = scale * (columns[0].y * x + columns[1].y * y + columns[2].y * z) + offset.y;
        shape.positions[i + 2] = scale * (columns[0].z * x + columns[1].z * y + columns[2].z * z) + offset.z;
    }
    return shape;
}

std::array<Vector, 3> const kTurn{Vector{2 / 3.0, 2 / 3.0, -1 / 3.0}, Vector{-1 / 3.0, 2 / 3.0, 2 / 3.0},
                                  Vector{2 / 3.0, -1 / 3.0, 2 / 3.0}};
std::array<Vector, 3> const kIdentity{Vector{1, 0, 0}, Vector{0, 1, 0}, Vector{0, 0, 1}};
std::array<Vector, 3> const kMirror{Vector{-1, 0, 0}, Vector{0, 1, 0}, Vector{0, 0, 1}};

/// The same mesh with its vertices and faces in another order, and each face from another vertex on.
Shape Renumbered(Shape const& shape, Random& random) {
    auto const shuffled = [&](int count) {
        std::vector<int> order(U(count));
        std::iota(order.begin(), order.end(), 0);
        for (int i = count - 1; i > 0; --i) std::swap(order[U(i)], order[U(random.Below(i + 1))]);
        return order;
    };
    std::vector<int> const newVertex = shuffled(shape.NumVertices()), faceOrder = shuffled(shape.NumFaces());
    Shape result = shape;
    for (int v = 0; v < shape.NumVertices(); ++v) {
        std::copy_n(&shape.positions[U(3 * v)], 3, &result.positions[U(3 * newVertex[U(v)])]);
    }
    auto const faces = shape.Faces();
    std::vector<std::vector<int>> newFaces;
    for (int f : faceOrder) {
        std::vector<int> face = faces[U(f)];
        std::rotate(face.begin(), face.begin() + random.Below(static_cast<int>(face.size())), face.end());
        for (int& v : face) v = newVertex[U(v)];
        newFaces.push_back(face);
    }
    result.SetFaces(newFaces);
    for (int& v : result.creaseVertices) v = newVertex[U(v)];
    for (int& v : result.cornerVertices) v = newVertex[U(v)];
    for (int& f : result.holes) {
        f = static_cast<int>(std::find(faceOrder.begin(), faceOrder.end(), f) - faceOrder.begin());
    }
    return result;
}

template <typename T>
bool SameBits(std::vector<T> const& a, std::vector<T> const& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

testing::AssertionResult SameBitsEverywhere(ShadingResult<double> const& a, ShadingResult<double> const& b) {
    if (!SameBits(a.positions, b.positions)) return testing::AssertionFailure() << "positions";
    if (!SameBits(a.limitNormals, b.limitNormals)) return testing::AssertionFailure() << "limit normals";
    if (!SameBits(a.subdividedNormals, b.subdividedNormals))
        return testing::AssertionFailure() << "subdivided normals";
    if (!SameBits(a.blendedNormals, b.blendedNormals)) return testing::AssertionFailure() << "blended normals";
    if (!SameBits(a.blendWeights, b.blendWeights)) return testing::AssertionFailure() << "weights";
    if (!SameBits(a.faceVertices, b.faceVertices)) return testing::AssertionFailure() << "vertices of faces";
    if (!SameBits(a.faceValues, b.faceValues)) return testing::AssertionFailure() << "values of faces";
    if (!SameBits(a.valueVertices, b.valueVertices)) return testing::AssertionFailure() << "vertices of values";
    return testing::AssertionSuccess();
}

struct Point {
    double x[3] = {0, 0, 0};

    void Clear() { x[0] = x[1] = x[2] = 0; }
    template <typename Weight>
    void AddWithWeight(Point const& other, Weight weight) {
        for (int k = 0; k < 3; ++k) x[k] += static_cast<double>(weight) * other.x[k];
    }
};

}  // namespace

TEST(Invariance, MovingTurningAndScalingTheMeshMovesTurnsAndScalesTheResult) {
    for (Shape const& shape : SomeShapes()) {
        for (ShadingOptions const& options : SomeOptions(2)) {
            auto const plain = Corners(ShadeShape(shape, options));
            Shape const turned = Moved(shape, kTurn, 1, {0.5, -2, 1});
            EXPECT_TRUE(SameCorners(Mapped(plain, kTurn, 1, {0.5, -2, 1}, 1), Corners(ShadeShape(turned, options))))
                << shape.name;
            for (double scale : {1e-6, 1e5}) {
                Shape const scaled = Moved(shape, kIdentity, scale, {});
                // Positions are compared at the larger of the two sizes.
                EXPECT_TRUE(SameCorners(Mapped(plain, kIdentity, scale, {}, 1),
                                        Corners(ShadeShape(scaled, options)), kRounding))
                    << shape.name;
            }
        }
    }
}

TEST(Invariance, MirroringTheMeshMirrorsTheResult) {
    for (Shape const& shape : SomeShapes()) {
        Shape mirrored = Moved(shape, kMirror, 1, {});
        auto faces = shape.Faces();
        for (auto& face : faces) std::reverse(face.begin(), face.end());
        mirrored.SetFaces(faces);
        for (ShadingOptions const& options : SomeOptions(SweepLevel(2))) {
            // A reflected mesh whose faces were turned round has reflected normals on the same side.
            EXPECT_TRUE(SameCornersInAnyOrder(Mapped(Corners(ShadeShape(shape, options)), kMirror, 1, {}, 1),
                                              Corners(ShadeShape(mirrored, options))))
                << shape.name;
        }
    }
}

TEST(Invariance, TurningTheFacesInsideOutOnlyReversesTheNormals) {
    for (Shape const& shape : SomeShapes()) {
        Shape reversed = shape;
        auto faces = shape.Faces();
        for (auto& face : faces) std::reverse(face.begin(), face.end());
        reversed.SetFaces(faces);
        for (ShadingOptions const& options : SomeOptions(SweepLevel(2))) {
            EXPECT_TRUE(SameCornersInAnyOrder(Mapped(Corners(ShadeShape(shape, options)), kIdentity, 1, {}, -1),
                                              Corners(ShadeShape(reversed, options))))
                << shape.name;
        }
    }
}

TEST(Invariance, RenumberingVerticesAndFacesChangesNothing) {
    Random random(12);
    for (Shape const& shape : SomeShapes()) {
        Shape const renumbered = Renumbered(shape, random);
        for (ShadingOptions const& options : SomeOptions(SweepLevel(2))) {
            EXPECT_TRUE(SameCornersInAnyOrder(Corners(ShadeShape(shape, options)),
                                              Corners(ShadeShape(renumbered, options))))
                << shape.name;
        }
    }
}

TEST(Invariance, AtInteriorValenceTwoTheNumberingDecidesOnWhichSideTheLimitNormalPoints) {
    // OpenSubdiv's tangents there are the two edges, in the order of its ring, whose beginning is arbitrary.
    Random random(3);
    Shape const shape = shapes::ValenceTwo().Jitter(0.1);
    auto const plain = Corners(ShadeShape(shape, PaperPreset(2)));
    for (int i = 0; i < 8; ++i) {
        auto corners = Corners(ShadeShape(Renumbered(shape, random), PaperPreset(2)));
        for (Corner& c : corners) {
            bool const isReversed = std::any_of(plain.begin(), plain.end(), [&](Corner const& p) {
                return Length(Minus(p.position, c.position)) < kRounding &&
                       Length(Minus(p.limit, {-c.limit.x, -c.limit.y, -c.limit.z})) < kRounding;
            });
            if (isReversed) c.limit = {-c.limit.x, -c.limit.y, -c.limit.z};
        }
        EXPECT_TRUE(SameCornersInAnyOrder(plain, corners));
    }
}

TEST(Invariance, SharpnessZeroIsNoCrease) {
    for (Shape const& shape : {shapes::MixedPolygons(), shapes::OpenBox(), shapes::Icosahedron().Loop()}) {
        Shape zero = shape;
        zero.CreaseAll(0).Corner(0, 0);
        for (ShadingOptions const& options : SomeOptions(2)) {
            EXPECT_TRUE(SameBitsEverywhere(ShadeShape(shape, options), ShadeShape(zero, options))) << shape.name;
        }
    }
}

TEST(Invariance, OrderAndDirectionAndRepetitionOfCreaseEntriesDoNotMatter) {
    Shape const shape = shapes::CubeWithSharpTop(1.5F).Crease(0, 4, 2.5F).Corner(3, 0.5F).Corner(1, 1.5F);
    Shape other = shape;
    std::reverse(other.creaseVertices.begin(), other.creaseVertices.end());
    std::reverse(other.creaseSharpness.begin(), other.creaseSharpness.end());
    std::reverse(other.cornerVertices.begin(), other.cornerVertices.end());
    std::reverse(other.cornerSharpness.begin(), other.cornerSharpness.end());
    other.Crease(0, 4, 1).Corner(3, 0.25F);  // the highest counts
    EXPECT_TRUE(SameBitsEverywhere(ShadeShape(shape, PaperPreset(3)), ShadeShape(other, PaperPreset(3))));
}

TEST(Invariance, SharpnessOfTenAndMoreIsInfinite) {
    float const infinity = std::numeric_limits<float>::infinity();
    auto const ten = ShadeShape(shapes::CubeWithSharpTop(10), PaperPreset(3));
    EXPECT_TRUE(SameBitsEverywhere(ten, ShadeShape(shapes::CubeWithSharpTop(1000), PaperPreset(3))));
    EXPECT_TRUE(SameBitsEverywhere(ten, ShadeShape(shapes::CubeWithSharpTop(infinity), PaperPreset(3))));
}

TEST(Invariance, AConstantFieldOfUserNormalsStaysConstant) {
    Vector const normal{2 / 7.0, -3 / 7.0, 6 / 7.0};
    for (Shape const& shape : SomeShapes()) {
        std::vector<Vector> const normals(shape.faceVertices.size(), normal);
        for (auto averaging :
             {NormalAveraging::Linear, NormalAveraging::Renormalised, NormalAveraging::Spherical}) {
            for (int level : {1, 3}) {
                ShadingOptions options = PaperPreset(level);
                options.startNormals.kind = StartNormalKind::User;
                options.subdividedNormals.averaging = averaging;
                options.weights.scheme = WeightScheme::One;
                double worst = 0;
                for (Vector const& n : ShadeShape(shape, options, normals).blendedNormals) {
                    worst = std::max(worst, Length(Minus(n, normal)));
                }
                // Masks of up to some 20 weights that add to 1, three levels and the limit.
                EXPECT_LT(worst, 1e-13) << shape.name;
            }
        }
    }
}

TEST(Invariance, TheVariantsAgreeWhereThereIsNoSharpVertexAndNoDart) {
    for (Shape const& shape : {shapes::MixedPolygons(), shapes::Cross().Jitter(0.1), shapes::Pyramid(6),
                               shapes::Icosahedron().Loop(), shapes::Bipyramid(7).Loop()}) {
        for (auto scheme : {WeightScheme::OneRing, WeightScheme::ExtraordinaryOnly, WeightScheme::Bilinear,
                            WeightScheme::InverseLimit}) {
            std::vector<std::vector<Corner>> results;
            for (auto sharp : {SharpVertexWeight::Zero, SharpVertexWeight::Smooth, SharpVertexWeight::PerRegion}) {
                ShadingOptions options = Options(3, sharp);
                options.weights.scheme = scheme;
                results.push_back(Corners(ShadeShape(shape, options)));
            }
            // The same sums, perhaps in another order; the inverse limit solves for them.
            EXPECT_TRUE(SameCorners(results[0], results[1], 1e-12)) << shape.name;
            EXPECT_TRUE(SameCorners(results[0], results[2], 1e-12)) << shape.name;
        }
    }
}

TEST(Invariance, CuttingAMeshOpenAlongAClosedInfiniteCreaseGivesTheNormalsOfEachSide) {
    // Torus of 6 x 4, creases at i = 0 and i = 3: cut there, it is two tubes, each from one crease to the other.
    Shape whole = shapes::TorusWithCreaseRing();
    whole.Jitter(0.2);
    Shape cut = whole;
    cut.creaseVertices.clear();
    cut.creaseSharpness.clear();
    auto faces = whole.Faces();
    std::vector<int> twin(U(whole.NumVertices()), -1);
    for (int v : {0, 1, 2, 3, 12, 13, 14, 15}) {
        twin[U(v)] = cut.NumVertices();
        double const* const p = &whole.positions[U(3 * v)];
        cut.Vertex(p[0], p[1], p[2]);
    }
    for (std::size_t f = 12; f < 24; ++f) {  // the faces from i = 3 to i = 0 get the twins
        for (int& v : faces[f]) v = twin[U(v)] >= 0 ? twin[U(v)] : v;
    }
    cut.SetFaces(faces);
    for (auto sharp : {SharpVertexWeight::Zero, SharpVertexWeight::Smooth, SharpVertexWeight::PerRegion}) {
        for (auto scheme : {WeightScheme::OneRing, WeightScheme::One}) {
            for (Shape const& shape : {whole, Shape(whole).Loop()}) {
                Shape opened = cut;
                if (shape.rules.scheme == Sdc::SCHEME_LOOP) opened.Loop();
                ShadingOptions options = Options(3, sharp);
                options.weights.scheme = scheme;
                EXPECT_TRUE(SameCorners(Corners(ShadeShape(shape, options)), Corners(ShadeShape(opened, options))));
            }
        }
    }
}

TEST(Invariance, WeightsAreBetweenZeroAndOneAndNormalsHaveUnitLength) {
    for (auto const& shapesOfScheme : {shapes::CatmarkShapes(), shapes::LoopShapes()}) {
        for (Shape const& shape : shapesOfScheme) {
            for (ShadingOptions const& options : SomeOptions(2)) {
                auto const result = ShadeShape(shape, options);
                int numZero = 0;
                for (std::size_t i = 0; i < result.blendedNormals.size(); ++i) {
                    EXPECT_GE(result.blendWeights[i], 0) << shape.name;
                    EXPECT_LE(result.blendWeights[i], 1) << shape.name;
                    double const length = Length(result.blendedNormals[i]);
                    if (length == 0) {
                        ++numZero;
                    } else {
                        EXPECT_NEAR(length, 1, 1e-15 * 4) << shape.name;  // four roundings
                    }
                }
                EXPECT_EQ(numZero, result.report.zeroNormals) << shape.name;
                EXPECT_EQ(numZero, 0) << shape.name;
            }
        }
    }
}

TEST(Invariance, TheResultHasTheSameBitsForAnyNumberOfThreads) {
    for (Shape const& shape : SomeShapes()) {
        for (ShadingOptions options : SomeOptions(4)) {
            auto const one = ShadeShape(shape, options);
            for (int numThreads : {2, 5}) {
                options.execution.numThreads = numThreads;
                EXPECT_TRUE(SameBitsEverywhere(one, ShadeShape(shape, options)))
                    << shape.name << ", " << numThreads;
            }
        }
    }
}

TEST(Invariance, ALargeResultHasTheSameBitsForAnyNumberOfThreads) {
    // 49,152 faces: enough for each thread to get work.
    Shape torus = shapes::Torus(8, 6);
    torus.CreaseLoop({0, 1, 2, 3, 4, 5}).CreasePath({6, 12, 18, 24}, 2.5F).Jitter(0.1);
    for (auto sharp : {SharpVertexWeight::Zero, SharpVertexWeight::PerRegion}) {
        ShadingOptions options = Options(5, sharp);
        auto const one = ShadeShape(torus, options);
        for (int numThreads : {2, 5}) {
            options.execution.numThreads = numThreads;
            EXPECT_TRUE(SameBitsEverywhere(one, ShadeShape(torus, options))) << numThreads << " threads";
        }
    }
}

TEST(Invariance, OpenSubdivsOwnFaceVaryingRulesGiveTheSameNormalsOnClosedInfiniteCreases) {
    // With FVAR_LINEAR_NONE, without darts and with an infinite vertex sharpness on every corner, OpenSubdiv
    // refines a channel whose seams are the creases by the rule of the method.
    std::vector<Shape> meshes{shapes::CubeWithSharpTop(), shapes::TorusWithCreaseRing().Jitter(0.2),
                              shapes::Cube().CreaseAll(),
                              shapes::CubeWithSharpTop().Crease(0, 4).CreaseLoop({0, 1, 2, 3})};
    for (int v = 0; v < 8; ++v) meshes[2].Corner(v);
    for (int v = 0; v < 8; ++v) meshes[3].Corner(v);
    for (std::size_t i = 0, count = meshes.size(); i < count; ++i) meshes.push_back(Shape(meshes[i]).Loop());
    int const level = 3;
    Random random(4);
    for (Shape& shape : meshes) {
        shape.rules.faceVarying = Sdc::Options::FVAR_LINEAR_NONE;
        naive::Hierarchy const control = naive::Refine(shape.Mesh(), shape.Points(), 0);
        std::vector<int> indices;
        for (auto const& values : control.levels[0].faceValues) {
            indices.insert(indices.end(), values.begin(), values.end());
        }
        int const numValues = control.levels[0].NumValues();
        std::vector<Point> field(U(numValues));
        for (Point& point : field) {
            for (double& x : point.x) x = random.Uniform(-1, 1);
            double const length = std::hypot(point.x[0], point.x[1], point.x[2]);
            for (double& x : point.x) x /= length;
        }
        std::vector<Vector> normals;
        for (int value : indices) {
            normals.push_back({field[U(value)].x[0], field[U(value)].x[1], field[U(value)].x[2]});
        }

        auto const refiner = shapes::MakeRefiner(shape, level, indices, numValues);
        Far::PrimvarRefinerReal<double> const primvars(*refiner);
        for (int l = 1; l <= level; ++l) {
            std::vector<Point> next(U(refiner->GetLevel(l).GetNumFVarValues(0)));
            primvars.InterpolateFaceVarying(l, field, next, 0);
            field = next;
        }
        std::vector<Point> limits(field.size());
        primvars.LimitFaceVarying(field, limits, 0);

        ShadingOptions options = PaperPreset(level);
        options.startNormals.kind = StartNormalKind::User;
        options.weights.scheme = WeightScheme::One;
        auto const result = ShadeShape(shape, options, normals);
        double worst = 0;
        for (int f = 0; f < result.NumFaces(); ++f) {
            auto const theirs = refiner->GetLevel(level).GetFaceFVarValues(f, 0);
            for (int i = 0; i < theirs.size(); ++i) {
                double const* const x = limits[U(theirs[i])].x;
                double const length = std::hypot(x[0], x[1], x[2]);
                Vector const n = result.subdividedNormals[U(result.faceValues[U(f * result.faceSize + i)])];
                worst = std::max(worst, length * Length(Minus(n, {x[0] / length, x[1] / length, x[2] / length})));
            }
        }
        // OpenSubdiv computes some of these masks in float.
        EXPECT_LT(worst, 1e-6) << shape.name << (shape.rules.scheme == Sdc::SCHEME_LOOP ? " as triangles" : "");
    }
}
