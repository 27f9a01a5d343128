// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>

#include "osd_shading/blendWeights.h"
#include "osd_shading/errors.h"
#include "osd_shading/extraordinaryVertices.h"
#include "osd_shading/startNormals.h"
#include "osd_shading/tables/tableData.h"
#include "osd_shading/tables/tileCompiler.h"
#include "osd_shading/tables/tileWeights.h"

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

/// Where the control edges are sharp at the last level: whole edges by uniform creasing, some of the children of
/// one by Chaikin's.
class LastSharpness {
public:
    LastSharpness(RefinedTopology const& topology, int lastLevel) : _topology(topology), _lastLevel(lastLevel) {
        _isUniform = topology.Refiner().GetSchemeOptions().GetCreasingMethod() == Sdc::Options::CREASE_UNIFORM;
    }

    /// Whether Chaikin's rule leaves open what becomes of some edge: then every level must be refined.
    static bool NeedsAllLevels(Far::TopologyRefiner const& refiner) {
        if (refiner.GetSchemeOptions().GetCreasingMethod() == Sdc::Options::CREASE_UNIFORM) return false;
        Far::TopologyLevel const base = refiner.GetLevel(0);
        for (int e = 0; e < base.GetNumEdges(); ++e) {
            float const sharpness = base.GetEdgeSharpness(e);
            if (sharpness > 0 && sharpness < Sdc::Crease::SHARPNESS_INFINITE) return true;
        }
        return false;
    }

    /// By child of the edge at the last level, from the end `first` on; one entry for all that are alike.
    std::vector<bool> Of(int edge, int first) const {
        Far::TopologyLevel const& base = _topology.Level(0);
        float const sharpness = base.GetEdgeSharpness(edge);
        if (!(sharpness > 0)) return {false};
        if (StaysSharp(sharpness, _lastLevel, _isUniform)) return {true};
        if (_isUniform) return {false};
        std::vector<int> edges{edge}, children;
        int start = first;
        for (int level = 0; level < _lastLevel; ++level) {
            // The order of the two children follows the ends of the parent.
            Far::TopologyLevel const& here = _topology.Level(level);
            children.clear();
            for (int const parent : edges) {
                Far::ConstIndexArray const pair = here.GetEdgeChildEdges(parent);
                bool const isForward = here.GetEdgeVertices(parent)[0] == start;
                children.push_back(pair[isForward ? 0 : 1]);
                children.push_back(pair[isForward ? 1 : 0]);
                start = here.GetEdgeVertices(parent)[isForward ? 1 : 0];
            }
            edges.swap(children);
            start = here.GetVertexChildVertex(first);
            first = start;
        }
        std::vector<bool> isSharp;
        for (int const child : edges) isSharp.push_back(IsSharpEdge(_topology.Level(_lastLevel), child));
        return isSharp;
    }
    bool AtEnd(int edge, int end) const { return Of(edge, end).front(); }

private:
    RefinedTopology const& _topology;
    int _lastLevel;
    bool _isUniform;
};

