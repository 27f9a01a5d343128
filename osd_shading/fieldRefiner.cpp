// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/fieldRefiner.h"

#include <algorithm>
#include <memory>

#include "osd_shading/parallel.h"
#include "osd_shading/vectorMath.h"

namespace osd_shading {
inline namespace v1 {

template <typename Real>
template <typename T>
void ValueRows<Real>::Apply(std::vector<T> const& field, std::vector<T>& result, ValueMarks const& marks,
                            int numThreads) const {
    ParallelFor(static_cast<int>(targets.size()), numThreads, [&](int begin, int end, int) {
        for (auto row = static_cast<std::size_t>(begin); row < static_cast<std::size_t>(end); ++row) {
            auto const target = static_cast<std::size_t>(targets[row]);
            if (!marks.empty() && !marks[target]) continue;
            T sum{};
            for (std::size_t t = offsets[row]; t < offsets[row + 1]; ++t) {
                sum += weights[t] * field[static_cast<std::size_t>(values[t])];
            }
            result[target] = sum;
        }
    });
}

template <typename Real>
void ValueRows<Real>::MarkSources(ValueMarks const& marks, ValueMarks& sources) const {
    for (std::size_t row = 0; row < targets.size(); ++row) {
        if (!marks[static_cast<std::size_t>(targets[row])]) continue;
        for (std::size_t t = offsets[row]; t < offsets[row + 1]; ++t) {
            sources[static_cast<std::size_t>(values[t])] = 1;
        }
    }
}

template <typename Real>
void ValueRows<Real>::AppendTerms(int target, std::vector<std::pair<int, Real>>& terms) const {
    auto const found = std::lower_bound(targets.begin(), targets.end(), target);
    auto const row = static_cast<std::size_t>(found - targets.begin());
    for (std::size_t t = offsets[row]; t < offsets[row + 1]; ++t) terms.emplace_back(values[t], weights[t]);
}

template <typename Real>
RegionRule<Real>::RegionRule(Far::TopologyLevel const& level, CreaseRegions const& regions)
    : _level(level),
      _regions(regions),
      _slotOfVertex(static_cast<std::size_t>(regions.NumVertices()), -1),
      _slotOfValue(static_cast<std::size_t>(regions.NumValues()), -1) {}

template <typename Real>
void RegionRule<Real>::Clear() {
    for (int const v : _vertices) _slotOfVertex[static_cast<std::size_t>(v)] = -1;
    _vertices.clear();
    _weights.clear();
}

template <typename Real>
void RegionRule<Real>::AddVertex(int vertex, Real weight) {
    int& slot = _slotOfVertex[static_cast<std::size_t>(vertex)];
    if (slot < 0) {
        slot = static_cast<int>(_vertices.size());
        _vertices.push_back(vertex);
        _weights.push_back(0);
    }
    _weights[static_cast<std::size_t>(slot)] += weight;
}

template <typename Real>
void RegionRule<Real>::AddFace(int face, Real weight) {
    Far::ConstIndexArray const vertices = _level.GetFaceVertices(face);
    Real const share = weight / static_cast<Real>(vertices.size());
    for (int const v : vertices) AddVertex(v, share);
}

template <typename Real>
void RegionRule<Real>::AppendRow(int target, std::vector<int>& faces, ValueRows<Real>& rows) {
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());

    // Find the corners of F at vertices of the mask.
    _counts.assign(_vertices.size(), 0);
    _found.clear();
    for (int const face : faces) {
        Far::ConstIndexArray const vertices = _level.GetFaceVertices(face);
        int const* const values = _regions.FaceValues(face);
        for (int i = 0; i < vertices.size(); ++i) {
            int const slot = _slotOfVertex[static_cast<std::size_t>(vertices[i])];
            if (slot < 0) continue;
            ++_counts[static_cast<std::size_t>(slot)];
            _found.emplace_back(slot, values[i]);
        }
    }
    // Sharp edges of a child are sharp in its parent, so F holds every vertex; where it does not (a reading of a
    // non-manifold mesh that OpenSubdiv may change), all regions of the vertex stand in, so that weights add to
    // one.
    for (std::size_t slot = 0; slot < _vertices.size(); ++slot) {
        if (_counts[slot] > 0) continue;
        int const first = _regions.FirstValue(_vertices[slot]), count = _regions.NumVertexValues(_vertices[slot]);
        for (int i = 0; i < count; ++i) _found.emplace_back(static_cast<int>(slot), first + i);
        _counts[slot] = count;
    }

    // Share each weight among them, one term per value.
    std::size_t const begin = rows.values.size();
    for (auto const& [slot, value] : _found) {
        Real const share =
            _weights[static_cast<std::size_t>(slot)] / static_cast<Real>(_counts[static_cast<std::size_t>(slot)]);
        int& term = _slotOfValue[static_cast<std::size_t>(value)];
        if (term < 0) {
            term = static_cast<int>(rows.values.size());
            rows.values.push_back(value);
            rows.weights.push_back(share);
        } else {
            rows.weights[static_cast<std::size_t>(term)] += share;
        }
    }
    for (std::size_t i = begin; i < rows.values.size(); ++i) {
        _slotOfValue[static_cast<std::size_t>(rows.values[i])] = -1;
    }
    rows.targets.push_back(target);
    rows.offsets.push_back(rows.values.size());
}

template <typename Real>
FieldStep<Real>::FieldStep(RefinedTopology const& topology, int childLevel, LevelMasks<Real> const& masks,
                           CreaseRegions const& parent, CreaseRegions const& child, int numThreads)
    : _topology(&topology), _childLevel(childLevel), _masks(&masks), _parent(&parent), _child(&child) {
    Far::TopologyLevel const& parentLevel = topology.Level(childLevel - 1);
    Far::TopologyLevel const& level = topology.Level(childLevel);
    int const numVertices = level.GetNumVertices(), firstFaceChild = topology.FirstFaceChild(childLevel - 1);
    bool const parentIsPlain = parent.HasOneValuePerVertex();

    // Find the vertices whose mask meets a vertex with several regions, or none.
    std::vector<std::vector<int>> specialOfChunk(static_cast<std::size_t>(NumChunks(numVertices)));
    ParallelFor(numVertices, numThreads, [&](int begin, int end, int chunk) {
        for (int c = begin; c < end; ++c) {
            bool isPlain = child.NumVertexValues(c) == 1;
            auto const row = static_cast<std::size_t>(masks.Row(c));
            if (isPlain && !parentIsPlain) {
                for (int t = masks.offsets[row]; isPlain && t < masks.offsets[row + 1]; ++t) {
                    int const term = masks.terms[static_cast<std::size_t>(t)];
                    isPlain =
                        term >= 0 ? parent.NumVertexValues(term) == 1 : parent.IsPlainFace(~term - firstFaceChild);
                }
            }
            if (!isPlain) specialOfChunk[static_cast<std::size_t>(chunk)].push_back(c);
        }
    });

    // Give those their own rows, one for each region.
    std::unique_ptr<RegionRule<Real>> rule;
    std::vector<std::vector<int>> facesOfRegion;
    for (std::vector<int> const& special : specialOfChunk) {
        if (special.empty()) continue;
        if (!rule) {
            rule = std::make_unique<RegionRule<Real>>(parentLevel, parent);
            _isSpecial.assign(static_cast<std::size_t>(numVertices), 0);
        }
        for (int const c : special) {
            _isSpecial[static_cast<std::size_t>(c)] = 1;
            if (child.NumVertexValues(c) == 0) continue;
            rule->Clear();
            auto const row = static_cast<std::size_t>(masks.Row(c));
            for (int t = masks.offsets[row]; t < masks.offsets[row + 1]; ++t) {
                int const term = masks.terms[static_cast<std::size_t>(t)];
                Real const weight = masks.weights[static_cast<std::size_t>(t)];
                if (term >= 0) {
                    rule->AddVertex(term, weight);
                } else {
                    rule->AddFace(~term - firstFaceChild, weight);
                }
            }
            FindRegionFaces(level, child, c, facesOfRegion);
            for (int i = 0; i < child.NumVertexValues(c); ++i) {
                std::vector<int>& faces = facesOfRegion[static_cast<std::size_t>(i)];
                for (int& face : faces) face = level.GetFaceParentFace(face);
                rule->AppendRow(child.FirstValue(c) + i, faces, _special);
            }
        }
    }
}

template <typename Real>
template <typename T>
T FieldStep<Real>::sumOfMask(int childVertex, std::vector<T> const& parentField,
                             std::vector<T> const& childField) const {
    auto const row = static_cast<std::size_t>(_masks->Row(childVertex));
    int const* const terms = _masks->terms.data();
    Real const* const weights = _masks->weights.data();
    T sum{};
    for (int t = _masks->offsets[row]; t < _masks->offsets[row + 1]; ++t) {
        T const& source = terms[t] >= 0 ? parentField[static_cast<std::size_t>(_parent->FirstValue(terms[t]))]
                                        : childField[static_cast<std::size_t>(_child->FirstValue(~terms[t]))];
        sum += weights[t] * source;
    }
    return sum;
}

template <typename Real>
template <typename T>
void FieldStep<Real>::Apply(std::vector<T> const& parentField, std::vector<T>& childField, ValueMarks const& marks,
                            int numThreads) const {
    auto const isNeeded = [&](int value) { return marks.empty() || marks[static_cast<std::size_t>(value)]; };
    _special.Apply(parentField, childField, marks, numThreads);
    auto const applyTo = [&](int first, int last) {
        ParallelFor(last - first, numThreads, [&](int begin, int end, int) {
            for (int c = first + begin; c < first + end; ++c) {
                if (!_isSpecial.empty() && _isSpecial[static_cast<std::size_t>(c)]) continue;
                int const value = _child->FirstValue(c);
                if (!isNeeded(value)) continue;
                childField[static_cast<std::size_t>(value)] = sumOfMask(c, parentField, childField);
            }
        });
    };
    // The face points first: other masks refer to them.
    int const numFaceChildren = _masks->numFaceChildren;
    int const firstFaceChild = _topology->FirstFaceChild(_childLevel - 1);
    applyTo(firstFaceChild, firstFaceChild + numFaceChildren);
    applyTo(0, firstFaceChild);
    applyTo(firstFaceChild + numFaceChildren, _child->NumVertices());
}

template <typename Real>
void FieldStep<Real>::MarkSources(ValueMarks& childMarks, ValueMarks& parentMarks) const {
    parentMarks.assign(static_cast<std::size_t>(_parent->NumValues()), 0);
    _special.MarkSources(childMarks, parentMarks);
    auto const markFor = [&](int first, int last) {
        for (int c = first; c < last; ++c) {
            if (!_isSpecial.empty() && _isSpecial[static_cast<std::size_t>(c)]) continue;
            if (!childMarks[static_cast<std::size_t>(_child->FirstValue(c))]) continue;
            auto const row = static_cast<std::size_t>(_masks->Row(c));
            for (int t = _masks->offsets[row]; t < _masks->offsets[row + 1]; ++t) {
                int const term = _masks->terms[static_cast<std::size_t>(t)];
                if (term >= 0) {
                    parentMarks[static_cast<std::size_t>(_parent->FirstValue(term))] = 1;
                } else {
                    childMarks[static_cast<std::size_t>(_child->FirstValue(~term))] = 1;
                }
            }
        }
    };
    // The face points last: other masks refer to them.
    int const numFaceChildren = _masks->numFaceChildren;
    int const firstFaceChild = _topology->FirstFaceChild(_childLevel - 1);
    markFor(0, firstFaceChild);
    markFor(firstFaceChild + numFaceChildren, _child->NumVertices());
    markFor(firstFaceChild, firstFaceChild + numFaceChildren);
}

template <typename Real>
void FieldStep<Real>::AppendTerms(int childVertex, int childValue, std::vector<std::pair<int, Real>>& terms) const {
    if (!_isSpecial.empty() && _isSpecial[static_cast<std::size_t>(childVertex)]) {
        _special.AppendTerms(childValue, terms);
        return;
    }
    auto const row = static_cast<std::size_t>(_masks->Row(childVertex));
    int const firstFaceChild = _topology->FirstFaceChild(_childLevel - 1);
    for (int t = _masks->offsets[row]; t < _masks->offsets[row + 1]; ++t) {
        int const term = _masks->terms[static_cast<std::size_t>(t)];
        Real const weight = _masks->weights[static_cast<std::size_t>(t)];
        if (term >= 0) {
            terms.emplace_back(_parent->FirstValue(term), weight);
            continue;
        }
        Far::ConstIndexArray const vertices =
            _topology->Level(_childLevel - 1).GetFaceVertices(~term - firstFaceChild);
        for (int const v : vertices) {
            terms.emplace_back(_parent->FirstValue(v), weight / static_cast<Real>(vertices.size()));
        }
    }
}

template <typename Real>
void FieldStep<Real>::AppendMaskTerms(int childVertex, int childValue,
                                      std::vector<std::pair<int, Real>>& terms) const {
    if (!_isSpecial.empty() && _isSpecial[static_cast<std::size_t>(childVertex)]) {
        _special.AppendTerms(childValue, terms);
        return;
    }
    auto const row = static_cast<std::size_t>(_masks->Row(childVertex));
    for (int t = _masks->offsets[row]; t < _masks->offsets[row + 1]; ++t) {
        int const term = _masks->terms[static_cast<std::size_t>(t)];
        terms.emplace_back(term >= 0 ? _parent->FirstValue(term) : ~_child->FirstValue(~term),
                           _masks->weights[static_cast<std::size_t>(t)]);
    }
}

template <typename Real>
std::vector<Vec3<Real>> RefinePoints(LevelMasks<Real> const& masks, std::vector<Vec3<Real>> const& points,
                                     int numThreads) {
    std::vector<Vec3<Real>> refined(static_cast<std::size_t>(masks.numChildVertices));
    // Rows are in OpenSubdiv's order: the face points, which others refer to, come first.
    auto const vertexOfRow = [&](int row) {
        int const c = row + masks.numParentVertices;
        return c < masks.numChildVertices ? c : c - masks.numChildVertices;
    };
    int const* const terms = masks.terms.data();
    Real const* const weights = masks.weights.data();
    auto const applyTo = [&](int first, int last) {
        ParallelFor(last - first, numThreads, [&](int begin, int end, int) {
            for (int row = first + begin; row < first + end; ++row) {
                Vec3<Real> sum{};
                for (int t = masks.offsets[static_cast<std::size_t>(row)];
                     t < masks.offsets[static_cast<std::size_t>(row) + 1]; ++t) {
                    sum += weights[t] * (terms[t] >= 0 ? points[static_cast<std::size_t>(terms[t])]
                                                       : refined[static_cast<std::size_t>(~terms[t])]);
                }
                refined[static_cast<std::size_t>(vertexOfRow(row))] = sum;
            }
        });
    };
    applyTo(0, masks.numFaceChildren);
    applyTo(masks.numFaceChildren, masks.numChildVertices);
    return refined;
}

template <typename Real>
FieldLevels<Real>::FieldLevels(RefinedTopology const& topology, int firstLevel, int numThreads)
    : _firstLevel(firstLevel) {
    auto const numLevels = static_cast<std::size_t>(topology.LastLevel() - firstLevel + 1);
    // Steps keep references: nothing may move once they are made.
    _regions.reserve(numLevels);
    _masks.reserve(numLevels);
    _steps.reserve(numLevels);
    for (int level = firstLevel; level <= topology.LastLevel(); ++level) {
        _regions.emplace_back(topology, level, numThreads);
        if (level == firstLevel) continue;
        _masks.push_back(topology.RecordMasks<Real>(level));
        _steps.emplace_back(topology, level, _masks.back(), Regions(level - 1), Regions(level), numThreads);
    }
}

#define OSD_SHADING_INSTANTIATE(Real)                                                                            \
    template struct ValueRows<Real>;                                                                             \
    template void ValueRows<Real>::Apply(std::vector<Real> const&, std::vector<Real>&, ValueMarks const&, int)   \
        const;                                                                                                   \
    template void ValueRows<Real>::Apply(std::vector<Vec3<Real>> const&, std::vector<Vec3<Real>>&,               \
                                         ValueMarks const&, int) const;                                          \
    template class RegionRule<Real>;                                                                             \
    template class FieldStep<Real>;                                                                              \
    template class FieldLevels<Real>;                                                                            \
    template std::vector<Vec3<Real>> RefinePoints(LevelMasks<Real> const&, std::vector<Vec3<Real>> const&, int); \
    template void FieldStep<Real>::Apply(std::vector<Real> const&, std::vector<Real>&, ValueMarks const&, int)   \
        const;                                                                                                   \
    template void FieldStep<Real>::Apply(std::vector<Vec3<Real>> const&, std::vector<Vec3<Real>>&,               \
                                         ValueMarks const&, int) const;
OSD_SHADING_INSTANTIATE(float)
OSD_SHADING_INSTANTIATE(double)
#undef OSD_SHADING_INSTANTIATE

}  // namespace v1
}  // namespace osd_shading
