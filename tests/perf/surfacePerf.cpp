// SPDX-License-Identifier: Apache-2.0

// What evaluating a LimitSurface costs beside OpenSubdiv's Bfr, on the same random points of all faces of a mesh,
// side by side in one run: P, du and dv by Bfr; those and N_L, N_S, b and N_B by ours.

#include <opensubdiv/bfr/refinerSurfaceFactory.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>
#include <random>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "openSubdivAlone.h"
#include "osd_shading/io/model.h"
#include "osd_shading/limitSurface.h"
#include "perfMeshes.h"
#include "stopwatch.h"

namespace perf {
namespace {

namespace Far = OpenSubdiv::OPENSUBDIV_VERSION::Far;
namespace Bfr = OpenSubdiv::OPENSUBDIV_VERSION::Bfr;
using osd_shading::LimitSurface;
using osd_shading::io::Model;

constexpr int kPointsPerFace = 16;

/// A regular torus: no weights, no irregular faces.
Model plainTorus(int around, int up) {
    Model model;
    model.name = "plain torus";
    constexpr double kTurn = 6.283185307179586;
    for (int i = 0; i < around; ++i) {
        for (int j = 0; j < up; ++j) {
            double const a = kTurn * i / around, b = kTurn * j / up, r = 3 + std::cos(b);
            model.positions.insert(model.positions.end(), {r * std::cos(a), r * std::sin(a), std::sin(b)});
            int const right = (i + 1) % around, above = (j + 1) % up;
            model.faceSizes.push_back(4);
            model.faceVertices.insert(model.faceVertices.end(),
                                      {i * up + j, right * up + j, right * up + above, i * up + above});
        }
    }
    return model;
}

/// Random parameters of each face, laid out as Bfr does.
template <typename Real>
std::vector<osd_shading::SurfaceParameter<Real>> randomParameters(Far::TopologyRefiner const& refiner) {
    std::mt19937 random(1);
    std::uniform_real_distribution<Real> uniform(0, 1);
    std::vector<osd_shading::SurfaceParameter<Real>> parameters;
    bool const isTriangle = refiner.GetSchemeType() == osd_shading::Sdc::SCHEME_LOOP;
    for (int f = 0; f < refiner.GetLevel(0).GetNumFaces(); ++f) {
        Bfr::Parameterization const layout(refiner.GetSchemeType(), refiner.GetLevel(0).GetFaceVertices(f).size());
        for (int i = 0; i < kPointsPerFace; ++i) {
            Real uv[2] = {uniform(random), uniform(random)};
            if (isTriangle && uv[0] + uv[1] > 1) {
                uv[0] = 1 - uv[0];
                uv[1] = 1 - uv[1];
            }
            if (layout.HasSubFaces()) {
                Real const inFace[2] = {uv[0], uv[1]};
                layout.ConvertNormalizedSubFaceToCoord(i % layout.GetFaceSize(), inFace, uv);
            }
            parameters.push_back({uv[0], uv[1]});
        }
    }
    return parameters;
}

template <typename Real>
void measure(Model const& model, bool isLoop, double seconds) {
    osd_shading::SubdivisionRules rules;
    if (isLoop) rules.scheme = osd_shading::Sdc::SCHEME_LOOP;
    osd_shading::ControlMesh const mesh = model.Mesh(rules);
    std::vector<Real> const positions(model.positions.begin(), model.positions.end());
    osd_shading::ShadingInput<Real> input;
    input.positions = {positions.data(), positions.size() / 3};

    // Ours, and all faces built; the second time the neighbourhoods are known.
    double const start = ThreadSeconds();
    LimitSurface<Real> const surface(mesh, input);
    int const numFaces = surface.NumFaces();
    for (int f = 0; f < numFaces; ++f) surface.Evaluate(f, 0, 0);
    double const firstBuild = ThreadSeconds() - start;
    LimitSurface<Real> const moved = surface.Moved(input);
    double const again = ThreadSeconds();
    for (int f = 0; f < numFaces; ++f) moved.Evaluate(f, 0, 0);
    double const secondBuild = ThreadSeconds() - again;

    // Bfr's, with as many levels of patches as its default.
    std::unique_ptr<Far::TopologyRefiner> const refiner = MakeRefiner(mesh);
    double const bfrStart = ThreadSeconds();
    Bfr::RefinerSurfaceFactory<> const factory(*refiner);
    std::vector<Bfr::Surface<Real>> surfaces(static_cast<std::size_t>(numFaces));
    std::vector<std::vector<Real>> patchPoints(surfaces.size());
    std::vector<int> evaluated;
    for (int f = 0; f < numFaces; ++f) {
        auto const i = static_cast<std::size_t>(f);
        if (!factory.InitVertexSurface(f, &surfaces[i])) continue;
        patchPoints[i].resize(3 * static_cast<std::size_t>(surfaces[i].GetNumPatchPoints()));
        surfaces[i].PreparePatchPoints(positions.data(), {3, 3}, patchPoints[i].data(), {3, 3});
        evaluated.push_back(f);
    }
    double const bfrBuild = ThreadSeconds() - bfrStart;

    auto const parameters = randomParameters<Real>(*refiner);
    std::vector<osd_shading::SurfacePoint<Real>> results(kPointsPerFace);
    Real sink = 0;
    auto const ours = [&] {
        for (int const f : evaluated) {
            surface.Evaluate(f, {&parameters[static_cast<std::size_t>(f) * kPointsPerFace], kPointsPerFace},
                             results.data());
            sink += results[0].blendedNormal.x;
        }
    };
    auto const theirs = [&] {
        Real p[3], du[3], dv[3];
        for (int const f : evaluated) {
            auto const i = static_cast<std::size_t>(f);
            for (int k = 0; k < kPointsPerFace; ++k) {
                auto const& parameter = parameters[i * kPointsPerFace + static_cast<std::size_t>(k)];
                Real const uv[2] = {parameter.u, parameter.v};
                surfaces[i].Evaluate(uv, patchPoints[i].data(), {3, 3}, p, du, dv);
                sink += p[0] + du[0] + dv[0];
            }
        }
    };
    std::vector<double> const times = SecondsPerFrame({{theirs}, {ours}}, seconds);
    double const count = static_cast<double>(evaluated.size()) * kPointsPerFace;
    auto const stats = surface.Stats();
    int numRegular = 0;
    for (int const f : evaluated) numRegular += surfaces[static_cast<std::size_t>(f)].IsRegular();
    std::printf("%-24s %-7s %7d %5.0f%% %9.1f %9.1f %7.2f %9.2f %9.2f %9.2f %8lld %8.0f\n", model.name.c_str(),
                std::is_same_v<Real, float> ? "float" : "double", numFaces,
                100.0 * numRegular / static_cast<double>(evaluated.size()), 1e9 * times[0] / count,
                1e9 * times[1] / count, times[1] / times[0], 1e6 * bfrBuild / numFaces, 1e6 * firstBuild / numFaces,
                1e6 * secondBuild / numFaces, static_cast<long long>(stats.faceClasses),
                static_cast<double>(stats.bytes) / static_cast<double>(stats.builtFaces));
    if (sink == Real(12345.678)) std::printf("\n");
}

int run(std::string const& extraModels, double seconds) {
    std::printf("%-24s %-7s %7s %6s %9s %9s %7s %9s %9s %9s %8s %8s\n", "", "", "", "regu-", "Bfr ns", "ours ns",
                "", "Bfr us", "ours us", "moved us", "neigh-", "bytes");
    std::printf("%-24s %-7s %7s %6s %9s %9s %7s %9s %9s %9s %8s %8s\n", "mesh", "", "faces", "lar", "/point",
                "/point", "ratio", "/face", "/face", "/face", "bours", "/face");
    Model const torus = plainTorus(60, 40), creased = CreasedTorus(48, 24), spot = ReadSpot(extraModels);
    for (Model const* model : {&torus, &creased, &spot}) {
        measure<float>(*model, false, seconds);
        measure<double>(*model, false, seconds);
        if (model == &spot) continue;
        Model triangles = Triangulated(*model);
        triangles.name = model->name + " Loop";
        measure<float>(triangles, true, seconds);
        measure<double>(triangles, true, seconds);
    }
    std::printf("Goals: a regular face at most 1.3 times Bfr's P, du and dv; the whole at most 2.5 times.\n");
    return 0;
}

}  // namespace
}  // namespace perf

int main(int argc, char** argv) {
    try {
        std::string extraModels = OSD_SHADING_EXTRA_MODELS;
        double seconds = 1;
        for (int i = 1; i < argc; ++i) {
            if (std::strcmp(argv[i], "--quick") == 0) {
                seconds = 0.2;
            } else if (std::strcmp(argv[i], "--extra-models") == 0 && i + 1 < argc) {
                extraModels = argv[++i];
            } else {
                std::fprintf(stderr, "usage: osd_shading_surface_perf [--quick] [--extra-models FOLDER]\n");
                return 2;
            }
        }
        return perf::run(extraModels, seconds);
    } catch (std::exception const& error) {
        std::fprintf(stderr, "osd_shading_surface_perf: %s\n", error.what());
        return 1;
    }
}