/// Shares out the values at the control mesh's vertices and along its edges.
void findOwners(RefinedTopology const& topology, LastSharpness const& last, TableData& data,
                std::vector<bool>& ownsMiddle) {
    Far::TopologyLevel const& base = topology.Level(0);
    std::vector<int> const& offsets = data.mesh.faceOffsets;
    data.cornerOwners.resize(data.mesh.faceVertices.size());
    data.edgeTwins.resize(data.mesh.faceVertices.size());
    ownsMiddle.assign(data.mesh.faceVertices.size(), false);

    // One owner for each region, at the last level, of each vertex.
    std::vector<int> group;
    for (int v = 0; v < base.GetNumVertices(); ++v) {
        Far::ConstIndexArray const faces = base.GetVertexFaces(v);
        Far::ConstLocalIndexArray const corners = base.GetVertexFaceLocalIndices(v);
        int const numFaces = faces.size();
        auto const cornerAt = [&](int i) { return offsets[index(faces[i])] + corners[i]; };
        group.assign(index(numFaces), -1);
        bool isWhole = !base.IsVertexNonManifold(v);
        for (int const edge : base.GetVertexEdges(v)) isWhole &= !IsSharpEdge(base, edge);
        if (isWhole) {
            std::fill(group.begin(), group.end(), 0);
        } else {
            // Spread from each face over edges that are not sharp.
            std::vector<int> open;
            for (int first = 0; first < numFaces; ++first) {
                if (group[index(first)] >= 0) continue;
                group[index(first)] = first;
                open.assign(1, first);
                while (!open.empty()) {
                    int const i = open.back();
                    open.pop_back();
                    Far::ConstIndexArray const edges = base.GetFaceEdges(faces[i]);
                    int const size = edges.size();
                    for (int const edge : {edges[corners[i]], edges[(corners[i] + size - 1) % size]}) {
                        if (last.AtEnd(edge, v)) continue;
                        for (int j = 0; j < numFaces; ++j) {
                            if (group[index(j)] >= 0 || base.GetFaceEdges(faces[j]).FindIndex(edge) < 0) continue;
                            group[index(j)] = first;
                            open.push_back(j);
                        }
                    }
                }
            }
        }
        for (int i = 0; i < numFaces; ++i) data.cornerOwners[index(cornerAt(i))] = cornerAt(group[index(i)]);
    }

    // Of an edge between two faces each writes the half at whose end the edge leaves a vertex in its own order:
    // equal neighbourhoods then write equal points. The middle is the extraordinary end's, or the first face's.
    int const regular = topology.IsCatmark() ? 4 : 6;
    auto const isPlain = [&](int v) {
        return base.GetVertexRule(v) == Sdc::Crease::RULE_SMOOTH && !base.IsVertexBoundary(v) &&
               base.GetVertexFaces(v).size() == regular;
    };
    for (int e = 0; e < base.GetNumEdges(); ++e) {
        Far::ConstIndexArray const faces = base.GetEdgeFaces(e);
        auto const cornerOf = [&](int face) { return offsets[index(face)] + base.GetFaceEdges(face).FindIndex(e); };
        bool const isShared = faces.size() == 2;
        for (int i = 0; i < faces.size(); ++i) {
            data.edgeTwins[index(cornerOf(faces[i]))] = cornerOf(faces[isShared ? 1 - i : i]);
        }
        if (!isShared) continue;
        // Each side of what is sharp all along writes for itself.
        int const first = cornerOf(faces[0]), second = cornerOf(faces[1]);
        int const start = data.mesh.faceVertices[index(first)];
        std::vector<bool> const isSharp = last.Of(e, start);
        if (std::find(isSharp.begin(), isSharp.end(), false) == isSharp.end()) {
            data.edgeTwins[index(first)] = first;
            data.edgeTwins[index(second)] = second;
            continue;
        }
        bool const isSecond = isPlain(start) && !isPlain(data.mesh.faceVertices[index(second)]);
        (isSecond ? ownsMiddle[index(second)] : ownsMiddle[index(first)]) = true;
    }
}

TileOwnership ownershipOf(RefinedTopology const& topology, LastSharpness const& last, TableData const& data,
                          std::vector<bool> const& ownsMiddle, int face) {
    Far::TopologyLevel const& base = topology.Level(0);
    int const size = data.mesh.FaceSize(face), offset = data.mesh.faceOffsets[index(face)], k = data.options.level;
    TileOwnership own(index(size));
    for (int i = 0; i < size; ++i) {
        int const corner = offset + i;
        own.corners[index(i)] = data.cornerOwners[index(corner)] == corner;
        EdgeOwnership& edge = own.edges[index(i)];
        if (data.edgeTwins[index(corner)] == corner) {
            edge = EdgeOwnership::All();
            continue;
        }
        edge = ownsMiddle[index(corner)] ? EdgeOwnership::HalfAndMiddle() : EdgeOwnership::Half();
        // Where children of an edge differ, points between two sharp ones have a value on this side too.
        std::vector<bool> const isSharp = last.Of(base.GetFaceEdges(face)[i], base.GetFaceVertices(face)[i]);
        if (isSharp.size() == 1) continue;
        std::vector<bool> points;
        for (std::size_t j = 1; j < isSharp.size(); ++j) {
            points.push_back((isSharp[j - 1] && isSharp[j]) || edge.Has(static_cast<int>(j) - 1, k));
        }
        edge = EdgeOwnership::Of(std::move(points));
    }
    return own;
}

