// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <opensubdiv/far/primvarRefiner.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "osd_shading/subdivisionShading.h"
#include "tests/naiveReference.h"
#include "tests/sampleSize.h"
#include "tests/shapes.h"

// The library, in double, against the naive reference: everything, at every face corner of the last level.

namespace {

using namespace osd_shading;
using shapes::Random;
using shapes::Shape;
using tests::IsSanitizerRun;
using tests::SampleSize;
using tests::SweepLevel;

namespace Far = OpenSubdiv::OPENSUBDIV_VERSION::Far;

/// Both sides add the same numbers in another order: some 1e-13 at most, and 1e-9 leaves room for badly scaled
/// meshes. Normalising a sum that nearly cancels magnifies the error of rounding, hence the second term.
double Tolerance(double relativeLength) { return 1e-9 + 1e-14 / std::max(relativeLength, 1e-14); }

double Distance(Vec3<double> a, Vec3<double> b) { return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z); }

std::string Text(Vec3<double> v) {
    std::ostringstream text;
    text.precision(17);
    text << "(" << v.x << " " << v.y << " " << v.z << ")";
    return text.str();
}

struct Case {
    Shape shape;
    ShadingOptions options;
    naive::UserNormals normals;
};

std::string Describe(Case const& c) {
    std::ostringstream text;
    auto const& o = c.options;
    text << c.shape.name << (c.shape.rules.creasing == Sdc::Options::CREASE_CHAIKIN ? ", Chaikin" : "")
         << (c.shape.rules.scheme == Sdc::SCHEME_LOOP ? ", Loop" : ", Catmull-Clark") << ", boundary "
         << c.shape.rules.boundary << ", level " << o.level << ", start kind "
         << static_cast<int>(o.startNormals.kind) << " level " << o.startNormals.level << ", averaging "
         << static_cast<int>(o.subdividedNormals.averaging) << " steps " << o.subdividedNormals.sphericalSteps
         << ", scheme " << static_cast<int>(o.weights.scheme) << ", sharp "
         << static_cast<int>(o.weights.sharpVertices) << ", darts " << static_cast<int>(o.weights.darts)
         << ", weights from " << o.weights.level << ", exponent " << o.weights.exponent << ", positions "
         << static_cast<int>(o.limits.positions) << ", normals " << static_cast<int>(o.limits.normals);
    return text.str();
}

ShadingResult<double> ShadeWithLibrary(Case const& c) {
    ShadingInput<double> input;
    input.positions = c.shape.Points();
    input.vertexNormals = c.normals.perVertex;
    input.faceVaryingNormals = c.normals.perFaceCorner;
    return ShadeSubdivision(c.shape.Mesh(), input, c.options);
}

/// Collects the first few differences of one case.
class Differences {
public:
    explicit Differences(Case const& c) : _case(Describe(c)) {}

    void Compare(char const* what, std::size_t face, std::size_t corner, Vec3<double> got, Vec3<double> wanted,
                 double tolerance) {
        // Written so that NaN differs as well.
        if (!(Distance(got, wanted) <= tolerance)) {
            Add(std::string(what) + " at face " + std::to_string(face) + " corner " + std::to_string(corner) +
                ": " + Text(got) + " instead of " + Text(wanted));
        }
    }
    void Compare(std::string const& what, double got, double wanted, double tolerance) {
        if (!(std::abs(got - wanted) <= tolerance)) {
            std::ostringstream text;
            text.precision(17);
            text << what << ": " << got << " instead of " << wanted;
            Add(text.str());
        }
    }
    void Add(std::string const& line) {
        if (++_count <= 4) _text += "\n    " + line;
    }
    testing::AssertionResult Result() const {
        if (_count == 0) return testing::AssertionSuccess();
        return testing::AssertionFailure() << _count << " differences, " << _case << _text;
    }

private:
    std::string _case, _text;
    int _count = 0;
};

