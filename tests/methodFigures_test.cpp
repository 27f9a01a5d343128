// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "osd_shading/io/objReader.h"
#include "osd_shading/subdivisionShading.h"
#include "tests/naiveReference.h"
#include "tests/shapes.h"

// The figures that the definition of the method names.

namespace {

using namespace osd_shading;
using shapes::Shape;

std::size_t U(int i) { return static_cast<std::size_t>(i); }

double Length(Vec3<double> v) { return std::hypot(v.x, v.y, v.z); }
Vec3<double> Minus(Vec3<double> a, Vec3<double> b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }

ShadingResult<double> ShadeShape(Shape const& shape, ShadingOptions const& options) {
    ShadingInput<double> input;
    input.positions = shape.Points();
    return ShadeSubdivision(shape.Mesh(), input, options);
}

std::string SpotPath() { return std::string(OSD_SHADING_EXTRA_MODELS) + "/zbk/spot.obj"; }

ShadingResult<double> ShadeSpot(ShadingOptions const& options) {
    io::Model const model = io::ReadObj(SpotPath());
    ShadingInput<double> input;
    input.positions = {model.positions.data(), model.positions.size() / 3};
    return ShadeSubdivision(model.Mesh(model.Rules({})), input, options);
}

/// The vertices of the faces around each vertex of the last level.
std::vector<std::set<int>> Rings(ShadingResult<double> const& result) {
    std::vector<std::set<int>> rings(result.positions.size());
    auto const size = U(result.faceSize);
    for (std::size_t f = 0; f < result.faceVertices.size(); f += size) {
        for (std::size_t i = 0; i < size; ++i) {
            for (std::size_t j = 0; j < size; ++j) {
                if (i != j) rings[U(result.faceVertices[f + i])].insert(result.faceVertices[f + j]);
            }
        }
    }
    return rings;
}

/// The largest distance of b from 1 at the smooth extraordinary vertices without a sharp vertex in their ring.
double WorstWeightAtFreeVertices(ShadingResult<double> const& result, bool dartsAreSharp, int& numFree) {
    auto const rings = Rings(result);
    auto isSharp = [&](int v) {
        VertexKind const kind = result.vertexTags[U(v)].kind;
        return kind >= VertexKind::Crease || (dartsAreSharp && kind == VertexKind::Dart);
    };
    double worst = 0;
    numFree = 0;
    for (int v = 0; v < result.NumVertices(); ++v) {
        VertexTag const& tag = result.vertexTags[U(v)];
        if (!tag.isExtraordinary || tag.kind != VertexKind::Smooth) continue;
        if (std::any_of(rings[U(v)].begin(), rings[U(v)].end(), isSharp)) continue;
        ++numFree;
        auto const value = U(result.vertexValues[U(v)]);
        worst = std::max(worst, std::abs(1 - result.blendWeights[value]));
        worst = std::max(worst, Length(Minus(result.blendedNormals[value], result.subdividedNormals[value])));
    }
    return worst;
}

/// Two rings of faces around vertex 0, of valence n; planar, so that positions are coordinates in the n sectors.
Shape TwoRings(Sdc::SchemeType scheme, int n) {
    Shape s;
    std::map<std::vector<int>, int> numbers;  // sector and steps along its two sides
    auto vertex = [&](int sector, int a, int b) {
        if (a == 0 && b == 0) sector = 0;
        if (a == 0 && b > 0) {
            sector = (sector + 1) % n;
            std::swap(a, b);
        }
        auto const [place, isNew] = numbers.insert({{sector, a, b}, s.NumVertices()});
        if (isNew) {
            double const angle = 2 * 3.14159265358979324 / n;
            double const x0 = std::cos(angle * sector), y0 = std::sin(angle * sector);
            double const x1 = std::cos(angle * (sector + 1)), y1 = std::sin(angle * (sector + 1));
            s.Vertex(a * x0 + b * x1, a * y0 + b * y1, 0);
        }
        return place->second;
    };
    vertex(0, 0, 0);
    for (int sector = 0; sector < n; ++sector) {
        for (int a = 0; a < 2; ++a) {
            for (int b = 0; b < 2; ++b) {
                int const corner[4] = {vertex(sector, a, b), vertex(sector, a + 1, b), vertex(sector, a + 1, b + 1),
                                       vertex(sector, a, b + 1)};
                if (scheme == Sdc::SCHEME_CATMARK) {
                    s.Face({corner[0], corner[1], corner[2], corner[3]});
                } else if (a + b < 2) {
                    s.Face({corner[0], corner[1], corner[3]});
                    if (a + b < 1) s.Face({corner[1], corner[2], corner[3]});
                }
            }
        }
    }
    s.rules.scheme = scheme;
    return s;
}

/// The two-ring subdivision matrix around vertex 0 of `rings`, from the masks of the reference, which the tests of
/// the reference hold to OpenSubdiv's.
Eigen::MatrixXd TwoRingMatrix(Shape const& rings) {
    naive::Hierarchy const hierarchy = naive::Refine(rings.Mesh(), rings.Points(), 1);
    naive::Level const& coarse = hierarchy.levels[0];
    naive::Level const& fine = hierarchy.levels[1];
    auto const size = static_cast<Eigen::Index>(coarse.positions.size());
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
    int numRows = 0;
    for (int c = 0; c < fine.NumVertices(); ++c) {
        // Refined bilinearly, the inner half of the sectors is the whole at half the size.
        Vec3<double> place;
        for (auto const& [v, w] : fine.flatMasks[U(c)]) {
            place.x += 2 * w * coarse.positions[U(v)].x;
            place.y += 2 * w * coarse.positions[U(v)].y;
        }
        for (int row = 0; row < coarse.NumVertices(); ++row) {
            if (Length(Minus(place, coarse.positions[U(row)])) > 1e-9) continue;
            ++numRows;
            for (auto const& [v, w] : fine.masks[U(c)]) matrix(row, v) += w;
        }
    }
    EXPECT_EQ(numRows, coarse.NumVertices());
    return matrix;
}

/// The moduli of its eigenvalues, largest first.
std::vector<double> Spectrum(Eigen::MatrixXd const& matrix) {
    std::vector<double> moduli;
    for (auto const& value : matrix.eigenvalues()) moduli.push_back(std::abs(value));
    std::sort(moduli.rbegin(), moduli.rend());
    return moduli;
}

/// Two rings that every step of refinement maps onto themselves: shrunk by lambda in the plane, and by mu, the next
/// eigenvalue, in a height so small that normals depend on it linearly.
Shape EigenRings(Sdc::SchemeType scheme, int n) {
    Shape rings = TwoRings(scheme, n);
    Eigen::MatrixXd const matrix = TwoRingMatrix(rings);
    std::vector<double> const spectrum = Spectrum(matrix);
    auto const space = [&](double eigenvalue) {  // its last columns belong to the eigenvalue
        Eigen::MatrixXd const shifted =
            matrix - eigenvalue * Eigen::MatrixXd::Identity(matrix.rows(), matrix.cols());
        return Eigen::MatrixXd(Eigen::JacobiSVD<Eigen::MatrixXd>(shifted, Eigen::ComputeFullV).matrixV());
    };
    Eigen::MatrixXd const plane = space((spectrum[1] + spectrum[2]) / 2), height = space(spectrum[3]);
    Eigen::Index const last = matrix.cols() - 1;
    for (Eigen::Index v = 0; v <= last; ++v) {
        double* const p = &rings.positions[static_cast<std::size_t>(3 * v)];
        p[0] = plane(v, last);
        p[1] = plane(v, last - 1);
        p[2] = 1e-4 * height(v, last);
    }
    return rings;
}

double const kCatmarkGrowth[6] = {0.991, 1, 1.124, 1.220, 1.289, 1.339};  // valence 3 to 8
double const kLoopGrowth[6] = {2, 1, 1, 1, 1.133, 1.232};

/// Half a unit of the last printed place, and the square root of rounding that multiple eigenvalues cost.
constexpr double kPrinted = 0.0005 + 1e-6;

/// Change per unit of surface around vertex 0, of N_L, N_S and N_B.
struct Change {
    double limit = 0, subdivided = 0, blended = 0;
};

Change ChangeAroundTheFirstVertex(ShadingResult<double> const& result) {
    Change change;
    auto const rings = Rings(result);
    auto const centre = U(result.vertexValues[0]);
    for (int v : rings[0]) {
        auto const value = U(result.vertexValues[U(v)]);
        double const distance = Length(Minus(result.positions[U(v)], result.positions[0]));
        auto const add = [&](double& sum, std::vector<Vec3<double>> const& normals) {
            sum = std::max(sum, Length(Minus(normals[value], normals[centre])) / distance);
        };
        add(change.limit, result.limitNormals);
        add(change.subdivided, result.subdividedNormals);
        add(change.blended, result.blendedNormals);
    }
    return change;
}

}  // namespace

