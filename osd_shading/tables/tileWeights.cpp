// SPDX-License-Identifier: Apache-2.0
#include "osd_shading/tables/tileWeights.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "osd_shading/extraordinaryVertices.h"

namespace osd_shading {
inline namespace v1 {
namespace tables {

namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// Weights at which rounding alone is what is left of 1.
double settled(double b) {
    constexpr double kRounding = 1e-12;
    return b > 1 - kRounding ? 1 : b;
}

/// What the vertices of one level will be at later ones, where only the sharpness of their own edges tells: which
/// of their regions are eligible.
class LaterSeeds {
public:
    LaterSeeds(BlendWeightOptions const& options, RegionLevels& levels, int level, int lastLevel)
        : _options(options),
          _levels(levels),
          _levelIndex(level),
          _lastLevel(lastLevel),
          _level(levels.Level(level)),
          _regions(levels.Regions(level)) {}

    /// By value: bit l for each level l from `levelIndex` on at which it is eligible.
    std::vector<std::uint32_t> Find() {
        std::vector<std::uint32_t> seeds(index(_regions.NumValues()), 0);
        for (int v = 0; v < _regions.NumVertices(); ++v) {
            if (_regions.NumVertexValues(v) == 0) continue;
            bool const isPerRegion = _options.sharpVertices == SharpVertexWeight::PerRegion;
            // Most vertices are regular and smooth for ever.
            bool const isPlain = _regions.Kind(v) == VertexKind::Smooth;
            if (isPlain && !IsExtraordinary(_levels.Topology(), _level, v)) continue;
            for (int l = _levelIndex; l <= _lastLevel; ++l) {
                if (isPerRegion) {
                    addRegions(v, l, seeds);
                } else {
                    addVertex(v, l, seeds);
                }
            }
        }
        return seeds;
    }

private:
    bool isSharpAt(float sharpness, int level) const {
        return sharpness >= Sdc::Crease::SHARPNESS_INFINITE || sharpness > static_cast<float>(level - _levelIndex);
    }

    VertexKind kindAt(int v, int level) const {
        int numSharp = 0;
        for (int const edge : _level.GetVertexEdges(v)) numSharp += isSharpAt(_level.GetEdgeSharpness(edge), level);
        if (isSharpAt(_level.GetVertexSharpness(v), level) || numSharp > 2) return VertexKind::Corner;
        return numSharp == 2 ? VertexKind::Crease : numSharp == 1 ? VertexKind::Dart : VertexKind::Smooth;
    }

    bool isExtraordinary(int v, VertexKind kind) const {
        int const numFaces = _level.GetVertexFaces(v).size();
        bool const isBoundary = _level.IsVertexBoundary(v), isCatmark = _levels.Topology().IsCatmark();
        if (isBoundary && numFaces == 1 && kind == VertexKind::Corner) return false;
        int const regular = isCatmark ? (isBoundary ? 3 : 4) : (isBoundary ? 4 : 6);
        return _level.GetVertexEdges(v).size() != regular;
    }

    void addVertex(int v, int level, std::vector<std::uint32_t>& seeds) const {
        VertexKind const kind = kindAt(v, level);
        if (_options.sharpVertices == SharpVertexWeight::Zero && CountsAsSharp(_options, kind)) return;
        if (!isExtraordinary(v, kind)) return;
        for (int value = _regions.FirstValue(v); value < _regions.FirstValue(v + 1); ++value) {
            seeds[index(value)] |= 1u << level;
        }
    }

    void addRegions(int v, int level, std::vector<std::uint32_t>& seeds) {
        VertexKind const kind = kindAt(v, level), lastKind = kindAt(v, _lastLevel);
        Far::ConstIndexArray const faces = _level.GetVertexFaces(v), edges = _level.GetVertexEdges(v);
        Far::ConstLocalIndexArray const corners = _level.GetVertexFaceLocalIndices(v);
        int const numFaces = faces.size();
        auto const mark = [&](int face) {
            seeds[index(_regions.CornerValue(faces[face], corners[face]))] |= 1u << level;
        };
        if (kind <= VertexKind::Dart) {
            bool isEligible = isExtraordinary(v, kind);
            if (kind == VertexKind::Dart) {
                isEligible =
                    _options.darts == DartWeight::LikeSmooth && (isEligible || lastKind == VertexKind::Dart);
            }
            for (int i = 0; i < numFaces && isEligible; ++i) mark(i);
            return;
        }
        if (lastKind < VertexKind::Crease) return;

        // The runs of faces between edges that are sharp then: face i lies between edges i and i + 1.
        bool const isRing = edges.size() == numFaces;
        auto const isSharp = [&](int edge) { return isSharpAt(_level.GetEdgeSharpness(edges[edge]), level); };
        int start = 0;
        while (isRing && start < numFaces && !isSharp(start)) ++start;
        bool const isWhole = isRing && start == numFaces;  // sharp by itself alone
        for (int i = 0; i < numFaces;) {
            int count = 1;
            while (i + count < numFaces && (isWhole || !isSharp((start + i + count) % edges.size()))) ++count;
            bool const isRegular =
                kind == VertexKind::Corner
                    ? count == 1
                    : IsRegularCreaseRegion(_levels.Topology().IsCatmark(), static_cast<std::size_t>(count));
            for (int j = i; j < i + count && !isRegular; ++j) mark((start + j) % numFaces);
            i += count;
        }
    }

    BlendWeightOptions const& _options;
    RegionLevels& _levels;
    int _levelIndex, _lastLevel;
    Far::TopologyLevel const& _level;
    CreaseRegions const& _regions;
};

}  // namespace

bool HasLocalWeights(BlendWeightOptions const& options, Far::TopologyRefiner const& refiner) {
    if (options.scheme != WeightScheme::OneRing) return false;
    Far::TopologyLevel const base = refiner.GetLevel(0);
    bool const isUniform = refiner.GetSchemeOptions().GetCreasingMethod() == Sdc::Options::CREASE_UNIFORM;
    for (int e = 0; e < base.GetNumEdges() && !isUniform; ++e) {
        float const sharpness = base.GetEdgeSharpness(e);
        if (sharpness > 0 && sharpness < Sdc::Crease::SHARPNESS_INFINITE) return false;
    }
    for (int v = 0; v < base.GetNumVertices(); ++v) {
        if (base.IsVertexNonManifold(v)) return false;
    }
    return true;
}

WeightSources FindStartWeights(BlendWeightOptions const& options, RegionLevels& levels, int level, int lastLevel) {
    WeightSources start;
    auto const numValues = [&](int l) { return index(levels.Regions(l).NumValues()); };
    auto const eligibleAt = [&](int l, std::vector<std::uint32_t> const& seeds) {
        ValueMarks eligible(seeds.size());
        for (std::size_t i = 0; i < seeds.size(); ++i) eligible[i] = (seeds[i] >> l) & 1u;
        return eligible;
    };
    start.weights.assign(numValues(std::min(options.level, level)), 0.0);
    for (int l = std::min(options.level, level); l <= level; ++l) {
        if (l > options.level) {
            std::vector<double> refined(numValues(l));
            levels.Step(l).Apply(start.weights, refined, {}, 1);
            start.weights.swap(refined);
        }
        start.seeds = LaterSeeds(options, levels, l, lastLevel).Find();
        if (l < options.level) continue;
        SeedRings(options, levels.Level(l), levels.Regions(l), eligibleAt(l, start.seeds), start.weights);
    }

    // A ring that is 1 all over stays so: to seed it again changes nothing.
    std::uint32_t const later = ~((2u << level) - 1) & ~((1u << std::max(options.level, 0)) - 1);
    Far::TopologyLevel const& here = levels.Level(level);
    CreaseRegions const& regions = levels.Regions(level);
    for (int v = 0; v < regions.NumVertices(); ++v) {
        std::uint32_t seeds = 0;
        for (int value = regions.FirstValue(v); value < regions.FirstValue(v + 1); ++value) {
            start.seeds[index(value)] &= later;
            seeds |= start.seeds[index(value)];
        }
        if (seeds == 0 || options.level > level) continue;
        bool isFull = true;
        for (int const face : here.GetVertexFaces(v)) {
            int const* const values = regions.FaceValues(face);
            for (int i = 0; i < here.GetFaceVertices(face).size(); ++i) {
                isFull &= start.weights[index(values[i])] == 1;
            }
        }
        for (int value = regions.FirstValue(v); value < regions.FirstValue(v + 1) && isFull; ++value) {
            start.seeds[index(value)] = 0;
        }
    }
    return start;
}

bool TileWeights::IsConstant(int tileClass, int level, WeightSources const& sources) const {
    double const b = sources.weights[0];
    if (b != 0 && b != 1) return false;
    for (double const other : sources.weights) {
        if (other != b) return false;
    }
    if (b == 1) return true;
    // At level 0 the middles of faces that are no quads may yet seed theirs.
    if (level == 0 && _isCatmark && _dictionary.classes[index(tileClass)].kind != TileKind::Spline) return false;
    return std::all_of(sources.seeds.begin(), sources.seeds.end(), [](std::uint32_t s) { return s == 0; });
}

void TileWeights::Append(int tileClass, int level, WeightSources const& sources, std::vector<double>& weights) {
    TileClass const& c = _dictionary.classes[index(tileClass)];
    if (c.numPoints == 0) return;
    if (IsConstant(tileClass, level, sources)) {
        weights.insert(weights.end(), index(c.numPoints), sources.weights[0]);
        return;
    }
    if (c.kind == TileKind::Split) {
        appendSplit(tileClass, level, sources, weights);
        return;
    }

    // Many leaves are alike.
    std::string key(reinterpret_cast<char const*>(&tileClass), sizeof tileClass);
    key.append(reinterpret_cast<char const*>(&level), sizeof level);
    key.append(reinterpret_cast<char const*>(sources.weights.data()), sources.weights.size() * sizeof(double));
    if (std::any_of(sources.seeds.begin(), sources.seeds.end(), [](std::uint32_t s) { return s != 0; })) {
        key.append(reinterpret_cast<char const*>(sources.seeds.data()),
                   sources.seeds.size() * sizeof(std::uint32_t));
    }
    auto const [known, isNew] = _known.emplace(std::move(key), std::vector<double>());
    if (isNew) {
        if (c.kind == TileKind::Dense) {
            appendDense(tileClass, level, sources, known->second);
        } else {
            appendSpline(tileClass, level, sources, known->second);
        }
    }
    weights.insert(weights.end(), known->second.begin(), known->second.end());
}

WeightSources TileWeights::refine(FieldStage const& stage, int level, WeightSources const& sources) const {
    bool const skipsSharp = _options.sharpVertices == SharpVertexWeight::Zero, isSeeding = level >= _options.level;
    bool const isPerRegion = _options.sharpVertices == SharpVertexWeight::PerRegion;
    WeightSources refined;
    refined.weights.resize(stage.Size());
    refined.seeds.resize(stage.Size());
    for (std::size_t i = 0; i < stage.Size(); ++i) {
        double sum = 0;
        for (std::size_t t = stage.offsets[i]; t < stage.offsets[i + 1]; ++t) {
            int const term = stage.terms[t];
            sum += stage.weights[t] * (term >= 0 ? sources.weights[index(term)] : refined.weights[index(~term)]);
        }
        refined.weights[i] = sum;
    }
    // Seeds come after all rows: those of this level name refined values as they are before.
    for (std::size_t i = 0; i < stage.Size(); ++i) {
        int const origin = stage.origins[i];
        constexpr std::uint32_t kAllLevels = ~0u;
        refined.seeds[i] = origin >= 0                         ? sources.seeds[index(origin)]
                           : origin == FieldStage::kNgonCenter ? kAllLevels
                                                               : 0;
        if (!isSeeding || (skipsSharp && CountsAsSharp(_options, stage.kinds[i]))) continue;
        bool isSeeded = (isPerRegion ? stage.isNearNgon[i] : stage.isVertexNearNgon[i]) != 0;
        for (std::size_t s = stage.seedOffsets[i]; s < stage.seedOffsets[i + 1]; ++s) {
            isSeeded |= ((sources.seeds[index(stage.seeds[s])] >> level) & 1u) != 0;
        }
        if (isSeeded) refined.weights[i] = 1;
    }
    return refined;
}

void TileWeights::appendSplit(int tileClass, int level, WeightSources const& sources,
                              std::vector<double>& weights) {
    TileClass const& c = _dictionary.classes[index(tileClass)];
    TileField const& field = _fields[index(tileClass)];
    WeightSources refined;
    if (!field.stages.empty()) refined = refine(field.stages[0], ++level, sources);
    WeightSources const& from = field.stages.empty() ? sources : refined;
    WeightSources own;
    for (std::size_t i = 0; i < c.children.size(); ++i) {
        own.weights.clear();
        own.seeds.clear();
        for (int const source : field.children[i]) {
            own.weights.push_back(from.weights[index(source)]);
            own.seeds.push_back(from.seeds[index(source)]);
        }
        Append(c.children[i].tileClass, level, own, weights);
    }
}

void TileWeights::appendDense(int tileClass, int level, WeightSources const& sources,
                              std::vector<double>& weights) const {
    TileField const& field = _fields[index(tileClass)];
    WeightSources refined = sources;
    for (FieldStage const& stage : field.stages) refined = refine(stage, ++level, refined);
    assert(level == _lastLevel);
    for (std::size_t i = 0; i < field.limits.Size(); ++i) {
        double sum = 0;
        for (std::size_t t = field.limits.offsets[i]; t < field.limits.offsets[i + 1]; ++t) {
            sum += field.limits.weights[t] * refined.weights[index(field.limits.sources[t])];
        }
        weights.push_back(settled(sum));
    }
}

void TileWeights::appendSpline(int tileClass, int level, WeightSources const& sources,
                               std::vector<double>& weights) {
    TileClass const& c = _dictionary.classes[index(tileClass)];
    unsigned const sides = _fields[index(tileClass)].sharpSides;
    auto const isSharp = [&](unsigned side) { return (sides & (1u << side)) != 0; };
    int const numCells = 1 << c.numNormalLevels;
    GridAxis u{numCells, isSharp(3), isSharp(1)}, v{numCells, isSharp(0), isSharp(2)};
    assert(index(u.Size() * v.Size()) == sources.weights.size());

    // Level by level as long as something seeds.
    WeightSources grid = sources;
    bool const skipsSharp = _options.sharpVertices == SharpVertexWeight::Zero;
    while (level < _lastLevel) {
        std::uint32_t later = 0;
        for (std::uint32_t const seeds : grid.seeds) later |= seeds;
        if ((later >> (level + 1)) == 0) break;
        ++level;
        GridAxis const nextU = u.Refined(), nextV = v.Refined();
        WeightSources next;
        next.weights = ApplyAxes(grid.weights, u.Size(), _axes.Refinement(u), _axes.Refinement(v));
        next.seeds.assign(next.weights.size(), 0);
        for (int row = nextV.First(); row <= nextV.Last(); ++row) {
            for (int column = nextU.First(); column <= nextU.Last(); ++column) {
                std::size_t const at = index((row - nextV.First()) * nextU.Size() + column - nextU.First());
                // The old points in whose rings it lies: those of its vertex, edge or face.
                int const firstRow = (row + 2) / 2 - 1, firstColumn = (column + 2) / 2 - 1;
                std::uint32_t seeds = 0;
                for (int r = firstRow; r <= firstRow + (row % 2 != 0); ++r) {
                    for (int s = firstColumn; s <= firstColumn + (column % 2 != 0); ++s) {
                        seeds |= grid.seeds[index((r - v.First()) * u.Size() + s - u.First())];
                    }
                }
                if (row % 2 == 0 && column % 2 == 0) next.seeds[at] = seeds;
                bool const isOnCrease = nextV.IsOnSharpEnd(row) || nextU.IsOnSharpEnd(column);
                if (level >= _options.level && ((seeds >> level) & 1u) != 0 && !(skipsSharp && isOnCrease)) {
                    next.weights[at] = 1;
                }
            }
        }
        grid = std::move(next);
        u = nextU;
        v = nextV;
    }

    int const k = _lastLevel - level;
    std::vector<double> const all = ApplyAxes(grid.weights, u.Size(), _axes.Limits(u, k), _axes.Limits(v, k));
    int const pitch = (1 << c.k) + 1, numWindows = NumWindows(c.k), side = 1 << std::min<int>(c.k, 4);
    for (int window = 0; window < numWindows * numWindows; ++window) {
        RowPlan const& plan = _dictionary.plans[index(c.plans[index(window)])];
        int const row = window / numWindows * side, column = window % numWindows * side;
        for (int s = 0; s < plan.numSegments; ++s) {
            RowSegment const& segment = plan.segments[s];
            double const* from = all.data() + (row + segment.row) * pitch + column + segment.first;
            for (int i = 0; i < segment.count; ++i) weights.push_back(settled(from[i]));
        }
    }
}

}  // namespace tables
}  // namespace v1
}  // namespace osd_shading
