// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/tables/tileFrames.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "osd_shading/vectorMath.h"

namespace osd_shading {
inline namespace v1 {
namespace tables {

namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// Points that a thread takes at a time.
constexpr int kChunkPoints = 8192;

/// A tangent that reaches less across the other, as a share of what it is summed from, has lost too many digits for
/// a normal exact to 1e-5. A matrix sums some twenty products whose errors seldom add up; a spline's differences
/// lose little.
constexpr float kDenseDoubt = 1.0f / 256, kSplineDoubt = 1.0f / 64;

Frame2 frameOfRotation(int rotation, bool isTriangle) {
    if (rotation == 0) return {};
    if (isTriangle) return rotation == 1 ? Frame2{0, -1, 1, -1} : Frame2{-1, 1, -1, 0};
    return rotation == 1 ? Frame2{0, -1, 1, 0} : rotation == 2 ? Frame2{-1, 0, 0, -1} : Frame2{0, 1, -1, 0};
}

}  // namespace

TileFrames::TileFrames(std::shared_ptr<TableData const> tableData, PatchKernels const* patchKernels,
                       std::shared_ptr<FrameThreads> frameThreads)
    : data(std::move(tableData)),
      kernels(patchKernels),
      threads(std::move(frameThreads)),
      startFrame(*data),
      exactNormals(std::make_unique<ExactNormals>(*data)) {
    StartProgram const& start = data->start;
    startNormals.resize(index(start.numNormals), LocalPoint{{0, 0, 0, 0}});
    if (start.limitTable) limitStart = std::make_unique<TileFrames>(start.limitTable, kernels, threads);
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

FrameReport TileFrames::evaluate(PointView<float> controlPoints, PointView<float> userNormals,
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

void TileFrames::evaluateTile(int tileIndex, Visit& visit) {
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

void TileFrames::startVisit(Tile const& tile, Visit& visit) const {
    visit.value = tile.firstValue;
    visit.hasNormals = needsSubdivided && tile.pattern != kZeroEverywhere;
    visit.leafBlend = nullptr;
    visit.blend = tile.pattern == kOneEverywhere ? LeafBlend::One : LeafBlend::Zero;
    if (tile.pattern < 0) return;
    BlendPattern const& pattern = data->patterns[index(tile.pattern)];
    visit.leafBlend = data->leafBlends.data() + pattern.firstLeaf;
    visit.weight = pattern.firstWeight;
}

void TileFrames::evaluateClass(int classIndex, Place const& place, Visit& visit) {
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

void TileFrames::evaluateSplit(TileClass const& c, Place const& place, Visit& visit) {
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

void TileFrames::evaluateDense(TileClass const& c, Place const& place, LeafSources const& sources, Visit& visit) {
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

void TileFrames::evaluateSpline(TileClass const& c, Place const& place, LeafSources const& sources, Visit& visit) {
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

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
