// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "osd_shading/shadingEvaluator.h"
#include "osd_shading/tables/exactNormals.h"
#include "osd_shading/tables/startFrame.h"

namespace osd_shading {
inline namespace v1 {
namespace tables {

/// How a class's u and v lie in the tile: du = a du' + b dv', dv = c du' + d dv'.
struct Frame2 {
    float a = 1, b = 0, c = 0, d = 1;

    Frame2 operator*(Frame2 const& o) const {
        return {a * o.a + b * o.c, a * o.b + b * o.d, c * o.a + d * o.c, c * o.b + d * o.d};
    }
};

/// The seven outputs of a leaf, or of everything.
enum OutputKind { kPositions, kBlended, kLimit, kSubdivided, kDu, kDv, kNumVectors };

/// Frames of a table's tiles: start normals, then tile after tile, leaf after leaf. What ShadingEvaluator does, but
/// for its checks.
struct TileFrames {
    /// What one thread works with.
    struct Worker {
        std::vector<float> memory;  // field arrays of a leaf, aligned by hand
        FieldArrays position{}, tangent1{}, tangent2{}, subdivided{};
        std::vector<LocalPoint> local;
        std::vector<std::uint16_t> doubtful;
        std::array<std::vector<float>, kNumVectors> ordered;  // of a leaf whose values go elsewhere
        std::int64_t numFallbacks = 0;
    };

    /// A tile on its way through its class.
    struct Visit {
        PointView<float> controlPoints;
        Worker* worker = nullptr;
        int tile = 0, value = 0;
        bool hasNormals = false;
        bool isMarking = false;  // points stand for whether they depend on a number that is not finite
        LeafBlend const* leafBlend = nullptr;  // null: the same for all leaves
        LeafBlend blend = LeafBlend::Zero;
        std::size_t weight = 0;  // of the next mixed leaf
    };

    /// A class with its sources in place.
    struct Place {
        LocalPoint *points = nullptr, *normals = nullptr, *free = nullptr;
        float origin[3] = {0, 0, 0};
        Frame2 frame;
    };

    /// What a leaf reads: control points and normals of a spline, the columns of a matrix.
    struct LeafSources {
        std::uint16_t const *points, *normals;
    };

    TileFrames(std::shared_ptr<TableData const> tableData, PatchKernels const* patchKernels,
               std::shared_ptr<FrameThreads> frameThreads);

    FrameReport evaluate(PointView<float> controlPoints, PointView<float> userNormals,
                         ShadingOutputs const& outputs);
    void evaluateTile(int tile, Visit& visit);
    void startVisit(Tile const& tile, Visit& visit) const;
    void evaluateClass(int tileClass, Place const& place, Visit& visit);
    void evaluateSplit(TileClass const& tileClass, Place const& place, Visit& visit);
    void evaluateDense(TileClass const& tileClass, Place const& place, LeafSources const& sources, Visit& visit);
    void evaluateSpline(TileClass const& tileClass, Place const& place, LeafSources const& sources, Visit& visit);
    void finishLeaf(TileClass const& tileClass, int numPoints, float doubt1, float doubt2, Place const& place,
                    bool hasTangents, Visit& visit);
    void settle(LeafFrame& leaf, TileClass const& tileClass, Place const& place, int firstValue, Visit& visit);
    void replaceVanished(LeafFrame const& leaf, TileClass const& tileClass, Place const& place, int firstValue,
                         Visit& visit);
    /// N_L in double precision, and whether it is an average, which no tangents make.
    Vec3<double> exactLimit(TileClass const& tileClass, Place const& place, int firstValue, int point, Visit& visit,
                            bool& isAverage);
    void spoil(int numPoints, std::size_t value, std::size_t weight, bool hasTangents, LeafBlend blend,
               Worker const& worker) const;
    /// Whether a leaf's tangents are needed; where b varies N_S is finished along with N_L.
    bool needsTangentsOf(LeafBlend blend) const {
        if (needsLimits) return true;
        return blend == LeafBlend::Mixed ? needsSubdivided : blend == LeafBlend::Zero && needsBlended;
    }
    LeafBlend blendOfLeaf(Visit const& visit) const { return visit.leafBlend ? *visit.leafBlend : visit.blend; }

    std::shared_ptr<TableData const> data;
    PatchKernels const* kernels;
    std::shared_ptr<FrameThreads> threads;
    StartFrame startFrame;
    std::unique_ptr<TileFrames> limitStart;
    std::vector<LocalPoint> startNormals, smoothed;
    std::vector<int> chunkTiles;
    std::vector<Worker> workers;
    std::unique_ptr<ExactNormals> exactNormals;

    // Of the frame.
    std::array<PointSpan, kNumVectors> vectors;
    NumberSpan numbers;
    bool needsLimits = false, needsTangents = false, needsSubdivided = false, needsBlended = false;
};

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
