// SPDX-License-Identifier: Apache-2.0

// Each model of models/ has the feature that it is named for.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "osd_shading/io/objReader.h"
#include "osd_shading/subdivisionShading.h"
#include "tests/ioFiles.h"

namespace {

using namespace osd_shading;
using io::Model;
using Edge = std::pair<int, int>;

std::size_t Index(int i) { return static_cast<std::size_t>(i); }

Model Load(std::string const& name) { return io::ReadObj(std::string(OSD_SHADING_MODELS) + "/" + name + ".obj"); }

std::vector<std::string> Names() {
    std::vector<std::string> names;
    for (std::string const& file : ioFiles::OwnModels()) {
        names.push_back(std::filesystem::path(file).stem().string());
    }
    return names;
}

std::vector<std::vector<int>> FacesOf(Model const& model) {
    std::vector<std::vector<int>> faces;
    auto corner = model.faceVertices.begin();
    for (int size : model.faceSizes) {
        faces.emplace_back(corner, corner + size);
        corner += size;
    }
    return faces;
}

/// How often each directed edge is used.
std::map<Edge, int> DirectedEdges(Model const& model) {
    std::map<Edge, int> edges;
    for (std::vector<int> const& face : FacesOf(model)) {
        for (std::size_t i = 0; i < face.size(); ++i) ++edges[{face[i], face[(i + 1) % face.size()]}];
    }
    return edges;
}

bool IsBoundary(std::map<Edge, int> const& edges, Edge const& edge) {
    return edges.count({edge.second, edge.first}) == 0;
}

bool HasBoundary(Model const& model) {
    auto const edges = DirectedEdges(model);
    return std::any_of(edges.begin(), edges.end(), [&](auto const& edge) { return IsBoundary(edges, edge.first); });
}

double Volume(Model const& model) {
    double volume = 0;
    for (std::vector<int> const& face : FacesOf(model)) {
        double const* const a = &model.positions[3 * Index(face[0])];
        for (std::size_t i = 1; i + 1 < face.size(); ++i) {
            double const* const b = &model.positions[3 * Index(face[i])];
            double const* const c = &model.positions[3 * Index(face[i + 1])];
            volume += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                      a[2] * (b[0] * c[1] - b[1] * c[0]);
        }
    }
    return volume / 6;
}

/// The number of runs of faces around `vertex` that share edges there: 1 where the mesh is manifold.
int NumFans(Model const& model, int vertex) {
    // From each neighbour to the next one: faces run from the edge that leaves the vertex to that which comes in.
    std::map<int, int> next;
    for (std::vector<int> const& face : FacesOf(model)) {
        auto const at = std::find(face.begin(), face.end(), vertex);
        if (at == face.end()) continue;
        std::size_t const i = static_cast<std::size_t>(at - face.begin());
        next[face[(i + 1) % face.size()]] = face[(i + face.size() - 1) % face.size()];
    }
    std::set<int> ends;
    for (auto const& [from, to] : next) ends.insert(to);
    int numFans = 0;
    auto const follow = [&](int start) {
        ++numFans;
        for (auto step = next.find(start); step != next.end(); step = next.find(start)) {
            start = step->second;
            next.erase(step);
        }
    };
    // Open runs first, from their ends; what is left is closed.
    std::vector<int> starts;
    for (auto const& [from, to] : next) {
        if (ends.count(from) == 0) starts.push_back(from);
    }
    for (int start : starts) follow(start);
    while (!next.empty()) follow(next.begin()->first);
    return numFans;
}

/// Interior vertices by number of edges.
std::map<int, int> InteriorValences(Model const& model) {
    auto const edges = DirectedEdges(model);
    std::map<int, int> valences;
    std::set<int> onBoundary;
    for (auto const& [edge, count] : edges) {
        ++valences[edge.first];
        if (IsBoundary(edges, edge)) onBoundary.insert({edge.first, edge.second});
    }
    std::map<int, int> counts;
    for (auto const& [vertex, valence] : valences) {
        if (onBoundary.count(vertex) == 0) ++counts[valence];
    }
    return counts;
}

/// Sharpness by edge, the lower vertex first: the highest entry counts.
std::map<Edge, float> Creases(Model const& model) {
    std::map<Edge, float> creases;
    for (std::size_t i = 0; i < model.creaseSharpness.size(); ++i) {
        Edge const edge = std::minmax(model.creaseVertices[2 * i], model.creaseVertices[2 * i + 1]);
        creases[edge] = std::max(creases[edge], model.creaseSharpness[i]);
    }
    return creases;
}

/// How many vertices have `numSharp` creases.
int NumVerticesWithCreases(Model const& model, int numSharp) {
    std::map<int, int> counts;
    for (auto const& [edge, sharpness] : Creases(model)) {
        if (sharpness <= 0) continue;
        ++counts[edge.first];
        ++counts[edge.second];
    }
    return static_cast<int>(
        std::count_if(counts.begin(), counts.end(), [&](auto const& count) { return count.second == numSharp; }));
}

int NumDarts(Model const& model) { return NumVerticesWithCreases(model, 1); }

bool HasCrease(Model const& model, float lowest, float highest) {
    auto const creases = Creases(model);
    return std::any_of(creases.begin(), creases.end(),
                       [&](auto const& crease) { return crease.second >= lowest && crease.second <= highest; });
}

bool HasSemiSharp(Model const& model) { return HasCrease(model, 0.01F, 9.99F); }
bool HasInfinitelySharp(Model const& model) { return HasCrease(model, 10.0F, 1e9F); }

bool HasOnlyFacesOf(Model const& model, int size) {
    return std::all_of(model.faceSizes.begin(), model.faceSizes.end(), [&](int s) { return s == size; });
}

template <typename Real>
ShadingResult<Real> Shade(Model const& model, Sdc::SchemeType scheme, ShadingOptions const& options) {
    std::vector<Real> points;
    for (double x : model.positions) points.push_back(static_cast<Real>(x));
    ShadingInput<Real> input;
    input.positions = {points.data(), points.size() / 3};
    SubdivisionRules rules;
    rules.scheme = scheme;
    return ShadeSubdivision(model.Mesh(model.Rules(rules)), input, options);
}

template <typename Real>
void ExpectUnitNormals(Model const& model, Sdc::SchemeType scheme, ShadingOptions const& options) {
    ShadingResult<Real> const result = Shade<Real>(model, scheme, options);
    EXPECT_EQ(result.report.zeroNormals, 0) << model.name;
    EXPECT_EQ(result.report.zeroStartNormals, 0) << model.name;
    EXPECT_EQ(result.report.fallbackNormals, 0) << model.name;
    for (Vec3<Real> const& n : result.blendedNormals) {
        ASSERT_NEAR(std::sqrt(double(n.x * n.x + n.y * n.y + n.z * n.z)), 1.0, 1e-5) << model.name;
    }
}

TEST(Models, AreThereSayWhatTheyShowAndReadWithoutWarnings) {
    std::vector<std::string> const names = Names();
    EXPECT_GE(names.size(), 18U);
    for (std::string const& name : names) {
        Model const model = Load(name);
        EXPECT_TRUE(model.warnings.empty()) << model.warnings.front();
        std::ifstream file(std::string(OSD_SHADING_MODELS) + "/" + name + ".obj");
        std::string line;
        std::getline(file, line);
        EXPECT_EQ(line.rfind("# ", 0), 0U) << name;
        EXPECT_GT(line.size(), 20U) << name;
    }
}

TEST(Models, AreListedInTheirReadme) {
    std::ifstream file(std::string(OSD_SHADING_MODELS) + "/README.md");
    std::string const text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    for (std::string const& name : Names()) {
        EXPECT_NE(text.find("| `" + name + "` |"), std::string::npos) << name;
    }
}

TEST(Models, AreManifoldAndWoundOutwards) {
    for (std::string const& name : Names()) {
        Model const model = Load(name);
        auto const edges = DirectedEdges(model);
        for (auto const& [edge, count] : edges) {
            EXPECT_EQ(count, 1) << name << ": edge " << edge.first << " " << edge.second;
        }
        for (int vertex = 0; vertex < model.NumVertices(); ++vertex) {
            EXPECT_EQ(NumFans(model, vertex), 1) << name << ": vertex " << vertex;
        }
        EXPECT_EQ(HasBoundary(model), name == "hat" || name == "open_box") << name;
        EXPECT_GT(Volume(model), 0) << name;
    }
}

TEST(Models, HaveCreasesOnEdgesThatTheyHave) {
    for (std::string const& name : Names()) {
        Model const model = Load(name);
        auto const edges = DirectedEdges(model);
        for (auto const& [edge, sharpness] : Creases(model)) {
            EXPECT_TRUE(edges.count(edge) + edges.count({edge.second, edge.first}) > 0) << name;
        }
        EXPECT_TRUE(!model.creaseSharpness.empty() || name == "cube_corners") << name;
    }
}

TEST(Models, CubesHaveTheirCreasesDartsFractionsCornersUvsAndHole) {
    EXPECT_TRUE(HasSemiSharp(Load("cube_creased")));
    EXPECT_FALSE(HasInfinitelySharp(Load("cube_creased")));
    EXPECT_EQ(NumDarts(Load("cube_creased")), 0);
    EXPECT_EQ(NumDarts(Load("cube_dart")), 4);

    // By the rule for fs lines, worked by hand: the first face, 1 2 4 3 in the file, has its edge from the third to
    // the fourth vertex first.
    Model const fractional = Load("cube_fractional");
    auto const creases = Creases(fractional);
    EXPECT_EQ(std::count_if(creases.begin(), creases.end(),
                            [](auto const& crease) { return crease.second != std::round(crease.second); }),
              8);
    EXPECT_FLOAT_EQ(creases.at({2, 3}), 0.3F);
    EXPECT_FLOAT_EQ(creases.at({0, 2}), 0.5F);
    EXPECT_FLOAT_EQ(creases.at({5, 7}), 1.75F);

    EXPECT_EQ(Load("cube_corners").cornerSharpness.size(), 3U);
    EXPECT_EQ(Load("cube_hole").holes.size(), 1U);
    Model const uvs = Load("cube_uvs");
    EXPECT_EQ(uvs.uvIndices.size(), uvs.faceVertices.size());
    EXPECT_EQ(uvs.uvs.size(), 2U * 14U);  // the unfolding has 14 corners, the cube 8: seams
    EXPECT_EQ(Load("bar_chaikin").creasing, Sdc::Options::CREASE_CHAIKIN);
    EXPECT_TRUE(HasCrease(Load("bar_chaikin"), 1.1F, 1.3F));
}

TEST(Models, TetrahedraHaveACreaseAndTwoDarts) {
    auto const creases = Creases(Load("tetrahedron"));
    EXPECT_EQ(creases, (std::map<Edge, float>{{{1, 2}, 2.0F}, {{1, 3}, 2.0F}, {{2, 3}, 2.0F}}));
    EXPECT_EQ(NumDarts(Load("tetrahedron_dart")), 2);
}

TEST(Models, CrossesHaveTheSameShapeInQuadsAndTriangles) {
    Model const quads = Load("cross_quads"), triangles = Load("cross_triangles");
    EXPECT_TRUE(HasOnlyFacesOf(quads, 4));
    EXPECT_TRUE(HasOnlyFacesOf(triangles, 3));
    EXPECT_EQ(quads.positions, triangles.positions);
    EXPECT_EQ(Creases(quads), Creases(triangles));
    EXPECT_EQ(InteriorValences(quads)[6], 8);
}

TEST(Models, LettersHaveARoundedFaceAndDarts) {
    Model const letter = Load("letter_a");
    EXPECT_TRUE(HasSemiSharp(letter) && HasInfinitelySharp(letter));
    EXPECT_EQ(NumDarts(letter), 0);
    EXPECT_EQ(NumDarts(Load("letter_a_dart")), 4);
    // The counter goes right through: genus 1.
    int const numEdges = static_cast<int>(DirectedEdges(letter).size() / 2);
    EXPECT_EQ(letter.NumVertices() - numEdges + letter.NumFaces(), 0);
}

TEST(Models, MugIsHollowHasAHandleAndASemiSharpRim) {
    Model const mug = Load("mug");
    EXPECT_TRUE(HasOnlyFacesOf(mug, 4));
    EXPECT_GE(mug.NumFaces(), 150);
    EXPECT_LE(mug.NumFaces(), 400);
    std::map<int, int> const expected = {{3, 8}, {4, mug.NumVertices() - 16}, {5, 8}};
    EXPECT_EQ(InteriorValences(mug), expected);
    int const numEdges = static_cast<int>(DirectedEdges(mug).size() / 2);
    EXPECT_EQ(mug.NumVertices() - numEdges + mug.NumFaces(), 0);  // the handle
    EXPECT_TRUE(HasSemiSharp(mug));
    EXPECT_EQ(std::count(mug.uvIndices.begin(), mug.uvIndices.end(), -1), 0);
    EXPECT_FALSE(mug.uvIndices.empty());
    // Hollow: much less volume than what the walls enclose, some pi * 2.2.
    EXPECT_LT(Volume(mug), 0.4 * 3.14 * 2.2);
}

TEST(Models, RingHasCreasesThatMeetInCornersAndAxeDartsBesides) {
    Model const ring = Load("ring"), axe = Load("axe");
    EXPECT_GE(NumVerticesWithCreases(ring, 3) + NumVerticesWithCreases(ring, 4), 8);
    EXPECT_TRUE(HasSemiSharp(ring) && HasInfinitelySharp(ring));
    EXPECT_EQ(ring.NumVertices() - static_cast<int>(DirectedEdges(ring).size() / 2) + ring.NumFaces(), 0);
    EXPECT_GE(NumVerticesWithCreases(axe, 3) + NumVerticesWithCreases(axe, 4), 4);
    EXPECT_EQ(NumDarts(axe), 4);
    EXPECT_TRUE(HasSemiSharp(axe) && HasInfinitelySharp(axe));
    EXPECT_EQ(InteriorValences(axe)[5], 8);
}

TEST(Models, HatIsOfTrianglesWithDartsAndPencilOfAllSizes) {
    Model const hat = Load("hat");
    EXPECT_TRUE(HasOnlyFacesOf(hat, 3));
    EXPECT_EQ(NumDarts(hat), 2);
    EXPECT_TRUE(HasSemiSharp(hat) && HasInfinitelySharp(hat));
    Model const pencil = Load("pencil_ngons");
    std::set<int> const sizes(pencil.faceSizes.begin(), pencil.faceSizes.end());
    EXPECT_EQ(sizes, (std::set<int>{3, 4, 5, 6}));
    EXPECT_EQ(NumDarts(Load("open_box")), 2);
}

TEST(Models, ShadeWithUnitNormalsInEveryVariantAndScheme) {
    ShadingOptions regions = PaperPreset(3);
    regions.weights.sharpVertices = SharpVertexWeight::PerRegion;
    for (std::string const& name : Names()) {
        Model const model = Load(name);
        for (ShadingOptions const& options : {PaperPreset(3), SmoothPreset(3), regions}) {
            ExpectUnitNormals<double>(model, Sdc::SCHEME_CATMARK, options);
            ExpectUnitNormals<float>(model, Sdc::SCHEME_CATMARK, options);
            if (HasOnlyFacesOf(model, 3)) ExpectUnitNormals<double>(model, Sdc::SCHEME_LOOP, options);
        }
    }
}

TEST(Models, ThatHaveDartsKeepThemAtTheLastLevel) {
    for (auto const& [name, numDarts] :
         std::map<std::string, int>{{"cube_dart", 2}, {"tetrahedron_dart", 2}, {"letter_a_dart", 2}}) {
        // Those that end an infinitely sharp crease.
        EXPECT_EQ(Shade<double>(Load(name), Sdc::SCHEME_CATMARK, PaperPreset(4)).report.darts, numDarts) << name;
    }
}

}  // namespace
