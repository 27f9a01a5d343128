// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/surface/facePoints.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "osd_shading/blendedNormals.h"
#include "osd_shading/startNormals.h"
#include "osd_shading/vectorMath.h"

namespace osd_shading {
inline namespace v1 {
namespace surface {

namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// Nearer than this to the corner of an irregular face a point counts as that corner.
template <typename Real>
constexpr Real kAtCorner = sizeof(Real) == 4 ? Real(1) / (1 << 20) : Real(1) / (1LL << 40);

/// Start normals of a cut-out, by value of the start level.
template <typename Real>
std::vector<Vec3<double>> startNormalsOf(ShadingOptions const& options, StartMesh const& start,
                                         tables::TileRing const& cutOut, ShadingInput<Real> const& input,
                                         std::vector<std::size_t> const& cornerOffsets,
                                         std::vector<Vec3<double>> points) {
    auto const inDouble = [](Vec3<Real> const& p) { return Vec3<double>{double(p.x), double(p.y), double(p.z)}; };
    if (options.startNormals.kind == StartNormalKind::User) {
        std::vector<Vec3<double>> normals;
        if (!input.vertexNormals.empty()) {
            for (int const v : cutOut.vertices) normals.push_back(inDouble(input.vertexNormals[index(v)]));
            return GatherUserNormals<double>(start.topology, start.regions, normals, {}).normals;
        }
        for (std::size_t f = 0; f < cutOut.faces.size(); ++f) {
            std::size_t const first = cornerOffsets[index(cutOut.faces[f])];
            for (int i = 0; i < cutOut.faceSizes[f]; ++i) {
                normals.push_back(inDouble(input.faceVaryingNormals[first + index(i)]));
            }
        }
        return GatherUserNormals<double>(start.topology, start.regions, {}, normals).normals;
    }
    for (LevelMasks<double> const& masks : start.masks) points = RefinePoints(masks, points, 1);
    return ComputeStartNormals(options.startNormals.kind, start.topology, options.startNormals.level, start.regions,
                               points, 1)
        .normals;
}

template <typename Real>
Vec3<Real> cast(Vec3<double> const& p) {
    return {static_cast<Real>(p.x), static_cast<Real>(p.y), static_cast<Real>(p.z)};
}

/// The child of a quad or triangle that holds (u, v), which become its own; `scale`: of derivatives by them.
template <typename Real>
int goDown(bool isCatmark, Real& u, Real& v, Real& scale) {
    constexpr Real kHalf = Real(0.5);
    scale *= 2;
    if (!isCatmark && u + v > kHalf && u < kHalf && v < kHalf) {
        // The middle one lies the other way round.
        u = 1 - 2 * u;
        v = 1 - 2 * v;
        scale = -scale;
        return 3;
    }
    // In a triangle's corner (1/2, 1/2) children meet that differ in either.
    bool const isRight = u >= kHalf, isAbove = v >= kHalf && (isCatmark || !isRight);
    u = isRight ? 2 * u - 1 : 2 * u;
    v = isAbove ? 2 * v - 1 : 2 * v;
    if (isCatmark) return isAbove ? (isRight ? 2 : 3) : (isRight ? 1 : 0);
    return isRight ? 1 : isAbove ? 2 : 0;
}

/// Derivative of v / |v| where v has the derivative `dv`; `unit` is v / length.
template <typename Real>
Vec3<Real> derivativeOfUnit(Vec3<Real> const& unit, Real length, Vec3<Real> const& dv) {
    if (!(length > 0)) return {};
    return (1 / length) * (dv - Dot(unit, dv) * unit);
}

}  // namespace

template <typename Real>
FacePoints<Real>::FacePoints(ShadingOptions const& options, FaceClass const& faceClass,
                             tables::TileRing const& cutOut, ShadingInput<Real> const& input,
                             std::vector<std::size_t> const& cornerOffsets)
    : _patches(faceClass.patches),
      _isCatmark(faceClass.isCatmark),
      _origin(input.positions[index(cutOut.vertices[0])]) {
    // Everything in double, relative to one of the vertices: what a distant origin would round away stays.
    std::vector<Vec3<double>> control;
    for (int const v : cutOut.vertices) {
        Vec3<Real> const p = input.positions[index(v)];
        control.push_back(
            {double(p.x) - double(_origin.x), double(p.y) - double(_origin.y), double(p.z) - double(_origin.z)});
    }
    std::size_t const numFirst = faceClass.NumFirstLines(), count = faceClass.NumLines();
    std::vector<double> lines(count * kLanes, 0);
    auto const addRow = [&](tables::FlatRows const& rows, std::size_t row, auto const& sources, double* line) {
        for (std::size_t t = rows.offsets[row]; t < rows.offsets[row + 1]; ++t) {
            Vec3<double> const& p = sources(rows.sources[t]);
            line[0] += rows.weights[t] * p.x;
            line[1] += rows.weights[t] * p.y;
            line[2] += rows.weights[t] * p.z;
        }
    };
    auto const controlAt = [&](int i) -> Vec3<double> const& { return control[index(i)]; };
    for (std::size_t i = 0; i < numFirst; ++i) addRow(faceClass.positionRows, i, controlAt, &lines[i * kLanes]);
    if (faceClass.HasWeights()) {
        std::vector<Vec3<double>> const normals =
            startNormalsOf(options, *faceClass.start, cutOut, input, cornerOffsets, control);
        auto const normalAt = [&](int i) -> Vec3<double> const& {
            return normals[index(faceClass.normalSources[index(i)])];
        };
        for (std::size_t i = 0; i < numFirst; ++i)
            addRow(faceClass.normalRows, i, normalAt, &lines[i * kLanes + 3]);
    }
    for (std::size_t i = 0; i < count; ++i) lines[i * kLanes + 6] = faceClass.weights[i];
    for (int row = 0; row < faceClass.rows.NumRows(); ++row) {
        double* const line = &lines[(numFirst + index(row)) * kLanes];
        for (std::uint32_t t = faceClass.rows.offsets[index(row)]; t < faceClass.rows.offsets[index(row) + 1];
             ++t) {
            double const* const source = &lines[std::size_t{faceClass.rows.sources[t]} * kLanes];
            for (int k = 0; k < 6; ++k) line[k] += faceClass.rows.weights[t] * source[k];
        }
    }
    _lines.resize(count);
    double size = 0;
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t k = 0; k < kLanes; ++k) _lines[i].v[k] = static_cast<Real>(lines[i * kLanes + k]);
        for (std::size_t k = 0; k < 3; ++k) size = std::max(size, std::fabs(lines[i * kLanes + k]));
    }
    _size = static_cast<Real>(size);
    computeCorners(options, faceClass, lines);
}

