// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <vector>

#include "osd_shading/controlMesh.h"

namespace osd_shading {
inline namespace v1 {

/// What is round a vertex, as far as its limit depends on it.
enum class RingKind {
    Ring,  ///< a full ring without sharp edge
    Dart,  ///< a full ring whose edge 0 is infinitely sharp
    Fan    ///< a fan between two infinitely sharp edges
};

/// The limit of OpenSubdiv's own rules at a vertex: weights of the vertex, the far ends of its edges
/// (counter-clockwise) and, in Catmull-Clark, the opposite vertices of its faces.
struct ExactLimitMask {
    struct Weights {
        std::vector<double> edges, faces;
        double vertex = 0;
    };
    Weights position;
    bool hasTangentPlane = false;
    Weights tangent1, tangent2;  ///< tangent1 x tangent2 points outwards; zero without tangent plane
};

/// Left eigenvectors of the matrix that refines what is round the vertex, which is recorded from OpenSubdiv.
///
///     position     of eigenvalue 1
///     tangents     of the next two: one is even, one odd under the reflection that maps the fan, or the dart's
///                  ring, to itself; so each is the largest of its own half, and simple there
///
/// A fan's odd tangent is that of the crease itself, eigenvalue 1/2. Where an even or odd eigenvalue of the cross
/// modes is larger (Catmull-Clark: from 5 faces on; Loop: from 7) there is no tangent plane, nor is there one at
/// interior vertices of valence 2. Rings of 3 faces and more, and fans of fewer than are allowed here, are
/// OpenSubdiv's own masks, which are exact.
///
/// REQUIRES: Ring: numFaces = 2; Dart: numFaces >= 2; Fan: numFaces >= 2.
/// COST: two eigenvalue problems of some numFaces rows.   [Stam98]
ExactLimitMask FindExactLimitMask(Sdc::SchemeType scheme, int numFaces, RingKind kind);

/// The most faces round a dart whose mask is exact; beyond, it is OpenSubdiv's. The cost grows with their cube.
constexpr int kLargestExactDart = 128;

}  // namespace v1
}  // namespace osd_shading
