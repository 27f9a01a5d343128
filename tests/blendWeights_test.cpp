// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/blendWeights.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "osd_shading/extraordinaryVertices.h"
#include "tests/testHelpers.h"

namespace {

using namespace osd_shading;
using namespace osd_shading::tests;

constexpr double kRounding = 1e-14;
SharpVertexWeight const kVariants[] = {SharpVertexWeight::Smooth, SharpVertexWeight::Zero,
                                       SharpVertexWeight::PerRegion};
WeightScheme const kSchemes[] = {WeightScheme::OneRing, WeightScheme::ExtraordinaryOnly, WeightScheme::Bilinear,
                                 WeightScheme::InverseLimit, WeightScheme::One};

BlendWeightOptions From(int level, WeightScheme scheme = WeightScheme::OneRing,
                        SharpVertexWeight sharp = SharpVertexWeight::Zero,
                        DartWeight darts = DartWeight::LikeSmooth) {
    BlendWeightOptions options;
    options.level = level;
    options.scheme = scheme;
    options.sharpVertices = sharp;
    options.darts = darts;
    return options;
}

std::vector<double> Weights(Rooms<double> const& rooms, BlendWeightOptions const& options) {
    return ComputeBlendWeights(options, rooms.topology, rooms.levels, rooms.limit, 1);
}
std::vector<double> Weights(Shape const& shape, int level, BlendWeightOptions const& options) {
    return Weights(Rooms<double>(shape, level), options);
}

/// How often each weight occurs.
void ExpectCounts(std::vector<double> const& weights, std::map<double, int> const& expected) {
    int total = 0;
    for (auto const& [weight, count] : expected) {
        auto const isNear = [w = weight](double b) { return std::fabs(b - w) < kRounding; };
        EXPECT_EQ(std::count_if(weights.begin(), weights.end(), isNear), count) << weight;
        total += count;
    }
    EXPECT_EQ(weights.size(), Index(total));
}

int CountPositive(std::vector<double> const& weights) {
    return static_cast<int>(std::count_if(weights.begin(), weights.end(), [](double b) { return b > 0; }));
}

TEST(BlendWeights, OfACubeAtLevelOneAreOne) {
    // Each of the 26 vertices is a corner or in a corner's ring.
    ExpectCounts(Weights(shapes::Cube(), 1, From(1)), {{1, 26}});
}

TEST(BlendWeights, OfACubeFromLevelTwoAreTheLimitsOfItsSeeds) {
    // A side of 4 x 4 faces: seeds 1 at (0, 0), (1, 0), (0, 1), (1, 1) and so on at each corner, 0 elsewhere. With
    // 4/9, 1/9, 1/36: (0, 0) 1, (1, 0) 5/6, (1, 1) 25/36, (2, 0) 1/3, (2, 1) 5/18, (2, 2) 1/9.
    ExpectCounts(Weights(shapes::Cube(), 2, From(2)),
                 {{1, 8}, {5.0 / 6, 24}, {25.0 / 36, 24}, {1.0 / 3, 12}, {5.0 / 18, 24}, {1.0 / 9, 6}});
}

TEST(BlendWeights, OfTheVertexAloneAreItsLimitMask) {
    // n / (n + 5) = 3/8 at the corner itself; its neighbours along edges see it with 1/9, across faces with 1/36.
    ExpectCounts(Weights(shapes::Cube(), 3, From(3, WeightScheme::ExtraordinaryOnly)),
                 {{3.0 / 8, 8}, {1.0 / 9, 24}, {1.0 / 36, 24}, {0, 386 - 56}});
}

TEST(BlendWeights, BilinearOnesHalveFromLevelToLevelWithoutALimit) {
    ExpectCounts(Weights(shapes::Cube(), 2, From(2, WeightScheme::Bilinear)), {{1, 8}, {0, 90}});
    ExpectCounts(Weights(shapes::Cube(), 3, From(2, WeightScheme::Bilinear)),
                 {{1, 8}, {0.5, 24}, {0.25, 24}, {0, 386 - 56}});
}

TEST(BlendWeights, SpreadOverNineteenVerticesRoundACornerAndInverseLimitsOverSeven) {
    // At level 3 the corners' rings do not meet.
    EXPECT_EQ(CountPositive(Weights(shapes::Cube(), 3, From(3))), 8 * 19);
    EXPECT_EQ(CountPositive(Weights(shapes::Cube(), 3, From(3, WeightScheme::InverseLimit))), 8 * 7);
}

TEST(BlendWeights, AreOneAtSmoothExtraordinaryVerticesAwayFromSharpOnes) {
    for (Shape const& shape : AllShapes()) {
        Rooms<double> const rooms(shape, 2);
        for (SharpVertexWeight const sharp : kVariants) {
            for (int start = 0; start <= 2; ++start) {
                std::vector<double> const weights = Weights(rooms, From(start, WeightScheme::OneRing, sharp));
                for (int v = 0; v < rooms.LastRegions().NumVertices(); ++v) {
                    if (!IsExtraordinary(rooms.topology, rooms.Last(), v)) continue;
                    bool isSmooth = true;
                    for (int const f : rooms.Last().GetVertexFaces(v)) {
                        for (int const u : rooms.Last().GetFaceVertices(f)) {
                            isSmooth = isSmooth && !rooms.LastRegions().IsSharp(u);
                        }
                    }
                    if (isSmooth) {
                        EXPECT_NEAR(weights[Index(rooms.LastRegions().FirstValue(v))], 1, kRounding) << shape.name;
                    }
                }
            }
        }
    }
}

TEST(BlendWeights, LieBetweenZeroAndOneInEverySchemeAndVariant) {
    for (Shape const& shape : AllShapes()) {
        Rooms<double> const rooms(shape, 2);
        for (WeightScheme const scheme : kSchemes) {
            for (SharpVertexWeight const sharp : kVariants) {
                for (double const b : Weights(rooms, From(1, scheme, sharp))) {
                    ASSERT_GE(b, 0) << shape.name;
                    ASSERT_LE(b, 1) << shape.name;
                }
            }
        }
    }
}

TEST(BlendWeights, AreZeroOnRegularMeshes) {
    for (Shape const& shape : {shapes::Torus(5, 4), shapes::QuadGrid(4, 3), shapes::LoneQuad()}) {
        for (WeightScheme const scheme : {WeightScheme::OneRing, WeightScheme::ExtraordinaryOnly,
                                          WeightScheme::Bilinear, WeightScheme::InverseLimit}) {
            for (SharpVertexWeight const sharp : {SharpVertexWeight::Smooth, SharpVertexWeight::Zero}) {
                EXPECT_EQ(CountPositive(Weights(shape, 2, From(1, scheme, sharp))), 0) << shape.name;
            }
        }
    }
}

TEST(BlendWeights, OfSchemeOneAreOneOnSharpVerticesToo) {
    for (double const b : Weights(shapes::CubeWithSharpTop(), 2, From(1, WeightScheme::One))) EXPECT_EQ(b, 1);
}

TEST(BlendWeights, VariantsDifferOnACreaseAsTheyShould) {
    // The corners of the sharp top have a region of one face above and one of two at the sides, the regular one.
    Rooms<double> const rooms(shapes::CubeWithSharpTop(), 1);
    CreaseRegions const& regions = rooms.LastRegions();
    std::vector<double> const smooth = Weights(rooms, From(1, WeightScheme::OneRing, SharpVertexWeight::Smooth));
    std::vector<double> const zero = Weights(rooms, From(1));
    std::vector<double> const perRegion =
        Weights(rooms, From(1, WeightScheme::OneRing, SharpVertexWeight::PerRegion));
    for (double const b : smooth) EXPECT_NEAR(b, 1, kRounding);
    for (int v = 0; v < regions.NumVertices(); ++v) {
        if (!regions.IsSharp(v)) continue;
        for (int i = regions.FirstValue(v); i < regions.FirstValue(v + 1); ++i) EXPECT_EQ(zero[Index(i)], 0);
    }
    for (int f = 0; f < 4; ++f) {  // the children of face 0
        for (int i = 0; i < 4; ++i) EXPECT_NEAR(perRegion[Index(regions.CornerValue(f, i))], 1, kRounding);
    }
    for (int corner = 4; corner < 8; ++corner) {
        int numZero = 0;
        for (int i = regions.FirstValue(corner); i < regions.FirstValue(corner + 1); ++i) {
            numZero += perRegion[Index(i)] == 0;
        }
        EXPECT_EQ(numZero, 1);  // the sides'
    }
}

TEST(BlendWeights, UnderVariantBARingIsSeededWhereACreaseIsReleased) {
    // Sharpness 1 ends at level 1: what counts is what a vertex is there.
    std::vector<double> const weights = Weights(shapes::CubeWithSharpTop(1), 2, From(0));
    for (std::size_t v = 0; v < 8; ++v) EXPECT_NEAR(weights[v], 1, kRounding);
}

TEST(BlendWeights, ASmoothDartKeepsWhatItsCreaseNeighbourDoesNotTake) {
    // Valence 5 in an icosahedron of quads: 1/2 + 5 (2/25) + 5 (1/50) without one 2/25 along the sharp edge; a
    // dart that counts as sharp is not seeded either.
    Shape const shape = shapes::Icosahedron().Crease(0, 11);
    EXPECT_NEAR(Weights(shape, 1, From(1))[0], 0.92, kRounding);
    EXPECT_NEAR(
        Weights(shape, 1, From(1, WeightScheme::OneRing, SharpVertexWeight::Zero, DartWeight::LikeSharp))[0], 0.42,
        kRounding);
    EXPECT_NEAR(Weights(shape, 1, From(1, WeightScheme::OneRing, SharpVertexWeight::Smooth))[0], 1, kRounding);
}

TEST(BlendWeights, VariantCSeedsDartsOfAnyValenceWhileTheyLast) {
    BlendWeightOptions const smooth = From(1, WeightScheme::OneRing, SharpVertexWeight::PerRegion);
    BlendWeightOptions sharp = smooth;
    sharp.darts = DartWeight::LikeSharp;
    auto const atDart = [](Shape const& shape, BlendWeightOptions const& options) {
        Rooms<double> const rooms(shape, 2);
        return Weights(rooms, options)[Index(rooms.LastRegions().FirstValue(12))];
    };
    EXPECT_NEAR(atDart(shapes::GridWithDart(), smooth), 1, kRounding);
    EXPECT_NEAR(atDart(shapes::GridWithDart(2.5F), smooth), 1, kRounding);
    EXPECT_EQ(atDart(shapes::GridWithDart(1.5F), smooth), 0);  // smooth, and of valence 4, at level 2
    EXPECT_EQ(atDart(shapes::GridWithDart(), sharp), 0);
    EXPECT_EQ(atDart(shapes::GridWithDart(), From(1)), 0);  // variant B goes by valence
}

TEST(BlendWeights, InverseLimitsAreOneAtEveryExtraordinaryVertexAlsoBetweenNeighbours) {
    for (Shape const& shape : {shapes::Icosahedron(), shapes::MixedPolygons(), shapes::Icosahedron().Loop(),
                               shapes::Cross(), shapes::Bipyramid(7).Loop(), shapes::Pyramid(5)}) {
        Rooms<double> const rooms(shape, 1);
        std::vector<double> const weights = Weights(rooms, From(1, WeightScheme::InverseLimit));
        for (int v = 0; v < rooms.Last().GetNumVertices(); ++v) {
            if (IsExtraordinary(rooms.topology, rooms.Last(), v)) {
                EXPECT_NEAR(weights[Index(v)], 1, 1e-10) << shape.name;  // solved to 1e-14, as conditioned
            }
        }
    }
    Shape const triangles = shapes::Icosahedron().Loop();  // all twelve are neighbours
    ExpectCounts(Weights(triangles, 0, From(0, WeightScheme::InverseLimit)), {{1, 12}});
}

TEST(BlendWeights, TheSingularSystemOfACubesOwnCornersYieldsOnes) {
    // On the cube's graph the limit mask has the eigenvalue 3/8 - 3/6 + 3/24 = 0; of all solutions that of least
    // norm is 1 everywhere.
    for (int level = 0; level <= 2; ++level) {
        for (double const b : Weights(shapes::Cube(), level, From(0, WeightScheme::InverseLimit))) {
            EXPECT_NEAR(b, 1, 1e-10);
        }
    }
}

TEST(BlendWeights, AnIsolatedVertexHasNone) {
    EXPECT_EQ(Weights(shapes::IsolatedVertex(), 1, From(1)).size(), 26U);
}

TEST(BlendWeights, AVertexOfValenceTwoIsSeeded) {
    for (int level = 1; level <= 2; ++level) {
        EXPECT_NEAR(Weights(shapes::ValenceTwo(), level, From(1))[8], 1, kRounding);
    }
}

TEST(BlendWeights, HolesTakePart) {
    EXPECT_EQ(Weights(shapes::Cube().Hole(0), 2, From(1)), Weights(shapes::Cube(), 2, From(1)));
}

TEST(BlendWeights, DoNotDependOnTheThreads) {
    Rooms<float> const rooms(shapes::CubeWithSharpTop(2.5F), 5);
    for (WeightScheme const scheme : kSchemes) {
        EXPECT_TRUE(
            HasSameBits(ComputeBlendWeights(From(1, scheme), rooms.topology, rooms.levels, rooms.limit, 1),
                        ComputeBlendWeights(From(1, scheme), rooms.topology, rooms.levels, rooms.limit, 4)));
    }
}

}  // namespace
