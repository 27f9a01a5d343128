// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/surface/faceClass.h"

#include <algorithm>
#include <cassert>
#include <map>
#include <utility>

#include "osd_shading/surface/cutOutLevels.h"
#include "osd_shading/tables/faceGrid.h"
#include "osd_shading/tables/tangentRows.h"

namespace osd_shading {
inline namespace v1 {
namespace surface {

namespace {

/// How many levels below an irregular face its patches are kept; what is nearer to the vertex, 1 in 4^this of it,
/// is refined when it is asked for.
constexpr int kKeptLevels = 4;

/// How many levels are refined before what is settled by then is left out.
constexpr int kLevelsOfCut = 2;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

class FaceCompiler {
public:
    FaceCompiler(FaceClassOptions const& options, tables::TileRing const& cutOut, LimitClasses& limitClasses)
        : _options(options), _limitClasses(limitClasses), _mesh(cutOut) {}

    std::unique_ptr<FaceClass> Compile() {
        // The first levels whole; then, some at a time, of what is not settled alone.
        ShadingOptions const& shading = _options.shading;
        int const first = std::max(shading.startNormals.level, shading.weights.level) + kLevelsOfCut;
        if (!compileLevels(std::min(first, shading.level))) compileLevels(shading.level);
        finishNormals();
        finishRows();
        return std::move(_made);
    }

private:
    /// A face of the last level of a cut-out that is not settled.
    struct Unsettled {
        std::uint32_t node;
        int face;
    };

    /// Begins with levels down to `last`; false where what is not settled there can't be cut out.
    bool compileLevels(int last) {
        _made = std::make_unique<FaceClass>();
        _firstLines.clear();
        _pending.clear();
        _unsettled.clear();
        auto levels = std::make_unique<CutOutLevels>(_options, _mesh, last);
        begin(*levels);
        compileRoots();
        makeFirstLines();
        while (!_unsettled.empty()) {
            std::vector<Unsettled> const above = std::exchange(_unsettled, {});
            std::vector<int> faces, facesHere;
            for (Unsettled const& left : above) faces.push_back(left.face);
            if (!levels->CanBeCut(faces)) return false;
            last = std::min(last + kLevelsOfCut, _options.shading.level);
            levels = std::make_unique<CutOutLevels>(*levels, faces, NumRingsOf(_options), last, facesHere);
            begin(*levels);
            for (std::size_t i = 0; i < above.size(); ++i) compile(0, facesHere[i], above[i].node);
            makeFirstLines();
        }
        return true;
    }

    void begin(CutOutLevels& levels) {
        _levels = &levels;
        _numLinesBefore = _firstLines.size();
        _numCornersBefore = _made->corners.size();
        _lineOfValue.clear();
        _corners.clear();
    }

    void compileRoots() {
        _made->isCatmark = _levels->Topology().IsCatmark();
        bool const isNgon = _made->isCatmark && _levels->Level(0).GetFaceVertices(_mesh.tileFace).size() != 4;
        if (!isNgon) {
            _made->patches->roots = newNodes(1);
            compile(0, _mesh.tileFace, _made->patches->roots[0]);
            return;
        }
        Far::ConstIndexArray const children = _levels->Level(0).GetFaceChildFaces(_mesh.tileFace);
        std::vector<std::uint32_t> const roots = newNodes(children.size());
        for (int i = 0; i < children.size(); ++i) compile(1, children[i], roots[index(i)]);
        _made->patches->roots = roots;
    }

    std::vector<std::uint32_t> newNodes(int count) {
        std::vector<std::uint32_t> numbers;
        for (int i = 0; i < count; ++i) {
            numbers.push_back(static_cast<std::uint32_t>(_made->patches->nodes.size()));
            _made->patches->nodes.emplace_back();
        }
        return numbers;
    }

    void compile(int level, int face, std::uint32_t node) {
        // As large as can be, where nothing changes any more.
        bool const isLast = level == _levels->LastLevel() && _levels->NumLevelsBelow() == 0;
        if (level == _levels->LastLevel() && !isLast) {
            _unsettled.push_back({node, face});
            return;
        }
        if (isLast || _levels->IsSettled(level, face)) {
            std::vector<FaceCorner> inputs;
            LimitClass const& found = _limitClasses.Find(_levels->Levels(), level, face, inputs);
            if (found.IsRegular() || isLast || _levels->HasExactCorners(level, face)) {
                if (!found.IsRegular()) {
                    int const before = static_cast<int>(_numCornersBefore);
                    _made->patches->nodes[node].corners =
                        before + static_cast<std::int32_t>(_corners.size()) * numCorners();
                    _corners.push_back({level, face});
                }
                std::vector<std::uint32_t> const lines = linesOf(level, inputs);
                _pending.push_back({node, &found, lines});
                return;
            }
        }
        Far::ConstIndexArray const children = _levels->Level(level).GetFaceChildFaces(face);
        std::vector<std::uint32_t> const nodes = newNodes(children.size());
        _made->patches->nodes[node].kind = FaceNode::Kind::Split;
        _made->patches->nodes[node].first = nodes[0];
        for (int i = 0; i < children.size(); ++i) compile(level + 1, children[i], nodes[index(i)]);
    }
    int numCorners() const { return _made->isCatmark ? 4 : 3; }

    void updateSplit(std::uint32_t node) {
        FaceNode& split = _made->patches->nodes[node];
        for (std::uint32_t i = 0; i < 4; ++i) split.hasWeight |= _made->patches->nodes[split.first + i].hasWeight;
    }

    /// The first lines of values of a level; each is made once.
    std::uint32_t lineOf(int level, FaceCorner const& at) {
        int const value = _levels->Levels().ValueAt(level, at);
        auto const [found, isNew] =
            _lineOfValue.emplace(std::make_pair(level, value), static_cast<std::uint32_t>(_firstLines.size()));
        if (isNew) _firstLines.push_back({level, value, tables::VertexAt(_levels->Level(level), at)});
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
        return lineOf(level, {_levels->Level(level).GetVertexFaces(vertex)[0],
                              _levels->Level(level).GetVertexFaceLocalIndices(vertex)[0]});
    }

    /// The first lines that these levels add, in order: rows from the cut-out's vertices, and from the values of
    /// the start level.
    void makeFirstLines() {
        for (auto const& [level, face] : _corners) makeCorners(level, face);
        std::size_t const first = _numLinesBefore, count = _firstLines.size() - first;
        std::vector<std::vector<std::size_t>> linesOfLevel(index(_levels->LastLevel()) + 1);
        for (std::size_t i = 0; i < count; ++i) {
            linesOfLevel[index(_firstLines[first + i].level)].push_back(i);
        }
        tables::FlatRows positions, normals;
        std::vector<std::size_t> positionRow(count), normalRow(count, kNoRow);
        for (int level = 0; level <= _levels->LastLevel(); ++level) {
            std::vector<std::size_t> const& lines = linesOfLevel[index(level)];
            if (lines.empty()) continue;
            std::vector<int> vertices;
            std::vector<std::pair<int, int>> values;
            for (std::size_t const i : lines) {
                FirstLine const& line = _firstLines[first + i];
                positionRow[i] = positions.Size() + vertices.size();
                normalRow[i] = normals.Size() + values.size();
                vertices.push_back(line.vertex);
                values.emplace_back(line.value, line.vertex);
            }
            _levels->AppendPositions(level, vertices, positions);
            if (_levels->HasWeights() && _levels->HasNormals(level)) {
                _levels->AppendNormals(level, values, normals);
            } else {
                for (std::size_t const i : lines) normalRow[i] = kNoRow;
            }
        }
        for (std::size_t i = 0; i < count; ++i) {
            appendRow(positions, positionRow[i], _made->positionRows);
            appendRow(normals, normalRow[i], _made->normalRows);
            _made->weights.push_back(_levels->WeightOf(_firstLines[first + i].level, _firstLines[first + i].value));
        }
    }

    static void appendRow(tables::FlatRows const& from, std::size_t row, tables::FlatRows& to) {
        if (row != kNoRow) {
            auto const at = [&](auto const& array, std::size_t i) {
                return array.begin() + static_cast<std::ptrdiff_t>(from.offsets[i]);
            };
            to.sources.insert(to.sources.end(), at(from.sources, row), at(from.sources, row + 1));
            to.weights.insert(to.weights.end(), at(from.weights, row), at(from.weights, row + 1));
        }
        to.offsets.push_back(to.sources.size());
    }

    /// Numbers the values of the start level that normals are sums of.
    void finishNormals() {
        if (!_made->HasWeights()) return;
        std::map<int, int> sourceOfValue;
        for (int& source : _made->normalRows.sources) {
            auto const [found, isNew] =
                sourceOfValue.emplace(source, static_cast<int>(_made->normalSources.size()));
            if (isNew) _made->normalSources.push_back(source);
            source = found->second;
        }
        int const startLevel = _options.shading.startNormals.level;
        RefinedTopology topology(_mesh.Mesh(_options.rules), startLevel);
        CreaseRegions regions(topology, startLevel, 1);
        _made->start.reset(new StartMesh{std::move(topology), std::move(regions), {}});
        for (int level = 1; level <= startLevel; ++level) {
            _made->start->masks.push_back(_made->start->topology.RecordMasks<double>(level));
        }
    }

    void makeCorners(int level, int face) {
        LimitStep<double> const& limit = _levels->LimitOf(level);
        std::vector<FaceCorner> const grid = tables::FindFaceGrid(_levels->Topology(), level, face, level);
        tables::TangentRows tangents(_levels->Levels(), limit, level, grid);
        int const places[4][2] = {{0, 0}, {0, 1}, {1, _made->isCatmark ? 1 : 0}, {1, 0}};
        for (int corner = 0; corner < numCorners(); ++corner) {
            int const row = places[corner][0], column = places[corner][1];
            FaceCorner const at = grid[index(2 * row + column)];
            int const vertex = tables::VertexAt(_levels->Level(level), at),
                      value = _levels->Levels().ValueAt(level, at);
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
                Far::ConstIndexArray const vertices = _levels->Level(level).GetFaceVertices(frame.fan.faces[i]);
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
        std::vector<int> const& first = _levels->Levels().Regions(level).FirstValues();
        int const vertex =
            static_cast<int>(std::upper_bound(first.begin(), first.end(), value) - first.begin() - 1);
        Far::ConstIndexArray const faces = _levels->Level(level).GetVertexFaces(vertex);
        Far::ConstLocalIndexArray const corners = _levels->Level(level).GetVertexFaceLocalIndices(vertex);
        for (int i = 0; i < faces.size(); ++i) {
            if (_levels->Levels().ValueAt(level, {faces[i], corners[i]}) == value)
                return lineOf(level, {faces[i], corners[i]});
        }
        assert(false);
        return 0;
    }

    /// Rows follow the first lines: so they are numbered when all of those are known.
    void finishRows() {
        for (Pending const& pending : _pending) expand(pending.node, *pending.limitClass, pending.lines, 0);
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

    static constexpr std::size_t kNoRow = ~std::size_t{0};

    FaceClassOptions const& _options;
    LimitClasses& _limitClasses;
    tables::TileRing const& _mesh;
    std::unique_ptr<FaceClass> _made;
    std::vector<Pending> _pending;
    std::vector<FirstLine> _firstLines;
    std::vector<Unsettled> _unsettled;

    // Of the levels that are compiled.
    CutOutLevels* _levels = nullptr;
    std::size_t _numLinesBefore = 0, _numCornersBefore = 0;
    std::map<std::pair<int, int>, std::uint32_t> _lineOfValue;  // by level and value
    std::vector<std::pair<int, int>> _corners;                  // level and face of irregular faces
};

}  // namespace

std::size_t FaceClass::NumBytes() const {
    auto const bytesOf = [](auto const& array) { return array.capacity() * sizeof array[0]; };
    auto const bytesOfRows = [&](auto const& r) {
        return bytesOf(r.offsets) + bytesOf(r.sources) + bytesOf(r.weights);
    };
    std::size_t bytes = sizeof *this + bytesOf(patches->nodes) + bytesOf(patches->indices) +
                        bytesOf(normalSources) + bytesOf(weights) + bytesOf(corners) + bytesOfRows(positionRows) +
                        bytesOfRows(normalRows) + bytesOfRows(rows);
    for (FaceCornerRows const& corner : corners) {
        bytes += bytesOf(corner.terms);
        for (std::vector<std::uint32_t> const& face : corner.faces) bytes += bytesOf(face);
    }
    return bytes;
}

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