/// Patterns of b: equal ones are kept once.
class PatternBuilder {
public:
    PatternBuilder(TableData& data, double exponent) : _data(data), _exponent(exponent) {}

    /// `leafSizes`: points of each leaf, in order; `weights`: of all points.
    int Add(std::vector<int> const& leafSizes, std::vector<double> const& weights) {
        bool const isZero = std::all_of(weights.begin(), weights.end(), [](double b) { return b == 0; });
        if (isZero) return kZeroEverywhere;
        if (std::all_of(weights.begin(), weights.end(), [](double b) { return b == 1; })) return kOneEverywhere;
        std::vector<LeafBlend> leaves;
        std::vector<float> mixed;
        std::size_t first = 0;
        for (int const size : leafSizes) {
            auto const begin = weights.begin() + static_cast<std::ptrdiff_t>(first), end = begin + size;
            first += index(size);
            if (std::all_of(begin, end, [](double b) { return b == 0; })) {
                leaves.push_back(LeafBlend::Zero);
            } else if (std::all_of(begin, end, [](double b) { return b == 1; })) {
                leaves.push_back(LeafBlend::One);
            } else {
                leaves.push_back(LeafBlend::Mixed);
                // What is not 0 stays so.
                for (auto it = begin; it != end; ++it) {
                    mixed.push_back(*it > 0 ? std::max(static_cast<float>(*it), std::numeric_limits<float>::min())
                                            : 0.0f);
                }
            }
        }

        std::string key(reinterpret_cast<char const*>(leaves.data()), leaves.size());
        key.append(reinterpret_cast<char const*>(mixed.data()), mixed.size() * sizeof(float));
        auto const [known, isNew] = _patternOfKey.emplace(std::move(key), static_cast<int>(_data.patterns.size()));
        if (isNew) {
            _data.patterns.push_back({_data.leafBlends.size(), _data.blendPowers.size()});
            _data.leafBlends.insert(_data.leafBlends.end(), leaves.begin(), leaves.end());
            for (float const b : mixed) {
                double const power = _exponent == 1 ? double{b} : std::pow(double{b}, _exponent);
                _data.blendPowers.push_back(static_cast<float>(power));
            }
            if (_exponent != 1) _data.blendWeights.insert(_data.blendWeights.end(), mixed.begin(), mixed.end());
        }
        return known->second;
    }

private:
    TableData& _data;
    double _exponent;
    std::unordered_map<std::string, int> _patternOfKey;
};

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
    LimitStep<double> const limit(topology, options.level, levels.Regions(options.level), numThreads);
    return ComputeBlendWeights(options.weights, topology, levels, limit, numThreads);
}

/// The patterns of tiles whose b is found from that of the start level round them.
class LocalPatterns {
public:
    LocalPatterns(RegionLevels& levels, TableData const& data, std::vector<TileField> const& fields,
                  PatternBuilder& patterns)
        : _levels(levels),
          _data(data),
          _patterns(patterns),
          _level(data.options.startNormals.level),
          _start(FindStartWeights(data.options.weights, levels, _level, data.options.level)),
          _tileWeights(data.options.weights, data.dictionary, fields, levels.Topology().IsCatmark(),
                       data.options.level) {}

