// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <vector>

#include "osd_shading/shadingOptions.h"
#include "tests/naiveRefinement.h"

/// The whole method once more, in double, with plain loops and maps: what the library is held to.
///
/// Written from the definition of the method alone, on meshes that it refines by itself (naiveRefinement.h). It
/// shares no code with the library: OpenSubdiv gives it only the limit tangent masks
/// (Sdc::Scheme::ComputeVertexLimitMask). Not covered: `exact` limit tangents, float.
namespace naive {

/// What the method gives at one face corner of the last level.
struct Corner {
    int vertex = 0, value = 0;
    Vec3 position, limitNormal, subdividedNormal, blendedNormal;
    double blendWeight = 0;

    // How much an error of rounding is magnified by normalising: lengths before, relative to what was added up.
    double limitNormalLength = 1, subdividedLength = 1, blendedLength = 1;
};

struct Reference {
    int faceSize = 4;
    std::vector<Corner> corners;  ///< faceSize per face, holes included
    std::vector<char> isHole;     ///< per face
    std::map<int, int> extraordinary, boundaryExtraordinary;
    int numVertices = 0, numValues = 0, sharpVertices = 0, darts = 0, boundaryVertices = 0;
    int nonManifoldVertices = 0, nonManifoldEdges = 0;
    int verticesWithWeight = 0, zeroStartNormals = 0, fallbackNormals = 0, opposedNormals = 0, zeroNormals = 0;
    double minSubdividedLength = -1;
    double startNormalLength = 1;  ///< smallest of the start normals' sums, relative to what was added up
};

/// User normals: at most one of the two is given.
struct UserNormals {
    std::vector<Vec3> perVertex, perFaceCorner;
};

/// Shades with the last level of `hierarchy`, whatever `options.level` says.
Reference Shade(Hierarchy const& hierarchy, osd_shading::ShadingOptions const& options,
                UserNormals const& normals = {});

}  // namespace naive
