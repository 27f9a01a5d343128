// SPDX-License-Identifier: Apache-2.0

// Every model in every way that it can be shaded: no crash, no NaN, and either a result that passes CheckGeometry
// or a refusal that the library documents.
//
// CI runs all models, and of the options a covering array: every pair of values of any two options stands in a row
// of it. A model runs all rows, one with many faces every fourth, and levels that give more than 3000 faces are cut
// to those that do not. A full run (OSD_SHADING_TEST_FULL) shades all levels 0 to 3 with the product of boundary
// and creasing rules, triangle rules, variants, darts and weight schemes, on as many threads as there are; rules
// for what a model does not have (boundaries, fading creases, triangles, anything sharp) take the first of their
// values.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "osd_shading/geometryCheck.h"
#include "osd_shading/io/objReader.h"
#include "tests/ioFiles.h"
#include "tests/sampleSize.h"
#include "tests/tableAgreement.h"

namespace osd_shading::tests {
namespace {

// --- A covering array
// ---------------------------------------------------------------------------------------------

/// One value of each option, as its number.
using Row = std::vector<int>;

/// Rows in which every pair of values of two options stands, `counts[i]` being the number of values of option i.
/// Greedy: each row begins with the first pair that is missing, and takes for each other option the value that adds
/// most pairs.
std::vector<Row> coveringArray(std::vector<int> const& counts) {
    std::size_t const n = counts.size();
    // By options i < j and their values: whether the pair is still missing.
    std::map<std::array<int, 4>, bool> isMissing;
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = i + 1; j < n; ++j) {
            for (int a = 0; a < counts[i]; ++a) {
                for (int b = 0; b < counts[j]; ++b) {
                    isMissing[{static_cast<int>(i), static_cast<int>(j), a, b}] = true;
                }
            }
        }
    }
    auto const pairOf = [](std::size_t i, std::size_t j, int a, int b) {
        return i < j ? std::array<int, 4>{static_cast<int>(i), static_cast<int>(j), a, b}
                     : std::array<int, 4>{static_cast<int>(j), static_cast<int>(i), b, a};
    };
    std::vector<Row> rows;
    for (;;) {
        auto const first =
            std::find_if(isMissing.begin(), isMissing.end(), [](auto const& pair) { return pair.second; });
        if (first == isMissing.end()) return rows;
        Row row(n, -1);
        row[Index(first->first[0])] = first->first[2];
        row[Index(first->first[1])] = first->first[3];
        for (std::size_t i = 0; i < n; ++i) {
            if (row[i] >= 0) continue;
            int mostAdded = -1;
            // Another value to begin with in each row, so that ties do not always take the first.
            for (int k = 0; k < counts[i]; ++k) {
                int const value = (k + static_cast<int>(rows.size())) % counts[i];
                int numAdded = 0;
                for (std::size_t j = 0; j < n; ++j) {
                    if (j != i && row[j] >= 0) numAdded += isMissing[pairOf(i, j, value, row[j])];
                }
                if (numAdded <= mostAdded) continue;
                mostAdded = numAdded;
                row[i] = value;
            }
        }
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t j = i + 1; j < n; ++j) isMissing[pairOf(i, j, row[i], row[j])] = false;
        }
        rows.push_back(row);
    }
}

TEST(CoveringArray, HasEveryPairOfValuesInFewRows) {
    std::vector<int> const counts = {4, 3, 2, 2, 5};
    std::vector<Row> const rows = coveringArray(counts);
    for (std::size_t i = 0; i < counts.size(); ++i) {
        for (std::size_t j = i + 1; j < counts.size(); ++j) {
            std::vector<std::pair<int, int>> pairs;
            for (Row const& row : rows) pairs.emplace_back(row[i], row[j]);
            std::sort(pairs.begin(), pairs.end());
            pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
            EXPECT_EQ(pairs.size(), Index(counts[i] * counts[j])) << i << " " << j;
        }
    }
    EXPECT_LE(rows.size(), 30U);  // 20 at least; all combinations are 240
}

