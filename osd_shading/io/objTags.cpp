// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/io/objTags.h"

#include <array>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "osd_shading/io/errors.h"

namespace osd_shading {
inline namespace v1 {
namespace io {

namespace {

using Options = Sdc::Options;

constexpr std::string_view kTagForm = "a tag is t NAME ints/floats/strings and as many values of each";

struct Tag {
    std::string name;
    std::vector<std::int64_t> ints;
    std::vector<float> sharpness;
    std::vector<std::string_view> strings;
};

std::string_view nextValue(LineScanner& line, std::string const& name) {
    auto const word = line.NextWord();
    if (word.empty()) {
        line.Fail("tag " + name + " has fewer values than its counts say: " + std::string(kTagForm));
    }
    return word;
}

std::array<std::int64_t, 3> readCounts(LineScanner& line, std::string const& name) {
    auto const word = line.NextWord();
    std::array<std::int64_t, 3> counts{};
    char const* at = word.data();
    char const* const end = at + word.size();
    for (std::size_t i = 0; i < 3; ++i) {
        char const* const next = ParseInteger(at, end, counts[i]);
        bool const isLast = i == 2;
        if (next == at || counts[i] < 0 || (isLast ? next != end : next == end || *next != '/')) {
            line.Fail("tag " + name + " has no counts but " + Quote(word) + ": " + std::string(kTagForm));
        }
        at = isLast ? next : next + 1;
    }
    return counts;
}

// All floats of the tags that are read are sharpness.
Tag readTag(LineScanner& line, std::string const& name) {
    Tag tag{name, {}, {}, {}};
    auto const counts = readCounts(line, name);
    // The counts are only what the file says: no memory is reserved for them.
    for (auto i = counts[0]; i > 0; --i) tag.ints.push_back(line.Integer(nextValue(line, name), kTagForm));
    for (auto i = counts[1]; i > 0; --i) tag.sharpness.push_back(line.Sharpness(nextValue(line, name), kTagForm));
    for (auto i = counts[2]; i > 0; --i) tag.strings.push_back(nextValue(line, name));
    if (!line.NextWord().empty()) {
        line.Fail("tag " + name + " has more values than its counts say: " + std::string(kTagForm));
    }
    return tag;
}

int toIndex(LineScanner const& line, std::int64_t value, std::string const& name) {
    if (value < 0 || value > std::numeric_limits<int>::max()) {
        line.Fail("tag " + name + " has the index " + std::to_string(value) + ": indices of tags count from 0");
    }
    return static_cast<int>(value);
}

// One number counts for all; otherwise there must be one per element. OpenSubdiv's own reader takes the number of
// edge i at place 2i, so one number per vertex of the pairs is accepted too.
float sharpnessOf(LineScanner const& line, Tag const& tag, std::size_t element, std::size_t numElements) {
    std::size_t const count = tag.sharpness.size();
    if (count == 1) return tag.sharpness[0];
    if (count == numElements) return tag.sharpness[element];
    if (tag.name == "crease" && count == tag.ints.size()) return tag.sharpness[2 * element];
    line.Fail("tag " + tag.name + " has " + std::to_string(count) + " numbers for " + std::to_string(numElements) +
              " elements: give one for all, or one for each");
}

// The enumerator for what the tag's one value says, out of (value, enumerator) pairs.
template <typename Value, typename Enum, std::size_t N>
Enum choose(LineScanner const& line, Tag const& tag, std::vector<Value> const& values,
            std::array<std::pair<Value, Enum>, N> const& choices, std::string_view allowed) {
    if (values.size() == 1) {
        for (auto const& [value, result] : choices) {
            if (value == values[0]) return result;
        }
    }
    line.Fail("tag " + tag.name + " takes one value: " + std::string(allowed));
}

// One warning stands for all its kind: the first line tells where to look.
void warnOnce(LineScanner const& line, Model& model, bool& isReported, std::string const& text) {
    if (!std::exchange(isReported, true)) model.warnings.push_back(line.Locate(text));
}

template <typename Value, typename Enum>
using Choice = std::pair<Value, Enum>;

constexpr std::array<Choice<std::int64_t, Options::VtxBoundaryInterpolation>, 3> kBoundaries = {
    {{0, Options::VTX_BOUNDARY_NONE},
     {1, Options::VTX_BOUNDARY_EDGE_AND_CORNER},
     {2, Options::VTX_BOUNDARY_EDGE_ONLY}}};

constexpr std::array<Choice<std::int64_t, Options::FVarLinearInterpolation>, 6> kFaceVarying = {
    {{0, Options::FVAR_LINEAR_NONE},
     {1, Options::FVAR_LINEAR_CORNERS_ONLY},
     {2, Options::FVAR_LINEAR_CORNERS_PLUS1},
     {3, Options::FVAR_LINEAR_CORNERS_PLUS2},
     {4, Options::FVAR_LINEAR_BOUNDARIES},
     {5, Options::FVAR_LINEAR_ALL}}};

constexpr std::array<Choice<std::string_view, Options::CreasingMethod>, 2> kCreasing = {
    {{"normal", Options::CREASE_UNIFORM}, {"chaikin", Options::CREASE_CHAIKIN}}};

constexpr std::array<Choice<std::string_view, Options::TriangleSubdivision>, 2> kTriangles = {
    {{"catmark", Options::TRI_SUB_CATMARK}, {"smooth", Options::TRI_SUB_SMOOTH}}};

}  // namespace

void TaggedElements::AddCrease(Model& model, int from, int to, float sharpness, std::int64_t line) {
    model.creaseVertices.insert(model.creaseVertices.end(), {from, to});
    model.creaseSharpness.push_back(sharpness);
    creaseLines.push_back(line);
}

void TaggedElements::AddCorner(Model& model, int vertex, float sharpness, std::int64_t line) {
    model.cornerVertices.push_back(vertex);
    model.cornerSharpness.push_back(sharpness);
    cornerLines.push_back(line);
}

void TaggedElements::AddHole(Model& model, int face, std::int64_t line) {
    model.holes.push_back(face);
    holeLines.push_back(line);
}

void ReadObjTag(LineScanner& line, Model& model, TaggedElements& tagged) {
    std::string const name(line.NextWord());
    if (name.empty()) line.Fail("the tag has no name: " + std::string(kTagForm));

    if (name == "crease") {
        Tag const tag = readTag(line, name);
        if (tag.ints.size() % 2 != 0) line.Fail("tag crease has an odd number of vertices: an edge has two");
        std::size_t const numEdges = tag.ints.size() / 2;
        for (std::size_t i = 0; i < numEdges; ++i) {
            int const from = toIndex(line, tag.ints[2 * i], name), to = toIndex(line, tag.ints[2 * i + 1], name);
            tagged.AddCrease(model, from, to, sharpnessOf(line, tag, i, numEdges), line.Line());
        }
    } else if (name == "corner") {
        Tag const tag = readTag(line, name);
        for (std::size_t i = 0; i < tag.ints.size(); ++i) {
            int const vertex = toIndex(line, tag.ints[i], name);
            tagged.AddCorner(model, vertex, sharpnessOf(line, tag, i, tag.ints.size()), line.Line());
        }
    } else if (name == "hole") {
        for (auto const face : readTag(line, name).ints) {
            tagged.AddHole(model, toIndex(line, face, name), line.Line());
        }
    } else if (name == "interpolateboundary") {
        Tag const tag = readTag(line, name);
        model.boundary = choose(line, tag, tag.ints, kBoundaries, "0 (none), 1 (edge and corner) or 2 (edge only)");
    } else if (name == "facevaryinginterpolateboundary") {
        Tag const tag = readTag(line, name);
        model.faceVarying = choose(line, tag, tag.ints, kFaceVarying,
                                   "0 (none), 1 (corners only), 2 (corners plus 1), 3 (corners plus 2), 4 "
                                   "(boundaries) or 5 (all)");
    } else if (name == "creasemethod") {
        Tag const tag = readTag(line, name);
        model.creasing = choose(line, tag, tag.strings, kCreasing, "normal or chaikin");
    } else if (name == "smoothtriangles") {
        Tag const tag = readTag(line, name);
        model.triangles = choose(line, tag, tag.strings, kTriangles, "catmark or smooth");
    } else if (name == "vertexedit" || name == "edgeedit" || name == "faceedit") {
        warnOnce(line, model, tagged.hasEdit, "ignored, as all hierarchical edits: " + Quote(name));
    } else {
        warnOnce(line, model, tagged.hasUnknownTag, "ignored, as all unknown tags: " + Quote(name));
    }
}

void CheckTagIndices(Model const& model, TaggedElements const& tagged, std::string const& fileName) {
    auto const check = [&](int index, int count, std::int64_t line, char const* kind) {
        if (index < count) return;
        throw ParseError(fileName, line,
                         std::string("no ") + kind + " has the index " + std::to_string(index) +
                             " (counted from 0): the file has " + std::to_string(count));
    };
    for (std::size_t i = 0; i < model.creaseVertices.size(); ++i) {
        check(model.creaseVertices[i], model.NumVertices(), tagged.creaseLines[i / 2], "vertex");
    }
    for (std::size_t i = 0; i < model.cornerVertices.size(); ++i) {
        check(model.cornerVertices[i], model.NumVertices(), tagged.cornerLines[i], "vertex");
    }
    for (std::size_t i = 0; i < model.holes.size(); ++i) {
        check(model.holes[i], model.NumFaces(), tagged.holeLines[i], "face");
    }
}

}  // namespace io
}  // namespace v1
}  // namespace osd_shading