TEST(MethodFigures, SpotHasTheExtraordinaryVerticesOfThePaper) {
    if (!std::filesystem::exists(SpotPath()))
        GTEST_SKIP() << "the paper's model Spot is not at hand: " << SpotPath();
    io::Model const model = io::ReadObj(SpotPath());
    EXPECT_EQ(model.NumVertices(), 188);
    std::map<int, int> sizes;
    for (int size : model.faceSizes) ++sizes[size];
    EXPECT_EQ(sizes, (std::map<int, int>{{3, 4}, {4, 160}, {5, 16}}));
    for (int level : {1, 2, 4}) {
        ShadingReport const report = ShadeSpot(PaperPreset(level)).report;
        EXPECT_EQ(report.extraordinary, (std::map<int, std::int64_t>{{3, 56}, {5, 40}, {6, 4}})) << level;
        EXPECT_TRUE(report.boundaryExtraordinary.empty());
    }
    EXPECT_EQ(ShadeSpot(PaperPreset(4)).report.vertices, 46850);
}

TEST(MethodFigures, SpotHasThePrintedNumbersOfWeightedVertices) {
    if (!std::filesystem::exists(SpotPath()))
        GTEST_SKIP() << "the paper's model Spot is not at hand: " << SpotPath();
    ShadingOptions options = PaperPreset(4);
    options.weights.level = 4;
    EXPECT_EQ(ShadeSpot(options).report.verticesWithWeight, 56 * 19 + 40 * 31 + 4 * 37);  // 2452
    options.weights.scheme = WeightScheme::InverseLimit;
    EXPECT_EQ(ShadeSpot(options).report.verticesWithWeight, 56 * 7 + 40 * 11 + 4 * 13);  // 884
}