// --- The options
// --------------------------------------------------------------------------------------------------

/// Options with their rules.
struct Choice {
    Sdc::Options::VtxBoundaryInterpolation boundary = Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER;
    Sdc::Options::CreasingMethod creasing = Sdc::Options::CREASE_UNIFORM;
    Sdc::Options::TriangleSubdivision triangles = Sdc::Options::TRI_SUB_CATMARK;
    ShadingOptions options;
};

std::vector<int> const kCounts = {4, 3, 2, 2, 6, 3, 3, 5, 3, 2, 3, 2, 2, 3, 2};

Choice choiceOf(Row const& row) {
    Choice choice;
    ShadingOptions& options = choice.options;
    options.level = row[0];
    auto const levelOf = [&](int value) { return value == 2 ? options.level : value - 1; };
    choice.boundary = static_cast<Sdc::Options::VtxBoundaryInterpolation>(row[1]);
    choice.creasing = static_cast<Sdc::Options::CreasingMethod>(row[2]);
    choice.triangles = static_cast<Sdc::Options::TriangleSubdivision>(row[3]);
    options.startNormals.kind = static_cast<StartNormalKind>(row[4]);
    options.startNormals.level = options.startNormals.kind == StartNormalKind::User ? 0 : levelOf(row[5]);
    options.subdividedNormals.averaging = static_cast<NormalAveraging>(row[6]);
    options.weights.scheme = static_cast<WeightScheme>(row[7]);
    options.weights.sharpVertices = static_cast<SharpVertexWeight>(row[8]);
    options.weights.darts = static_cast<DartWeight>(row[9]);
    options.weights.level = levelOf(row[10]);
    options.weights.exponent = row[11] == 0 ? 1 : 1.5;
    options.limits.positions = static_cast<PositionKind>(row[12]);
    options.limits.normals = static_cast<LimitNormalKind>(row[13]);
    options.execution.numThreads = 1 + row[14];
    return choice;
}

/// What a model has that some options are about.
struct Traits {
    bool hasBoundary = false, hasFading = false, hasTriangles = false, hasSharp = false;
};

/// Every combination of what the whole sweep varies, `level` apart.
std::vector<Choice> allChoices(int level, Traits const& traits) {
    std::vector<Choice> choices;
    for (int boundary = 0; boundary < (traits.hasBoundary ? 3 : 1); ++boundary) {
        for (int creasing = 0; creasing < (traits.hasFading ? 2 : 1); ++creasing) {
            for (int triangles = 0; triangles < (traits.hasTriangles ? 2 : 1); ++triangles) {
                for (int scheme = 0; scheme < 5; ++scheme) {
                    for (int sharp = 0; sharp < (traits.hasSharp ? 3 : 1); ++sharp) {
                        for (int darts = 0; darts < (traits.hasSharp ? 2 : 1); ++darts) {
                            choices.push_back(choiceOf({level, boundary, creasing, triangles, 0, 0, 0, scheme,
                                                        sharp, darts, 0, 0, 0, 0, 0}));
                        }
                    }
                }
                choices.push_back(
                    choiceOf({level, boundary, creasing, triangles, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}));
                choices.back().options = SmoothPreset(level);  // variant D
            }
        }
    }
    return choices;
}

// --- The models
// ---------------------------------------------------------------------------------------------------

/// The model, or nothing where its reader refuses it: a face with a repeated vertex.
std::optional<io::Model> read(std::string const& file) {
    try {
        return io::ReadObj(file);
    } catch (Error const& error) {
        EXPECT_NE(std::string(error.what()).find("more than once"), std::string::npos) << error.what();
        return std::nullopt;
    }
}

bool allFacesHave(io::Model const& model, int size) {
    return std::all_of(model.faceSizes.begin(), model.faceSizes.end(), [&](int n) { return n == size; });
}

