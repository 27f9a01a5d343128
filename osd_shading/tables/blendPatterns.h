// SPDX-License-Identifier: Apache-2.0
#pragma once

// Internal: not installed, not for users.

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "osd_shading/tables/tableData.h"
#include "osd_shading/tables/tileCompiler.h"
#include "osd_shading/tables/tileWeights.h"

namespace osd_shading {
inline namespace v1 {
namespace tables {

/// Patterns of b: equal ones are kept once.
class PatternBuilder {
public:
    /// Adds to `data`, which must outlive this object.
    PatternBuilder(TableData& data, double exponent) : _data(data), _exponent(exponent) {}

    /// `leafSizes`: points of each leaf, in order; `weights`: of all points.
    int Add(std::vector<int> const& leafSizes, std::vector<double> const& weights);

private:
    TableData& _data;
    double _exponent;
    std::unordered_map<std::string, int> _patternOfKey;
};

/// The patterns of tiles whose b is found from that of the start level round them.
class LocalPatterns {
public:
    /// REQUIRES: HasLocalWeights. All arguments must outlive this object; `fields`: by class.
    LocalPatterns(RegionLevels& levels, TableData const& data, std::vector<TileField> const& fields,
                  PatternBuilder& patterns)
        : _levels(levels),
          _data(data),
          _patterns(patterns),
          _level(data.options.startNormals.level),
          _start(FindStartWeights(data.options.weights, levels, _level, data.options.level)),
          _tileWeights(data.options.weights, data.dictionary, fields, levels.Topology().IsCatmark(),
                       data.options.level) {}

    /// The pattern of a tile. Adds to `numBlended` the points with b > 0.
    int Find(CompiledTile const& tile, std::int64_t& numBlended);

private:
    struct Found {
        int pattern = kZeroEverywhere;
        std::int64_t numBlended = 0;
    };

    RegionLevels& _levels;
    TableData const& _data;
    PatternBuilder& _patterns;
    int _level;
    WeightSources _start;
    TileWeights _tileWeights;
    std::unordered_map<std::string, Found> _known;
};

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
