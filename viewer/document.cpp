// SPDX-License-Identifier: Apache-2.0
#include "document.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "builtInModels.h"
#include "modelInput.h"

namespace osd_shading::viewer {

namespace {

constexpr std::size_t kMaxStates = 1000;

// The highest of several entries counts.
Creases CreasesOf(io::Model const& model) {
    Creases creases;
    for (std::size_t i = 0; i < model.creaseSharpness.size(); ++i) {
        if (!(model.creaseSharpness[i] > 0)) continue;
        float& sharpness = creases.edges[MakeEdgeKey(model.creaseVertices[2 * i], model.creaseVertices[2 * i + 1])];
        sharpness = std::max(sharpness, model.creaseSharpness[i]);
    }
    for (std::size_t i = 0; i < model.cornerSharpness.size(); ++i) {
        if (!(model.cornerSharpness[i] > 0)) continue;
        float& sharpness = creases.vertices[model.cornerVertices[i]];
        sharpness = std::max(sharpness, model.cornerSharpness[i]);
    }
    return creases;
}

}  // namespace

Document::Document(std::string name, tool::MeshOptions const& options) : _name(std::move(name)) {
    auto model = std::make_shared<io::Model>(LoadModel(_name));
    tool::ApplyMeshOptions(options, *model);
    _states.push_back(CreasesOf(*model));
    _saved = CurrentCreases();
    _model = std::move(model);
}

void Document::Change(Creases creases, int gesture) {
    if (creases == CurrentCreases()) return;
    bool const isSameGesture = gesture != 0 && gesture == _gesture && _current > 0;
    _states.resize(_current + 1);
    if (isSameGesture) {
        _states[_current] = std::move(creases);
    } else {
        if (_states.size() == kMaxStates) _states.erase(_states.begin());
        _states.push_back(std::move(creases));
        _current = _states.size() - 1;
    }
    _gesture = gesture;
    update();
}

void Document::Undo() {
    if (!CanUndo()) return;
    --_current;
    _gesture = 0;
    update();
}

void Document::Redo() {
    if (!CanRedo()) return;
    ++_current;
    _gesture = 0;
    update();
}

void Document::update() {
    auto model = std::make_shared<io::Model>(*_model);
    model->creaseVertices.clear();
    model->creaseSharpness.clear();
    model->cornerVertices.clear();
    model->cornerSharpness.clear();
    for (auto const& [edge, sharpness] : CurrentCreases().edges) {
        model->creaseVertices.insert(model->creaseVertices.end(), edge.begin(), edge.end());
        model->creaseSharpness.push_back(sharpness);
    }
    for (auto const& [vertex, sharpness] : CurrentCreases().vertices) {
        model->cornerVertices.push_back(vertex);
        model->cornerSharpness.push_back(sharpness);
    }
    _model = std::move(model);
}

std::vector<std::string> FilesBeside(std::string const& name) {
    namespace fs = std::filesystem;
    constexpr std::size_t kMost = 1000;
    std::vector<std::string> files;
    std::error_code ignored;
    fs::path const folder = fs::is_regular_file(name, ignored) ? fs::path(name).parent_path() : fs::path();
    for (auto entry = fs::directory_iterator(folder.empty() ? fs::path(".") : folder, ignored);
         !ignored && entry != fs::directory_iterator() && files.size() < kMost; entry.increment(ignored)) {
        std::error_code isNoFile;
        if (entry->path().extension() != ".obj" || !entry->is_regular_file(isNoFile)) continue;
        files.push_back((folder / entry->path().filename()).string());
    }
    std::sort(files.begin(), files.end());
    return files;
}

}  // namespace osd_shading::viewer
