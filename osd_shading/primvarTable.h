// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opensubdiv/far/topologyRefiner.h>

#include <cstddef>
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

/// Writable view over `count` elements, element i at `data + i * stride`; as wide as what is written to it.
///
/// `stride` counts `Real`s and is at least the width; 0: packed, the width itself. What lies between elements is
/// left alone.
template <typename Real>
struct PrimvarSpan {
    Real* data = nullptr;    ///< the first number of the first element
    std::size_t count = 0;   ///< elements
    std::size_t stride = 0;  ///< in `Real`s; 0: packed
};

/// Turns control values of a primvar, of any width, into refined ones. `Real`: float or double, also of the
/// weights.
///
/// Immutable, cheap to copy (copies share everything), safe to share between threads.
template <typename Real>
class OSD_SHADING_API PrimvarRows {
public:
    /// \name Life
    /// @{

    /// Copies share what they hold; a default one has no rows.
    PrimvarRows();
    ~PrimvarRows();
    PrimvarRows(PrimvarRows const&);
    PrimvarRows(PrimvarRows&&) noexcept;
    PrimvarRows& operator=(PrimvarRows const&);
    PrimvarRows& operator=(PrimvarRows&&) noexcept;
    /// @}

    int NumControlValues() const;  ///< what a row is a sum of
    int NumRows() const;           ///< refined values
    std::size_t NumBytes() const;  ///< memory that the rows take; copies share it

    /// Row i is this object's row rows[i]: any number of them, in any order, also repeated.
    ///
    /// ERRORS: InvalidOptions where rows[i] is not 0 to NumRows() - 1.
    PrimvarRows Reordered(ArrayView<int> rows) const;

    /// Writes refined value i to element i of `refined`, which must have NumRows().
    ///
    /// Nothing is allocated with one thread (several are started on each call; those who have threads call
    /// `EvaluateRange`). The result is the same bits whatever their number. Control values are not checked: a NaN
    /// spoils what depends on it.
    ///
    /// ERRORS: InvalidOptions where a view has the wrong size, a null pointer, no width or too small a stride, or
    /// the number of threads is negative (0: as many as the machine has).
    void Evaluate(PrimvarView<Real> control, PrimvarSpan<Real> refined, int numThreads = 1) const;

    /// The same for rows `begin` to `end` - 1 alone. Calls with different ranges may run at the same time.
    void EvaluateRange(PrimvarView<Real> control, PrimvarSpan<Real> refined, int begin, int end) const;

    struct Data;
    /// Internal.
    explicit PrimvarRows(std::shared_ptr<Data const> data);

private:
    std::shared_ptr<Data const> _data;
};

/// A face-varying channel of the control mesh.
struct FaceVaryingChannel {
    ArrayView<int> indices;  ///< per face corner: a value, 0 to numValues - 1
    int numValues = 0;       ///< control values of the channel
};

/// The rows of one face-varying channel.
template <typename Real>
struct FaceVaryingRows {
    PrimvarRows<Real> values;      ///< per refined value
    std::vector<int> faceIndices;  ///< per face corner, holes left out: index of a value
};

/// Primvars of a mesh whose control values change: built once, evaluated for every frame.
///
///     auto const table = BuildPrimvarTable<float>(mesh, {{uvIndices, numUvs}}, PaperPreset(4));
///     table.faceVarying[0].values.Evaluate({uvs, numUvs, 2}, {refinedUvs, numRefinedUvs});
///
/// Numbers are those of ShadeSubdivision's `vertexData` and `faceVaryingData`, by OpenSubdiv's own rules: to 1e-12
/// of the largest control value in double, 1e-6 in float.
///
/// For the values and faces of a ShadingTable:
///
///     table.vertexData.Reordered(shadingTable.RefinedVertices())      one row per value
///     MatchFaceCorners(table.faceVertices, its faces, table.faceSize)   where the faces' corners are
template <typename Real>
struct PrimvarTable {
    PrimvarRows<Real> vertexData;  ///< per vertex of the last level, OpenSubdiv's order: refined as positions are
    std::vector<FaceVaryingRows<Real>> faceVarying;  ///< per channel

    int faceSize = 4;               ///< vertices of a face: 4 or 3
    std::vector<int> faceVertices;  ///< faceSize per face, as ShadingResult::faceVertices
};

/// Builds the table of a control mesh and its channels.
///
/// Of `options`, `level`, `limits.positions` and `execution` count: pass those of what is shaded.
///
/// ERRORS: InvalidControlMesh (also where a channel has the wrong number of indices, or one that names no value),
/// InvalidOptions, MemoryLimitExceeded, Cancelled; nothing else but std::bad_alloc.
/// COST: some 16 weights (Loop: 12) for each refined value.
template <typename Real>
PrimvarTable<Real> BuildPrimvarTable(ControlMesh const& mesh, std::vector<FaceVaryingChannel> const& channels,
                                     ShadingOptions const& options = {});

/// From level 0 of an existing refiner, with all its channels; it is not modified or needed afterwards.
template <typename Real>
PrimvarTable<Real> BuildPrimvarTable(Far::TopologyRefiner const& refiner, ShadingOptions const& options = {});

/// Finds the faces of the index buffer `wanted` in `faces`: per corner of `wanted`, the number of the same corner
/// in `faces` (faceSize * face + corner). Faces may come in any order and begin at any corner.
///
/// With it, `faceIndices` of a channel follow another order of faces:
///
///     std::vector<int> corners = MatchFaceCorners(table.faceVertices, wanted, table.faceSize);
///     for (int& corner : corners) corner = table.faceVarying[0].faceIndices[corner];
///
/// or, one row per corner, `values.Reordered(corners)` with the corners so found. Where faces have the same
/// vertices in the same order, the first found is taken first; index buffers of values (ShadingResult::faceValues)
/// tell them apart.
///
/// ERRORS: InvalidOptions where `faceSize` is less than 3 or divides no buffer's size, or a face is not found.
/// COST: sorts the corners of `faces`.
OSD_SHADING_API std::vector<int> MatchFaceCorners(ArrayView<int> faces, ArrayView<int> wanted, int faceSize);

#define OSD_SHADING_DECLARE(Real)                                                                     \
    extern template class OSD_SHADING_API PrimvarRows<Real>;                                          \
    extern template OSD_SHADING_API PrimvarTable<Real> BuildPrimvarTable(                             \
        ControlMesh const&, std::vector<FaceVaryingChannel> const&, ShadingOptions const&);           \
    extern template OSD_SHADING_API PrimvarTable<Real> BuildPrimvarTable(Far::TopologyRefiner const&, \
                                                                         ShadingOptions const&);
OSD_SHADING_DECLARE(float)
OSD_SHADING_DECLARE(double)
#undef OSD_SHADING_DECLARE

}  // namespace v1
}  // namespace osd_shading
