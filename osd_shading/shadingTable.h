// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opensubdiv/far/topologyRefiner.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "osd_shading/controlMesh.h"
#include "osd_shading/errors.h"
#include "osd_shading/export.h"
#include "osd_shading/shadingOptions.h"

namespace osd_shading {
inline namespace v1 {

namespace Far = OpenSubdiv::OPENSUBDIV_VERSION::Far;

namespace tables {
struct TableData;
}

/// In which order a table's values are numbered.
enum class ValueOrder {
    Tiles,      ///< the faces of a tile together: as fast as it gets, and good for a GPU's vertex cache (default)
    OpenSubdiv  ///< that of ShadingResult: vertices in OpenSubdiv's order, values after their vertices. Slower to
                ///< build (every level is refined) and to evaluate (each value is moved once more)
};

/// Counts of a table.
struct ShadingTableStats {
    std::int64_t values = 0;          ///< (vertex, region) pairs
    std::int64_t faces = 0;           ///< without holes
    std::int64_t tiles = 0;           ///< control faces, or children of n-gons
    std::int64_t regularTiles = 0;    ///< of those, evaluated as one B-spline patch (in Loop: as one box spline)
    std::int64_t blendedTiles = 0;    ///< of those, with b > 0 somewhere
    std::int64_t blendedValues = 0;   ///< values with b > 0: the support of b
    std::int64_t classes = 0;         ///< different neighbourhoods in the dictionary, at any level
    std::int64_t denseMatrices = 0;   ///< different matrices in it
    std::int64_t startNormals = 0;    ///< start normals that a frame computes
    std::size_t bytes = 0;            ///< of the whole table
    std::size_t dictionaryBytes = 0;  ///< of that: classes and matrices
    double buildSeconds = 0;          ///< wall time of the build
};

/// Everything of a shaded mesh that does not depend on its positions: built once, evaluated for every frame.
///
/// Control faces are tiles. A tile whose neighbourhood is regular is a B-spline patch; any other looks its
/// neighbourhood up in a dictionary, whose entries split into smaller tiles or hold a small dense matrix, compiled
/// in double precision from OpenSubdiv's own masks. Numbers agree with ShadeSubdivision in double: positions to
/// 2e-7 of the model's size, normals to 1e-5 over the shortest vector normalised on the way.
///
/// Immutable, cheap to copy (copies share everything), safe to share between threads.
class OSD_SHADING_API ShadingTable {
public:
    /// `mesh` and its arrays are not needed any more afterwards.
    ///
    /// All options hold but `subdividedNormals.averaging`, which must be Linear. `execution` counts for the build.
    ///
    /// ERRORS: InvalidControlMesh (also, in Loop from level 3 on, for two faces that share two edges),
    /// InvalidOptions, MemoryLimitExceeded, Cancelled; nothing else but std::bad_alloc. COST: small beside
    /// OpenSubdiv's limit stencil table; near a vertex of N faces it grows with N squared.
    explicit ShadingTable(ControlMesh const& mesh, ShadingOptions const& options = {},
                          ValueOrder order = ValueOrder::Tiles);

    /// From level 0 of an existing refiner, refined or not, which is not modified or needed afterwards.
    explicit ShadingTable(Far::TopologyRefiner const& refiner, ShadingOptions const& options = {},
                          ValueOrder order = ValueOrder::Tiles);

    ShadingOptions const& Options() const;  ///< as resolved: start levels are never kDefaultStartLevel
    ValueOrder Order() const;               ///< as asked for when it was built
    int NumControlVertices() const;         ///< points that a frame takes
    int NumControlFaceCorners() const;      ///< normals that a frame takes, where the caller's are per face corner
    int NumValues() const;                  ///< of what a frame writes: (vertex, region) pairs
    int NumFaces() const;                   ///< of the shaded mesh, without holes
    int FaceSize() const;                   ///< vertices of such a face: 4, or 3 in Loop
    /// Bytes of the whole table; copies share them.
    std::size_t NumBytes() const { return Stats().bytes; }
    ShadingTableStats const& Stats() const;  ///< counts, found when it was built

    /// Index buffer: the value of each corner, FaceSize() per face, counter-clockwise, the faces of a tile
    /// together.
    std::vector<int> FaceValues() const;
    /// The same as triangles, three per face; quads are cut from their first corner.
    std::vector<int> TriangleValues() const;
    /// Per face, in the same order: the face of the control mesh.
    std::vector<int> BaseFaces() const;
    /// Per value: its number in the ShadingResult of the same mesh and options. Refines every level: slow.
    std::vector<int> ResultValues() const;
    /// Per value: OpenSubdiv's vertex at the last level. Refines every level: slow.
    std::vector<int> RefinedVertices() const;
    /// Per value: the limit of b, in [0, 1].
    std::vector<float> BlendWeights() const;

    /// Internal.
    std::shared_ptr<tables::TableData const> const& SharedData() const { return _data; }

private:
    std::shared_ptr<tables::TableData const> _data;
};

}  // namespace v1
}  // namespace osd_shading