/// What the library refuses of a choice, by its documentation; nothing where it must shade.
std::string refusalOf(ShadingOptions const& options, bool hasNgons) {
    if (!hasNgons) return {};
    if (options.level == 0) return "level is 0, but the mesh has faces other than quads";
    auto const kind = options.startNormals.kind;
    if (options.startNormals.level == 0 &&
        (kind == StartNormalKind::Limit || kind == StartNormalKind::LimitSmoothed)) {
        return "limit normals can't start at level 0";
    }
    if (options.weights.level == 0 && options.weights.scheme == WeightScheme::InverseLimit) {
        return "inverse-limit weights can't start at level 0";
    }
    return {};
}

template <typename Real>
bool isUnitOrZero(Vec3<Real> const& n) {
    double const length = std::hypot(double(n.x), double(n.y), double(n.z));
    return length == 0 || std::fabs(length - 1) < 1e-5;
}

/// What is wrong with a result in itself; empty: nothing.
std::string faultOf(ShadingResult<double> const& result) {
    for (auto const& p : result.positions) {
        if (!IsFinite(p)) return "a position is not finite";
    }
    for (std::size_t i = 0; i < result.blendWeights.size(); ++i) {
        if (!(result.blendWeights[i] >= 0 && result.blendWeights[i] <= 1)) return "a weight is not in [0, 1]";
        if (!isUnitOrZero(result.limitNormals[i])) return "N_L is neither unit nor zero";
        if (!isUnitOrZero(result.subdividedNormals[i])) return "N_S is neither unit nor zero";
        if (!isUnitOrZero(result.blendedNormals[i])) return "N_B is neither unit nor zero";
    }
    return {};
}

std::string faultOf(TableFrame const& frame) {
    for (std::size_t i = 0; i < frame.positions.size(); ++i) {
        if (!IsFinite(frame.positions[i])) return "a frame's position is not finite";
        if (!(frame.blendWeights[i] >= 0 && frame.blendWeights[i] <= 1)) return "a frame's weight is not in [0, 1]";
        if (!isUnitOrZero(frame.limitNormals[i]) || !isUnitOrZero(frame.subdividedNormals[i]) ||
            !isUnitOrZero(frame.blendedNormals[i])) {
            return "a frame's normal is neither unit nor zero";
        }
    }
    return {};
}

std::string faultOf(GeometryCheck const& check) {
    std::string text;
    for (GeometryComparison const& c : check.comparisons) {
        text += c.name + ": " + std::to_string(c.largest * 1e15) + "e-15 at vertex " + std::to_string(c.vertex) +
                " of level " + std::to_string(c.level) + " ";
    }
    return check.Passes(1e-12) ? "" : "the geometry is not OpenSubdiv's: " + text;
}

/// What was done, which the tests print.
struct Counts {
    std::atomic<int> numShaded{0}, numRefused{0}, numChecked{0}, numTables{0};
};

/// A model in one scheme.
class Case {
public:
    Case(io::Model const& model, Sdc::SchemeType scheme)
        : _model(model), _scheme(scheme), _hasNgons(scheme == Sdc::SCHEME_CATMARK && !allFacesHave(model, 4)) {
        _points.assign(model.positions.begin(), model.positions.end());
        // Any normals do.
        for (std::size_t i = 0; i < _points.size(); ++i)
            _normals.push_back(std::sin(1 + 3.3F * static_cast<float>(i)));
        _normalsInDouble.assign(_normals.begin(), _normals.end());
    }

    std::size_t NumFaces(int level) const {
        return level == 0 ? _model.faceSizes.size() : _model.faceVertices.size() << (2 * (level - 1));
    }

