// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "fuzzTargets.h"
#include "osd_shading/limitSurface.h"
#include "osd_shading/shadingEvaluator.h"
#include "osd_shading/subdivisionShading.h"
#include "tests/faceLocations.h"

namespace fuzz {

namespace {

using namespace osd_shading;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// Bytes, one choice after the other; zeros behind the last one.
class Choices {
public:
    Choices(std::uint8_t const* data, std::size_t size) : _at(data), _end(data + size) {}

    int Byte() { return _at == _end ? 0 : *_at++; }
    int Below(int count) { return Byte() % count; }
    template <typename Enum>
    Enum One(int count) {
        return static_cast<Enum>(Below(count));
    }

private:
    std::uint8_t const* _at;
    std::uint8_t const* _end;
};

/// A control mesh of a few faces that owns its arrays.
struct FuzzedMesh {
    std::vector<float> positions;
    std::vector<int> faceSizes, faceVertices, creaseVertices, cornerVertices, holes;
    std::vector<float> creaseSharpness, cornerSharpness, normals;
    SubdivisionRules rules;

    ControlMesh View() const {
        ControlMesh mesh;
        mesh.numVertices = static_cast<int>(positions.size() / 3);
        mesh.faceSizes = faceSizes;
        mesh.faceVertices = faceVertices;
        mesh.creaseVertices = creaseVertices;
        mesh.creaseSharpness = creaseSharpness;
        mesh.cornerVertices = cornerVertices;
        mesh.cornerSharpness = cornerSharpness;
        mesh.holes = holes;
        mesh.rules = rules;
        return mesh;
    }
};

float chooseSharpness(Choices& choices) {
    constexpr float kSpecial[] = {10, 1, 2, 0, 1e-6F, 9.999F, 1e30F, std::numeric_limits<float>::infinity()};
    int const byte = choices.Byte();
    return byte < 8 ? kSpecial[byte] : static_cast<float>(byte) / 32;
}

FuzzedMesh chooseMesh(Choices& choices) {
    FuzzedMesh mesh;
    mesh.rules.scheme = choices.Below(3) == 0 ? Sdc::SCHEME_LOOP : Sdc::SCHEME_CATMARK;
    mesh.rules.boundary = choices.One<Sdc::Options::VtxBoundaryInterpolation>(3);
    mesh.rules.creasing = choices.One<Sdc::Options::CreasingMethod>(2);
    mesh.rules.triangles = choices.One<Sdc::Options::TriangleSubdivision>(2);

    int const numVertices = 3 + choices.Below(18);
    for (int i = 0; i < 3 * numVertices; ++i) {
        mesh.positions.push_back(static_cast<float>(choices.Byte() - 128) / 16);
    }
    int const numFaces = 1 + choices.Below(12);
    for (int f = 0; f < numFaces; ++f) {
        int const size = mesh.rules.scheme == Sdc::SCHEME_LOOP ? 3 : 3 + (choices.Below(8) + 7) % 8 % 5;
        std::vector<int> face;
        for (int i = 0; i < size; ++i) {
            int const vertex = choices.Below(numVertices);
            if (std::find(face.begin(), face.end(), vertex) == face.end()) face.push_back(vertex);
        }
        if (face.size() < 3 || (mesh.rules.scheme == Sdc::SCHEME_LOOP && face.size() > 3)) continue;
        mesh.faceSizes.push_back(static_cast<int>(face.size()));
        mesh.faceVertices.insert(mesh.faceVertices.end(), face.begin(), face.end());
    }
    for (int i = choices.Below(12); i > 0 && !mesh.faceSizes.empty(); --i) {
        // An edge of a face: its corner and the next one.
        int const face = choices.Below(static_cast<int>(mesh.faceSizes.size()));
        int first = 0;
        for (int f = 0; f < face; ++f) first += mesh.faceSizes[index(f)];
        int const size = mesh.faceSizes[index(face)], corner = choices.Below(size);
        mesh.creaseVertices.push_back(mesh.faceVertices[index(first + corner)]);
        mesh.creaseVertices.push_back(mesh.faceVertices[index(first + (corner + 1) % size)]);
        mesh.creaseSharpness.push_back(chooseSharpness(choices));
    }
    for (int i = choices.Below(4); i > 0; --i) {
        mesh.cornerVertices.push_back(choices.Below(numVertices));
        mesh.cornerSharpness.push_back(chooseSharpness(choices));
    }
    for (int i = choices.Below(3); i > 0 && !mesh.faceSizes.empty(); --i) {
        mesh.holes.push_back(choices.Below(static_cast<int>(mesh.faceSizes.size())));
    }
    return mesh;
}

ShadingOptions chooseOptions(Choices& choices, FuzzedMesh& mesh) {
    constexpr int kLevels[] = {0, 1, 2, 1, 2, 1, 3};  // the last one costs most of the time
    ShadingOptions options = PaperPreset(kLevels[choices.Below(7)]);
    options.startNormals.kind = choices.One<StartNormalKind>(6);
    options.startNormals.level = choices.Below(6) - 1;
    options.subdividedNormals.averaging =
        choices.Below(4) == 3 ? choices.One<NormalAveraging>(3) : NormalAveraging::Linear;
    options.weights.scheme = choices.One<WeightScheme>(5);
    options.weights.sharpVertices = choices.One<SharpVertexWeight>(3);
    options.weights.darts = choices.One<DartWeight>(2);
    options.weights.level = choices.Below(6) - 1;
    constexpr double kExponents[] = {1, 2, 0.5, 1e-3, 100};
    options.weights.exponent = kExponents[choices.Below(5)];
    options.limits.positions = choices.One<PositionKind>(2);
    options.limits.normals = choices.One<LimitNormalKind>(3);
    if (options.startNormals.kind == StartNormalKind::User) {
        std::size_t const count = choices.Below(2) == 0 ? mesh.positions.size() / 3 : mesh.faceVertices.size();
        for (std::size_t i = 0; i < 3 * count; ++i) {
            mesh.normals.push_back(static_cast<float>(choices.Byte() - 128) / 128);
        }
    }
    return options;
}

/// The mesh with its numbers in `Real`, moved a little; its first vertex to the origin too where `moved` is not 0,
/// so that they are rounded otherwise.
template <typename Real>
struct FuzzedInput {
    std::vector<Real> positions, normals;
    ShadingInput<Real> view;

