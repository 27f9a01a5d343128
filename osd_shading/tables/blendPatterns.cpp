// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/tables/blendPatterns.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace osd_shading {
inline namespace v1 {
namespace tables {

namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

}  // namespace

int PatternBuilder::Add(std::vector<int> const& leafSizes, std::vector<double> const& weights) {
    bool const isZero = std::all_of(weights.begin(), weights.end(), [](double b) { return b == 0; });
    if (isZero) return kZeroEverywhere;
    if (std::all_of(weights.begin(), weights.end(), [](double b) { return b == 1; })) return kOneEverywhere;
    std::vector<LeafBlend> leaves;
    std::vector<float> mixed;
    std::size_t first = 0;
    for (int const size : leafSizes) {
        auto const begin = weights.begin() + static_cast<std::ptrdiff_t>(first), end = begin + size;
        first += index(size);
        if (std::all_of(begin, end, [](double b) { return b == 0; })) {
            leaves.push_back(LeafBlend::Zero);
        } else if (std::all_of(begin, end, [](double b) { return b == 1; })) {
            leaves.push_back(LeafBlend::One);
        } else {
            leaves.push_back(LeafBlend::Mixed);
            // What is not 0 stays so.
            for (auto it = begin; it != end; ++it) {
                mixed.push_back(*it > 0 ? std::max(static_cast<float>(*it), std::numeric_limits<float>::min())
                                        : 0.0f);
            }
        }
    }

    std::string key(reinterpret_cast<char const*>(leaves.data()), leaves.size());
    key.append(reinterpret_cast<char const*>(mixed.data()), mixed.size() * sizeof(float));
    auto const [known, isNew] = _patternOfKey.emplace(std::move(key), static_cast<int>(_data.patterns.size()));
    if (isNew) {
        _data.patterns.push_back({_data.leafBlends.size(), _data.blendPowers.size()});
        _data.leafBlends.insert(_data.leafBlends.end(), leaves.begin(), leaves.end());
        for (float const b : mixed) {
            // A power too small for float stays above 0 as well: N_S is there wherever b is.
            double const least = b > 0 ? double{std::numeric_limits<float>::min()} : 0;
            double const power = _exponent == 1 ? double{b} : std::max(std::pow(double{b}, _exponent), least);
            _data.blendPowers.push_back(static_cast<float>(power));
        }
        if (_exponent != 1) _data.blendWeights.insert(_data.blendWeights.end(), mixed.begin(), mixed.end());
    }
    return known->second;
}

int LocalPatterns::Find(CompiledTile const& tile, std::int64_t& numBlended) {
    WeightSources sources;
    for (FaceCorner const& at : tile.normals) {
        std::size_t const value = index(_levels.ValueAt(_level, at));
        sources.weights.push_back(_start.weights[value]);
        sources.seeds.push_back(_start.seeds[value]);
    }
    int const numPoints = _data.dictionary.classes[index(tile.tileClass)].numPoints;
    if (numPoints == 0) return kZeroEverywhere;
    if (_tileWeights.IsConstant(tile.tileClass, _level, sources)) {
        bool const isOne = sources.weights[0] == 1;
        numBlended += isOne ? numPoints : 0;
        return isOne ? kOneEverywhere : kZeroEverywhere;
    }
    std::string key(reinterpret_cast<char const*>(&tile.tileClass), sizeof tile.tileClass);
    key.append(reinterpret_cast<char const*>(sources.weights.data()), sources.weights.size() * sizeof(double));
    key.append(reinterpret_cast<char const*>(sources.seeds.data()), sources.seeds.size() * sizeof(std::uint32_t));
    auto const [known, isNew] = _known.emplace(std::move(key), Found{});
    if (isNew) {
        std::vector<double> weights;
        std::vector<int> leafSizes;
        _tileWeights.Append(tile.tileClass, _level, sources, weights);
        AppendLeafSizes(_data.dictionary, tile.tileClass, leafSizes);
        known->second.pattern = _patterns.Add(leafSizes, weights);
        known->second.numBlended = std::count_if(weights.begin(), weights.end(), [](double b) { return b > 0; });
    }
    numBlended += known->second.numBlended;
    return known->second.pattern;
}

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
