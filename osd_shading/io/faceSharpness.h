// SPDX-License-Identifier: Apache-2.0
#pragma once

/// \file
/// Not needed by ordinary clients: what the readers of `fs` and `as` lines share.

#include <cstdint>
#include <string>
#include <vector>

#include "osd_shading/io/lineScanner.h"
#include "osd_shading/io/model.h"

namespace osd_shading {
inline namespace v1 {
namespace io {

/// Collects the sharpness lines of [ZBK23]'s tool, and turns them into crease entries when the faces are known.
///
///     fs X..      belongs to the next face v0 v1 .. v(n-1): the first value to its edge (v(n-2), v(n-1)), the
///                 second to (v(n-1), v0), the third to (v0, v1), and so on; missing values are 0
///     as K X..    stands for K such lines
///
/// Faces without a line have 0. The higher value of two faces wins, by the rule for crease entries in Model.
class FaceSharpness {
public:
    /// Reads the rest of a line whose first word was `fs`.     ERRORS: ParseError
    void ReadFaceLine(LineScanner& line);

    /// Reads the rest of a line whose first word was `as`.     ERRORS: ParseError
    void ReadRepeatedLine(LineScanner& line);

    bool Empty() const { return _lines.empty(); }

    /// Appends one crease entry per value above 0 to `model`, whose faces must be complete.
    ///
    /// ERRORS: ParseError for a line beyond the last face, or a value above 0 beyond a face's last edge.
    void AddTo(Model& model, std::string const& fileName) const;

private:
    struct Line {
        std::int64_t number, numFaces;
        std::size_t firstValue, endValue;
    };
    void readValues(LineScanner& line, std::int64_t numFaces);

    std::vector<Line> _lines;
    std::vector<float> _values;
};

}  // namespace io
}  // namespace v1
}  // namespace osd_shading