template <typename Real>
void FacePoints<Real>::computeCorners(ShadingOptions const& options, FaceClass const& faceClass,
                                      std::vector<double> const& lines) {
    auto const at = [&](std::uint32_t line) {
        double const* const p = &lines[std::size_t{line} * kLanes];
        return Vec3<double>{p[0], p[1], p[2]};
    };
    for (FaceCornerRows const& rows : faceClass.corners) {
        Vec3<double> position{}, tangent1{}, tangent2{}, normal{}, subdivided{};
        double added1 = 0, added2 = 0, b = 0;
        Vec3<double> const vertex = at(rows.vertexLine);
        for (FaceCornerRows::Term const& term : rows.terms) {
            double const* const line = &lines[std::size_t{term.line} * kLanes];
            Vec3<double> const side = at(term.line) - vertex;
            double const length = Length(side);
            position += term.limit * side;
            tangent1 += term.tangent1 * side;
            tangent2 += term.tangent2 * side;
            added1 += std::fabs(term.tangent1) * length;
            added2 += std::fabs(term.tangent2) * length;
            subdivided += term.limit * Vec3<double>{line[3], line[4], line[5]};
            b += term.limit * line[6];
        }
        position += vertex;
        if (!rows.isAverage && added1 > 0 && added2 > 0) {
            normal = NormalizedSum(Cross((1 / added1) * tangent1, (1 / added2) * tangent2), 1.0);
        }
        if (IsZero(normal)) {
            // The average of its faces.
            Vec3<double> sum{};
            double added = 0;
            for (std::vector<std::uint32_t> const& face : rows.faces) {
                Vec3<double> area{};
                double sizes = 0;
                for (std::size_t i = 1; i + 1 < face.size(); ++i) {
                    Vec3<double> const a = at(face[i]) - at(face[0]), c = at(face[i + 1]) - at(face[0]);
                    area += Cross(a, c);
                    sizes += Length(a) * Length(c);
                }
                Vec3<double> const unit = NormalizedSum(area, sizes);
                sum += unit;
                added += Length(unit);
            }
            normal = NormalizedSum(sum, added);
        }
        b = std::min(std::max(b, 0.0), 1.0);
        subdivided = b > 0 || IsZero(normal) ? NormalizedSum(subdivided, 1.0) : Vec3<double>{};
        if (IsZero(normal)) normal = subdivided;
        if (!(b > 0)) subdivided = {};
        SurfacePoint<Real> corner;
        corner.position = cast<Real>(position);
        if (!rows.isAverage) {
            corner.du = cast<Real>(tangent1);
            corner.dv = cast<Real>(tangent2);
        }
        corner.limitNormal = cast<Real>(normal);
        corner.subdividedNormal = cast<Real>(subdivided);
        corner.blendWeight = static_cast<Real>(b);
        corner.blendedNormal = cast<Real>(BlendNormals(normal, subdivided, b, options.weights.exponent));
        _corners.push_back(corner);
    }
}

