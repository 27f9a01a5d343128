// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <set>
#include <string>

#include "viewer/builtInModels.h"
#include "viewer/edgeChains.h"
#include "viewer/sceneBuilder.h"

/// What the tests of the viewer's parts share: built-in models as scenes, and their edges.
namespace osd_shading::viewer {

inline std::shared_ptr<Scene const> SceneOf(std::string const& name, int level,
                                            Sdc::SchemeType scheme = Sdc::SCHEME_CATMARK,
                                            bool allSubdivided = false) {
    auto const model = std::make_shared<io::Model>(LoadModel(name));
    SubdivisionRules rules;
    rules.scheme = scheme;
    SceneBuilder builder;
    return builder.Build({model, name, model->Rules(rules), PaperPreset(level), allSubdivided, {}},
                         [](double) { return true; });
}

inline std::set<EdgeKey> EdgesOf(io::Model const& model) {
    std::set<EdgeKey> edges;
    std::size_t first = 0;
    for (int size : model.faceSizes) {
        auto const count = static_cast<std::size_t>(size);
        for (std::size_t i = 0; i < count; ++i) {
            edges.insert(MakeEdgeKey(model.faceVertices[first + i], model.faceVertices[first + (i + 1) % count]));
        }
        first += count;
    }
    return edges;
}

}  // namespace osd_shading::viewer
