// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opensubdiv/far/topologyRefiner.h>

#include <cstddef>
#include <cstdint>
#include <memory>

#include "osd_shading/controlMesh.h"
#include "osd_shading/errors.h"
#include "osd_shading/export.h"
#include "osd_shading/shadingInput.h"
#include "osd_shading/shadingOptions.h"
#include "osd_shading/views.h"

namespace osd_shading {
inline namespace v1 {

namespace Far = OpenSubdiv::OPENSUBDIV_VERSION::Far;

/// The level of a LimitSurface that is left to the library: see there.
constexpr int kDefaultSurfaceLevel = -1;
/// The highest level of a LimitSurface.
constexpr int kMaxSurfaceLevel = 10;

/// The defaults, variant B, for a LimitSurface whose level is left to the library. [ZBK23]
inline ShadingOptions SurfacePreset() {
    ShadingOptions options;
    options.level = kDefaultSurfaceLevel;
    return options;
}

/// A point of a face, as OpenSubdiv's Bfr parametrises faces: quads over [0, 1]^2 from vertex 0 to vertex 1 (u) and
/// to the last vertex (v); triangles of Loop over u, v >= 0, u + v <= 1; n-gons of Catmull-Clark by their quads,
/// laid out as Bfr::Parameterization does.
template <typename Real>
struct SurfaceParameter {
    Real u = 0;  ///< outside the face it is moved to its border; NaN counts as 0
    Real v = 0;  ///< likewise
};

/// Which derivatives a SurfacePoint holds.
enum class SurfaceDerivatives {
    First,  ///< du and dv (default)
    Second  ///< second derivatives of the position too, and first ones of N_B
};

/// What is known of a point of the limit surface.
template <typename Real>
struct SurfacePoint {
    Vec3<Real> position;          ///< on the limit surface
    Vec3<Real> du;                ///< derivative of the position by u
    Vec3<Real> dv;                ///< derivative of the position by v
    Vec3<Real> limitNormal;       ///< N_L, of unit length; zero where nothing gives one
    Vec3<Real> subdividedNormal;  ///< N_S, of unit length; zero where b = 0
    Vec3<Real> blendedNormal;     ///< N_B, of unit length or zero
    Real blendWeight = 0;         ///< b, in [0, 1]

    Vec3<Real> duu;       ///< second derivative of the position, where asked for; zero at extraordinary vertices
    Vec3<Real> duv;       ///< as above, by u and v
    Vec3<Real> dvv;       ///< as above, by v
    Vec3<Real> normalDu;  ///< of N_B by u; as above
    Vec3<Real> normalDv;  ///< of N_B by v; as above
};

/// Counts of a LimitSurface; they grow as it is used.
struct LimitSurfaceStats {
    std::int64_t builtFaces = 0;    ///< control faces that were evaluated
    std::int64_t faceClasses = 0;   ///< different neighbourhoods among them
    std::int64_t limitClasses = 0;  ///< different neighbourhoods further down
    std::size_t bytes = 0;          ///< of the faces that were built
};

/// The limit surface of a control mesh with its shading, at any point of any face.
///
/// P, du and dv are those of OpenSubdiv's limit surface; b and N_S are the limit fields that uniform shading takes
/// at the vertices of its last level, between these vertices too: continuous over faces where the surface is
/// smooth, and one-sided at creases. At the points of level `options.level` all numbers are those of
/// ShadeSubdivision.
///
/// The level L is where weights stop being seeded, and what is still sharp there is infinitely sharp. Left to the
/// library (the default) it is the largest of 1, the start levels, and the largest finite sharpness rounded up (at
/// most 6 of a mesh with non-manifold vertices, where 8 can be given). Options that only a mesh has are refused:
/// other than limit positions and linear averaging, N_L by face averages, and the schemes InverseLimit and
/// Bilinear. So are, as InvalidControlMesh, a mesh with a vertex of two non-manifold edges where a region begins
/// and ends at one of them, and one with triangles of Loop that share two edges.
///
/// A face is built when it is first evaluated, from the faces up to two (with start levels 0, by Chaikin's rule or
/// ExtraordinaryOnly, up to four) rings round it; equal neighbourhoods share what does not depend on positions.
/// Near an irregular vertex patches get smaller without end, by OpenSubdiv's own masks: nothing is approximated. At
/// the vertex itself limits are those of `options.limits.normals`: with Limit, OpenSubdiv's masks, which jump from
/// their surroundings at irregular crease and boundary vertices and darts; with Exact nothing jumps.
///
/// Safe to use from any number of threads. Copies share everything.
template <typename Real>
class LimitSurface {
public:
    /// `mesh` is not needed any more afterwards; the arrays of `input` are read when faces are built, and must
    /// outlive the surface and stay as they are. Of `input` positions and normals count.
    ///
    /// ERRORS: InvalidControlMesh, InvalidOptions; nothing else but std::bad_alloc, also from Evaluate.
    /// COST: that of validating the mesh.
    explicit LimitSurface(ControlMesh const& mesh, ShadingInput<Real> const& input,
                          ShadingOptions const& options = SurfacePreset());

    /// From level 0 of an existing refiner, refined or not, which is not modified and must outlive the surface.
    explicit LimitSurface(Far::TopologyRefiner const& refiner, ShadingInput<Real> const& input,
                          ShadingOptions const& options = SurfacePreset());

    /// The same mesh with other positions: shares what does not depend on them.
    LimitSurface Moved(ShadingInput<Real> const& input) const;

    ShadingInput<Real> const& Input() const;  ///< the views that were given
    ShadingOptions const& Options() const;    ///< as resolved: no level is left to the library
    Far::TopologyRefiner const& Refiner()
        const;                     ///< whose level 0 is the control mesh; lives as long as the surface
    int NumFaces() const;          ///< of the control mesh
    int FaceSize(int face) const;  ///< its vertices. REQUIRES: 0 <= face < NumFaces(), here and below
    bool IsHole(int face) const;   ///< holes can be evaluated as other faces

    /// The point at (u, v) of a control face.
    ///
    /// COST: some 16 terms a number; near irregular vertices up to a microsecond for each halving of the distance
    /// beyond the sixth. The first time on a face: to build it, some 10 microseconds, or a millisecond for a
    /// neighbourhood that is new.
    SurfacePoint<Real> Evaluate(int face, Real u, Real v,
                                SurfaceDerivatives derivatives = SurfaceDerivatives::First) const;

    /// The points at all `parameters`, written to `points`, which has room for as many.
    void Evaluate(int face, ArrayView<SurfaceParameter<Real>> parameters, SurfacePoint<Real>* points,
                  SurfaceDerivatives derivatives = SurfaceDerivatives::First) const;

    LimitSurfaceStats Stats() const;  ///< as far as it was used, by all copies that were not moved

private:
    struct Topology;
    struct Faces;
    LimitSurface() = default;

    std::shared_ptr<Topology const> _topology;
    std::shared_ptr<Faces const> _faces;
};

#define OSD_SHADING_DECLARE(Real) extern template class OSD_SHADING_API LimitSurface<Real>;
OSD_SHADING_DECLARE(float)
OSD_SHADING_DECLARE(double)
#undef OSD_SHADING_DECLARE

}  // namespace v1
}  // namespace osd_shading