template <typename Real>
template <int NumLanes, typename LineAt>
void FacePoints<Real>::sumLines(LineAt const& lineAt, Real u, Real v, bool hasSecond, Sums& sums) const {
    auto const add = [](Real* sum, Real weight, Real const* line) {
        for (int k = 0; k < NumLanes; ++k) sum[k] += weight * line[k];
    };
    if (!_isCatmark) {
        PatchBasis<Real> basis;  // NOLINT(cppcoreguidelines-pro-type-member-init): what is read is written first
        EvaluateTriangleBasis(u, v, hasSecond, basis);
        Real value[NumLanes] = {}, du[NumLanes] = {}, dv[NumLanes] = {};
        for (int i = 0; i < kTrianglePoints; ++i) {
            Real const* const line = lineAt(i);
            add(value, basis.value[i], line);
            add(du, basis.du[i], line);
            add(dv, basis.dv[i], line);
        }
        std::copy(value, value + NumLanes, sums.v[0]);
        std::copy(du, du + NumLanes, sums.v[1]);
        std::copy(dv, dv + NumLanes, sums.v[2]);
        for (int i = 0; i < kTrianglePoints && hasSecond; ++i) {
            Real const* const line = lineAt(i);
            add(sums.v[3], basis.duu[i], line);
            add(sums.v[4], basis.duv[i], line);
            add(sums.v[5], basis.dvv[i], line);
        }
        return;
    }
    // Rows of four points first.
    CubicBasis<Real> alongU, alongV;  // NOLINT(cppcoreguidelines-pro-type-member-init): written at once
    EvaluateCubicBasis(u, alongU);
    EvaluateCubicBasis(v, alongV);
    Real value[NumLanes] = {}, du[NumLanes] = {}, dv[NumLanes] = {};
    for (int row = 0; row < 4; ++row) {
        Real rowValue[NumLanes] = {}, rowDu[NumLanes] = {};
        for (int column = 0; column < 4; ++column) {
            Real const* const line = lineAt(4 * row + column);
            add(rowValue, alongU.value[column], line);
            add(rowDu, alongU.first[column], line);
        }
        add(value, alongV.value[row], rowValue);
        add(du, alongV.value[row], rowDu);
        add(dv, alongV.first[row], rowValue);
        if (hasSecond) {
            Real rowDuu[NumLanes] = {};
            for (int column = 0; column < 4; ++column) {
                add(rowDuu, alongU.second[column], lineAt(4 * row + column));
            }
            add(sums.v[3], alongV.value[row], rowDuu);
            add(sums.v[4], alongV.first[row], rowDu);
            add(sums.v[5], alongV.second[row], rowValue);
        }
    }
    std::copy(value, value + NumLanes, sums.v[0]);
    std::copy(du, du + NumLanes, sums.v[1]);
    std::copy(dv, dv + NumLanes, sums.v[2]);
}

