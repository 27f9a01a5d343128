// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/io/objReader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <unordered_map>
#include <utility>
#include <vector>

#include "osd_shading/io/errors.h"
#include "osd_shading/io/faceSharpness.h"
#include "osd_shading/io/lineScanner.h"
#include "osd_shading/io/objTags.h"
#include "osd_shading/io/textFile.h"

namespace osd_shading {
inline namespace v1 {
namespace io {

namespace {

constexpr std::int64_t kMostElements = std::numeric_limits<int>::max();

constexpr std::string_view kFaceForms = "f takes v, v/vt, v//vn or v/vt/vn for each corner";

// Words of the OBJ specification that say nothing about a control mesh.
constexpr std::array<std::string_view, 38> kIrrelevantWords = {
    "g",    "o",    "s",      "mg",         "usemtl", "mtllib", "usemap", "maplib",   "vp",       "deg",
    "bmat", "step", "cstype", "curv",       "curv2",  "surf",   "parm",   "trim",     "hole",     "scrv",
    "sp",   "end",  "con",    "bevel",      "lod",    "ctech",  "stech",  "c_interp", "d_interp", "bsp",
    "cdc",  "cdp",  "res",    "shadow_obj", "bzp",    "call",   "csh",    "trace_obj"};

// What an index counts, in the order of a face corner's three.
enum Kind { kVertex, kUv, kNormal };
constexpr std::array<char const*, 3> kKindNames = {"vertex", "vt", "vn"};

// An index that stood before its element; it is checked when all are known.
struct ForwardIndex {
    std::int64_t line;
    int index;
    Kind kind;
};

std::int64_t edgeKey(int a, int b) { return (std::int64_t{std::min(a, b)} << 32) | std::int64_t{std::max(a, b)}; }

class ObjParser {
public:
    ObjParser(std::string_view text, std::string const& fileName) : _line(text, fileName) {
        _model.name = std::filesystem::path(fileName).stem().string();
    }

    Model Parse() {
        while (_line.NextLine()) parseLine(_line.NextWord());
        if (_model.faceSizes.empty()) {
            throw ParseError(_line.FileName(), 0, "has no face (a line that begins with f): it is no OBJ model");
        }
        checkCounts();
        checkForwardIndices();
        CheckTagIndices(_model, _tagged, _line.FileName());
        checkCreases();
        _sharpness.AddTo(_model, _line.FileName());
        return std::move(_model);
    }

private:
    void parseLine(std::string_view word) {
        if (word == "v") {
            readNumbers(_model.positions, 3, 3, "v takes three numbers, x y z");
        } else if (word == "vt") {
            readNumbers(_model.uvs, 1, 2, "vt takes one to three numbers, u v w");
        } else if (word == "vn") {
            readNumbers(_model.normals, 3, 3, "vn takes three numbers, x y z");
        } else if (word == "f") {
            readFace();
        } else if (word == "l") {
            readPolyline();
        } else if (word == "p") {
            readPoints();
        } else if (word == "t") {
            ReadObjTag(_line, _model, _tagged);
        } else if (word == "fs") {
            _sharpness.ReadFaceLine(_line);
        } else if (word == "as") {
            _sharpness.ReadRepeatedLine(_line);
        } else if (word == "OFF") {
            readOffset();
        } else if (!_hasUnknownWord &&
                   std::find(kIrrelevantWords.begin(), kIrrelevantWords.end(), word) == kIrrelevantWords.end()) {
            _hasUnknownWord = true;
            _model.warnings.push_back(
                _line.Locate("skipped, as all lines with an unknown first word: " + Quote(word)));
        }
    }

    // Appends `kept` numbers, those missing past `needed` as 0. All words must be numbers, those kept finite ones.
    void readNumbers(std::vector<double>& values, int needed, int kept, std::string_view what) {
        int count = 0;
        for (auto word = _line.NextWord(); !word.empty(); word = _line.NextWord(), ++count) {
            double const value = _line.Number(word, what);
            if (count >= kept) continue;
            if (!std::isfinite(value)) _line.Fail(Quote(word) + " is not finite: " + std::string(what));
            values.push_back(value);
        }
        if (count < needed) {
            _line.Fail("has only " + std::to_string(count) + " numbers: " + std::string(what));
        }
        for (; count < kept; ++count) values.push_back(0);
    }

    std::int64_t count(Kind kind) const {
        if (kind == kVertex) return static_cast<std::int64_t>(_model.positions.size() / 3);
        return static_cast<std::int64_t>(kind == kUv ? _model.uvs.size() / 2 : _model.normals.size() / 3);
    }

    // Resolves an index as written: from 1 (or 0), or back from the last element so far.
    int resolve(std::int64_t written, Kind kind, std::string_view word) {
        std::int64_t const index = written < 0 ? count(kind) + written : written - _firstIndex;
        if (index < 0 || index >= kMostElements) {
            std::string reason = "no " + std::string(kKindNames[kind]) + " has the index in " + Quote(word);
            if (written < 0) {
                reason += ": it counts back past the first of the " + std::to_string(count(kind)) + " so far";
            } else if (written == 0) {
                reason += ": indices count from 1 (from 0 after a line OFF 0)";
            } else {
                reason += ": it is too large";
            }
            _line.Fail(reason);
        }
        if (index >= count(kind)) _forward.push_back({_line.Line(), static_cast<int>(index), kind});
        return static_cast<int>(index);
    }

    // Reads v, v/vt, v//vn or v/vt/vn; what is not there is -1.
    std::array<int, 3> readCorner(std::string_view word, std::string_view what) {
        std::array<int, 3> corner = {-1, -1, -1};
        char const* at = word.data();
        char const* const end = at + word.size();
        for (Kind const kind : {kVertex, kUv, kNormal}) {
            std::int64_t written = 0;
            char const* const next = ParseInteger(at, end, written);
            if (next != at) {
                corner[kind] = resolve(written, kind, word);
            } else if (kind == kVertex) {
                break;
            }
            at = next;
            if (at == end || *at != '/' || kind == kNormal) break;
            ++at;
        }
        if (at != end || corner[kVertex] < 0) {
            _line.Fail(Quote(word) + " is no index: " + std::string(what));
        }
        return corner;
    }

    // Face-varying indices are kept only from the first one on; corners before it get -1.
    static void addCornerIndex(std::vector<int>& indices, std::size_t corner, int index) {
        if (indices.empty() && index < 0) return;
        indices.resize(corner, -1);
        indices.push_back(index);
    }

    void readFace() {
        std::size_t const first = _model.faceVertices.size();
        for (auto word = _line.NextWord(); !word.empty(); word = _line.NextWord()) {
            auto const corner = readCorner(word, kFaceForms);
            addCornerIndex(_model.uvIndices, _model.faceVertices.size(), corner[kUv]);
            addCornerIndex(_model.normalIndices, _model.faceVertices.size(), corner[kNormal]);
            _model.faceVertices.push_back(corner[kVertex]);
        }
        std::size_t const size = _model.faceVertices.size() - first;
        if (size < 3) {
            _line.Fail("the face has " + std::to_string(size) + " vertices: it takes three or more");
        }
        checkRepeats(first, size);
        _model.faceSizes.push_back(static_cast<int>(size));
        _model.faceLines.push_back(_line.Line());
    }

    void checkRepeats(std::size_t first, std::size_t size) {
        auto const fail = [&](int vertex) {
            _line.Fail("the face has vertex " + std::to_string(vertex + _firstIndex) +
                       " more than once: remove the repetition, or the face");
        };
        int const* const begin = _model.faceVertices.data() + first;
        constexpr std::size_t kFewVertices = 16;  // up to here comparing all pairs is faster than sorting
        if (size <= kFewVertices) {
            for (std::size_t i = 1; i < size; ++i) {
                if (std::find(begin, begin + i, begin[i]) != begin + i) fail(begin[i]);
            }
            return;
        }
        std::vector<int> sorted(begin, begin + size);
        std::sort(sorted.begin(), sorted.end());
        auto const repeated = std::adjacent_find(sorted.begin(), sorted.end());
        if (repeated != sorted.end()) fail(*repeated);
    }

    void readPolyline() {
        int previous = -1;
        int numVertices = 0;
        for (auto word = _line.NextWord(); !word.empty(); word = _line.NextWord(), ++numVertices) {
            int const vertex = readCorner(word, "l takes v or v/vt for each vertex")[kVertex];
            if (numVertices > 0) _tagged.AddCrease(_model, previous, vertex, kInfiniteSharpness, _line.Line());
            previous = vertex;
        }
        if (numVertices < 2) _line.Fail("l has fewer than two vertices: it takes the vertices of a polyline");
    }

    void readPoints() {
        int numPoints = 0;
        for (auto word = _line.NextWord(); !word.empty(); word = _line.NextWord(), ++numPoints) {
            int const vertex = readCorner(word, "p takes vertices")[kVertex];
            _tagged.AddCorner(_model, vertex, kInfiniteSharpness, _line.Line());
        }
        if (numPoints == 0) _line.Fail("p has no vertex: it takes one or more");
    }

    void readOffset() {
        auto const word = _line.NextWord();
        if (word != "0" && word != "1") {
            _line.Fail("OFF takes the index of the first vertex, 0 or 1 (files in the OFF format are not read)");
        }
        _firstIndex = word == "0" ? 0 : 1;
    }

    void checkCounts() const {
        for (Kind const kind : {kVertex, kUv, kNormal}) {
            if (count(kind) > kMostElements) {
                throw ParseError(_line.FileName(), 0,
                                 "has more than 2147483647 " + std::string(kKindNames[kind]) + " lines");
            }
        }
        if (_model.faceVertices.size() > static_cast<std::size_t>(kMostElements)) {
            throw ParseError(_line.FileName(), 0, "has more than 2147483647 face corners");
        }
    }

    void checkForwardIndices() const {
        for (ForwardIndex const& forward : _forward) {
            if (forward.index < count(forward.kind)) continue;
            std::string const name = kKindNames[forward.kind];
            throw ParseError(_line.FileName(), forward.line,
                             "no " + name + " has the index " + std::to_string(std::int64_t{forward.index} + 1) +
                                 " (counted from 1): the file has " + std::to_string(count(forward.kind)));
        }
    }

    // Creases of tags and polylines must be edges of faces; those of fs lines are, by construction.
    void checkCreases() const {
        std::size_t const numCreases = _tagged.creaseLines.size();
        if (numCreases == 0) return;

        // Mark the edges that faces have among those that creases name; look up only where both vertices are in
        // one.
        std::unordered_map<std::int64_t, bool> isEdge;
        std::vector<bool> inCrease(_model.positions.size() / 3);
        isEdge.reserve(numCreases);
        auto const ends = [&](std::size_t crease) {
            return std::pair(_model.creaseVertices[2 * crease], _model.creaseVertices[2 * crease + 1]);
        };
        for (std::size_t i = 0; i < numCreases; ++i) {
            auto const [a, b] = ends(i);
            isEdge.emplace(edgeKey(a, b), false);
            inCrease[static_cast<std::size_t>(a)] = inCrease[static_cast<std::size_t>(b)] = true;
        }
        int const* vertices = _model.faceVertices.data();
        for (int const size : _model.faceSizes) {
            for (int i = 0, previous = size - 1; i < size; previous = i++) {
                int const a = vertices[previous], b = vertices[i];
                if (!inCrease[static_cast<std::size_t>(a)] || !inCrease[static_cast<std::size_t>(b)]) continue;
                auto const found = isEdge.find(edgeKey(a, b));
                if (found != isEdge.end()) found->second = true;
            }
            vertices += size;
        }

        for (std::size_t i = 0; i < numCreases; ++i) {
            auto const [a, b] = ends(i);
            if (isEdge.at(edgeKey(a, b))) continue;
            throw ParseError(_line.FileName(), _tagged.creaseLines[i],
                             "the crease from vertex " + std::to_string(a) + " to " + std::to_string(b) +
                                 " (from 0) is no edge of a face: name the two ends of an edge");
        }
    }

    LineScanner _line;
    Model _model;
    FaceSharpness _sharpness;
    TaggedElements _tagged;
    std::vector<ForwardIndex> _forward;
    int _firstIndex = 1;
    bool _hasUnknownWord = false;
};

}  // namespace

Model ParseObj(std::string_view text, std::string const& fileName) { return ObjParser(text, fileName).Parse(); }

Model ReadObj(std::string const& path) { return ParseObj(ReadTextFile(path), path); }

}  // namespace io
}  // namespace v1
}  // namespace osd_shading
