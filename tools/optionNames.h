// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>
#include <utility>

#include "deformation.h"
#include "osd_shading/controlMesh.h"
#include "osd_shading/shadingOptions.h"

namespace osd_shading::tool {

// The words of the command line, and of the report, for each choice: one list serves both.

enum class Precision { Float, Double };

template <typename T, std::size_t N>
using OptionNames = std::array<std::pair<std::string_view, T>, N>;

inline constexpr OptionNames<Sdc::SchemeType, 2> kSchemeNames = {
    {{"catmark", Sdc::SCHEME_CATMARK}, {"loop", Sdc::SCHEME_LOOP}}};

inline constexpr OptionNames<SharpVertexWeight, 3> kSharpVertexNames = {
    {{"zero", SharpVertexWeight::Zero},
     {"smooth", SharpVertexWeight::Smooth},
     {"per-region", SharpVertexWeight::PerRegion}}};

inline constexpr OptionNames<DartWeight, 2> kDartNames = {
    {{"smooth", DartWeight::LikeSmooth}, {"sharp", DartWeight::LikeSharp}}};

inline constexpr OptionNames<WeightScheme, 5> kWeightNames = {{{"one-ring", WeightScheme::OneRing},
                                                               {"ev-only", WeightScheme::ExtraordinaryOnly},
                                                               {"bilinear", WeightScheme::Bilinear},
                                                               {"inverse-limit", WeightScheme::InverseLimit},
                                                               {"one", WeightScheme::One}}};

inline constexpr OptionNames<StartNormalKind, 6> kStartNormalNames = {
    {{"uniform", StartNormalKind::Uniform},
     {"corner-area", StartNormalKind::CornerArea},
     {"angle", StartNormalKind::Angle},
     {"limit", StartNormalKind::Limit},
     {"limit-smoothed", StartNormalKind::LimitSmoothed},
     {"file", StartNormalKind::User}}};

inline constexpr OptionNames<NormalAveraging, 3> kAveragingNames = {
    {{"linear", NormalAveraging::Linear},
     {"renormalised", NormalAveraging::Renormalised},
     {"spherical", NormalAveraging::Spherical}}};

inline constexpr OptionNames<LimitNormalKind, 3> kLimitNormalNames = {
    {{"limit", LimitNormalKind::Limit},
     {"face-average", LimitNormalKind::FaceAverage},
     {"exact", LimitNormalKind::Exact}}};

inline constexpr OptionNames<PositionKind, 2> kPositionNames = {
    {{"limit", PositionKind::Limit}, {"refined", PositionKind::Refined}}};

inline constexpr OptionNames<Sdc::Options::VtxBoundaryInterpolation, 3> kBoundaryNames = {
    {{"none", Sdc::Options::VTX_BOUNDARY_NONE},
     {"edge-only", Sdc::Options::VTX_BOUNDARY_EDGE_ONLY},
     {"edge-and-corner", Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER}}};

inline constexpr OptionNames<Sdc::Options::CreasingMethod, 2> kCreasingNames = {
    {{"uniform", Sdc::Options::CREASE_UNIFORM}, {"chaikin", Sdc::Options::CREASE_CHAIKIN}}};

inline constexpr OptionNames<Sdc::Options::TriangleSubdivision, 2> kTriangleNames = {
    {{"catmark", Sdc::Options::TRI_SUB_CATMARK}, {"smooth", Sdc::Options::TRI_SUB_SMOOTH}}};

inline constexpr OptionNames<Precision, 2> kPrecisionNames = {
    {{"float", Precision::Float}, {"double", Precision::Double}}};

inline constexpr OptionNames<DeformationKind, 3> kDeformationNames = {
    {{"bend", DeformationKind::Bend}, {"twist", DeformationKind::Twist}, {"wave", DeformationKind::Wave}}};

/// The word for `value`, or an empty one.
template <typename T, std::size_t N>
constexpr std::string_view NameOf(OptionNames<T, N> const& names, T value) {
    for (auto const& [name, named] : names) {
        if (named == value) return name;
    }
    return {};
}

}  // namespace osd_shading::tool
