// SPDX-License-Identifier: Apache-2.0

// What tile frames do with a leaf's fields: blend, write, and settle what float tangents can't.

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "osd_shading/blendedNormals.h"
#include "osd_shading/faceNormals.h"
#include "osd_shading/tables/tileFrames.h"

namespace osd_shading {
inline namespace v1 {
namespace tables {

namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

}  // namespace

void TileFrames::finishLeaf(TileClass const& tileClass, int numPoints, float doubt1, float doubt2,
                            Place const& place, bool hasTangents, Visit& visit) {
    Worker& worker = *visit.worker;
    LeafBlend const blend = blendOfLeaf(visit);
    std::size_t const value = index(visit.value), weight = visit.weight;
    bool const isOrdered = !data->orderOfValues.empty();
    visit.value += numPoints;
    if (visit.leafBlend) ++visit.leafBlend;
    if (blend == LeafBlend::Mixed) visit.weight += index(numPoints);
    if (numPoints == 0) return;
    if (visit.isMarking) {
        spoil(numPoints, value, weight, hasTangents, blend, worker);
        return;
    }

    LeafFrame leaf{};
    leaf.numPoints = numPoints;
    for (int axis = 0; axis < 3; ++axis) leaf.origin[axis] = place.origin[axis];
    leaf.position = worker.position;
    if (hasTangents) {
        leaf.tangent1 = worker.tangent1;
        leaf.tangent2 = worker.tangent2;
    }
    leaf.doubt1 = doubt1;
    leaf.doubt2 = doubt2;
    if (visit.hasNormals && blend != LeafBlend::Zero) leaf.subdivided = worker.subdivided;
    if (blend == LeafBlend::Mixed) leaf.blend = data->blendPowers.data() + weight;
    LeafFrame::Output du{}, dv{};
    LeafFrame::Output* const targets[kNumVectors] = {
        &leaf.positions, &leaf.blendedNormals, &leaf.limitNormals, &leaf.subdividedNormals, &du, &dv};
    for (std::size_t kind = 0; kind < kNumVectors; ++kind) {
        if (vectors[kind].data == nullptr) continue;
        if (isOrdered) {
            *targets[kind] = {worker.ordered[kind].data(), 3};
        } else {
            *targets[kind] = {vectors[kind].data + value * vectors[kind].stride, vectors[kind].stride};
        }
    }
    leaf.doubtful = worker.doubtful.data();
    if (blend == LeafBlend::One && hasTangents && leaf.subdivided.x != nullptr) {
        // N_B is N_S alone: the same bits as where no N_L is asked for.
        LeafFrame alone = leaf;
        alone.positions = alone.limitNormals = {};
        alone.tangent1 = alone.tangent2 = {};
        kernels->finish(alone);
        replaceVanished(alone, tileClass, place, static_cast<int>(value), visit);
        leaf.blendedNormals = leaf.subdividedNormals = {};
        leaf.subdivided = {};
    }
    kernels->finish(leaf);
    if (!hasTangents) replaceVanished(leaf, tileClass, place, static_cast<int>(value), visit);
    if (blend == LeafBlend::One && visit.hasNormals) leaf.subdivided = worker.subdivided;  // may stand in for N_L
    if (!hasTangents && blend == LeafBlend::Zero && leaf.subdividedNormals.data != nullptr) {
        for (std::size_t i = 0; i < index(numPoints); ++i) {
            std::fill_n(leaf.subdividedNormals.data + i * leaf.subdividedNormals.stride, 3, 0.0f);
        }
    }
    if (needsTangents) {
        // As the tile sees them. N_L is made of those of the class, the same bits whether they are wanted or not.
        Frame2 const& f = place.frame;
        auto const turn = [&](LeafFrame::Output const& output, float ofU, float ofV) {
            if (output.data == nullptr) return;
            FieldArrays const &u = worker.tangent1, &v = worker.tangent2;
            for (std::size_t i = 0; i < index(numPoints); ++i) {
                float* const target = output.data + i * output.stride;
                target[0] = ofU * u.x[i] + ofV * v.x[i];
                target[1] = ofU * u.y[i] + ofV * v.y[i];
                target[2] = ofU * u.z[i] + ofV * v.z[i];
            }
        };
        turn(du, f.a, f.b);
        turn(dv, f.c, f.d);
    }
    if (hasTangents && leaf.numDoubtful > 0) settle(leaf, tileClass, place, static_cast<int>(value), visit);

    std::vector<float> const& weights = data->blendWeights.empty() ? data->blendPowers : data->blendWeights;
    if (numbers.data != nullptr) {
        for (std::size_t i = 0; i < index(numPoints); ++i) {
            std::size_t const target = isOrdered ? index(data->orderOfValues[value + i]) : value + i;
            numbers.data[target * numbers.stride] = blend == LeafBlend::Mixed ? weights[weight + i]
                                                    : blend == LeafBlend::One ? 1.0f
                                                                              : 0.0f;
        }
    }
    if (!isOrdered) return;
    for (std::size_t kind = 0; kind < kNumVectors; ++kind) {
        if (vectors[kind].data == nullptr) continue;
        float const* from = worker.ordered[kind].data();
        for (std::size_t i = 0; i < index(numPoints); ++i, from += 3) {
            std::copy_n(from, 3, vectors[kind].data + index(data->orderOfValues[value + i]) * vectors[kind].stride);
        }
    }
}

namespace {

/// The average of the unit normals of a value's faces, and whether `point` has one instead of tangents.
bool findAverage(AverageNormals const& averages, int point, LocalPoint const* points, Vec3<double>& normal) {
    auto const found =
        std::lower_bound(averages.normals.begin(), averages.normals.end(), point,
                         [](AverageNormal const& average, int wanted) { return average.point < wanted; });
    if (found == averages.normals.end() || found->point != point) return false;
    auto const pointOfRow = [&](int row) {
        Vec3<double> sum{};
        for (auto t = averages.offsets[index(row)]; t < averages.offsets[index(row) + 1]; ++t) {
            float const* const p = points[averages.sources[t]].v;
            sum += averages.weights[t] * Vec3<double>{double{p[0]}, double{p[1]}, double{p[2]}};
        }
        return sum;
    };
    auto const last = found + 1 == averages.normals.end() ? averages.faces.end()
                                                          : averages.faces.begin() + (found + 1)->firstFace;
    auto const first = averages.faces.begin() + found->firstFace;
    auto const sidesOf = [&](auto face) {
        Vec3<double> const p = pointOfRow(face->rows[face->corner]);
        return std::pair(pointOfRow(face->rows[(face->corner + 1) % face->size]) - p,
                         pointOfRow(face->rows[(face->corner + face->size - 1) % face->size]) - p);
    };
    double longest = 0;
    for (auto face = first; face != last && averages.weight == FaceWeight::CornerArea; ++face) {
        auto const [after, before] = sidesOf(face);
        longest = std::fmax(longest, std::fmax(Length(after), Length(before)));
    }
    NormalSum<double> sum;
    for (auto face = first; face != last; ++face) {
        Vec3<double> corners[4];
        for (int i = 0; i < face->size; ++i) corners[i] = pointOfRow(face->rows[i]);
        auto const [after, before] = sidesOf(face);
        double const weight =
            std::fmax(CornerWeight(averages.weight, after, before), LeastWeight(averages.weight, longest));
        sum.Add(UnitPolygonNormal<double>(face->size, [&](int i) { return corners[i]; }), weight);
    }
    // The points were rounded to float: what is left where normals cancel is no direction.
    normal = Length(sum.sum) > double{kVanishing<float>} * sum.added ? sum.Unit() : Vec3<double>{};
    return true;
}

}  // namespace

/// Overwrites what depends on a number that is not finite. Start normals leave out faces without a normal, so N_S
/// does not.
void TileFrames::spoil(int numPoints, std::size_t value, std::size_t weight, bool hasTangents, LeafBlend blend,
                       Worker const& worker) const {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    for (std::size_t i = 0; i < index(numPoints); ++i) {
        std::size_t const target = data->orderOfValues.empty() ? value + i : index(data->orderOfValues[value + i]);
        auto const overwrite = [&](OutputKind kind) {
            if (vectors[kind].data == nullptr) return;
            std::fill_n(vectors[kind].data + target * vectors[kind].stride, 3, kNan);
        };
        if (worker.position.x[i] != 0) overwrite(kPositions);
        if (!hasTangents || (worker.tangent1.x[i] == 0 && worker.tangent2.x[i] == 0)) continue;
        overwrite(kLimit);
        overwrite(kDu);
        overwrite(kDv);
        bool const isOne =
            blend == LeafBlend::One || (blend == LeafBlend::Mixed && data->blendPowers[weight + i] == 1);
        if (!isOne) overwrite(kBlended);
    }
}

Vec3<double> TileFrames::exactLimit(TileClass const& tileClass, Place const& place, int firstValue, int point,
                                    Visit& visit, bool& isAverage) {
    Vec3<double> average;
    isAverage = tileClass.averages && findAverage(*tileClass.averages, point, place.points, average);
    return isAverage ? average : exactNormals->Find(visit.tile, firstValue + point, visit.controlPoints);
}

namespace {

void writePoint(LeafFrame::Output const& output, std::size_t point, Vec3<float> const& v) {
    if (output.data == nullptr) return;
    float* const target = output.data + point * output.stride;
    target[0] = v.x;
    target[1] = v.y;
    target[2] = v.z;
}

Vec3<float> toFloat(Vec3<double> const& v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

}  // namespace

/// Where b is 1 and N_S vanishes N_B is N_L, as in BlendNormals.
void TileFrames::replaceVanished(LeafFrame const& leaf, TileClass const& tileClass, Place const& place,
                                 int firstValue, Visit& visit) {
    if (leaf.blendedNormals.data == nullptr) return;
    for (int i = 0; i < leaf.numDoubtful; ++i) {
        bool isAverage = false;
        int const point = leaf.doubtful[i];
        Vec3<double> const limit = exactLimit(tileClass, place, firstValue, point, visit, isAverage);
        writePoint(leaf.blendedNormals, index(point), toFloat(limit));
    }
}

void TileFrames::settle(LeafFrame& leaf, TileClass const& tileClass, Place const& place, int firstValue,
                        Visit& visit) {
    for (int i = 0; i < leaf.numDoubtful; ++i) {
        std::size_t const point = leaf.doubtful[i];
        bool isAverage = false;
        Vec3<float> limit =
            toFloat(exactLimit(tileClass, place, firstValue, static_cast<int>(point), visit, isAverage));
        if (!isAverage) ++visit.worker->numFallbacks;
        Vec3<float> subdivided{};
        float blend = 0;
        if (leaf.subdivided.x != nullptr) {
            FieldArrays const& s = leaf.subdivided;
            subdivided = NormalizedSum(Vec3<float>{s.x[point], s.y[point], s.z[point]}, 1.0f);
            blend = leaf.blend ? leaf.blend[point] : 1.0f;
            // Where no face has an area N_S stands in.
            if (IsZero(limit)) limit = subdivided;
            if (blend == 0) subdivided = {};
        }
        writePoint(leaf.limitNormals, point, limit);
        writePoint(leaf.blendedNormals, point, BlendNormals(limit, subdivided, blend, 1));
    }
}

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