    /// Adds to `numBlended` the points with b > 0.
    int Find(CompiledTile const& tile, std::int64_t& numBlended) {
        WeightSources sources;
        for (FaceCorner const& at : tile.normals) {
            std::size_t const value = index(_levels.ValueAt(_level, at));
            sources.weights.push_back(_start.weights[value]);
            sources.seeds.push_back(_start.seeds[value]);
        }
        int const numPoints = _data.dictionary.classes[index(tile.tileClass)].numPoints;
        if (numPoints == 0) return kZeroEverywhere;
        if (_tileWeights.IsConstant(tile.tileClass, _level, sources)) {
            bool const isOne = sources.weights[0] == 1;
            numBlended += isOne ? numPoints : 0;
            return isOne ? kOneEverywhere : kZeroEverywhere;
        }
        std::string key(reinterpret_cast<char const*>(&tile.tileClass), sizeof tile.tileClass);
        key.append(reinterpret_cast<char const*>(sources.weights.data()), sources.weights.size() * sizeof(double));
        key.append(reinterpret_cast<char const*>(sources.seeds.data()),
                   sources.seeds.size() * sizeof(std::uint32_t));
        auto const [known, isNew] = _known.emplace(std::move(key), Found{});
        if (isNew) {
            std::vector<double> weights;
            std::vector<int> leafSizes;
            _tileWeights.Append(tile.tileClass, _level, sources, weights);
            AppendLeafSizes(_data.dictionary, tile.tileClass, leafSizes);
            known->second.pattern = _patterns.Add(leafSizes, weights);
            known->second.numBlended =
                std::count_if(weights.begin(), weights.end(), [](double b) { return b > 0; });
        }
        numBlended += known->second.numBlended;
        return known->second.pattern;
    }

private:
    struct Found {
        int pattern = kZeroEverywhere;
        std::int64_t numBlended = 0;
    };

    RegionLevels& _levels;
    TableData const& _data;
    PatternBuilder& _patterns;
    int _level;
    WeightSources _start;
    TileWeights _tileWeights;
    std::unordered_map<std::string, Found> _known;
};

/// Start normals that are averages of faces, or the caller's.
class StartBuilder {
public:
    StartBuilder(RegionLevels& levels, int level, StartNormalKind kind, StartProgram& program)
        : _levels(levels),
          _level(level),
          _kind(kind),
          _program(program),
          _normalOfValue(index(levels.Regions(level).NumValues()), -1) {}

    /// The number of a value's start normal.
    int Use(int value) {
        int& normal = _normalOfValue[index(value)];
        if (normal < 0) normal = _program.numNormals++;
        return normal;
    }

