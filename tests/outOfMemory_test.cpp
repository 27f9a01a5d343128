// SPDX-License-Identifier: Apache-2.0

// A program of its own: each allocation fails once, and what comes of it is std::bad_alloc and no leak.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "osd_shading/geometryCheck.h"
#include "osd_shading/io/errors.h"
#include "osd_shading/io/objReader.h"
#include "osd_shading/io/objWriter.h"
#include "osd_shading/io/plyWriter.h"
#include "osd_shading/io/sharpReader.h"
#include "osd_shading/io/usdWriter.h"
#include "osd_shading/primvarTable.h"
#include "osd_shading/shadingStencils.h"
#include "tests/countedAllocations.h"
#include "tests/ioFiles.h"
#include "tests/sampleSize.h"
#include "tests/tableAgreement.h"

// OpenSubdiv's factories lose what they were making: a leak sanitizer shall look at our own code.
// Seen from outside: g++'s sanitizer is a shared library.
#if defined(__clang__)
#    pragma clang diagnostic ignored "-Wreserved-identifier"
#endif
extern "C" __attribute__((visibility("default"))) char const* __lsan_default_suppressions();
extern "C" char const* __lsan_default_suppressions() {
    return "leak:libosdCPU\nleak:OpenSubdiv::*::Far::TopologyRefinerFactory\n";
}

