// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/shapes.h"

namespace shapes {

std::uint64_t Random::Bits() {
    _state += 0x9E3779B97F4A7C15U;
    std::uint64_t z = _state;
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31U);
}

double Random::Uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(Bits() >> 11U) / 9007199254740992.0);
}

int Random::Below(int count) { return static_cast<int>(Bits() % static_cast<std::uint64_t>(count)); }

namespace {

/// Joins pairs of vertices that share neither a face nor an edge: bow ties and non-manifold edges.
void WeldSomeVertices(Shape& s, Random& random) {
    for (int attempt = 0; attempt < 2; ++attempt) {
        int a = random.Below(s.NumVertices()), b = random.Below(s.NumVertices());
        auto faces = s.Faces();
        bool allowed = a != b;
        for (auto const& f : faces) {
            allowed =
                allowed && !(std::count(f.begin(), f.end(), a) != 0 && std::count(f.begin(), f.end(), b) != 0);
        }
        if (!allowed) continue;
        for (auto& f : faces) std::replace(f.begin(), f.end(), b, a);
        s.SetFaces(faces);
    }
}

/// A random element of `all`.
template <typename T>
T const& OneOf(std::vector<T> const& all, Random& random) {
    return all[static_cast<std::size_t>(random.Below(static_cast<int>(all.size())))];
}

/// Follows edges from a random vertex, away from where it came.
std::vector<int> RandomPath(Shape const& s, Random& random, int length) {
    auto const edges = s.Edges();
    auto const& start = OneOf(edges, random);
    std::vector<int> path{start[0], start[1]};
    while (static_cast<int>(path.size()) <= length) {
        std::vector<int> next;
        for (auto const& e : edges) {
            if (e[0] == path.back() && e[1] != path[path.size() - 2]) next.push_back(e[1]);
            if (e[1] == path.back() && e[0] != path[path.size() - 2]) next.push_back(e[0]);
        }
        if (next.empty()) break;
        path.push_back(OneOf(next, random));
    }
    return path;
}

float RandomSharpness(Random& random, bool infiniteOnly) {
    if (infiniteOnly || random.Chance(0.25)) return kInfinite;
    return static_cast<float>(1 + random.Below(28)) / 8;
}

}  // namespace

Shape RandomShape(std::uint64_t seed, RandomShapeOptions const& options) {
    Random random(seed);
    Shape s;
    switch (random.Below(9)) {
        case 0:
            s = Torus(3 + random.Below(3), 3 + random.Below(2));
            break;
        case 1:
            s = Cube();
            break;
        case 2:
            s = Icosahedron();
            break;
        case 3:
            s = Pyramid(3 + random.Below(5));
            break;
        case 4:
            s = QuadGrid(2 + random.Below(3), 2 + random.Below(3));
            break;
        case 5:
            s = MixedPolygons();
            break;
        case 6:
            s = Tube(3 + random.Below(4), 1 + random.Below(3));
            break;
        case 7:
            s = Cross();
            break;
        default:
            s = Bipyramid(3 + random.Below(5));
            break;
    }
    // Cut some faces along a diagonal or from a new middle vertex, and open some: changes valences and sizes.
    std::vector<std::vector<int>> faces;
    for (auto const& face : s.Faces()) {
        if (face.size() > 3 && random.Chance(0.2)) {
            auto const cut = face.begin() + 2 + random.Below(static_cast<int>(face.size()) - 3);
            std::vector<int> second(cut, face.end());
            second.push_back(face.front());
            faces.emplace_back(face.begin(), cut + 1);
            faces.push_back(second);
        } else if (random.Chance(0.1)) {
            double centre[3] = {0, 0, 0};
            for (int v : face) {
                std::size_t const first = 3 * static_cast<std::size_t>(v);
                for (std::size_t k = 0; k < 3; ++k) {
                    centre[k] += s.positions[first + k] / static_cast<double>(face.size());
                }
            }
            int const middle = s.NumVertices();
            s.Vertex(centre[0], centre[1], centre[2]);
            for (std::size_t i = 0; i < face.size(); ++i) {
                faces.push_back({face[i], face[(i + 1) % face.size()], middle});
            }
        } else if (!random.Chance(0.06) || faces.empty()) {
            faces.push_back(face);
        }
    }
    s.SetFaces(faces);
    if (options.triangles) s.Loop();
    if (options.nonManifold) WeldSomeVertices(s, random);
    s.Jitter(0.15, static_cast<std::uint32_t>(random.Below(1000000)));

    int const numPaths = random.Below(4);
    for (int i = 0; i < numPaths; ++i) {
        auto const path = RandomPath(s, random, 1 + random.Below(7));
        if (random.Chance(0.5)) {
            s.CreasePath(path, RandomSharpness(random, options.infiniteOnly));
        } else {
            for (std::size_t k = 0; k + 1 < path.size(); ++k) {
                s.Crease(path[k], path[k + 1], RandomSharpness(random, options.infiniteOnly));
            }
        }
    }
    if (random.Chance(0.4)) {
        s.Corner(random.Below(s.NumVertices()), RandomSharpness(random, options.infiniteOnly));
    }
    if (random.Chance(0.3)) s.Hole(random.Below(s.NumFaces()));
    s.rules.boundary = random.Chance(0.6)   ? Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER
                       : random.Chance(0.8) ? Sdc::Options::VTX_BOUNDARY_EDGE_ONLY
                                            : Sdc::Options::VTX_BOUNDARY_NONE;
    if (!options.triangles && random.Chance(0.25)) s.SmoothTriangles();
    if (options.chaikin) s.Chaikin();
    s.name = "RandomShape(" + std::to_string(seed) + ")";
    return s;
}

}  // namespace shapes
