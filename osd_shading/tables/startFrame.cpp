// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/tables/startFrame.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "osd_shading/faceNormals.h"
#include "osd_shading/parallel.h"
#include "osd_shading/startNormals.h"

namespace osd_shading {
inline namespace v1 {
namespace tables {

namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// Calls `body(begin, end)` for the chunks of [first, last).
template <typename Body>
void forChunks(FrameThreads& threads, int first, int last, Body const& body) {
    threads.Run(NumChunks(last - first), [&](int chunk, int) {
        int const begin = first + chunk * kChunkSize;
        body(begin, std::min(last - begin, kChunkSize) + begin);
    });
}

Vec3<double> toDouble(Vec3<float> const& p) { return {double{p.x}, double{p.y}, double{p.z}}; }

void store(Vec3<double> const& normal, LocalPoint& result) {
    result = {{static_cast<float>(normal.x), static_cast<float>(normal.y), static_cast<float>(normal.z), 0}};
}

}  // namespace

StartFrame::StartFrame(TableData const& data) : _data(data) {
    StartProgram const& program = data.start;
    if (data.options.startNormals.kind == StartNormalKind::User || program.facePoints.empty()) return;
    _points.resize(index(data.mesh.numVertices) + program.pointOffsets.size() - 1);
    _faceNormals.resize(program.faceOffsets.size() - 1);
}

std::int64_t StartFrame::Compute(PointView<float> controlPoints, PointView<float> userNormals,
                                 FrameThreads& threads, std::vector<LocalPoint>& normals) {
    StartProgram const& program = _data.start;
    std::atomic<std::int64_t> numZero{0};

    if (_data.options.startNormals.kind == StartNormalKind::User) {
        bool const isPerVertex = userNormals.size() == index(_data.mesh.numVertices);
        forChunks(threads, 0, program.numNormals, [&](int begin, int end) {
            std::int64_t zero = 0;
            for (int i = begin; i < end; ++i) {
                Vec3<double> sum{};
                double added = 0;
                for (int c = program.valueOffsets[index(i)]; c < program.valueOffsets[index(i) + 1]; ++c) {
                    int const corner = program.valueFaces[index(c)];
                    int const source = isPerVertex ? _data.mesh.faceVertices[index(corner)] : corner;
                    Vec3<double> const normal = toDouble(userNormals[index(source)]);
                    sum += normal;
                    added += Length(normal);
                }
                Vec3<double> const normal = NormalizedSum(sum, added);
                zero += IsZero(normal);
                store(normal, normals[index(i)]);
            }
            numZero += zero;
        });
        return numZero;
    }

    // Points of the start level.
    int const numControl = _data.mesh.numVertices;
    if (program.facePoints.empty()) return 0;
    forChunks(threads, 0, numControl, [&](int begin, int end) {
        for (int i = begin; i < end; ++i) _points[index(i)] = toDouble(controlPoints[index(i)]);
    });
    for (std::size_t segment = 1; segment < program.rowSegments.size(); ++segment) {
        forChunks(threads, program.rowSegments[segment - 1], program.rowSegments[segment], [&](int begin, int end) {
            double const* const weights = program.pointWeights.data();
            int const* const sources = program.pointSources.data();
            for (int row = begin; row < end; ++row) {
                Vec3<double> sum{};
                auto const last = program.pointOffsets[index(row) + 1];
                for (auto t = program.pointOffsets[index(row)]; t < last; ++t) {
                    sum += weights[t] * _points[index(sources[t])];
                }
                _points[index(numControl + row)] = sum;
            }
        });
    }

    // Normals of their faces, then of the values.
    auto const pointOf = [&](int face, int corner) -> Vec3<double> const& {
        return _points[index(program.facePoints[index(program.faceOffsets[index(face)] + corner)])];
    };
    auto const sizeOf = [&](int face) {
        return program.faceOffsets[index(face) + 1] - program.faceOffsets[index(face)];
    };
    forChunks(threads, 0, static_cast<int>(_faceNormals.size()), [&](int begin, int end) {
        for (int f = begin; f < end; ++f) {
            int const* const corners = program.facePoints.data() + program.faceOffsets[index(f)];
            int const size = sizeOf(f);
            if (size <= 4) {
                // Twice the vector area is the product of two sides or of the diagonals; far from vanishing it
                // needs no closer look.
                bool const isQuad = size == 4;
                Vec3<double> const* const points = _points.data();
                Vec3<double> const a = points[corners[isQuad ? 2 : 1]] - points[corners[0]];
                Vec3<double> const b = points[corners[isQuad ? 3 : 2]] - points[corners[isQuad ? 1 : 0]];
                Vec3<double> const area = Cross(a, b);
                double const squared = Dot(area, area);
                constexpr double kClear = 1e-8, kSmallest = 1e-200;
                if (squared > kClear * Dot(a, a) * Dot(b, b) && squared > kSmallest) {
                    _faceNormals[index(f)] = 1 / std::sqrt(squared) * area;
                    continue;
                }
            }
            _faceNormals[index(f)] = UnitPolygonNormal<double>(size, [&](int i) { return pointOf(f, i); });
        }
    });
    FaceWeight const weight = FaceWeightOf(_data.options.startNormals.kind);
    forChunks(threads, 0, program.numNormals, [&](int begin, int end) {
        std::int64_t zero = 0;
        for (int i = begin; i < end; ++i) {
            int const first = program.valueOffsets[index(i)], last = program.valueOffsets[index(i) + 1];
            if (weight == FaceWeight::Uniform) {
                // Far from vanishing it does not matter how many faces had a normal.
                Vec3<double> sum{};
                for (int c = first; c < last; ++c) sum += _faceNormals[index(program.valueFaces[index(c)])];
                double const squared = Dot(sum, sum);
                constexpr double kClear = 1e-12;
                if (squared > kClear * (last - first) * (last - first)) {
                    store(1 / std::sqrt(squared) * sum, normals[index(i)]);
                    continue;
                }
            }
            auto const sidesOf = [&](int c) {
                int const face = program.valueFaces[index(c)];
                int const size = sizeOf(face), corner = program.valueCorners[index(c)];
                Vec3<double> const p = pointOf(face, corner);
                return std::pair(pointOf(face, (corner + 1) % size) - p,
                                 pointOf(face, (corner + size - 1) % size) - p);
            };
            double longest = 0;
            for (int c = first; c < last && weight == FaceWeight::CornerArea; ++c) {
                auto const [after, before] = sidesOf(c);
                longest = std::fmax(longest, std::fmax(Length(after), Length(before)));
            }
            NormalSum<double> sum;
            for (int c = first; c < last; ++c) {
                double own = 1;
                if (weight != FaceWeight::Uniform) {
                    auto const [after, before] = sidesOf(c);
                    own = std::fmax(CornerWeight(weight, after, before), LeastWeight(weight, longest));
                }
                sum.Add(_faceNormals[index(program.valueFaces[index(c)])], own);
            }
            Vec3<double> const normal = sum.Unit();
            zero += IsZero(normal);
            store(normal, normals[index(i)]);
        }
        numZero += zero;
    });
    return numZero;
}

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
