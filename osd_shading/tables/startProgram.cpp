// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/tables/startProgram.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "osd_shading/limitMasks.h"
#include "osd_shading/startNormals.h"

namespace osd_shading {
inline namespace v1 {
namespace tables {

namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

}  // namespace

int StartBuilder::Use(int value) {
    int& normal = _normalOfValue[index(value)];
    if (normal < 0) normal = _program.numNormals++;
    return normal;
}

void StartBuilder::Finish() {
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

/// The points of faces of the start level, and what they are refined from.
void StartBuilder::addPoints(std::vector<int> const& faces) {
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
        for (auto t = index(m.offsets[row]); t < index(m.offsets[row + 1]); ++t) visit(m.terms[t], m.weights[t]);
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
                    _program.pointSources.push_back(term >= 0 ? pointOfParent[index(term)] : point[index(~term)]);
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

std::vector<int> MakeLimitStart(RefinedTopology const& topology, RegionLevels& levels,
                                ShadingOptions const& options, StartProgram& program) {
    int const level = options.startNormals.level;
    ShadingOptions own;
    own.level = level;
    own.startNormals.level = own.weights.level = std::min(1, level);
    own.execution.numThreads = options.execution.numThreads;
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

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
