# SPDX-License-Identifier: Apache-2.0
#
# Writes OUTPUT, C++ that holds the OBJ files MODELS (separated by |) as text.
string(REPLACE "|" ";" MODELS "${MODELS}")
set(entries "")
foreach(file IN LISTS MODELS)
    get_filename_component(name "${file}" NAME_WE)
    file(READ "${file}" text)
    # Compilers end a literal at 16 KiB.
    string(LENGTH "${text}" length)
    set(pieces "")
    set(begin 0)
    while(begin LESS length)
        string(SUBSTRING "${text}" ${begin} 8000 piece)
        string(APPEND pieces "\n    R\"obj(${piece})obj\"")
        math(EXPR begin "${begin} + 8000")
    endwhile()
    string(APPEND entries "    {\"${name}\",${pieces}},\n")
endforeach()
file(WRITE "${OUTPUT}" "// Made by viewer/embedModels.cmake.
#include \"builtInModels.h\"

namespace osd_shading::viewer {

std::vector<BuiltInModel> const& BuiltInModels() {
    static std::vector<BuiltInModel> const models = {
${entries}    };
    return models;
}

}  // namespace osd_shading::viewer
")
