// SPDX-License-Identifier: Apache-2.0
//
// Tutorial 7: threads.
//
// New here:
//   - one shading on several threads: `execution.numThreads`
//   - several shadings at once: nothing is global, and const objects may be shared without a lock
//   - the same bits every time, whatever the number of threads
//   - watching a long shading, and stopping it

#include <osd_shading/subdivisionShading.h>

#include <cstddef>
#include <cstdio>
#include <cstring>
#include <future>
#include <vector>

using Result = osd_shading::ShadingResult<float>;

// Bit for bit: == would take 0 for -0.
static bool haveSameBits(std::vector<osd_shading::Vec3<float>> const& a,
                         std::vector<osd_shading::Vec3<float>> const& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0;
}

int main() {
    std::vector<float> const points = {-1, -1, -1, 1, -1, -1, 1, 1, -1, -1, 1, -1,
                                       -1, -1, 1,  1, -1, 1,  1, 1, 1,  -1, 1, 1};
    std::vector<int> const faceSizes = {4, 4, 4, 4, 4, 4};
    std::vector<int> const faceVertices = {4, 5, 6, 7, 3, 2, 1, 0, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7};
    osd_shading::ControlMesh mesh;
    mesh.numVertices = 8;
    mesh.faceSizes = faceSizes;
    mesh.faceVertices = faceVertices;
    osd_shading::ShadingInput<float> input;
    input.positions = {points.data(), 8};

    // Four shadings at once of the same mesh, on 1, 2, 3 and 4 threads each. 0 takes all that the machine has.
    auto const& sharedMesh = mesh;
    auto const& sharedInput = input;
    std::vector<std::future<Result>> running;
    for (int numThreads = 1; numThreads <= 4; ++numThreads) {
        running.push_back(std::async(std::launch::async, [&sharedMesh, &sharedInput, numThreads] {
            osd_shading::ShadingOptions options = osd_shading::PaperPreset(6);
            options.execution.numThreads = numThreads;
            return osd_shading::ShadeSubdivision(sharedMesh, sharedInput, options);
        }));
    }

    // The results are values of their own. Errors would arrive here too: get() rethrows them.
    Result const first = running[0].get();
    for (std::size_t i = 1; i < running.size(); ++i) {
        Result const other = running[i].get();
        bool const areSame = haveSameBits(first.positions, other.positions) &&
                             haveSameBits(first.blendedNormals, other.blendedNormals);
        std::printf("%zu threads: %d faces, %s\n", i + 1, other.NumFaces(), areSame ? "same bits" : "other bits");
    }

    // Progress is told to the thread that called; false stops the shading with osd_shading::Cancelled.
    osd_shading::ShadingOptions options = osd_shading::PaperPreset(6);
    options.execution.progress = [](double share) { return share < 0.25; };
    try {
        osd_shading::ShadeSubdivision(mesh, input, options);
    } catch (osd_shading::Cancelled const& cancelled) {
        std::printf("stopped: %s\n", cancelled.what());
    }
}
