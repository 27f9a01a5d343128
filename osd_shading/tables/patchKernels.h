// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <cstddef>
#include <cstdint>

namespace osd_shading {
inline namespace v1 {

enum class InstructionSet;  // shadingEvaluator.h, which the kernels' own files must not include

/// A leaf of a tile has at most 16 x 16 faces, so 17 x 17 points.
constexpr int kLeafSide = 16;
/// Floats that an array of a leaf's points must have: all points, and what the widest vector writes past them.
constexpr int kLeafCapacity = (kLeafSide + 1) * (kLeafSide + 1) + 2 * 16;
/// Points of one block of a dense matrix; vectors of 4, 8 and 16 lanes divide it.
constexpr int kDenseBlock = 16;

/// x, y, z, 0: a point relative to its tile's origin, or a normal.
struct alignas(16) LocalPoint {
    float v[4];
};

inline LocalPoint operator+(LocalPoint const& a, LocalPoint const& b) {
    return {{a.v[0] + b.v[0], a.v[1] + b.v[1], a.v[2] + b.v[2], a.v[3] + b.v[3]}};
}
inline LocalPoint operator-(LocalPoint const& a, LocalPoint const& b) {
    return {{a.v[0] - b.v[0], a.v[1] - b.v[1], a.v[2] - b.v[2], a.v[3] - b.v[3]}};
}

/// The larger size of each component, without signs.
inline LocalPoint LargerOf(LocalPoint const& a, LocalPoint const& b) {
    LocalPoint c{};
    for (int i = 0; i < 4; ++i) {
        float const size = b.v[i] < 0 ? -b.v[i] : b.v[i];
        c.v[i] = a.v[i] > size ? a.v[i] : size;
    }
    return c;
}
/// The largest component of a point that has no signs: at most its length, and more than half of it.
inline float LengthBound(LocalPoint const& a) {
    float const xy = a.v[0] > a.v[1] ? a.v[0] : a.v[1];
    return xy > a.v[2] ? xy : a.v[2];
}

/// A field of three components at a leaf's points, in the order of the output. Each array holds kLeafCapacity
/// floats and is aligned to 64 bytes; what lies past the points is undefined.
struct FieldArrays {
    float *x, *y, *z;
};

/// `count` points of row `row` (v), from column `first` (u) on. A leaf's points are its segments, one after
/// another.
struct RowSegment {
    std::uint8_t row, first, count;
};

/// The points of a regular leaf that it writes.
struct RowPlan {
    RowSegment const* segments;
    int numSegments;
    int numPoints;
    int firstColumn, lastColumn;  ///< over all segments, inclusive
};

/// Uniform cubic B-splines at the parameters i of a leaf's row or column, i = 0 .. 16 at most.
///
/// One face with parameters in [0, 1]: control points 0 to 3 surround it. A grid of `gridSize` > 1 faces has
/// gridSize + 3 of them, and parameter i lies in face i >> shift with the weights `value[j][i]` for control point
/// (i >> shift) + j; at the very end that names one control point too many, with weight 0.
struct SplineBasis {
    static constexpr int kPitch = 48;  ///< vectors may read past the last parameter; zeros there
    int numParameters;                 ///< 2^k + 1, where the leaf spans a face or grid; fewer in a window of it
    int gridSize;                      ///< faces along a side: 1, 2, 4, 8 or 16
    int shift;                         ///< log2 of the parameters in a face of the grid
    alignas(64) float value[4][kPitch];
    alignas(64) float slope[3][kPitch];  ///< quadratic B-splines, on differences of control points; gridSize 1 only
};

/// A matrix from local points to a leaf's points, for `numFields` fields (position and two tangents: 3; one: 1).
///
/// Weights: [block of kDenseBlock points][column][field][kDenseBlock], zeros past the last point; 64-byte aligned.
struct DenseMatrix {
    int numPoints, numColumns, numFields;
    float const* weights;
};

/// What `finish` reads and writes; null pointers and fields leave a part out.
struct LeafFrame {
    int numPoints;
    float origin[3];                 ///< added to positions
    FieldArrays position;            ///< relative to `origin`
    FieldArrays tangent1, tangent2;  ///< x null: no N_L is needed (b is 1 everywhere, or positions alone)
    float doubt1, doubt2;            ///< how far a tangent must reach across the other, or it is doubtful
    FieldArrays subdivided;          ///< N_S, not normalised; x null: b is 0 everywhere
    float const* blend;              ///< b^p per point, in [0, 1]; null with `subdivided`: 1 everywhere

    // Outputs of point 0, in floats from point to point; null: not wanted. `width` 3 writes x y z alone.
    struct Output {
        float* data;
        std::size_t stride;
    };
    Output positions, blendedNormals, limitNormals, subdividedNormals;

    std::uint16_t* doubtful;  ///< points whose N_L or N_B is doubtful, ascending; room for numPoints
    int numDoubtful;          ///< set by `finish`
};

/// The inner loops of a frame, compiled for one instruction set. All are exact functions of their arguments: the
/// same bits on every call, whatever lies in the padding (NaN too).
struct PatchKernels {
    char const* name;  ///< "portable", "sse2", "avx2", "avx512"
    int numLanes;

    /// Position-like field of a regular leaf: control point (column i, row r) is points[indices[r * (gridSize + 3)
    /// + i]].
    void (*evaluateSpline)(SplineBasis const& u, SplineBasis const& v, RowPlan const& plan,
                           LocalPoint const* points, std::uint16_t const* indices, FieldArrays const& field);

    /// Position and its derivatives by u and v; gridSize is 1.
    void (*evaluateSplineFrame)(SplineBasis const& u, SplineBasis const& v, RowPlan const& plan,
                                LocalPoint const* points, std::uint16_t const* indices, FieldArrays const& position,
                                FieldArrays const& du, FieldArrays const& dv);

    /// matrix * points[indices[0 .. numColumns)]; fields[0 .. numFields).
    void (*evaluateDense)(DenseMatrix const& matrix, LocalPoint const* points, std::uint16_t const* indices,
                          FieldArrays const* fields);

    /// The same with 3 fields, and at the same time the first field's weights on `normals`.
    void (*evaluateDenseWithNormals)(DenseMatrix const& matrix, LocalPoint const* points,
                                     std::uint16_t const* indices, LocalPoint const* normals,
                                     std::uint16_t const* normalIndices, FieldArrays const* fields,
                                     FieldArrays const& subdivided);

    /// Normals of the tangents, blend, output.
    ///
    ///     N_L = normalize(tangent1 x tangent2)
    ///     N_S = normalize(subdivided), 0 where its length is at most 1e-6
    ///     N_B = normalize((1 - b) N_L + b N_S); N_L where b is 0 or where the sum vanishes (length <= 1e-6)
    ///
    /// subdividedNormals are 0 where b is 0. A point is doubtful when |t1 x t2| <= |t1| doubt2 or |t2| doubt1, or
    /// where the square of the cross product leaves the range of floats (|t1 x t2| below 1e-18 is taken as that);
    /// NaN is not doubtful. Without tangents N_B is N_S (b is 1), and a point is doubtful where N_S vanishes: there
    /// N_B is N_L, which the caller knows. N_L and N_B of doubtful points are written all the same; never NaN where
    /// the tangents' cross product is zero. N_B is the same bits whatever else is written.
    void (*finish)(LeafFrame& frame);

    /// results[i] = sum of weights[t] * points[sources[t]] for t in [offsets[i], offsets[i + 1]); results may
    /// follow `points` in one array, and rows may refer to results of earlier rows.
    void (*combine)(int numRows, std::uint32_t const* offsets, std::uint16_t const* sources, float const* weights,
                    LocalPoint const* points, LocalPoint* results);
};

/// The kernels of `set`; null where this build or this processor lacks it.
PatchKernels const* FindKernels(InstructionSet set);

}  // namespace v1
}  // namespace osd_shading
