// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <cstdint>
#include <string>

#include "osd_shading/errors.h"
#include "osd_shading/tables/tileDictionary.h"

namespace osd_shading {
inline namespace v1 {
namespace tables {

/// `i` as the dictionary keeps indices; throws MemoryLimitExceeded where it is too large for that.
inline std::uint16_t LocalIndex(std::size_t i) {
    if (i > 65535) {
        throw MemoryLimitExceeded(
            "a face's neighbourhood has more than 65535 points: tables take memory with the square of a vertex's "
            "number of faces; use ShadeSubdivision for this mesh",
            std::uint64_t{65536} * 65536 * sizeof(int));
    }
    return static_cast<std::uint16_t>(i);
}
inline std::uint16_t LocalIndex(int i) { return LocalIndex(static_cast<std::size_t>(i)); }

inline void AppendTerm(LocalRows& rows, std::size_t source, double weight) {
    rows.sources.push_back(LocalIndex(source));
    rows.weights.push_back(static_cast<float>(weight));
}
inline void EndRow(LocalRows& rows) { rows.offsets.push_back(static_cast<std::uint32_t>(rows.sources.size())); }

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
