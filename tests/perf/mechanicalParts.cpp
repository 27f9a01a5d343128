// SPDX-License-Identifier: Apache-2.0
#include "mechanicalParts.h"

#include <array>
#include <cmath>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "extrudedSolid.h"
#include "osd_shading/io/creaseEdits.h"

namespace perf {

using osd_shading::io::Model;
using Point = ExtrudedSolid::Point;

namespace {

/// Chooses the points in the rectangle from (x0, y0) to (x1, y1).
auto inRectangle(double x0, double y0, double x1, double y1) {
    return [=](Point const& p) { return p[0] > x0 && p[0] < x1 && p[1] > y0 && p[1] < y1; };
}

}  // namespace

Model FanDisk() {
    constexpr int kNumX = 22, kNumY = 12, kPlate = 2;
    ExtrudedSolid solid;
    for (int i = 0; i <= kNumX; ++i) {
        for (int j = 0; j <= kNumY; ++j) solid.AddPoint(i, j);
    }
    solid.AddGrid(kNumX, kNumY, kPlate, [](int i, int j) { return i * (kNumY + 1) + j; });

    // The hub and the rim are thicker than the plate, and a part of the rim is cut away.
    solid.SetLayers(inRectangle(0, 0, kNumX, 3), 0, kPlate + 2);
    solid.SetLayers(inRectangle(0, 10, kNumX, kNumY), 0, kPlate + 1);
    solid.SetLayers(inRectangle(15, 10, kNumX, kNumY), 0, 1);
    // A round boss and a bolt hole in the plate.
    auto const boss = inRectangle(4, 5, 7, 8);
    solid.InsertRing(boss, 0.75);
    solid.InsertRing(boss, 0.75);
    solid.SetLayers(inRectangle(4.3, 5.3, 6.7, 7.7), 0, kPlate + 1);
    solid.InsertRing(inRectangle(13, 5, 15, 7), 0.7);
    solid.SetLayers(inRectangle(13.3, 5.3, 14.7, 6.7), 0, 0);

    Model model = solid.Surface([](Point const& p, int layer) -> std::array<double, 3> {
        double const radius = 8 + p[1], angle = -0.09 * p[0];
        return {radius * std::cos(angle), radius * std::sin(angle), layer + 0.01 * radius * radius};
    });
    model.name = "fandisk";
    osd_shading::io::AddCreasesByAngle(model, 40);
    model.creaseSharpness.assign(model.creaseSharpness.size(), 4.0f);
    return model;
}

Model RockerArm() {
    constexpr int kWidth = 6, kLength = 12, kHeight = 4;
    ExtrudedSolid solid;
    double const turn = 2 * std::acos(-1.0);
    // A ring of `numRadial` columns; its points are numbered outwards, then round, from where the arm is attached.
    auto const addRing = [&](double x, double radius, double hole, int around, int numRadial, double start) {
        int const first = static_cast<int>(solid.points.size());
        for (int i = 0; i < around; ++i) {
            double const angle = start + turn * i / around;
            for (int j = 0; j <= numRadial; ++j) {
                double const r = hole + (radius - hole) * j / numRadial;
                solid.AddPoint(x + r * std::cos(angle), r * std::sin(angle));
            }
        }
        auto const corner = [=](int i, int j) { return first + (i % around) * (numRadial + 1) + j; };
        // Outwards first: counter-clockwise.
        solid.AddGrid(numRadial, around, kHeight, [=](int j, int i) { return corner(i, j); });
        return corner;
    };
    constexpr int kBigAround = 32, kSmallAround = 24, kNumRadial = 3;
    constexpr double kBigX = -14, kSmallX = 12;
    auto const big = addRing(kBigX, 7, 3.5, kBigAround, kNumRadial, -turn * kWidth / (2 * kBigAround));
    auto const small =
        addRing(kSmallX, 5, 2, kSmallAround, kNumRadial, turn / 2 - turn * kWidth / (2 * kSmallAround));

    // The arm shares the points of both rings at its ends.
    std::vector<int> arm;
    for (int i = 0; i <= kLength; ++i) {
        for (int j = 0; j <= kWidth; ++j) {
            if (i == 0) {
                arm.push_back(big(j, kNumRadial));
            } else if (i == kLength) {
                arm.push_back(small(kWidth - j, kNumRadial));
            } else {
                auto const& from = solid.points[static_cast<std::size_t>(big(j, kNumRadial))];
                auto const& to = solid.points[static_cast<std::size_t>(small(kWidth - j, kNumRadial))];
                double const t = static_cast<double>(i) / kLength;
                arm.push_back(solid.AddPoint(from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1])));
            }
        }
    }
    std::size_t const firstOfArm = solid.columns.size();
    solid.AddGrid(kLength, kWidth, kHeight,
                  [&](int i, int j) { return arm[static_cast<std::size_t>(i * (kWidth + 1) + j)]; });
    auto const armColumns = [&](int i0, int j0, int i1, int j1) {
        std::set<std::pair<double, double>> middles;
        for (int i = i0; i < i1; ++i) {
            for (int j = j0; j < j1; ++j) {
                Point const middle =
                    solid.Middle(solid.columns[firstOfArm + static_cast<std::size_t>(i * kWidth + j)]);
                middles.insert({middle[0], middle[1]});
            }
        }
        return [middles](Point const& p) { return middles.count({p[0], p[1]}) != 0; };
    };

    // A pad above and below, and the hole of the adjusting screw.
    solid.SetLayers(armColumns(7, 2, 10, 4), -1, kHeight + 1);
    solid.InsertRing(armColumns(3, 2, 5, 4), 0.7);
    solid.SetLayers(armColumns(3, 2, 5, 4), 0, 0);

    Model model = solid.Surface([](Point const& p, int layer) -> std::array<double, 3> {
        return {p[0], p[1], 1.2 * layer - 0.01 * p[0] * p[0]};
    });
    model.name = "rockerarm";
    return model;
}

Model WithRandomSharpness(Model model, std::uint32_t seed) {
    std::set<std::pair<int, int>> edges;
    std::size_t first = 0;
    for (int const size : model.faceSizes) {
        auto const count = static_cast<std::size_t>(size);
        for (std::size_t i = 0; i < count; ++i) {
            edges.insert(std::minmax({model.faceVertices[first + i], model.faceVertices[first + (i + 1) % count]}));
        }
        first += count;
    }
    model.creaseVertices.clear();
    model.creaseSharpness.clear();
    std::mt19937 random(seed);
    // Not std::uniform_real_distribution, whose numbers differ between libraries.
    auto const uniform = [&] { return static_cast<double>(random()) / 4294967296.0; };
    for (auto const& [a, b] : edges) {
        if (uniform() >= 0.1) continue;
        model.creaseVertices.insert(model.creaseVertices.end(), {a, b});
        model.creaseSharpness.push_back(static_cast<float>(5 * uniform()));
    }
    model.name += " with random sharpness";
    return model;
}

}  // namespace perf
