// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/shadingEvaluator.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "osd_shading/blendedNormals.h"
#include "osd_shading/faceNormals.h"
#include "osd_shading/tables/exactNormals.h"
#include "osd_shading/tables/startFrame.h"

namespace osd_shading {
inline namespace v1 {

namespace {

using namespace tables;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// Points that a thread takes at a time.
constexpr int kChunkPoints = 8192;

/// A tangent that reaches less across the other, as a share of what it is summed from, has lost too many digits for
/// a normal exact to 1e-5. A matrix sums some twenty products whose errors seldom add up; a spline's differences
/// lose little.
constexpr float kDenseDoubt = 1.0f / 256, kSplineDoubt = 1.0f / 64;

void checkSpan(char const* name, float const* data, std::size_t count, std::size_t stride, std::size_t width,
               std::size_t wanted) {
    if (data == nullptr && count == 0) return;
    auto const what = [&] { return std::string(name); };  // made where it is thrown: a frame allocates nothing
    if (count != wanted) {
        throw InvalidOptions(what() + " has room for " + std::to_string(count) + " elements; the table has " +
                             std::to_string(wanted) + " values");
    }
    if (data == nullptr && count > 0) throw InvalidOptions(what() + ": its pointer is null");
    if (stride < width) {
        throw InvalidOptions(what() + ": its stride is " + std::to_string(stride) + "; give " +
                             std::to_string(width) + " or more");
    }
}

void checkView(char const* name, PointView<float> const& view, std::size_t wanted, char const* element) {
    std::string const what = name;
    if (view.size() != wanted) {
        throw InvalidOptions(what + " has " + std::to_string(view.size()) + " elements; the table needs " +
                             std::to_string(wanted) + ", one per " + element);
    }
    if (view.size() > 0 && view.data() == nullptr) throw InvalidOptions(what + ": its pointer is null");
    if (view.stride() < 3) {
        throw InvalidOptions(what + ": its stride is " + std::to_string(view.stride()) + "; give 3 or more");
    }
}

/// How a class's u and v lie in the tile: du = a du' + b dv', dv = c du' + d dv'.
struct Frame2 {
    float a = 1, b = 0, c = 0, d = 1;

    Frame2 operator*(Frame2 const& o) const {
        return {a * o.a + b * o.c, a * o.b + b * o.d, c * o.a + d * o.c, c * o.b + d * o.d};
    }
};

Frame2 frameOfRotation(int rotation, bool isTriangle) {
    if (rotation == 0) return {};
    if (isTriangle) return rotation == 1 ? Frame2{0, -1, 1, -1} : Frame2{-1, 1, -1, 0};
    return rotation == 1 ? Frame2{0, -1, 1, 0} : rotation == 2 ? Frame2{-1, 0, 0, -1} : Frame2{0, 1, -1, 0};
}

/// The seven outputs of a leaf, or of everything.
enum OutputKind { kPositions, kBlended, kLimit, kSubdivided, kDu, kDv, kNumVectors };

}  // namespace

struct ShadingEvaluator::Impl {
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

    Impl(std::shared_ptr<TableData const> tableData, PatchKernels const* patchKernels,
         std::shared_ptr<FrameThreads> frameThreads)
        : data(std::move(tableData)),
          kernels(patchKernels),
          threads(std::move(frameThreads)),
          startFrame(*data),
          exactNormals(std::make_unique<ExactNormals>(*data)) {
        StartProgram const& start = data->start;
        startNormals.resize(index(start.numNormals), LocalPoint{{0, 0, 0, 0}});
        if (start.limitTable) limitStart = std::make_unique<Impl>(start.limitTable, kernels, threads);
        smoothed.resize(start.smoothed.size());

        // Whole tiles, some thousand points a chunk.
        int points = kChunkPoints;
        for (std::size_t tile = 0; tile < data->tiles.size(); ++tile) {
            if (points >= kChunkPoints) {
                chunkTiles.push_back(static_cast<int>(tile));
                points = 0;
            }
            points += data->dictionary.classes[index(data->tiles[tile].tileClass)].numPoints;
        }
        chunkTiles.push_back(static_cast<int>(data->tiles.size()));

        workers.resize(index(threads->NumThreads()));
        for (Worker& worker : workers) {
            constexpr std::size_t kNumArrays = 12, kPitch = (kLeafCapacity + 15) / 16 * 16;
            worker.memory.assign(kNumArrays * kPitch + 16, 0.0f);
            auto const address = reinterpret_cast<std::uintptr_t>(worker.memory.data());
            float* next = worker.memory.data() + (64 - address % 64) % 64 / sizeof(float);
            auto const take = [&] {
                float* const array = next;
                next += kPitch;
                return array;
            };
            for (FieldArrays* field : {&worker.position, &worker.tangent1, &worker.tangent2, &worker.subdivided}) {
                field->x = take();
                field->y = take();
                field->z = take();
            }
            worker.local.resize(data->numLocalPoints);
            worker.doubtful.resize(kLeafCapacity);
            if (!data->orderOfValues.empty()) {
                for (auto& ordered : worker.ordered) ordered.resize(std::size_t{3} * kLeafCapacity);
            }
        }
    }

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
    std::unique_ptr<Impl> limitStart;
    std::vector<LocalPoint> startNormals, smoothed;
    std::vector<int> chunkTiles;
    std::vector<Worker> workers;
    std::unique_ptr<ExactNormals> exactNormals;

    // Of the frame.
    std::array<PointSpan, kNumVectors> vectors;
    NumberSpan numbers;
    bool needsLimits = false, needsTangents = false, needsSubdivided = false, needsBlended = false;
};

FrameReport ShadingEvaluator::Impl::evaluate(PointView<float> controlPoints, PointView<float> userNormals,
                                             ShadingOutputs const& outputs) {
    vectors = {outputs.positions,    outputs.blendedNormals,
               outputs.limitNormals, outputs.subdividedNormals,
               outputs.du,           outputs.dv};
    numbers = outputs.blendWeights;
    auto const isWanted = [&](OutputKind kind) { return vectors[kind].data != nullptr; };
    needsBlended = isWanted(kBlended);
    needsSubdivided = needsBlended || isWanted(kSubdivided);
    needsTangents = isWanted(kDu) || isWanted(kDv);
    needsLimits = needsTangents || isWanted(kLimit);  // also where b is 1

    // Start normals.
    FrameReport report;
    StartProgram const& start = data->start;
    if (needsSubdivided && start.numNormals > 0) {
        if (limitStart) {
            ShadingOutputs own;
            own.limitNormals = {startNormals[0].v, startNormals.size(), 4};
            limitStart->evaluate(controlPoints, {}, own);
            for (std::size_t i = 0; i < start.smoothed.size(); ++i) {
                Vec3<float> sum{};
                for (auto t = start.smoothOffsets[i]; t < start.smoothOffsets[i + 1]; ++t) {
                    float const* const n = startNormals[index(start.smoothSources[t])].v;
                    sum += start.smoothWeights[t] * Vec3<float>{n[0], n[1], n[2]};
                }
                Vec3<float> const normal = NormalizedSum(sum, 1.0f);
                smoothed[i] = {{normal.x, normal.y, normal.z, 0}};
            }
            for (std::size_t i = 0; i < smoothed.size(); ++i) startNormals[index(start.smoothed[i])] = smoothed[i];
            for (LocalPoint const& n : startNormals) {
                report.zeroStartNormals += n.v[0] == 0 && n.v[1] == 0 && n.v[2] == 0;
            }
        } else {
            report.zeroStartNormals = startFrame.Compute(controlPoints, userNormals, *threads, startNormals);
        }
    }

    // Tiles.
    for (Worker& worker : workers) worker.numFallbacks = 0;
    threads->Run(static_cast<int>(chunkTiles.size()) - 1, [&](int chunk, int thread) {
        Visit visit;
        visit.controlPoints = controlPoints;
        visit.worker = &workers[index(thread)];
        for (int tile = chunkTiles[index(chunk)]; tile < chunkTiles[index(chunk) + 1]; ++tile) {
            evaluateTile(tile, visit);
        }
    });
    for (Worker const& worker : workers) report.fallbackNormals += worker.numFallbacks;
    return report;
}

void ShadingEvaluator::Impl::evaluateTile(int tileIndex, Visit& visit) {
    Tile const& tile = data->tiles[index(tileIndex)];
    TileClass const& tileClass = data->dictionary.classes[index(tile.tileClass)];
    if (tileClass.numPoints == 0) return;
    visit.tile = tileIndex;
    startVisit(tile, visit);

    Place place;
    place.points = visit.worker->local.data();
    int const* const vertices = data->vertices.data() + tile.firstVertex;
    // Relative to their middle, so that a tile keeps its digits wherever it lies.
    float const* const control = visit.controlPoints.data();
    std::size_t const stride = visit.controlPoints.stride();
    LocalPoint sum{{0, 0, 0, 0}};
    for (int i = 0; i < tileClass.numSources; ++i) {
        float const* const p = control + index(vertices[i]) * stride;
        place.points[i] = {{p[0], p[1], p[2], 0}};
        sum = sum + place.points[i];
    }
    auto const isFinite = [](LocalPoint const& p) {
        return std::isfinite(p.v[0]) && std::isfinite(p.v[1]) && std::isfinite(p.v[2]);
    };
    bool const isClean = isFinite(sum);
    LocalPoint origin{{0, 0, 0, 0}};
    for (int axis = 0; axis < 3; ++axis) {
        origin.v[axis] = sum.v[axis] / static_cast<float>(tileClass.numSources);
        if (!isClean) origin.v[axis] = 0;
        place.origin[axis] = origin.v[axis];
    }
    for (int i = 0; i < tileClass.numSources; ++i) {
        place.points[i] =
            isClean || isFinite(place.points[i]) ? place.points[i] - origin : LocalPoint{{0, 0, 0, 0}};
    }
    place.normals = place.points + tileClass.numSources + tileClass.pointRows.NumRows();
    place.free = place.normals;
    if (visit.hasNormals) {
        int const* const normals = data->normals.data() + tile.firstNormal;
        for (int i = 0; i < tileClass.numNormalSources; ++i) place.normals[i] = startNormals[index(normals[i])];
        place.free += tileClass.numNormalSources + tileClass.normalRows.NumRows();
    }
    if (!tileClass.isNgon) place.frame = frameOfRotation(tile.rotation, tileClass.size == 3);
    evaluateClass(tile.tileClass, place, visit);
    if (isClean) return;

    // Once more with marks in place of points: what a number that is not finite has a weight in is no number
    // either. (A weight of zero would have made one of it.)
    for (int i = 0; i < tileClass.numSources; ++i) {
        float const* const p = control + index(vertices[i]) * stride;
        bool const isBad = !isFinite({{p[0], p[1], p[2], 0}});
        place.points[i] = {{isBad ? 1 + static_cast<float>(i) / 64 : 0, 0, 0, 0}};
    }
    startVisit(tile, visit);
    visit.hasNormals = false;
    visit.isMarking = true;
    evaluateClass(tile.tileClass, place, visit);
    visit.isMarking = false;
}

void ShadingEvaluator::Impl::startVisit(Tile const& tile, Visit& visit) const {
    visit.value = tile.firstValue;
    visit.hasNormals = needsSubdivided && tile.pattern != kZeroEverywhere;
    visit.leafBlend = nullptr;
    visit.blend = tile.pattern == kOneEverywhere ? LeafBlend::One : LeafBlend::Zero;
    if (tile.pattern < 0) return;
    BlendPattern const& pattern = data->patterns[index(tile.pattern)];
    visit.leafBlend = data->leafBlends.data() + pattern.firstLeaf;
    visit.weight = pattern.firstWeight;
}

void ShadingEvaluator::Impl::evaluateClass(int classIndex, Place const& place, Visit& visit) {
    TileClass const& c = data->dictionary.classes[index(classIndex)];
    auto const applyRows = [&](LocalRows const& rows, LocalPoint* points, int numSources) {
        if (rows.NumRows() == 0) return;
        kernels->combine(rows.NumRows(), rows.offsets.data(), rows.sources.data(), rows.weights.data(), points,
                         points + numSources);
    };
    applyRows(c.pointRows, place.points, c.numSources);
    if (visit.hasNormals) applyRows(c.normalRows, place.normals, c.numNormalSources);
    LeafSources const sources{c.pointIndices.data(), c.normalIndices.data()};
    switch (c.kind) {
        case TileKind::Split:
            evaluateSplit(c, place, visit);
            break;
        case TileKind::Dense:
            evaluateDense(c, place, sources, visit);
            break;
        case TileKind::Spline:
            evaluateSpline(c, place, sources, visit);
            break;
    }
}

void ShadingEvaluator::Impl::evaluateSplit(TileClass const& c, Place const& place, Visit& visit) {
    bool const isTriangle = c.size == 3 && !c.isNgon;
    for (std::size_t i = 0; i < c.children.size(); ++i) {
        ChildTile const& child = c.children[i];
        TileClass const& childClass = data->dictionary.classes[index(child.tileClass)];
        if (childClass.numPoints == 0) {
            // Others write all of it.
            if (visit.leafBlend) visit.leafBlend += childClass.numLeaves;
            continue;
        }
        Place inner = place;
        if (needsTangents) {
            inner.frame = frameOfRotation(child.rotation, isTriangle);
            if (!c.isNgon) {
                float const scale = isTriangle && i == 3 ? -2.0f : 2.0f;
                inner.frame = place.frame * Frame2{scale, 0, 0, scale} * inner.frame;
            }
        }
        if (child.isInPlace) {
            LeafSources const sources{child.pointIndices.data(), child.normalIndices.data()};
            if (childClass.kind == TileKind::Dense) {
                evaluateDense(childClass, inner, sources, visit);
            } else {
                evaluateSpline(childClass, inner, sources, visit);
            }
            continue;
        }

        // Relative to their own middle again; its origin is a float, what that leaves over goes to the points.
        inner.points = place.free;
        LocalPoint sum{{0, 0, 0, 0}};
        for (auto const j : child.pointIndices) sum = sum + place.points[j];
        LocalPoint shift{{0, 0, 0, 0}};
        for (int axis = 0; axis < 3; ++axis) {
            float const middle = sum.v[axis] / static_cast<float>(child.pointIndices.size());
            double const exact = double{place.origin[axis]} + double{middle};
            inner.origin[axis] = static_cast<float>(exact);
            shift.v[axis] = middle - static_cast<float>(exact - double{inner.origin[axis]});
        }
        if (visit.isMarking) shift = {{0, 0, 0, 0}};
        for (std::size_t j = 0; j < child.pointIndices.size(); ++j) {
            inner.points[j] = place.points[child.pointIndices[j]] - shift;
        }
        inner.normals = inner.points + childClass.numSources + childClass.pointRows.NumRows();
        inner.free = inner.normals;
        if (visit.hasNormals) {
            for (std::size_t j = 0; j < child.normalIndices.size(); ++j) {
                inner.normals[j] = place.normals[child.normalIndices[j]];
            }
            inner.free += childClass.numNormalSources + childClass.normalRows.NumRows();
        }
        evaluateClass(child.tileClass, inner, visit);
    }
}

void ShadingEvaluator::Impl::evaluateDense(TileClass const& c, Place const& place, LeafSources const& sources,
                                           Visit& visit) {
    TileDictionary const& dictionary = data->dictionary;
    Worker& worker = *visit.worker;
    LeafBlend const blend = blendOfLeaf(visit);
    bool const hasTangents = needsTangentsOf(blend);
    bool const hasNormals = visit.hasNormals && blend != LeafBlend::Zero;
    DenseMatrix const& matrix = dictionary.matrices[index(c.frameMatrix)];
    FieldArrays const fields[3] = {worker.position, worker.tangent1, worker.tangent2};
    if (hasNormals && c.normalMatrix == c.frameMatrix) {
        kernels->evaluateDenseWithNormals(matrix, place.points, sources.points, place.normals, sources.normals,
                                          fields, worker.subdivided);
    } else {
        kernels->evaluateDense(matrix, place.points, sources.points, fields);
        if (hasNormals) {
            kernels->evaluateDense(dictionary.matrices[index(c.normalMatrix)], place.normals, sources.normals,
                                   &worker.subdivided);
        }
    }
    float size = 0;
    if (hasTangents) {
        LocalPoint const& first = place.points[sources.points[0]];
        LocalPoint reach{{0, 0, 0, 0}};
        for (int i = 1; i < matrix.numColumns; ++i) {
            reach = LargerOf(reach, place.points[sources.points[i]] - first);
        }
        size = LengthBound(reach) * kDenseDoubt;
    }
    finishLeaf(c, c.numPoints, c.tangentSums[0] * size, c.tangentSums[1] * size, place, hasTangents, visit);
}

void ShadingEvaluator::Impl::evaluateSpline(TileClass const& c, Place const& place, LeafSources const& sources,
                                            Visit& visit) {
    TileDictionary const& dictionary = data->dictionary;
    Worker& worker = *visit.worker;

    // How long its tangents should be, by the inner rows and columns of control points.
    LocalPoint reachU{{0, 0, 0, 0}}, reachV{{0, 0, 0, 0}};
    auto const at = [&](int row, int column) -> LocalPoint const& {
        return place.points[sources.points[4 * row + column]];
    };
    for (int i = 1; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            reachU = LargerOf(reachU, at(i, j + 1) - at(i, j));
            reachV = LargerOf(reachV, at(j + 1, i) - at(j, i));
        }
    }
    float const doubtU = LengthBound(reachU) * kSplineDoubt, doubtV = LengthBound(reachV) * kSplineDoubt;

    // Window by window.
    bool const isRefined = !dictionary.bases.positions.empty();
    auto const& limits = dictionary.bases.limits[c.k];
    auto const& positions = isRefined ? dictionary.bases.positions[c.k] : limits;
    int const numWindows = NumWindows(c.k), normalPitch = (1 << c.numNormalLevels) + 3;
    for (int window = 0; window < numWindows * numWindows; ++window) {
        RowPlan const& plan = dictionary.plans[index(c.plans[index(window)])];
        LeafBlend const blend = blendOfLeaf(visit);
        bool const hasTangents = needsTangentsOf(blend);
        bool const hasNormals = visit.hasNormals && blend != LeafBlend::Zero;
        auto const row = index(window / numWindows), column = index(window % numWindows);
        if (plan.numPoints > 0) {
            if (hasTangents) {
                kernels->evaluateSplineFrame(limits[column], limits[row], plan, place.points, sources.points,
                                             worker.position, worker.tangent1, worker.tangent2);
            }
            if (isRefined || !hasTangents) {
                kernels->evaluateSpline(positions[column], positions[row], plan, place.points, sources.points,
                                        worker.position);
            }
            if (hasNormals && c.numNormalLevels == 0) {
                kernels->evaluateSpline(limits[column], limits[row], plan, place.normals, sources.normals,
                                        worker.subdivided);
            } else if (hasNormals) {
                int firstColumn = 0, firstRow = 0;
                SplineBasis const& u =
                    dictionary.bases.ForNormals(c.k, c.numNormalLevels, static_cast<int>(column), firstColumn);
                SplineBasis const& v =
                    dictionary.bases.ForNormals(c.k, c.numNormalLevels, static_cast<int>(row), firstRow);
                std::uint16_t indices[(kLeafSide + 3) * (kLeafSide + 3)];
                int const side = u.gridSize + 3;
                for (int i = 0; i < side; ++i) {
                    std::copy_n(sources.normals + (firstRow + i) * normalPitch + firstColumn, side,
                                indices + i * side);
                }
                kernels->evaluateSpline(u, v, plan, place.normals, indices, worker.subdivided);
            }
        }
        finishLeaf(c, plan.numPoints, doubtU, doubtV, place, hasTangents, visit);
    }
}

void ShadingEvaluator::Impl::finishLeaf(TileClass const& tileClass, int numPoints, float doubt1, float doubt2,
                                        Place const& place, bool hasTangents, Visit& visit) {
    Worker& worker = *visit.worker;
    LeafBlend const blend = blendOfLeaf(visit);
    std::size_t const value = index(visit.value), weight = visit.weight;
    bool const isOrdered = !data->orderOfValues.empty();
    visit.value += numPoints;
    if (visit.leafBlend) ++visit.leafBlend;
    if (blend == LeafBlend::Mixed) visit.weight += index(numPoints);
    if (numPoints == 0) return;
    if (visit.isMarking) {
        spoil(numPoints, value, weight, hasTangents, blend, worker);
        return;
    }

    LeafFrame leaf{};
    leaf.numPoints = numPoints;
    for (int axis = 0; axis < 3; ++axis) leaf.origin[axis] = place.origin[axis];
    leaf.position = worker.position;
    if (hasTangents) {
        leaf.tangent1 = worker.tangent1;
        leaf.tangent2 = worker.tangent2;
    }
    leaf.doubt1 = doubt1;
    leaf.doubt2 = doubt2;
    if (visit.hasNormals && blend != LeafBlend::Zero) leaf.subdivided = worker.subdivided;
    if (blend == LeafBlend::Mixed) leaf.blend = data->blendPowers.data() + weight;
    LeafFrame::Output* const targets[kNumVectors] = {&leaf.positions,    &leaf.blendedNormals,
                                                     &leaf.limitNormals, &leaf.subdividedNormals,
                                                     &leaf.tangents1,    &leaf.tangents2};
    for (std::size_t kind = 0; kind < kNumVectors; ++kind) {
        if (vectors[kind].data == nullptr) continue;
        if (isOrdered) {
            *targets[kind] = {worker.ordered[kind].data(), 3};
        } else {
            *targets[kind] = {vectors[kind].data + value * vectors[kind].stride, vectors[kind].stride};
        }
    }
    leaf.doubtful = worker.doubtful.data();
    LeafFrame::Output const du = std::exchange(leaf.tangents1, {}), dv = std::exchange(leaf.tangents2, {});
    if (blend == LeafBlend::One && hasTangents && leaf.subdivided.x != nullptr) {
        // N_B is N_S alone: the same bits as where no N_L is asked for.
        LeafFrame alone = leaf;
        alone.positions = alone.limitNormals = {};
        alone.tangent1 = alone.tangent2 = {};
        kernels->finish(alone);
        replaceVanished(alone, tileClass, place, static_cast<int>(value), visit);
        leaf.blendedNormals = leaf.subdividedNormals = {};
        leaf.subdivided = {};
    }
    kernels->finish(leaf);
    if (!hasTangents) replaceVanished(leaf, tileClass, place, static_cast<int>(value), visit);
    if (blend == LeafBlend::One && visit.hasNormals) leaf.subdivided = worker.subdivided;  // may stand in for N_L
    if (!hasTangents && blend == LeafBlend::Zero && leaf.subdividedNormals.data != nullptr) {
        for (std::size_t i = 0; i < index(numPoints); ++i) {
            std::fill_n(leaf.subdividedNormals.data + i * leaf.subdividedNormals.stride, 3, 0.0f);
        }
    }
    if (needsTangents) {
        // As the tile sees them. N_L is made of those of the class, the same bits whether they are wanted or not.
        Frame2 const& f = place.frame;
        auto const turn = [&](LeafFrame::Output const& output, float ofU, float ofV) {
            if (output.data == nullptr) return;
            FieldArrays const &u = worker.tangent1, &v = worker.tangent2;
            for (std::size_t i = 0; i < index(numPoints); ++i) {
                float* const target = output.data + i * output.stride;
                target[0] = ofU * u.x[i] + ofV * v.x[i];
                target[1] = ofU * u.y[i] + ofV * v.y[i];
                target[2] = ofU * u.z[i] + ofV * v.z[i];
            }
        };
        turn(du, f.a, f.b);
        turn(dv, f.c, f.d);
    }
    if (hasTangents && leaf.numDoubtful > 0) settle(leaf, tileClass, place, static_cast<int>(value), visit);

    std::vector<float> const& weights = data->blendWeights.empty() ? data->blendPowers : data->blendWeights;
    if (numbers.data != nullptr) {
        for (std::size_t i = 0; i < index(numPoints); ++i) {
            std::size_t const target = isOrdered ? index(data->orderOfValues[value + i]) : value + i;
            numbers.data[target * numbers.stride] = blend == LeafBlend::Mixed ? weights[weight + i]
                                                    : blend == LeafBlend::One ? 1.0f
                                                                              : 0.0f;
        }
    }
    if (!isOrdered) return;
    for (std::size_t kind = 0; kind < kNumVectors; ++kind) {
        if (vectors[kind].data == nullptr) continue;
        float const* from = worker.ordered[kind].data();
        for (std::size_t i = 0; i < index(numPoints); ++i, from += 3) {
            std::copy_n(from, 3, vectors[kind].data + index(data->orderOfValues[value + i]) * vectors[kind].stride);
        }
    }
}

namespace {

/// The average of the unit normals of a value's faces, and whether `point` has one instead of tangents.
bool findAverage(AverageNormals const& averages, int point, LocalPoint const* points, Vec3<double>& normal) {
    auto const found =
        std::lower_bound(averages.normals.begin(), averages.normals.end(), point,
                         [](AverageNormal const& average, int wanted) { return average.point < wanted; });
    if (found == averages.normals.end() || found->point != point) return false;
    auto const pointOfRow = [&](int row) {
        Vec3<double> sum{};
        for (auto t = averages.offsets[index(row)]; t < averages.offsets[index(row) + 1]; ++t) {
            float const* const p = points[averages.sources[t]].v;
            sum += averages.weights[t] * Vec3<double>{double{p[0]}, double{p[1]}, double{p[2]}};
        }
        return sum;
    };
    auto const last = found + 1 == averages.normals.end() ? averages.faces.end()
                                                          : averages.faces.begin() + (found + 1)->firstFace;
    auto const first = averages.faces.begin() + found->firstFace;
    auto const sidesOf = [&](auto face) {
        Vec3<double> const p = pointOfRow(face->rows[face->corner]);
        return std::pair(pointOfRow(face->rows[(face->corner + 1) % face->size]) - p,
                         pointOfRow(face->rows[(face->corner + face->size - 1) % face->size]) - p);
    };
    double longest = 0;
    for (auto face = first; face != last && averages.weight == FaceWeight::CornerArea; ++face) {
        auto const [after, before] = sidesOf(face);
        longest = std::fmax(longest, std::fmax(Length(after), Length(before)));
    }
    NormalSum<double> sum;
    for (auto face = first; face != last; ++face) {
        Vec3<double> corners[4];
        for (int i = 0; i < face->size; ++i) corners[i] = pointOfRow(face->rows[i]);
        auto const [after, before] = sidesOf(face);
        double const weight =
            std::fmax(CornerWeight(averages.weight, after, before), LeastWeight(averages.weight, longest));
        sum.Add(UnitPolygonNormal<double>(face->size, [&](int i) { return corners[i]; }), weight);
    }
    // The points were rounded to float: what is left where normals cancel is no direction.
    normal = Length(sum.sum) > double{kVanishing<float>} * sum.added ? sum.Unit() : Vec3<double>{};
    return true;
}

}  // namespace

/// Overwrites what depends on a number that is not finite. Start normals leave out faces without a normal, so N_S
/// does not.
void ShadingEvaluator::Impl::spoil(int numPoints, std::size_t value, std::size_t weight, bool hasTangents,
                                   LeafBlend blend, Worker const& worker) const {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    for (std::size_t i = 0; i < index(numPoints); ++i) {
        std::size_t const target = data->orderOfValues.empty() ? value + i : index(data->orderOfValues[value + i]);
        auto const overwrite = [&](OutputKind kind) {
            if (vectors[kind].data == nullptr) return;
            std::fill_n(vectors[kind].data + target * vectors[kind].stride, 3, kNan);
        };
        if (worker.position.x[i] != 0) overwrite(kPositions);
        if (!hasTangents || (worker.tangent1.x[i] == 0 && worker.tangent2.x[i] == 0)) continue;
        overwrite(kLimit);
        overwrite(kDu);
        overwrite(kDv);
        bool const isOne =
            blend == LeafBlend::One || (blend == LeafBlend::Mixed && data->blendPowers[weight + i] == 1);
        if (!isOne) overwrite(kBlended);
    }
}

Vec3<double> ShadingEvaluator::Impl::exactLimit(TileClass const& tileClass, Place const& place, int firstValue,
                                                int point, Visit& visit, bool& isAverage) {
    Vec3<double> average;
    isAverage = tileClass.averages && findAverage(*tileClass.averages, point, place.points, average);
    return isAverage ? average : exactNormals->Find(visit.tile, firstValue + point, visit.controlPoints);
}

namespace {

void writePoint(LeafFrame::Output const& output, std::size_t point, Vec3<float> const& v) {
    if (output.data == nullptr) return;
    float* const target = output.data + point * output.stride;
    target[0] = v.x;
    target[1] = v.y;
    target[2] = v.z;
}

Vec3<float> toFloat(Vec3<double> const& v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

}  // namespace

/// Where b is 1 and N_S vanishes N_B is N_L, as in BlendNormals.
void ShadingEvaluator::Impl::replaceVanished(LeafFrame const& leaf, TileClass const& tileClass, Place const& place,
                                             int firstValue, Visit& visit) {
    if (leaf.blendedNormals.data == nullptr) return;
    for (int i = 0; i < leaf.numDoubtful; ++i) {
        bool isAverage = false;
        int const point = leaf.doubtful[i];
        Vec3<double> const limit = exactLimit(tileClass, place, firstValue, point, visit, isAverage);
        writePoint(leaf.blendedNormals, index(point), toFloat(limit));
    }
}

void ShadingEvaluator::Impl::settle(LeafFrame& leaf, TileClass const& tileClass, Place const& place, int firstValue,
                                    Visit& visit) {
    for (int i = 0; i < leaf.numDoubtful; ++i) {
        std::size_t const point = leaf.doubtful[i];
        bool isAverage = false;
        Vec3<float> limit =
            toFloat(exactLimit(tileClass, place, firstValue, static_cast<int>(point), visit, isAverage));
        if (!isAverage) ++visit.worker->numFallbacks;
        Vec3<float> subdivided{};
        float blend = 0;
        if (leaf.subdivided.x != nullptr) {
            FieldArrays const& s = leaf.subdivided;
            subdivided = NormalizedSum(Vec3<float>{s.x[point], s.y[point], s.z[point]}, 1.0f);
            blend = leaf.blend ? leaf.blend[point] : 1.0f;
            // Where no face has an area N_S stands in.
            if (IsZero(limit)) limit = subdivided;
            if (blend == 0) subdivided = {};
        }
        writePoint(leaf.limitNormals, point, limit);
        writePoint(leaf.blendedNormals, point, BlendNormals(limit, subdivided, blend, 1));
    }
}

ShadingEvaluator::ShadingEvaluator(ShadingTable const& table, EvaluatorOptions const& options) {
    int numThreads = options.numThreads;
    if (numThreads < 0) {
        throw InvalidOptions("numThreads is " + std::to_string(numThreads) + "; it must be 0 or more");
    }
    if (numThreads == 0) numThreads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    PatchKernels const* const kernels = FindKernels(options.instructionSet);
    if (kernels == nullptr) {
        throw InvalidOptions(
            "this build or this processor does not have the instruction set asked for; use "
            "InstructionSet::Best");
    }
    _impl = std::make_unique<Impl>(table.SharedData(), kernels, std::make_shared<FrameThreads>(numThreads));
}

ShadingEvaluator::~ShadingEvaluator() = default;
ShadingEvaluator::ShadingEvaluator(ShadingEvaluator&&) noexcept = default;
ShadingEvaluator& ShadingEvaluator::operator=(ShadingEvaluator&&) noexcept = default;

FrameReport ShadingEvaluator::Evaluate(PointView<float> controlPoints, ShadingOutputs const& outputs) {
    return Evaluate(controlPoints, {}, outputs);
}

FrameReport ShadingEvaluator::Evaluate(PointView<float> controlPoints, PointView<float> userNormals,
                                       ShadingOutputs const& outputs) {
    TableMesh const& mesh = _impl->data->mesh;
    checkView("controlPoints", controlPoints, index(mesh.numVertices), "control vertex");
    bool const isUser = _impl->data->options.startNormals.kind == StartNormalKind::User;
    if (isUser) {
        bool const isPerVertex = userNormals.size() == index(mesh.numVertices);
        checkView("userNormals", userNormals, isPerVertex ? userNormals.size() : mesh.faceVertices.size(),
                  "control vertex or face corner");
    } else if (!userNormals.empty()) {
        throw InvalidOptions("userNormals are given, but the table's start normals are not StartNormalKind::User");
    }
    auto const numValues = index(_impl->data->numValues);
    auto const checkPoints = [&](char const* name, PointSpan const& span) {
        checkSpan(name, span.data, span.count, span.stride, 3, numValues);
    };
    checkPoints("positions", outputs.positions);
    checkPoints("blendedNormals", outputs.blendedNormals);
    checkPoints("limitNormals", outputs.limitNormals);
    checkPoints("subdividedNormals", outputs.subdividedNormals);
    checkPoints("du", outputs.du);
    checkPoints("dv", outputs.dv);
    checkSpan("blendWeights", outputs.blendWeights.data, outputs.blendWeights.count, outputs.blendWeights.stride, 1,
              numValues);
    return _impl->evaluate(controlPoints, userNormals, outputs);
}

char const* ShadingEvaluator::InstructionSetName() const { return _impl->kernels->name; }

}  // namespace v1
}  // namespace osd_shading
