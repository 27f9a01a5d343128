// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>

namespace osd_shading {
inline namespace v1 {

/// A start level left to the library: 1, or 0 where the last level is 0.
constexpr int kDefaultStartLevel = -1;

/// The normals that are subdivided, one per (vertex, region) of the start level.
enum class StartNormalKind {
    Uniform,        ///< normalised sum of the unit normals of the region's faces (default)  [ZBK23] Sec. 2.2
    CornerArea,     ///< each face weighted by the cross product of its two edges at the vertex (ZBK's tool)
    Angle,          ///< each face weighted by its corner angle
    Limit,          ///< the limit normals of the start level's mesh
    LimitSmoothed,  ///< those, smoothed once around extraordinary vertices (variant D)
    User            ///< given by the caller on the control mesh; the start level is then 0
};

/// What happens to the subdivided normals from level to level.
enum class NormalAveraging {
    Linear,        ///< masks alone; the only mode that tables can hold (default)
    Renormalised,  ///< normalised after each level (ZBK's tool); the limit step is linear
    Spherical      ///< weighted mean on the sphere, also in the limit step  [AB08]
};

/// How the blend weight treats sharp vertices. [ZBK23] Sec. 3.1-3.3
enum class SharpVertexWeight {
    Zero,      ///< variant B: sharp vertices are neither eligible nor seeded (default)
    Smooth,    ///< variant A: as if they were smooth
    PerRegion  ///< variant C: each side of a crease has a weight of its own
};

/// How a dart counts: a vertex where exactly one sharp edge ends. [ZBK23] Sec. 3.3
enum class DartWeight {
    LikeSmooth,  ///< eligible when extraordinary (default)
    LikeSharp    ///< the dart follows `SharpVertexWeight`
};

/// Where the blend weight is seeded, and how it is refined.
enum class WeightScheme {
    OneRing,            ///< 1 on the extraordinary vertex and its ring, at every level (default)  [BBK18, ZBK23]
    ExtraordinaryOnly,  ///< 1 on the vertex alone, once  [AB08]
    Bilinear,           ///< that, refined bilinearly, without limit step  [AB08]
    InverseLimit,       ///< values whose limit is 1 at every eligible vertex  [BBK18]
    One                 ///< 1 everywhere: the subdivided normals alone
};

/// How N_L is found.
enum class LimitNormalKind {
    Limit,        ///< OpenSubdiv's limit tangent masks, over the region's own faces (default)
    FaceAverage,  ///< the start normals' rule at the last level (ZBK's tool)
    Exact         ///< the limit of OpenSubdiv's rules also where its masks are not: darts, irregular creases and
           ///< boundaries, interior vertices of valence 2. There, limits of positions, N_S and b are exact too
};

/// Which positions the result holds.
enum class PositionKind {
    Limit,   ///< on the limit surface (default)
    Refined  ///< of the last level's mesh; normals and weights stay limits
};

/// The normals that are subdivided.
struct StartNormalOptions {
    StartNormalKind kind = StartNormalKind::Uniform;  ///< which
    int level = kDefaultStartLevel;                   ///< n: 0 to the last level
};

/// How they are subdivided.
struct SubdividedNormalOptions {
    NormalAveraging averaging = NormalAveraging::Linear;  ///< tables hold Linear only
    int sphericalSteps = 3;                               ///< steps of the spherical mean, 0 to 100
};

/// The blend weight b.
struct BlendWeightOptions {
    WeightScheme scheme = WeightScheme::OneRing;                ///< seeds and refining
    SharpVertexWeight sharpVertices = SharpVertexWeight::Zero;  ///< variants A, B, C
    DartWeight darts = DartWeight::LikeSmooth;                  ///< where one sharp edge ends
    int level = kDefaultStartLevel;                             ///< w: 0 to the last level
    double exponent = 1.0;                                      ///< p > 0: the blend takes b^p
};

/// What is taken at the last level.
struct LimitOptions {
    PositionKind positions = PositionKind::Limit;      ///< of the result
    LimitNormalKind normals = LimitNormalKind::Limit;  ///< N_L
};

/// How a run behaves; nothing here changes a number of the result.
struct ExecutionOptions {
    int numThreads = 1;             ///< 1 or more; 0: as many as the machine has
    std::uint64_t memoryLimit = 0;  ///< bytes that a run may take; 0: no limit
    /// Called now and then with the share done, 0 to 1, from the calling thread; false abandons the run
    /// (Cancelled is thrown). Default: none.
    std::function<bool(double)> progress;
};

/// All options of the method; the defaults are [ZBK23]'s recommendation.
struct ShadingOptions {
    int level = 4;                              ///< L: 0 to 15 (Catmull-Clark with faces other than quads: 1 to 15)
    StartNormalOptions startNormals;            ///< what is subdivided, from which level
    SubdividedNormalOptions subdividedNormals;  ///< how it is subdivided
    BlendWeightOptions weights;                 ///< where and how far the blend leaves N_L
    LimitOptions limits;                        ///< positions and N_L
    ExecutionOptions execution;                 ///< threads, memory, progress
};

/// The defaults, variant B, at level `level`. [ZBK23]
inline ShadingOptions PaperPreset(int level = 4) {
    ShadingOptions options;
    options.level = level;
    return options;
}

/// Variant D: weight 1 everywhere, over smoothed limit normals of level 2 (or `level` where that is less).
inline ShadingOptions SmoothPreset(int level = 4) {
    ShadingOptions options;
    options.level = level;
    options.startNormals.kind = StartNormalKind::LimitSmoothed;
    options.startNormals.level = level < 2 ? level : 2;
    options.weights.scheme = WeightScheme::One;
    return options;
}

}  // namespace v1
}  // namespace osd_shading
