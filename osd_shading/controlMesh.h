// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opensubdiv/sdc/options.h>
#include <opensubdiv/sdc/types.h>

#include "osd_shading/export.h"
#include "osd_shading/views.h"

namespace osd_shading {
inline namespace v1 {

namespace Sdc = OpenSubdiv::OPENSUBDIV_VERSION::Sdc;

/// How OpenSubdiv refines: scheme and options, in OpenSubdiv's own types.
///
/// One default differs from those of `Sdc::Options`: boundaries interpolate edges and corners (OpenSubdiv's own
/// default would turn every boundary face into a hole).
struct SubdivisionRules {
    Sdc::SchemeType scheme = Sdc::SCHEME_CATMARK;  ///< Catmull-Clark or Loop; bilinear is refused
    Sdc::Options::VtxBoundaryInterpolation boundary =
        Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER;  ///< what boundary edges and corners keep
    Sdc::Options::FVarLinearInterpolation faceVarying =
        Sdc::Options::FVAR_LINEAR_ALL;  ///< OpenSubdiv's rule for UVs and the like, not for normals
    Sdc::Options::CreasingMethod creasing = Sdc::Options::CREASE_UNIFORM;  ///< how a semi-sharp crease fades
    Sdc::Options::TriangleSubdivision triangles =
        Sdc::Options::TRI_SUB_CATMARK;  ///< Catmull-Clark: the rule for triangles
};

/// The topology of a control mesh as plain arrays; views only, nothing is copied or owned.
///
/// Everything that OpenSubdiv accepts is accepted (n-gons in Catmull-Clark, open meshes, holes, several
/// components, isolated vertices, non-manifold joins), in any order.
struct ControlMesh {
    int numVertices = 0;          ///< also those that no face names
    ArrayView<int> faceSizes;     ///< per face: number of vertices, 3 or more (Loop: 3)
    ArrayView<int> faceVertices;  ///< per face corner, counter-clockwise: vertex in [0, numVertices)

    ArrayView<int> creaseVertices;     ///< two vertices per crease entry; they must span an edge
    ArrayView<float> creaseSharpness;  ///< per crease entry: >= 0; 10 and more, +inf included, is infinite
    ArrayView<int> cornerVertices;     ///< vertex of each corner entry
    ArrayView<float> cornerSharpness;  ///< per corner entry: as creaseSharpness
    ArrayView<int> holes;              ///< faces that are refined but left out of the result's faces

    SubdivisionRules rules;  ///< scheme, boundaries, creasing
};
// Where several entries name one edge (or vertex) the highest sharpness counts. OpenSubdiv would take the last.

/// Throws InvalidControlMesh, naming the element, unless `mesh` keeps every condition stated above.
///
/// Refused are only: counts or indices out of range, faces of fewer than 3 vertices or with a repeated vertex,
/// other than triangles in Loop, creases that are no edges, NaN or negative sharpness, null or inconsistent
/// views, rules that OpenSubdiv doesn't have, the bilinear scheme, and more than OpenSubdiv can number (2^30 - 1 of
/// anything, 65535 faces or edges at a vertex).     COST: one pass over the faces; a hash of the crease entries.
OSD_SHADING_API void ValidateControlMesh(ControlMesh const& mesh);

}  // namespace v1
}  // namespace osd_shading
