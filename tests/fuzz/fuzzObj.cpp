// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "fuzzTargets.h"
#include "osd_shading/io/errors.h"
#include "osd_shading/io/objReader.h"
#include "osd_shading/io/sharpReader.h"
#include "osd_shading/subdivisionShading.h"

namespace fuzz {

namespace {

using namespace osd_shading;

bool isIn(std::vector<int> const& indices, int least, std::size_t count) {
    return std::all_of(indices.begin(), indices.end(),
                       [&](int index) { return index >= least && index < static_cast<int>(count); });
}

bool areFinite(std::vector<double> const& numbers) {
    return std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); });
}

bool areSharpness(std::vector<float> const& numbers) {
    return std::all_of(numbers.begin(), numbers.end(),
                       [](float s) { return s >= 0 && s <= io::kInfiniteSharpness; });
}

void requirePromises(io::Model const& model) {
    std::size_t const numVertices = model.positions.size() / 3, numCorners = model.faceVertices.size();
    Require(isIn(model.faceVertices, 0, numVertices), "faces name vertices");
    Require(isIn(model.creaseVertices, 0, numVertices), "creases name vertices");
    Require(isIn(model.cornerVertices, 0, numVertices), "corners name vertices");
    Require(isIn(model.holes, 0, model.faceSizes.size()), "holes name faces");
    Require(isIn(model.uvIndices, -1, model.uvs.size() / 2), "corners name UVs");
    Require(isIn(model.normalIndices, -1, model.normals.size() / 3), "corners name normals");
    Require(model.uvIndices.empty() || model.uvIndices.size() <= numCorners, "no more UV indices than corners");
    Require(areFinite(model.positions) && areFinite(model.uvs) && areFinite(model.normals), "numbers are finite");
    Require(areSharpness(model.creaseSharpness) && areSharpness(model.cornerSharpness), "sharpness is 0 to 10");
    Require(model.creaseVertices.size() == 2 * model.creaseSharpness.size(), "creases have two ends");
    Require(model.faceLines.size() == model.faceSizes.size(), "each face has its line");
}

/// What a reader accepts, the library accepts but for what only OpenSubdiv limits.
void shade(io::Model const& model) {
    ControlMesh const mesh = model.Mesh(model.Rules({}));
    ValidateControlMesh(mesh);
    constexpr std::size_t kFew = 400;
    double largest = 0;
    for (double const x : model.positions) largest = std::max(largest, std::fabs(x));
    if (model.faceVertices.size() > kFew || model.positions.size() > 10 * kFew || largest > 1e30) return;
    ShadingInput<double> input;
    input.positions = {model.positions.data(), model.positions.size() / 3};
    for (Vec3<double> const& n : ShadeSubdivision(mesh, input, PaperPreset(1)).blendedNormals) {
        Require(std::isfinite(n.x) && std::isfinite(n.y) && std::isfinite(n.z), "normals are finite");
    }
}

}  // namespace

void FuzzObj(std::uint8_t const* data, std::size_t size) {
    std::string_view const text(reinterpret_cast<char const*>(data), size);
    try {
        io::Model model = io::ParseObj(text, "fuzz.obj");
        requirePromises(model);
        model.CompleteUvs();
        Require(model.uvIndices.empty() || isIn(model.uvIndices, 0, model.uvs.size() / 2),
                "complete UVs are complete");
        shade(model);
        io::ApplySharpText(text, "fuzz.sharp", model);
        requirePromises(model);
    } catch (io::ParseError const& error) {
        Require(error.Line() >= 0 && error.what()[0] != '\0', "an error says where");
    }
}

}  // namespace fuzz
