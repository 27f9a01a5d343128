// SPDX-License-Identifier: Apache-2.0
#pragma once

/// \file
/// Not needed by ordinary clients: OpenSubdiv's `t` lines, a part of the OBJ reader.

#include <cstdint>
#include <string>
#include <vector>

#include "osd_shading/io/lineScanner.h"
#include "osd_shading/io/model.h"

namespace osd_shading {
inline namespace v1 {
namespace io {

/// The lines that crease, corner and hole entries come from: they may stand before the elements that they name, so
/// their indices are checked at the end of the file.
struct TaggedElements {
    std::vector<std::int64_t> creaseLines;  ///< per crease entry of the model, as the next two
    std::vector<std::int64_t> cornerLines;
    std::vector<std::int64_t> holeLines;

    void AddCrease(Model& model, int from, int to, float sharpness, std::int64_t line);
    void AddCorner(Model& model, int vertex, float sharpness, std::int64_t line);
    void AddHole(Model& model, int face, std::int64_t line);

    bool hasEdit = false;        ///< hierarchical edits were reported
    bool hasUnknownTag = false;  ///< a tag that OpenSubdiv does not have was reported
};

/// Reads the rest of a line whose first word was `t`: `NAME ints/floats/strings`, then as many values of each.
///
/// One number for a crease or corner counts for all its edges or vertices.     ERRORS: ParseError
void ReadObjTag(LineScanner& line, Model& model, TaggedElements& tagged);

/// Throws ParseError for the first tag whose vertex or face the complete `model` does not have.
void CheckTagIndices(Model const& model, TaggedElements const& tagged, std::string const& fileName);

}  // namespace io
}  // namespace v1
}  // namespace osd_shading
