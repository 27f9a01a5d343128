// SPDX-License-Identifier: Apache-2.0
#include <string_view>

#include "fuzzTargets.h"
#include "osd_shading/controlMesh.h"
#include "osd_shading/io/errors.h"
#include "osd_shading/io/objReader.h"
#include "osd_shading/io/sharpReader.h"

namespace fuzz {

using namespace osd_shading;

void FuzzSharp(std::uint8_t const* data, std::size_t size) {
    // A triangle, a quad and a pentagon, and a crease that every refusal must leave.
    static io::Model const kModel = io::ParseObj(
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 3 1 0\nv 2 2 0\nf 1 2 3 4\nf 2 5 3\nf 5 6 7 4 3\nfs 7\n",
        "model.obj");
    io::Model model = kModel;
    try {
        io::ApplySharpText({reinterpret_cast<char const*>(data), size}, "fuzz.sharp", model);
        ValidateControlMesh(model.Mesh({}));
        for (float const s : model.creaseSharpness) {
            Require(s > 0 && s <= io::kInfiniteSharpness, "sharpness is above 0 and at most 10");
        }
        Require(model.warnings.size() <= 1, "one warning stands for all");
    } catch (io::ParseError const&) {
        Require(model.creaseVertices == kModel.creaseVertices && model.creaseSharpness == kModel.creaseSharpness &&
                    model.warnings.empty(),
                "an error leaves the model");
    }
}

}  // namespace fuzz