    explicit FuzzedInput(FuzzedMesh const& mesh, double moved = 0, double way = 0)
        : positions(mesh.positions.begin(), mesh.positions.end()),
          normals(mesh.normals.begin(), mesh.normals.end()) {
        // Another direction and length for each coordinate.
        for (std::size_t i = 0; i < positions.size() && moved != 0; ++i) {
            positions[i] -= static_cast<Real>(mesh.positions[i % 3]);
            positions[i] += static_cast<Real>(moved * std::sin(way + (2.7 + way) * static_cast<double>(i)));
        }
        view.positions = {positions.data(), positions.size() / 3};
        PointView<Real> const given(normals.data(), normals.size() / 3);
        (normals.size() == positions.size() ? view.vertexNormals : view.faceVaryingNormals) = given;
    }
};

template <typename Real>
ShadingResult<Real> shade(FuzzedMesh const& mesh, ShadingOptions const& options, double moved = 0, double way = 0) {
    return ShadeSubdivision(mesh.View(), FuzzedInput<Real>(mesh, moved, way).view, options);
}

template <typename Real>
void requireNormals(std::vector<Vec3<Real>> const& normals, char const* promise) {
    for (Vec3<Real> const& n : normals) {
        double const length = std::hypot(double(n.x), double(n.y), double(n.z));
        Require(length == 0 || std::fabs(length - 1) < 1e-5, promise);
    }
}

template <typename Real>
void requirePromises(ShadingResult<Real> const& result) {
    for (Vec3<Real> const& p : result.positions) {
        Require(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z), "positions are finite");
    }
    for (Real const b : result.blendWeights) Require(b >= 0 && b <= 1, "weights are in [0, 1]");
    requireNormals(result.limitNormals, "limit normals are unit or zero");
    requireNormals(result.subdividedNormals, "subdivided normals are unit or zero");
    requireNormals(result.blendedNormals, "blended normals are unit or zero");
}

void requirePromises(SurfacePoint<double> const& point) {
    for (Vec3<double> const& v : {point.position, point.du, point.dv, point.duu, point.duv, point.dvv}) {
        Require(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z), "derivatives are finite");
    }
    Require(point.blendWeight >= 0 && point.blendWeight <= 1, "weights of the surface are in [0, 1]");
    requireNormals<double>({point.limitNormal, point.subdividedNormal, point.blendedNormal},
                           "normals of the surface are unit or zero");
}

bool IsZero(Vec3<double> const& v) { return v.x == 0 && v.y == 0 && v.z == 0; }

template <typename A, typename B>
double distance(Vec3<A> const& a, Vec3<B> const& b) {
    return std::hypot(double(a.x) - double(b.x), double(a.y) - double(b.y), double(a.z) - double(b.z));
}

