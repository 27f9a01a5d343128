// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/exactLimitMasks.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <utility>

#include "osd_shading/refinedTopology.h"

namespace osd_shading {
inline namespace v1 {

namespace {

constexpr double kPi = 3.14159265358979323846;

/// Vertex 0, the far ends of its edges, the opposite vertices of its faces: what refines itself.
struct Neighborhood {
    Sdc::SchemeType scheme;
    int numFaces, numEdges;
    RingKind kind;

    bool IsCatmark() const { return scheme == Sdc::SCHEME_CATMARK; }
    int Size() const { return 1 + numEdges + (IsCatmark() ? numFaces : 0); }
    int Edge(int i) const { return 1 + (kind == RingKind::Fan ? i : i % numFaces); }
    int Face(int i) const { return 1 + numEdges + i; }

    /// The vertex that the reflection takes `element` to.
    int Mirror(int element) const {
        if (element == 0) return 0;
        if (element <= numEdges) {
            int const i = element - 1;
            return kind == RingKind::Fan ? Edge(numFaces - i) : Edge((numFaces - i) % numFaces);
        }
        return Face(numFaces - 1 - (element - 1 - numEdges));
    }
    /// Where an even layout puts it: x is odd or even as the kind has it.
    std::pair<double, double> Place(int element) const {
        if (element == 0) return {0, 0};
        double const step = (kind == RingKind::Fan ? kPi : 2 * kPi) / numFaces;
        if (element <= numEdges) {
            double const angle = step * (element - 1);
            return {std::cos(angle), std::sin(angle)};
        }
        double const angle = step * (element - 1 - numEdges);
        return {std::cos(angle) + std::cos(angle + step), std::sin(angle) + std::sin(angle + step)};
    }
};

/// Row i: what element i of the next level is made of.
Eigen::MatrixXd recordMatrix(Neighborhood const& around) {
    ControlMesh mesh;
    std::vector<int> const sizes(static_cast<std::size_t>(around.numFaces), around.IsCatmark() ? 4 : 3);
    std::vector<int> vertices;
    for (int i = 0; i < around.numFaces; ++i) {
        vertices.insert(vertices.end(), {0, around.Edge(i)});
        if (around.IsCatmark()) vertices.push_back(around.Face(i));
        vertices.push_back(around.Edge(i + 1));
    }
    std::vector<int> const crease{0, 1};
    std::vector<float> const sharpness{Sdc::Crease::SHARPNESS_INFINITE};
    mesh.numVertices = around.Size();
    mesh.faceSizes = sizes;
    mesh.faceVertices = vertices;
    mesh.rules.scheme = around.scheme;
    mesh.rules.boundary = Sdc::Options::VTX_BOUNDARY_EDGE_ONLY;
    if (around.kind == RingKind::Dart) {
        mesh.creaseVertices = crease;
        mesh.creaseSharpness = sharpness;
    }
    RefinedTopology const topology(mesh, 1);
    LevelMasks<double> const masks = topology.RecordMasks<double>(1);
    Far::TopologyLevel const& level = topology.Level(0);

    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(around.Size(), around.Size());
    auto const addRow = [&](int element, int child, double scale, auto const& self) -> void {
        auto const row = static_cast<std::size_t>(masks.Row(child));
        for (int t = masks.offsets[row]; t < masks.offsets[row + 1]; ++t) {
            int const term = masks.terms[static_cast<std::size_t>(t)];
            double const weight = scale * masks.weights[static_cast<std::size_t>(t)];
            if (term >= 0) {
                matrix(element, term) += weight;
            } else {
                self(element, ~term, weight, self);
            }
        }
    };
    addRow(0, level.GetVertexChildVertex(0), 1, addRow);
    for (int e = 0; e < level.GetNumEdges(); ++e) {
        Far::ConstIndexArray const ends = level.GetEdgeVertices(e);
        if (ends[0] == 0 || ends[1] == 0) addRow(ends[0] + ends[1], level.GetEdgeChildVertex(e), 1, addRow);
    }
    for (int f = 0; around.IsCatmark() && f < around.numFaces; ++f) {
        addRow(around.Face(f), level.GetFaceChildVertex(f), 1, addRow);
    }
    return matrix;
}

/// The left eigenvectors of `matrix` that are even (sign 1) or odd (sign -1) under the reflection: eigenvalues in
/// falling order of their size, and the vectors as columns.
struct Half {
    std::vector<double> values;  ///< their sizes; complex ones too
    Eigen::MatrixXd vectors;     ///< of the real ones; others are zero
};
Half solveHalf(Neighborhood const& around, Eigen::MatrixXd const& matrix, int sign) {
    // One number for each pair of mirror images; odd vectors vanish on those that are their own.
    std::vector<std::pair<int, int>> orbits;
    for (int i = 0; i < around.Size(); ++i) {
        int const mirrored = around.Mirror(i);
        if (i < mirrored || (i == mirrored && sign > 0)) orbits.emplace_back(i, mirrored);
    }
    auto const size = static_cast<Eigen::Index>(orbits.size());
    Eigen::MatrixXd transposed(size, size);
    for (Eigen::Index p = 0; p < size; ++p) {
        for (Eigen::Index o = 0; o < size; ++o) {
            auto const [a, b] = orbits[static_cast<std::size_t>(o)];
            int const to = orbits[static_cast<std::size_t>(p)].first;
            transposed(p, o) = matrix(a, to) + (a == b ? 0 : sign * matrix(b, to));
        }
    }
    Half half;
    if (size == 0) return half;
    Eigen::EigenSolver<Eigen::MatrixXd> const solver(transposed);
    std::vector<Eigen::Index> order(orbits.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
        return std::abs(solver.eigenvalues()[a]) > std::abs(solver.eigenvalues()[b]);
    });
    half.vectors = Eigen::MatrixXd::Zero(around.Size(), size);
    for (Eigen::Index column = 0; column < size; ++column) {
        Eigen::Index const from = order[static_cast<std::size_t>(column)];
        auto const value = solver.eigenvalues()[from];
        half.values.push_back(std::abs(value));
        if (std::fabs(value.imag()) > 0 || value.real() < 0) continue;
        for (Eigen::Index o = 0; o < size; ++o) {
            auto const [a, b] = orbits[static_cast<std::size_t>(o)];
            double const entry = solver.eigenvectors()(o, from).real();
            half.vectors(b, column) = sign * entry;
            half.vectors(a, column) = entry;
        }
    }
    return half;
}

ExactLimitMask::Weights weightsOf(Neighborhood const& around, Eigen::VectorXd const& vector, double scale) {
    ExactLimitMask::Weights weights;
    weights.vertex = scale * vector[0];
    for (int i = 0; i < around.numEdges; ++i) weights.edges.push_back(scale * vector[1 + i]);
    for (int i = 1 + around.numEdges; i < around.Size(); ++i) weights.faces.push_back(scale * vector[i]);
    return weights;
}

}  // namespace

ExactLimitMask FindExactLimitMask(Sdc::SchemeType scheme, int numFaces, RingKind kind) {
    Neighborhood const around{scheme, numFaces, kind == RingKind::Fan ? numFaces + 1 : numFaces, kind};
    Eigen::MatrixXd const matrix = recordMatrix(around);
    Half const even = solveHalf(around, matrix, 1), odd = solveHalf(around, matrix, -1);

    ExactLimitMask mask;
    Eigen::VectorXd const position = even.vectors.col(0);
    mask.position = weightsOf(around, position, 1 / position.sum());

    // The tangents must outgrow everything else, and both be there.
    constexpr double kMargin = 1e-6;  // a chained pair of eigenvalues is found to the root of the precision
    double const otherEven = even.values.size() > 2 ? even.values[2] : 0;
    bool const isFan = kind == RingKind::Fan;
    Eigen::VectorXd evenTangent, oddTangent;
    if (isFan) {
        // Odd: the crease's own direction; with 4 faces (Loop: 6) an odd cross mode has its eigenvalue too, to
        // which it is chained, so that it outgrows that mode by a factor of the level.
        bool const isLargest = odd.values[0] < 0.5 + kMargin;
        mask.hasTangentPlane = isLargest && even.values[1] > otherEven + kMargin;
        oddTangent = Eigen::VectorXd::Zero(around.Size());
        oddTangent[around.Edge(0)] = 1;
        oddTangent[around.Edge(numFaces)] = -1;
    } else {
        double const otherOdd = odd.values.size() > 1 ? odd.values[1] : 0;
        double const others = std::max(otherEven, otherOdd);
        mask.hasTangentPlane = !odd.values.empty() && even.values.size() > 1 && numFaces > 2 &&
                               std::min(even.values[1], odd.values[0]) > others + kMargin;
        if (mask.hasTangentPlane) oddTangent = odd.vectors.col(0);
    }
    if (!mask.hasTangentPlane) return mask;
    evenTangent = even.vectors.col(1);

    // Scaled and turned so that an even layout of edges of length 1 has tangents of the length that OpenSubdiv's
    // masks give it, along x and y: about half the number of edges.
    auto const extent = [&](Eigen::VectorXd const& tangent, bool isAlongX) {
        double sum = 0;
        for (int i = 0; i < around.Size(); ++i) {
            auto const [x, y] = around.Place(i);
            sum += tangent[i] * (isAlongX ? x : y);
        }
        return sum;
    };
    // A fan's mirror is the y axis, a dart's the x axis.
    Eigen::VectorXd const& alongX = isFan ? oddTangent : evenTangent;
    Eigen::VectorXd const& alongY = isFan ? evenTangent : oddTangent;
    double const extentX = extent(alongX, true), extentY = extent(alongY, false);
    assert(extentX != 0 && extentY != 0);
    mask.tangent1 = weightsOf(around, alongX, 1 / extentX);
    mask.tangent2 = weightsOf(around, alongY, 1 / extentY);
    return mask;
}

}  // namespace v1
}  // namespace osd_shading
