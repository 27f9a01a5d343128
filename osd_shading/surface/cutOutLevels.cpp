// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/surface/cutOutLevels.h"

#include <algorithm>

#include "osd_shading/surface/cutOut.h"
#include "osd_shading/surface/regionRing.h"

namespace osd_shading {
inline namespace v1 {
namespace surface {

namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// Sums over the elements of a first level, `rows`, as sums over what those are sums of; over themselves where
/// `first` is empty.
void appendComposed(tables::FlatRows const& rows, std::size_t row, std::vector<int> const& elements,
                    tables::FlatRows const& first, tables::RowAdder& sum, tables::FlatRows& composed) {
    if (first.sources.empty()) {
        for (std::size_t t = rows.offsets[row]; t < rows.offsets[row + 1]; ++t) {
            composed.sources.push_back(elements[index(rows.sources[t])]);
            composed.weights.push_back(rows.weights[t]);
        }
        composed.offsets.push_back(composed.sources.size());
        return;
    }
    for (std::size_t t = rows.offsets[row]; t < rows.offsets[row + 1]; ++t) {
        sum.AddRow(first, index(elements[index(rows.sources[t])]), rows.weights[t]);
    }
    sum.MoveTo(composed);
}

std::vector<std::pair<int, int>> sortedOnce(std::vector<std::pair<int, int>> list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    return list;
}

std::size_t numSourcesOf(tables::FlatRows const& rows) {
    return rows.sources.empty() ? 0 : index(*std::max_element(rows.sources.begin(), rows.sources.end())) + 1;
}

}  // namespace

CutOutLevels::CutOutLevels(FaceClassOptions const& options, tables::TileRing const& cutOut, int lastLevel)
    : _options(options),
      _firstLevel(0),
      _ring(cutOut),
      _topology(_ring.Mesh(options.rules), lastLevel),
      _levels(_topology),
      _limits(index(lastLevel) + 1) {
    findWeights(nullptr);
}

CutOutLevels::CutOutLevels(CutOutLevels& above, std::vector<int> const& faces, int numRings, int lastLevel,
                           std::vector<int>& facesHere)
    : _options(above._options),
      _firstLevel(above._firstLevel + above.LastLevel()),
      _ring(FindCutOut(above.Level(above.LastLevel()), faces, numRings)),
      _topology(_ring.Mesh(above._options.rules), lastLevel - _firstLevel),
      _levels(_topology),
      _limits(index(lastLevel - _firstLevel) + 1) {
    facesHere.clear();
    for (int const face : faces) {
        auto const found = std::lower_bound(_ring.faces.begin(), _ring.faces.end(), face);
        facesHere.push_back(static_cast<int>(found - _ring.faces.begin()));
    }

    // What its vertices and values are above. At the rim, where values differ, nothing is taken from.
    int const level = above.LastLevel();
    CreaseRegions const& regions = _levels.Regions(0);
    std::vector<std::pair<int, int>> values(index(regions.NumValues()));
    for (int f = 0; f < Level(0).GetNumFaces(); ++f) {
        Far::ConstIndexArray const corners = Level(0).GetFaceVertices(f);
        for (int i = 0; i < corners.size(); ++i) {
            values[index(regions.CornerValue(f, i))] = {above._levels.ValueAt(level, {_ring.faces[index(f)], i}),
                                                        _ring.vertices[index(corners[i])]};
        }
    }
    above.AppendPositions(level, _ring.vertices, _positionRows);
    above.AppendNormals(level, values, _normalRows);
    std::vector<double> weights;
    weights.reserve(values.size());
    for (auto const& value : values) weights.push_back(above.WeightOf(level, value.first));
    findWeights(&weights);
}

void CutOutLevels::findWeights(std::vector<double> const* given) {
    if (usesOne()) {
        _hasWeights = true;
        return;
    }
    BlendWeightOptions options = _options.shading.weights;
    options.level = firstWeights();
    FieldLevels<double> const levels(_topology, options.level, 1);
    _history = ComputeWeightHistory(options, _topology, levels, {given, NumLevelsBelow()}, 1);
    auto const isSet = [](auto b) { return b != 0; };
    _hasWeights = std::any_of(_history.weights.back().begin(), _history.weights.back().end(), isSet);
    for (ValueMarks const& marks : _history.changed) {
        _isChanged.push_back(std::any_of(marks.begin(), marks.end(), isSet));
    }
}

double CutOutLevels::WeightOf(int level, int value) const {
    if (usesOne()) return 1;
    if (!_hasWeights || level < firstWeights()) return 0;
    return _history.weights[index(level - firstWeights())][index(value)];
}

/// Whether `isIt(value)` of any value of the faces round a face's descendants at level `at`.
template <typename IsIt>
bool CutOutLevels::anyRound(int level, int face, int at, IsIt const& isIt) const {
    if (level < at) {
        Far::ConstIndexArray const children = Level(level).GetFaceChildFaces(face);
        return std::any_of(children.begin(), children.begin() + children.size(),
                           [&](int child) { return anyRound(level + 1, child, at, isIt); });
    }
    CreaseRegions const& regions = _levels.Regions(level);
    for (int const v : Level(level).GetFaceVertices(face)) {
        for (int const around : Level(level).GetVertexFaces(v)) {
            int const* const values = regions.FaceValues(around);
            for (int i = 0; i < Level(level).GetFaceVertices(around).size(); ++i) {
                if (isIt(values[i])) return true;
            }
        }
    }
    return false;
}

bool CutOutLevels::hasWeight(int level, int face) {
    return _hasWeights &&
           anyRound(level, face, LastLevel(), [&](int value) { return WeightOf(LastLevel(), value) != 0; });
}

/// Whether nothing is seeded round a face any more that refining alone does not give. What is seeded further down
/// than the level after its own, at vertices that are not the face's, is too far away.
bool CutOutLevels::isSeeded(int level, int face) {
    if (!HasNormals(level) || level < firstWeights()) return false;
    for (int at = level + 1; at <= LastLevel(); ++at) {
        ValueMarks const& changed = _history.changed[index(at - firstWeights())];
        if (!_isChanged[index(at - firstWeights())]) continue;
        if (anyRound(level, face, at, [&](int value) { return changed[index(value)] != 0; })) return false;
    }
    return true;
}

bool CutOutLevels::IsSettled(int level, int face) {
    bool const isNgonMesh = _firstLevel + level == 0 && _topology.HasIrregularFaces(0);
    if (isNgonMesh || !StaysAsItIs(_levels, level, face, LastLevel() + NumLevelsBelow() - level)) return false;
    if (usesOne()) return HasNormals(level);
    return !hasWeight(level, face) || isSeeded(level, face);
}

LimitStep<double> const& CutOutLevels::LimitOf(int level) {
    std::unique_ptr<LimitStep<double>>& limit = _limits[index(level)];
    if (!limit) {
        limit = std::make_unique<LimitStep<double>>(_topology, level, _levels.Regions(level), 1,
                                                    _options.shading.limits.normals);
    }
    return *limit;
}

bool CutOutLevels::HasExactCorners(int level, int face) {
    CreaseRegions const& regions = _levels.Regions(level);
    Far::ConstIndexArray const vertices = Level(level).GetFaceVertices(face);
    std::vector<LimitFrame<double>> frames;
    for (int corner = 0; corner < vertices.size(); ++corner) {
        int const v = vertices[corner];
        FindLimitFrames(LimitOf(level), v, frames);
        LimitFrame<double> const& frame = frames[index(regions.CornerValue(face, corner) - regions.FirstValue(v))];
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

bool CutOutLevels::CanBeCut(std::vector<int> const& faces) {
    // Round their faces too: there weights are seeded.
    int const level = LastLevel();
    return std::all_of(faces.begin(), faces.end(), [&](int face) {
        Far::ConstIndexArray const corners = Level(level).GetFaceVertices(face);
        return std::all_of(corners.begin(), corners.begin() + corners.size(), [&](int v) {
            Far::ConstIndexArray const around = Level(level).GetVertexFaces(v);
            return std::all_of(around.begin(), around.begin() + around.size(),
                               [&](int f) { return tables::IsRefinedAlike(_levels, level, f); });
        });
    });
}

void CutOutLevels::AppendPositions(int level, std::vector<int> const& vertices, tables::FlatRows& rows) {
    std::vector<std::pair<int, int>> wanted;
    wanted.reserve(vertices.size());
    for (int const v : vertices) wanted.emplace_back(v, v);
    appendRows(tables::ElementKind::Vertex, 0, level, wanted, _positionRows, rows);
}

void CutOutLevels::AppendNormals(int level, std::vector<std::pair<int, int>> const& values,
                                 tables::FlatRows& rows) {
    int const startLevel = std::max(0, _options.shading.startNormals.level - _firstLevel);
    appendRows(tables::ElementKind::Value, startLevel, level, values, _normalRows, rows);
}

/// One row for each of `wanted`, elements with their vertices, over what the elements of `fromLevel` are sums of.
void CutOutLevels::appendRows(tables::ElementKind kind, int fromLevel, int level,
                              std::vector<std::pair<int, int>> const& wanted, tables::FlatRows const& first,
                              tables::FlatRows& rows) {
    tables::NeededRows const needed(_levels, kind, fromLevel, level, sortedOnce(wanted));
    tables::FlatRows const composed = tables::ComposeRows(needed);
    tables::RowAdder sum(numSourcesOf(first));
    for (auto const& element : wanted) {
        appendComposed(composed, index(needed.IndexOf(level, element.first)), needed.Level(fromLevel).elements,
                       first, sum, rows);
    }
}

}  // namespace surface
}  // namespace v1
}  // namespace osd_shading
