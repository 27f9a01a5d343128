// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>

#include "osd_shading/export.h"
#include "osd_shading/shadingTable.h"
#include "osd_shading/views.h"

namespace osd_shading {
inline namespace v1 {

/// Writable view over points: x, y, z of point i at `data + i * stride` (`stride` in floats, at least 3).
///
/// Floats between the points are left alone. Empty: not wanted.
struct PointSpan {
    float* data = nullptr;   ///< x of the first point
    std::size_t count = 0;   ///< points
    std::size_t stride = 3;  ///< floats from point to point, at least 3
};

/// Writable view over single numbers, number i at `data + i * stride`. Empty: not wanted.
struct NumberSpan {
    float* data = nullptr;   ///< the first number
    std::size_t count = 0;   ///< numbers
    std::size_t stride = 1;  ///< floats from number to number, at least 1
};

/// Where a frame goes: each view is empty or has ShadingTable::NumValues() elements. They may interleave in one
/// buffer, but not overlap.
struct ShadingOutputs {
    PointSpan positions;       ///< of the limit surface, or as options.limits.positions has it
    PointSpan blendedNormals;  ///< N_B, unit length or zero
    /// N_L, unit length or zero. Where tangents and faces leave none N_S stands in, but, other than in
    /// ShadeSubdivision, only where b > 0: tables hold no N_S elsewhere.
    PointSpan limitNormals;
    PointSpan subdividedNormals;  ///< N_S, unit length; zero where b = 0 or where it vanishes
    /// Limit tangents, du x dv along N_L. Where the surface is regular: its derivatives by u and v of the tile
    /// (edge 0 of the face runs along u); at extraordinary and sharp vertices they point along those edges, their
    /// lengths are those of OpenSubdiv's tangent masks. At corners of several faces, where no tangent plane exists,
    /// zero.
    PointSpan du;
    PointSpan dv;             ///< see `du`
    NumberSpan blendWeights;  ///< the limit of b
};

/// Instruction sets for a frame's inner loops. Results differ between them in the last digits.
enum class InstructionSet {
    Best,      ///< the best that this processor has (default)
    Portable,  ///< plain C++
    Sse2,
    Avx2,  ///< with FMA
    Avx512
};

/// Whether this build and this processor have `set`.
OSD_SHADING_API bool IsAvailable(InstructionSet set);

/// How frames are evaluated.
struct EvaluatorOptions {
    int numThreads = 1;  ///< 1 or more; 0: as many as the machine has. The result is the same bits
    InstructionSet instructionSet = InstructionSet::Best;  ///< one that `IsAvailable`
};

/// What a frame met.
struct FrameReport {
    std::int64_t fallbackNormals = 0;   ///< values whose limit tangents were degenerate or nearly so
    std::int64_t zeroStartNormals = 0;  ///< start normals whose sum vanished
};

/// Turns control points into a shaded mesh, frame by frame.
///
///     ShadingTable const table(mesh, PaperPreset(4));
///     ShadingEvaluator evaluator(table);
///     evaluator.Evaluate(controlPoints, outputs);   // for every frame
///
/// Holds the memory that a frame needs: nothing is allocated per frame, but in tiles whose tangents vanish or
/// nearly do, which are settled in double precision. One evaluator is for one thread at a time; several may share a
/// table, which they keep alive.
class OSD_SHADING_API ShadingEvaluator {
public:
    /// ERRORS: InvalidOptions where the instruction set is not available or the number of threads is negative.
    explicit ShadingEvaluator(ShadingTable const& table, EvaluatorOptions const& options = {});
    ~ShadingEvaluator();
    ShadingEvaluator(ShadingEvaluator&&) noexcept;             ///< leaves the other fit for assignment only
    ShadingEvaluator& operator=(ShadingEvaluator&&) noexcept;  ///< likewise

    /// One frame. `controlPoints`: one per control vertex; they are not checked: a NaN or an infinite number spoils
    /// what depends on it, and nothing else. Every wanted output is written completely.
    ///
    /// ERRORS: InvalidOptions where a view has the wrong size, a null pointer, or too small a stride.
    FrameReport Evaluate(PointView<float> controlPoints, ShadingOutputs const& outputs);

    /// The same with the caller's normals (StartNormalKind::User): one per control vertex or one per face corner.
    FrameReport Evaluate(PointView<float> controlPoints, PointView<float> userNormals,
                         ShadingOutputs const& outputs);

    char const* InstructionSetName() const;  ///< "portable", "sse2", "avx2" or "avx512"

private:
    struct Impl;
    std::unique_ptr<Impl> _impl;
};

}  // namespace v1
}  // namespace osd_shading
