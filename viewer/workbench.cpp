// SPDX-License-Identifier: Apache-2.0
#include "workbench.h"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "commandLine.h"
#include "edgeChains.h"
#include "osd_shading/io/creaseEdits.h"
#include "osd_shading/io/fileReplacement.h"
#include "osd_shading/io/modelWriter.h"

namespace osd_shading::viewer {

namespace {

bool EndsIn(std::string const& file, std::string_view ending) {
    return std::filesystem::path(file).extension() == ending;
}

void Toggle(auto& list, auto const& item, bool isAdded) {
    auto const found = std::find(list.begin(), list.end(), item);
    if (!isAdded) {
        list = {item};
    } else if (found == list.end()) {
        list.push_back(item);
    } else {
        list.erase(found);
    }
}

}  // namespace

Workbench::Workbench(Settings initial, std::shared_ptr<Document> const& document, std::function<void()> wake)
    : settings(std::move(initial)), _worker(std::move(wake)) {
    attempt([&] { submit(document); });
}

// What goes wrong is said, and nothing else happens.
template <typename Action>
void Workbench::attempt(Action const& action) {
    try {
        action();
    } catch (std::bad_alloc const&) {
        _message = "out of memory";
    } catch (std::exception const& error) {
        _message = error.what();
    }
}

void Workbench::submit(std::shared_ptr<Document> const& document) {
    SceneRequest request = MakeRequest(settings, document->Model(), document->Name(), screen);
    bool const allSubdivided = request.allSubdivided;
    std::int64_t const number = _worker.RequestScene(std::move(request));
    _requests.push_back({number, document, settings, allSubdivided});
}

void Workbench::Apply() {
    // While a model opens, options are for that one.
    std::shared_ptr<Document> const& document = _requests.empty() ? _document : _requests.back().document;
    if (document) attempt([&] { submit(document); });
}

int Workbench::ChosenLevel() const {
    int const level = settings.ResolveShading().level;
    if (level != kDefaultSurfaceLevel) return level;
    return _scene ? _scene->options.level : ShadingOptions{}.level;
}

void Workbench::Open(std::string const& name) {
    attempt([&] {
        auto const document = std::make_shared<Document>(name, settings.mesh);
        std::vector<int> const& sizes = document->Model()->faceSizes;
        bool const isLoop = settings.mesh.Scheme() == Sdc::SCHEME_LOOP;
        bool const hasOthers = std::any_of(sizes.begin(), sizes.end(), [](int size) { return size != 3; });
        if (_document && isLoop && hasOthers) {
            settings.mesh.scheme = Sdc::SCHEME_CATMARK;
            _message = name + " has faces other than triangles: shown with Catmull-Clark";
        }
        submit(document);
    });
}

void Workbench::OpenDropped(std::vector<std::string> const& files) {
    if (files.empty()) return;
    EndsIn(files[0], ".txt") ? LoadSettings(files[0]) : Open(files[0]);
}

void Workbench::LoadSettings(std::string const& file) {
    attempt([&] {
        std::optional<CommandLine> const line = ParseCommandLine({"--settings", file});
        if (!line) return;
        settings = line->settings;
        if (!settings.modelFile.empty()) {
            Open(settings.modelFile);
        } else {
            Apply();
        }
        _message = "settings read from " + file;
    });
}

void Workbench::SaveSettings(std::string const& file) {
    attempt([&] {
        Settings saved = settings;
        std::string const name = _document ? _document->Name() : std::string();
        std::error_code ignored;
        bool const isFile = std::filesystem::exists(name, ignored);
        saved.modelFile = isFile ? std::filesystem::absolute(name).string() : name;
        std::string const text = SettingsText(saved);
        io::FileReplacement target(file);
        target.Write(text.data(), text.size());
        target.Commit();
        _message = "settings written to " + file;
    });
}

void Workbench::SaveCage(std::string const& file) {
    if (!_document) return;
    attempt([&] {
        if (EndsIn(file, ".sharp")) {
            io::WriteSharpFile(file, *_document->Model());
        } else if (EndsIn(file, ".obj")) {
            io::WriteModel(file, *_document->Model());
        } else {
            _message = file + ": the name of a control mesh ends in .obj or .sharp";
            return;
        }
        _document->MarkSaved();
        _message = "written: " + file;
    });
}

void Workbench::SaveResult(std::string const& file) {
    if (!_document) return;
    attempt([&] {
        tool::OutputFormat const format = tool::FormatOf(file);
        if (format == tool::OutputFormat::None) {
            _message = file + ": the name of a result ends in .ply, .obj or .usda";
            return;
        }
        SceneRequest request = MakeRequest(settings, _document->Model(), _document->Name(), screen);
        request.precision = settings.run.precision.value_or(tool::Precision::Double);
        _worker.RequestFile(std::move(request), file, format);
        _message = "writing " + file;
    });
}

bool Workbench::Update() {
    bool hasChanged = false;
    while (std::optional<WorkResult> const result = _worker.Take()) {
        take(*result);
        hasChanged = true;
    }
    return hasChanged;
}

void Workbench::take(WorkResult const& result) {
    if (!result.savedFile.empty()) {
        _message = result.isAbandoned     ? "abandoned: " + result.savedFile
                   : result.error.empty() ? "written: " + result.savedFile
                                          : result.error;
        return;
    }
    auto const isThis = [&](Request const& request) { return request.number == result.request; };
    auto const found = std::find_if(_requests.begin(), _requests.end(), isThis);
    if (found == _requests.end()) return;
    Request const request = *found;
    bool const isLast = found + 1 == _requests.end();
    _requests.erase(_requests.begin(), found + 1);

    if (result.scene) {
        _scene = result.scene;
        _shownSettings = request.settings;
        if (request.document != _document) {
            _document = request.document;
            settings.modelFile = _document->Name();
            _isNewModel = true;
            _edges.clear();
            _vertices.clear();
            std::vector<std::string> const& warnings = _document->Model()->warnings;
            _message = warnings.empty() ? std::string() : warnings.front();
        }
        _hovered = {};
        dropMissing();
        return;
    }
    // What is shown stays, and with it the options that it was made with. Work that a newer request replaced is
    // not missed.
    if (!isLast) return;
    _message = result.isAbandoned ? "abandoned" : result.error;
    settings.mesh = _shownSettings.mesh;
    settings.shading = _shownSettings.shading;
    settings.tessellation = _shownSettings.tessellation;
}

void Workbench::dropMissing() {
    int const numVertices = _document->Model()->NumVertices();
    std::erase_if(_vertices, [&](int vertex) { return vertex >= numVertices; });
    std::erase_if(_edges, [&](EdgeKey const& edge) { return edge[1] >= numVertices; });
}

Selection Workbench::ShownSelection() const {
    Selection shown;
    if (!_scene) return shown;
    std::vector<ControlCurve> const& curves = _scene->topology->curves;
    for (std::size_t i = 0; i < curves.size(); ++i) {
        bool const isSelected = std::find(_edges.begin(), _edges.end(), curves[i].vertices) != _edges.end();
        if (isSelected) shown.curves.push_back(static_cast<int>(i));
    }
    for (int vertex : _vertices) {
        if (!_scene->topology->IsIsolated(vertex)) shown.vertices.push_back(vertex);
    }
    shown.hoverCurve = _hovered.curve;
    shown.hoverVertex = _hovered.controlVertex;
    return shown;
}

void Workbench::Select(Pick const& pick, bool isAdded) {
    if (!_scene) return;
    if (pick.controlVertex >= 0) {
        if (!isAdded) _edges.clear();
        Toggle(_vertices, pick.controlVertex, isAdded);
    } else if (pick.curve >= 0) {
        if (!isAdded) _vertices.clear();
        Toggle(_edges, _scene->topology->curves[static_cast<std::size_t>(pick.curve)].vertices, isAdded);
    } else if (!isAdded) {
        SelectNone();
    }
    if (pick.vertex >= 0) settings.view.vertex = pick.vertex;
}

void Workbench::SelectNone() {
    _edges.clear();
    _vertices.clear();
}

void Workbench::SelectAllCreases() {
    if (!_document) return;
    SelectNone();
    for (auto const& [edge, sharpness] : _document->CurrentCreases().edges) _edges.push_back(edge);
}

void Workbench::SelectNextEdge(int step) {
    if (!_scene || _scene->topology->curves.empty()) return;
    std::vector<ControlCurve> const& curves = _scene->topology->curves;
    auto const count = static_cast<int>(curves.size());
    int next = step > 0 ? 0 : count - 1;
    if (!_edges.empty()) {
        auto const isLast = [&](ControlCurve const& curve) { return curve.vertices == _edges.back(); };
        auto const found = std::find_if(curves.begin(), curves.end(), isLast);
        if (found != curves.end()) next = (static_cast<int>(found - curves.begin()) + step + count) % count;
    }
    _vertices.clear();
    _edges = {curves[static_cast<std::size_t>(next)].vertices};
}

void Workbench::SelectNextVertex(int step) {
    if (!_document) return;
    int const count = _document->Model()->NumVertices();
    int const next = _vertices.empty() ? (step > 0 ? 0 : count - 1) : (_vertices.back() + step + count) % count;
    _edges.clear();
    _vertices = {next};
    settings.view.vertex = next;
}

void Workbench::ExtendToChains() {
    if (!_document) return;
    std::vector<EdgeKey> const starts = _edges;
    for (EdgeKey const& start : starts) {
        for (EdgeKey const& edge : ChainOf(*_document->Model(), _document->CurrentCreases(), start)) {
            if (std::find(_edges.begin(), _edges.end(), edge) == _edges.end()) _edges.push_back(edge);
        }
    }
}

std::optional<float> Workbench::SelectedSharpness() const {
    if (!_document || (_edges.empty() && _vertices.empty())) return std::nullopt;
    Creases const& creases = _document->CurrentCreases();
    std::optional<float> common;
    bool isCommon = true;
    auto const add = [&](auto const& sharpness, auto const& item) {
        auto const found = sharpness.find(item);
        float const value = found == sharpness.end() ? 0 : found->second;
        isCommon = isCommon && common.value_or(value) == value;
        common = value;
    };
    for (EdgeKey const& edge : _edges) add(creases.edges, edge);
    for (int vertex : _vertices) add(creases.vertices, vertex);
    return isCommon ? common : std::nullopt;
}

void Workbench::change(Creases creases, int gesture) {
    _document->Change(std::move(creases), gesture);
    attempt([&] { submit(_document); });
}

void Workbench::SetSelectedSharpness(float sharpness, int gesture) {
    if (!_document || (_edges.empty() && _vertices.empty())) return;
    Creases creases = _document->CurrentCreases();
    float const value = std::clamp(sharpness, 0.0F, io::kInfiniteSharpness);
    auto const set = [&](auto& map, auto const& item) {
        if (value > 0) {
            map[item] = value;
        } else {
            map.erase(item);
        }
    };
    for (EdgeKey const& edge : _edges) set(creases.edges, edge);
    for (int vertex : _vertices) set(creases.vertices, vertex);
    change(std::move(creases), gesture);
}

void Workbench::ClearAllSharpness() {
    if (_document) change({});
}

void Workbench::CreaseByAngle(double degrees) {
    if (!_document) return;
    attempt([&] {
        io::Model model = *_document->Model();
        model.creaseVertices.clear();
        model.creaseSharpness.clear();
        io::AddCreasesByAngle(model, degrees);
        Creases creases = _document->CurrentCreases();
        for (std::size_t i = 0; i < model.creaseSharpness.size(); ++i) {
            creases.edges[MakeEdgeKey(model.creaseVertices[2 * i], model.creaseVertices[2 * i + 1])] =
                model.creaseSharpness[i];
        }
        change(std::move(creases));
    });
}

void Workbench::Undo() {
    if (!_document || !_document->CanUndo()) return;
    _document->Undo();
    attempt([&] { submit(_document); });
}

void Workbench::Redo() {
    if (!_document || !_document->CanRedo()) return;
    _document->Redo();
    attempt([&] { submit(_document); });
}

std::string Workbench::StateText() const {
    nlohmann::ordered_json state;
    state["model"] = _document ? _document->Name() : "";
    state["level"] = _scene ? _scene->options.level : -1;
    state["faces"] = _scene ? _scene->report.faces : 0;
    state["creases"] = _document ? _document->CurrentCreases().edges.size() : 0;
    state["corners"] = _document ? _document->CurrentCreases().vertices.size() : 0;
    state["edges"] = _edges;
    state["vertices"] = _vertices;
    std::optional<float> const sharpness = SelectedSharpness();
    state["sharpness"] = sharpness ? nlohmann::ordered_json(*sharpness) : nlohmann::ordered_json();
    state["hover"] = {_hovered.curve, _hovered.controlVertex};
    state["undo"] = _document && _document->CanUndo();
    state["redo"] = _document && _document->CanRedo();
    state["shading"] = tool::NameOf(kShadingNames, settings.view.shading);
    state["splitLine"] = settings.view.splitPosition;
    state["camera"] = settings.camera.Text();
    state["message"] = _message;
    return state.dump();
}

}  // namespace osd_shading::viewer
