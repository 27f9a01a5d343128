// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/io/sharpReader.h"

#include <utility>

#include "osd_shading/io/errors.h"
#include "osd_shading/io/faceSharpness.h"
#include "osd_shading/io/lineScanner.h"
#include "osd_shading/io/textFile.h"

namespace osd_shading {
inline namespace v1 {
namespace io {

void ApplySharpText(std::string_view text, std::string const& fileName, Model& model) {
    LineScanner line(text, fileName);
    FaceSharpness sharpness;
    std::string warning;
    while (line.NextLine()) {
        auto const word = line.NextWord();
        if (word == "fs") {
            sharpness.ReadFaceLine(line);
        } else if (word == "as") {
            sharpness.ReadRepeatedLine(line);
        } else if (warning.empty()) {
            warning = line.Locate("skipped, and all lines like it: a .sharp file has no " + Quote(word) + " lines");
        }
    }
    if (sharpness.Empty() && !warning.empty()) {
        throw ParseError(fileName, 0, "has no fs or as line: it is no .sharp file");
    }

    // Build the new entries beside the old ones: an error must leave the model as it was.
    auto oldVertices = std::exchange(model.creaseVertices, {});
    auto oldSharpness = std::exchange(model.creaseSharpness, {});
    try {
        sharpness.AddTo(model, fileName);
        if (!warning.empty()) model.warnings.push_back(warning);
    } catch (...) {
        model.creaseVertices = std::move(oldVertices);
        model.creaseSharpness = std::move(oldSharpness);
        throw;
    }
}

void ApplySharpFile(std::string const& path, Model& model) { ApplySharpText(ReadTextFile(path), path, model); }

}  // namespace io
}  // namespace v1
}  // namespace osd_shading
