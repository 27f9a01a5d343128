// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/subdividedNormals.h"

#include <utility>

#include "osd_shading/parallel.h"
#include "osd_shading/vectorMath.h"

namespace osd_shading {
inline namespace v1 {

namespace {

template <typename Real>
using Terms = std::vector<std::pair<int, Real>>;

/// The weighted mean of unit vectors on the sphere: from the normalised linear mean, `numSteps` steps to the mean
/// of their logarithms at the current estimate. Zero vectors do not count. [AB08]
template <typename Real>
Vec3<Real> sphericalMean(Terms<Real> const& terms, std::vector<Vec3<Real>> const& normals, int numSteps) {
    Vec3<Real> sum{};
    Real added = 0;
    for (auto const& [value, weight] : terms) {
        Vec3<Real> const& normal = normals[static_cast<std::size_t>(value)];
        sum += weight * normal;
        added += std::fabs(weight) * Length(normal);
    }
    Vec3<Real> mean = NormalizedSum(sum, added);
    if (IsZero(mean)) return mean;
    for (int i = 0; i < numSteps; ++i) {
        Vec3<Real> step{};
        Real counted = 0;
        for (auto const& [value, weight] : terms) {
            Vec3<Real> const& normal = normals[static_cast<std::size_t>(value)];
            if (IsZero(normal)) continue;
            Real const cosine = Dot(mean, normal);
            Vec3<Real> const across = normal - cosine * mean;
            Real const sine = Length(across);
            if (sine > 0) step += (weight * std::atan2(sine, cosine) / sine) * across;
            counted += weight;
        }
        Real const length = Length(step);
        if (!(length > 0) || !(counted > kVanishing<Real>)) break;
        Real const angle = length / counted;
        mean = Normalized(std::cos(angle) * mean + (std::sin(angle) / length) * step);
    }
    return mean;
}

/// One step (FieldStep or LimitStep) on the sphere.
template <typename Real, typename Step>
void applyOnSphere(Step const& step, CreaseRegions const& regions, std::vector<Vec3<Real>> const& from,
                   std::vector<Vec3<Real>>& to, ValueMarks const& marks, int numSteps, int numThreads) {
    ParallelFor(regions.NumVertices(), numThreads, [&](int begin, int end, int) {
        Terms<Real> terms;
        for (int v = begin; v < end; ++v) {
            for (int value = regions.FirstValue(v); value < regions.FirstValue(v + 1); ++value) {
                if (!marks.empty() && !marks[static_cast<std::size_t>(value)]) continue;
                terms.clear();
                step.AppendTerms(v, value, terms);
                to[static_cast<std::size_t>(value)] = sphericalMean(terms, from, numSteps);
            }
        }
    });
}

}  // namespace

template <typename Real>
std::vector<Vec3<Real>> ComputeSubdividedNormals(SubdividedNormalOptions const& options,
                                                 FieldLevels<Real> const& levels, int startLevel,
                                                 LimitStep<Real> const& limit, std::vector<Vec3<Real>> start,
                                                 ValueMarks const& marks, int numThreads) {
    int const lastLevel = limit.Topology().LastLevel();
    bool const isSpherical = options.averaging == NormalAveraging::Spherical;

    // Trace back what the marked values need, level by level.
    std::vector<ValueMarks> needed(static_cast<std::size_t>(lastLevel) + 1);
    if (!marks.empty()) {
        limit.MarkSources(marks, needed[static_cast<std::size_t>(lastLevel)]);
        for (int level = lastLevel; level > startLevel; --level) {
            levels.Step(level).MarkSources(needed[static_cast<std::size_t>(level)],
                                           needed[static_cast<std::size_t>(level) - 1]);
        }
    }

    std::vector<Vec3<Real>> normals = std::move(start);
    for (int level = startLevel + 1; level <= lastLevel; ++level) {
        ValueMarks const& wanted = needed[static_cast<std::size_t>(level)];
        FieldStep<Real> const& step = levels.Step(level);
        std::vector<Vec3<Real>> refined(static_cast<std::size_t>(levels.Regions(level).NumValues()));
        if (isSpherical) {
            applyOnSphere(step, levels.Regions(level), normals, refined, wanted, options.sphericalSteps,
                          numThreads);
        } else {
            step.Apply(normals, refined, wanted, numThreads);
        }
        if (options.averaging == NormalAveraging::Renormalised) {
            // Normals are at most 1 long, so a sum vanishes against 1.
            for (Vec3<Real>& normal : refined) normal = NormalizedSum(normal, Real(1));
        }
        normals.swap(refined);
    }

    std::vector<Vec3<Real>> limits(normals.size());
    if (isSpherical) {
        applyOnSphere(limit, limit.Regions(), normals, limits, marks, options.sphericalSteps, numThreads);
    } else {
        limit.Apply(normals, limits, marks, numThreads);
    }
    return limits;
}

#define OSD_SHADING_INSTANTIATE(Real)                                                          \
    template std::vector<Vec3<Real>> ComputeSubdividedNormals(                                 \
        SubdividedNormalOptions const&, FieldLevels<Real> const&, int, LimitStep<Real> const&, \
        std::vector<Vec3<Real>>, ValueMarks const&, int);
OSD_SHADING_INSTANTIATE(float)
OSD_SHADING_INSTANTIATE(double)
#undef OSD_SHADING_INSTANTIATE

}  // namespace v1
}  // namespace osd_shading