template <typename Real>
template <typename LineAt>
Vec3<Real> FacePoints<Real>::normalOfDoubtfulTangents(LineAt const& lineAt, Sums const& sums,
                                                      std::uint16_t phantoms, Real u, Real v) const {
    // What the tangents are sums of.
    Real weightsDu[kQuadPoints], weightsDv[kQuadPoints];
    if (_isCatmark) {
        CubicBasis<Real> alongU, alongV;  // NOLINT(cppcoreguidelines-pro-type-member-init): written at once
        EvaluateCubicBasis(u, alongU);
        EvaluateCubicBasis(v, alongV);
        for (int i = 0; i < kQuadPoints; ++i) {
            weightsDu[i] = alongU.first[i % 4] * alongV.value[i / 4];
            weightsDv[i] = alongU.value[i % 4] * alongV.first[i / 4];
        }
    } else {
        PatchBasis<Real> basis;  // NOLINT(cppcoreguidelines-pro-type-member-init): what is read is written first
        EvaluateTriangleBasis(u, v, false, basis);
        std::copy(basis.du, basis.du + kTrianglePoints, weightsDu);
        std::copy(basis.dv, basis.dv + kTrianglePoints, weightsDv);
    }
    Vec3<Real> const position{sums.v[0][0], sums.v[0][1], sums.v[0][2]};
    Real added1 = 0, added2 = 0;
    int const count = _isCatmark ? kQuadPoints : kTrianglePoints;
    auto const pointAt = [&](int i) { return Vec3<Real>{lineAt(i)[0], lineAt(i)[1], lineAt(i)[2]}; };
    for (int i = 0; i < count; ++i) {
        Real const length = Length(pointAt(i) - position);
        added1 += std::fabs(weightsDu[i]) * length;
        added2 += std::fabs(weightsDv[i]) * length;
    }
    if (added1 > 0 && added2 > 0) {
        Vec3<Real> const du{sums.v[1][0] / added1, sums.v[1][1] / added1, sums.v[1][2] / added1},
            dv{sums.v[2][0] / added2, sums.v[2][1] / added2, sums.v[2][2] / added2};
        Vec3<Real> const normal = NormalizedSum(Cross(du, dv), Real(1));
        if (!IsZero(normal)) return normal;
    }
    // The average of the mesh's faces round the vertex, at one; of the face under the point elsewhere.
    Vec3<Real> sum{};
    Real added = 0;
    auto const addFace = [&](int const* corners, int size) {
        Vec3<Real> area{};
        Real sizes = 0;
        for (int i = 0; i < size; ++i) {
            if ((phantoms >> corners[i] & 1u) != 0) return;
        }
        for (int i = 1; i + 1 < size; ++i) {
            Vec3<Real> const a = pointAt(corners[i]) - pointAt(corners[0]),
                             c = pointAt(corners[i + 1]) - pointAt(corners[0]);
            area += Cross(a, c);
            sizes += Length(a) * Length(c);
        }
        Vec3<Real> const unit = NormalizedSum(area, sizes);
        sum += unit;
        added += Length(unit);
    };
    bool const isAtVertex = (u == 0 || u == 1) && (v == 0 || v == 1);
    if (_isCatmark) {
        int const firstRow = isAtVertex && v == 0 ? 0 : 1, lastRow = isAtVertex && v == 1 ? 2 : 1;
        int const firstColumn = isAtVertex && u == 0 ? 0 : 1, lastColumn = isAtVertex && u == 1 ? 2 : 1;
        for (int row = firstRow; row <= lastRow; ++row) {
            for (int column = firstColumn; column <= lastColumn; ++column) {
                int const at = 4 * row + column;
                int const corners[4] = {at, at + 1, at + 5, at + 4};
                addFace(corners, 4);
            }
        }
    } else if (isAtVertex) {
        // Of the six lattice points round each vertex.
        constexpr int kRings[3][6] = {{1, 2, 3, 4, 5, 6}, {8, 9, 2, 0, 6, 7}, {9, 10, 11, 3, 0, 1}};
        int const vertex = u == 1 ? 1 : v == 1 ? 2 : 0;
        for (int i = 0; i < 6; ++i) {
            int const corners[3] = {vertex, kRings[vertex][i], kRings[vertex][(i + 1) % 6]};
            addFace(corners, 3);
        }
    } else {
        int const corners[3] = {0, 1, 2};
        addFace(corners, 3);
    }
    return NormalizedSum(sum, added);
}

