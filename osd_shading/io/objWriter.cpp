// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/io/objWriter.h"

#include "osd_shading/io/exportedResult.h"
#include "osd_shading/io/fileReplacement.h"
#include "osd_shading/io/textWriter.h"

namespace osd_shading {
inline namespace v1 {
namespace io {

template <typename Real>
void WriteObj(std::string const& path, ShadingResult<Real> const& result) {
    FileReplacement file(path);
    TextWriter text(file);
    RefinedFaceVarying<Real> const* const uvs = FindUvs(result);

    text.Add("# osd_shading: ", result.NumVertices(), " vertices, ", result.NumFaces(), " faces\n");
    for (auto const& point : result.positions) text.Add("v ", point.x, ' ', point.y, ' ', point.z, '\n');
    if (uvs) {
        for (std::size_t i = 0; i + 1 < uvs->values.size(); i += 2) {
            text.Add("vt ", uvs->values[i], ' ', uvs->values[i + 1], '\n');
        }
    }
    for (auto const& normal : result.blendedNormals) {
        text.Add("vn ", normal.x, ' ', normal.y, ' ', normal.z, '\n');
    }

    auto const faceSize = static_cast<std::size_t>(result.faceSize);
    for (std::size_t corner = 0; corner < result.faceVertices.size(); ++corner) {
        text.Add(corner % faceSize == 0 ? "f " : " ", result.faceVertices[corner] + 1, '/');
        if (uvs) text.Add(uvs->faceIndices[corner] + 1);
        text.Add('/', result.faceValues[corner] + 1);
        if (corner % faceSize == faceSize - 1) text.Add('\n');
    }
    file.Commit();
}

template void WriteObj(std::string const&, ShadingResult<float> const&);
template void WriteObj(std::string const&, ShadingResult<double> const&);

}  // namespace io
}  // namespace v1
}  // namespace osd_shading
