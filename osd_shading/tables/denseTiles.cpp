// SPDX-License-Identifier: Apache-2.0

// Tiles that are matrices.

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <memory>
#include <utility>

#include "osd_shading/tables/localRows.h"
#include "osd_shading/tables/tangentRows.h"
#include "osd_shading/tables/tileCompiler.h"

namespace osd_shading {
inline namespace v1 {
namespace tables {

namespace {

/// The largest k of a tile that can't be split into meshes of their own: what a leaf holds.
constexpr int kLargestWhole = 4;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// Numbers some elements in the order in which they are met.
class ElementList {
public:
    explicit ElementList(int numElements) : _isListed(index(numElements), 0) {}

    void Add(int element, int vertex) {
        if (!std::exchange(_isListed[index(element)], 1)) _elements.emplace_back(element, vertex);
    }
    std::vector<std::pair<int, int>> const& Elements() const { return _elements; }

private:
    std::vector<unsigned char> _isListed;
    std::vector<std::pair<int, int>> _elements;
};

void appendTerms(FlatRows& rows, std::vector<std::pair<int, double>> const& terms) {
    for (auto const& [source, weight] : terms) {
        rows.sources.push_back(source);
        rows.weights.push_back(weight);
    }
    rows.offsets.push_back(rows.sources.size());
}

/// Turns what `rows` name, elements of the last level, into indices of the needed.
void useIndices(FlatRows& rows, NeededRows const& needed) {
    for (int& source : rows.sources) source = needed.IndexOf(needed.LastLevel(), source);
}

/// `rows` over the elements that `needed` begins with. Where `rows` have `numTangents` tangents after each
/// position, what is left of a tangent's terms by rounding alone is taken for zero.
FlatRows compose(FlatRows const& rows, FlatRows const& elements, std::size_t numSources, bool hasTangents) {
    constexpr double kNoise = 1e-12;
    RowAdder sum(numSources);
    FlatRows composed;
    for (std::size_t row = 0; row < rows.Size(); ++row) {
        double size = 0;
        for (std::size_t t = rows.offsets[row]; t < rows.offsets[row + 1]; ++t) {
            sum.AddRow(elements, index(rows.sources[t]), rows.weights[t]);
            size += std::fabs(rows.weights[t]);
        }
        std::size_t const first = composed.weights.size();
        sum.MoveTo(composed);
        if (!hasTangents || row % 3 == 0) continue;
        auto const begin = composed.weights.begin() + static_cast<std::ptrdiff_t>(first);
        bool const isNoise =
            std::all_of(begin, composed.weights.end(), [&](double w) { return std::fabs(w) < kNoise * size; });
        if (isNoise) std::fill(begin, composed.weights.end(), 0.0);
    }
    return composed;
}

FaceCorner cornerOfValue(RegionLevels& levels, int levelIndex, int value, int vertex) {
    Far::TopologyLevel const& level = levels.Level(levelIndex);
    Far::ConstIndexArray const faces = level.GetVertexFaces(vertex);
    Far::ConstLocalIndexArray const corners = level.GetVertexFaceLocalIndices(vertex);
    int i = 0;
    while (levels.Regions(levelIndex).CornerValue(faces[i], corners[i]) != value) ++i;
    return {faces[i], corners[i]};
}

/// Renumbers the sources of `rows`, the elements that `needed` begins with, as those elements themselves.
void useElements(FlatRows& rows, NeededRows const& needed) {
    std::vector<int> const& elements = needed.Level(needed.FirstLevel()).elements;
    for (int& source : rows.sources) source = elements[index(source)];
}

}  // namespace

int TileCompiler::addMatrix(int numPoints, int numFields, int numSources, FlatRows const& rows,
                            std::vector<std::uint16_t>& columns) {
    // Columns: the sources that any row names.
    std::vector<int> columnOfSource(index(numSources), -1);
    for (std::size_t t = 0; t < rows.sources.size(); ++t) {
        if (rows.weights[t] != 0) columnOfSource[index(rows.sources[t])] = 0;
    }
    columns.clear();
    int numColumns = 0;
    for (std::size_t source = 0; source < columnOfSource.size(); ++source) {
        if (columnOfSource[source] < 0) continue;
        columnOfSource[source] = numColumns++;
        columns.push_back(LocalIndex(source));
    }

    int const numBlocks = (numPoints + kDenseBlock - 1) / kDenseBlock;
    std::size_t const firstLine = _dictionary.weights.size();
    std::size_t const numLines = index(numBlocks) * index(numColumns) * index(numFields);
    _dictionary.weights.resize(firstLine + numLines, WeightLine{});
    WeightLine* const lines = _dictionary.weights.data() + firstLine;
    for (std::size_t row = 0; row < rows.Size(); ++row) {
        int const point = static_cast<int>(row) / numFields, field = static_cast<int>(row) % numFields;
        for (std::size_t t = rows.offsets[row]; t < rows.offsets[row + 1]; ++t) {
            if (rows.weights[t] == 0) continue;
            int const column = columnOfSource[index(rows.sources[t])];
            lines[((point / kDenseBlock) * numColumns + column) * numFields + field].v[point % kDenseBlock] =
                static_cast<float>(rows.weights[t]);
        }
    }

    // Equal ones are kept once.
    std::uint64_t const hash = HashOf(lines, numLines * sizeof(WeightLine));
    auto const [begin, end] = _matrixOfHash.equal_range(hash);
    for (auto it = begin; it != end; ++it) {
        auto const m = static_cast<std::size_t>(it->second);
        DenseMatrix const& other = _dictionary.matrices[m];
        if (other.numPoints == numPoints && other.numColumns == numColumns && other.numFields == numFields &&
            (numLines == 0 || std::memcmp(_dictionary.weights.data() + _weightOffsets[m], lines,
                                          numLines * sizeof(WeightLine)) == 0)) {
            _dictionary.weights.resize(firstLine);
            return it->second;
        }
    }
    int const matrix = static_cast<int>(_dictionary.matrices.size());
    _weightOffsets.push_back(firstLine);
    _dictionary.matrices.push_back({numPoints, numColumns, numFields, nullptr});
    _matrixOfHash.emplace(hash, matrix);
    return matrix;
}

MadeClass TileCompiler::makeDense(RegionLevels& levels, int tileLevel, int face, int k, int q,
                                  TileOwnership const& own, bool takesAll) {
    RefinedTopology const& topology = levels.Topology();
    int const lastLevel = tileLevel + k, side = 1 << k;
    Far::TopologyLevel const& last = levels.Level(lastLevel);
    CreaseRegions const& regions = levels.Regions(lastLevel);
    LimitStep<double> const limit(topology, lastLevel, regions, 1, _contents.normals);
    std::vector<FaceCorner> const grid = FindFaceGrid(topology, tileLevel, face, lastLevel);
    bool const hasNormals = _contents.hasSubdividedNormals;
    // Normals are refined as points are, where each vertex has just one.
    bool const isAlike = hasNormals && q == 0 && !takesAll && _contents.positions == PositionKind::Limit &&
                         levels.HasOneValuePerVertex(lastLevel);

    MadeClass result;
    TileClass& made = result.tileClass;
    made.kind = TileKind::Dense;
    made.k = static_cast<std::uint8_t>(k);
    made.numNormalLevels = static_cast<std::uint8_t>(q);
    made.numLeaves = 1;
    made.size = static_cast<int>(own.corners.size());

    // The points that it writes, and the rows of each over vertices and values of the last level.
    FlatRows frameRows, normalRows;
    ElementList neededVertices(last.GetNumVertices()), neededValues(regions.NumValues());
    bool const isAverageOnly = _contents.normals == LimitNormalKind::FaceAverage;
    AverageNormals averages;
    if (isAverageOnly) averages.weight = _contents.faceWeight;
    TangentRows tangents(levels, limit, lastLevel, grid);
    std::vector<std::pair<int, double>> terms;
    made.gridPoints.reserve(index((side + 1) * (side + 1)));
    auto const addFrameRow = [&] {
        for (auto const& [vertex, weight] : terms) neededVertices.Add(vertex, vertex);
        appendTerms(frameRows, terms);
        terms.clear();
    };
    for (int row = 0; row <= side; ++row) {
        for (int column = 0; column <= side; ++column) {
            if ((!isCatmark() && row + column > side) || !own.Has(row, column, k, isCatmark())) continue;
            FaceCorner const at = grid[index(row * (side + 1) + column)];
            int const v = VertexAt(last, at);
            if (_contents.positions == PositionKind::Limit) {
                limit.AppendVertexTerms(v, terms);
            } else {
                terms.emplace_back(v, 1.0);
            }
            addFrameRow();
            LimitFrame<double> const& frame = tangents.Find(row, column);
            if (frame.isAverage || isAverageOnly) {
                averages.normals.push_back({made.numPoints, static_cast<int>(averages.faces.size())});
                for (std::size_t i = 0; i < frame.fan.faces.size(); ++i) {
                    Far::ConstIndexArray const vertices = last.GetFaceVertices(frame.fan.faces[i]);
                    AverageFace averaged;
                    averaged.size = vertices.size();
                    averaged.corner = frame.fan.corners[i];
                    for (int j = 0; j < averaged.size && j < 4; ++j) {
                        neededVertices.Add(vertices[j], vertices[j]);
                        averaged.rows[j] = vertices[j];  // numbered below
                    }
                    // A face of other size is met at level 0 only, where limits need quads.
                    assert(averaged.size <= 4);
                    averages.faces.push_back(averaged);
                }
                addFrameRow();
                addFrameRow();
            } else {
                for (auto const* weights : {&frame.tangent1, &frame.tangent2}) {
                    for (std::size_t i = 0; i < frame.vertices.size(); ++i) {
                        terms.emplace_back(frame.vertices[i], (*weights)[i]);
                    }
                    addFrameRow();
                }
            }
            if (hasNormals && !isAlike) {
                limit.AppendTerms(v, levels.ValueAt(lastLevel, at), terms);
                for (auto const& [value, weight] : terms) neededValues.Add(value, -1);
                appendTerms(normalRows, terms);
                terms.clear();
            }
            ++made.numPoints;
            made.gridPoints.push_back(static_cast<std::uint16_t>(row * 32 + column));
        }
    }

    made.gridPoints.shrink_to_fit();

    // Down from the vertices of the tile's own mesh.
    {
        NeededRows const needed(levels, ElementKind::Vertex, 0, lastLevel, neededVertices.Elements());
        NeededLevel const& first = needed.Level(0);
        FlatRows const vertexRows = ComposeRows(needed);
        useIndices(frameRows, needed);
        FlatRows composed = compose(frameRows, vertexRows, first.Size(), true);
        if (isAlike && _contents.needsFields) {
            for (int l = 1; l <= lastLevel; ++l) result.field.stages.push_back(MakeFieldStage(levels, needed, l));
            for (std::size_t row = 0; row < frameRows.Size(); row += 3) {
                for (std::size_t t = frameRows.offsets[row]; t < frameRows.offsets[row + 1]; ++t) {
                    result.field.limits.sources.push_back(frameRows.sources[t]);
                    result.field.limits.weights.push_back(frameRows.weights[t]);
                }
                result.field.limits.offsets.push_back(result.field.limits.sources.size());
            }
        }
        if (takesAll) {
            useElements(composed, needed);
            made.numSources = topology.Level(0).GetNumVertices();
        } else {
            made.numSources = static_cast<int>(first.Size());
            for (int const v : first.elements) result.sources.ringVertices.push_back(LocalIndex(v));
        }
        for (std::size_t row = 0; row < composed.Size(); ++row) {
            if (row % 3 == 0) continue;
            double added = 0;
            for (std::size_t t = composed.offsets[row]; t < composed.offsets[row + 1]; ++t) {
                added += std::fabs(composed.weights[t]);
            }
            float& largest = made.tangentSums[row % 3 - 1];
            largest = std::max(largest, static_cast<float>(added));
        }
        made.frameMatrix = addMatrix(made.numPoints, 3, made.numSources, composed, made.pointIndices);
        if (isAlike) {
            made.normalMatrix = made.frameMatrix;
            made.normalIndices = made.pointIndices;
            made.numNormalSources = made.numSources;
            for (int const v : first.elements) {
                FaceCorner const at = cornerOfValue(levels, 0, v, v);
                result.sources.normalLocators.push_back({{at.face, {}}, at.corner});
            }
        }

        // Points of the faces whose normals are averaged.
        if (!averages.normals.empty()) {
            RowAdder sum(index(made.numSources));
            std::vector<int> rowOfVertex(needed.Level(lastLevel).Size(), -1);
            FlatRows averageRows;
            for (AverageFace& averaged : averages.faces) {
                for (int j = 0; j < averaged.size; ++j) {
                    int const element = needed.IndexOf(lastLevel, averaged.rows[j]);
                    int& row = rowOfVertex[index(element)];
                    if (row < 0) {
                        row = static_cast<int>(averageRows.Size());
                        sum.AddRow(vertexRows, index(element), 1);
                        sum.MoveTo(averageRows);
                    }
                    averaged.rows[j] = row;
                }
            }
            if (takesAll) useElements(averageRows, needed);
            for (std::size_t t = 0; t < averageRows.sources.size(); ++t) {
                averages.sources.push_back(LocalIndex(averageRows.sources[t]));
                averages.weights.push_back(averageRows.weights[t]);
            }
            averages.offsets.assign(averageRows.offsets.begin(), averageRows.offsets.end());
            made.averages = std::make_shared<AverageNormals const>(averages);
        }
    }
    if (!hasNormals || isAlike) return result;

    // Normals: from values of level q.
    std::vector<std::pair<int, int>> lastValues;
    for (auto const& [value, unknown] : neededValues.Elements()) {
        std::vector<int> const& first = regions.FirstValues();
        int const vertex =
            static_cast<int>(std::upper_bound(first.begin(), first.end(), value) - first.begin() - 1);
        lastValues.emplace_back(value, vertex);
    }
    NeededRows const needed(levels, ElementKind::Value, q, lastLevel, lastValues);
    NeededLevel const& first = needed.Level(q);
    useIndices(normalRows, needed);
    FlatRows composed = compose(normalRows, ComposeRows(needed), first.Size(), false);
    if (_contents.needsFields && !takesAll) {
        for (int l = q + 1; l <= lastLevel; ++l) result.field.stages.push_back(MakeFieldStage(levels, needed, l));
        result.field.limits = normalRows;
    }
    if (takesAll) {
        useElements(composed, needed);
        made.numNormalSources = levels.Regions(q).NumValues();
    } else {
        made.numNormalSources = static_cast<int>(first.Size());
        for (std::size_t i = 0; i < first.Size(); ++i) {
            FaceCorner const at = cornerOfValue(levels, q, first.elements[i], first.vertices[i]);
            result.sources.normalLocators.push_back({FindFacePath(topology, q, at.face, 0), at.corner});
        }
    }
    made.normalMatrix = addMatrix(made.numPoints, 1, made.numNormalSources, composed, made.normalIndices);
    return result;
}

MadeClass TileCompiler::makeWhole(RegionLevels& levels, int level, int face, int k, int q,
                                  TileOwnership const& own) {
    bool const isNgon = isCatmark() && own.corners.size() != 4;
    if (k <= kLargestWhole && !isNgon) return makeDense(levels, level, face, k, q, own, true);
    MadeClass result;
    TileClass& made = result.tileClass;
    made.kind = TileKind::Split;
    made.k = static_cast<std::uint8_t>(k);
    made.numNormalLevels = static_cast<std::uint8_t>(q);
    made.isNgon = isNgon;
    made.size = static_cast<int>(own.corners.size());
    made.numSources = levels.Level(0).GetNumVertices();
    made.numNormalSources = _contents.hasSubdividedNormals ? levels.Regions(q).NumValues() : 0;
    Far::ConstIndexArray const childFaces = levels.Level(level).GetFaceChildFaces(face);
    for (int i = 0; i < childFaces.size(); ++i) {
        MadeClass child = makeWhole(levels, level + 1, childFaces[i], k - 1, q, own.OfChild(i, k, isCatmark()));
        made.numPoints += child.tileClass.numPoints;
        made.numLeaves += child.tileClass.numLeaves;
        ChildTile entry;
        for (int j = 0; j < made.numSources; ++j) entry.pointIndices.push_back(LocalIndex(j));
        for (int j = 0; j < made.numNormalSources; ++j) entry.normalIndices.push_back(LocalIndex(j));
        entry.tileClass = addClass(std::move(child));
        made.children.push_back(std::move(entry));
    }
    return result;
}

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
