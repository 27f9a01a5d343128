// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/io/faceSharpness.h"

#include "osd_shading/io/errors.h"

namespace osd_shading {
inline namespace v1 {
namespace io {

void FaceSharpness::readValues(LineScanner& line, std::int64_t numFaces) {
    std::size_t const first = _values.size();
    for (auto word = line.NextWord(); !word.empty(); word = line.NextWord()) {
        _values.push_back(line.Sharpness(word, "fs and as take one sharpness per edge of the face"));
    }
    _lines.push_back({line.Line(), numFaces, first, _values.size()});
}

void FaceSharpness::ReadFaceLine(LineScanner& line) { readValues(line, 1); }

void FaceSharpness::ReadRepeatedLine(LineScanner& line) {
    auto const word = line.NextWord();
    if (word.empty()) line.Fail("as has neither count nor values: write as COUNT SHARPNESS..");
    std::int64_t const count = line.Integer(word, "as takes the number of faces first");
    if (count < 1) line.Fail("as has the count " + Quote(word) + ": it takes the number of faces, 1 or more");
    std::size_t const first = _values.size();
    readValues(line, count);
    if (_values.size() == first) line.Fail("as has a count but no values: write as COUNT SHARPNESS..");
}

void FaceSharpness::AddTo(Model& model, std::string const& fileName) const {
    std::int64_t const numFaces = model.NumFaces();
    std::int64_t face = 0;
    std::size_t firstCorner = 0;
    for (Line const& line : _lines) {
        if (line.numFaces > numFaces - face) {
            throw ParseError(fileName, line.number,
                             "fs and as lines stand for more faces than the " + std::to_string(numFaces) +
                                 " of the model: remove them, or check that they belong to this model");
        }
        for (std::int64_t const end = face + line.numFaces; face < end; ++face) {
            auto const size = static_cast<std::size_t>(model.faceSizes[static_cast<std::size_t>(face)]);
            int const* const vertices = model.faceVertices.data() + firstCorner;
            firstCorner += size;
            for (std::size_t i = line.firstValue; i < line.endValue; ++i) {
                if (!(_values[i] > 0)) continue;
                std::size_t const edge = i - line.firstValue;
                if (edge >= size) {
                    throw ParseError(fileName, line.number,
                                     "sharpness number " + std::to_string(edge + 1) + " is not 0, but face " +
                                         std::to_string(face) + " (from 0) has only " + std::to_string(size) +
                                         " edges: remove it, or check the order of the lines");
                }
                model.creaseVertices.push_back(vertices[(edge + size - 2) % size]);
                model.creaseVertices.push_back(vertices[(edge + size - 1) % size]);
                model.creaseSharpness.push_back(_values[i]);
            }
        }
    }
}

}  // namespace io
}  // namespace v1
}  // namespace osd_shading