template <typename Real>
template <typename LineAt>
void FacePoints<Real>::evaluatePatch(double exponent, LineAt const& lineAt, bool hasWeight, std::uint16_t phantoms,
                                     Real u, Real v, Real scale, bool hasSecond, Vec3<Real> const& origin,
                                     SurfacePoint<Real>& point) const {
    // Positions alone where b is zero: four lanes, for the machine's sake.
    Sums sums{};
    if (hasSecond || hasWeight) {
        sumLines<kLanes>(lineAt, u, v, hasSecond, sums);
    } else {
        sumLines<4>(lineAt, u, v, hasSecond, sums);
    }
    auto const vectorAt = [&](int sum, int lane) {
        return Vec3<Real>{sums.v[sum][lane], sums.v[sum][lane + 1], sums.v[sum][lane + 2]};
    };

    // Normals do not depend on the scale of the tangents.
    Vec3<Real> const du = vectorAt(1, 0), dv = vectorAt(2, 0);
    Vec3<Real> const cross = Cross(du, dv);
    Real const squared = Dot(cross, cross), bound = 1000 * kVanishing<Real> * _size * _size;
    Real crossLength = 0;
    if (squared > bound * bound) {
        crossLength = std::sqrt(squared);
        point.limitNormal = (1 / crossLength) * cross;
    } else {
        crossLength = Length(cross);
        point.limitNormal = normalOfDoubtfulTangents(lineAt, sums, phantoms, u, v);
    }
    point.position = vectorAt(0, 0) + origin;
    point.du = scale * du;
    point.dv = scale * dv;
    Real const b = hasWeight ? std::min(std::max(sums.v[0][6], Real(0)), Real(1)) : Real(0);
    point.blendWeight = b;
    Real subdividedLength = 0;
    if (b > 0) {
        Vec3<Real> const sum = vectorAt(0, 3);
        subdividedLength = Length(sum);
        point.subdividedNormal = NormalizedSum(sum, Real(1));
    } else {
        point.subdividedNormal = {};
    }
    if (IsZero(point.limitNormal)) point.limitNormal = point.subdividedNormal;
    point.blendedNormal = BlendNormals(point.limitNormal, point.subdividedNormal, b, exponent);
    if (!hasSecond) return;

    Vec3<Real> const duu = vectorAt(3, 0), duv = vectorAt(4, 0), dvv = vectorAt(5, 0);
    point.duu = (scale * scale) * duu;
    point.duv = (scale * scale) * duv;
    point.dvv = (scale * scale) * dvv;
    // N_B = m / |m|, m = (1 - b^p) N_L + b^p N_S.
    Real const share = static_cast<Real>(std::pow(static_cast<double>(b), exponent));
    double const shareByB = b > 0 ? exponent * std::pow(static_cast<double>(b), exponent - 1) : 0;
    Vec3<Real> const mixed = (1 - share) * point.limitNormal + share * point.subdividedNormal;
    Vec3<Real> const crossBy[2] = {Cross(duu, dv) + Cross(du, duv), Cross(duv, dv) + Cross(du, dvv)};
    Vec3<Real>* const results[2] = {&point.normalDu, &point.normalDv};
    for (int i = 0; i < 2; ++i) {
        Vec3<Real> change = (1 - share) * derivativeOfUnit(point.limitNormal, crossLength, crossBy[i]);
        if (b > 0) {
            change += share * derivativeOfUnit(point.subdividedNormal, subdividedLength, vectorAt(1 + i, 3));
            // With p < 1 it has no bound where b begins.
            constexpr double kLargest = 1e15;
            double const shareBy = shareByB * static_cast<double>(sums.v[1 + i][6]);
            change += static_cast<Real>(std::min(std::max(shareBy, -kLargest), kLargest)) *
                      (point.subdividedNormal - point.limitNormal);
        }
        *results[i] = scale * derivativeOfUnit(point.blendedNormal, Length(mixed), change);
    }
}