void CompareReports(ShadingReport const& got, naive::Reference const& wanted, Differences& differences) {
    auto compare = [&](char const* what, auto a, auto b) {
        differences.Compare(what, static_cast<double>(a), static_cast<double>(b), 0);
    };
    compare("vertices", got.vertices, wanted.numVertices);
    compare("values", got.values, wanted.numValues);
    compare("sharp vertices", got.sharpVertices, wanted.sharpVertices);
    compare("darts", got.darts, wanted.darts);
    compare("boundary vertices", got.boundaryVertices, wanted.boundaryVertices);
    compare("non-manifold vertices", got.nonManifoldVertices, wanted.nonManifoldVertices);
    compare("non-manifold edges", got.nonManifoldEdges, wanted.nonManifoldEdges);
    auto compareMaps = [&](char const* what, std::map<int, std::int64_t> const& a, std::map<int, int> const& b) {
        if (!std::equal(a.begin(), a.end(), b.begin(), b.end(),
                        [](auto const& x, auto const& y) { return x.first == y.first && x.second == y.second; })) {
            differences.Add(what);
        }
    };
    compareMaps("counts of extraordinary vertices", got.extraordinary, wanted.extraordinary);
    compareMaps("counts of extraordinary boundary vertices", got.boundaryExtraordinary,
                wanted.boundaryExtraordinary);
    compare("zero start normals", got.zeroStartNormals, wanted.zeroStartNormals);
    compare("fallback normals", got.fallbackNormals, wanted.fallbackNormals);
    compare("zero normals", got.zeroNormals, wanted.zeroNormals);
    compare("vertices with weight", got.verticesWithWeight, wanted.verticesWithWeight);
    compare("opposed normals", got.opposedNormals, wanted.opposedNormals);
    differences.Compare("smallest length", got.minSubdividedLength, wanted.minSubdividedLength, 1e-9);
}

testing::AssertionResult Agree(Case const& c, naive::Hierarchy const& hierarchy) {
    naive::Reference const wanted = naive::Shade(hierarchy, c.options, c.normals);
    ShadingResult<double> const got = ShadeWithLibrary(c);
    Differences differences(c);

    auto const size = static_cast<std::size_t>(got.faceSize);
    std::size_t numFaces = 0;
    for (char isHole : wanted.isHole) numFaces += isHole != 0 ? 0U : 1U;
    differences.Compare("face size", got.faceSize, wanted.faceSize, 0);
    differences.Compare("faces", got.NumFaces(), static_cast<double>(numFaces), 0);
    if (!differences.Result()) return differences.Result();

    // Sharpness summed in another order differs by float's rounding, which only Chaikin creases magnify.
    bool const isChaikin = c.shape.rules.creasing == Sdc::Options::CREASE_CHAIKIN;
    double const slack = isChaikin ? 2e-6 : 0;
    auto tolerance = [&](double length) { return slack + Tolerance(length); };
    for (std::size_t f = 0; f < numFaces; ++f) {
        std::size_t const face = got.refinerFaces.empty() ? f : static_cast<std::size_t>(got.refinerFaces[f]);
        if (wanted.isHole[face]) differences.Add("a hole in the result, face " + std::to_string(face));
        for (std::size_t i = 0; i < size; ++i) {
            naive::Corner const& w = wanted.corners[face * size + i];
            auto const vertex = static_cast<std::size_t>(got.faceVertices[f * size + i]);
            auto const value = static_cast<std::size_t>(got.faceValues[f * size + i]);
            double const subdivided = w.subdividedLength * wanted.startNormalLength;
            differences.Compare("position", face, i, got.positions[vertex], w.position, tolerance(1));
            differences.Compare("limit normal", face, i, got.limitNormals[value], w.limitNormal,
                                tolerance(std::min(w.limitNormalLength, 1.0)));
            differences.Compare("weight at face " + std::to_string(face) + " corner " + std::to_string(i),
                                got.blendWeights[value], w.blendWeight, tolerance(1));
            if (got.blendWeights[value] > 0 && w.blendWeight > 1e-9) {
                differences.Compare("subdivided normal", face, i, got.subdividedNormals[value], w.subdividedNormal,
                                    tolerance(subdivided));
            }
            if (got.blendWeights[value] == 0) {
                differences.Compare("subdivided normal without weight", face, i, got.subdividedNormals[value], {},
                                    0);
            }
            // An exponent below 1 magnifies the rounding of small weights.
            double const power = c.options.weights.exponent < 1 ? 1e-6 : 0;
            differences.Compare("blended normal", face, i, got.blendedNormals[value], w.blendedNormal,
                                power + tolerance(w.blendedLength * std::min(w.limitNormalLength, subdivided)));
        }
    }
    CompareReports(got.report, wanted, differences);
    return differences.Result();
}

