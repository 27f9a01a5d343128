// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "document.h"
#include "overlays.h"
#include "picking.h"
#include "sceneWorker.h"
#include "settings.h"

namespace osd_shading::viewer {

/// What the window works on: settings, model, selection, and the scene made of them. Knows neither windows nor GL.
class Workbench {
public:
    /// Begins with `document`. `wake` is called from another thread when `Update` has something to do.
    Workbench(Settings initial, std::shared_ptr<Document> const& document, std::function<void()> wake);

    /// Edited by the panel and the keys; `Apply` must follow where what is computed depends on the change.
    Settings settings;
    glm::ivec2 screen{1280, 800};  ///< pixels, where triangles are as long as is seen
    void Apply();
    /// The level that the settings ask for, or that the scene has where it is left to the library.
    int ChosenLevel() const;

    /// Opens a model; the old one stays until the new one is shown, and where that can't be.
    void Open(std::string const& name);
    /// What is dropped on the window: the first of several files, a model or, where it ends in `.txt`, settings.
    void OpenDropped(std::vector<std::string> const& files);
    void LoadSettings(std::string const& file);
    void SaveSettings(std::string const& file);
    /// As OBJ, or as `.sharp` by its ending.
    void SaveCage(std::string const& file);
    /// What is shown, as PLY, OBJ or USD by its ending.
    void SaveResult(std::string const& file);

    /// Takes finished work; true where something changed.
    bool Update();
    bool IsBusy() const { return _worker.IsBusy(); }
    double Progress() const { return _worker.Progress(); }
    double BusySeconds() const { return _worker.BusySeconds(); }
    void Abandon() { _worker.Abandon(); }

    std::shared_ptr<Scene const> const& CurrentScene() const { return _scene; }  ///< null: none yet
    Document const* CurrentDocument() const { return _document.get(); }
    bool IsNewModel() { return std::exchange(_isNewModel, false); }  ///< since the last call
    std::string const& Message() const { return _message; }
    void Say(std::string message) { _message = std::move(message); }

    // What is picked. Edges are known by their vertices, so that they outlive a change of level.
    std::vector<EdgeKey> const& SelectedEdges() const { return _edges; }
    std::vector<int> const& SelectedVertices() const { return _vertices; }
    Selection ShownSelection() const;
    Pick const& Hovered() const { return _hovered; }
    void Hover(Pick const& pick) { _hovered = pick; }
    /// Selects what `pick` found, alone or in addition; nothing found clears.
    void Select(Pick const& pick, bool isAdded);
    void SelectNone();
    void SelectAllCreases();
    /// The next edge (`step` 1) or the one before (-1), in the order of the model.
    void SelectNextEdge(int step);
    void SelectNextVertex(int step);
    void ExtendToChains();

    // Editing; each change is shown and can be undone.
    /// The sharpness of all that is selected; nothing where it differs or nothing is selected.
    std::optional<float> SelectedSharpness() const;
    /// Changes of one `gesture` (not 0) are undone together.
    void SetSelectedSharpness(float sharpness, int gesture = 0);
    void ClearAllSharpness();
    void CreaseByAngle(double degrees);
    void Undo();
    void Redo();

    /// As JSON in one line: what tests and scripts ask for.
    std::string StateText() const;

private:
    struct Request {
        std::int64_t number = 0;
        std::shared_ptr<Document> document;
        Settings settings;
        bool allSubdivided = false;
    };

    void submit(std::shared_ptr<Document> const& document);
    void take(WorkResult const& result);
    template <typename Action>
    void attempt(Action const& action);
    void change(Creases creases, int gesture = 0);
    void dropMissing();

    std::shared_ptr<Document> _document;
    std::shared_ptr<Scene const> _scene;
    Settings _shownSettings;  // those that the scene was made with
    std::vector<Request> _requests;
    std::string _message;
    bool _isNewModel = false;
    std::vector<EdgeKey> _edges;
    std::vector<int> _vertices;
    Pick _hovered;
    SceneWorker _worker;
};

}  // namespace osd_shading::viewer
