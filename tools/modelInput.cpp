// SPDX-License-Identifier: Apache-2.0
#include "modelInput.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "osd_shading/io/creaseEdits.h"
#include "osd_shading/io/errors.h"
#include "osd_shading/io/objReader.h"
#include "osd_shading/io/sharpReader.h"

namespace osd_shading::tool {

namespace {

// `what` and `width`: what every `width` numbers are, for the message.
template <typename Real>
std::vector<Real> Converted(std::string const& file, std::vector<double> const& values, std::string const& what,
                            std::size_t width) {
    std::vector<Real> converted;
    converted.reserve(values.size());
    for (double value : values) {
        converted.push_back(static_cast<Real>(value));
        if (std::isfinite(converted.back())) continue;
        throw io::ParseError(file, 0,
                             what + " " + std::to_string((converted.size() - 1) / width) +
                                 " (from 0) is too large for --precision float: scale the model, or use double");
    }
    return converted;
}

// The face that holds a corner.
std::size_t FaceOfCorner(io::Model const& model, std::size_t corner) {
    std::size_t face = 0;
    for (std::size_t end = 0; face < model.faceSizes.size(); ++face) {
        end += static_cast<std::size_t>(model.faceSizes[face]);
        if (corner < end) break;
    }
    return face;
}

template <typename Real>
std::vector<Real> CornerNormals(std::string const& file, io::Model const& model) {
    std::vector<Real> normals;
    std::vector<Real> const ofFile = Converted<Real>(file, model.normals, "vn", 3);
    normals.reserve(3 * model.faceVertices.size());
    for (std::size_t corner = 0; corner < model.faceVertices.size(); ++corner) {
        int const normal = model.normalIndices.empty() ? -1 : model.normalIndices[corner];
        if (normal < 0) {
            throw io::ParseError(file, model.faceLines[FaceOfCorner(model, corner)],
                                 "the face has a corner without a normal; give every face corner one (f v//vn), or "
                                 "choose another --start-normals than file");
        }
        for (std::size_t i = 0; i < 3; ++i) {
            normals.push_back(ofFile[3 * static_cast<std::size_t>(normal) + i]);
        }
    }
    return normals;
}

}  // namespace

io::Model ReadModel(std::string const& file, MeshOptions const& options) {
    io::Model model = io::ReadObj(file);
    ApplyMeshOptions(options, model);
    LeaveOutPartialUvs(file, model);
    return model;
}

void ApplyMeshOptions(MeshOptions const& options, io::Model& model) {
    if (!options.sharpnessFile.empty()) io::ApplySharpFile(options.sharpnessFile, model);
    if (options.creaseAngle) io::AddCreasesByAngle(model, *options.creaseAngle);
    if (options.creaseScale) io::ScaleCreases(model, *options.creaseScale);
}

void LeaveOutPartialUvs(std::string const& file, io::Model& model) {
    bool const lacksUvs = std::find(model.uvIndices.begin(), model.uvIndices.end(), -1) != model.uvIndices.end();
    if (lacksUvs) {
        model.warnings.push_back(file + ": not every face corner has a vt; texture coordinates are left out");
        model.uvIndices.clear();
    }
}

void RequireTriangles(std::string const& file, Sdc::SchemeType scheme, io::Model const& model) {
    if (scheme != Sdc::SCHEME_LOOP) return;
    for (std::size_t face = 0; face < model.faceSizes.size(); ++face) {
        if (model.faceSizes[face] == 3) continue;
        throw io::ParseError(
            file, model.faceLines[face],
            "the face has " + std::to_string(model.faceSizes[face]) +
                " vertices; Loop subdivision takes triangles only: triangulate it, or use --scheme "
                "catmark");
    }
}

template <typename Real>
RunInput<Real> MakeInput(std::string const& file, io::Model const& model, StartNormalKind startNormals) {
    RunInput<Real> run;
    run.positions = Converted<Real>(file, model.positions, "the position of vertex", 3);
    run.input.positions = {run.positions.data(), run.positions.size() / 3};
    if (startNormals == StartNormalKind::User) {
        run.cornerNormals = CornerNormals<Real>(file, model);
        run.input.faceVaryingNormals = {run.cornerNormals.data(), run.cornerNormals.size() / 3};
    }
    if (!model.uvIndices.empty()) {
        run.uvs = Converted<Real>(file, model.uvs, "vt", 2);
        run.input.faceVaryingData.push_back({model.uvIndices, {run.uvs.data(), run.uvs.size() / 2, 2}});
    }
    return run;
}

template RunInput<float> MakeInput(std::string const&, io::Model const&, StartNormalKind);
template RunInput<double> MakeInput(std::string const&, io::Model const&, StartNormalKind);

}  // namespace osd_shading::tool
