// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "osd_shading/blendWeights.h"
#include "osd_shading/tables/gridAxis.h"
#include "osd_shading/tables/tileDictionary.h"
#include "osd_shading/tables/tileField.h"

namespace osd_shading {
inline namespace v1 {
namespace tables {

/// b at the values of a tile's neighbourhood, and at which levels below each one's vertex seeds its ring: bit l of
/// `seeds` for level l. Seeding that changes nothing is left out.
struct WeightSources {
    std::vector<double> weights;
    std::vector<std::uint32_t> seeds;
};

/// Whether b can be found tile by tile: for weights on rings, where a vertex alone tells what it will be at every
/// level: no non-manifold vertices, no semi-sharp creases by Chaikin's rule.
bool HasLocalWeights(BlendWeightOptions const& options, Far::TopologyRefiner const& refiner);

/// b and the seeds of every value of level `level`, for a surface that ends at `lastLevel`.
///
/// REQUIRES: HasLocalWeights.
WeightSources FindStartWeights(BlendWeightOptions const& options, RegionLevels& levels, int level, int lastLevel);

/// Finds the limit of b at the points of tiles.
class TileWeights {
public:
    /// All arguments must outlive this object. `fields`: by class.
    TileWeights(BlendWeightOptions const& options, TileDictionary const& dictionary,
                std::vector<TileField> const& fields, bool isCatmark, int lastLevel)
        : _options(options),
          _dictionary(dictionary),
          _fields(fields),
          _isCatmark(isCatmark),
          _lastLevel(lastLevel) {}

    /// Whether b is the same 0 or 1 at all points, that of the sources.
    bool IsConstant(int tileClass, int level, WeightSources const& sources) const;

    /// b at the points that a tile of class `tileClass` writes, in their order, appended to `weights`. `sources`:
    /// at the sources of its normals, values of `level`.
    void Append(int tileClass, int level, WeightSources const& sources, std::vector<double>& weights);

private:
    void appendSplit(int tileClass, int level, WeightSources const& sources, std::vector<double>& weights);
    void appendDense(int tileClass, int level, WeightSources const& sources, std::vector<double>& weights) const;
    void appendSpline(int tileClass, int level, WeightSources const& sources, std::vector<double>& weights);
    WeightSources refine(FieldStage const& stage, int level, WeightSources const& sources) const;

    BlendWeightOptions const& _options;
    TileDictionary const& _dictionary;
    std::vector<TileField> const& _fields;
    bool _isCatmark;
    int _lastLevel;
    AxisRules _axes;
    std::unordered_map<std::string, std::vector<double>> _known;  // of leaves
};

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
