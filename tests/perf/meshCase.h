// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "movingMesh.h"
#include "osd_shading/shadingTable.h"

namespace perf {

/// Seconds per frame on one mesh at one level, by thread time where nothing else is said; 0: not measured.
struct CaseFigures {
    std::string mesh;
    bool isLoop = false;
    int level = 0;

    std::size_t openSubdivVertices = 0;
    std::array<double, 3> openSubdivLimits{};   ///< by form: P, du, dv
    std::array<double, 3> openSubdivNormals{};  ///< by form: with cross products and normalising
    std::array<double, 3> openSubdivTwice{};    ///< by form: the naive way to shade
    double openSubdivBytes = 0;                 ///< of the table, per vertex
    double openSubdivBuild = 0;

    osd_shading::ShadingTableStats table;  ///< of the table for Shaded and LimitNormals
    double build = 0;
    double shaded = 0, shadedAvx2 = 0, shadedSse2 = 0;
    double limitNormals = 0;                         ///< P and N_L
    double smooth = 0;                               ///< P and N_S, variant D
    double memsetOutput = 0;                         ///< writing as many bytes as a frame
    double wallOneThread = 0, wallTwoThreads = 0;    ///< shaded, wall time
    double memsetTwoThreads = 0, memsetOneWall = 0;  ///< wall time

    /// The yardstick: the fastest form, P, du and dv alone.
    double OpenSubdiv() const { return fastest(openSubdivLimits); }
    double OpenSubdivWithNormals() const { return fastest(openSubdivNormals); }
    double OpenSubdivTwice() const { return fastest(openSubdivTwice); }
    double BytesPerValue() const { return static_cast<double>(table.bytes) / static_cast<double>(table.values); }
    double SupportShare() const {
        return static_cast<double>(table.blendedValues) / static_cast<double>(table.values);
    }
    std::string Name() const { return mesh + (isLoop ? " Loop" : "") + " level " + std::to_string(level); }

private:
    static double fastest(std::array<double, 3> const& seconds) {
        return *std::min_element(seconds.begin(), seconds.end());
    }
};

/// How thoroughly a case is measured.
struct CaseEffort {
    double seconds = 2;          ///< of all frames together, about
    bool comparesBuild = true;   ///< several builds of our table
    bool usesTwoThreads = true;  ///< frames by wall time, and a memset's
};

/// Measures all of it, the contenders in turns; nullopt where memory won't do.
std::optional<CaseFigures> MeasureCase(MovingMesh& mesh, int level, CaseEffort const& effort);

}  // namespace perf
