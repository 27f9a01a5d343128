// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "osd_shading/controlMesh.h"
#include "osd_shading/export.h"

namespace osd_shading {
inline namespace v1 {
namespace io {

/// The least sharpness that is infinite; also what infinite sharpness is stored as. OpenSubdiv's own number.
constexpr float kInfiniteSharpness = 10.0f;

/// A control mesh as a file gives it; owns its arrays. Indices count from 0.
struct Model {
    std::string name;  ///< of the file, without folder and suffix

    std::vector<double> positions;        ///< 3 per vertex
    std::vector<int> faceSizes;           ///< per face
    std::vector<int> faceVertices;        ///< per face corner
    std::vector<std::int64_t> faceLines;  ///< per face: its line in the file, for messages

    std::vector<int> creaseVertices;  ///< 2 per crease entry; an edge may stand more than once: the highest counts
    std::vector<float> creaseSharpness;  ///< 0 to 10; 10 is infinite
    std::vector<int> cornerVertices;     ///< per corner entry; the highest counts likewise
    std::vector<float> cornerSharpness;  ///< as creaseSharpness
    std::vector<int> holes;              ///< faces

    std::vector<double> uvs;         ///< 2 per value
    std::vector<int> uvIndices;      ///< per face corner, -1 where a corner has none; empty when no corner has one
    std::vector<double> normals;     ///< 3 per value
    std::vector<int> normalIndices;  ///< as uvIndices

    /// \name Options
    /// @{

    /// As the file's tags give it; unset where it has none.
    std::optional<Sdc::Options::VtxBoundaryInterpolation> boundary;
    std::optional<Sdc::Options::FVarLinearInterpolation> faceVarying;
    std::optional<Sdc::Options::CreasingMethod> creasing;
    std::optional<Sdc::Options::TriangleSubdivision> triangles;
    /// @}

    std::vector<std::string> warnings;  ///< "file:line: text", each once

    /// Also those that no face names.
    int NumVertices() const { return static_cast<int>(positions.size() / 3); }
    /// Also holes.
    int NumFaces() const { return static_cast<int>(faceSizes.size()); }

    /// `rules`, with the options that the file's tags give in their place.
    OSD_SHADING_API SubdivisionRules Rules(SubdivisionRules rules) const;

    /// Views over this model's arrays, valid as long as it is and is not changed.
    OSD_SHADING_API ControlMesh Mesh(SubdivisionRules const& rules) const;

    /// Gives the corners that have no UV the UV (0, 0), added as a value of its own; so `uvIndices` can serve as a
    /// face-varying channel. Does nothing where every corner has a UV, or none has.
    OSD_SHADING_API void CompleteUvs();
};

}  // namespace io
}  // namespace v1
}  // namespace osd_shading