template <typename Real>
void FacePoints<Real>::Evaluate(double exponent, int root, Real u, Real v, Real scale, bool hasSecond,
                                SurfacePoint<Real>& point) const {
    FaceNode const* node = &_patches->nodes[_patches->roots[index(root)]];
    std::uint32_t corners = 0;
    while (node->kind == FaceNode::Kind::Split) {
        if (node->corners >= 0) {
            corners = static_cast<std::uint32_t>(node->corners);
            Real const nearU = std::min(u, 1 - u), nearV = std::min(v, 1 - v);
            int corner = -1;
            if (_isCatmark) {
                if (nearU < kAtCorner<Real> && nearV < kAtCorner<Real>) {
                    corner = v < Real(0.5) ? (u < Real(0.5) ? 0 : 1) : (u < Real(0.5) ? 3 : 2);
                }
            } else {
                if (u + v < kAtCorner<Real>) corner = 0;
                if (1 - u < kAtCorner<Real>) corner = 1;
                if (1 - v < kAtCorner<Real>) corner = 2;
            }
            if (corner >= 0) {
                point = _corners[corners + static_cast<std::uint32_t>(corner)];
                point.position += _origin;
                point.du = scale * point.du;
                point.dv = scale * point.dv;
                return;  // with second derivatives of zero
            }
        }
        node = &_patches->nodes[node->first + static_cast<std::uint32_t>(goDown(_isCatmark, u, v, scale))];
    }
    if (node->kind == FaceNode::Kind::Deep) {
        evaluateDeep(exponent, *node, corners, u, v, scale, hasSecond, point);
        return;
    }
    std::uint32_t const* const lines = &_patches->indices[node->first];
    auto const lineAt = [&](int i) { return _lines[lines[i]].v; };
    evaluatePatch(exponent, lineAt, node->hasWeight, node->phantoms, u, v, scale, hasSecond, _origin, point);
}

template <typename Real>
void FacePoints<Real>::evaluateDeep(double exponent, FaceNode const& node, std::uint32_t corners, Real u, Real v,
                                    Real scale, bool hasSecond, SurfacePoint<Real>& point) const {
    // Relative to the limit of the irregular corner, where everything shrinks to: so nothing cancels on the way.
    LimitClass const* here = node.limitClass;
    int corner = 0;
    for (int i = 0; i < (_isCatmark ? 4 : 3); ++i) {
        if (!here->children[index(i)].limitClass->IsRegular()) corner = i;
    }
    SurfacePoint<Real> const& at = _corners[corners + static_cast<std::uint32_t>(corner)];
    std::vector<Line> lines(index(here->numInputs)), next;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        lines[i] = _lines[_patches->indices[node.first + i]];
        lines[i].v[0] -= at.position.x;
        lines[i].v[1] -= at.position.y;
        lines[i].v[2] -= at.position.z;
    }
    for (int depth = 0;; ++depth) {
        for (int row = 0; row < here->rows.NumRows(); ++row) {
            Line line{};
            for (std::uint32_t t = here->rows.offsets[index(row)]; t < here->rows.offsets[index(row) + 1]; ++t) {
                Line const& source = lines[here->rows.sources[t]];
                auto const weight = static_cast<Real>(here->rows.weights[t]);
                for (int k = 0; k < kLanes; ++k) line.v[k] += weight * source.v[k];
            }
            lines.push_back(line);
        }
        if (here->IsRegular()) break;
        // No corner is farther than its own tolerance; a neighbourhood that never gets regular ends here too.
        constexpr int kDeepest = 64;
        if (depth == kDeepest) {
            point = at;
            point.position += _origin;
            point.du = point.dv = {};
            return;
        }
        LimitClass::Child const& child = here->children[index(goDown(_isCatmark, u, v, scale))];
        next.clear();
        for (std::uint32_t const input : child.inputs) next.push_back(lines[input]);
        lines.swap(next);
        here = child.limitClass;
    }
    auto const lineAt = [&](int i) { return lines[here->patch[index(i)]].v; };
    evaluatePatch(exponent, lineAt, node.hasWeight, here->phantoms, u, v, scale, hasSecond, at.position + _origin,
                  point);
}

template <typename Real>
std::size_t FacePoints<Real>::NumBytes() const {
    return sizeof *this + _lines.capacity() * sizeof(Line) + _corners.capacity() * sizeof(SurfacePoint<Real>) +
           _patches->nodes.capacity() * sizeof(FaceNode) + _patches->indices.capacity() * sizeof(std::uint32_t);
}

#define OSD_SHADING_INSTANTIATE(Real) template class FacePoints<Real>;
OSD_SHADING_INSTANTIATE(float)
OSD_SHADING_INSTANTIATE(double)
#undef OSD_SHADING_INSTANTIATE

}  // namespace surface
}  // namespace v1
}  // namespace osd_shading