/// The results of points 1e-6 away, made when asked for: their normals tell how much those here may change by
/// rounding.
class Neighbours {
public:
    Neighbours(FuzzedMesh const& mesh, ShadingOptions const& options, ShadingResult<double> const& result)
        : _mesh(mesh), _options(options), _result(result) {}

    bool IsSteady(std::vector<Vec3<double>> ShadingResult<double>::*normals, std::size_t value) {
        // Of three points all faces lie in one plane; where both sides meet rounding alone is left, however moved.
        std::set<int> const used(_mesh.faceVertices.begin(), _mesh.faceVertices.end());
        if (used.size() < 4) return false;
        constexpr double kSteady = 1e-3;
        for (double const way : {1.0, 2.5, 4.1}) {
            if (_moved.size() < 3) _moved.push_back(shade<double>(_mesh, _options, 1e-6, way));
        }
        return std::all_of(_moved.begin(), _moved.end(), [&](ShadingResult<double> const& other) {
            return distance((_result.*normals)[value], (other.*normals)[value]) < kSteady;
        });
    }
    /// The length of N_B before it is normalised: where it all but vanishes the last digit of b decides.
    double BlendLength(std::size_t value) const {
        double const power = std::pow(_result.blendWeights[value], _options.weights.exponent);
        Vec3<double> const &n = _result.limitNormals[value], &s = _result.subdividedNormals[value];
        return std::hypot((1 - power) * n.x + power * s.x, (1 - power) * n.y + power * s.y,
                          (1 - power) * n.z + power * s.z);
    }

private:
    FuzzedMesh const& _mesh;
    ShadingOptions const& _options;
    ShadingResult<double> const& _result;
    std::vector<ShadingResult<double>> _moved;
};

/// The limit surface at the points of the result.
void requireSameSurface(FuzzedMesh const& mesh, ShadingOptions const& options, ShadingResult<double> const& result,
                        Neighbours& neighbours) {
    FuzzedInput<double> const input(mesh);
    LimitSurface<double> const surface(mesh.View(), input.view, options);
    RefinedTopology const topology(mesh.View(), options.level);
    std::vector<tests::Location> const locations = tests::LocationsOf(topology);
    auto const size = index(result.faceSize);
    for (std::size_t i = 0; i < result.faceValues.size(); ++i) {
        std::size_t const face = i / size, value = index(result.faceValues[i]),
                          vertex = index(result.valueVertices[value]);
        std::size_t const levelFace = result.refinerFaces.empty() ? face : index(result.refinerFaces[face]);
        tests::Location const& at = locations[levelFace * size + i % size];
        SurfacePoint<double> const point = surface.Evaluate(at.face, at.u, at.v);
        requirePromises(point);
        Require(distance(point.position, result.positions[vertex]) < 1e-9,
                "the surface has the result's positions");
        Require(std::fabs(point.blendWeight - result.blendWeights[value]) < 1e-9,
                "the surface has the result's weights");
        auto const compare = [&](Vec3<double> const& normal, auto normals, char const* promise) {
            Vec3<double> const& want = (result.*normals)[value];
            if (distance(normal, want) < 1e-3) return;
            // Where no tangents tell, it takes the faces of another level.
            bool const isDegenerate = result.report.fallbackNormals + result.report.averagedNormals > 0;
            if (isDegenerate || IsZero(normal) || IsZero(want)) return;
            Require(!neighbours.IsSteady(normals, value), promise);
        };
        using Result = ShadingResult<double>;
        compare(point.limitNormal, &Result::limitNormals, "the surface has the result's limit normals");
        if (result.blendWeights[value] < 1e-9) continue;
        compare(point.subdividedNormal, &Result::subdividedNormals, "the surface has the result's N_S");
        if (neighbours.BlendLength(value) > 0.01) {
            compare(point.blendedNormal, &Result::blendedNormals, "the surface has the result's N_B");
        }
    }
    // Anywhere, holes too.
    for (int face = 0; face < surface.NumFaces(); ++face) {
        for (double const t : {0.0, 1e-7, 0.3, 0.77, 1.0}) {
            requirePromises(surface.Evaluate(face, t, 0.6 * t * t, SurfaceDerivatives::Second));
        }
    }
}

