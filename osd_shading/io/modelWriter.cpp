// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/io/modelWriter.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "osd_shading/io/fileReplacement.h"
#include "osd_shading/io/textWriter.h"

namespace osd_shading {
inline namespace v1 {
namespace io {

namespace {

using Options = Sdc::Options;

void addRows(TextWriter& text, std::string_view word, std::vector<double> const& numbers, std::size_t width) {
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        if (i % width == 0) text.Add(word);
        text.Add(' ', numbers[i]);
        if (i % width == width - 1) text.Add('\n');
    }
}

void addFaces(TextWriter& text, Model const& model) {
    std::size_t corner = 0;
    for (int size : model.faceSizes) {
        text.Add('f');
        for (int i = 0; i < size; ++i, ++corner) {
            int const uv = model.uvIndices.empty() ? -1 : model.uvIndices[corner];
            int const normal = model.normalIndices.empty() ? -1 : model.normalIndices[corner];
            text.Add(' ', model.faceVertices[corner] + 1);
            if (uv >= 0 || normal >= 0) text.Add('/');
            if (uv >= 0) text.Add(uv + 1);
            if (normal >= 0) text.Add('/', normal + 1);
        }
        text.Add('\n');
    }
}

// The tag of an option that has a value.
template <typename Enum, typename Word, std::size_t N>
void addOption(TextWriter& text, std::string_view tag, std::optional<Enum> const& value,
               std::array<std::pair<Enum, Word>, N> const& words) {
    for (auto const& [candidate, word] : words) {
        if (value == candidate) text.Add("t ", tag, ' ', word, '\n');
    }
}

void addTags(TextWriter& text, Model const& model) {
    using Text = std::string_view;
    static constexpr std::array<std::pair<Options::VtxBoundaryInterpolation, Text>, 3> kBoundaries = {
        {{Options::VTX_BOUNDARY_NONE, "1/0/0 0"},
         {Options::VTX_BOUNDARY_EDGE_AND_CORNER, "1/0/0 1"},
         {Options::VTX_BOUNDARY_EDGE_ONLY, "1/0/0 2"}}};
    static constexpr std::array<std::pair<Options::FVarLinearInterpolation, Text>, 6> kFaceVarying = {
        {{Options::FVAR_LINEAR_NONE, "1/0/0 0"},
         {Options::FVAR_LINEAR_CORNERS_ONLY, "1/0/0 1"},
         {Options::FVAR_LINEAR_CORNERS_PLUS1, "1/0/0 2"},
         {Options::FVAR_LINEAR_CORNERS_PLUS2, "1/0/0 3"},
         {Options::FVAR_LINEAR_BOUNDARIES, "1/0/0 4"},
         {Options::FVAR_LINEAR_ALL, "1/0/0 5"}}};
    static constexpr std::array<std::pair<Options::CreasingMethod, Text>, 2> kCreasing = {
        {{Options::CREASE_UNIFORM, "0/0/1 normal"}, {Options::CREASE_CHAIKIN, "0/0/1 chaikin"}}};
    static constexpr std::array<std::pair<Options::TriangleSubdivision, Text>, 2> kTriangles = {
        {{Options::TRI_SUB_CATMARK, "0/0/1 catmark"}, {Options::TRI_SUB_SMOOTH, "0/0/1 smooth"}}};
    addOption(text, "interpolateboundary", model.boundary, kBoundaries);
    addOption(text, "facevaryinginterpolateboundary", model.faceVarying, kFaceVarying);
    addOption(text, "creasemethod", model.creasing, kCreasing);
    addOption(text, "smoothtriangles", model.triangles, kTriangles);

    for (std::size_t i = 0; i < model.creaseSharpness.size(); ++i) {
        text.Add("t crease 2/1/0 ", model.creaseVertices[2 * i], ' ', model.creaseVertices[2 * i + 1], ' ',
                 model.creaseSharpness[i], '\n');
    }
    for (std::size_t i = 0; i < model.cornerSharpness.size(); ++i) {
        text.Add("t corner 1/1/0 ", model.cornerVertices[i], ' ', model.cornerSharpness[i], '\n');
    }
    for (int face : model.holes) text.Add("t hole 1/0/0 ", face, '\n');
}

}  // namespace

void WriteModel(std::string const& path, Model const& model) {
    FileReplacement file(path);
    TextWriter text(file);
    text.Add("# osd_shading: control mesh of ", model.NumVertices(), " vertices, ", model.NumFaces(), " faces\n");
    addRows(text, "v", model.positions, 3);
    addRows(text, "vt", model.uvs, 2);
    addRows(text, "vn", model.normals, 3);
    addFaces(text, model);
    addTags(text, model);
    file.Commit();
}

void WriteSharpFile(std::string const& path, Model const& model) {
    std::map<std::pair<int, int>, float> sharpness;
    for (std::size_t i = 0; i < model.creaseSharpness.size(); ++i) {
        auto const [low, high] = std::minmax(model.creaseVertices[2 * i], model.creaseVertices[2 * i + 1]);
        float& highest = sharpness[{low, high}];
        highest = std::max(highest, model.creaseSharpness[i]);
    }

    FileReplacement file(path);
    TextWriter text(file);
    std::size_t first = 0;
    for (int faceSize : model.faceSizes) {
        auto const size = static_cast<std::size_t>(faceSize);
        text.Add("fs");
        // The first number belongs to the edge that ends in the last vertex.
        for (std::size_t i = 0; i < size; ++i) {
            auto const [low, high] = std::minmax(model.faceVertices[first + (i + size - 2) % size],
                                                 model.faceVertices[first + (i + size - 1) % size]);
            auto const found = sharpness.find({low, high});
            text.Add(' ', found == sharpness.end() ? 0.0F : found->second);
        }
        text.Add('\n');
        first += size;
    }
    file.Commit();
}

}  // namespace io
}  // namespace v1
}  // namespace osd_shading
