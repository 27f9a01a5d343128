// SPDX-License-Identifier: Apache-2.0
#include "builtInModels.h"

#include <filesystem>
#include <system_error>

#include "modelInput.h"
#include "osd_shading/io/objReader.h"

namespace osd_shading::viewer {

io::Model LoadModel(std::string const& name) {
    std::error_code ignored;
    if (!std::filesystem::exists(name, ignored)) {
        for (BuiltInModel const& model : BuiltInModels()) {
            if (model.name == name) return io::ParseObj(model.text, name + ".obj");
        }
    }
    return tool::ReadModel(name, {});
}

}  // namespace osd_shading::viewer