TEST(MethodFigures, ALoneExtraordinaryVertexWeighsThePrintedNumberOfVertices) {
    // One vertex of each valence of Spot's, far from the boundary: weights from the last level.
    std::map<int, std::vector<int>> const printed{{3, {19, 7}}, {5, {31, 11}}, {6, {37, 13}}};
    for (auto const& [valence, counts] : printed) {
        ShadingOptions options = PaperPreset(3);
        options.weights.level = 3;
        EXPECT_EQ(ShadeShape(shapes::QuadFan(valence), options).report.verticesWithWeight, counts[0]);
        options.weights.scheme = WeightScheme::InverseLimit;
        EXPECT_EQ(ShadeShape(shapes::QuadFan(valence), options).report.verticesWithWeight, counts[1]);
    }
}

TEST(MethodFigures, TheWeightIsOneAtFreeExtraordinaryVerticesInEveryVariantFromEveryLevel) {
    std::vector<Shape> meshes{shapes::CubeWithSharpTop(1.5F),
                              shapes::MixedPolygons().CreasePath({1, 8, 9}).Corner(4, 1.5F),
                              shapes::Cross().CreasePath({0, 1, 2}, 2.5F),
                              shapes::Pyramid(6),
                              shapes::Icosahedron().CreasePath({0, 1, 8}, 1.25F).Loop(),
                              shapes::Bipyramid(7).Jitter(0.1).Crease(0, 2).Loop()};
    int numTested = 0;
    for (Shape const& shape : meshes) {
        for (int start : {0, 1, 3}) {
            for (auto sharp : {SharpVertexWeight::Zero, SharpVertexWeight::Smooth, SharpVertexWeight::PerRegion}) {
                for (auto darts : {DartWeight::LikeSmooth, DartWeight::LikeSharp}) {
                    ShadingOptions options = PaperPreset(3);
                    options.weights.level = start;
                    options.weights.sharpVertices = sharp;
                    options.weights.darts = darts;
                    int numFree = 0;
                    // Masks of up to some 20 weights that add to 1.
                    EXPECT_LT(WorstWeightAtFreeVertices(ShadeShape(shape, options), darts == DartWeight::LikeSharp,
                                                        numFree),
                              1e-13)
                        << shape.name << " from level " << start;
                    numTested += numFree;
                }
            }
        }
    }
    EXPECT_GT(numTested, 500);
}

