// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/surface/faceClass.h"

#include <algorithm>
#include <cassert>
#include <map>
#include <utility>

#include "osd_shading/blendWeights.h"
#include "osd_shading/limitFrames.h"
#include "osd_shading/tables/faceGrid.h"
#include "osd_shading/tables/tangentRows.h"

namespace osd_shading {
inline namespace v1 {
namespace surface {

namespace {

/// How many levels below an irregular face its patches are kept; what is nearer to the vertex, 1 in 4^this of it,
/// is refined when it is asked for.
constexpr int kKeptLevels = 4;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

class FaceCompiler {
public:
    FaceCompiler(FaceClassOptions const& options, tables::TileRing const& cutOut, LimitClasses& limitClasses)
        : _options(options),
          _lastLevel(options.shading.level),
          _limitClasses(limitClasses),
          _mesh(cutOut),
          _topology(_mesh.Mesh(options.rules), _lastLevel),
          _levels(_topology),
          _limits(index(_lastLevel) + 1),
          _made(std::make_unique<FaceClass>()) {}

    std::unique_ptr<FaceClass> Compile() {
        _made->isCatmark = _topology.IsCatmark();
        findWeights();
        bool const isNgon = _topology.IsCatmark() && _topology.Level(0).GetFaceVertices(_mesh.tileFace).size() != 4;
        if (isNgon) {
            Far::ConstIndexArray const children = _levels.Level(0).GetFaceChildFaces(_mesh.tileFace);
            std::vector<std::uint32_t> const roots = newNodes(children.size());
            for (int i = 0; i < children.size(); ++i) compile(1, children[i], roots[index(i)]);
            _made->patches->roots = roots;
        } else {
            _made->patches->roots = newNodes(1);
            compile(0, _mesh.tileFace, _made->patches->roots[0]);
        }
        makeFirstLines();
        finishRows();
        return std::move(_made);
    }

private:
    bool usesOne() const { return _options.shading.weights.scheme == WeightScheme::One; }

    void findWeights() {
        BlendWeightOptions const& options = _options.shading.weights;
        if (usesOne()) {
            _hasWeights = true;
            return;
        }
        FieldLevels<double> const levels(_topology, options.level, 1);
        _history = ComputeWeightHistory(options, _topology, levels, 1);
        auto const isSet = [](auto b) { return b != 0; };
        _hasWeights = std::any_of(_history.weights.back().begin(), _history.weights.back().end(), isSet);
        for (ValueMarks const& marks : _history.changed) {
            _isChanged.push_back(std::any_of(marks.begin(), marks.end(), isSet));
        }
    }
    int firstWeights() const { return _options.shading.weights.level; }
    /// b of a value, before any limit.
    double weightOf(int level, int value) const {
        if (usesOne()) return 1;
        if (!_hasWeights || level < firstWeights()) return 0;
        return _history.weights[index(level - firstWeights())][index(value)];
    }

    std::vector<std::uint32_t> newNodes(int count) {
        std::vector<std::uint32_t> numbers;
        for (int i = 0; i < count; ++i) {
            numbers.push_back(static_cast<std::uint32_t>(_made->patches->nodes.size()));
            _made->patches->nodes.emplace_back();
        }
        return numbers;
    }

    /// Whether `isIt(value)` of any value of the faces round a face's descendants at level `at`.
    template <typename IsIt>
    bool anyRound(int level, int face, int at, IsIt const& isIt) {
        if (level < at) {
            Far::ConstIndexArray const children = _levels.Level(level).GetFaceChildFaces(face);
            return std::any_of(children.begin(), children.begin() + children.size(),
                               [&](int child) { return anyRound(level + 1, child, at, isIt); });
        }
        CreaseRegions const& regions = _levels.Regions(level);
        for (int const v : _levels.Level(level).GetFaceVertices(face)) {
            for (int const around : _levels.Level(level).GetVertexFaces(v)) {
                int const* const values = regions.FaceValues(around);
                for (int i = 0; i < _levels.Level(level).GetFaceVertices(around).size(); ++i) {
                    if (isIt(values[i])) return true;
                }
            }
        }
        return false;
    }

    bool hasWeight(int level, int face) {
        return _hasWeights &&
               anyRound(level, face, _lastLevel, [&](int value) { return weightOf(_lastLevel, value) != 0; });
    }

    /// Whether nothing is seeded round a face any more that refining alone does not give.
    bool isSeeded(int level, int face) {
        if (level < std::max(_options.shading.startNormals.level, firstWeights())) return false;
        for (int at = level + 1; at <= _lastLevel; ++at) {
            ValueMarks const& changed = _history.changed[index(at - firstWeights())];
            if (!_isChanged[index(at - firstWeights())]) continue;
            if (anyRound(level, face, at, [&](int value) { return changed[index(value)] != 0; })) return false;
        }
        return true;
    }

    LimitStep<double> const& limitStep(int level) {
        std::unique_ptr<LimitStep<double>>& limit = _limits[index(level)];
        if (!limit) {
            limit = std::make_unique<LimitStep<double>>(_topology, level, _levels.Regions(level), 1,
                                                        _options.shading.limits.normals);
        }
        return *limit;
    }

    /// Whether the limits at a face's vertices are the same taken at any level: where the masks are exact, and
    /// there is a tangent plane.
    bool hasExactCorners(int level, int face) {
        CreaseRegions const& regions = _levels.Regions(level);
        Far::ConstIndexArray const vertices = _levels.Level(level).GetFaceVertices(face);
        std::vector<LimitFrame<double>> frames;
        for (int corner = 0; corner < vertices.size(); ++corner) {
            int const v = vertices[corner];
            FindLimitFrames(limitStep(level), v, frames);
            LimitFrame<double> const& frame =
                frames[index(regions.CornerValue(face, corner) - regions.FirstValue(v))];
            if (frame.isAverage) return false;
            if (_options.shading.limits.normals == LimitNormalKind::Exact) continue;
            auto const numFaces = static_cast<int>(frame.fan.faces.size());
            int const lastExactFan = _topology.IsCatmark() ? 2 : 3;
            VertexKind const kind = regions.Kind(v);
            if (kind == VertexKind::Dart || (kind == VertexKind::Smooth && numFaces == 2) ||
                (kind == VertexKind::Crease && numFaces > lastExactFan)) {
                return false;
            }
        }
        return true;
    }

    void compile(int level, int face, std::uint32_t node) {
        // As large as can be, where nothing changes any more.
        bool const isNgonMesh = level == 0 && _topology.HasIrregularFaces(0);
        bool isSettled = level == _lastLevel;
        if (!isSettled && !isNgonMesh && StaysAsItIs(_levels, level, face, _lastLevel - level)) {
            isSettled = usesOne()                ? level >= _options.shading.startNormals.level
                        : hasWeight(level, face) ? isSeeded(level, face)
                                                 : true;
        }
        if (isSettled) {
            std::vector<FaceCorner> inputs;
            LimitClass const& found = _limitClasses.Find(_levels, level, face, inputs);
            if (found.IsRegular() || level == _lastLevel || hasExactCorners(level, face)) {
                if (!found.IsRegular()) {
                    _made->patches->nodes[node].corners = static_cast<std::int32_t>(_corners.size());
                    _corners.push_back({level, face});
                }
                std::vector<std::uint32_t> const lines = linesOf(level, inputs);
                _pending.push_back({node, &found, lines});
                return;
            }
        }
        Far::ConstIndexArray const children = _levels.Level(level).GetFaceChildFaces(face);
        std::vector<std::uint32_t> const nodes = newNodes(children.size());
        _made->patches->nodes[node].kind = FaceNode::Kind::Split;
        _made->patches->nodes[node].first = nodes[0];
        for (int i = 0; i < children.size(); ++i) compile(level + 1, children[i], nodes[index(i)]);
        updateSplit(node);
    }

    void updateSplit(std::uint32_t node) {
        FaceNode& split = _made->patches->nodes[node];
        for (std::uint32_t i = 0; i < 4; ++i) split.hasWeight |= _made->patches->nodes[split.first + i].hasWeight;
    }

    /// The first lines of values of a level; each is made once.
    std::uint32_t lineOf(int level, FaceCorner const& at) {
        int const value = _levels.ValueAt(level, at);
        auto const [found, isNew] =
            _lineOfValue.emplace(std::make_pair(level, value), static_cast<std::uint32_t>(_firstLines.size()));
        if (isNew) _firstLines.push_back({level, value, tables::VertexAt(_levels.Level(level), at)});
        return found->second;
    }
    std::vector<std::uint32_t> linesOf(int level, std::vector<FaceCorner> const& at) {
        std::vector<std::uint32_t> lines;
        lines.reserve(at.size());
        for (FaceCorner const& corner : at) lines.push_back(lineOf(level, corner));
        return lines;
    }
    /// Of a vertex's first value: good for its position.
    std::uint32_t lineOfVertex(int level, int vertex) {
        return lineOf(level, {_levels.Level(level).GetVertexFaces(vertex)[0],
                              _levels.Level(level).GetVertexFaceLocalIndices(vertex)[0]});
    }

    /// Rows of the first lines from the cut-out's vertices, and from the values of the start level.
    void makeFirstLines() {
        for (auto const& [level, face] : _corners) makeCorners(level, face);
        std::size_t const count = _firstLines.size();
        std::vector<std::vector<std::size_t>> linesOfLevel(index(_lastLevel) + 1);
        for (std::size_t i = 0; i < count; ++i) linesOfLevel[index(_firstLines[i].level)].push_back(i);

        std::vector<std::vector<std::pair<int, double>>> positions(count), normals(count);
        int const startLevel = _options.shading.startNormals.level;
        std::map<int, int> sourceOfValue;
        for (int level = 0; level <= _lastLevel; ++level) {
            std::vector<std::size_t> const& lines = linesOfLevel[index(level)];
            if (lines.empty()) continue;
            std::vector<std::pair<int, int>> vertices, values;
            for (std::size_t const i : lines) {
                vertices.emplace_back(_firstLines[i].vertex, _firstLines[i].vertex);
                values.emplace_back(_firstLines[i].value, _firstLines[i].vertex);
            }
            std::sort(vertices.begin(), vertices.end());
            vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
            {
                tables::NeededRows const needed(_levels, tables::ElementKind::Vertex, 0, level, vertices);
                tables::FlatRows const rows = tables::ComposeRows(needed);
                for (std::size_t const i : lines) {
                    auto const row = index(needed.IndexOf(level, _firstLines[i].vertex));
                    for (std::size_t t = rows.offsets[row]; t < rows.offsets[row + 1]; ++t) {
                        positions[i].emplace_back(needed.Level(0).elements[index(rows.sources[t])],
                                                  rows.weights[t]);
                    }
                }
            }
            if (!_hasWeights || level < startLevel) continue;
            tables::NeededRows const needed(_levels, tables::ElementKind::Value, startLevel, level, values);
            tables::FlatRows const rows = tables::ComposeRows(needed);
            for (std::size_t const i : lines) {
                auto const row = index(needed.IndexOf(level, _firstLines[i].value));
                for (std::size_t t = rows.offsets[row]; t < rows.offsets[row + 1]; ++t) {
                    int const value = needed.Level(startLevel).elements[index(rows.sources[t])];
                    auto const [found, isNew] =
                        sourceOfValue.emplace(value, static_cast<int>(_made->normalSources.size()));
                    if (isNew) _made->normalSources.push_back(value);
                    normals[i].emplace_back(found->second, rows.weights[t]);
                }
            }
        }
        auto const flatten = [](auto const& rowsOfLines, tables::FlatRows& rows) {
            for (auto const& row : rowsOfLines) {
                for (auto const& [source, weight] : row) {
                    rows.sources.push_back(source);
                    rows.weights.push_back(weight);
                }
                rows.offsets.push_back(rows.sources.size());
            }
        };
        flatten(positions, _made->positionRows);
        if (_hasWeights) flatten(normals, _made->normalRows);
        for (FirstLine const& line : _firstLines) _made->weights.push_back(weightOf(line.level, line.value));
        if (_hasWeights) makeStart(startLevel);
    }

    void makeStart(int startLevel) {
        _made->start.reset(new StartMesh{
            RefinedTopology(_mesh.Mesh(_options.rules), startLevel), CreaseRegions(_topology, startLevel, 1), {}});
        for (int level = 1; level <= startLevel; ++level) {
            _made->start->masks.push_back(_made->start->topology.RecordMasks<double>(level));
        }
    }

    void makeCorners(int level, int face) {
        LimitStep<double> const& limit = limitStep(level);
        std::vector<FaceCorner> const grid = tables::FindFaceGrid(_topology, level, face, level);
        tables::TangentRows tangents(_levels, limit, level, grid);
        bool const isCatmark = _topology.IsCatmark();
        int const places[4][2] = {{0, 0}, {0, 1}, {1, isCatmark ? 1 : 0}, {1, 0}};
        for (int corner = 0; corner < (isCatmark ? 4 : 3); ++corner) {
            int const row = places[corner][0], column = places[corner][1];
            FaceCorner const at = grid[index(2 * row + column)];
            int const vertex = tables::VertexAt(_levels.Level(level), at), value = _levels.ValueAt(level, at);
            FaceCornerRows made;
            made.vertexLine = lineOf(level, at);
            std::map<std::uint32_t, FaceCornerRows::Term> terms;
            auto const term = [&](std::uint32_t line) -> FaceCornerRows::Term& {
                return terms.emplace(line, FaceCornerRows::Term{line, 0, 0, 0}).first->second;
            };
            std::vector<std::pair<int, double>> limits;
            limit.AppendTerms(vertex, value, limits);
            for (auto const& [source, weight] : limits) term(lineOfValue(level, source)).limit += weight;
            LimitFrame<double> const frame = tangents.Find(row, column);
            made.isAverage = frame.isAverage;
            for (std::size_t i = 0; i < frame.vertices.size(); ++i) {
                FaceCornerRows::Term& t = term(lineOfVertex(level, frame.vertices[i]));
                t.tangent1 += frame.tangent1[i];
                t.tangent2 += frame.tangent2[i];
            }
            for (auto const& [line, t] : terms) made.terms.push_back(t);
            // Its faces: also where tangents turn out to be degenerate.
            for (std::size_t i = 0; i < frame.fan.faces.size(); ++i) {
                Far::ConstIndexArray const vertices = _levels.Level(level).GetFaceVertices(frame.fan.faces[i]);
                made.faces.emplace_back();
                for (int j = 0; j < vertices.size(); ++j) {
                    made.faces.back().push_back(
                        lineOfVertex(level, vertices[(frame.fan.corners[i] + j) % vertices.size()]));
                }
            }
            _made->corners.push_back(std::move(made));
        }
    }

    std::uint32_t lineOfValue(int level, int value) {
        auto const known = _lineOfValue.find({level, value});
        if (known != _lineOfValue.end()) return known->second;
        std::vector<int> const& first = _levels.Regions(level).FirstValues();
        int const vertex =
            static_cast<int>(std::upper_bound(first.begin(), first.end(), value) - first.begin() - 1);
        Far::ConstIndexArray const faces = _levels.Level(level).GetVertexFaces(vertex);
        Far::ConstLocalIndexArray const corners = _levels.Level(level).GetVertexFaceLocalIndices(vertex);
        for (int i = 0; i < faces.size(); ++i) {
            if (_levels.ValueAt(level, {faces[i], corners[i]}) == value)
                return lineOf(level, {faces[i], corners[i]});
        }
        assert(false);
        return 0;
    }

    /// Rows follow the first lines: so they are numbered when all of those are known.
    void finishRows() {
        for (Pending const& pending : _pending) expand(pending.node, *pending.limitClass, pending.lines, 0);
        // Each face has its own 4 corners (3 in Loop).
        int next = 0;
        for (FaceNode& node : _made->patches->nodes) {
            if (node.corners < 0) continue;
            next = node.corners * (_topology.IsCatmark() ? 4 : 3);
            node.corners = next;
        }
        for (std::size_t i = _made->patches->nodes.size(); i-- > 0;) {
            if (_made->patches->nodes[i].kind == FaceNode::Kind::Split) updateSplit(static_cast<std::uint32_t>(i));
        }
    }

    std::uint32_t addRow(LineRows const& rows, int row, std::vector<std::uint32_t> const& lines) {
        double weight = 0;
        for (std::uint32_t t = rows.offsets[index(row)]; t < rows.offsets[index(row) + 1]; ++t) {
            std::uint32_t const line = lines[rows.sources[t]];
            _made->rows.Add(line, rows.weights[t]);
            weight += rows.weights[t] * _made->weights[line];
        }
        _made->rows.EndRow();
        _made->weights.push_back(weight);
        return static_cast<std::uint32_t>(_made->weights.size() - 1);
    }

    void expand(std::uint32_t node, LimitClass const& limitClass, std::vector<std::uint32_t> lines, int depth) {
        bool const isDeep = !limitClass.IsRegular() && depth == kKeptLevels;
        if (isDeep || limitClass.IsRegular()) {
            FaceNode& leaf = _made->patches->nodes[node];
            leaf.kind = isDeep ? FaceNode::Kind::Deep : FaceNode::Kind::Patch;
            leaf.limitClass = isDeep ? &limitClass : nullptr;
            leaf.phantoms = limitClass.phantoms;
            if (!isDeep) {
                for (int row = 0; row < limitClass.rows.NumRows(); ++row) {
                    lines.push_back(addRow(limitClass.rows, row, lines));
                }
                std::vector<std::uint32_t> points;
                for (std::uint32_t const i : limitClass.patch) points.push_back(lines[i]);
                lines.swap(points);
            }
            leaf.first = static_cast<std::uint32_t>(_made->patches->indices.size());
            for (std::uint32_t const line : lines) {
                _made->patches->indices.push_back(line);
                leaf.hasWeight |= _made->weights[line] != 0;
            }
            return;
        }
        for (int row = 0; row < limitClass.rows.NumRows(); ++row) {
            lines.push_back(addRow(limitClass.rows, row, lines));
        }
        std::vector<std::uint32_t> const children = newNodes(4);
        _made->patches->nodes[node].kind = FaceNode::Kind::Split;
        _made->patches->nodes[node].first = children[0];
        for (std::size_t i = 0; i < 4; ++i) {
            LimitClass::Child const& child = limitClass.children[i];
            std::vector<std::uint32_t> inputs;
            for (std::uint32_t const input : child.inputs) inputs.push_back(lines[input]);
            expand(children[i], *child.limitClass, std::move(inputs), depth + 1);
        }
    }

    struct FirstLine {
        int level, value, vertex;
    };
    struct Pending {
        std::uint32_t node;
        LimitClass const* limitClass;
        std::vector<std::uint32_t> lines;
    };

    FaceClassOptions const& _options;
    int _lastLevel;
    LimitClasses& _limitClasses;
    tables::TileRing const& _mesh;
    RefinedTopology _topology;
    RegionLevels _levels;
    std::vector<std::unique_ptr<LimitStep<double>>> _limits;  // by level
    WeightHistory<double> _history;
    std::vector<bool> _isChanged;  // by its levels
    bool _hasWeights = false;
    std::vector<FirstLine> _firstLines;
    std::map<std::pair<int, int>, std::uint32_t> _lineOfValue;  // by level and value
    std::vector<Pending> _pending;
    std::vector<std::pair<int, int>> _corners;  // level and face of irregular faces of the last level
    std::unique_ptr<FaceClass> _made;
};

}  // namespace

int NumRingsOf(FaceClassOptions const& options) {
    ShadingOptions const& shading = options.shading;
    bool const isWide =
        (shading.startNormals.level == 0 && shading.startNormals.kind == StartNormalKind::LimitSmoothed) ||
        (shading.weights.level == 0 && shading.weights.scheme != WeightScheme::One) ||
        shading.weights.scheme == WeightScheme::ExtraordinaryOnly;
    // By Chaikin's rule how an edge fades depends on all edges at both its ends.
    bool const isChaikin = options.rules.creasing == Sdc::Options::CREASE_CHAIKIN;
    return 2 + (isWide ? 1 : 0) + (isChaikin ? 1 : 0);
}

std::unique_ptr<FaceClass> MakeFaceClass(FaceClassOptions const& options, tables::TileRing const& cutOut,
                                         LimitClasses& limitClasses) {
    return FaceCompiler(options, cutOut, limitClasses).Compile();
}

}  // namespace surface
}  // namespace v1
}  // namespace osd_shading
