// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/io/plyWriter.h"

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "osd_shading/io/exportedResult.h"
#include "osd_shading/io/fileReplacement.h"
#include "osd_shading/io/textWriter.h"

namespace osd_shading {
inline namespace v1 {
namespace io {

namespace {

using Uv = std::array<float, 2>;

// The vertices of the PLY: values, split where UVs differ.
struct SplitValues {
    std::vector<int> values;   // per PLY vertex
    std::vector<Uv> uvs;       // per PLY vertex; empty without UVs
    std::vector<int> corners;  // per face corner: PLY vertex
};

template <typename Real>
SplitValues splitAtUvs(ShadingResult<Real> const& result) {
    SplitValues split;
    int const numValues = result.NumValues();
    split.values.reserve(static_cast<std::size_t>(numValues));
    for (int value = 0; value < numValues; ++value) split.values.push_back(value);
    split.corners = result.faceValues;
    RefinedFaceVarying<Real> const* const uvs = FindUvs(result);
    if (!uvs) return split;

    // Each value keeps a chain of the PLY vertices that it has so far, one per UV as written.
    constexpr int kNone = -1;
    split.uvs.resize(split.values.size());
    std::vector<int> next(split.values.size(), kNone);
    std::vector<bool> hasUv(split.values.size());
    for (std::size_t corner = 0; corner < split.corners.size(); ++corner) {
        Real const* const at = &uvs->values[2 * static_cast<std::size_t>(uvs->faceIndices[corner])];
        Uv const uv = {static_cast<float>(at[0]), static_cast<float>(at[1])};
        int& vertex = split.corners[corner];
        auto const value = static_cast<std::size_t>(vertex);
        if (!hasUv[value]) {
            hasUv[value] = true;
            split.uvs[value] = uv;
        }
        int last = vertex;
        for (; vertex != kNone && split.uvs[static_cast<std::size_t>(vertex)] != uv;
             vertex = next[static_cast<std::size_t>(vertex)]) {
            last = vertex;
        }
        if (vertex != kNone) continue;
        vertex = static_cast<int>(split.values.size());
        next[static_cast<std::size_t>(last)] = vertex;
        next.push_back(kNone);
        split.values.push_back(static_cast<int>(value));
        split.uvs.push_back(uv);
    }
    return split;
}

// The numbers of a row, as bytes or as text.
class BinaryRows {
public:
    explicit BinaryRows(FileReplacement& file) : _file(file) {}
    void Float(float value) { _file.Write(&value, sizeof(value)); }
    void Int(int value) {
        auto const number = static_cast<std::int32_t>(value);
        _file.Write(&number, sizeof(number));
    }
    void Count(int value) {
        auto const number = static_cast<std::uint8_t>(value);
        _file.Write(&number, sizeof(number));
    }
    void End() {}

private:
    FileReplacement& _file;
};

class TextRows {
public:
    explicit TextRows(FileReplacement& file) : _text(file) {}
    void Float(float value) { add(value); }
    void Int(int value) { add(value); }
    void Count(int value) { add(value); }
    void End() {
        _text.Add('\n');
        _isFirst = true;
    }

private:
    template <typename Number>
    void add(Number value) {
        if (!_isFirst) _text.Add(' ');
        _text.Add(value);
        _isFirst = false;
    }

    TextWriter _text;
    bool _isFirst = true;
};

template <typename Rows, typename Real>
void writeRows(Rows rows, ShadingResult<Real> const& result, SplitValues const& split) {
    auto const addVector = [&](Vec3<Real> const& vector) {
        for (Real const component : {vector.x, vector.y, vector.z}) rows.Float(static_cast<float>(component));
    };
    for (std::size_t i = 0; i < split.values.size(); ++i) {
        auto const value = static_cast<std::size_t>(split.values[i]);
        int const vertex = result.valueVertices[value];
        addVector(result.positions[static_cast<std::size_t>(vertex)]);
        addVector(result.blendedNormals[value]);
        rows.Float(static_cast<float>(result.blendWeights[value]));
        addVector(result.limitNormals[value]);
        addVector(result.subdividedNormals[value]);
        rows.Int(vertex);
        rows.Int(split.values[i] - result.vertexValues[static_cast<std::size_t>(vertex)]);
        if (!split.uvs.empty()) {
            for (float const component : split.uvs[i]) rows.Float(component);
        }
        rows.End();
    }
    auto const faceSize = static_cast<std::size_t>(result.faceSize);
    for (std::size_t first = 0; first < split.corners.size(); first += faceSize) {
        rows.Count(result.faceSize);
        for (std::size_t i = 0; i < faceSize; ++i) rows.Int(split.corners[first + i]);
        rows.End();
    }
}

}  // namespace

template <typename Real>
void WritePly(std::string const& path, ShadingResult<Real> const& result, PlyOptions const& options) {
    CheckFitsFloat(path, result);
    SplitValues const split = splitAtUvs(result);
    bool const isBinary = options.format == PlyFormat::Binary;
    char const* const binary =
        std::endian::native == std::endian::little ? "binary_little_endian" : "binary_big_endian";

    FileReplacement file(path);
    TextWriter text(file);
    text.Add("ply\nformat ", isBinary ? binary : "ascii", " 1.0\ncomment osd_shading\n");
    text.Add("element vertex ", split.values.size(), '\n');
    for (char const* const name : {"x", "y", "z", "nx", "ny", "nz", "blend_weight", "limit_nx", "limit_ny",
                                   "limit_nz", "subdivided_nx", "subdivided_ny", "subdivided_nz"}) {
        text.Add("property float ", name, '\n');
    }
    text.Add("property int vertex\nproperty int region\n");
    if (FindUvs(result)) text.Add("property float s\nproperty float t\n");
    text.Add("element face ", result.NumFaces(), "\nproperty list uchar int vertex_indices\nend_header\n");
    if (isBinary) {
        writeRows(BinaryRows(file), result, split);
    } else {
        writeRows(TextRows(file), result, split);
    }
    file.Commit();
}

template void WritePly(std::string const&, ShadingResult<float> const&, PlyOptions const&);
template void WritePly(std::string const&, ShadingResult<double> const&, PlyOptions const&);

}  // namespace io
}  // namespace v1
}  // namespace osd_shading
