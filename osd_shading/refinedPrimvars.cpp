// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/refinedPrimvars.h"

#include <opensubdiv/far/primvarRefiner.h>

#include <algorithm>
#include <utility>

namespace osd_shading {
inline namespace v1 {

namespace {

/// One element of any width, as OpenSubdiv's primvar refiner wants to see it.
template <typename Real>
struct Element {
    Real* values;
    int width;

    void Clear() { std::fill(values, values + width, Real(0)); }
    template <typename Weight>
    void AddWithWeight(Element const& other, Weight weight) {
        for (int i = 0; i < width; ++i) values[i] += static_cast<Real>(weight) * other.values[i];
    }
};

template <typename Real>
struct Elements {
    std::vector<Real>* values;
    int width;

    Element<Real> operator[](int i) const {
        return {values->data() + static_cast<std::size_t>(i) * static_cast<std::size_t>(width), width};
    }
};

template <typename Real>
std::vector<Real> packed(PrimvarView<Real> const& view) {
    std::vector<Real> values;
    values.reserve(view.size() * static_cast<std::size_t>(view.width()));
    for (std::size_t i = 0; i < view.size(); ++i) values.insert(values.end(), view[i], view[i] + view.width());
    return values;
}

/// Refines level by level with `interpolate(level, source, target)`, then takes the limit with `limit(source,
/// target)`.
template <typename Real, typename CountOf, typename Interpolate, typename Limit>
std::vector<Real> refine(RefinedTopology const& topology, PrimvarView<Real> const& control, bool takesLimit,
                         CountOf const& countOf, Interpolate const& interpolate, Limit const& limit) {
    int const width = control.width();
    std::vector<Real> values = packed(control), next;
    for (int level = 1; level <= topology.LastLevel(); ++level) {
        next.assign(static_cast<std::size_t>(countOf(level)) * static_cast<std::size_t>(width), 0);
        Elements<Real> const source{&values, width};
        Elements<Real> target{&next, width};
        interpolate(level, source, target);
        values.swap(next);
    }
    if (takesLimit) {
        next.assign(values.size(), 0);
        Elements<Real> const source{&values, width};
        Elements<Real> target{&next, width};
        limit(source, target);
        values.swap(next);
    }
    return values;
}

}  // namespace

template <typename Real>
RefinedPrimvar<Real> RefineVertexData(RefinedTopology const& topology, PrimvarView<Real> const& control,
                                      PositionKind positions) {
    Far::PrimvarRefinerReal<Real> const refiner(topology.Refiner());
    return {control.width(),
            refine(
                topology, control, positions == PositionKind::Limit,
                [&](int level) { return topology.Level(level).GetNumVertices(); },
                [&](int level, auto const& source, auto& target) { refiner.Interpolate(level, source, target); },
                [&](auto const& source, auto& target) { refiner.Limit(source, target); })};
}

template <typename Real>
RefinedFaceVarying<Real> RefineFaceVaryingData(RefinedTopology const& topology, int channel,
                                               PrimvarView<Real> const& control, PositionKind positions) {
    Far::PrimvarRefinerReal<Real> const refiner(topology.Refiner());
    RefinedFaceVarying<Real> refined;
    refined.width = control.width();
    refined.values = refine(
        topology, control, positions == PositionKind::Limit && HasFaceVaryingLimit(topology),
        [&](int level) { return topology.Level(level).GetNumFVarValues(channel); },
        [&](int level, auto const& source, auto& target) {
            refiner.InterpolateFaceVarying(level, source, target, channel);
        },
        [&](auto const& source, auto& target) { refiner.LimitFaceVarying(source, target, channel); });

    Far::TopologyLevel const& last = topology.Level(topology.LastLevel());
    for (int f = 0; f < last.GetNumFaces(); ++f) {
        if (last.IsFaceHole(f)) continue;
        Far::ConstIndexArray const indices = last.GetFaceFVarValues(f, channel);
        refined.faceIndices.insert(refined.faceIndices.end(), indices.begin(), indices.begin() + indices.size());
    }
    return refined;
}

#define OSD_SHADING_INSTANTIATE(Real)                                                                              \
    template RefinedPrimvar<Real> RefineVertexData(RefinedTopology const&, PrimvarView<Real> const&,               \
                                                   PositionKind);                                                  \
    template RefinedFaceVarying<Real> RefineFaceVaryingData(RefinedTopology const&, int, PrimvarView<Real> const&, \
                                                            PositionKind);
OSD_SHADING_INSTANTIATE(float)
OSD_SHADING_INSTANTIATE(double)
#undef OSD_SHADING_INSTANTIATE

}  // namespace v1
}  // namespace osd_shading