testing::AssertionResult Agree(Case const& c) {
    return Agree(c, naive::Refine(c.shape.Mesh(), c.shape.Points(), c.options.level));
}

bool HasOnlyRegularFaces(Shape const& shape) {
    return shape.rules.scheme == Sdc::SCHEME_LOOP ||
           std::all_of(shape.faceSizes.begin(), shape.faceSizes.end(), [](int size) { return size == 4; });
}

std::vector<Shape> AllShapes() {
    std::vector<Shape> all = shapes::CatmarkShapes();
    std::vector<Shape> const loop = shapes::LoopShapes();
    all.insert(all.end(), loop.begin(), loop.end());
    return all;
}

template <typename T>
T Pick(Random& random, std::vector<T> const& from) {
    return from[static_cast<std::size_t>(random.Below(static_cast<int>(from.size())))];
}

Vec3<double> RandomVector(Random& random) {
    return {random.Uniform(-1, 1), random.Uniform(-1, 1), random.Uniform(-1, 1)};
}

/// Any options that the shape allows, the last level included.
Case RandomCase(Shape const& shape, Random& random, int maxLevel) {
    Case c{shape, {}, {}};
    auto& o = c.options;
    bool const isRegular = HasOnlyRegularFaces(shape);
    o.level = (isRegular ? 0 : 1) + random.Below(isRegular ? maxLevel + 1 : maxLevel);
    o.startNormals.kind = Pick<StartNormalKind>(
        random, {StartNormalKind::Uniform, StartNormalKind::CornerArea, StartNormalKind::Angle,
                 StartNormalKind::Limit, StartNormalKind::LimitSmoothed, StartNormalKind::User});
    o.subdividedNormals.averaging =
        Pick<NormalAveraging>(random, {NormalAveraging::Linear, NormalAveraging::Linear,
                                       NormalAveraging::Renormalised, NormalAveraging::Spherical});
    o.subdividedNormals.sphericalSteps = random.Below(5);
    o.weights.scheme =
        Pick<WeightScheme>(random, {WeightScheme::OneRing, WeightScheme::OneRing, WeightScheme::ExtraordinaryOnly,
                                    WeightScheme::Bilinear, WeightScheme::InverseLimit, WeightScheme::One});
    o.weights.sharpVertices = Pick<SharpVertexWeight>(
        random, {SharpVertexWeight::Zero, SharpVertexWeight::Smooth, SharpVertexWeight::PerRegion});
    o.weights.darts = random.Chance(0.5) ? DartWeight::LikeSmooth : DartWeight::LikeSharp;
    o.weights.exponent = Pick<double>(random, {1, 1, 2, 0.5, 3.7});
    o.limits.normals = random.Chance(0.7) ? LimitNormalKind::Limit : LimitNormalKind::FaceAverage;
    o.limits.positions = random.Chance(0.8) ? PositionKind::Limit : PositionKind::Refined;

    // Limits of the control mesh itself need quads.
    int const lowestLimit = isRegular ? 0 : 1;
    if (o.startNormals.kind == StartNormalKind::User) {
        bool const perVertex = random.Chance(0.5);
        std::size_t const count =
            perVertex ? static_cast<std::size_t>(shape.NumVertices()) : shape.faceVertices.size();
        auto& normals = perVertex ? c.normals.perVertex : c.normals.perFaceCorner;
        for (std::size_t i = 0; i < count; ++i) normals.push_back(RandomVector(random));
    } else if (random.Chance(0.7)) {
        bool const needsLimit =
            o.startNormals.kind == StartNormalKind::Limit || o.startNormals.kind == StartNormalKind::LimitSmoothed;
        int const lowest = needsLimit ? lowestLimit : 0;
        o.startNormals.level = lowest + random.Below(o.level - lowest + 1);
    }
    if (random.Chance(0.7)) {
        int const lowest = o.weights.scheme == WeightScheme::InverseLimit ? lowestLimit : 0;
        o.weights.level = lowest + random.Below(o.level - lowest + 1);
    }
    return c;
}

struct Point {
    double x[3];

