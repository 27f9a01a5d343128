// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "osd_shading/io/model.h"

namespace osd_shading::viewer {

/// One of the project's own models, part of the program.
struct BuiltInModel {
    std::string_view name, text;  ///< of an OBJ file
};

/// All of them, by name.
std::vector<BuiltInModel> const& BuiltInModels();

/// What opens when nothing is named: extraordinary vertices, handle and creases in one.
inline constexpr std::string_view kFirstModel = "mug";

/// Reads `name`: a file, or where there is none a built-in model.
///
/// ERRORS: io::ReadError, io::ParseError
io::Model LoadModel(std::string const& name);

}  // namespace osd_shading::viewer