    Traits FindTraits() const {
        SubdivisionRules rules;
        rules.scheme = _scheme;
        RefinedTopology const topology(_model.Mesh(rules), 0);
        Far::TopologyLevel const& level = topology.Level(0);
        Traits traits;
        auto const look = [&](float sharpness) {
            traits.hasSharp |= sharpness > 0;
            traits.hasFading |= sharpness > 0 && sharpness < Sdc::Crease::SHARPNESS_INFINITE;
        };
        for (int e = 0; e < level.GetNumEdges(); ++e) {
            traits.hasBoundary |= level.GetEdgeFaces(e).size() == 1;
            look(level.GetEdgeSharpness(e));
        }
        for (int v = 0; v < level.GetNumVertices(); ++v) look(level.GetVertexSharpness(v));
        traits.hasTriangles =
            _scheme == Sdc::SCHEME_CATMARK &&
            std::find(_model.faceSizes.begin(), _model.faceSizes.end(), 3) != _model.faceSizes.end();
        return traits;
    }

    /// Shades; checks the geometry, and a table, where that is asked for.
    void Run(Choice const& choice, bool isChecked, bool hasTable, Counts& counts) const {
        SubdivisionRules rules;
        rules.scheme = _scheme;
        rules.boundary = choice.boundary;
        rules.creasing = choice.creasing;
        rules.triangles = choice.triangles;
        ControlMesh const mesh = _model.Mesh(rules);
        ShadingOptions const& options = choice.options;
        bool const isUser = options.startNormals.kind == StartNormalKind::User;
        ShadingInput<double> input;
        input.positions = {_model.positions.data(), _model.positions.size() / 3};
        if (isUser) input.vertexNormals = {_normalsInDouble.data(), _normalsInDouble.size() / 3};

        std::string const refusal = refusalOf(options, _hasNgons);
        try {
            ShadingResult<double> const result = ShadeSubdivision(mesh, input, options);
            ++counts.numShaded;
            EXPECT_EQ(refusal, "") << nameOf(choice);
            EXPECT_EQ(faultOf(result), "") << nameOf(choice);
            if (isChecked) {
                ++counts.numChecked;
                EXPECT_EQ(faultOf(CheckGeometry(mesh, input.positions, result)), "") << nameOf(choice);
            }
            if (hasTable && options.subdividedNormals.averaging == NormalAveraging::Linear) {
                ++counts.numTables;
                PointView<float> const normals(_normals.data(), isUser ? _normals.size() / 3 : 0);
                TableFrame const frame =
                    EvaluateAll(ShadingTable(mesh, options), {_points.data(), _points.size() / 3}, {}, normals);
                EXPECT_EQ(frame.positions.size(), result.valueVertices.size()) << nameOf(choice);
                EXPECT_EQ(faultOf(frame), "") << nameOf(choice);
            }
        } catch (Error const& error) {
            ++counts.numRefused;
            EXPECT_NE(refusal, "") << nameOf(choice) << ": " << error.what();
            EXPECT_EQ(std::string(error.what()).rfind(refusal, 0), 0U) << nameOf(choice) << ": " << error.what();
        }
    }

private:
    std::string nameOf(Choice const& choice) const {
        ShadingOptions const& o = choice.options;
        std::string text = _model.name + (_scheme == Sdc::SCHEME_LOOP ? " in Loop" : "") +
                           ": level, boundary, creasing, "
                           "triangles, start normals and level, averaging, weights, sharp vertices, darts, level, "
                           "positions, limit normals:";
        for (int const number :
             {o.level, static_cast<int>(choice.boundary), static_cast<int>(choice.creasing),
              static_cast<int>(choice.triangles), static_cast<int>(o.startNormals.kind), o.startNormals.level,
              static_cast<int>(o.subdividedNormals.averaging), static_cast<int>(o.weights.scheme),
              static_cast<int>(o.weights.sharpVertices), static_cast<int>(o.weights.darts), o.weights.level,
              static_cast<int>(o.limits.positions), static_cast<int>(o.limits.normals)}) {
            text += " " + std::to_string(number);
        }
        return text;
    }

    io::Model const& _model;
    Sdc::SchemeType _scheme;
    bool _hasNgons;
    std::vector<float> _points, _normals;
    std::vector<double> _normalsInDouble;
};