/// A frame of a table beside the result.
void requireSameFrame(FuzzedMesh const& mesh, ShadingOptions const& options, ShadingResult<double> const& result,
                      Neighbours& neighbours) {
    ShadingTable const table(mesh.View(), options);
    std::size_t const count = index(table.NumValues());
    Require(count == result.valueVertices.size(), "a table has the values of the result");
    Require(index(table.NumFaces()) * index(table.FaceSize()) == result.faceValues.size(),
            "a table has the faces of the result");
    std::vector<float> numbers(13 * count, std::numeric_limits<float>::quiet_NaN());
    ShadingOutputs outputs;
    if (count > 0) {
        outputs.positions = {&numbers[0], count, 13};
        outputs.blendedNormals = {&numbers[3], count, 13};
        outputs.limitNormals = {&numbers[6], count, 13};
        outputs.subdividedNormals = {&numbers[9], count, 13};
        outputs.blendWeights = {&numbers[12], count, 13};
    }
    ShadingEvaluator evaluator(table);
    evaluator.Evaluate({mesh.positions.data(), mesh.positions.size() / 3},
                       {mesh.normals.data(), mesh.normals.size() / 3}, outputs);

    std::vector<int> const values = table.ResultValues();
    for (std::size_t i = 0; i < count; ++i) {
        float const* const at = &numbers[13 * i];
        std::size_t const value = index(values[i]), vertex = index(result.valueVertices[value]);
        // Points lie within 8 of the origin.
        Require(distance(Vec3<float>{at[0], at[1], at[2]}, result.positions[vertex]) < 1e-4, "positions agree");
        Require(std::fabs(double(at[12]) - result.blendWeights[value]) < 1e-5, "weights agree");
        auto const compare = [&](float const* have, auto normals, char const* promise) {
            Vec3<float> const normal{have[0], have[1], have[2]};
            double const length = std::hypot(double(normal.x), double(normal.y), double(normal.z));
            Require(length == 0 || std::fabs(length - 1) < 1e-5, "a frame's normals are unit or zero");
            // Where faces leave no N_L, N_S stands in; tables hold that only where b is not 0.
            bool const hasOther = result.blendWeights[value] > 0 && !IsZero(result.subdividedNormals[value]);
            // And of slivers back to back either may be left with what rounding makes of their sum.
            bool const isMissing = length == 0 || IsZero((result.*normals)[value]);
            if (isMissing && !hasOther && result.report.fallbackNormals > 0) return;
            if (distance(normal, (result.*normals)[value]) < 0.05) return;
            Require(!neighbours.IsSteady(normals, value), promise);
        };
        using Result = ShadingResult<double>;
        compare(at + 6, &Result::limitNormals, "limit normals agree");
        compare(at + 9, &Result::subdividedNormals, "subdivided normals agree");
        if (neighbours.BlendLength(value) > 0.01) {
            compare(at + 3, &Result::blendedNormals, "blended normals agree");
        }
    }
}

}  // namespace

void FuzzMesh(std::uint8_t const* data, std::size_t size) {
    Choices choices(data, size);
    FuzzedMesh mesh = chooseMesh(choices);
    ShadingOptions const options = chooseOptions(choices, mesh);
    bool const isLinear = options.subdividedNormals.averaging == NormalAveraging::Linear;
    std::string refusal;
    ShadingResult<double> result;
    try {
        result = shade<double>(mesh, options);
    } catch (Error const& error) {
        refusal = error.what();
    }
    if (!refusal.empty()) {
        // What one door refuses, the other one refuses in the same words; normals alone are no business of a table.
        if (!isLinear || refusal.find("ormals") != std::string::npos) return;
        try {
            ShadingTable const table(mesh.View(), options);
        } catch (Error const& error) {
            Require(refusal == error.what(), "both doors refuse in the same words");
            return;
        }
        Require(false, "both doors refuse");
    }
    requirePromises(result);
    requirePromises(shade<float>(mesh, options));
    if (!isLinear) return;
    Neighbours neighbours(mesh, options, result);
    bool const hasSurface =
        options.limits.positions == PositionKind::Limit && options.limits.normals != LimitNormalKind::FaceAverage &&
        options.weights.scheme != WeightScheme::InverseLimit && options.weights.scheme != WeightScheme::Bilinear;
    try {
        if (hasSurface) requireSameSurface(mesh, options, result, neighbours);
    } catch (InvalidControlMesh const& error) {
        std::string const words = error.what();
        Require(words.find("begin and end at the same") != std::string::npos ||
                    words.find("can't tell their sides apart") != std::string::npos,
                "a surface takes the mesh");
    }
    try {
        requireSameFrame(mesh, options, result, neighbours);
    } catch (InvalidControlMesh const& error) {
        // The one kind of mesh that tables alone refuse.
        Require(std::string(error.what()).find("share two edges") != std::string::npos, "a table takes the mesh");
    }
}

}  // namespace fuzz
