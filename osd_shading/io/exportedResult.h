// SPDX-License-Identifier: Apache-2.0
#pragma once

/// \file
/// Not needed by ordinary clients: what the writers ask of a result.

#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <type_traits>

#include "osd_shading/io/errors.h"
#include "osd_shading/shadingResult.h"

namespace osd_shading {
inline namespace v1 {
namespace io {

/// The UVs of a result: its first face-varying primvar of two numbers; null when it has none.
template <typename Real>
RefinedFaceVarying<Real> const* FindUvs(ShadingResult<Real> const& result) {
    for (auto const& primvar : result.faceVaryingData) {
        if (primvar.width == 2) return &primvar;
    }
    return nullptr;
}

/// Whether `value` fits the 32-bit numbers of some formats; what is not finite does, as itself.
inline bool FitsFloat(double value) {
    return !std::isfinite(value) || std::abs(value) <= double{std::numeric_limits<float>::max()};
}

/// Throws WriteError: "PATH: ... NAME INDEX is too large".
[[noreturn]] inline void FailTooLarge(std::string const& path, std::string const& name, std::size_t index) {
    throw WriteError(path,
                     name + ' ' + std::to_string(index) +
                         " is too large for the 32-bit numbers of this format: scale the model, or write OBJ");
}

/// Throws WriteError unless all positions and UVs of `result` fit 32-bit numbers. Normals and weights always do.
template <typename Real>
void CheckFitsFloat(std::string const& path, ShadingResult<Real> const& result) {
    if constexpr (std::is_same_v<Real, double>) {
        for (std::size_t i = 0; i < result.positions.size(); ++i) {
            auto const& point = result.positions[i];
            bool const fits = FitsFloat(point.x) && FitsFloat(point.y) && FitsFloat(point.z);
            if (!fits) FailTooLarge(path, "the position of vertex", i);
        }
        if (auto const* const uvs = FindUvs(result)) {
            for (std::size_t i = 0; i < uvs->values.size(); ++i) {
                if (!FitsFloat(uvs->values[i])) FailTooLarge(path, "UV", i / 2);
            }
        }
    }
}

}  // namespace io
}  // namespace v1
}  // namespace osd_shading