    void Finish() {
        // The faces of each value that is used.
        Far::TopologyLevel const& level = _levels.Level(_level);
        CreaseRegions const& regions = _levels.Regions(_level);
        std::vector<std::vector<std::pair<int, int>>> corners(index(_program.numNormals));  // face, corner
        for (int f = 0; f < level.GetNumFaces(); ++f) {
            for (int i = 0; i < level.GetFaceVertices(f).size(); ++i) {
                int const normal = _normalOfValue[index(regions.CornerValue(f, i))];
                if (normal >= 0) corners[index(normal)].emplace_back(f, i);
            }
        }
        bool const isUser = _kind == StartNormalKind::User;
        bool const isWeighted = FaceWeightOf(_kind) != FaceWeight::Uniform;
        std::vector<int> faceNumber(index(level.GetNumFaces()), -1), firstCorners;
        if (isUser) {
            int offset = 0;
            for (int f = 0; f < level.GetNumFaces(); ++f) {
                firstCorners.push_back(offset);
                offset += level.GetFaceVertices(f).size();
            }
        }
        std::vector<int> faces;
        for (auto const& list : corners) {
            for (auto const& [face, corner] : list) {
                if (isUser) {
                    _program.valueFaces.push_back(firstCorners[index(face)] + corner);
                    continue;
                }
                int& number = faceNumber[index(face)];
                if (number < 0) {
                    number = static_cast<int>(faces.size());
                    faces.push_back(face);
                }
                _program.valueFaces.push_back(number);
                if (isWeighted) _program.valueCorners.push_back(static_cast<std::uint8_t>(std::min(corner, 255)));
            }
            _program.valueOffsets.push_back(static_cast<int>(_program.valueFaces.size()));
        }
        if (!isUser) addPoints(faces);
    }

private:
    /// The points of faces of the start level, and what they are refined from.
    void addPoints(std::vector<int> const& faces) {
        RefinedTopology const& topology = _levels.Topology();
        std::vector<std::vector<unsigned char>> isNeeded;
        for (int l = 0; l <= _level; ++l) isNeeded.emplace_back(index(_levels.Level(l).GetNumVertices()), 0);
        for (int const f : faces) {
            for (int const v : _levels.Level(_level).GetFaceVertices(f)) isNeeded[index(_level)][index(v)] = 1;
        }
        std::vector<LevelMasks<double>> masks(index(_level) + 1);
        auto const forEachTerm = [&](int level, int vertex, auto const& visit) {
            LevelMasks<double> const& m = masks[index(level)];
            auto const row = index(m.Row(vertex));
            for (auto t = index(m.offsets[row]); t < index(m.offsets[row + 1]); ++t)
                visit(m.terms[t], m.weights[t]);
        };
        for (int l = _level; l > 0; --l) {
            masks[index(l)] = topology.RecordMasks<double>(l);
            auto& here = isNeeded[index(l)];
            // Face points may be needed by others alone.
            for (std::size_t v = 0; v < here.size(); ++v) {
                if (!here[v]) continue;
                forEachTerm(l, static_cast<int>(v), [&](int term, double) {
                    if (term < 0) here[index(~term)] = 1;
                });
            }
            for (std::size_t v = 0; v < here.size(); ++v) {
                if (!here[v]) continue;
                forEachTerm(l, static_cast<int>(v), [&](int term, double) {
                    if (term >= 0) isNeeded[index(l) - 1][index(term)] = 1;
                });
            }
        }
        // Control points keep their numbers; rows follow, face points first.
        std::vector<int> pointOfParent(isNeeded[0].size());
        for (std::size_t v = 0; v < pointOfParent.size(); ++v) pointOfParent[v] = static_cast<int>(v);
        int numPoints = static_cast<int>(pointOfParent.size());
        for (int l = 1; l <= _level; ++l) {
            LevelMasks<double> const& m = masks[index(l)];
            std::vector<int> point(isNeeded[index(l)].size(), -1);
            auto const addRows = [&](int first, int last) {
                for (int v = first; v < last; ++v) {
                    if (!isNeeded[index(l)][index(v)]) continue;
                    forEachTerm(l, v, [&](int term, double weight) {
                        _program.pointSources.push_back(term >= 0 ? pointOfParent[index(term)]
                                                                  : point[index(~term)]);
                        _program.pointWeights.push_back(weight);
                    });
                    _program.pointOffsets.push_back(static_cast<std::uint32_t>(_program.pointSources.size()));
                    point[index(v)] = numPoints++;
                }
                _program.rowSegments.push_back(static_cast<int>(_program.pointOffsets.size()) - 1);
            };
            int const firstFaceChild = topology.FirstFaceChild(l - 1);
            addRows(firstFaceChild, firstFaceChild + m.numFaceChildren);
            addRows(0, firstFaceChild);
            addRows(firstFaceChild + m.numFaceChildren, m.numChildVertices);
            pointOfParent.swap(point);
        }
        for (int const f : faces) {
            for (int const v : _levels.Level(_level).GetFaceVertices(f)) {
                _program.facePoints.push_back(pointOfParent[index(v)]);
            }
            _program.faceOffsets.push_back(static_cast<int>(_program.facePoints.size()));
        }
    }

    RegionLevels& _levels;
    int _level;
    StartNormalKind _kind;
    StartProgram& _program;
    std::vector<int> _normalOfValue;
};