void sweepSample(Case const& c, Counts& counts) {
    static std::vector<Row> const kRows = coveringArray(kCounts);
    constexpr std::size_t kManyFaces = 150, kMostFaces = 3000;
    bool const isLarge = c.NumFaces(0) > kManyFaces;
    std::size_t const step = (isLarge ? 4 : 1) * (IsSanitizerRun() ? 5 : 1);
    for (std::size_t i = 0; i < kRows.size(); i += step) {
        Row row = kRows[i];
        while (c.NumFaces(row[0]) > kMostFaces) --row[0];
        Choice const choice = choiceOf(row);
        c.Run(choice, /*isChecked=*/true, /*hasTable=*/!isLarge, counts);
    }
}

void sweepAll(Case const& c, Counts& counts) {
    struct Task {
        Choice choice;
        bool isChecked;
    };
    std::vector<Task> tasks;
    Traits const traits = c.FindTraits();
    for (int level = 0; level <= 3; ++level) {
        for (Choice const& choice : allChoices(level, traits)) {
            // Geometry does not depend on the weights: the first scheme and the smooth variant are checked.
            ShadingOptions const& o = choice.options;
            bool const isChecked =
                o.weights.sharpVertices == SharpVertexWeight::Zero && o.weights.darts == DartWeight::LikeSmooth &&
                (o.weights.scheme == WeightScheme::OneRing || o.weights.scheme == WeightScheme::One);
            tasks.push_back({choice, isChecked});
        }
    }
    // And the pairs of all other options.
    for (Row const& row : coveringArray(kCounts)) tasks.push_back({choiceOf(row), true});

    std::atomic<std::size_t> next{0};
    std::vector<std::thread> threads;
    for (unsigned i = 0; i < std::max(1U, std::thread::hardware_concurrency()); ++i) {
        threads.emplace_back([&] {
            for (std::size_t task = next++; task < tasks.size(); task = next++) {
                c.Run(tasks[task].choice, tasks[task].isChecked, /*hasTable=*/tasks[task].isChecked, counts);
            }
        });
    }
    for (std::thread& thread : threads) thread.join();
}

void sweep(std::vector<std::string> const& files) {
    Counts counts;
    for (std::string const& file : files) {
        std::optional<io::Model> const model = read(file);
        if (!model) continue;
        for (Sdc::SchemeType const scheme : {Sdc::SCHEME_CATMARK, Sdc::SCHEME_LOOP}) {
            if (scheme == Sdc::SCHEME_LOOP && !allFacesHave(*model, 3)) continue;
            Case const c(*model, scheme);
            auto const start = std::chrono::steady_clock::now();
            IsFullRun() ? sweepAll(c, counts) : sweepSample(c, counts);
            if (!IsFullRun()) continue;
            std::chrono::duration<double> const seconds = std::chrono::steady_clock::now() - start;
            std::printf("%s%s: %.1f s\n", model->name.c_str(), scheme == Sdc::SCHEME_LOOP ? ", loop" : "",
                        seconds.count());
            std::fflush(stdout);
        }
    }
    std::printf("%zu models: %d shaded, %d of them checked and %d with a table; %d refused\n", files.size(),
                counts.numShaded.load(), counts.numChecked.load(), counts.numTables.load(),
                counts.numRefused.load());
    EXPECT_GT(counts.numShaded.load(), 4 * counts.numRefused.load());
}

TEST(Sweep, OurModelsGiveAResultThatPassesOrADocumentedRefusal) {
    std::vector<std::string> const files = ioFiles::OwnModels();
    ASSERT_FALSE(files.empty());
    sweep(files);
}

TEST(Sweep, SharedModelsGiveAResultThatPassesOrADocumentedRefusal) {
    std::vector<std::string> const files = ioFiles::SharedModels();
    if (files.empty()) GTEST_SKIP() << ioFiles::kNoSharedModels;
    sweep(files);
}

}  // namespace
}  // namespace osd_shading::tests
