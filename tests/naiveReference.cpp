// SPDX-License-Identifier: Apache-2.0
#include "tests/naiveReference.h"

#include <opensubdiv/sdc/catmarkScheme.h>
#include <opensubdiv/sdc/crease.h>
#include <opensubdiv/sdc/loopScheme.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace naive {

namespace Sdc = osd_shading::Sdc;
using osd_shading::ShadingOptions;
using osd_shading::SubdivisionRules;

namespace {

constexpr double kEps = 1e-12;

Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
double Dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec3 Cross(Vec3 a, Vec3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
double Length(Vec3 a) { return std::sqrt(Dot(a, a)); }

/// A sum that remembers how much was added, which decides whether it vanishes.
struct Sum {
    Vec3 sum;
    double added = 0;

    void Add(double weight, Vec3 v) {
        sum = sum + weight * v;
        added += std::abs(weight) * Length(v);
    }
    bool Vanishes() const { return Length(sum) <= kEps * added; }
    Vec3 Normalised() const { return Vanishes() ? Vec3{} : (1 / Length(sum)) * sum; }
    double RelativeLength() const { return added > 0 ? Length(sum) / added : 1; }
};

int Before(std::vector<int> const& face, int vertex) {
    return After(face, vertex, static_cast<int>(face.size()) - 1);
}
bool Holds(std::vector<int> const& face, int vertex) {
    return PlaceOf(face, vertex) < static_cast<int>(face.size());
}

int ValueAt(Level const& m, int face, int vertex) {
    return m.faceValues[U(face)][U(PlaceOf(m.faces[U(face)], vertex))];
}

/// The faces of a region in counter-clockwise order, and the edges' far ends before, between and after them. A
/// closed fan begins with its lowest face, as OpenSubdiv's ring does, and repeats no vertex.
struct Fan {
    std::vector<int> faces, ends;
    bool isClosed = false;
};

Fan FanOf(Level const& m, int value) {
    int const v = m.valueVertices[U(value)];
    auto const& region = m.valueFaces[U(value)];
    auto leaving = [&](int f) { return m.faceEdges[U(f)][U(PlaceOf(m.faces[U(f)], v))]; };
    auto arriving = [&](int f) {
        std::size_t const n = m.faces[U(f)].size();
        return m.faceEdges[U(f)][(U(PlaceOf(m.faces[U(f)], v)) + n - 1) % n];
    };
    Fan fan;
    fan.isClosed = m.kinds[U(v)] <= Kind::Dart;
    int face = region[0];
    for (int f : region) {
        if (!fan.isClosed && m.edges[U(leaving(f))].sharpness > 0) face = f;
    }
    for (;;) {
        fan.faces.push_back(face);
        fan.ends.push_back(OtherEnd(m.edges[U(leaving(face))], v));
        int const edge = arriving(face);
        if (fan.faces.size() == region.size()) {
            if (!fan.isClosed) fan.ends.push_back(OtherEnd(m.edges[U(edge)], v));
            return fan;
        }
        face = *std::find_if(region.begin(), region.end(), [&](int f) { return leaving(f) == edge; });
    }
}

struct Sector {  // what Sdc::Scheme asks of a vertex
    int numEdges, numFaces;
    bool isClosed;

    int GetNumEdges() const { return numEdges; }
    int GetNumFaces() const { return numFaces; }
    float* GetSharpnessPerEdge(float* buffer) const {
        std::fill(buffer, buffer + numEdges, 0.0F);
        if (!isClosed) buffer[0] = buffer[numEdges - 1] = kInfinite;
        return buffer;
    }
};

struct SdcMask {
    using Weight = double;
    std::vector<double> v, e, f;
    bool isForCenters = false;

    explicit SdcMask(int n) : v(1, 0.0), e(U(n), 0.0), f(U(n), 0.0) {}
    int GetNumVertexWeights() const { return static_cast<int>(v.size()); }
    int GetNumEdgeWeights() const { return static_cast<int>(e.size()); }
    int GetNumFaceWeights() const { return static_cast<int>(f.size()); }
    void SetNumVertexWeights(int) {}
    void SetNumEdgeWeights(int) {}
    void SetNumFaceWeights(int) {}
    double& VertexWeight(int i) { return v[U(i)]; }
    double& EdgeWeight(int i) { return e[U(i)]; }
    double& FaceWeight(int i) { return f[U(i)]; }
    double const& VertexWeight(int i) const { return v[U(i)]; }
    double const& EdgeWeight(int i) const { return e[U(i)]; }
    double const& FaceWeight(int i) const { return f[U(i)]; }
    bool AreFaceWeightsForFaceCenters() const { return isForCenters; }
    void SetFaceWeightsForFaceCenters(bool on) { isForCenters = on; }
};

Sum Tangent(Level const& m, int vertex, Fan const& fan, SdcMask const& mask) {
    Sum tangent;
    Vec3 const origin = m.positions[U(vertex)];
    auto add = [&](double w, int end) {
        if (std::abs(w) > kEps) tangent.Add(w, m.positions[U(end)] - origin);
    };
    for (std::size_t i = 0; i < fan.ends.size(); ++i) add(mask.e[i], fan.ends[i]);
    for (std::size_t i = 0; i < fan.faces.size(); ++i) {
        add(mask.f[i], After(m.faces[U(fan.faces[i])], vertex, 2));
    }
    return tangent;
}

/// Normalised vector area, or zero for a face without area.
Vec3 UnitNormal(Level const& m, int face) {
    auto const& f = m.faces[U(face)];
    Vec3 const first = m.positions[U(f[0])];
    Vec3 area;
    double added = 0;
    for (std::size_t i = 1; i + 1 < f.size(); ++i) {
        Vec3 const a = m.positions[U(f[i])] - first, b = m.positions[U(f[i + 1])] - first;
        area = area + Cross(a, b);
        added += Length(a) * Length(b);
    }
    return Length(area) <= kEps * added ? Vec3{} : (1 / Length(area)) * area;
}

double CornerWeight(Level const& m, int face, int vertex, osd_shading::StartNormalKind kind) {
    Vec3 const v = m.positions[U(vertex)];
    Vec3 const a = m.positions[U(After(m.faces[U(face)], vertex))] - v;
    Vec3 const b = m.positions[U(Before(m.faces[U(face)], vertex))] - v;
    double const area = Length(Cross(a, b));
    if (kind == osd_shading::StartNormalKind::CornerArea) return area;
    if (kind == osd_shading::StartNormalKind::Angle) return std::atan2(area, Dot(a, b));
    return 1;
}

Sum FaceAverage(Level const& m, int value, osd_shading::StartNormalKind kind) {
    Sum sum;
    for (int f : m.valueFaces[U(value)])
        sum.Add(CornerWeight(m, f, m.valueVertices[U(value)], kind), UnitNormal(m, f));
    return sum;
}

struct LimitNormal {
    Vec3 normal;  ///< zero where the tangents are degenerate, and the faces' normals vanish as well
    double relativeLength = 1;
    bool isFallback = false;
};

LimitNormal LimitNormalOf(SubdivisionRules const& rules, Level const& m, int value) {
    int const v = m.valueVertices[U(value)];
    Sum const average = FaceAverage(m, value, osd_shading::StartNormalKind::Uniform);
    bool const isCorner = m.kinds[U(v)] == Kind::Corner;
    if (isCorner && m.valueFaces[U(value)].size() > 1) {
        return {average.Normalised(), average.RelativeLength(), average.Vanishes()};
    }
    Sum t1, t2;
    if (isCorner) {
        auto const& face = m.faces[U(m.valueFaces[U(value)][0])];
        t1.Add(1, m.positions[U(After(face, v))] - m.positions[U(v)]);
        t2.Add(1, m.positions[U(Before(face, v))] - m.positions[U(v)]);
    } else {
        Fan const fan = FanOf(m, value);
        int const numEdges = static_cast<int>(fan.ends.size());
        SdcMask position(numEdges), mask1(numEdges), mask2(numEdges);
        Sector const sector{numEdges, static_cast<int>(fan.faces.size()), fan.isClosed};
        auto const rule = fan.isClosed ? Sdc::Crease::RULE_SMOOTH : Sdc::Crease::RULE_CREASE;
        if (IsLoop(rules)) {
            Sdc::Scheme<Sdc::SCHEME_LOOP>().ComputeVertexLimitMask(sector, position, mask1, mask2, rule);
        } else {
            Sdc::Scheme<Sdc::SCHEME_CATMARK>().ComputeVertexLimitMask(sector, position, mask1, mask2, rule);
        }
        t1 = Tangent(m, v, fan, mask1);
        t2 = Tangent(m, v, fan, mask2);
    }
    Vec3 const normal = Cross(t1.sum, t2.sum);
    double const length = Length(normal), scale = t1.added * t2.added;
    if (length <= kEps * scale) return {average.Normalised(), average.RelativeLength(), true};
    return {(1 / length) * normal, length / scale, false};
}

/// What one term of a mask reads: the values of its vertex on this side, with equal shares of its weight.
using Terms = std::vector<std::pair<int, double>>;

/// `mask` on `m`, each vertex's value taken from the faces `sides` that hold it.
Terms Restricted(Level const& m, Mask const& mask, std::vector<int> const& sides) {
    Terms terms;
    for (auto const& [v, w] : mask) {
        std::vector<int> values, standIns;
        for (int f : sides) {
            if (Holds(m.faces[U(f)], v)) values.push_back(ValueAt(m, f, v));
        }
        // Only where non-manifold edges end at a vertex that is no corner: all sides of a vertex stand in.
        for (int value = 0; values.empty() && value < m.NumValues(); ++value) {
            if (m.valueVertices[U(value)] == v) standIns.push_back(value);
        }
        values.insert(values.end(), standIns.begin(), standIns.end());
        for (int value : values) terms.emplace_back(value, w / static_cast<double>(values.size()));
    }
    return terms;
}

/// The parents of the faces of a region, each once.
std::vector<int> ParentFaces(Level const& child, int value) {
    std::set<int> parents;
    for (int f : child.valueFaces[U(value)]) parents.insert(child.parentFaces[U(f)]);
    return {parents.begin(), parents.end()};
}

Sum LinearMean(Terms const& terms, std::vector<Vec3> const& normals) {
    Sum sum;
    for (auto const& [value, w] : terms) sum.Add(w, normals[U(value)]);
    return sum;
}

/// The weighted mean on the sphere: `steps` times, the estimate moves along the mean of the log maps at it.
Vec3 SphericalMean(Terms const& terms, std::vector<Vec3> const& normals, int steps) {
    Vec3 mean = LinearMean(terms, normals).Normalised();
    for (int step = 0; step < steps && Length(mean) > 0; ++step) {
        Vec3 move;
        double total = 0;
        for (auto const& [value, w] : terms) {
            Vec3 const n = normals[U(value)];
            if (Length(n) == 0) continue;
            total += w;
            Vec3 const tangent = n - Dot(n, mean) * mean;
            double const sine = Length(tangent);
            if (sine > 0) move = move + (w * std::atan2(sine, Dot(n, mean)) / sine) * tangent;
        }
        if (total == 0) break;
        move = (1 / total) * move;
        double const angle = Length(move);
        if (angle == 0) break;
        mean = std::cos(angle) * mean + (std::sin(angle) / angle) * move;
        mean = (1 / Length(mean)) * mean;
    }
    return mean;
}

double Apply(Terms const& terms, std::vector<double> const& field) {
    double sum = 0;
    for (auto const& [value, w] : terms) sum += w * field[U(value)];
    return sum;
}

double Apply(Mask const& mask, std::vector<double> const& field) {
    double sum = 0;
    for (auto const& [v, w] : mask) sum += w * field[U(v)];
    return sum;
}

class Weights {
public:
    Weights(Hierarchy const& hierarchy, ShadingOptions const& options, int startLevel)
        : _levels(hierarchy.levels), _rules(hierarchy.rules), _options(options.weights), _start(startLevel) {}

    /// The limit of b, clamped, per value of the last level.
    std::vector<double> Limits() {
        using osd_shading::WeightScheme;
        Level const& last = _levels.back();
        std::vector<double> limits;
        if (_options.scheme == WeightScheme::One) return std::vector<double>(U(last.NumValues()), 1.0);
        bool const isFlat = _options.scheme == WeightScheme::Bilinear;
        int const lastLevel = static_cast<int>(_levels.size()) - 1;

        std::vector<double> b(NumUnknowns(_start), 0.0);
        for (int l = _start;; ++l) {
            Seed(l, b);
            if (l == lastLevel) break;
            Level const& child = _levels[U(l + 1)];
            std::vector<double> next;
            for (int i = 0; i < static_cast<int>(NumUnknowns(l + 1)); ++i) {
                int const v = VertexOf(l + 1, i);
                Mask const& mask = isFlat ? child.flatMasks[U(v)] : child.masks[U(v)];
                next.push_back(IsPerRegion() ? Apply(Restricted(_levels[U(l)], mask, ParentFaces(child, i)), b)
                                             : Apply(mask, b));
            }
            b = next;
        }
        for (int value = 0; value < last.NumValues(); ++value) {
            int const i = IsPerRegion() ? value : last.valueVertices[U(value)];
            double const limit = isFlat ? b[U(i)] : Apply(LimitTerms(lastLevel, i), b);
            limits.push_back(std::clamp(limit, 0.0, 1.0));
        }
        return limits;
    }

private:
    std::vector<Level> const& _levels;
    SubdivisionRules const& _rules;
    osd_shading::BlendWeightOptions const& _options;
    int _start;

    // b has one number per vertex under A and B, one per value under C.
    bool IsPerRegion() const { return _options.sharpVertices == osd_shading::SharpVertexWeight::PerRegion; }
    std::size_t NumUnknowns(int l) const {
        return IsPerRegion() ? _levels[U(l)].valueVertices.size() : _levels[U(l)].positions.size();
    }
    int VertexOf(int l, int i) const { return IsPerRegion() ? _levels[U(l)].valueVertices[U(i)] : i; }

    Terms LimitTerms(int l, int i) const {
        Mask const mask = LimitMask(_rules, _levels[U(l)], VertexOf(l, i));
        if (IsPerRegion()) return Restricted(_levels[U(l)], mask, _levels[U(l)].valueFaces[U(i)]);
        return {mask.begin(), mask.end()};
    }

    bool DartsAreSharp() const { return _options.darts == osd_shading::DartWeight::LikeSharp; }
    bool CountsAsSharp(Level const& m, int v) const {
        return m.IsSharp(v) || (m.kinds[U(v)] == Kind::Dart && DartsAreSharp());
    }

    /// A vertex keeps its number from level to level, so its child at the last level has the same.
    Kind KindAtEnd(int v) const { return _levels.back().kinds[U(v)]; }

    bool IsEligible(int l, int i) const {
        Level const& m = _levels[U(l)];
        int const v = VertexOf(l, i);
        bool const isExtraordinary = IsExtraordinary(_rules, m, v);
        if (_options.sharpVertices == osd_shading::SharpVertexWeight::Smooth) return isExtraordinary;
        if (_options.sharpVertices == osd_shading::SharpVertexWeight::Zero) {
            return isExtraordinary && !CountsAsSharp(m, v);
        }
        std::size_t const numFaces = m.valueFaces[U(i)].size();
        bool const staysSharp = KindAtEnd(v) >= Kind::Crease;
        switch (m.kinds[U(v)]) {
            case Kind::Smooth:
                return isExtraordinary;
            case Kind::Dart:
                return !DartsAreSharp() && (isExtraordinary || KindAtEnd(v) == Kind::Dart);
            case Kind::Crease:
                return staysSharp && (IsLoop(_rules) ? numFaces != 1 && numFaces != 3 : numFaces != 2);
            default:
                return staysSharp && numFaces != 1;
        }
    }

    bool WasEligible(int l, int i) const {
        int const parent = _levels[U(l)].parents[U(VertexOf(l, i))];
        if (parent < 0) return false;
        if (!IsPerRegion()) return IsEligible(l - 1, parent);
        for (int f : ParentFaces(_levels[U(l)], i)) {
            if (IsEligible(l - 1, ValueAt(_levels[U(l - 1)], f, parent))) return true;
        }
        return false;
    }

    void Seed(int l, std::vector<double>& b) const {
        using osd_shading::WeightScheme;
        Level const& m = _levels[U(l)];
        std::vector<int> eligible, fresh;
        for (int i = 0; i < static_cast<int>(b.size()); ++i) {
            if (!IsEligible(l, i)) continue;
            eligible.push_back(i);
            if (l == _start || !WasEligible(l, i)) fresh.push_back(i);
        }
        if (_options.scheme == WeightScheme::OneRing) {
            for (int i : eligible) SeedRing(m, i, b);
        } else if (_options.scheme == WeightScheme::InverseLimit) {
            if (!fresh.empty()) SolveForLimitOne(l, eligible, b);
        } else {
            for (int i : fresh) b[U(i)] = 1;
        }
    }

    void SeedRing(Level const& m, int i, std::vector<double>& b) const {
        for (int f : IsPerRegion() ? m.valueFaces[U(i)] : m.vertexFaces[U(i)]) {
            for (int v : m.faces[U(f)]) {
                if (IsPerRegion()) {
                    b[U(ValueAt(m, f, v))] = 1;
                } else if (_options.sharpVertices == osd_shading::SharpVertexWeight::Smooth ||
                           !CountsAsSharp(m, v)) {
                    b[U(v)] = 1;
                }
            }
        }
    }

    /// The shortest solution: a symmetric mesh may leave a direction free (a cube at level 0 does).
    void SolveForLimitOne(int l, std::vector<int> const& eligible, std::vector<double>& b) const {
        std::map<int, int> column;
        for (int i : eligible) column.insert({i, static_cast<int>(column.size())});
        auto const n = static_cast<Eigen::Index>(eligible.size());
        Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
        Eigen::VectorXd right = Eigen::VectorXd::Ones(n);
        for (int i : eligible) {
            for (auto const& [j, w] : LimitTerms(l, i)) {
                if (column.count(j) != 0) {
                    matrix(column[i], column[j]) += w;
                } else {
                    right(column[i]) -= w * b[U(j)];
                }
            }
        }
        Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
        solver.setThreshold(1e-10);
        Eigen::VectorXd const solution = solver.compute(matrix).solve(right);
        for (int i : eligible) b[U(i)] = solution(column[i]);
    }
};

class Normals {
public:
    Normals(Hierarchy const& hierarchy, ShadingOptions const& options, Reference& report)
        : _levels(hierarchy.levels), _rules(hierarchy.rules), _options(options), _report(report) {}

    std::vector<Vec3> Start(int n, UserNormals const& user) {
        using osd_shading::StartNormalKind;
        Level const& m = _levels[U(n)];
        auto const kind = _options.startNormals.kind;
        std::vector<Vec3> normals;
        if (kind == StartNormalKind::User) {
            std::map<std::pair<int, int>, Vec3> given;
            std::size_t corner = 0;
            for (int f = 0; f < m.NumFaces(); ++f) {
                for (int v : m.faces[U(f)]) {
                    given[{f, v}] = user.perVertex.empty() ? user.perFaceCorner[corner] : user.perVertex[U(v)];
                    ++corner;
                }
            }
            for (int value = 0; value < m.NumValues(); ++value) {
                Sum sum;
                for (int f : m.valueFaces[U(value)]) sum.Add(1, given[{f, m.valueVertices[U(value)]}]);
                Append(normals, sum);
            }
        } else if (kind == StartNormalKind::Limit || kind == StartNormalKind::LimitSmoothed) {
            for (int value = 0; value < m.NumValues(); ++value) {
                LimitNormal const limit = LimitNormalOf(_rules, m, value);
                _report.startNormalLength = std::min(_report.startNormalLength, limit.relativeLength);
                normals.push_back(limit.normal);
            }
            if (kind == StartNormalKind::LimitSmoothed) normals = SmoothedAtExtraordinary(m, normals);
        } else {
            for (int value = 0; value < m.NumValues(); ++value) Append(normals, FaceAverage(m, value, kind));
        }
        _report.zeroStartNormals = 0;
        for (Vec3 const& normal : normals) _report.zeroStartNormals += Length(normal) == 0 ? 1 : 0;
        return normals;
    }

    /// From level `l` to the next, by the geometry's masks restricted to regions.
    std::vector<Vec3> Refined(int l, std::vector<Vec3> const& normals) const {
        using osd_shading::NormalAveraging;
        Level const& child = _levels[U(l + 1)];
        std::vector<Vec3> result;
        for (int value = 0; value < child.NumValues(); ++value) {
            Mask const& mask = child.masks[U(child.valueVertices[U(value)])];
            Terms const terms = Restricted(_levels[U(l)], mask, ParentFaces(child, value));
            auto const& options = _options.subdividedNormals;
            if (options.averaging == NormalAveraging::Spherical) {
                result.push_back(SphericalMean(terms, normals, options.sphericalSteps));
            } else {
                Sum const sum = LinearMean(terms, normals);
                result.push_back(options.averaging == NormalAveraging::Linear ? sum.sum : sum.Normalised());
            }
        }
        return result;
    }

    /// The limits, normalised, and the lengths before.
    void Limit(std::vector<Vec3> const& normals, std::vector<Vec3>& limits, std::vector<double>& lengths,
               std::vector<double>& relative) const {
        Level const& m = _levels.back();
        for (int value = 0; value < m.NumValues(); ++value) {
            Terms const terms =
                Restricted(m, LimitMask(_rules, m, m.valueVertices[U(value)]), m.valueFaces[U(value)]);
            Sum const sum = LinearMean(terms, normals);
            bool const isSpherical =
                _options.subdividedNormals.averaging == osd_shading::NormalAveraging::Spherical;
            // In the end a combination of unit start normals whose weights add to 1: what is below eps is rounding.
            Vec3 const linear = Length(sum.sum) <= kEps ? Vec3{} : (1 / Length(sum.sum)) * sum.sum;
            limits.push_back(isSpherical ? SphericalMean(terms, normals, _options.subdividedNormals.sphericalSteps)
                                         : linear);
            lengths.push_back(isSpherical ? Length(limits.back()) : Length(sum.sum));
            relative.push_back(Length(sum.sum));
        }
    }

private:
    std::vector<Level> const& _levels;
    SubdivisionRules const& _rules;
    ShadingOptions const& _options;
    Reference& _report;

    void Append(std::vector<Vec3>& normals, Sum const& sum) {
        if (!sum.Vanishes()) _report.startNormalLength = std::min(_report.startNormalLength, sum.RelativeLength());
        normals.push_back(sum.Normalised());
    }

    std::vector<Vec3> SmoothedAtExtraordinary(Level const& m, std::vector<Vec3> const& normals) const {
        std::set<int> touched;
        for (int v = 0; v < m.NumVertices(); ++v) {
            if (m.IsSharp(v) || !IsExtraordinary(_rules, m, v)) continue;
            for (int f : m.vertexFaces[U(v)]) {
                for (int u : m.faces[U(f)]) {
                    if (!m.IsSharp(u)) touched.insert(u);
                }
            }
        }
        std::vector<Vec3> result = normals;
        for (int value = 0; value < m.NumValues(); ++value) {
            int const v = m.valueVertices[U(value)];
            if (touched.count(v) == 0) continue;
            Terms const terms = Restricted(m, LimitMask(_rules, m, v), m.valueFaces[U(value)]);
            result[U(value)] = LinearMean(terms, normals).Normalised();
        }
        return result;
    }
};

void CountTopology(Hierarchy const& hierarchy, Reference& r) {
    Level const& m = hierarchy.levels.back();
    r.numVertices = m.NumVertices();
    r.numValues = m.NumValues();
    for (int v = 0; v < m.NumVertices(); ++v) {
        r.sharpVertices += m.IsSharp(v) ? 1 : 0;
        r.darts += m.kinds[U(v)] == Kind::Dart ? 1 : 0;
        r.boundaryVertices += m.IsBoundary(v) ? 1 : 0;
        r.nonManifoldVertices += m.isNonManifold[U(v)] != 0 && !m.vertexFaces[U(v)].empty() ? 1 : 0;
        if (!IsExtraordinary(hierarchy.rules, m, v)) continue;
        ++(m.IsBoundary(v) ? r.boundaryExtraordinary
                           : r.extraordinary)[static_cast<int>(m.vertexEdges[U(v)].size())];
    }
    for (Edge const& e : m.edges) r.nonManifoldEdges += e.isNonManifold ? 1 : 0;
}

}  // namespace

Reference Shade(Hierarchy const& hierarchy, ShadingOptions const& options, UserNormals const& user) {
    Reference r;
    Level const& m = hierarchy.levels.back();
    int const last = static_cast<int>(hierarchy.levels.size()) - 1;
    auto resolved = [&](int level) { return level == osd_shading::kDefaultStartLevel ? std::min(1, last) : level; };
    int const n =
        options.startNormals.kind == osd_shading::StartNormalKind::User ? 0 : resolved(options.startNormals.level);
    CountTopology(hierarchy, r);

    Normals rule(hierarchy, options, r);
    std::vector<Vec3> normals = rule.Start(n, user), subdivided;
    for (int l = n; l < last; ++l) normals = rule.Refined(l, normals);
    std::vector<double> lengths, relative;
    rule.Limit(normals, subdivided, lengths, relative);
    std::vector<double> const weights = Weights(hierarchy, options, resolved(options.weights.level)).Limits();
    std::vector<Vec3> const limits = options.limits.positions == osd_shading::PositionKind::Limit
                                         ? LimitPositions(hierarchy.rules, m)
                                         : m.positions;

    std::vector<Corner> values;
    std::set<int> weighted;
    for (int value = 0; value < m.NumValues(); ++value) {
        Corner c;
        c.vertex = m.valueVertices[U(value)];
        c.value = value;
        c.position = limits[U(c.vertex)];
        c.blendWeight = weights[U(value)];
        c.subdividedNormal = subdivided[U(value)];
        c.subdividedLength = relative[U(value)];

        LimitNormal limit;
        if (options.limits.normals == osd_shading::LimitNormalKind::Limit) {
            limit = LimitNormalOf(hierarchy.rules, m, value);
        } else {
            Sum const average = FaceAverage(m, value, options.startNormals.kind);
            limit = {average.Normalised(), average.RelativeLength(), average.Vanishes()};
            if (limit.isFallback)
                limit.normal = FaceAverage(m, value, osd_shading::StartNormalKind::Uniform).Normalised();
        }
        if (Length(limit.normal) == 0) limit.normal = c.subdividedNormal;
        r.fallbackNormals += limit.isFallback ? 1 : 0;
        c.limitNormal = limit.normal;
        c.limitNormalLength = limit.relativeLength;

        double const share = std::pow(c.blendWeight, options.weights.exponent);
        Sum blend;
        blend.Add(1 - share, c.limitNormal);
        blend.Add(share, c.subdividedNormal);
        c.blendedNormal = blend.Vanishes() ? c.limitNormal : blend.Normalised();
        c.blendedLength = blend.RelativeLength();
        r.zeroNormals += Length(c.blendedNormal) == 0 ? 1 : 0;
        if (c.blendWeight > 0) {
            weighted.insert(c.vertex);
            r.opposedNormals += Dot(c.limitNormal, c.subdividedNormal) < 0 ? 1 : 0;
            r.minSubdividedLength =
                r.minSubdividedLength < 0 ? lengths[U(value)] : std::min(r.minSubdividedLength, lengths[U(value)]);
        }
        values.push_back(c);
    }
    r.verticesWithWeight = static_cast<int>(weighted.size());
    r.faceSize = static_cast<int>(m.faces[0].size());
    r.isHole = m.isHole;
    for (auto const& face : m.faceValues) {
        for (int value : face) r.corners.push_back(values[U(value)]);
    }
    return r;
}

}  // namespace naive
