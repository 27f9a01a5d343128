// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/controlMesh.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <unordered_map>
#include <vector>

#include "osd_shading/errors.h"
#include "osd_shading/numberText.h"

namespace osd_shading {
inline namespace v1 {

namespace {

// OpenSubdiv keeps sizes and valences in 16 bits.
constexpr int kLargestFace = 65535;

// It numbers vertices, faces and edges with int, and keeps two numbers for each in one array.
constexpr int kMostElements = std::numeric_limits<int>::max() / 2;

[[noreturn]] void fail(std::string const& text) { throw InvalidControlMesh(text); }

template <typename T>
void checkView(ArrayView<T> const& view, char const* name) {
    if (view.size() != 0 && view.data() == nullptr) {
        fail(std::string(name) + " has " + std::to_string(view.size()) + " elements but its pointer is null");
    }
    if (view.size() > static_cast<std::size_t>(kMostElements)) {
        fail(std::string(name) + " has " + std::to_string(view.size()) + " elements; OpenSubdiv takes at most " +
             std::to_string(kMostElements));
    }
}

void checkSharpness(float sharpness, std::string const& element) {
    if (std::isnan(sharpness)) fail("sharpness of " + element + " is not a number; give 0 or more");
    if (sharpness < 0) {
        fail("sharpness of " + element + " is " + NumberText(sharpness) + "; give 0 or more");
    }
}

std::uint64_t edgeKey(int a, int b) {
    auto const low = static_cast<std::uint32_t>(a < b ? a : b), high = static_cast<std::uint32_t>(a < b ? b : a);
    return (static_cast<std::uint64_t>(low) << 32) | high;
}

void checkRules(SubdivisionRules const& rules) {
    auto const check = [](int value, int last, char const* name) {
        if (value >= 0 && value <= last) return;
        fail(std::string("rules.") + name + " is " + std::to_string(value) + ", none that OpenSubdiv has");
    };
    check(rules.scheme, Sdc::SCHEME_LOOP, "scheme");
    check(rules.boundary, Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER, "boundary");
    check(rules.faceVarying, Sdc::Options::FVAR_LINEAR_ALL, "faceVarying");
    check(rules.creasing, Sdc::Options::CREASE_CHAIKIN, "creasing");
    check(rules.triangles, Sdc::Options::TRI_SUB_SMOOTH, "triangles");
    if (rules.scheme != Sdc::SCHEME_CATMARK && rules.scheme != Sdc::SCHEME_LOOP) {
        fail("the bilinear scheme has no normals to subdivide; use Catmull-Clark or Loop");
    }
}

void checkFaces(ControlMesh const& mesh) {
    bool const isLoop = mesh.rules.scheme == Sdc::SCHEME_LOOP;
    // The last face that used each vertex: finds repeated vertices in one pass.
    std::vector<int> lastFace(static_cast<std::size_t>(mesh.numVertices), -1);
    std::size_t corner = 0;
    for (std::size_t f = 0; f < mesh.faceSizes.size(); ++f) {
        int const face = static_cast<int>(f), size = mesh.faceSizes[f];
        if (size < 3) {
            fail("face " + std::to_string(face) + " has " + std::to_string(size) +
                 " vertices; a face needs 3 or more");
        }
        if (size > kLargestFace) {
            fail("face " + std::to_string(face) + " has " + std::to_string(size) +
                 " vertices; OpenSubdiv takes at most 65535");
        }
        if (isLoop && size != 3) {
            fail("face " + std::to_string(face) + " has " + std::to_string(size) +
                 " vertices; Loop subdivision takes triangles only (triangulate, or use Catmull-Clark)");
        }
        if (static_cast<std::size_t>(size) > mesh.faceVertices.size() - corner) {
            fail("faceVertices has " + std::to_string(mesh.faceVertices.size()) +
                 " elements, fewer than faceSizes adds up to (it ends in face " + std::to_string(face) + ")");
        }
        for (int i = 0; i < size; ++i, ++corner) {
            int const v = mesh.faceVertices[corner];
            if (v < 0 || v >= mesh.numVertices) {
                fail("face " + std::to_string(face) + " names vertex " + std::to_string(v) + "; there are " +
                     std::to_string(mesh.numVertices) + " vertices");
            }
            int& last = lastFace[static_cast<std::size_t>(v)];
            if (last == face) {
                fail("face " + std::to_string(face) + " names vertex " + std::to_string(v) + " twice");
            }
            last = face;
        }
    }
    if (corner != mesh.faceVertices.size()) {
        fail("faceVertices has " + std::to_string(mesh.faceVertices.size()) + " elements; faceSizes adds up to " +
             std::to_string(corner));
    }
}

/// OpenSubdiv counts the edges of a vertex in 16 bits too: more than its faces, on boundaries and joins.
void checkValences(ControlMesh const& mesh) {
    std::vector<int> numFaces(static_cast<std::size_t>(mesh.numVertices), 0);
    for (int const v : mesh.faceVertices) {
        if (++numFaces[static_cast<std::size_t>(v)] > kLargestFace) {
            fail("vertex " + std::to_string(v) + " has more than 65535 faces, more than OpenSubdiv takes");
        }
    }
    std::unordered_map<int, std::vector<int>> neighbors;
    for (int v = 0; v < mesh.numVertices; ++v) {
        if (2 * numFaces[static_cast<std::size_t>(v)] > kLargestFace) neighbors[v];
    }
    if (neighbors.empty()) return;
    std::size_t first = 0;
    for (int const size : mesh.faceSizes) {
        auto const n = static_cast<std::size_t>(size);
        for (std::size_t i = 0; i < n; ++i) {
            auto const found = neighbors.find(mesh.faceVertices[first + i]);
            if (found == neighbors.end()) continue;
            found->second.push_back(mesh.faceVertices[first + (i + 1) % n]);
            found->second.push_back(mesh.faceVertices[first + (i + n - 1) % n]);
        }
        first += n;
    }
    for (auto& [v, others] : neighbors) {
        std::sort(others.begin(), others.end());
        if (std::unique(others.begin(), others.end()) - others.begin() > kLargestFace) {
            fail("vertex " + std::to_string(v) + " has more than 65535 edges, more than OpenSubdiv takes");
        }
    }
}

void checkCreases(ControlMesh const& mesh) {
    if (mesh.creaseVertices.size() != 2 * mesh.creaseSharpness.size()) {
        fail("creaseVertices has " + std::to_string(mesh.creaseVertices.size()) + " elements; " +
             std::to_string(mesh.creaseSharpness.size()) + " sharpnesses need two each");
    }
    if (mesh.creaseSharpness.empty()) return;

    std::unordered_map<std::uint64_t, bool> isEdge;
    isEdge.reserve(mesh.creaseSharpness.size());
    for (std::size_t i = 0; i < mesh.creaseSharpness.size(); ++i) {
        int const a = mesh.creaseVertices[2 * i], b = mesh.creaseVertices[2 * i + 1];
        std::string const element =
            "crease " + std::to_string(i) + " (vertices " + std::to_string(a) + ", " + std::to_string(b) + ")";
        for (int const v : {a, b}) {
            if (v < 0 || v >= mesh.numVertices) {
                fail(element + " names vertex " + std::to_string(v) + "; there are " +
                     std::to_string(mesh.numVertices) + " vertices");
            }
        }
        checkSharpness(mesh.creaseSharpness[i], element);
        isEdge.emplace(edgeKey(a, b), false);
    }
    std::size_t first = 0;
    for (int const size : mesh.faceSizes) {
        auto const n = static_cast<std::size_t>(size);
        for (std::size_t i = 0; i < n; ++i) {
            auto const found = isEdge.find(
                edgeKey(mesh.faceVertices[first + i], mesh.faceVertices[first + (i + 1 == n ? 0 : i + 1)]));
            if (found != isEdge.end()) found->second = true;
        }
        first += n;
    }
    for (std::size_t i = 0; i < mesh.creaseSharpness.size(); ++i) {
        int const a = mesh.creaseVertices[2 * i], b = mesh.creaseVertices[2 * i + 1];
        if (!isEdge.at(edgeKey(a, b))) {
            fail("crease " + std::to_string(i) + " names vertices " + std::to_string(a) + " and " +
                 std::to_string(b) + ", which no edge joins");
        }
    }
}

}  // namespace

void ValidateControlMesh(ControlMesh const& mesh) {
    checkView(mesh.faceSizes, "faceSizes");
    checkView(mesh.faceVertices, "faceVertices");
    checkView(mesh.creaseVertices, "creaseVertices");
    checkView(mesh.creaseSharpness, "creaseSharpness");
    checkView(mesh.cornerVertices, "cornerVertices");
    checkView(mesh.cornerSharpness, "cornerSharpness");
    checkView(mesh.holes, "holes");
    checkRules(mesh.rules);
    if (mesh.numVertices <= 0)
        fail("numVertices is " + std::to_string(mesh.numVertices) + "; a mesh needs vertices");
    if (mesh.numVertices > kMostElements) {
        fail("numVertices is " + std::to_string(mesh.numVertices) + "; OpenSubdiv takes at most " +
             std::to_string(kMostElements));
    }
    if (mesh.faceSizes.empty()) fail("the mesh has no faces");
    checkFaces(mesh);
    checkValences(mesh);
    checkCreases(mesh);

    if (mesh.cornerVertices.size() != mesh.cornerSharpness.size()) {
        fail("cornerVertices has " + std::to_string(mesh.cornerVertices.size()) + " elements, cornerSharpness " +
             std::to_string(mesh.cornerSharpness.size()));
    }
    for (std::size_t i = 0; i < mesh.cornerVertices.size(); ++i) {
        int const v = mesh.cornerVertices[i];
        std::string const element = "corner " + std::to_string(i) + " (vertex " + std::to_string(v) + ")";
        if (v < 0 || v >= mesh.numVertices) {
            fail(element + " is out of range; there are " + std::to_string(mesh.numVertices) + " vertices");
        }
        checkSharpness(mesh.cornerSharpness[i], element);
    }
    for (std::size_t i = 0; i < mesh.holes.size(); ++i) {
        if (mesh.holes[i] < 0 || static_cast<std::size_t>(mesh.holes[i]) >= mesh.faceSizes.size()) {
            fail("hole " + std::to_string(i) + " names face " + std::to_string(mesh.holes[i]) + "; there are " +
                 std::to_string(mesh.faceSizes.size()) + " faces");
        }
    }
}

}  // namespace v1
}  // namespace osd_shading
