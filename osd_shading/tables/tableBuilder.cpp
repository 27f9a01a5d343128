// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "osd_shading/blendWeights.h"
#include "osd_shading/errors.h"
#include "osd_shading/startNormals.h"
#include "osd_shading/tables/blendPatterns.h"
#include "osd_shading/tables/borderOwners.h"
#include "osd_shading/tables/startProgram.h"
#include "osd_shading/tables/tableData.h"
#include "osd_shading/tables/tableEstimate.h"
#include "osd_shading/tables/tileCompiler.h"

namespace osd_shading {
inline namespace v1 {
namespace tables {

namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

TableMesh copyMesh(RefinedTopology const& topology) {
    Far::TopologyLevel const& base = topology.Level(0);
    TableMesh mesh;
    mesh.rules = RulesOf(topology.Refiner());
    mesh.numVertices = base.GetNumVertices();
    mesh.faceVertices.reserve(index(base.GetNumFaceVertices()));
    mesh.faceOffsets.reserve(index(base.GetNumFaces()) + 1);
    for (int f = 0; f < base.GetNumFaces(); ++f) {
        Far::ConstIndexArray const vertices = base.GetFaceVertices(f);
        mesh.faceVertices.insert(mesh.faceVertices.end(), vertices.begin(), vertices.begin() + vertices.size());
        mesh.faceOffsets.push_back(static_cast<int>(mesh.faceVertices.size()));
        if (base.IsFaceHole(f)) mesh.holes.push_back(f);
    }
    for (int e = 0; e < base.GetNumEdges(); ++e) {
        if (!IsSharpEdge(base, e)) continue;
        Far::ConstIndexArray const ends = base.GetEdgeVertices(e);
        mesh.creaseVertices.insert(mesh.creaseVertices.end(), {ends[0], ends[1]});
        mesh.creaseSharpness.push_back(base.GetEdgeSharpness(e));
    }
    for (int v = 0; v < base.GetNumVertices(); ++v) {
        if (!(base.GetVertexSharpness(v) > 0)) continue;
        mesh.cornerVertices.push_back(v);
        mesh.cornerSharpness.push_back(base.GetVertexSharpness(v));
    }
    return mesh;
}

/// The most local points that a tile and those inside it hold at one time.
std::size_t countLocalPoints(TileDictionary const& dictionary, int tileClass, std::vector<std::size_t>& known) {
    std::size_t& count = known[index(tileClass)];
    if (count > 0) return count;
    TileClass const& c = dictionary.classes[index(tileClass)];
    std::size_t most = 0;
    for (ChildTile const& child : c.children) {
        most = std::max(most, countLocalPoints(dictionary, child.tileClass, known));
    }
    return count = index(c.numSources + c.pointRows.NumRows() + c.numNormalSources + c.normalRows.NumRows()) + most;
}

/// b of every value of the last level, level by level.
std::vector<double> weightsOfLastLevel(RefinedTopology const& topology, ShadingOptions const& options) {
    int const numThreads = options.execution.numThreads;
    FieldLevels<double> const levels(topology, options.weights.level, numThreads);
    LimitStep<double> const limit(topology, options.level, levels.Regions(options.level), numThreads,
                                  options.limits.normals);
    return ComputeBlendWeights(options.weights, topology, levels, limit, numThreads);
}

std::size_t bytesOfData(TableData const& data) {
    auto const bytesOf = [](auto const& v) { return v.capacity() * sizeof(v[0]); };
    StartProgram const& start = data.start;
    return sizeof data + data.dictionary.NumBytes() + bytesOf(data.mesh.faceOffsets) +
           bytesOf(data.mesh.faceVertices) + bytesOf(data.mesh.creaseVertices) +
           bytesOf(data.mesh.creaseSharpness) + bytesOf(data.mesh.cornerVertices) +
           bytesOf(data.mesh.cornerSharpness) + bytesOf(data.mesh.holes) + bytesOf(data.tiles) +
           bytesOf(data.vertices) + bytesOf(data.normals) + bytesOf(data.patterns) + bytesOf(data.leafBlends) +
           bytesOf(data.blendPowers) + bytesOf(data.blendWeights) + bytesOf(data.cornerOwners) +
           bytesOf(data.edgeTwins) + bytesOf(data.orderOfValues) + bytesOf(start.valueOffsets) +
           bytesOf(start.valueFaces) + bytesOf(start.valueCorners) + bytesOf(start.pointOffsets) +
           bytesOf(start.pointSources) + bytesOf(start.pointWeights) + bytesOf(start.faceOffsets) +
           bytesOf(start.facePoints) + bytesOf(start.smoothed) + bytesOf(start.smoothOffsets) +
           bytesOf(start.smoothSources) + bytesOf(start.smoothWeights) +
           (start.limitTable ? start.limitTable->stats.bytes : 0);
}

}  // namespace

std::shared_ptr<TableData const> BuildTable(RefinedTopology const& topology, ShadingOptions const& options,
                                            ValueOrder order, bool hasSubdividedNormals) {
    auto const start = std::chrono::steady_clock::now();
    auto made = std::make_shared<TableData>();
    TableData& data = *made;
    data.options = options;
    data.options.execution.progress = nullptr;  // what it holds is the caller's
    BuildProgress progress(options.execution.progress);
    progress.Enter(0, 0.1);
    data.order = order;
    data.mesh = copyMesh(topology);
    Far::TopologyLevel const& base = topology.Level(0);
    int const lastLevel = options.level, normalLevel = options.startNormals.level;

    // Levels beyond those that start normals need, where something can't be told without them.
    bool const usesOne = options.weights.scheme == WeightScheme::One;
    bool const hasWeights = hasSubdividedNormals && !usesOne;
    bool const hasLocalWeights = hasWeights && HasLocalWeights(options.weights, topology.Refiner());
    bool const needsAllLevels =
        order == ValueOrder::OpenSubdiv || (hasWeights && !hasLocalWeights) || NeedsAllLevels(topology.Refiner());
    std::unique_ptr<RefinedTopology> own;
    if (needsAllLevels && topology.LastLevel() < lastLevel) {
        own = std::make_unique<RefinedTopology>(topology.Refiner(), lastLevel);
    }
    RefinedTopology const& all = own ? *own : topology;
    RegionLevels levels(topology), allLevels(all);

    BorderOwners const owners(topology, all, data);

    // Tiles and their classes.
    progress.Enter(0.1, 0.7);
    TileCompiler compiler({data.mesh.rules, options.limits.positions, options.limits.normals,
                           FaceWeightOf(options.startNormals.kind), hasSubdividedNormals, hasLocalWeights});
    std::vector<CompiledTile> const tiles = compiler.CompileAll(
        levels, lastLevel, hasSubdividedNormals ? normalLevel : 0, [&](int face) { return owners.Of(face); },
        [&](double share) { progress.Tell(share); });
    std::vector<TileField> const fields = compiler.TakeFields();
    data.dictionary = compiler.Take();

    // Weights, start normals, sources.
    std::vector<double> weights;
    if (hasWeights && !hasLocalWeights) weights = weightsOfLastLevel(all, options);
    StartNormalKind const kind = options.startNormals.kind;
    bool const isLimit = kind == StartNormalKind::Limit || kind == StartNormalKind::LimitSmoothed;
    std::vector<int> limitNormals;
    std::unique_ptr<StartBuilder> startBuilder;
    if (hasSubdividedNormals && isLimit) {
        limitNormals = MakeLimitStart(topology, levels, options, data.start);
    } else if (hasSubdividedNormals) {
        startBuilder = std::make_unique<StartBuilder>(levels, normalLevel, kind, data.start);
    }
    PatternBuilder patterns(data, options.weights.exponent);
    std::optional<LocalPatterns> localPatterns;
    if (hasLocalWeights) localPatterns.emplace(levels, data, fields, patterns);
    std::int64_t numValues = 0;
    std::vector<int> leafSizes;
    std::vector<double> tileWeights;
    std::vector<std::size_t> localPoints(data.dictionary.classes.size(), 0);
    progress.Enter(0.7, 1);
    for (int f = 0; f < base.GetNumFaces(); ++f) {
        progress.Tell(static_cast<double>(f) / base.GetNumFaces());
        CompiledTile const& compiled = tiles[index(f)];
        TileClass const& tileClass = data.dictionary.classes[index(compiled.tileClass)];
        Tile tile;
        tile.tileClass = compiled.tileClass;
        tile.rotation = compiled.rotation;
        tile.firstValue = static_cast<int>(numValues);
        tile.firstVertex = data.vertices.size();
        numValues += tileClass.numPoints;
        if (numValues > std::numeric_limits<int>::max()) {
            throw MemoryLimitExceeded(
                "the shaded mesh has more values than 32-bit indices can number; use a lower level",
                static_cast<std::uint64_t>(numValues) * 4);
        }
        data.vertices.insert(data.vertices.end(), compiled.vertices.begin(), compiled.vertices.end());
        if (hasSubdividedNormals && usesOne) {
            tile.pattern = kOneEverywhere;
        } else if (hasLocalWeights) {
            tile.pattern = localPatterns->Find(compiled, data.stats.blendedValues);
        } else if (hasSubdividedNormals) {
            leafSizes.clear();
            AppendLeafSizes(data.dictionary, compiled.tileClass, leafSizes);
            std::vector<GridPoint> const points = FindTilePoints(data.dictionary, tile);
            bool const isNgon = topology.IsCatmark() && data.mesh.FaceSize(f) != 4;
            tileWeights.clear();
            int filled = -1;
            std::vector<FaceCorner> grid;
            int const side = 1 << (isNgon ? lastLevel - 1 : lastLevel);
            for (GridPoint const& point : points) {
                if (point.child != filled) {
                    filled = point.child;
                    grid = isNgon ? FindFaceGrid(all, 1, all.Level(0).GetFaceChildFaces(f)[filled], lastLevel)
                                  : FindFaceGrid(all, 0, f, lastLevel);
                }
                FaceCorner const at = grid[index(point.row * (side + 1) + point.column)];
                tileWeights.push_back(weights[index(allLevels.ValueAt(lastLevel, at))]);
            }
            tile.pattern = patterns.Add(leafSizes, tileWeights);
            data.stats.blendedValues +=
                std::count_if(tileWeights.begin(), tileWeights.end(), [](double b) { return b > 0; });
        }
        if (tile.pattern != kZeroEverywhere) {
            ++data.stats.blendedTiles;
            tile.firstNormal = data.normals.size();
            int const sourceLevel = normalLevel;
            for (FaceCorner const& at : compiled.normals) {
                int const value = levels.ValueAt(sourceLevel, at);
                data.normals.push_back(isLimit ? limitNormals[index(value)] : startBuilder->Use(value));
            }
        }
        data.numLocalPoints =
            std::max(data.numLocalPoints, countLocalPoints(data.dictionary, tile.tileClass, localPoints));
        bool const isTriangle = !topology.IsCatmark() && tileClass.kind == TileKind::Dense;
        data.stats.regularTiles += tileClass.kind == TileKind::Spline || isTriangle;
        data.tiles.push_back(tile);
    }
    if (startBuilder) startBuilder->Finish();
    data.numValues = static_cast<int>(numValues);

    std::int64_t numFaces = 0;
    for (int f = 0; f < base.GetNumFaces(); ++f) {
        if (base.IsFaceHole(f)) continue;
        int const size = data.mesh.FaceSize(f);
        bool const isNgon = topology.IsCatmark() && size != 4;
        numFaces += isNgon ? std::int64_t{size} << (2 * (lastLevel - 1)) : std::int64_t{1} << (2 * lastLevel);
    }
    data.numFaces = static_cast<int>(numFaces);
    if (order == ValueOrder::OpenSubdiv) {
        for (FaceCorner const& at : FindValueCorners(data, all)) {
            data.orderOfValues.push_back(allLevels.ValueAt(lastLevel, at));
        }
    }

    for (auto* list :
         {&data.vertices, &data.normals, &data.start.valueOffsets, &data.start.valueFaces, &data.start.pointSources,
          &data.start.faceOffsets, &data.start.facePoints, &data.orderOfValues}) {
        list->shrink_to_fit();
    }
    data.tiles.shrink_to_fit();
    data.patterns.shrink_to_fit();
    data.leafBlends.shrink_to_fit();
    data.blendPowers.shrink_to_fit();
    data.blendWeights.shrink_to_fit();
    data.start.pointOffsets.shrink_to_fit();
    data.start.pointWeights.shrink_to_fit();

    ShadingTableStats& stats = data.stats;
    stats.values = numValues;
    stats.faces = numFaces;
    stats.tiles = static_cast<std::int64_t>(data.tiles.size());
    if (usesOne && hasSubdividedNormals) stats.blendedValues = numValues;
    stats.classes = static_cast<std::int64_t>(data.dictionary.classes.size());
    stats.denseMatrices = static_cast<std::int64_t>(data.dictionary.matrices.size());
    stats.startNormals = data.start.numNormals;
    stats.dictionaryBytes = data.dictionary.NumBytes();
    stats.bytes = bytesOfData(data);
    progress.Tell(1);
    stats.buildSeconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return made;
}

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
