// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/limitTessellation.h"

#include <opensubdiv/bfr/parameterization.h>
#include <opensubdiv/bfr/tessellation.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "osd_shading/creaseRegions.h"
#include "osd_shading/parallel.h"
#include "osd_shading/vectorMath.h"
#include "osd_shading/vertexTags.h"

namespace osd_shading {
inline namespace v1 {

namespace Bfr = OpenSubdiv::OPENSUBDIV_VERSION::Bfr;

namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

constexpr int kMostSegments = 1024, kSamples = 12;
constexpr double kDegrees = 180 / 3.14159265358979323846;

void check(TessellationOptions const& options) {
    auto const fail = [](std::string const& text) { throw InvalidOptions("tessellation: " + text); };
    auto const checkRate = [&](int rate, char const* name) {
        if (rate >= 1 && rate <= kMostSegments) return;
        fail(std::string(name) + " is " + std::to_string(rate) + "; it must be 1 to " +
             std::to_string(kMostSegments));
    };
    auto const checkSize = [&](double size, char const* name) {
        if (size > 0 && std::isfinite(size)) return;
        fail(std::string(name) + " is " + std::to_string(size) + "; it must be positive");
    };
    checkRate(options.rate, "rate");
    checkRate(options.maxRate, "maxRate");
    checkSize(options.maxAngle, "maxAngle");
    checkSize(options.maxPixels, "maxPixels");
    if (options.numThreads < 0)
        fail("numThreads is " + std::to_string(options.numThreads) + "; it must be 0 or more");
    if (options.width < 1 || options.height < 1) fail("the screen has no pixels; give width and height");
    for (double const x : options.viewProjection) {
        if (!std::isfinite(x)) fail("viewProjection is not finite");
    }
}

template <typename Real>
class Tessellator {
public:
    Tessellator(LimitSurface<Real> const& surface, TessellationOptions const& options)
        : _surface(surface),
          _options(options),
          _level(surface.Refiner().GetLevel(0)),
          _scheme(surface.Refiner().GetSchemeType()) {
        if (_options.numThreads == 0) {
            _options.numThreads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
        }
    }

    ShadingResult<Real> Run() {
        findRates();
        checkSize();
        _faces.resize(index(_level.GetNumFaces()));
        cutFaces();
        numberPoints();
        return std::move(_result);
    }

private:
    struct Face {
        std::vector<int> rates;
        std::vector<SurfacePoint<Real>> points;  ///< the boundary's first, from vertex 0 on
        std::vector<int> facets;                 ///< three points each
        int numBoundary = 0;
    };

    Bfr::Parameterization layoutOf(int face) const { return {_scheme, _level.GetFaceVertices(face).size()}; }
    bool isLeftOut(int face) const { return _surface.IsHole(face); }

    // --- Rates

    void findRates() {
        _rates.assign(index(_level.GetNumEdges()), 1);
        if (_options.kind == TessellationKind::Uniform) {
            std::fill(_rates.begin(), _rates.end(), _options.rate);
            return;
        }
        ParallelForEach(_level.GetNumEdges(), _options.numThreads, [&](int edge) {
            int rate = 1;
            for (int const face : _level.GetEdgeFaces(edge)) {
                if (isLeftOut(face)) continue;
                rate = std::max(rate, rateOf(face, _level.GetFaceEdges(face).FindIndex(edge)));
            }
            _rates[index(edge)] = rate;
        });
    }

    /// By an edge of a face, and the line half way to the opposite edge of a quad.
    int rateOf(int face, int edge) const {
        Bfr::Parameterization const layout = layoutOf(face);
        std::vector<SurfaceParameter<Real>> line(kSamples + 1);
        auto const measure = [&] {
            std::vector<SurfacePoint<Real>> points(line.size());
            _surface.Evaluate(face, line, points.data());
            return _options.kind == TessellationKind::Curvature ? rateOfTurns(points) : rateOnScreen(points);
        };
        for (int i = 0; i <= kSamples; ++i) {
            Real uv[2];
            layout.GetEdgeCoord(edge, static_cast<Real>(i) / kSamples, uv);
            line[index(i)] = {uv[0], uv[1]};
        }
        int rate = measure();
        if (_scheme == Sdc::SCHEME_CATMARK && layout.GetFaceSize() == 4) {
            for (int i = 0; i <= kSamples; ++i) {
                Real const t = static_cast<Real>(i) / kSamples;
                line[index(i)] =
                    edge % 2 == 0 ? SurfaceParameter<Real>{t, Real(0.5)} : SurfaceParameter<Real>{Real(0.5), t};
            }
            rate = std::max(rate, measure());
        }
        return rate;
    }

    int clampRate(double rate) const {
        return rate < _options.maxRate ? std::max(1, static_cast<int>(std::ceil(rate))) : _options.maxRate;
    }

    int rateOfTurns(std::vector<SurfacePoint<Real>> const& points) const {
        double normals = 0, directions = 0;
        for (std::size_t i = 1; i < points.size(); ++i) {
            normals += AngleBetween(points[i - 1].blendedNormal, points[i].blendedNormal);
            if (i < 2) continue;
            Vec3<Real> const a = points[i - 1].position - points[i - 2].position,
                             b = points[i].position - points[i - 1].position;
            directions += AngleBetween(a, b);
        }
        return clampRate(kDegrees * std::max(normals, directions) / _options.maxAngle);
    }

    int rateOnScreen(std::vector<SurfacePoint<Real>> const& points) const {
        auto const& m = _options.viewProjection;
        double length = 0, lastX = 0, lastY = 0;
        int numBehind = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            double const p[3] = {double(points[i].position.x), double(points[i].position.y),
                                 double(points[i].position.z)};
            double clip[4];
            for (std::size_t row = 0; row < 4; ++row) {
                clip[row] = m[row] * p[0] + m[4 + row] * p[1] + m[8 + row] * p[2] + m[12 + row];
            }
            if (!(clip[3] > 0)) {
                ++numBehind;
                continue;
            }
            double const x = 0.5 * _options.width * clip[0] / clip[3],
                         y = 0.5 * _options.height * clip[1] / clip[3];
            if (i > 0) length += std::hypot(x - lastX, y - lastY);
            lastX = x;
            lastY = y;
        }
        // What is behind the eye is not seen; what passes it is near.
        if (numBehind == static_cast<int>(points.size())) return 1;
        return numBehind > 0 ? _options.maxRate : clampRate(length / _options.maxPixels);
    }

    /// Refuses what would take too much, before it is evaluated.
    void checkSize() const {
        double count = 0;
        for (int f = 0; f < _level.GetNumFaces(); ++f) {
            int most = 1;
            for (int const edge : _level.GetFaceEdges(f)) most = std::max(most, _rates[index(edge)]);
            double const size = _level.GetFaceVertices(f).size(), square = double(most) * most;
            count += _scheme == Sdc::SCHEME_LOOP ? square / 2 : square * size / 4;
        }
        double const perPoint = 2 * sizeof(SurfacePoint<Real>) + 100;
        auto const bytes = static_cast<std::uint64_t>(std::min(count * perPoint, 9e18));
        std::string const takes = "the tessellation would take about " + std::to_string(bytes) + " bytes";
        constexpr double kMostPoints = 250e6;  // a point has up to 6 corners of triangles
        if (count > kMostPoints) {
            throw MemoryLimitExceeded(takes + " and more points than 32-bit indices can number; use lower rates",
                                      bytes);
        }
        std::uint64_t const limit = _surface.Options().execution.memoryLimit;
        if (limit != 0 && bytes > limit) {
            throw MemoryLimitExceeded(takes + ", more than the limit of " + std::to_string(limit) +
                                          "; use lower rates or raise the limit",
                                      bytes);
        }
    }

    // --- Faces

    void cutFaces() {
        int const numFaces = _level.GetNumFaces();
        constexpr int kMostReports = 100, kLeastFaces = 64;
        int const step = _options.progress ? std::max(kLeastFaces, numFaces / kMostReports) : numFaces;
        for (int first = 0; first < numFaces; first += step) {
            ParallelForEach(std::min(step, numFaces - first), _options.numThreads,
                            [&](int i) { cutFace(first + i); });
            double const done = static_cast<double>(std::min(numFaces, first + step)) / numFaces;
            if (_options.progress && !_options.progress(done)) throw Cancelled("the tessellation was abandoned");
        }
    }

    void cutFace(int face) {
        if (isLeftOut(face)) return;
        Face& made = _faces[index(face)];
        Bfr::Parameterization const layout = layoutOf(face);
        for (int const edge : _level.GetFaceEdges(face)) made.rates.push_back(_rates[index(edge)]);
        Bfr::Tessellation const cut(layout, static_cast<int>(made.rates.size()), made.rates.data());
        std::vector<Real> coordinates(2 * index(cut.GetNumCoords()));
        cut.GetCoords(coordinates.data());
        made.facets.resize(3 * index(cut.GetNumFacets()));
        cut.GetFacets(made.facets.data());
        made.numBoundary = cut.GetNumBoundaryCoords();
        std::vector<SurfaceParameter<Real>> parameters;
        for (std::size_t i = 0; i < coordinates.size(); i += 2)
            parameters.push_back({coordinates[i], coordinates[i + 1]});
        made.points.resize(parameters.size());
        _surface.Evaluate(face, parameters, made.points.data());
    }

    // --- Numbers

    /// The vertex at a face's boundary point, which all faces at it share.
    int vertexAt(int face, int edge, int i) const {
        Far::ConstIndexArray const vertices = _level.GetFaceVertices(face);
        if (i == 0) return vertices[edge];
        int const e = _level.GetFaceEdges(face)[edge], rate = _rates[index(e)];
        bool const isForward = _level.GetEdgeVertices(e)[0] == vertices[edge];
        return _firstOfEdge[index(e)] + (isForward ? i : rate - i) - 1;
    }

    void numberPoints() {
        int const numFaces = _level.GetNumFaces();
        // Vertices: those of the control mesh, then face by face of edges that are new, and those inside.
        std::int64_t count = _level.GetNumVertices();
        std::vector<int> firstInside(_faces.size(), 0);
        _firstOfEdge.assign(index(_level.GetNumEdges()), -1);
        for (int f = 0; f < numFaces; ++f) {
            if (isLeftOut(f)) continue;
            for (int const e : _level.GetFaceEdges(f)) {
                if (_firstOfEdge[index(e)] >= 0) continue;
                _firstOfEdge[index(e)] = static_cast<int>(count);
                count += _rates[index(e)] - 1;
            }
            firstInside[index(f)] = static_cast<int>(count);
            count += static_cast<std::int64_t>(_faces[index(f)].points.size()) - _faces[index(f)].numBoundary;
        }

        // Which vertex each point of each face is; the first face at a vertex places it.
        ShadingResult<Real>& result = _result;
        result.options = _surface.Options();
        result.faceSize = 3;
        result.positions.resize(static_cast<std::size_t>(count));
        for (int v = 0; v < _level.GetNumVertices(); ++v) {
            result.positions[index(v)] = _surface.Input().positions[index(v)];  // stays where no face is
        }
        std::vector<unsigned char> isPlaced(static_cast<std::size_t>(count), 0);
        std::vector<std::vector<int>> vertexOfPoint(_faces.size());
        for (int f = 0; f < numFaces; ++f) {
            Face const& face = _faces[index(f)];
            if (isLeftOut(f)) continue;
            std::vector<int>& vertices = vertexOfPoint[index(f)];
            for (int edge = 0; edge < static_cast<int>(face.rates.size()); ++edge) {
                for (int i = 0; i < face.rates[index(edge)]; ++i) vertices.push_back(vertexAt(f, edge, i));
            }
            for (int next = firstInside[index(f)]; vertices.size() < face.points.size(); ++next) {
                vertices.push_back(next);
            }
            for (std::size_t i = 0; i < vertices.size(); ++i) {
                if (isPlaced[index(vertices[i])] != 0) continue;
                isPlaced[index(vertices[i])] = 1;
                result.positions[index(vertices[i])] = face.points[i].position;
            }
        }
        makeValues(vertexOfPoint);
        tagVertices();
        findCreaseEdges();
        fillReport();
    }

    /// A value for each different normal at a vertex.
    void makeValues(std::vector<std::vector<int>> const& vertexOfPoint) {
        constexpr Real kSame = sizeof(Real) == 4 ? Real(1e-4) : Real(1e-6);
        struct Value {
            SurfacePoint<Real> const* point;
            int next, number;
        };
        std::vector<Value> values;
        std::vector<int> firstOfVertex(_result.positions.size(), -1);
        std::vector<std::vector<int>> valueOfPoint(_faces.size());
        for (std::size_t f = 0; f < _faces.size(); ++f) {
            for (std::size_t i = 0; i < vertexOfPoint[f].size(); ++i) {
                SurfacePoint<Real> const& point = _faces[f].points[i];
                int* place = &firstOfVertex[index(vertexOfPoint[f][i])];
                while (*place >= 0) {
                    Value& value = values[index(*place)];
                    if (Length(value.point->blendedNormal - point.blendedNormal) <= kSame &&
                        Length(value.point->limitNormal - point.limitNormal) <= kSame) {
                        break;
                    }
                    place = &value.next;
                }
                if (*place < 0) {
                    int const number = static_cast<int>(values.size());
                    *place = number;
                    values.push_back({&point, -1, 0});
                    valueOfPoint[f].push_back(number);
                } else {
                    valueOfPoint[f].push_back(*place);
                }
            }
        }

        // In the order of their vertices.
        ShadingResult<Real>& result = _result;
        result.vertexValues.push_back(0);
        for (std::size_t v = 0; v < firstOfVertex.size(); ++v) {
            for (int at = firstOfVertex[v]; at >= 0; at = values[index(at)].next) {
                SurfacePoint<Real> const& point = *values[index(at)].point;
                values[index(at)].number = static_cast<int>(result.blendedNormals.size());
                result.valueVertices.push_back(static_cast<int>(v));
                result.limitNormals.push_back(point.limitNormal);
                result.subdividedNormals.push_back(point.subdividedNormal);
                result.blendedNormals.push_back(point.blendedNormal);
                result.blendWeights.push_back(point.blendWeight);
            }
            result.vertexValues.push_back(static_cast<int>(result.blendedNormals.size()));
        }
        for (std::size_t f = 0; f < _faces.size(); ++f) {
            for (std::size_t i = 0; i < _faces[f].facets.size(); ++i) {
                auto const point = index(_faces[f].facets[i]);
                result.faceVertices.push_back(vertexOfPoint[f][point]);
                result.faceValues.push_back(values[index(valueOfPoint[f][point])].number);
                if (i % 3 == 0) result.baseFaces.push_back(static_cast<int>(f));
            }
        }
    }

    /// Points of a control edge, its ends too.
    std::vector<int> pointsOf(int edge) const {
        Far::ConstIndexArray const ends = _level.GetEdgeVertices(edge);
        std::vector<int> points{ends[0]};
        for (int i = 0; i + 1 < _rates[index(edge)]; ++i) points.push_back(_firstOfEdge[index(edge)] + i);
        points.push_back(ends[1]);
        return points;
    }

    void tagVertices() {
        std::vector<VertexTag>& tags = _result.vertexTags;
        tags.resize(_result.positions.size());
        for (int v = 0; v < _level.GetNumVertices(); ++v)
            tags[index(v)] = TagOf(_scheme == Sdc::SCHEME_CATMARK, _level, v);
        for (int e = 0; e < _level.GetNumEdges(); ++e) {
            if (_firstOfEdge[index(e)] < 0) continue;
            VertexTag tag;
            tag.kind = IsSharpEdge(_level, e) ? VertexKind::Crease : VertexKind::Smooth;
            tag.isBoundary = _level.IsEdgeBoundary(e);
            tag.isNonManifold = _level.IsEdgeNonManifold(e);
            for (int i = 0; i + 1 < _rates[index(e)]; ++i) tags[index(_firstOfEdge[index(e)] + i)] = tag;
        }
    }

    void findCreaseEdges() {
        for (int e = 0; e < _level.GetNumEdges(); ++e) {
            if (_firstOfEdge[index(e)] < 0 || !IsSharpEdge(_level, e)) continue;
            float const sharpness = _level.GetEdgeSharpness(e);
            std::vector<int> const points = pointsOf(e);
            for (std::size_t i = 1; i < points.size(); ++i) {
                _result.creaseEdges.push_back(
                    {{points[i - 1], points[i]}, sharpness, sharpness, _level.IsEdgeBoundary(e)});
            }
        }
    }

    void fillReport() {
        ShadingResult<Real>& result = _result;
        ShadingReport& report = result.report;
        report.vertices = result.NumVertices();
        report.faces = result.NumFaces();
        report.values = result.NumValues();
        for (VertexTag const& tag : result.vertexTags) CountTag(tag, report);
        for (int e = 0; e < _level.GetNumEdges(); ++e) report.nonManifoldEdges += _level.IsEdgeNonManifold(e);
        double sum = 0;
        for (std::size_t i = 0; i < result.blendWeights.size(); ++i) {
            report.subdividedValues += result.blendWeights[i] > 0;
            report.zeroNormals += IsZero(result.blendedNormals[i]);
            if (!(result.blendWeights[i] > 0)) continue;
            report.opposedNormals += Dot(result.limitNormals[i], result.subdividedNormals[i]) < 0;
            double const angle = kDegrees * AngleBetween(result.limitNormals[i], result.blendedNormals[i]);
            sum += angle;
            if (report.maxAngleValue < 0 || angle > report.maxAngle) {
                report.maxAngle = angle;
                report.maxAngleValue = static_cast<std::int64_t>(i);
            }
        }
        report.meanAngle = result.NumValues() > 0 ? sum / result.NumValues() : 0;
        for (int v = 0; v < result.NumVertices(); ++v) {
            auto const first = result.blendWeights.begin() + result.vertexValues[index(v)];
            auto const last = result.blendWeights.begin() + result.vertexValues[index(v) + 1];
            report.verticesWithWeight += std::any_of(first, last, [](Real b) { return b > 0; });
        }
    }

    LimitSurface<Real> const& _surface;
    TessellationOptions _options;
    Far::TopologyLevel _level;
    Sdc::SchemeType _scheme;
    std::vector<int> _rates;  // by edge
    std::vector<Face> _faces;
    std::vector<int> _firstOfEdge;  // by edge: the first point inside it; -1: no face has it
    ShadingResult<Real> _result;
};

}  // namespace

template <typename Real>
ShadingResult<Real> TessellateLimitSurface(LimitSurface<Real> const& surface, TessellationOptions const& options) {
    check(options);
    return Tessellator<Real>(surface, options).Run();
}

#define OSD_SHADING_INSTANTIATE(Real)                                                              \
    template OSD_SHADING_API ShadingResult<Real> TessellateLimitSurface(LimitSurface<Real> const&, \
                                                                        TessellationOptions const&);
OSD_SHADING_INSTANTIATE(float)
OSD_SHADING_INSTANTIATE(double)
#undef OSD_SHADING_INSTANTIATE

}  // namespace v1
}  // namespace osd_shading
