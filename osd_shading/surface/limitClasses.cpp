// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/surface/limitClasses.h"

#include <algorithm>
#include <utility>

#include "osd_shading/tables/neededRows.h"

namespace osd_shading {
inline namespace v1 {
namespace surface {

namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

}  // namespace

LimitClass const& LimitClasses::Find(RegionLevels& levels, int level, int face, std::vector<FaceCorner>& inputs) {
    TileRing const ring = FindRegionRing(levels, level, face);
    std::vector<std::int32_t> key;
    ring.AppendKey(key);
    std::unique_ptr<Entry>& place = _classOfKey[key];
    if (!place) place = std::make_unique<Entry>();
    Entry& entry = *place;
    if (!entry.isMade && !entry.isBeingMade) {
        // Also once more where memory had run out.
        struct Mark {
            bool& flag;
            explicit Mark(bool& f) : flag(f) { flag = true; }
            ~Mark() { flag = false; }
        } const mark(entry.isBeingMade);
        entry.limitClass = {};
        make(ring, entry);
        entry.isMade = true;
    }
    inputs.clear();
    for (FaceCorner const& at : entry.inputs) {
        int const size = ring.faceSizes[index(at.face)];
        inputs.push_back({ring.faces[index(at.face)], (ring.firstCorners[index(at.face)] + at.corner) % size});
    }
    return entry.limitClass;
}

void LimitClasses::make(TileRing const& ring, Entry& entry) {
    RefinedTopology const topology(ring.Mesh(RulesOfRings(_scheme)), 1);
    RegionLevels levels(topology);
    LimitClass& made = entry.limitClass;

    // Inputs: all values of the ring. They are there before the children are, which may be of this very class.
    CreaseRegions const& regions = levels.Regions(0);
    made.numInputs = regions.NumValues();
    entry.inputs.assign(index(made.numInputs), {});
    for (int f = 0; f < levels.Level(0).GetNumFaces(); ++f) {
        for (int corner = 0; corner < levels.Level(0).GetFaceVertices(f).size(); ++corner) {
            FaceCorner& at = entry.inputs[index(regions.CornerValue(f, corner))];
            if (!at.IsFound()) at = {f, corner};
        }
    }

    RegularPatch const patch = FindRegularPatch(levels, 0, ring.tileFace);
    if (patch.IsFound()) {
        made.patch.resize(patch.points.size());
        for (std::size_t i = 0; i < patch.points.size(); ++i) {
            if (!patch.points[i].at.IsFound()) continue;
            made.patch[i] = static_cast<std::uint32_t>(levels.ValueAt(0, patch.points[i].at));
        }
        for (int const phantom : patch.order) {
            for (PatchPoint::Term const& term : patch.points[index(phantom)].terms) {
                made.rows.Add(made.patch[index(term.point)], term.weight);
            }
            made.rows.EndRow();
            made.patch[index(phantom)] = static_cast<std::uint32_t>(made.NumLines() - 1);
            made.phantoms = static_cast<std::uint16_t>(made.phantoms | 1u << phantom);
        }
        return;
    }

    // Children, and the values of level 1 that they take.
    Far::ConstIndexArray const childFaces = levels.Level(0).GetFaceChildFaces(ring.tileFace);
    std::vector<std::vector<FaceCorner>> inputs(4);
    for (int i = 0; i < 4; ++i) {
        made.children[index(i)].limitClass = &Find(levels, 1, childFaces[i], inputs[index(i)]);
    }
    std::vector<std::pair<int, int>> wanted;
    std::vector<int> isWanted(index(levels.Regions(1).NumValues()), 0);
    for (auto const& list : inputs) {
        for (FaceCorner const& at : list) {
            int const value = levels.ValueAt(1, at);
            if (!std::exchange(isWanted[index(value)], 1)) {
                wanted.emplace_back(value, tables::VertexAt(levels.Level(1), at));
            }
        }
    }
    tables::NeededRows const needed(levels, tables::ElementKind::Value, 0, 1, wanted);
    tables::NeededLevel const& sources = needed.Level(0);
    tables::NeededLevel const& results = needed.Level(1);
    auto const first = static_cast<std::uint32_t>(made.numInputs);
    for (std::size_t i = 0; i < results.Size(); ++i) {
        for (std::size_t t = results.offsets[i]; t < results.offsets[i + 1]; ++t) {
            int const term = results.terms[t];
            made.rows.Add(term >= 0 ? static_cast<std::uint32_t>(sources.elements[index(term)])
                                    : first + static_cast<std::uint32_t>(~term),
                          results.weights[t]);
        }
        made.rows.EndRow();
    }
    for (int i = 0; i < 4; ++i) {
        for (FaceCorner const& at : inputs[index(i)]) {
            made.children[index(i)].inputs.push_back(
                first + static_cast<std::uint32_t>(needed.IndexOf(1, levels.ValueAt(1, at))));
        }
    }
}

}  // namespace surface
}  // namespace v1
}  // namespace osd_shading