    void Clear() { x[0] = x[1] = x[2] = 0; }
    template <typename Weight>
    void AddWithWeight(Point const& other, Weight weight) {
        for (int k = 0; k < 3; ++k) x[k] += static_cast<double>(weight) * other.x[k];
    }
    Vec3<double> Vector() const { return {x[0], x[1], x[2]}; }
};

/// Positions, limits, sharpness, kinds and tags of every level, against OpenSubdiv's.
testing::AssertionResult RefinesAsOpenSubdiv(Shape const& shape, int last) {
    auto const refiner = shapes::MakeRefiner(shape, last);
    naive::Hierarchy const hierarchy = naive::Refine(shape.Mesh(), shape.Points(), last);
    Case c{shape, {}, {}};
    Differences differences(c);
    // Some ten roundings of numbers of size 3; under Chaikin's rule masks take in sums of sharpness, which
    // OpenSubdiv rounds to float in an order of its own.
    double const tolerance = shape.rules.creasing == Sdc::Options::CREASE_CHAIKIN ? 1e-7 : 1e-13;
    std::vector<Point> points, limits;
    for (std::size_t i = 0; i < shape.positions.size(); i += 3) {
        points.push_back({{shape.positions[i], shape.positions[i + 1], shape.positions[i + 2]}});
    }
    for (int l = 0; l <= last; ++l) {
        auto const& theirs = refiner->GetLevel(l);
        naive::Level const& ours = hierarchy.levels[static_cast<std::size_t>(l)];
        Far::PrimvarRefinerReal<double> const primvars(*refiner);
        if (l > 0) {
            std::vector<Point> next(static_cast<std::size_t>(theirs.GetNumVertices()));
            primvars.Interpolate(l, points, next);
            points = next;
        }
        if (l == last) {
            limits.resize(points.size());
            primvars.Limit(points, limits);
        }
        std::vector<Vec3<double>> const ourLimits = naive::LimitPositions(shape.rules, ours);
        differences.Compare("faces", ours.NumFaces(), theirs.GetNumFaces(), 0);
        differences.Compare("edges", static_cast<double>(ours.edges.size()), theirs.GetNumEdges(), 0);
        differences.Compare("vertices", ours.NumVertices(), theirs.GetNumVertices(), 0);
        if (!differences.Result()) return differences.Result();
        for (int f = 0; f < ours.NumFaces(); ++f) {
            auto const face = static_cast<std::size_t>(f);
            differences.Compare("hole", ours.isHole[face], theirs.IsFaceHole(f) ? 1 : 0, 0);
            for (int i = 0; i < theirs.GetFaceVertices(f).size(); ++i) {
                auto const corner = static_cast<std::size_t>(i);
                auto const v = static_cast<std::size_t>(ours.faces[face][corner]);
                auto const& edge = ours.edges[static_cast<std::size_t>(ours.faceEdges[face][corner])];
                int const vertex = theirs.GetFaceVertices(f)[i], theirEdge = theirs.GetFaceEdges(f)[i];
                auto const at = static_cast<std::size_t>(vertex);
                differences.Compare("position", face, corner, ours.positions[v], points[at].Vector(), tolerance);
                if (l == last && l > 0) {
                    differences.Compare("limit", face, corner, ourLimits[v], limits[at].Vector(), tolerance);
                }
                differences.Compare("kind", 1 << static_cast<int>(ours.kinds[v]), theirs.GetVertexRule(vertex), 0);
                differences.Compare("vertex sharpness", static_cast<double>(ours.vertexSharpness[v]),
                                    static_cast<double>(theirs.GetVertexSharpness(vertex)), 0);
                // Chaikin's sums are taken in another order.
                differences.Compare("edge sharpness", static_cast<double>(edge.sharpness),
                                    static_cast<double>(theirs.GetEdgeSharpness(theirEdge)), 1e-6);
                differences.Compare("non-manifold edge", edge.isNonManifold ? 1 : 0,
                                    theirs.IsEdgeNonManifold(theirEdge) ? 1 : 0, 0);
                differences.Compare("non-manifold vertex", ours.isNonManifold[v],
                                    theirs.IsVertexNonManifold(vertex) ? 1 : 0, 0);
            }
        }
    }
    return differences.Result();
}

}  // namespace