TEST(MethodFigures, TheWeightIsOneAtEveryExtraordinaryVertexOfSpot) {
    if (!std::filesystem::exists(SpotPath()))
        GTEST_SKIP() << "the paper's model Spot is not at hand: " << SpotPath();
    int numFree = 0;
    EXPECT_LT(WorstWeightAtFreeVertices(ShadeSpot(PaperPreset(4)), false, numFree), 1e-13);
    EXPECT_EQ(numFree, 100);
}

TEST(MethodFigures, TheSpectraGiveThePrintedGrowth) {
    for (int n = 3; n <= 8; ++n) {
        auto const catmark = Spectrum(TwoRingMatrix(TwoRings(Sdc::SCHEME_CATMARK, n)));
        auto const loop = Spectrum(TwoRingMatrix(TwoRings(Sdc::SCHEME_LOOP, n)));
        for (auto const& spectrum : {catmark, loop}) {
            EXPECT_NEAR(spectrum[0], 1, 1e-12);
            EXPECT_NEAR(spectrum[1], spectrum[2], 1e-6) << "the subdominant eigenvalue is a pair";
        }
        EXPECT_NEAR(catmark[3] / (catmark[2] * catmark[2]), kCatmarkGrowth[n - 3], kPrinted) << "valence " << n;
        EXPECT_NEAR(loop[3] / (loop[2] * loop[2]), kLoopGrowth[n - 3], kPrinted) << "valence " << n;
    }
}

TEST(MethodFigures, TheChangeOfTheLimitNormalGrowsByThePrintedFactor) {
    for (int n = 3; n <= 8; ++n) {
        for (auto scheme : {Sdc::SCHEME_CATMARK, Sdc::SCHEME_LOOP}) {
            Shape const rings = EigenRings(scheme, n);
            double const printed = (scheme == Sdc::SCHEME_LOOP ? kLoopGrowth : kCatmarkGrowth)[n - 3];
            double before = 0;
            for (int level = 2; level <= 5; ++level) {
                double const change = ChangeAroundTheFirstVertex(ShadeShape(rings, PaperPreset(level))).limit;
                // Heights of 1e-4 change normals by as much, their squares are 1e-8 of that.
                if (before > 0) {
                    EXPECT_NEAR(change / before, printed, kPrinted) << "valence " << n;
                }
                before = change;
            }
        }
    }
}

TEST(MethodFigures, TheChangeOfTheSubdividedAndTheBlendedNormalTendsToAConstant) {
    for (int n = 3; n <= 8; ++n) {
        for (auto scheme : {Sdc::SCHEME_CATMARK, Sdc::SCHEME_LOOP}) {
            Shape fan = scheme == Sdc::SCHEME_LOOP ? shapes::TriangleFan(n).Loop() : shapes::QuadFan(n);
            fan.Jitter(0.2, 3);
            // The next mode of the normals dies away as (mu / lambda)^l, .85^l at worst (Catmull-Clark, valence 8):
            // measured, it still is .014 of the whole at level 6. Growth of N_L is .12 to 1 away from 1.
            Change before, after;
            for (auto* change : {&before, &after}) {
                ShadingOptions options = PaperPreset(change == &before ? 5 : 6);
                *change = ChangeAroundTheFirstVertex(ShadeShape(fan, options));
                options.weights.scheme = WeightScheme::One;
                change->subdivided = ChangeAroundTheFirstVertex(ShadeShape(fan, options)).subdivided;
            }
            EXPECT_NEAR(after.subdivided / before.subdivided, 1, 0.02) << "valence " << n;
            EXPECT_NEAR(after.blended / before.blended, 1, 0.02) << "valence " << n;
        }
    }
}