namespace osd_shading::tests {
namespace {

/// Some 200 of the allocations of a call in CI, its first and its last ones among them; all in a full run.
std::vector<std::int64_t> allocationsToFail(std::int64_t count) {
    std::int64_t const most = IsFullRun() ? count : static_cast<std::int64_t>(SampleSize(200));
    std::vector<std::int64_t> numbers;
    std::int64_t const step = std::max<std::int64_t>(1, count / most);
    for (std::int64_t number = 1; number <= count; number += number < 20 || number > count - 20 ? 1 : step) {
        numbers.push_back(number);
    }
    return numbers;
}

/// What is left behind: by our own code nothing; OpenSubdiv's factories and refining lose what they were making.
enum class Leaks { None, OfOpenSubdiv };

/// Lets each allocation of `call` fail. `call` makes and destroys all that it needs.
void expectBadAlloc(std::string const& name, Leaks leaks, std::function<void()> const& call) {
    call();  // what is made once and kept
    std::int64_t const before = NumAllocations();
    call();
    std::int64_t const count = NumAllocations() - before;
    EXPECT_GT(count, 0) << name;
    std::int64_t numThrown = 0;
    for (std::int64_t const number : allocationsToFail(count)) {
        std::int64_t const live = NumLiveAllocations();
        std::string outcome = "nothing thrown";
        FailAllocation(number);
        try {
            call();
        } catch (std::bad_alloc const&) {
            outcome.clear();
            ++numThrown;
        } catch (std::exception const& error) {
            outcome = error.what();
        }
        FailAllocation(0);
        // Only where less memory is an answer, in sorting, is nothing thrown.
        EXPECT_TRUE(outcome.empty() || outcome == "nothing thrown")
            << name << ", allocation " << number << ": " << outcome;
        outcome.clear();
        outcome.shrink_to_fit();
        if (leaks == Leaks::None) {
            EXPECT_EQ(NumLiveAllocations(), live) << name << ", allocation " << number;
        }
    }
    EXPECT_GT(numThrown, 0) << name;
}

Shape const kShape = shapes::MixedPolygons().Crease(0, 1, 1.5F).Corner(2, 3).Jitter(0.1);

TEST(OutOfMemory, ReadersAndWritersThrowAndLeakNothingAndNoFile) {
    std::string text;
    for (std::size_t i = 0; i < kShape.positions.size(); i += 3) {
        text += "v " + std::to_string(kShape.positions[i]) + " " + std::to_string(kShape.positions[i + 1]) + " " +
                std::to_string(kShape.positions[i + 2]) + "\n";
    }
    for (std::vector<int> const& face : kShape.Faces()) {
        text += "f";
        for (int const v : face) text += " " + std::to_string(v + 1);
        text += "\n";
    }
    text += "vt 0 0\nfs 1 2 3\nt crease 2/1/0 0 1 2\nt corner 1/1/0 0 2\nt hole 1/0/0 0\np 1\nfoo\n";
    expectBadAlloc("ParseObj", Leaks::None, [&] { io::ParseObj(text, "a model with a name of some length.obj"); });
    expectBadAlloc("ParseObj of a wrong file", Leaks::None, [&] {
        try {
            io::ParseObj("v 0 0 nan\n", "a model with a name of some length.obj");
        } catch (io::ParseError const&) {
            return;
        }
    });
    io::Model const read = io::ParseObj(text, "m.obj");
    expectBadAlloc("ApplySharpText", Leaks::None, [&] {
        io::Model model = read;
        io::ApplySharpText("as 3 1 2 3\nfs 1\nfoo\n", "m.sharp", model);
    });

    ioFiles::TemporaryFolder const folder;
    auto const expectWriter = [&](char const* fileName, auto const& write) {
        std::string const path = folder.File(fileName);
        expectBadAlloc(fileName, Leaks::None, [&] {
            write(path);
            std::remove(path.c_str());  // takes no memory
        });
        EXPECT_EQ(folder.NumFiles(), 0U) << fileName;
    };
    ShadingResult<double> const result = Shade<double>(kShape, PaperPreset(1));
    expectWriter("a.ply", [&](std::string const& path) { io::WritePly(path, result); });
    expectWriter("a.obj", [&](std::string const& path) { io::WriteObj(path, result); });
    ControlMesh const cage = kShape.Mesh();
    io::UsdOptions options;
    options.cage = &cage;
    options.cagePositions = kShape.Points();
    expectWriter("a.usda", [&](std::string const& path) { io::WriteUsd(path, result, options); });
}

TEST(OutOfMemory, ShadingThrowsAndLeaksNothingOnceTheLevelsAreRefined) {
    std::vector<double> const uvs(24, 0.5);
    std::vector<int> const indices(kShape.faceVertices.size(), 3);
    ShadingInput<double> input;
    input.positions = kShape.Points();
    input.vertexData = {{kShape.positions.data(), input.positions.size(), 3}};
    input.faceVaryingData = {{indices, {uvs.data(), 12, 2}}};
    ShadingOptions options = SmoothPreset(2);
    options.weights.scheme = WeightScheme::InverseLimit;
    expectBadAlloc("ShadeSubdivision", Leaks::OfOpenSubdiv,
                   [&] { ShadeSubdivision(kShape.Mesh(), input, options); });
    expectBadAlloc("CheckGeometry", Leaks::OfOpenSubdiv, [&] {
        CheckGeometry(kShape.Mesh(), input.positions, ShadeSubdivision(kShape.Mesh(), input, PaperPreset(1)));
    });

    // The allocations behind the refining, of one thread and of two.
    for (int const numThreads : {1, 2}) {
        options.execution.numThreads = numThreads;
        std::int64_t start = 0;
        bool isRefined = false;
        options.execution.progress = [&](double done) {
            if (!isRefined && done >= 0.3) {
                isRefined = true;
                FailAllocation(start);
            }
            return true;
        };
        std::int64_t numThrown = 0;
        for (start = 1; start < 2000; start += start < 100 ? 1 : 17) {
            std::int64_t const live = NumLiveAllocations();
            isRefined = false;
            bool isThrown = false;
            try {
                ShadeSubdivision(kShape.Mesh(), input, options);
            } catch (std::bad_alloc const&) {
                isThrown = true;
            }
            FailAllocation(0);
            numThrown += isThrown;
            EXPECT_EQ(NumLiveAllocations(), live) << "allocation " << start << " with " << numThreads;
        }
        EXPECT_GT(numThrown, 50) << numThreads;
    }
}

TEST(OutOfMemory, TablesStencilsAndRowsThrow) {
    expectBadAlloc("ShadingTable", Leaks::OfOpenSubdiv, [] { ShadingTable(kShape.Mesh(), PaperPreset(2)); });
    ShadingOptions options = SmoothPreset(2);
    options.weights.scheme = WeightScheme::Bilinear;
    expectBadAlloc("ShadingTable of whole levels", Leaks::OfOpenSubdiv,
                   [&] { ShadingTable(kShape.Mesh(), options, ValueOrder::OpenSubdiv); });
    expectBadAlloc("BuildShadingStencils", Leaks::OfOpenSubdiv,
                   [&] { BuildShadingStencils(kShape.Mesh(), PaperPreset(1)); });
    std::vector<int> const indices(kShape.faceVertices.size(), 3);
    expectBadAlloc("BuildPrimvarTable", Leaks::OfOpenSubdiv, [&] {
        BuildPrimvarTable<float>(kShape.Mesh(), {{indices, 4}}, PaperPreset(1));
    });
}

TEST(OutOfMemory, FramesThrowAndTheNextOneIsRight) {
    Shape const torus = shapes::Torus(6, 5).Crease(0, 1, 1.5F).Jitter(0.1);
    std::vector<float> const torusPoints = torus.FloatPositions();
    ShadingTable const torusTable(torus.Mesh(), PaperPreset(2));
    expectBadAlloc("an evaluator", Leaks::None, [&] {
        EvaluateAll(torusTable, {torusPoints.data(), torusPoints.size() / 3});
    });

    // Its tangents vanish, so that frames allocate, and OpenSubdiv refines the tiles concerned.
    Shape const flat = shapes::Cube().CreaseAll(1.5F);
    std::vector<float> points = flat.FloatPositions();
    for (std::size_t i = 0; i < 12; ++i) points[i] = 0;
    PointView<float> const view{points.data(), points.size() / 3};
    ShadingTable const table(flat.Mesh(), PaperPreset(2));
    TableFrame const right = EvaluateAll(table, view);
    for (int const numThreads : {1, 2}) {
        expectBadAlloc("a frame and its evaluator", Leaks::OfOpenSubdiv, [&] {
            EvaluateAll(table, view, {numThreads, InstructionSet::Best});
        });
    }
    ShadingEvaluator evaluator(table);
    std::size_t const count = Index(table.NumValues());
    std::vector<Vec3<float>> normals(count);
    ShadingOutputs outputs;
    outputs.blendedNormals = SpanOf(normals);
    std::int64_t numThrown = 0;
    for (std::int64_t number = 1; number < 50; ++number) {
        FailAllocation(number);
        try {
            evaluator.Evaluate(view, outputs);
        } catch (std::bad_alloc const&) {
            ++numThrown;
        }
        FailAllocation(0);
        evaluator.Evaluate(view, outputs);
        ASSERT_TRUE(HasSameBits(normals, right.blendedNormals)) << number;
    }
    EXPECT_GT(numThrown, 0);
    expectBadAlloc("index buffers", Leaks::OfOpenSubdiv, [&] {
        table.TriangleValues();
        table.ResultValues();
        table.BlendWeights();
    });
}

}  // namespace
}  // namespace osd_shading::tests