TEST(NaiveReference, PutsTheCornersOfACubeAtHalfTheirDistance) {
    // Valence 3: 3/8 (1, 1, 1) + 1/6 (its neighbours: (1, 1, 1) in all) + 1/24 (the opposite ones: -(1, 1, 1)).
    Shape const cube = shapes::Cube();
    naive::Hierarchy const hierarchy = naive::Refine(cube.Mesh(), cube.Points(), 0);
    Vec3<double> const limit = naive::LimitPositions(cube.rules, hierarchy.levels[0])[6];
    EXPECT_LT(Distance(limit, {0.5, 0.5, 0.5}), 1e-15);
}

TEST(NaiveReference, RefinesEveryShapeAsOpenSubdivDoesFaceByFace) {
    for (Shape const& shape : AllShapes()) EXPECT_TRUE(RefinesAsOpenSubdiv(shape, 3));
}

TEST(NaiveReference, RefinesRandomShapesAsOpenSubdivDoesFaceByFace) {
    for (std::uint64_t seed = 0; seed < SampleSize(160); ++seed) {
        shapes::RandomShapeOptions options;
        options.triangles = seed % 2 == 1;
        options.chaikin = seed % 4 >= 2;
        options.nonManifold = seed % 8 >= 4;
        EXPECT_TRUE(RefinesAsOpenSubdiv(shapes::RandomShape(seed, options), 3));
    }
}

TEST(MethodReference, AgreesOnEveryShapeAndLevelWithTheDefaults) {
    for (Shape const& shape : AllShapes()) {
        for (int level = HasOnlyRegularFaces(shape) ? 0 : 1; level <= SweepLevel(3); ++level) {
            EXPECT_TRUE(Agree({shape, PaperPreset(level), {}}));
        }
    }
}

TEST(MethodReference, AgreesOnEveryShapeWithTheSmoothVariant) {
    for (Shape const& shape : AllShapes()) {
        for (int level = 1; level <= SweepLevel(3); ++level) EXPECT_TRUE(Agree({shape, SmoothPreset(level), {}}));
    }
}

TEST(MethodReference, AgreesAtLevelFour) {
    for (Shape const& shape :
         {shapes::CubeWithSharpTop(3.5F), shapes::MixedPolygons().CreasePath({1, 8, 9, 10}, 2.5F),
          shapes::Icosahedron().CreaseLoop({11, 5, 1, 7, 10}, 3.25F).Loop()}) {
        EXPECT_TRUE(Agree({shape, PaperPreset(4), {}}));
    }
}

TEST(MethodReference, AgreesWhereIsolatedVerticesMakeUpForTheSidesOfCreases) {
    // As many values as vertices in all, though the crease's vertices have two and the isolated ones none.
    Shape cube = shapes::CubeWithSharpTop();
    for (int i = 0; i < 4; ++i) cube.Vertex(i, 0, 5);
    for (Shape const& shape : {cube, Shape(cube).Loop(), shapes::BowTieAndIsolatedVertex()}) {
        for (int level : {0, 1, 2}) {
            Case c{shape, PaperPreset(level), {}};
            c.options.weights.scheme = WeightScheme::One;
            c.options.startNormals.level = 0;
            EXPECT_TRUE(Agree(c));
        }
    }
}

TEST(MethodReference, AgreesOnAPillowWhoseEdgeNormalsCancel) {
    for (Shape const& shape : {shapes::Pillow(), shapes::Pillow().Loop()}) {
        for (auto averaging :
             {NormalAveraging::Linear, NormalAveraging::Renormalised, NormalAveraging::Spherical}) {
            for (int level : {1, 2, 3}) {
                Case c{shape, PaperPreset(level), {}};
                c.options.weights.scheme = WeightScheme::One;
                c.options.subdividedNormals.averaging = averaging;
                EXPECT_TRUE(Agree(c));
            }
        }
    }
}

