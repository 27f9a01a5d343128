// SPDX-License-Identifier: Apache-2.0
//
// Tutorial 2: shade from the Far::TopologyRefiner that you have, out of and into your own vertex buffers.
//
// New here:
//   - a refiner stands in for the control mesh: its level 0, scheme and options are used; it is not modified
//   - strides: points are read in place from an interleaved buffer
//   - vertices and faces of the result have OpenSubdiv's order, so both can be used side by side
//   - one vertex of a vertex buffer for each value of the result

#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>
#include <osd_shading/subdivisionShading.h>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <memory>
#include <vector>

using namespace OpenSubdiv;

struct ControlVertex {  // what the application keeps for each point
    float mass;
    float position[3];
    float velocity[3];
};

struct RenderVertex {  // what it draws
    float position[3];
    float normal[3];
};

// A tetrahedron with the edges of its base creased, as any OpenSubdiv program makes it, refined to level 3.
static std::unique_ptr<Far::TopologyRefiner> makeRefiner() {
    static int const faceSizes[] = {3, 3, 3, 3}, faceVertices[] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
    static int const creaseVertices[] = {0, 1, 1, 2, 2, 0};
    static float const creaseSharpness[] = {10, 10, 10};
    Far::TopologyDescriptor descriptor;
    descriptor.numVertices = 4;
    descriptor.numFaces = 4;
    descriptor.numVertsPerFace = faceSizes;
    descriptor.vertIndicesPerFace = faceVertices;
    descriptor.numCreases = 3;
    descriptor.creaseVertexIndexPairs = creaseVertices;
    descriptor.creaseWeights = creaseSharpness;

    using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
    std::unique_ptr<Far::TopologyRefiner> refiner(
        Factory::Create(descriptor, Factory::Options(Sdc::SCHEME_LOOP, Sdc::Options())));
    refiner->RefineUniform(Far::TopologyRefiner::UniformOptions(3));
    return refiner;
}

int main() {
    std::unique_ptr<Far::TopologyRefiner const> const refiner = makeRefiner();
    std::vector<ControlVertex> const points = {
        {1, {0, 0, 0.5F}, {}}, {1, {3, 0.5F, 0}, {}}, {1, {1, 2, 0}, {}}, {1, {1, 1, 2}, {}}};

    // The stride counts numbers, not bytes, from one point to the next.
    osd_shading::ShadingInput<float> input;
    input.positions = {points[0].position, points.size(), sizeof(ControlVertex) / sizeof(float)};
    auto const shaded = osd_shading::ShadeSubdivision(*refiner, input, osd_shading::PaperPreset(3));

    // The refiner's level 3 and the result agree, vertex by vertex and face by face.
    Far::TopologyLevel const& level = refiner->GetLevel(3);
    bool sameFaces = level.GetNumFaces() == shaded.NumFaces();
    auto corner = shaded.faceVertices.begin();
    for (int face = 0; sameFaces && face < level.GetNumFaces(); ++face, corner += shaded.faceSize) {
        Far::ConstIndexArray const vertices = level.GetFaceVertices(face);
        sameFaces = std::equal(vertices.begin(), vertices.end(), corner);
    }
    std::printf("vertices: refiner %d, shading %d\n", level.GetNumVertices(), shaded.NumVertices());
    std::printf("faces: refiner %d, shading %d, %s\n", level.GetNumFaces(), shaded.NumFaces(),
                sameFaces ? "the same" : "different");

    // The vertex buffer; shaded.faceValues is its index buffer, three indices to a triangle.
    std::vector<RenderVertex> buffer;
    buffer.reserve(shaded.blendedNormals.size());
    for (std::size_t value = 0; value < shaded.blendedNormals.size(); ++value) {
        auto const& p = shaded.positions[static_cast<std::size_t>(shaded.valueVertices[value])];
        auto const& n = shaded.blendedNormals[value];
        buffer.push_back({{p.x, p.y, p.z}, {n.x, n.y, n.z}});
    }
    std::printf("buffers: %zu vertices, %zu indices\n", buffer.size(), shaded.faceValues.size());

    // A vertex on the crease has two values: one position, a normal for each side.
    for (int value = shaded.vertexValues[0]; value < shaded.vertexValues[1]; ++value) {
        auto const& [p, n] = buffer[static_cast<std::size_t>(value)];
        std::printf("vertex 0: position %.3f %.3f %.3f, normal %.3f %.3f %.3f\n", p[0], p[1], p[2], n[0], n[1],
                    n[2]);
    }
}