/// Start normals that are limit normals: a table of their level gives them.
std::vector<int> makeLimitStart(RefinedTopology const& topology, RegionLevels& levels,
                                ShadingOptions const& options, StartProgram& program) {
    int const level = options.startNormals.level;
    ShadingOptions own;
    own.level = level;
    own.startNormals.level = own.weights.level = std::min(1, level);
    own.execution = options.execution;
    program.limitTable = BuildTable(topology, own, ValueOrder::Tiles, false);
    program.numNormals = program.limitTable->numValues;

    CreaseRegions const& regions = levels.Regions(level);
    std::vector<int> normalOfValue(index(regions.NumValues()), -1);
    std::vector<FaceCorner> const corners = FindValueCorners(*program.limitTable, topology);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        normalOfValue[index(levels.ValueAt(level, corners[i]))] = static_cast<int>(i);
    }
    if (options.startNormals.kind == StartNormalKind::Limit) return normalOfValue;

    LimitStep<double> const step(topology, level, regions, 1);
    ValueMarks const marks = MarkSmoothed(step);
    std::vector<std::pair<int, double>> terms;
    for (int v = 0; v < regions.NumVertices(); ++v) {
        for (int value = regions.FirstValue(v); value < regions.FirstValue(v + 1); ++value) {
            if (!marks[index(value)]) continue;
            terms.clear();
            step.AppendTerms(v, value, terms);
            program.smoothed.push_back(normalOfValue[index(value)]);
            for (auto const& [source, weight] : terms) {
                program.smoothSources.push_back(normalOfValue[index(source)]);
                program.smoothWeights.push_back(static_cast<float>(weight));
            }
            program.smoothOffsets.push_back(static_cast<std::uint32_t>(program.smoothSources.size()));
        }
    }
    return normalOfValue;
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
    data.options.execution.progress = nullptr;
    data.order = order;
    data.mesh = copyMesh(topology);
    Far::TopologyLevel const& base = topology.Level(0);
    int const lastLevel = options.level, normalLevel = options.startNormals.level;

    // Levels beyond those that start normals need, where something can't be told without them.
    bool const usesOne = options.weights.scheme == WeightScheme::One;
    bool const hasWeights = hasSubdividedNormals && !usesOne;
    bool const hasLocalWeights = hasWeights && HasLocalWeights(options.weights, topology.Refiner());
    bool const needsAllLevels = order == ValueOrder::OpenSubdiv || (hasWeights && !hasLocalWeights) ||
                                LastSharpness::NeedsAllLevels(topology.Refiner());
    std::unique_ptr<RefinedTopology> own;
    if (needsAllLevels && topology.LastLevel() < lastLevel) {
        own = std::make_unique<RefinedTopology>(topology.Refiner(), lastLevel);
    }
    RefinedTopology const& all = own ? *own : topology;
    RegionLevels levels(topology), allLevels(all);

    LastSharpness const last(all, lastLevel);
    std::vector<bool> ownsMiddle;
    findOwners(topology, last, data, ownsMiddle);

    // Tiles and their classes.
    TileCompiler compiler({data.mesh.rules, options.limits.positions, options.limits.normals,
                           FaceWeightOf(options.startNormals.kind), hasSubdividedNormals, hasLocalWeights});
    std::vector<CompiledTile> tiles;
    tiles.reserve(index(base.GetNumFaces()));
    for (int f = 0; f < base.GetNumFaces(); ++f) {
        tiles.push_back(compiler.Compile(levels, 0, f, lastLevel, hasSubdividedNormals ? normalLevel : 0,
                                         ownershipOf(topology, last, data, ownsMiddle, f)));
    }
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
        limitNormals = makeLimitStart(topology, levels, options, data.start);
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
    for (int f = 0; f < base.GetNumFaces(); ++f) {
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
    stats.buildSeconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return made;
}

