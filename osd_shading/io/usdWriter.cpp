// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/io/usdWriter.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include "osd_shading/errors.h"
#include "osd_shading/io/exportedResult.h"
#include "osd_shading/io/fileReplacement.h"
#include "osd_shading/io/model.h"
#include "osd_shading/io/textWriter.h"

namespace osd_shading {
inline namespace v1 {
namespace io {

namespace {

using Options = Sdc::Options;

// A prim's name has letters, digits and underscores, and no digit in front.
std::string primName(std::string const& path) {
    std::string name = std::filesystem::path(path).stem().string();
    auto const isDigit = [](char c) { return c >= '0' && c <= '9'; };
    for (char& c : name) {
        if (!isDigit(c) && !(c >= 'a' && c <= 'z') && !(c >= 'A' && c <= 'Z')) c = '_';
    }
    if (name.empty() || isDigit(name[0])) name.insert(0, "_");
    return name;
}

// Writes the attributes of one prim, an array a line.
class PrimWriter {
public:
    explicit PrimWriter(TextWriter& text) : _text(text) {}

    void Token(std::string_view attribute, std::string_view value) {
        _text.Add("        ", attribute, " = \"", value, "\"\n");
    }

    // `addElement(i)` writes element i.
    template <typename AddElement>
    void Array(std::string_view attribute, std::size_t count, AddElement const& addElement,
               std::string_view interpolation = {}) {
        _text.Add("        ", attribute, " = [");
        for (std::size_t i = 0; i < count; ++i) {
            if (i > 0) _text.Add(", ");
            addElement(i);
        }
        _text.Add(']');
        if (!interpolation.empty()) {
            _text.Add(" (\n            interpolation = \"", interpolation, "\"\n        )");
        }
        _text.Add('\n');
    }

    template <typename Number>
    void Numbers(std::string_view attribute, ArrayView<Number> values, std::string_view interpolation = {}) {
        Array(
            attribute, values.size(), [&](std::size_t i) { _text.Add(values[i]); }, interpolation);
    }

    template <std::size_t N>
    void Tuple(std::array<float, N> const& tuple) {
        for (std::size_t i = 0; i < N; ++i) _text.Add(i == 0 ? "(" : ", ", tuple[i]);
        _text.Add(')');
    }

    template <typename Real>
    void Points(PointView<Real> points) {
        // The extent is that of the points as written, so rounded alike.
        std::array<std::array<float, 3>, 2> extent = {};
        for (std::size_t i = 0; i < points.size(); ++i) {
            auto const point = rounded(points[i]);
            for (std::size_t k = 0; k < 3; ++k) {
                extent[0][k] = i == 0 ? point[k] : std::min(extent[0][k], point[k]);
                extent[1][k] = i == 0 ? point[k] : std::max(extent[1][k], point[k]);
            }
        }
        Array("float3[] extent", extent.size(), [&](std::size_t i) { Tuple(extent[i]); });
        Array("point3f[] points", points.size(), [&](std::size_t i) { Tuple(rounded(points[i])); });
    }

    template <typename Real>
    void Uvs(PrimvarView<Real> values, ArrayView<int> indices) {
        auto const addUv = [&](std::size_t i) {
            Tuple<2>({static_cast<float>(values[i][0]), static_cast<float>(values[i][1])});
        };
        Array("texCoord2f[] primvars:st", values.size(), addUv, "faceVarying");
        Numbers("int[] primvars:st:indices", indices);
    }

    template <typename Real>
    static std::array<float, 3> rounded(Vec3<Real> const& v) {
        return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
    }

private:
    TextWriter& _text;
};

template <typename Real>
void writeShaded(TextWriter& text, ShadingResult<Real> const& result) {
    PrimWriter prim(text);
    text.Add("    def Mesh \"shaded\"\n    {\n");
    prim.Token("uniform token subdivisionScheme", "none");
    prim.Array("int[] faceVertexCounts", static_cast<std::size_t>(result.NumFaces()),
               [&](std::size_t) { text.Add(result.faceSize); });
    prim.Numbers<int>("int[] faceVertexIndices", result.faceVertices);
    prim.Points(PointView<Real>(result.positions));
    auto const addNormal = [&](std::size_t corner) {
        auto const value = static_cast<std::size_t>(result.faceValues[corner]);
        prim.Tuple(PrimWriter::rounded(result.blendedNormals[value]));
    };
    prim.Array("normal3f[] normals", result.faceValues.size(), addNormal, "faceVarying");
    prim.Array(
        "float[] primvars:blendWeight", result.blendWeights.size(),
        [&](std::size_t i) { text.Add(static_cast<float>(result.blendWeights[i])); }, "faceVarying");
    prim.Numbers<int>("int[] primvars:blendWeight:indices", result.faceValues);
    if (auto const* const uvs = FindUvs(result)) {
        prim.Uvs(PrimvarView<Real>(uvs->values.data(), uvs->values.size() / 2, 2), uvs->faceIndices);
    }
    text.Add("    }\n");
}

std::string_view boundaryToken(Options::VtxBoundaryInterpolation boundary) {
    if (boundary == Options::VTX_BOUNDARY_NONE) return "none";
    return boundary == Options::VTX_BOUNDARY_EDGE_ONLY ? "edgeOnly" : "edgeAndCorner";
}

std::string_view faceVaryingToken(Options::FVarLinearInterpolation faceVarying) {
    switch (faceVarying) {
        case Options::FVAR_LINEAR_NONE:
            return "none";
        case Options::FVAR_LINEAR_CORNERS_ONLY:
            return "cornersOnly";
        case Options::FVAR_LINEAR_CORNERS_PLUS1:
            return "cornersPlus1";
        case Options::FVAR_LINEAR_CORNERS_PLUS2:
            return "cornersPlus2";
        case Options::FVAR_LINEAR_BOUNDARIES:
            return "boundaries";
        case Options::FVAR_LINEAR_ALL:
            break;
    }
    return "all";
}

void writeSharpness(PrimWriter& prim, ControlMesh const& cage) {
    // One entry per element, with the highest sharpness: USD's readers would take the last.
    std::map<std::pair<int, int>, float> creases;
    for (std::size_t i = 0; i < cage.creaseSharpness.size(); ++i) {
        auto const ends = std::minmax(cage.creaseVertices[2 * i], cage.creaseVertices[2 * i + 1]);
        float& sharpness = creases[{ends.first, ends.second}];
        sharpness = std::max(sharpness, std::min(cage.creaseSharpness[i], kInfiniteSharpness));
    }
    std::map<int, float> corners;
    for (std::size_t i = 0; i < cage.cornerSharpness.size(); ++i) {
        float& sharpness = corners[cage.cornerVertices[i]];
        sharpness = std::max(sharpness, std::min(cage.cornerSharpness[i], kInfiniteSharpness));
    }

    std::vector<int> creaseVertices, creaseLengths, cornerVertices;
    std::vector<float> creaseSharpness, cornerSharpness;
    for (auto const& [ends, sharpness] : creases) {
        creaseVertices.insert(creaseVertices.end(), {ends.first, ends.second});
        creaseLengths.push_back(2);
        creaseSharpness.push_back(sharpness);
    }
    for (auto const& [vertex, sharpness] : corners) {
        cornerVertices.push_back(vertex);
        cornerSharpness.push_back(sharpness);
    }
    if (!creases.empty()) {
        prim.Numbers<int>("int[] creaseIndices", creaseVertices);
        prim.Numbers<int>("int[] creaseLengths", creaseLengths);
        prim.Numbers<float>("float[] creaseSharpnesses", creaseSharpness);
    }
    if (!corners.empty()) {
        prim.Numbers<int>("int[] cornerIndices", cornerVertices);
        prim.Numbers<float>("float[] cornerSharpnesses", cornerSharpness);
    }
}

void writeCage(TextWriter& text, UsdOptions const& options) {
    ControlMesh const& cage = *options.cage;
    SubdivisionRules const& rules = cage.rules;
    PrimWriter prim(text);
    text.Add("    def Mesh \"cage\"\n    {\n");
    prim.Token("uniform token purpose", "guide");
    prim.Token("uniform token subdivisionScheme", rules.scheme == Sdc::SCHEME_LOOP ? "loop" : "catmullClark");
    prim.Token("token interpolateBoundary", boundaryToken(rules.boundary));
    prim.Token("token faceVaryingLinearInterpolation", faceVaryingToken(rules.faceVarying));
    prim.Token("token triangleSubdivisionRule",
               rules.triangles == Options::TRI_SUB_SMOOTH ? "smooth" : "catmullClark");
    if (rules.creasing == Options::CREASE_CHAIKIN) {
        prim.Token("custom uniform token osd_shading:creasingMethod", "chaikin");
    }
    prim.Numbers("int[] faceVertexCounts", cage.faceSizes);
    prim.Numbers("int[] faceVertexIndices", cage.faceVertices);
    prim.Points(options.cagePositions);
    if (!cage.holes.empty()) prim.Numbers("int[] holeIndices", cage.holes);
    writeSharpness(prim, cage);
    if (!options.cageUvs.indices.empty()) prim.Uvs(options.cageUvs.values, options.cageUvs.indices);
    text.Add("    }\n");
}

// What writing would read past the end of an array for; the library checks the rest of a control mesh.
void checkCage(std::string const& path, UsdOptions const& options) {
    ControlMesh const& cage = *options.cage;
    auto const& uvs = options.cageUvs;
    if (options.cagePositions.size() != static_cast<std::size_t>(cage.numVertices)) {
        throw InvalidControlMesh("the cage has " + std::to_string(cage.numVertices) + " vertices, but " +
                                 std::to_string(options.cagePositions.size()) + " positions are given");
    }
    if (cage.creaseVertices.size() != 2 * cage.creaseSharpness.size() ||
        cage.cornerVertices.size() != cage.cornerSharpness.size()) {
        throw InvalidControlMesh("the cage has other numbers of creases or corners than of their sharpness");
    }
    if (!uvs.indices.empty()) {
        auto const isOutside = [&](int i) { return i < 0 || static_cast<std::size_t>(i) >= uvs.values.size(); };
        if (uvs.values.width() != 2 || uvs.indices.size() != cage.faceVertices.size() ||
            std::any_of(uvs.indices.begin(), uvs.indices.end(), isOutside)) {
            throw InvalidControlMesh("the cage's UVs take two numbers a value, and a valid index per face corner");
        }
    }
    for (std::size_t i = 0; i < options.cagePositions.size(); ++i) {
        auto const point = options.cagePositions[i];
        bool const fits = FitsFloat(point.x) && FitsFloat(point.y) && FitsFloat(point.z);
        if (!fits) FailTooLarge(path, "the position of the cage's vertex", i);
    }
}

}  // namespace

template <typename Real>
void WriteUsd(std::string const& path, ShadingResult<Real> const& result, UsdOptions const& options) {
    CheckFitsFloat(path, result);
    if (options.cage) checkCage(path, options);
    std::string const name = primName(path);

    FileReplacement file(path);
    TextWriter text(file);
    text.Add("#usda 1.0\n(\n    defaultPrim = \"", name, "\"\n    metersPerUnit = 1\n    upAxis = \"Y\"\n)\n\n");
    text.Add("def Xform \"", name, "\"\n{\n");
    writeShaded(text, result);
    if (options.cage) {
        text.Add('\n');
        writeCage(text, options);
    }
    text.Add("}\n");
    file.Commit();
}

template void WriteUsd(std::string const&, ShadingResult<float> const&, UsdOptions const&);
template void WriteUsd(std::string const&, ShadingResult<double> const&, UsdOptions const&);

}  // namespace io
}  // namespace v1
}  // namespace osd_shading
