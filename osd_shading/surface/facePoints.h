// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <cstdint>
#include <memory>
#include <vector>

#include "osd_shading/limitSurface.h"
#include "osd_shading/surface/faceClass.h"
#include "osd_shading/surface/patchBasis.h"

namespace osd_shading {
inline namespace v1 {
namespace surface {

/// One control face with its numbers: the lines of its class, for the positions given.
template <typename Real>
class FacePoints {
public:
    /// `cornerOffsets`: of the control mesh's faces, where the caller's normals are by face corner.
    FacePoints(ShadingOptions const& options, FaceClass const& faceClass, tables::TileRing const& cutOut,
               ShadingInput<Real> const& input, std::vector<std::size_t> const& cornerOffsets);

    /// The point at (u, v), inside [0, 1]^2 or the triangle, of a root; `scale`: of its derivatives.
    void Evaluate(double exponent, int root, Real u, Real v, Real scale, bool hasSecond,
                  SurfacePoint<Real>& point) const;

    std::size_t NumBytes() const;

private:
    static constexpr int kLanes = 8;  // position, normal, weight, and one unused
    struct Line {
        Real v[kLanes];
    };
    /// Sums of lines: value, du, dv, then second derivatives.
    struct Sums {
        Real v[6][kLanes];
    };

    void computeCorners(ShadingOptions const& options, FaceClass const& faceClass,
                        std::vector<double> const& lines);
    void evaluateDeep(double exponent, FaceNode const& node, std::uint32_t corners, Real u, Real v, Real scale,
                      bool hasSecond, SurfacePoint<Real>& point) const;
    /// `origin` is added to the position.
    template <typename LineAt>
    void evaluatePatch(double exponent, LineAt const& lineAt, bool hasWeight, std::uint16_t phantoms, Real u,
                       Real v, Real scale, bool hasSecond, Vec3<Real> const& origin,
                       SurfacePoint<Real>& point) const;
    /// The sums of the first `NumLanes` lanes.
    template <int NumLanes, typename LineAt>
    void sumLines(LineAt const& lineAt, Real u, Real v, bool hasSecond, Sums& sums) const;
    template <typename LineAt>
    Vec3<Real> normalOfDoubtfulTangents(LineAt const& lineAt, Sums const& sums, std::uint16_t phantoms, Real u,
                                        Real v) const;

    std::shared_ptr<FacePatches const> _patches;
    bool _isCatmark;
    Vec3<Real> _origin;  // lines hold positions relative to it
    Real _size = 0;      // of those
    std::vector<Line> _lines;
    std::vector<SurfacePoint<Real>> _corners;  // positions relative to the origin, derivatives by their own face
};

}  // namespace surface
}  // namespace v1
}  // namespace osd_shading
