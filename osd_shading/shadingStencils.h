// SPDX-License-Identifier: Apache-2.0
#pragma once

/// \file
/// For those who run OpenSubdiv's evaluators already; `ShadingTable` is faster and needs less memory.

#include <opensubdiv/far/stencilTable.h>
#include <opensubdiv/far/topologyRefiner.h>

#include <memory>
#include <vector>

#include "osd_shading/controlMesh.h"
#include "osd_shading/errors.h"
#include "osd_shading/export.h"
#include "osd_shading/shadingOptions.h"
#include "osd_shading/views.h"

namespace osd_shading {
inline namespace v1 {

namespace Far = OpenSubdiv::OPENSUBDIV_VERSION::Far;

/// Stencils, in the arrays that OpenSubdiv's evaluators take: row i is the sum of weights[k] * source[indices[k]]
/// over the sizes[i] entries from k = offsets[i] on.
///
/// Composed in double and rounded once. A row may be empty: its sum is zero.
struct StencilRows {
    int numSources = 0;            ///< indices are 0 to numSources - 1, ascending in each row
    std::vector<int> sizes;        ///< per row: its number of entries
    std::vector<int> offsets;      ///< per row: its first entry
    std::vector<int> indices;      ///< per entry: which source
    std::vector<float> weights;    ///< per entry: its weight; any sign
    std::vector<float> duWeights;  ///< as `weights`, for du; empty where rows have none
    std::vector<float> dvWeights;  ///< likewise for dv

    /// Rows, which is what an evaluator writes.
    int NumRows() const { return static_cast<int>(sizes.size()); }

    /// \name For OpenSubdiv's evaluators
    /// @{

    /// What the templates of Osd::CpuEvaluator and Osd::OmpEvaluator ask of a stencil table: give them the address
    /// of this struct.
    int GetNumStencils() const { return NumRows(); }
    int GetNumControlVertices() const { return numSources; }
    std::vector<int> const& GetSizes() const { return sizes; }
    std::vector<int> const& GetOffsets() const { return offsets; }
    std::vector<int> const& GetControlIndices() const { return indices; }
    std::vector<float> const& GetWeights() const { return weights; }
    std::vector<float> const& GetDuWeights() const { return duWeights; }
    std::vector<float> const& GetDvWeights() const { return dvWeights; }
    /// @}
};

/// A copy as OpenSubdiv's own table, which the buffers of its GPU evaluators are made from
/// (Osd::GLStencilTableSSBO, Osd::GLStencilTableTBO, Osd::CudaStencilTable).
OSD_SHADING_API std::unique_ptr<Far::StencilTable const> MakeFarStencilTable(StencilRows const& rows);
/// The same with the weights of du and dv. REQUIRES: `rows` has them.
OSD_SHADING_API std::unique_ptr<Far::LimitStencilTable const> MakeFarLimitStencilTable(StencilRows const& rows);

/// Unit normals that are no sum of points: each the normalised sum, over its corners, of the face's unit normal
/// times the corner's weight. Faces without area add nothing.
struct FaceAverages {
    StartNormalKind weight = StartNormalKind::Uniform;  ///< Uniform, CornerArea or Angle

    std::vector<int> faceSizes;     ///< of a refined mesh, per face: number of corners
    std::vector<int> faceVertices;  ///< per corner of those faces: a point, numbered as the rows of
                                    ///< NormalStencils::points

    std::vector<int> normals;  ///< per entry: which normal it is; ascending
    std::vector<int> offsets;  ///< per entry and one more: its first corner
    std::vector<int> faces;    ///< per corner: its face
    std::vector<int> corners;  ///< per corner: its place in the face, 0 to faceSizes[face] - 1
};

/// How the unit normals of a level's (vertex, region) values are made from the control points.
///
///     those in averages.normals   by the faces, whose points `points` gives
///     all others                  normalize(du x dv), by `frames`
///
/// `ComputeUnitNormals` does it.
struct NormalStencils {
    std::vector<int> vertices;  ///< per normal: OpenSubdiv's vertex at the level
    /// Control points to P (the position), du and dv, per normal. Tangents are those of the normal's own region,
    /// OpenSubdiv's limit masks; du x dv points outwards. du and dv are zero for normals in `averages`: corner
    /// regions of several faces, which have no tangent plane, and regions whose tangents vanish or are parallel
    /// whatever the positions.
    StencilRows frames;
    StencilRows points;              ///< control points to points of the level's mesh, without limit
    std::vector<int> pointVertices;  ///< per row of `points`: OpenSubdiv's vertex; ascending
    FaceAverages averages;           ///< of the normals that `frames` doesn't give
};

/// The method as stencils: everything of a shaded mesh that does not depend on its positions.
///
///     P, du, dv   limits.frames * control points
///     N_L         ComputeUnitNormals(limits, du, dv, limits.points * control points)
///     n           start normals, by kind:
///                   Uniform, CornerArea, Angle   from starts.points alone (all of M_n, OpenSubdiv's order)
///                   Limit                        as N_L, with `starts` in place of `limits`
///                   LimitSmoothed                that, then normalize(startSmoothing * n)
///                   User                         normalize(userNormals * normals of the face corners); or, from
///                                                normals m of the vertices, normalize(m[starts.vertices[i]])
///     N_S         normalize(subdividedNormals * n), where blendWeights > 0
///     N_B         normalize((1 - b^p) N_L + b^p N_S), with b = blendWeights
///
/// Values, vertices and faces are numbered as in ShadingResult. Left to the caller is what depends on the
/// positions: where tangents are degenerate (du x dv vanishes), ShadeSubdivision takes the faces' average instead.
struct ShadingStencils {
    ShadingOptions options;       ///< as resolved: start levels are never kDefaultStartLevel
    int faceSize = 4;             ///< vertices of a face: 4 or 3
    std::vector<int> faceValues;  ///< faceSize per face, holes left out: the value of each corner

    NormalStencils limits;            ///< of the values at level L; frames give P by options.limits.positions
    std::vector<float> blendWeights;  ///< per value: the limit of b, in [0, 1]

    NormalStencils starts;       ///< of the start normals, one per (vertex, region) of M_n
    StencilRows startSmoothing;  ///< LimitSmoothed: start normals to start normals; otherwise no rows
    StencilRows userNormals;     ///< User: face corners to start normals; otherwise no rows
    /// Per value: start normals to N_S; empty rows where b = 0. Without rows where b = 0 everywhere: OpenSubdiv's
    /// evaluators must not be given rows without any index.
    StencilRows subdividedNormals;

    /// (vertex, region) pairs of the last level.
    int NumValues() const { return static_cast<int>(blendWeights.size()); }
};

/// Builds the stencils of a mesh. All options hold, but subdividedNormals.averaging must be Linear.
///
/// ERRORS: as ShadeSubdivision; InvalidOptions for other averaging; MemoryLimitExceeded, before anything large is
/// taken, also where a table would have more than 2^31 - 1 indices.
/// COST: a row has some 16 indices (Loop: 12) on regular ground, and as many as a control vertex of N faces has
/// around it near that: some 300 bytes for each face of level L, 1,200 while building; some 5 microseconds a value.
OSD_SHADING_API ShadingStencils BuildShadingStencils(ControlMesh const& mesh, ShadingOptions const& options = {});

/// From level 0 of an existing refiner, refined or not, which is not modified or needed afterwards.
OSD_SHADING_API ShadingStencils BuildShadingStencils(Far::TopologyRefiner const& refiner,
                                                     ShadingOptions const& options = {});

/// Turns what the tables give into unit normals, on the CPU: one per normal of `stencils`; zero where nothing is
/// left to normalise (to a relative 1e-6).
///
/// `du` and `dv` are those of `stencils.frames`, `points` those of `stencils.points`; a view is empty where the
/// table has no rows.
///
/// ERRORS: InvalidOptions where a view has the wrong size, a null pointer or too small a stride.
OSD_SHADING_API void ComputeUnitNormals(NormalStencils const& stencils, PointView<float> du, PointView<float> dv,
                                        PointView<float> points, std::vector<Vec3<float>>& normals);

}  // namespace v1
}  // namespace osd_shading
