// SPDX-License-Identifier: Apache-2.0

// The recipe of ShadingStencils, followed with OpenSubdiv's own CPU evaluator, gives what ShadeSubdivision gives.

#include "osd_shading/shadingStencils.h"

#include <gtest/gtest.h>
#include <opensubdiv/osd/cpuEvaluator.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "osd_shading/blendedNormals.h"
#include "osd_shading/composedRows.h"
#include "osd_shading/io/objReader.h"
#include "tests/ioFiles.h"
#include "tests/sampleSize.h"
#include "tests/testHelpers.h"

namespace osd_shading::tests {
namespace {

namespace Osd = OpenSubdiv::OPENSUBDIV_VERSION::Osd;

using Points = std::vector<Vec3<float>>;

float* FloatsOf(Points& points) { return points.empty() ? nullptr : &points[0].x; }

/// Buffers as Osd's evaluators want to see them.
struct Buffer {
    Points points;
    float* BindCpuBuffer() { return FloatsOf(points); }
};
Osd::BufferDescriptor const kTriples(0, 3, 3);

Points Evaluate(StencilRows const& rows, Points const& sources) {
    Buffer source{sources}, result{Points(Index(rows.NumRows()))};
    if (rows.NumRows() > 0) {
        EXPECT_EQ(static_cast<int>(sources.size()), rows.numSources);
        EXPECT_TRUE(Osd::CpuEvaluator::EvalStencils(&source, kTriples, &result, kTriples, &rows));
    }
    return result.points;
}

struct Frames {
    Points p, du, dv;
};

Frames EvaluateFrames(StencilRows const& rows, Points const& sources) {
    auto const size = Index(rows.NumRows());
    Buffer source{sources}, p{Points(size)}, du{Points(size)}, dv{Points(size)};
    if (size > 0) {
        EXPECT_TRUE(
            Osd::CpuEvaluator::EvalStencils(&source, kTriples, &p, kTriples, &du, kTriples, &dv, kTriples, &rows));
    }
    return {p.points, du.points, dv.points};
}

/// Unit vectors, and what rounding in float may have done to each: bounds to first order, in radians.
struct Normals {
    Points units;
    std::vector<double> errors;
};

// Weights, products and sums are each rounded to 2^-24 of what is added up, a few times over; the evaluator adds
// one term after the other.
constexpr double kRounding = 1.0 / (1 << 21);
double RoundingOf(int numTerms) { return std::fmax(kRounding, numTerms / double(1 << 24)); }

double LargestOf(Points const& points) {
    double largest = 0;
    for (Vec3<float> const& p : points) largest = std::fmax(largest, double(Length(p)));
    return largest;
}

Normals NormalsOf(NormalStencils const& stencils, Points const& control) {
    Frames const frames = EvaluateFrames(stencils.frames, control);
    Points const points = Evaluate(stencils.points, control);
    Normals normals;
    ComputeUnitNormals(stencils, frames.du, frames.dv, points, normals.units);
    normals.errors.assign(normals.units.size(), 0);

    // Along du x dv: what is lost of each tangent tilts the normal.
    StencilRows const& rows = stencils.frames;
    for (std::size_t i = 0; i < frames.du.size(); ++i) {
        double addedU = 0, addedV = 0;
        for (int k = rows.offsets[i]; k < rows.offsets[i] + rows.sizes[i]; ++k) {
            double const length = double(Length(control[Index(rows.indices[Index(k)])]));
            addedU += std::fabs(double(rows.duWeights[Index(k)])) * length;
            addedV += std::fabs(double(rows.dvWeights[Index(k)])) * length;
        }
        double const area = double(Length(Cross(frames.du[i], frames.dv[i])));
        normals.errors[i] = RoundingOf(rows.sizes[i]) *
                            (addedU * double(Length(frames.dv[i])) + addedV * double(Length(frames.du[i]))) / area;
    }

    // By faces: the points' rounding over the faces' size.
    FaceAverages const& averages = stencils.averages;
    double const rounding = kRounding * LargestOf(control);
    std::vector<double> faceErrors;
    std::vector<int> faceOffsets;
    std::vector<Vec3<double>> faceUnits;
    int const* face = averages.faceVertices.data();
    for (int const size : averages.faceSizes) {
        auto const at = [&](int i) {
            Vec3<float> const& p = points[Index(face[i % size])];
            return Vec3<double>{double(p.x), double(p.y), double(p.z)};
        };
        Vec3<double> area{};
        double around = 0;
        for (int i = 0; i < size; ++i) {
            area += Cross(at(i) - at(0), at(i + 1) - at(0));
            around += Length(at(i + 1) - at(i));
        }
        faceOffsets.push_back(static_cast<int>(face - averages.faceVertices.data()));
        faceErrors.push_back(rounding * around / Length(area));
        faceUnits.push_back(Normalized(area));
        face += size;
    }
    for (std::size_t i = 0; i < averages.normals.size(); ++i) {
        double largest = 0, added = 0;
        Vec3<double> sum{};
        for (int k = averages.offsets[i]; k < averages.offsets[i + 1]; ++k) {
            auto const f = Index(averages.faces[Index(k)]);
            int const* const vertices = averages.faceVertices.data() + faceOffsets[f];
            int const size = averages.faceSizes[f], corner = averages.corners[Index(k)];
            auto const sideTo = [&](int other) {
                Vec3<float> const p = points[Index(vertices[corner])], q = points[Index(vertices[other % size])];
                return Vec3<double>{double(q.x) - double(p.x), double(q.y) - double(p.y),
                                    double(q.z) - double(p.z)};
            };
            Vec3<double> const after = sideTo(corner + 1), before = sideTo(corner + size - 1);
            double const weight = averages.weight == StartNormalKind::CornerArea ? Length(Cross(after, before))
                                  : averages.weight == StartNormalKind::Angle    ? AngleBetween(after, before)
                                                                                 : 1;
            largest = std::fmax(largest, faceErrors[f]);
            sum += weight * faceUnits[f];
            added += weight;
        }
        // As if the face of largest error were alone; weights lose as much as their faces do.
        normals.errors[Index(averages.normals[i])] = 4 * (largest + kRounding) * added / Length(sum);
    }
    return normals;
}

/// The normalised sums of `rows` over normals.
Normals Combine(StencilRows const& rows, Normals const& sources) {
    Normals normals;
    normals.units = Evaluate(rows, sources.units);
    for (std::size_t i = 0; i < normals.units.size(); ++i) {
        double error = 0;
        for (int k = rows.offsets[i]; k < rows.offsets[i] + rows.sizes[i]; ++k) {
            error += std::fabs(double(rows.weights[Index(k)])) *
                     (sources.errors[Index(rows.indices[Index(k)])] + RoundingOf(rows.sizes[i]));
        }
        normals.errors.push_back(rows.sizes[i] == 0 ? 0 : error / double(Length(normals.units[i])));
        normals.units[i] = Normalized(normals.units[i]);
    }
    return normals;
}

struct Case {
    std::string name;
    ControlMesh mesh;
    Points control;
    Points userNormals;  // per face corner, or per vertex
    bool perVertex = false;
};

struct Counts {
    std::int64_t values = 0, skipped = 0, above = 0;  // above: differ by more than 1e-5
    double largestP = 0, largestN = 0;                // of those not skipped
};

/// Follows the recipe and compares each number with ShadeSubdivision's in double.
void ExpectSame(Case const& which, ShadingOptions const& options, Counts& counts) {
    std::string const name = which.name + " level " + std::to_string(options.level);
    ShadingStencils const stencils = BuildShadingStencils(which.mesh, options);

    std::vector<Vec3<double>> control, userNormals;
    auto const widen = [](Vec3<float> const& p) { return Vec3<double>{double(p.x), double(p.y), double(p.z)}; };
    for (Vec3<float> const& p : which.control) control.push_back(widen(p));
    for (Vec3<float> const& n : which.userNormals) userNormals.push_back(widen(n));
    ShadingInput<double> input;
    input.positions = control;
    (which.perVertex ? input.vertexNormals : input.faceVaryingNormals) = userNormals;
    ShadingResult<double> const expected = ShadeSubdivision(which.mesh, input, options);

    // What is numbered, and b.
    ASSERT_EQ(stencils.NumValues(), expected.NumValues()) << name;
    ASSERT_EQ(stencils.limits.vertices, expected.valueVertices) << name;
    ASSERT_EQ(stencils.faceValues, expected.faceValues) << name;
    ASSERT_EQ(stencils.faceSize, expected.faceSize) << name;
    ASSERT_EQ(stencils.limits.frames.NumRows(), expected.NumValues()) << name;
    for (std::size_t i = 0; i < stencils.blendWeights.size(); ++i) {
        ASSERT_EQ(stencils.blendWeights[i] > 0, expected.blendWeights[i] > 0) << name << " value " << i;
        ASSERT_NEAR(double(stencils.blendWeights[i]), expected.blendWeights[i], 6e-8) << name;
        bool const hasRow = stencils.subdividedNormals.NumRows() > 0 && stencils.subdividedNormals.sizes[i] > 0;
        ASSERT_EQ(hasRow, expected.blendWeights[i] > 0) << name;
    }

    // Positions.
    Frames const frames = EvaluateFrames(stencils.limits.frames, which.control);
    double const size = LargestOf(which.control);
    for (std::size_t i = 0; i < frames.p.size(); ++i) {
        double const difference =
            Distance(widen(frames.p[i]), expected.positions[Index(expected.valueVertices[i])]);
        int const numTerms = stencils.limits.frames.sizes[i];
        ASSERT_LE(difference, std::fmax(1e-6, RoundingOf(numTerms)) * size) << name << " value " << i;
        counts.largestP = std::fmax(counts.largestP, difference / size);
    }

    // N_L, start normals, N_S, and the blend.
    Normals const limits = NormalsOf(stencils.limits, which.control);
    Normals starts;
    if (options.startNormals.kind != StartNormalKind::User) {
        starts = NormalsOf(stencils.starts, which.control);
        if (options.startNormals.kind == StartNormalKind::LimitSmoothed) {
            starts = Combine(stencils.startSmoothing, starts);
        }
    } else if (which.perVertex) {
        for (int const v : stencils.starts.vertices)
            starts.units.push_back(Normalized(which.userNormals[Index(v)]));
        starts.errors.assign(starts.units.size(), kRounding);
    } else {
        Normals given{which.userNormals, std::vector<double>(which.userNormals.size(), 0)};
        starts = Combine(stencils.userNormals, given);
    }
    Normals const subdivided = Combine(stencils.subdividedNormals, starts);
    auto const expectNear = [&](Vec3<float> const& found, Vec3<double> const& normal, double error,
                                char const* what, std::size_t value) {
        ++counts.values;
        // The definition's fallbacks begin where double can't tell a normal, these tables' zeros where float can't.
        if (!(error < 0.05)) {
            ++counts.skipped;
            return;
        }
        double const difference = Distance(widen(found), normal);
        EXPECT_LE(difference, 1e-6 + error) << name << " " << what << " of value " << value;
        counts.above += difference > 1e-5;
        counts.largestN = std::fmax(counts.largestN, difference);
    };
    for (std::size_t i = 0; i < limits.units.size(); ++i) {
        expectNear(limits.units[i], expected.limitNormals[i], limits.errors[i], "N_L", i);
        double const b = double(stencils.blendWeights[i]);
        if (b == 0) {
            expectNear(limits.units[i], expected.blendedNormals[i], limits.errors[i], "N_B", i);
            continue;
        }
        expectNear(subdivided.units[i], expected.subdividedNormals[i], subdivided.errors[i], "N_S", i);
        double const share = std::pow(b, options.weights.exponent);
        Vec3<double> const sum = (1 - share) * widen(limits.units[i]) + share * widen(subdivided.units[i]);
        double const rest = share < 1 ? (1 - share) * limits.errors[i] : 0;
        double const error = (rest + share * subdivided.errors[i] + kRounding) / Length(sum);
        expectNear(
            BlendNormals(limits.units[i], subdivided.units[i], stencils.blendWeights[i], options.weights.exponent),
            expected.blendedNormals[i], error, "N_B", i);
    }
}

/// Options that meet every kind of start normal, variant, scheme of weights and limit.
std::vector<ShadingOptions> ManyOptions(int level, bool hasLimitsAtZero) {
    std::vector<ShadingOptions> all{PaperPreset(level), SmoothPreset(level)};
    int const lowest = hasLimitsAtZero ? 0 : std::min(level, 1);

    ShadingOptions options = PaperPreset(level);
    options.startNormals = {StartNormalKind::CornerArea, 0};
    options.weights.level = 0;
    options.weights.sharpVertices = SharpVertexWeight::Smooth;
    options.weights.exponent = 2;
    options.limits.positions = PositionKind::Refined;
    all.push_back(options);

    options = PaperPreset(level);
    options.startNormals = {StartNormalKind::Angle, level};
    options.weights.sharpVertices = SharpVertexWeight::PerRegion;
    options.limits.normals = LimitNormalKind::FaceAverage;
    all.push_back(options);

    options = PaperPreset(level);
    options.startNormals = {StartNormalKind::Limit, lowest};
    options.weights.scheme = WeightScheme::InverseLimit;
    options.weights.level = lowest;
    options.weights.darts = DartWeight::LikeSharp;
    options.execution.numThreads = 2;
    all.push_back(options);

    options = PaperPreset(level);
    options.limits.normals = LimitNormalKind::Exact;
    all.push_back(options);

    options = PaperPreset(level);
    options.startNormals = {StartNormalKind::LimitSmoothed, lowest};
    options.weights.scheme = WeightScheme::Bilinear;
    options.weights.sharpVertices = SharpVertexWeight::Smooth;
    all.push_back(options);

    options = PaperPreset(level);
    options.weights.scheme = WeightScheme::ExtraordinaryOnly;
    options.weights.level = level;
    all.push_back(options);
    return all;
}

Points RandomNormals(std::size_t count) {
    Points normals;
    shapes::Random random(5);
    for (std::size_t i = 0; i < count; ++i) {
        normals.push_back(
            {static_cast<float>(random.Uniform(-0.3, 0.3)), static_cast<float>(random.Uniform(-0.3, 0.3)), 1.0F});
    }
    return normals;
}

void ExpectSameWithManyOptions(Case which, int lastLevel, Counts& counts) {
    bool const isLoop = which.mesh.rules.scheme == Sdc::SCHEME_LOOP;
    bool const hasLimitsAtZero = isLoop || std::all_of(which.mesh.faceSizes.begin(), which.mesh.faceSizes.end(),
                                                       [](int size) { return size == 4; });
    for (int level = hasLimitsAtZero ? 0 : 1; level <= lastLevel; ++level) {
        for (ShadingOptions const& options : ManyOptions(level, hasLimitsAtZero)) {
            ExpectSame(which, options, counts);
            if (::testing::Test::HasFatalFailure()) return;
        }
        ShadingOptions user = PaperPreset(level);
        user.startNormals.kind = StartNormalKind::User;
        for (bool const perVertex : {false, true}) {
            which.perVertex = perVertex;
            which.userNormals = RandomNormals(perVertex ? which.control.size() : which.mesh.faceVertices.size());
            ExpectSame(which, user, counts);
        }
        which.userNormals.clear();
    }
}

void ExpectSameShape(Shape const& shape, int lastLevel, Counts& counts) {
    ExpectSameWithManyOptions({shape.name, shape.Mesh(), PointsOf<float>(shape), {}, false}, lastLevel, counts);
}

/// Prints the figures, and expects next to all normals to be compared.
void Report(Counts const& counts) {
    std::printf(
        "             %lld normals compared, %lld differ by more than 1e-5 and %.2g at most; %lld degenerate ones "
        "skipped; positions differ by %.2g of the size\n",
        static_cast<long long>(counts.values), static_cast<long long>(counts.above), counts.largestN,
        static_cast<long long>(counts.skipped), counts.largestP);
    EXPECT_LE(counts.skipped, counts.values / 20);
    EXPECT_LE(counts.above, counts.values / 20);  // slivers: the models' poles of 360 faces, the rook
}

int const kLastLevel = IsSanitizerRun() ? 2 : 3;

TEST(ShadingStencils, OfACubeAreWhatIsWorkedByHand) {
    // Level 1: the face point of the top is the mean of its corners, and its limit sees 4/9 of itself, 1/9 of the
    // edge points and 1/36 of the corners' children.
    Shape const cube = shapes::Cube();
    ShadingOptions options = PaperPreset(1);
    options.limits.positions = PositionKind::Refined;
    ShadingStencils const stencils = BuildShadingStencils(cube.Mesh(), options);
    EXPECT_EQ(stencils.NumValues(), 26);
    EXPECT_EQ(stencils.starts.points.NumRows(), 26);
    EXPECT_EQ(stencils.starts.frames.NumRows(), 0);
    EXPECT_EQ(stencils.startSmoothing.NumRows() + stencils.userNormals.NumRows(), 0);
    EXPECT_EQ(stencils.options.startNormals.level, 1);
    StencilRows const& points = stencils.starts.points;
    int const row = 8;  // the first face's child
    EXPECT_EQ(points.sizes[row], 4);
    for (int k = points.offsets[row]; k < points.offsets[row] + 4; ++k) {
        EXPECT_EQ(points.indices[Index(k)], 4 + k - points.offsets[row]);
        EXPECT_EQ(points.weights[Index(k)], 0.25F);
    }
    // Refined positions and points of the start level are the same here; every b is 1, each normal is made of its
    // neighbours.
    Points const control = PointsOf<float>(cube);
    EXPECT_TRUE(HasSameBits(Evaluate(points, control), EvaluateFrames(stencils.limits.frames, control).p));
    for (float const b : stencils.blendWeights) EXPECT_EQ(b, 1);
    EXPECT_EQ(stencils.subdividedNormals.numSources, 26);
}

TEST(ShadingStencils, RowsOfPointsAndNormalsAddToOneAndThoseOfTangentsToZero) {
    for (Shape const& shape : AllShapes()) {
        ShadingStencils const stencils = BuildShadingStencils(shape.Mesh(), PaperPreset(2));
        auto const expectSums = [&](StencilRows const& rows, std::vector<float> const& weights, double sum) {
            ASSERT_EQ(weights.size(), rows.indices.size());
            for (std::size_t i = 0; i < rows.sizes.size(); ++i) {
                auto const first = weights.begin() + rows.offsets[i];
                double const found = std::accumulate(first, first + rows.sizes[i], 0.0);
                ASSERT_NEAR(found, rows.sizes[i] == 0 ? 0 : sum, 1e-6) << shape.name;
                ASSERT_TRUE(std::is_sorted(rows.indices.begin() + rows.offsets[i],
                                           rows.indices.begin() + rows.offsets[i] + rows.sizes[i]));
            }
        };
        StencilRows const& frames = stencils.limits.frames;
        expectSums(frames, frames.weights, 1);
        expectSums(frames, frames.duWeights, 0);
        expectSums(frames, frames.dvWeights, 0);
        expectSums(stencils.limits.points, stencils.limits.points.weights, 1);
        expectSums(stencils.starts.points, stencils.starts.points.weights, 1);
        expectSums(stencils.subdividedNormals, stencils.subdividedNormals.weights, 1);
    }
}

TEST(ShadingStencils, ThroughOpenSubdivsEvaluatorGiveWhatShadeSubdivisionGives) {
    Counts counts;
    for (Shape const& shape : AllShapes()) ExpectSameShape(shape, kLastLevel, counts);
    Report(counts);
}

TEST(ShadingStencils, OfRandomMeshesGiveWhatShadeSubdivisionGives) {
    Counts counts;
    for (std::uint64_t seed = 0; seed < SampleSize(40); ++seed) {
        shapes::RandomShapeOptions options;
        options.triangles = seed % 4 == 1;
        options.nonManifold = seed % 3 == 1;
        options.chaikin = seed % 5 == 4;
        Shape shape = shapes::RandomShape(seed, options);
        if (options.triangles) shape.Loop();
        ExpectSameShape(shape, 2, counts);
    }
    Report(counts);
}

TEST(ShadingStencils, OfAllModelsGiveWhatShadeSubdivisionGives) {
    std::vector<std::string> files = ioFiles::OwnModels();
    std::vector<std::string> const further = ioFiles::SharedModels();
    if (!IsSanitizerRun()) files.insert(files.end(), further.begin(), further.end());
    Counts counts;
    for (std::string const& file : files) {
        io::Model model;
        try {
            model = io::ReadObj(file);
        } catch (Error const&) {
            continue;  // a face with a repeated vertex is refused
        }
        Points control;
        for (std::size_t i = 0; i < model.positions.size(); i += 3) {
            double const* const p = &model.positions[i];
            control.push_back({static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
        }
        bool const isTriangles =
            std::all_of(model.faceSizes.begin(), model.faceSizes.end(), [](int size) { return size == 3; });
        for (Sdc::SchemeType const scheme : {Sdc::SCHEME_CATMARK, Sdc::SCHEME_LOOP}) {
            if (scheme == Sdc::SCHEME_LOOP && !isTriangles) continue;
            SubdivisionRules rules;
            rules.scheme = scheme;
            int const level = model.NumFaces() < 100 && IsFullRun() ? 3 : 2;
            for (ShadingOptions const& options : ManyOptions(level, scheme == Sdc::SCHEME_LOOP)) {
                ExpectSame({model.name, model.Mesh(model.Rules(rules)), control, {}, false}, options, counts);
            }
        }
    }
    Report(counts);
}

TEST(ShadingStencils, AreTheSameFromARefinerAndWithAnyNumberOfThreads) {
    Shape const shape = shapes::MixedPolygons().CreasePath({1, 8, 9}, 1.5F);
    std::unique_ptr<Far::TopologyRefiner> const refiner = shapes::MakeRefiner(shape, 2);
    ShadingOptions options = SmoothPreset(5);
    ShadingStencils const one = BuildShadingStencils(shape.Mesh(), options);
    options.execution.numThreads = 3;
    ShadingStencils const other = BuildShadingStencils(*refiner, options);
    auto const expectSame = [](StencilRows const& a, StencilRows const& b) {
        EXPECT_EQ(a.numSources, b.numSources);
        EXPECT_TRUE(HasSameBits(a.sizes, b.sizes) && HasSameBits(a.offsets, b.offsets));
        EXPECT_TRUE(HasSameBits(a.indices, b.indices) && HasSameBits(a.weights, b.weights));
        EXPECT_TRUE(HasSameBits(a.duWeights, b.duWeights) && HasSameBits(a.dvWeights, b.dvWeights));
    };
    expectSame(one.limits.frames, other.limits.frames);
    expectSame(one.limits.points, other.limits.points);
    expectSame(one.starts.frames, other.starts.frames);
    expectSame(one.starts.points, other.starts.points);
    expectSame(one.startSmoothing, other.startSmoothing);
    expectSame(one.subdividedNormals, other.subdividedNormals);
    EXPECT_TRUE(HasSameBits(one.blendWeights, other.blendWeights));
}

TEST(ShadingStencils, AreGivenToOpenSubdivsGpuBuffersAsItsOwnTables) {
    ShadingStencils const stencils = BuildShadingStencils(shapes::CubeWithSharpTop().Mesh(), PaperPreset(2));
    StencilRows const& rows = stencils.limits.frames;
    std::unique_ptr<Far::LimitStencilTable const> const limit = MakeFarLimitStencilTable(rows);
    EXPECT_EQ(limit->GetNumStencils(), rows.NumRows());
    EXPECT_EQ(limit->GetNumControlVertices(), 8);
    EXPECT_EQ(limit->GetSizes(), rows.sizes);
    EXPECT_EQ(limit->GetOffsets(), rows.offsets);
    EXPECT_EQ(limit->GetControlIndices(), rows.indices);
    EXPECT_EQ(limit->GetWeights(), rows.weights);
    EXPECT_EQ(limit->GetDuWeights(), rows.duWeights);
    EXPECT_EQ(limit->GetDvWeights(), rows.dvWeights);
    std::unique_ptr<Far::StencilTable const> const points = MakeFarStencilTable(stencils.subdividedNormals);
    EXPECT_EQ(points->GetSizes(), stencils.subdividedNormals.sizes);
    EXPECT_EQ(points->GetControlIndices(), stencils.subdividedNormals.indices);
    EXPECT_EQ(points->GetWeights(), stencils.subdividedNormals.weights);
}

TEST(ShadingStencils, WhereNothingIsWeightedThereAreNoRowsOfSubdividedNormals) {
    ShadingStencils const torus = BuildShadingStencils(shapes::Torus(5, 4).Mesh(), PaperPreset(2));
    EXPECT_EQ(torus.subdividedNormals.NumRows(), 0);
    EXPECT_EQ(torus.subdividedNormals.numSources, 80);
    EXPECT_EQ(torus.limits.frames.NumRows(), 320);
    // The same from variant B on a cube whose extraordinary vertices are all corners.
    ShadingOptions options = PaperPreset(2);
    options.weights.level = 2;
    EXPECT_EQ(BuildShadingStencils(shapes::Cube().CreaseAll().Mesh(), options).subdividedNormals.NumRows(), 0);
}

TEST(ShadingStencils, ListCornersOfSeveralFacesWithTheFacesThatTheyAverage) {
    // The dent corners of a creased plus sign have regions of two and more faces.
    Shape const cross = shapes::Cross().CreaseAll();
    ShadingStencils const stencils = BuildShadingStencils(cross.Mesh(), PaperPreset(1));
    FaceAverages const& averages = stencils.limits.averages;
    StencilRows const& frames = stencils.limits.frames;
    EXPECT_EQ(averages.weight, StartNormalKind::Uniform);
    for (std::size_t i = 0; i < averages.normals.size(); ++i) {
        int const value = averages.normals[i];
        for (int k = averages.offsets[i]; k < averages.offsets[i + 1]; ++k) {
            int const face = averages.faces[Index(k)];
            int const at = averages.faceVertices[Index(4 * face + averages.corners[Index(k)])];
            EXPECT_EQ(stencils.limits.pointVertices[Index(at)], stencils.limits.vertices[Index(value)]);
        }
        for (int k = frames.offsets[Index(value)]; k < frames.offsets[Index(value)] + frames.sizes[Index(value)];
             ++k) {
            EXPECT_EQ(frames.duWeights[Index(k)], 0);
            EXPECT_EQ(frames.dvWeights[Index(k)], 0);
        }
    }
    // Nothing else is listed.
    EXPECT_LT(averages.normals.size(), frames.sizes.size());
    EXPECT_EQ(stencils.starts.averages.normals.size(), stencils.starts.vertices.size());
}

TEST(ShadingStencils, OfNormalsAreNotMoreThanTheEstimate) {
    std::vector<Shape> all = AllShapes();
    for (std::uint64_t seed = 0; seed < SampleSize(60); ++seed) {
        shapes::RandomShapeOptions options;
        options.triangles = seed % 2 != 0;
        all.push_back(shapes::RandomShape(seed, options));
        if (options.triangles) all.back().Loop();
    }
    for (Shape const& shape : all) {
        RefinedTopology const base(shape.Mesh(), 0);
        RowEstimate const estimate(base.Refiner());
        for (ShadingOptions const& options : ManyOptions(3, shape.rules.scheme == Sdc::SCHEME_LOOP)) {
            ShadingStencils const stencils = BuildShadingStencils(shape.Mesh(), options);
            double const numTerms = static_cast<double>(stencils.subdividedNormals.indices.size());
            EXPECT_GE(estimate.NormalTerms(stencils.options), numTerms)
                << shape.name << " n " << stencils.options.startNormals.level << " w "
                << stencils.options.weights.level << " scheme " << static_cast<int>(options.weights.scheme)
                << " variant " << static_cast<int>(options.weights.sharpVertices);
        }
    }
}

TEST(ShadingStencils, RefuseInWords) {
    Shape const shape = shapes::Cube();
    ShadingOptions options = PaperPreset(2);
    options.subdividedNormals.averaging = NormalAveraging::Renormalised;
    EXPECT_EQ(ErrorOf<InvalidOptions>([&] { BuildShadingStencils(shape.Mesh(), options); }),
              "stencils hold linear averaging of normals only; use ShadeSubdivision for the others");
    options = PaperPreset(14);
    EXPECT_NE(ErrorOf<MemoryLimitExceeded>([&] {
                  BuildShadingStencils(shape.Mesh(), options);
              }).find("more indices than 32 bits can number"),
              std::string::npos);
    options = PaperPreset(4);
    options.execution.memoryLimit = 3000000;
    EXPECT_NO_THROW(BuildShadingStencils(shape.Mesh(), PaperPreset(4)));
    EXPECT_NE(ErrorOf<MemoryLimitExceeded>([&] {
                  BuildShadingStencils(shape.Mesh(), options);
              }).find("more than the limit of 3000000"),
              std::string::npos);
    options.execution.memoryLimit = 0;
    options.execution.progress = [](double done) { return done < 0.3; };
    EXPECT_THROW(BuildShadingStencils(shape.Mesh(), options), Cancelled);

    ShadingStencils const stencils = BuildShadingStencils(shape.Mesh(), PaperPreset(1));
    Points const points(25);
    Points normals;
    EXPECT_EQ(ErrorOf<InvalidOptions>([&] { ComputeUnitNormals(stencils.starts, {}, {}, points, normals); }),
              "points has 25 elements; its table has 26 rows");
    EXPECT_EQ(ErrorOf<InvalidOptions>([&] { ComputeUnitNormals(stencils.starts, points, {}, points, normals); }),
              "du has 25 elements; its table has 0 rows");
    float const number = 0;
    EXPECT_EQ(ErrorOf<InvalidOptions>(
                  [&] { ComputeUnitNormals(stencils.starts, {}, {}, PointView<float>(&number, 26, 2), normals); }),
              "points: its stride is 2; give 3 or more");
    EXPECT_EQ(ErrorOf<InvalidOptions>(
                  [&] { ComputeUnitNormals(stencils.starts, {}, {}, PointView<float>(nullptr, 26), normals); }),
              "points: its pointer is null");
}

}  // namespace
}  // namespace osd_shading::tests