namespace {

/// Turns a point of a class's grid into one of the face whose corner `rotation` the class begins with.
GridPoint turnBack(GridPoint point, int rotation, int side, bool isTriangle) {
    if (isTriangle) {
        int const own[3] = {side - point.row - point.column, point.column, point.row};
        int face[3];
        for (int i = 0; i < 3; ++i) face[(i + rotation) % 3] = own[i];
        return {point.child, face[2], face[1]};
    }
    for (int i = 0; i < rotation; ++i) {
        int const row = point.row;
        point.row = point.column;
        point.column = side - row;
    }
    return point;
}

void appendPoints(TileDictionary const& dictionary, int tileClass, std::vector<GridPoint>& points) {
    TileClass const& c = dictionary.classes[index(tileClass)];
    if (c.kind == TileKind::Spline) {
        int const windows = NumWindows(c.k), side = 1 << std::min<int>(c.k, 4);
        for (std::size_t window = 0; window < c.plans.size(); ++window) {
            RowPlan const& plan = dictionary.plans[index(c.plans[window])];
            int const row = static_cast<int>(window) / windows * side,
                      column = static_cast<int>(window) % windows * side;
            for (int s = 0; s < plan.numSegments; ++s) {
                RowSegment const& segment = plan.segments[s];
                for (int i = 0; i < segment.count; ++i)
                    points.push_back({0, row + segment.row, column + segment.first + i});
            }
        }
    } else if (c.kind == TileKind::Dense) {
        for (auto const at : c.gridPoints) points.push_back({0, at / 32, at % 32});
    } else {
        bool const isTriangle = c.size == 3 && !c.isNgon;
        int const half = 1 << (c.k - 1);
        for (std::size_t i = 0; i < c.children.size(); ++i) {
            std::size_t const first = points.size();
            appendPoints(dictionary, c.children[i].tileClass, points);
            for (std::size_t p = first; p < points.size(); ++p) {
                GridPoint point = turnBack(points[p], c.children[i].rotation, half, isTriangle);
                if (c.isNgon) {
                    point.child = static_cast<int>(i);
                } else if (isTriangle) {
                    int const sign = i == 3 ? -1 : 1;
                    point.row = sign * point.row + (i >= 2 ? half : 0);
                    point.column = sign * point.column + (i % 2 == 1 ? half : 0);
                } else {
                    point.row += i >= 2 ? half : 0;
                    point.column += i == 1 || i == 2 ? half : 0;
                }
                points[p] = point;
            }
        }
    }
}

}  // namespace

void AppendLeafSizes(TileDictionary const& dictionary, int tileClass, std::vector<int>& sizes) {
    TileClass const& c = dictionary.classes[index(tileClass)];
    switch (c.kind) {
        case TileKind::Spline:
            for (int const plan : c.plans) sizes.push_back(dictionary.plans[index(plan)].numPoints);
            break;
        case TileKind::Dense:
            sizes.push_back(c.numPoints);
            break;
        case TileKind::Split:
            for (ChildTile const& child : c.children) AppendLeafSizes(dictionary, child.tileClass, sizes);
            break;
    }
}

std::vector<GridPoint> FindTilePoints(TileDictionary const& dictionary, Tile const& tile) {
    std::vector<GridPoint> points;
    TileClass const& c = dictionary.classes[index(tile.tileClass)];
    points.reserve(index(c.numPoints));
    appendPoints(dictionary, tile.tileClass, points);
    for (GridPoint& point : points) {
        if (c.isNgon) {
            point.child = (point.child + tile.rotation) % c.size;
        } else {
            point = turnBack(point, tile.rotation, 1 << c.k, c.size == 3);
        }
    }
    return points;
}

std::vector<FaceCorner> FindValueCorners(TableData const& data, RefinedTopology const& topology) {
    std::vector<FaceCorner> corners;
    corners.reserve(index(data.numValues));
    int const lastLevel = data.options.level;
    for (std::size_t f = 0; f < data.tiles.size(); ++f) {
        bool const isNgon = data.dictionary.classes[index(data.tiles[f].tileClass)].isNgon;
        int const side = 1 << (isNgon ? lastLevel - 1 : lastLevel);
        int filled = -1;
        std::vector<FaceCorner> grid;
        for (GridPoint const& point : FindTilePoints(data.dictionary, data.tiles[f])) {
            if (point.child != filled) {
                filled = point.child;
                int const face = static_cast<int>(f);
                grid = isNgon
                           ? FindFaceGrid(topology, 1, topology.Level(0).GetFaceChildFaces(face)[filled], lastLevel)
                           : FindFaceGrid(topology, 0, face, lastLevel);
            }
            corners.push_back(grid[index(point.row * (side + 1) + point.column)]);
        }
    }
    return corners;
}

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
