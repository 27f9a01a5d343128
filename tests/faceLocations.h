// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opensubdiv/bfr/parameterization.h>

#include <cstddef>
#include <vector>

#include "osd_shading/refinedTopology.h"

namespace osd_shading::tests {

namespace Bfr = OpenSubdiv::OPENSUBDIV_VERSION::Bfr;

/// A point of a control face.
struct Location {
    int face;
    double u, v;
};
/// Where the corners of the last level's faces lie on the control faces.
inline std::vector<Location> LocationsOf(RefinedTopology const& topology) {
    struct Corners {
        int base;
        double at[4][2];
    };
    int const size = topology.IsCatmark() ? 4 : 3;
    std::vector<Corners> here, next;
    for (int f = 0; f < topology.Level(0).GetNumFaces(); ++f) {
        Corners corners{f, {}};
        int const numVertices = topology.Level(0).GetFaceVertices(f).size();
        Bfr::Parameterization const parametrization(topology.Scheme(), numVertices);
        for (int i = 0; i < size && !parametrization.HasSubFaces(); ++i) {
            parametrization.GetVertexCoord(i, corners.at[i]);
        }
        here.push_back(corners);
    }
    for (int level = 0; level < topology.LastLevel(); ++level) {
        next.assign(static_cast<std::size_t>(topology.Level(level + 1).GetNumFaces()), {});
        for (int f = 0; f < topology.Level(level).GetNumFaces(); ++f) {
            Far::ConstIndexArray const children = topology.Level(level).GetFaceChildFaces(f);
            int const numVertices = topology.Level(level).GetFaceVertices(f).size();
            Bfr::Parameterization const parametrization(topology.Scheme(), numVertices);
            Corners const& parent = here[static_cast<std::size_t>(f)];
            for (int c = 0; c < children.size(); ++c) {
                Corners& child = next[static_cast<std::size_t>(children[c])];
                child.base = parent.base;
                if (parametrization.HasSubFaces()) {
                    double const square[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
                    for (int i = 0; i < 4; ++i) {
                        parametrization.ConvertNormalizedSubFaceToCoord(c, square[i], child.at[i]);
                    }
                    continue;
                }
                auto const middle = [&](int i, int j, double(&at)[2]) {
                    at[0] = (parent.at[i][0] + parent.at[j][0]) / 2;
                    at[1] = (parent.at[i][1] + parent.at[j][1]) / 2;
                };
                if (size == 3 && c == 3) {
                    middle(1, 2, child.at[0]);
                    middle(2, 0, child.at[1]);
                    middle(0, 1, child.at[2]);
                    continue;
                }
                for (int i = 0; i < size; ++i) {
                    if (size == 4 && (i + 2) % 4 == c) {
                        middle(0, 2, child.at[i]);
                    } else {
                        middle(c, i, child.at[i]);
                    }
                }
            }
        }
        here.swap(next);
    }
    std::vector<Location> locations;
    for (Corners const& corners : here) {
        for (int i = 0; i < size; ++i) locations.push_back({corners.base, corners.at[i][0], corners.at[i][1]});
    }
    return locations;
}

}  // namespace osd_shading::tests