TEST(MethodReference, AgreesWhereRenormalisedNormalsCancelButForRounding) {
    // The face point's normal is the mean of three directions 120 degrees apart: it vanishes, and stays zero.
    Case c{shapes::LoneTriangle(), PaperPreset(1), {}};
    c.options.startNormals.kind = StartNormalKind::User;
    c.options.subdividedNormals.averaging = NormalAveraging::Renormalised;
    c.options.weights.scheme = WeightScheme::One;
    double const y = std::sqrt(0.75);
    c.normals.perVertex = {{1, 0, 0}, {-0.5, y, 0}, {-0.5, -y, 0}};
    EXPECT_TRUE(Agree(c));
}

TEST(MethodReference, AgreesThatASphericalMeanSkipsZeroNormals) {
    // The face point's mean is over three normals, of weight 1/3 each, not over three quarters of a mean.
    Case c{shapes::LoneQuad(), PaperPreset(1), {}};
    c.options.startNormals.kind = StartNormalKind::User;
    c.options.subdividedNormals.averaging = NormalAveraging::Spherical;
    c.options.subdividedNormals.sphericalSteps = 1;
    c.options.weights.scheme = WeightScheme::One;
    c.normals.perVertex = {{1, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}};
    EXPECT_TRUE(Agree(c));
}

TEST(MethodReference, AgreesInEveryVariantOfEveryWeightScheme) {
    std::vector<Shape> meshes{shapes::CubeWithSharpTop(1.5F).Crease(0, 4, 2.5F),
                              shapes::GridWithDart(),
                              shapes::MixedPolygons().CreasePath({1, 8, 9}).Corner(4, 1.5F),
                              shapes::OpenBox().Crease(0, 1, 1.25F),
                              shapes::CubeWithSharpTop().Loop(),
                              shapes::Icosahedron().CreasePath({0, 1, 8}).Loop()};
    for (Shape const& shape : meshes) {
        for (int level : {1, 3}) {
            naive::Hierarchy const hierarchy = naive::Refine(shape.Mesh(), shape.Points(), level);
            for (auto sharp : {SharpVertexWeight::Zero, SharpVertexWeight::Smooth, SharpVertexWeight::PerRegion}) {
                for (auto scheme : {WeightScheme::OneRing, WeightScheme::ExtraordinaryOnly, WeightScheme::Bilinear,
                                    WeightScheme::InverseLimit, WeightScheme::One}) {
                    for (auto darts : {DartWeight::LikeSmooth, DartWeight::LikeSharp}) {
                        Case c{shape, PaperPreset(level), {}};
                        c.options.weights.scheme = scheme;
                        c.options.weights.sharpVertices = sharp;
                        c.options.weights.darts = darts;
                        EXPECT_TRUE(Agree(c, hierarchy));
                    }
                }
            }
        }
    }
}

TEST(MethodReference, AgreesOnTheCubeAtLevelZeroWhereTheInverseLimitIsNotUnique) {
    Case c{shapes::Cube(), PaperPreset(2), {}};
    c.options.weights.scheme = WeightScheme::InverseLimit;
    c.options.weights.level = 0;
    for (auto sharp : {SharpVertexWeight::Zero, SharpVertexWeight::Smooth, SharpVertexWeight::PerRegion}) {
        c.options.weights.sharpVertices = sharp;
        EXPECT_TRUE(Agree(c));
    }
}

TEST(MethodReference, AgreesOnEveryShapeWithRandomOptions) {
    constexpr std::uint64_t kSeed = 20230401;
    RecordProperty("seed", std::to_string(kSeed));
    Random random(kSeed);
    std::uint64_t const perShape = IsSanitizerRun() ? 1 : SampleSize(6);
    for (Shape const& shape : AllShapes()) {
        for (std::uint64_t i = 0; i < perShape; ++i)
            EXPECT_TRUE(Agree(RandomCase(shape, random, 3))) << "seed " << kSeed;
    }
}

TEST(MethodReference, AgreesOnRandomMeshesWithRandomOptions) {
    constexpr std::uint64_t kSeed = 85;
    RecordProperty("seed", std::to_string(kSeed));
    Random random(kSeed);
    for (std::uint64_t i = 0; i < SampleSize(600); ++i) {
        shapes::RandomShapeOptions options;
        options.triangles = i % 2 == 1;
        options.chaikin = i % 8 >= 6;
        options.nonManifold = i % 16 >= 12;
        EXPECT_TRUE(Agree(RandomCase(shapes::RandomShape(1000 + i, options), random, 3))) << "seed " << kSeed;
    }
}
