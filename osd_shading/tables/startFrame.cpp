// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/tables/startFrame.h"

#include <algorithm>
#include <cmath>

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
            for (int row = begin; row < end; ++row) {
                Vec3<double> sum{};
                for (auto t = program.pointOffsets[index(row)]; t < program.pointOffsets[index(row) + 1]; ++t) {
                    sum += program.pointWeights[t] * _points[index(program.pointSources[t])];
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
            _faceNormals[index(f)] = UnitPolygonNormal<double>(sizeOf(f), [&](int i) { return pointOf(f, i); });
        }
    });
    FaceWeight const weight = FaceWeightOf(_data.options.startNormals.kind);
    forChunks(threads, 0, program.numNormals, [&](int begin, int end) {
        std::int64_t zero = 0;
        for (int i = begin; i < end; ++i) {
            VectorSum<double> sum;
            for (int c = program.valueOffsets[index(i)]; c < program.valueOffsets[index(i) + 1]; ++c) {
                int const face = program.valueFaces[index(c)];
                double own = 1;
                if (weight != FaceWeight::Uniform) {
                    int const size = sizeOf(face), corner = program.valueCorners[index(c)];
                    Vec3<double> const p = pointOf(face, corner);
                    own = CornerWeight(weight, pointOf(face, (corner + 1) % size) - p,
                                       pointOf(face, (corner + size - 1) % size) - p);
                }
                sum.Add(_faceNormals[index(face)], own);
            }
            Vec3<double> const normal = sum.Normalized();
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
