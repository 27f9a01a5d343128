// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include "osd_shading/tables/patchKernels.h"

namespace osd_shading {
inline namespace v1 {

/// The kernels, written once. Each file patchKernelsNAME.cpp compiles them for its own `Lanes`:
///
///     Lanes::kCount    floats in a vector: 4, 8 or 16
///     Lanes::Vector    Load, Store (any address), Broadcast (of a float in memory), Set, + - * /,
///                      Kept (in a register: not loaded again where it is used),
///                      MulAdd(a, b, c) = a b + c, MulSub = a b - c, Sqrt, Max (the second where one is NaN)
///     Lanes::Repeat<n>, Spread<n>    p[0] .. p[n - 1] over and over; each of p[0], p[1], ... n times; n is 4, 8 or
///     16 Lanes::Mask      Greater(a, b), NotLess(a, b), both false for NaN; Bits, Select, KeepIf Lanes::Quad a
///     vector of 4: a LocalPoint; Transpose, ZipLow, ZipHigh Lanes::WritePacked, Lanes::WriteStrided    x, y, z of
///     kCount points
///
/// Those files are compiled for processors that may not be there. Nothing of them may be merged by the linker with
/// the same function of another file, so all that is here is a template on `Lanes`, which is in an unnamed
/// namespace; and nothing of the standard library that has a body is used (an inline function that was not inlined
/// is such a function).
template <typename Lanes>
class KernelsFor {
public:
    static constexpr PatchKernels Table(char const* name) {
        return {name,
                Lanes::kCount,
                &evaluateSpline,
                &evaluateSplineFrame,
                &evaluateDense,
                &evaluateDenseWithNormals,
                &finish,
                &combine};
    }

private:
    using V = typename Lanes::Vector;
    using Quad = typename Lanes::Quad;

    static constexpr int kLanes = Lanes::kCount;
    // A row of at most 17 parameters, in vectors, and one vector further: segments begin anywhere.
    static constexpr int kRowPitch = 48;

    // --- Splines ----------------------------------------------------------------------------------------------

    static Quad loadPoint(LocalPoint const& point) { return Quad::Load(point.v); }

    /// `p`, of which the compiler knows nothing: g++ -O3 sees that one row's end is the next one's beginning (when
    /// they are some vectors apart) and would keep more of them for later than there are registers.
    static float const* opaque(float const* p) {
#ifdef __GNUC__
        asm("" : "+r"(p));
#endif
        return p;
    }

    /// sum of weights[j] * values[j * pitch]
    template <int kNum>
    static V sum(V const* weights, float const* values, std::ptrdiff_t pitch) {
        V result = weights[0] * V::Load(values);
        for (int j = 1; j < kNum; ++j) result = MulAdd(weights[j], V::Load(values + j * pitch), result);
        return result;
    }

    /// The same of single values, with the weights of a basis at kSide parameters, over and over.
    template <int kNum, int kSide = kLanes>
    static V sumOfScalars(float const* weights, float const* values, std::ptrdiff_t pitch) {
        V result = Lanes::template Repeat<kSide>(weights) * V::Broadcast(values);
        for (int j = 1; j < kNum; ++j) {
            V const weight = Lanes::template Repeat<kSide>(weights + j * SplineBasis::kPitch);
            result = MulAdd(weight, V::Broadcast(values + j * pitch), result);
        }
        return result;
    }

    /// The same of points, at one parameter.
    template <int kNum>
    static Quad sumOfPoints(float const* weights, float const (*points)[4]) {
        Quad result = Quad::Broadcast(weights) * Quad::Load(points[0]);
        for (int j = 1; j < kNum; ++j) {
            result = MulAdd(Quad::Broadcast(weights + j * SplineBasis::kPitch), Quad::Load(points[j]), result);
        }
        return result;
    }

    /// How the segments of a plan become vectors.
    struct Layout {
        int side;     ///< of the rows: several rows of 4 or 8 points make one vector; kLanes: all other plans
        bool hasOdd;  ///< the last column is what rows have above whole vectors: evaluated by itself, along v
    };

    static Layout layoutOf(RowPlan const& plan) {
        int const count = plan.lastColumn - plan.firstColumn + 1;
        bool const canPack = count < kLanes && (count == 4 || count == 8);
        bool const canSplit = count > kLanes && count % kLanes == 1;
        if (!canPack && !canSplit) return {kLanes, false};
        for (int s = 0; s < plan.numSegments; ++s) {
            RowSegment const segment = plan.segments[s];
            if (segment.count != count || segment.row != plan.segments[0].row + s) return {kLanes, false};
        }
        return {canPack ? count : kLanes, canSplit};
    }

    /// Calls f(column, to) for the vectors of a row; `to` counts floats from the first column.
    template <typename Function>
    static void forAllColumns(RowPlan const& plan, Layout layout, Function const& f) {
        int const last = plan.lastColumn - (layout.hasOdd ? 1 : 0);
        for (int column = plan.firstColumn, to = 0; column <= last; column += kLanes, to += kLanes) f(column, to);
    }

    /// Calls f(row, begin, count, to) for the segments, where kSide is kLanes, and otherwise for as many rows as
    /// are in a vector.
    template <int kSide, typename Function>
    static void forAllRows(RowPlan const& plan, Layout layout, Function const& f) {
        int const skipped = layout.hasOdd ? 1 : 0;
        int to = 0;
        for (int s = 0; s < plan.numSegments; s += kLanes / kSide) {
            RowSegment const segment = plan.segments[s];
            if constexpr (kSide == kLanes) {
                f(int(segment.row), segment.first - plan.firstColumn, segment.count - skipped, to);
                to += segment.count;
            } else {
                f(int(segment.row), 0, kLanes, to);
                to += kLanes;
            }
        }
    }

    /// The last column of a plan: numbers of `kNum` fields from the sums over u of its control rows.
    template <int kNum>
    static void oddColumn(RowPlan const& plan, float const (*weights)[SplineBasis::kPitch], float const (*sums)[4],
                          FieldArrays const& field) {
        int const count = plan.segments[0].count, row = plan.segments[0].row;
        float* const fields[3] = {field.x, field.y, field.z};
        for (int first = 0; first < plan.numSegments; first += kLanes) {
            int const numRows = plan.numSegments - first < kLanes ? plan.numSegments - first : kLanes;
            for (int c = 0; c < 3; ++c) {
                alignas(64) float values[kLanes];
                sumOfScalars<kNum>(weights[0] + row + first, sums[0] + c, 4).Store(values);
                float* to = fields[c] + (first + 1) * count - 1;
                for (int i = 0; i < numRows; ++i, to += count) *to = values[i];
            }
        }
    }

    static void evaluateSpline(SplineBasis const& u, SplineBasis const& v, RowPlan const& plan,
                               LocalPoint const* points, std::uint16_t const* indices, FieldArrays const& field) {
        if (u.gridSize > 1) {
            splineOfGrid(u, v, plan, points, indices, field);
            return;
        }
        alignas(64) float control[4][4][4];
        for (int i = 0; i < 16; ++i) loadPoint(points[indices[i]]).Store(control[i / 4][i % 4]);
        Layout const layout = layoutOf(plan);
        if (kLanes > 4 && layout.side == 4) {
            splineOfFace<4>(u, v, plan, layout, control, field);
        } else if (kLanes > 8 && layout.side == 8) {
            splineOfFace<8>(u, v, plan, layout, control, field);
        } else {
            splineOfFace<kLanes>(u, v, plan, layout, control, field);
        }
        if (layout.hasOdd) {
            alignas(16) float sums[4][4];
            for (int r = 0; r < 4; ++r) sumOfPoints<4>(u.value[0] + plan.lastColumn, control[r]).Store(sums[r]);
            oddColumn<4>(plan, v.value, sums, field);
        }
    }

    template <int kSideWanted>
    static void splineOfFace(SplineBasis const& u, SplineBasis const& v, RowPlan const& plan, Layout layout,
                             float const (*control)[4][4], FieldArrays const& field) {
        constexpr int kSide = kSideWanted < kLanes ? kSideWanted : kLanes;
        // Rows along u: [x, y, z][control row].
        alignas(64) float rows[3][4][kRowPitch];
        forAllColumns(plan, layout, [&](int column, int to) {
            for (int r = 0; r < 4; ++r) {
                for (int c = 0; c < 3; ++c) {
                    sumOfScalars<4, kSide>(u.value[0] + column, control[r][0] + c, 4).Store(rows[c][r] + to);
                }
            }
        });
        forAllRows<kSide>(plan, layout, [&](int row, int begin, int count, int to) {
            V values[4];
            for (int r = 0; r < 4; ++r) values[r] = Lanes::template Spread<kSide>(v.value[r] + row);
            for (int i = 0; i < count; i += kLanes) {
                float const* const x = opaque(rows[0][0] + begin + i);
                float const *const y = x + 4 * kRowPitch, *const z = y + 4 * kRowPitch;
                sum<4>(values, x, kRowPitch).Store(field.x + to + i);
                sum<4>(values, y, kRowPitch).Store(field.y + to + i);
                sum<4>(values, z, kRowPitch).Store(field.z + to + i);
            }
        });
    }

    static void splineOfGrid(SplineBasis const& u, SplineBasis const& v, RowPlan const& plan,
                             LocalPoint const* points, std::uint16_t const* indices, FieldArrays const& field) {
        // At the end of a grid a row past the last is asked for, with weight 0.
        alignas(64) float rows[3][kLeafSide + 4][kRowPitch];
        gridRows(u, v, plan, points, indices, rows);
        forAllRows<kLanes>(plan, {kLanes, false}, [&](int row, int begin, int count, int to) {
            V values[4];
            for (int r = 0; r < 4; ++r) values[r] = V::Broadcast(v.value[r] + row);
            int const face = row >> v.shift;
            for (int i = 0; i < count; i += kLanes) {
                float const* const x = opaque(rows[0][face] + begin + i);
                float const *const y = x + (kLeafSide + 4) * kRowPitch, *const z = y + (kLeafSide + 4) * kRowPitch;
                sum<4>(values, x, kRowPitch).Store(field.x + to + i);
                sum<4>(values, y, kRowPitch).Store(field.y + to + i);
                sum<4>(values, z, kRowPitch).Store(field.z + to + i);
            }
        });
    }

    static void gridRows(SplineBasis const& u, SplineBasis const& v, RowPlan const& plan, LocalPoint const* points,
                         std::uint16_t const* indices, float (*rows)[kLeafSide + 4][kRowPitch]) {
        int const numControls = u.gridSize + 3, shift = u.shift;
        int firstRow = plan.segments[0].row, lastRow = firstRow;
        for (int s = 1; s < plan.numSegments; ++s) {
            int const row = plan.segments[s].row;
            firstRow = row < firstRow ? row : firstRow;
            lastRow = row > lastRow ? row : lastRow;
        }

        // Each control point as often as there are parameters in a face, so that parameter i finds its control
        // point j at i + (j << shift); zeros past the last.
        constexpr int kPitch = 96;
        alignas(64) float spread[3][kPitch];
        for (int c = 0; c < 3; ++c) {
            for (int i = 0; i < kPitch; i += kLanes) V::Set(0).Store(spread[c] + i);
        }
        for (int r = firstRow >> v.shift, end = (lastRow >> v.shift) + 4; r < end; ++r) {
            if (r == v.gridSize + 3) {
                for (int c = 0; c < 3; ++c) {
                    for (int i = 0; i < kRowPitch; i += kLanes) V::Set(0).Store(rows[c][r] + i);
                }
                break;
            }
            spreadRow(points, indices + r * numControls, numControls, shift, spread);
            for (int column = plan.firstColumn, to = 0; column <= plan.lastColumn; column += kLanes, to += kLanes) {
                V weights[4];
                for (int j = 0; j < 4; ++j) weights[j] = V::Load(u.value[j] + column);
                for (int c = 0; c < 3; ++c) {
                    sum<4>(weights, spread[c] + column, std::ptrdiff_t(1) << shift).Store(rows[c][r] + to);
                }
            }
        }
    }

    static void spreadRow(LocalPoint const* points, std::uint16_t const* indices, int numControls, int shift,
                          float (*spread)[96]) {
        for (int i = 0; i < numControls; i += 4) {
            Quad q[4];
            if (i + 4 <= numControls) {
                for (int k = 0; k < 4; ++k) q[k] = loadPoint(points[indices[i + k]]);
            } else {
                q[0] = q[1] = q[2] = q[3] = Quad::Set(0);
                for (int k = 0; i + k < numControls; ++k) q[k] = loadPoint(points[indices[i + k]]);
            }
            Transpose(q[0], q[1], q[2], q[3]);
            for (int c = 0; c < 3; ++c) {
                float* const to = spread[c] + (i << shift);
                if (shift == 0) {
                    q[c].Store(to);
                } else if (shift == 1) {
                    ZipLow(q[c], q[c]).Store(to);
                    ZipHigh(q[c], q[c]).Store(to + 4);
                } else {
                    alignas(16) float single[4];
                    q[c].Store(single);
                    if (shift == 2) {
                        for (int k = 0; k < 4; ++k) Quad::Broadcast(single + k).Store(to + 4 * k);
                        continue;
                    }
                    for (int k = 0; k < 4; ++k) {
                        for (int n = 0; n < 1 << shift; n += 4) {
                            Quad::Broadcast(single + k).Store(to + (k << shift) + n);
                        }
                    }
                }
            }
        }
    }

    static void evaluateSplineFrame(SplineBasis const& u, SplineBasis const& v, RowPlan const& plan,
                                    LocalPoint const* points, std::uint16_t const* indices,
                                    FieldArrays const& position, FieldArrays const& du, FieldArrays const& dv) {
        // Control points [row][column] and their differences. Derivatives are made of differences of control points
        // and never of rounded sums.
        alignas(64) float control[4][4][4], alongU[4][3][4], alongV[3][4][4];
        for (int r = 0; r < 4; ++r) {
            Quad previous = loadPoint(points[indices[4 * r]]);
            previous.Store(control[r][0]);
            for (int i = 1; i < 4; ++i) {
                Quad const point = loadPoint(points[indices[4 * r + i]]);
                point.Store(control[r][i]);
                (point - previous).Store(alongU[r][i - 1]);
                previous = point;
            }
        }
        for (int i = 0; i < 4; ++i) {
            for (int r = 0; r < 3; ++r) {
                (Quad::Load(control[r + 1][i]) - Quad::Load(control[r][i])).Store(alongV[r][i]);
            }
        }

        Layout const layout = layoutOf(plan);
        Frame const frame{control, alongU, alongV, position, du, dv};
        if (kLanes > 4 && layout.side == 4) {
            frameOfFace<4>(u, v, plan, layout, frame);
        } else if (kLanes > 8 && layout.side == 8) {
            frameOfFace<8>(u, v, plan, layout, frame);
        } else {
            frameOfFace<kLanes>(u, v, plan, layout, frame);
        }
        if (layout.hasOdd) {
            alignas(16) float values[4][4], slopes[4][4], differences[3][4];
            for (int r = 0; r < 4; ++r) {
                sumOfPoints<4>(u.value[0] + plan.lastColumn, control[r]).Store(values[r]);
                sumOfPoints<3>(u.slope[0] + plan.lastColumn, alongU[r]).Store(slopes[r]);
                if (r < 3) sumOfPoints<4>(u.value[0] + plan.lastColumn, alongV[r]).Store(differences[r]);
            }
            oddColumn<4>(plan, v.value, values, position);
            oddColumn<4>(plan, v.value, slopes, du);
            oddColumn<3>(plan, v.slope, differences, dv);
        }
    }

    /// Control points, their differences, and the fields to write.
    struct Frame {
        float const (*control)[4][4];
        float const (*alongU)[3][4];
        float const (*alongV)[4][4];
        FieldArrays position, du, dv;
    };

    template <int kSideWanted>
    static void frameOfFace(SplineBasis const& u, SplineBasis const& v, RowPlan const& plan, Layout layout,
                            Frame const& frame) {
        constexpr int kSide = kSideWanted < kLanes ? kSideWanted : kLanes;
        // Rows along u of what the columns combine: [x, y, z][4 of positions, 4 of du, 3 of differences].
        alignas(64) float rows[3][11][kRowPitch];
        forAllColumns(plan, layout, [&](int column, int to) {
            float const *const value = u.value[0] + column, *const slope = u.slope[0] + column;
            for (int c = 0; c < 3; ++c) {
                for (int r = 0; r < 4; ++r) {
                    sumOfScalars<4, kSide>(value, frame.control[r][0] + c, 4).Store(rows[c][r] + to);
                    sumOfScalars<3, kSide>(slope, frame.alongU[r][0] + c, 4).Store(rows[c][4 + r] + to);
                }
                for (int r = 0; r < 3; ++r) {
                    sumOfScalars<4, kSide>(value, frame.alongV[r][0] + c, 4).Store(rows[c][8 + r] + to);
                }
            }
        });

        FieldArrays const position = frame.position, du = frame.du, dv = frame.dv;
        forAllRows<kSide>(plan, layout, [&](int row, int begin, int count, int to) {
            V values[4], slopes[3];
            for (int r = 0; r < 4; ++r) values[r] = Lanes::template Spread<kSide>(v.value[r] + row);
            for (int r = 0; r < 3; ++r) slopes[r] = Lanes::template Spread<kSide>(v.slope[r] + row);
            for (int i = 0; i < count; i += kLanes) {
                float const* const x = opaque(rows[0][0] + begin + i);
                float const *const y = x + 11 * kRowPitch, *const z = y + 11 * kRowPitch;
                sum<4>(values, x, kRowPitch).Store(position.x + to + i);
                sum<4>(values, y, kRowPitch).Store(position.y + to + i);
                sum<4>(values, z, kRowPitch).Store(position.z + to + i);
                sum<4>(values, x + 4 * kRowPitch, kRowPitch).Store(du.x + to + i);
                sum<4>(values, y + 4 * kRowPitch, kRowPitch).Store(du.y + to + i);
                sum<4>(values, z + 4 * kRowPitch, kRowPitch).Store(du.z + to + i);
                sum<3>(slopes, x + 8 * kRowPitch, kRowPitch).Store(dv.x + to + i);
                sum<3>(slopes, y + 8 * kRowPitch, kRowPitch).Store(dv.y + to + i);
                sum<3>(slopes, z + 8 * kRowPitch, kRowPitch).Store(dv.z + to + i);
            }
        });
    }

    // --- Dense matrices ---------------------------------------------------------------------------------------

    static void evaluateDense(DenseMatrix const& matrix, LocalPoint const* points, std::uint16_t const* indices,
                              FieldArrays const* fields) {
        int field = 0;
        for (; field + 3 <= matrix.numFields; field += 3) {
            for (int first = 0; first < matrix.numPoints; first += kLanes) {
                denseVectors<3, 1>(matrix, field, first, points, indices, fields);
            }
        }
        for (; field < matrix.numFields; ++field) {
            // Two vectors at once, or each sum would wait for its last product.
            int first = 0;
            for (; first + kLanes < matrix.numPoints; first += 2 * kLanes) {
                denseVectors<1, 2>(matrix, field, first, points, indices, fields);
            }
            if (first < matrix.numPoints) denseVectors<1, 1>(matrix, field, first, points, indices, fields);
        }
    }

    /// kNum fields from `field` on, at kVectors vectors of points from `first` on.
    template <int kNum, int kVectors>
    static void denseVectors(DenseMatrix const& matrix, int field, int first, LocalPoint const* points,
                             std::uint16_t const* indices, FieldArrays const* fields) {
        std::ptrdiff_t const columnPitch = std::ptrdiff_t(matrix.numFields) * kDenseBlock;
        float const* weights[kVectors];
        V x[kVectors][kNum], y[kVectors][kNum], z[kVectors][kNum];
        for (int v = 0; v < kVectors; ++v) {
            int const point = first + v * kLanes;
            weights[v] = matrix.weights + point / kDenseBlock * columnPitch * matrix.numColumns +
                         field * kDenseBlock + point % kDenseBlock;
            for (int f = 0; f < kNum; ++f) x[v][f] = y[v][f] = z[v][f] = V::Set(0);
        }
        for (int column = 0; column < matrix.numColumns; ++column) {
            float const* const p = points[indices[column]].v;
            V const px = V::Broadcast(p), py = V::Broadcast(p + 1), pz = V::Broadcast(p + 2);
            for (int v = 0; v < kVectors; ++v) {
                for (int f = 0; f < kNum; ++f) {
                    V const weight = V::Load(weights[v] + column * columnPitch + f * kDenseBlock).Kept();
                    x[v][f] = MulAdd(weight, px, x[v][f]);
                    y[v][f] = MulAdd(weight, py, y[v][f]);
                    z[v][f] = MulAdd(weight, pz, z[v][f]);
                }
            }
        }
        for (int v = 0; v < kVectors; ++v) {
            for (int f = 0; f < kNum; ++f) {
                int const to = first + v * kLanes;
                x[v][f].Store(fields[field + f].x + to);
                y[v][f].Store(fields[field + f].y + to);
                z[v][f].Store(fields[field + f].z + to);
            }
        }
    }

    static void evaluateDenseWithNormals(DenseMatrix const& matrix, LocalPoint const* points,
                                         std::uint16_t const* indices, LocalPoint const* normals,
                                         std::uint16_t const* normalIndices, FieldArrays const* fields,
                                         FieldArrays const& subdivided) {
        constexpr std::ptrdiff_t kColumnPitch = std::ptrdiff_t(3) * kDenseBlock;
        for (int first = 0; first < matrix.numPoints; first += kLanes) {
            float const* weights =
                matrix.weights + first / kDenseBlock * kColumnPitch * matrix.numColumns + first % kDenseBlock;
            V x[3], y[3], z[3], nx = V::Set(0), ny = V::Set(0), nz = V::Set(0);
            for (int f = 0; f < 3; ++f) x[f] = y[f] = z[f] = V::Set(0);
            for (int column = 0; column < matrix.numColumns; ++column, weights += kColumnPitch) {
                float const* const p = points[indices[column]].v;
                float const* const n = normals[normalIndices[column]].v;
                V const px = V::Broadcast(p), py = V::Broadcast(p + 1), pz = V::Broadcast(p + 2);
                V const position = V::Load(weights).Kept();
                x[0] = MulAdd(position, px, x[0]);
                y[0] = MulAdd(position, py, y[0]);
                z[0] = MulAdd(position, pz, z[0]);
                nx = MulAdd(position, V::Broadcast(n), nx);
                ny = MulAdd(position, V::Broadcast(n + 1), ny);
                nz = MulAdd(position, V::Broadcast(n + 2), nz);
                for (int f = 1; f < 3; ++f) {
                    V const tangent = V::Load(weights + f * kDenseBlock).Kept();
                    x[f] = MulAdd(tangent, px, x[f]);
                    y[f] = MulAdd(tangent, py, y[f]);
                    z[f] = MulAdd(tangent, pz, z[f]);
                }
            }
            for (int f = 0; f < 3; ++f) {
                x[f].Store(fields[f].x + first);
                y[f].Store(fields[f].y + first);
                z[f].Store(fields[f].z + first);
            }
            nx.Store(subdivided.x + first);
            ny.Store(subdivided.y + first);
            nz.Store(subdivided.z + first);
        }
    }

    // --- Normals and output -----------------------------------------------------------------------------------

    struct V3 {
        V x, y, z;
    };

    static V3 load(FieldArrays const& field, int i) {
        return {V::Load(field.x + i), V::Load(field.y + i), V::Load(field.z + i)};
    }
    static V3 scale(V3 const& a, V factor) { return {a.x * factor, a.y * factor, a.z * factor}; }
    static V squaredLength(V3 const& a) { return MulAdd(a.x, a.x, MulAdd(a.y, a.y, a.z * a.z)); }

    /// Points [first, first + kLanes) of an output; those from `numPoints` on are not there.
    static void write(LeafFrame::Output const& output, int first, int numPoints, V3 const& a) {
        float* const to = output.data + std::size_t(first) * output.stride;
        if (numPoints < kLanes) {
            alignas(64) float packed[3 * kLanes];
            Lanes::WritePacked(a.x, a.y, a.z, packed);
            for (int i = 0; i < numPoints; ++i) {
                for (int c = 0; c < 3; ++c) to[std::size_t(i) * output.stride + std::size_t(c)] = packed[3 * i + c];
            }
        } else if (output.stride == 3) {
            Lanes::WritePacked(a.x, a.y, a.z, to);
        } else {
            Lanes::WriteStrided(a.x, a.y, a.z, to, output.stride);
        }
    }

    /// Calls f(first) for vectors of points that cover all. The last one reaches back over points that were done
    /// before, so that none reaches past the end but where there is less than a vector.
    template <typename Function>
    static void forAllPoints(int numPoints, Function const& f) {
        int first = 0;
        for (; first + kLanes <= numPoints; first += kLanes) f(first);
        if (first < numPoints) f(numPoints < kLanes ? 0 : numPoints - kLanes);
    }

    enum class Blend {
        LimitOnly,       ///< no N_S: b is 0
        SubdividedOnly,  ///< no N_L: b is 1
        Everywhere,      ///< both, b is 1
        ByPoint          ///< both, b of each point
    };

    static void finish(LeafFrame& frame) {
        int const numPoints = frame.numPoints;
        frame.numDoubtful = 0;
        if (frame.positions.data) {
            V const x = V::Set(frame.origin[0]), y = V::Set(frame.origin[1]), z = V::Set(frame.origin[2]);
            forAllPoints(numPoints, [&](int first) {
                V3 const p = load(frame.position, first);
                write(frame.positions, first, numPoints, {p.x + x, p.y + y, p.z + z});
            });
        }

        if (!frame.subdivided.x) {
            if (frame.tangent1.x) finishNormals<Blend::LimitOnly>(frame);
        } else if (!frame.tangent1.x) {
            finishNormals<Blend::SubdividedOnly>(frame);
        } else if (!frame.blend) {
            finishNormals<Blend::Everywhere>(frame);
        } else {
            finishNormals<Blend::ByPoint>(frame);
        }
    }

    // Squares of lengths. A cross product whose square is smaller than kTiny loses digits to underflow; N_S of
    // length 1e-6 and sums of normals that are so short count as vanished.
    static constexpr float kTiny = 1e-36F, kHuge = 3e38F, kVanished = 1e-12F;

    template <Blend kBlend>
    static void finishNormals(LeafFrame& frame) {
        int const numPoints = frame.numPoints;
        unsigned const all = numPoints < kLanes ? (1U << numPoints) - 1 : (1U << (kLanes - 1)) * 2 - 1;
        V const doubt1 = V::Set(frame.doubt1 * frame.doubt1);
        V const doubt2 = V::Set(frame.doubt2 * frame.doubt2);
        V const one = V::Set(1), tiny = V::Set(kTiny), vanished = V::Set(kVanished);
        float const* blend = frame.blend;
        alignas(64) float fewBlends[kLanes];
        if (kBlend == Blend::ByPoint && numPoints < kLanes) {
            for (int i = 0; i < kLanes; ++i) fewBlends[i] = i < numPoints ? blend[i] : 0;
            blend = fewBlends;
        }

        forAllPoints(numPoints, [&](int first) {
            V3 n{}, s{}, blended{};
            V n2 = one, s2 = one;
            if constexpr (kBlend != Blend::SubdividedOnly) {
                V3 const a = load(frame.tangent1, first), b = load(frame.tangent2, first);
                n = {MulSub(a.y, b.z, a.z * b.y), MulSub(a.z, b.x, a.x * b.z), MulSub(a.x, b.y, a.y * b.x)};
                n2 = squaredLength(n);
                // An infinite n2, and NaN by overflow of n, are doubtful.
                V const a2 = squaredLength(a), b2 = squaredLength(b);
                auto const good =
                    And(Greater(n2, Max(tiny, Max(a2 * doubt2, b2 * doubt1))), Greater(V::Set(kHuge), n2));
                unsigned const doubtful = ~Bits(good) & all;
                if (doubtful != 0) addDoubtful(frame, first, doubtful & Bits(NotLess(a2 + b2, a2 + b2)));
                n2 = Max(tiny, n2);
            }
            if constexpr (kBlend != Blend::LimitOnly) {
                s = load(frame.subdivided, first);
                s2 = squaredLength(s);
            }

            if constexpr (kBlend == Blend::LimitOnly) {
                blended = scale(n, one / Sqrt(n2));
            } else if constexpr (kBlend == Blend::SubdividedOnly) {
                blended = normalizedSubdivided(s, s2);
                // There N_B is N_L, which the caller finds.
                unsigned const without = Bits(NotLess(vanished, s2)) & all;
                if (without != 0) addDoubtful(frame, first, without);
            } else {
                // N_B is along (1 - b) n + b (|n| / |s|) s: one square root for both lengths.
                V const b = kBlend == Blend::ByPoint ? V::Load(blend + first) : one;
                V const ratio = KeepIf(Greater(s2, vanished), b * Sqrt(n2 / Max(vanished, s2)));
                V const rest = one - b;
                V3 const sum = {MulAdd(s.x, ratio, n.x * rest), MulAdd(s.y, ratio, n.y * rest),
                                MulAdd(s.z, ratio, n.z * rest)};
                V const sum2 = squaredLength(sum);
                blended = scale(sum, one / Sqrt(sum2));
                auto const usual = Greater(sum2, n2 * vanished);
                if ((~Bits(usual) & all) != 0) {
                    V3 const other = blendUnusual(scale(n, one / Sqrt(n2)), normalizedSubdivided(s, s2), b);
                    blended = {Select(usual, blended.x, other.x), Select(usual, blended.y, other.y),
                               Select(usual, blended.z, other.z)};
                }
            }

            if (frame.blendedNormals.data) write(frame.blendedNormals, first, numPoints, blended);
            if (kBlend != Blend::SubdividedOnly && frame.limitNormals.data) {
                write(frame.limitNormals, first, numPoints, scale(n, one / Sqrt(n2)));
            }
            if (frame.subdividedNormals.data) {
                V3 unit{V::Set(0), V::Set(0), V::Set(0)};
                if constexpr (kBlend != Blend::LimitOnly) unit = normalizedSubdivided(s, s2);
                if constexpr (kBlend == Blend::ByPoint) {
                    auto const counts = Greater(V::Load(blend + first), V::Set(0));
                    unit = {KeepIf(counts, unit.x), KeepIf(counts, unit.y), KeepIf(counts, unit.z)};
                }
                write(frame.subdividedNormals, first, numPoints, unit);
            }
        });
    }

    static V3 normalizedSubdivided(V3 const& s, V s2) {
        // NaN stays: only a length known to be small counts as vanished.
        V const vanished = V::Set(kVanished), zero = V::Set(0);
        auto const small = NotLess(vanished, s2);
        V const factor = V::Set(1) / Sqrt(Max(vanished, s2));
        V3 const unit = scale(s, factor);
        return {Select(small, zero, unit.x), Select(small, zero, unit.y), Select(small, zero, unit.z)};
    }

    /// Where the sum vanishes or is NaN, or n is zero.
    static V3 blendUnusual(V3 const& limitNormal, V3 const& subdividedNormal, V b) {
        V const rest = V::Set(1) - b;
        V3 const sum = {MulAdd(subdividedNormal.x, b, limitNormal.x * rest),
                        MulAdd(subdividedNormal.y, b, limitNormal.y * rest),
                        MulAdd(subdividedNormal.z, b, limitNormal.z * rest)};
        V const sum2 = squaredLength(sum);
        V3 const unit = scale(sum, V::Set(1) / Sqrt(sum2));
        // b = 0 never looks at N_S; a sum that is not a number stays so.
        auto const vanishes = NotLess(V::Set(kVanished), sum2), without = NotLess(V::Set(0), b);
        auto const limit = [&](V l, V blended) { return Select(without, l, Select(vanishes, l, blended)); };
        return {limit(limitNormal.x, unit.x), limit(limitNormal.y, unit.y), limit(limitNormal.z, unit.z)};
    }

    static void addDoubtful(LeafFrame& frame, int first, unsigned bits) {
        for (int i = 0; bits != 0; ++i, bits >>= 1) {
            // The last vector meets points of the one before it again.
            bool const isNew = frame.numDoubtful == 0 || frame.doubtful[frame.numDoubtful - 1] < first + i;
            if ((bits & 1) != 0 && isNew) frame.doubtful[frame.numDoubtful++] = std::uint16_t(first + i);
        }
    }

    // --- Sparse rows ------------------------------------------------------------------------------------------

    static void combine(int numRows, std::uint32_t const* offsets, std::uint16_t const* sources,
                        float const* weights, LocalPoint const* points, LocalPoint* results) {
        for (int row = 0; row < numRows; ++row) {
            Quad sum = Quad::Set(0);
            for (std::uint32_t t = offsets[row]; t < offsets[row + 1]; ++t) {
                sum = MulAdd(Quad::Broadcast(weights + t), loadPoint(points[sources[t]]), sum);
            }
            sum.Store(results[row].v);
        }
    }
};

}  // namespace v1
}  // namespace osd_shading
