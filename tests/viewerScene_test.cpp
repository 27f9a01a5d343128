// SPDX-License-Identifier: Apache-2.0

// Scenes: the connectivity of what is drawn, what a scene holds, and fields of it.

#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <string>

#include "tests/viewerModels.h"
#include "viewer/commandLine.h"
#include "viewer/requestShading.h"
#include "viewer/sceneBuilder.h"
#include "viewer/sceneFields.h"
#include "viewer/sceneRequest.h"

namespace osd_shading::viewer {
namespace {

TEST(SurfaceTopology, HasEachControlEdgeAsACurveBetweenItsVertices) {
    for (std::string const name : {"cube_creased", "mug", "pencil_ngons", "hat", "open_box", "ring", "letter_a"}) {
        for (int level : {1, 3}) {
            SCOPED_TRACE(name + std::to_string(level));
            std::shared_ptr<Scene const> const scene = SceneOf(name, level);
            std::set<EdgeKey> curves;
            for (ControlCurve const& curve : scene->topology->curves) {
                curves.insert(curve.vertices);
                EXPECT_EQ(curve.count, (std::size_t{1} << level) + 1);
                auto const vertexAt = [&](std::size_t i) {
                    int const value = scene->topology->curveValues[curve.first + i];
                    return scene->topology->valueVertices[static_cast<std::size_t>(value)];
                };
                EXPECT_EQ(vertexAt(0), curve.vertices[0]);
                EXPECT_EQ(vertexAt(curve.count - 1), curve.vertices[1]);
            }
            EXPECT_EQ(curves, EdgesOf(LoadModel(name)));
            EXPECT_EQ(curves.size(), scene->topology->curves.size());
        }
    }
}

TEST(SurfaceTopology, HasControlEdgesAsCurvesOnAdaptiveTrianglesToo) {
    for (std::string const name : {"cube_creased", "mug", "pencil_ngons", "hat", "open_box", "ring"}) {
        for (std::string const cut : {"curvature", "screen", "5"}) {
            SCOPED_TRACE(name + " " + cut);
            auto const line = ParseCommandLine({name, "--tessellate", cut});
            auto const model = std::make_shared<io::Model>(LoadModel(name));
            SceneBuilder builder;
            auto const scene =
                builder.Build(MakeRequest(line->settings, model, name, {640, 400}), [](double) { return true; });
            EXPECT_EQ(scene->topology->faceSize, 3);
            std::set<EdgeKey> curves;
            for (ControlCurve const& curve : scene->topology->curves) curves.insert(curve.vertices);
            EXPECT_EQ(curves, EdgesOf(LoadModel(name)));
            EXPECT_EQ(curves.size(), scene->topology->curves.size());
        }
    }
}

TEST(SceneBuilder, CutsFinerForALargerScreen) {
    auto const line = ParseCommandLine({"mug", "--tessellate", "screen"});
    auto const model = std::make_shared<io::Model>(LoadModel("mug"));
    auto const facesOn = [&](glm::ivec2 size) {
        SceneBuilder builder;
        return builder.Build(MakeRequest(line->settings, model, "mug", size), [](double) { return true; })
            ->report.faces;
    };
    EXPECT_GT(facesOn({1280, 800}), 2 * facesOn({320, 200}));
}

TEST(SurfaceTopology, HasEachEdgeOnce) {
    // Euler: a closed surface of genus g has 2 - 2 g = V - E + F; the mug's handle makes it a torus.
    for (auto const& [name, euler] : {std::pair("cube_creased", 2), {"mug", 0}, {"cross_triangles", 2}}) {
        SCOPED_TRACE(name);
        std::shared_ptr<Scene const> const scene = SceneOf(name, 2);
        SurfaceTopology const& topology = *scene->topology;
        EXPECT_EQ(topology.NumVertices() - static_cast<int>(topology.wires.size()) +
                      static_cast<int>(topology.NumFaces()),
                  euler);
    }
}

TEST(SurfaceTopology, KnowsWhereNoBackOfAFaceCanBeSeen) {
    for (auto const& [name, isClosed] : {std::pair("mug", true),
                                         {"cross_triangles", true},
                                         {"ring", true},
                                         {"hat", false},
                                         {"open_box", false},
                                         {"cube_hole", false}}) {
        EXPECT_EQ(SceneOf(name, 2)->topology->hidesBackFaces, isClosed) << name;
    }
    // Turned inside out, closed as it is, its backs are what one sees.
    auto const model = std::make_shared<io::Model>(LoadModel("cube_uvs"));
    std::reverse(model->faceVertices.begin(), model->faceVertices.end());
    SceneBuilder builder;
    auto const scene = builder.Build({model, "reversed", model->Rules({}), PaperPreset(2), false, {}},
                                     [](double) { return true; });
    EXPECT_FALSE(scene->topology->hidesBackFaces);
}

TEST(SceneBuilder, HasSubdividedNormalsEverywhereWhereTheyAreAskedFor) {
    auto const count = [](Scene const& scene) {
        std::size_t missing = 0;
        for (SurfaceVertex const& vertex : scene.vertices) {
            missing += glm::length(vertex.subdividedNormal) < 0.5F ? 1U : 0U;
        }
        return missing;
    };
    EXPECT_GT(count(*SceneOf("mug", 3)), 1000U);
    EXPECT_EQ(count(*SceneOf("mug", 3, Sdc::SCHEME_CATMARK, true)), 0U);
}

TEST(SceneBuilder, MovesByTablesAsItWouldLevelByLevel) {
    for (auto const& [name, scheme] : {std::pair("mug", Sdc::SCHEME_CATMARK),
                                       {"letter_a_dart", Sdc::SCHEME_CATMARK},
                                       {"hat", Sdc::SCHEME_LOOP},
                                       {"pencil_ngons", Sdc::SCHEME_CATMARK}}) {
        SCOPED_TRACE(name);
        auto const model = std::make_shared<io::Model>(LoadModel(name));
        SubdivisionRules rules;
        rules.scheme = scheme;
        SceneRequest request{model,          name, model->Rules(rules),
                             PaperPreset(3), true, {DeformationKind::Bend, 0.2F, 1}};
        auto const build = [](SceneBuilder& builder, SceneRequest const& wanted) {
            return builder.Build(wanted, [](double) { return true; });
        };
        // Deformed beforehand, and then shaded as any model.
        std::vector<glm::vec3> points;
        auto const scene = SceneOf(name, 1, scheme);
        auto moved = std::make_shared<io::Model>(*model);
        for (glm::vec3 const& p : scene->cage.points) points.push_back(p);
        Deform(request.deformation, points);
        for (std::size_t i = 0; i < points.size(); ++i) {
            for (int k = 0; k < 3; ++k) {
                moved->positions[3 * i + static_cast<std::size_t>(k)] = static_cast<double>(points[i][k]);
            }
        }
        SceneRequest still = request;
        still.model = moved;
        still.deformation = {};
        SceneBuilder byTables, byLevels;
        auto const expected = build(byLevels, still);
        request.deformation.phase = 0.7F;
        build(byTables, request);
        request.deformation.phase = 0.2F;  // from the tables of the frame before
        auto const actual = build(byTables, request);
        ASSERT_EQ(actual->vertices.size(), expected->vertices.size());
        glm::vec3 const shift(expected->origin);
        int numOff = 0;
        for (std::size_t i = 0; i < actual->vertices.size(); ++i) {
            SurfaceVertex const &a = actual->vertices[i], &b = expected->vertices[i];
            ASSERT_LT(glm::distance(a.position, b.position + shift), 1e-5F * expected->bounds.radius);
            ASSERT_EQ(a.weight, b.weight);
            // Of zero length where there is none; a few are badly conditioned.
            for (NormalChoice choice : {NormalChoice::Limit, NormalChoice::Subdivided, NormalChoice::Blended}) {
                numOff += glm::distance(NormalOf(a, choice), NormalOf(b, choice)) > 1e-3F ? 1 : 0;
            }
        }
        EXPECT_LE(numOff, static_cast<int>(actual->vertices.size() / 1000));
    }
}

TEST(SceneFields, AgreeWithTheLibrarysReport) {
    std::shared_ptr<Scene const> const scene = SceneOf("cross_quads", 3);
    AngleStatistics const angles = CompareNormals(*scene, NormalChoice::Limit, NormalChoice::Blended);
    EXPECT_NEAR(angles.max, scene->report.maxAngle, 1e-3);
    EXPECT_NEAR(angles.mean, scene->report.meanAngle, 1e-3);
    EXPECT_EQ(angles.maxValue, scene->report.maxAngleValue);
    EXPECT_EQ(CompareNormals(*scene, NormalChoice::Face, NormalChoice::Face).max, 0);
}

TEST(SceneFields, RegionsOfAControlVertexAreItsFacesBetweenSharpEdges) {
    std::shared_ptr<Scene const> const scene = SceneOf("open_box", 2);
    SurfaceTopology const& topology = *scene->topology;
    for (int vertex = 0; vertex < topology.numControlVertices; ++vertex) {
        RegionShape const regions = RegionsOf(*scene, vertex);
        EXPECT_EQ(static_cast<int>(regions.values.size()),
                  topology.FirstValue(vertex + 1) - topology.FirstValue(vertex));
        for (auto const& triangles : regions.triangles) {
            // Whole control faces: 4^2 quads of two triangles each.
            EXPECT_GT(triangles.size(), 0U);
            EXPECT_EQ(triangles.size() % (16 * 2 * 3), 0U);
        }
    }
}

}  // namespace
}  // namespace osd_shading::viewer
