// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "methodOptions.h"
#include "osd_shading/io/model.h"

namespace osd_shading::viewer {

/// A control edge: its vertices, the lower number first.
using EdgeKey = std::array<int, 2>;
inline EdgeKey MakeEdgeKey(int a, int b) { return a < b ? EdgeKey{a, b} : EdgeKey{b, a}; }

/// All sharpness of a model, as one edits it; what is not there is smooth.
struct Creases {
    std::map<EdgeKey, float> edges;
    std::map<int, float> vertices;

    bool operator==(Creases const&) const = default;
};

/// A model whose creases are edited, with all states that they had.
class Document {
public:
    /// Reads `name` as LoadModel does, and applies what `options` change in it.
    ///
    /// ERRORS: those of reading a model.
    Document(std::string name, tool::MeshOptions const& options);

    std::string const& Name() const { return _name; }
    /// With the creases as they are now; another object after each change.
    std::shared_ptr<io::Model const> const& Model() const { return _model; }
    Creases const& CurrentCreases() const { return _states[_current]; }

    /// Changes of one `gesture` (but 0), such as a drag of a slider, are one state.
    void Change(Creases creases, int gesture = 0);
    bool CanUndo() const { return _current > 0; }
    bool CanRedo() const { return _current + 1 < _states.size(); }
    void Undo();
    void Redo();
    /// Whether creases differ from those that were read or saved last.
    bool IsChanged() const { return CurrentCreases() != _saved; }
    void MarkSaved() { _saved = CurrentCreases(); }

private:
    void update();

    std::string _name;
    std::shared_ptr<io::Model const> _model;
    std::vector<Creases> _states;
    std::size_t _current = 0;
    int _gesture = 0;
    Creases _saved;
};

/// The OBJ files of the folder that holds `name`, or of the current one where that is no file, in order; no more
/// than a list can hold (1000).
std::vector<std::string> FilesBeside(std::string const& name);

}  // namespace osd_shading::viewer
