// SPDX-License-Identifier: Apache-2.0
#include "goals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdarg>
#include <cstddef>
#include <cstdio>
#include <functional>

namespace perf {

namespace {

using Figure = std::function<double(CaseFigures const&)>;
using Choice = std::function<bool(CaseFigures const&)>;

[[gnu::format(printf, 1, 2)]] std::string text(char const* format, ...) {
    std::array<char, 256> buffer{};
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(buffer.data(), buffer.size(), format, arguments);
    va_end(arguments);
    return buffer.data();
}

/// Several figures of one kind.
class Sample {
public:
    void Add(double value) { _values.push_back(value); }
    bool IsEmpty() const { return _values.empty(); }
    double Least() const { return *std::min_element(_values.begin(), _values.end()); }
    double Most() const { return *std::max_element(_values.begin(), _values.end()); }
    double GeometricMean() const {
        double sum = 0;
        for (double const value : _values) sum += std::log(value);
        return std::exp(sum / static_cast<double>(_values.size()));
    }

private:
    std::vector<double> _values;
};

bool isPart(CaseFigures const& figures) { return figures.mesh == "fandisk" || figures.mesh == "rockerarm"; }
/// Spot, or what stands in for it.
bool isCharacter(CaseFigures const& figures) { return !figures.isLoop && !isPart(figures); }

/// Fills the rows in the order of the goals' table.
class Comparison {
public:
    explicit Comparison(Measurements const& measured) : _measured(measured) {}

    std::vector<GoalRow> Rows() {
        compareFrames();
        compareInstructions();
        compareMemory();
        compareBuilds();
        compareShadingCost();
        compareScaling();
        compareAccuracy();
        compareSmallLevels();
        compareThreads();
        return std::move(_rows);
    }

private:
    Sample sample(Choice const& isChosen, Figure const& figure) const {
        Sample values;
        for (CaseFigures const& figures : _measured.cases) {
            if (isChosen(figures) && figure(figures) > 0) values.Add(figure(figures));
        }
        return values;
    }
    void add(std::string const& what, std::string const& goal, std::string const& have, bool isMet) {
        _rows.push_back({what, goal, have, isMet ? Verdict::Met : Verdict::Missed});
    }
    void addMissing(std::string const& what, std::string const& goal) {
        _rows.push_back({what, goal, "", Verdict::NotMeasured});
    }
    /// A goal for the geometric mean of how many times faster than OpenSubdiv, and one for the least.
    void addSpeed(std::string const& what, Choice const& isChosen, Figure const& seconds, double meanGoal,
                  double leastGoal) {
        auto const ratio = [&](double (CaseFigures::*yardstick)() const) {
            return sample(isChosen, [&seconds, yardstick](CaseFigures const& figures) {
                return seconds(figures) > 0 ? (figures.*yardstick)() / seconds(figures) : 0;
            });
        };
        std::string goal = text("%g times faster", meanGoal);
        if (leastGoal > 0) goal += text(", none below %g", leastGoal);
        Sample const alone = ratio(&CaseFigures::OpenSubdiv);
        if (alone.IsEmpty()) return addMissing(what, goal);
        Sample const normals = ratio(&CaseFigures::OpenSubdivWithNormals);
        add(what, goal,
            text("%.1f; %.1f to %.1f (against its normals too: %.1f; %.1f to %.1f)", alone.GeometricMean(),
                 alone.Least(), alone.Most(), normals.GeometricMean(), normals.Least(), normals.Most()),
            alone.GeometricMean() >= meanGoal && alone.Least() >= leastGoal);
    }

    void compareFrames() {
        auto const isFine = [](CaseFigures const& figures) { return !figures.isLoop && figures.level >= 4; };
        addSpeed(
            "shaded frame, levels 4 to 6", isFine, [](CaseFigures const& f) { return f.shaded; }, 30, 15);
        auto const isForSets = [](CaseFigures const& f) {
            return (f.mesh == "rockerarm" || isCharacter(f)) && (f.level == 4 || f.level == 5);
        };
        addSpeed(
            "AVX2 alone, Spot and rocker arm, levels 4, 5", isForSets,
            [](CaseFigures const& f) { return f.shadedAvx2; }, 18, 11);
        addSpeed(
            "SSE2 alone, likewise", isForSets, [](CaseFigures const& f) { return f.shadedSse2; }, 9, 0);
        addSpeed(
            "Loop, levels 4 to 6", [](CaseFigures const& f) { return f.isLoop; },
            [](CaseFigures const& f) { return f.shaded; }, 15, 0);
        Sample const smooth = sample([](CaseFigures const& f) { return f.level >= 4; },
                                     [](CaseFigures const& f) { return f.smooth / f.limitNormals; });
        if (smooth.IsEmpty()) return addMissing("variant D against P + N_L", "0.9 at most");
        add("variant D against P + N_L", "0.9 at most",
            text("%.2f; %.2f to %.2f", smooth.GeometricMean(), smooth.Least(), smooth.Most()),
            smooth.Most() <= 0.9);
    }

    double instructions(std::string const& what) const {
        auto const found = _measured.instructions.find(what);
        return found == _measured.instructions.end() ? 0 : found->second;
    }

    void compareInstructions() {
        for (auto const& [mesh, goal] : {std::pair("fandisk", 48), std::pair("spot", 80)}) {
            std::string const what = std::string("instructions per value, AVX2, level 4: ") + mesh;
            double const have = instructions(std::string(mesh) + " shaded");
            double const openSubdiv = instructions(std::string(mesh) + " openSubdiv");
            if (have == 0) {
                addMissing(what, text("%d at most", goal));
            } else {
                add(what, text("%d at most", goal), text("%.1f (OpenSubdiv %.0f)", have, openSubdiv), have <= goal);
            }
        }
    }

    void compareMemory() {
        auto const isLarge = [](CaseFigures const& f) { return f.table.values > 3'000'000; };
        Sample const one = sample(isLarge, [](CaseFigures const& f) { return f.shaded / f.memsetOutput; });
        if (one.IsEmpty()) {
            addMissing("against a memset, 4 million, 1 thread", "2.0 times at most");
            addMissing("against a memset, 4 million, 2 threads", "1.4 times at most");
        } else {
            add("against a memset, 4 million, 1 thread", "2.0 times at most",
                text("%.2f to %.2f", one.Least(), one.Most()), one.Most() <= 2);
            Sample const two =
                sample(isLarge, [](CaseFigures const& f) { return f.wallTwoThreads / f.memsetTwoThreads; });
            Sample const twoByOne =
                sample(isLarge, [](CaseFigures const& f) { return f.wallTwoThreads / f.memsetOneWall; });
            if (two.IsEmpty()) {
                addMissing("against a memset, 4 million, 2 threads", "1.4 times at most");
            } else {
                add("against a memset, 4 million, 2 threads", "1.4 times at most",
                    text("%.2f to %.2f (against a memset by one thread: %.2f to %.2f)", two.Least(), two.Most(),
                         twoByOne.Least(), twoByOne.Most()),
                    two.Most() <= 1.4);
            }
        }

        constexpr std::array<std::pair<int, int>, 3> kBytesGoals = {{{4, 7}, {5, 3}, {6, 2}}};
        for (auto const& [level, goal] : kBytesGoals) {
            addBytes(text("table bytes per value, level %d, parts", level), goal,
                     sample([level = level](CaseFigures const& f) { return isPart(f) && f.level == level; },
                            &CaseFigures::BytesPerValue));
        }
        addBytes("table bytes per value, level 4, Spot", 13,
                 sample([](CaseFigures const& f) { return isCharacter(f) && f.level == 4; },
                        &CaseFigures::BytesPerValue));
        Sample random;
        for (auto const& stats : _measured.randomSharpness) {
            random.Add(static_cast<double>(stats.bytes) / static_cast<double>(stats.values));
        }
        addBytes("table bytes per value, random sharpness", 60, random);
    }
    void addBytes(std::string const& what, int goal, Sample const& bytes) {
        if (bytes.IsEmpty()) return addMissing(what, text("%d at most", goal));
        add(what, text("%d at most", goal), text("%.2f to %.2f", bytes.Least(), bytes.Most()),
            bytes.Most() <= goal);
    }

    void compareBuilds() {
        auto const addBuild = [this](std::string const& what, Choice const& isChosen, double goal) {
            Sample const ratio = sample(isChosen, [](CaseFigures const& f) { return f.openSubdivBuild / f.build; });
            if (ratio.IsEmpty()) return addMissing(what, text("%g times faster", goal));
            add(what, text("%g times faster", goal), text("%.1f to %.1f", ratio.Least(), ratio.Most()),
                ratio.Least() >= goal);
        };
        constexpr std::array<std::array<int, 3>, 3> kBuildGoals = {{{4, 20, 20}, {5, 40, 35}, {6, 100, 50}}};
        for (auto const& [level, parts, spot] : kBuildGoals) {
            int const chosen = level;
            addBuild(
                text("build, level %d, parts", level),
                [chosen](CaseFigures const& f) { return isPart(f) && f.level == chosen; }, parts);
            addBuild(
                text("build, level %d, Spot", level),
                [chosen](CaseFigures const& f) { return isCharacter(f) && f.level == chosen; }, spot);
        }
    }

    void compareShadingCost() {
        char const* const what = "cost of shading over P + N_L, over the support's share";
        Sample cost;
        for (CaseFigures const& figures : _measured.cases) {
            double const shaded = instructions(figures.mesh + " shaded");
            double const limit = instructions(figures.mesh + " limit");
            if (figures.isLoop || figures.level != 4 || shaded == 0 || limit == 0) continue;
            cost.Add((shaded / limit - 1) / figures.SupportShare());
        }
        if (cost.IsEmpty()) {
            addMissing(what, "0.6 at most");
        } else {
            add(what, "0.6 at most", text("%.2f to %.2f", cost.Least(), cost.Most()), cost.Most() <= 0.6);
        }
        auto const addTwice = [this](char const* name, double least, double most, double goal) {
            Sample const ratio = sample(
                [=](CaseFigures const& f) {
                    auto const vertices = static_cast<double>(f.openSubdivVertices);
                    return !f.isLoop && vertices >= least && vertices < most;
                },
                [](CaseFigures const& f) { return f.OpenSubdivTwice() / f.shaded; });
            if (ratio.IsEmpty()) return addMissing(name, text("%g times faster", goal));
            add(name, text("%g times faster", goal), text("%.1f to %.1f", ratio.Least(), ratio.Most()),
                ratio.Least() >= goal);
        };
        addTwice("against OSD's tables used twice, 200k vertices", 180e3, 300e3, 20);
        addTwice("against OSD's tables used twice, a million", 800e3, 1.5e6, 50);
    }

    void compareScaling() {
        auto const& series = _measured.scalingByLevel;
        if (series.size() < 2) {
            addMissing("43 million values: ns per value", "no more than at 2.7 million");
            addMissing("43 million values: bytes besides the outputs", "5 at most");
            return;
        }
        ScalingFigures const &small = series.front(), &large = series.back();
        double const smallNs = 1e9 * small.shaded / small.values, largeNs = 1e9 * large.shaded / large.values;
        add("43 million values: ns per value", "no more than at 2.7 million",
            text("%.2f at %.1f million, %.2f at %.1f", largeNs, large.values / 1e6, smallNs, small.values / 1e6),
            largeNs <= smallNs);
        add("43 million values: bytes besides the outputs", "5 at most",
            text("%.2f (table %.2f)", large.otherBytes, large.tableBytes), large.otherBytes <= 5);
    }

    void compareAccuracy() {
        if (_measured.accuracy.empty()) {
            addMissing("accuracy: P over the bounding box", "2e-7 at most");
            addMissing("accuracy: normals times m", "1e-5 at most");
            return;
        }
        Accuracy worst;
        for (auto const& [mesh, accuracy] : _measured.accuracy) {
            worst.positions = std::max(worst.positions, accuracy.positions);
            worst.blendedNormals = std::max(worst.blendedNormals, accuracy.blendedNormals);
            worst.limitNormals = std::max(worst.limitNormals, accuracy.limitNormals);
        }
        add("accuracy: P over the bounding box", "2e-7 at most", text("%.2g", worst.positions),
            worst.positions <= 2e-7);
        add("accuracy: normals times m", "1e-5 at most",
            text("N_B %.2g, N_L %.2g", worst.blendedNormals, worst.limitNormals),
            worst.blendedNormals <= 1e-5 && worst.limitNormals <= 1e-5);
    }

    void compareSmallLevels() {
        addSpeed(
            "levels 2 and 3", [](CaseFigures const& f) { return f.level == 2 || f.level == 3; },
            [](CaseFigures const& f) { return f.shaded; }, 10, 10);
    }

    void compareThreads() {
        auto const speedUp = [](CaseFigures const& f) {
            return f.wallTwoThreads > 0 ? f.wallOneThread / f.wallTwoThreads : 0;
        };
        Sample const large = sample([](CaseFigures const& f) { return f.table.values >= 200'000; }, speedUp);
        Sample const all = sample([](CaseFigures const&) { return true; }, speedUp);
        if (large.IsEmpty()) {
            addMissing("two threads, 200k values and more", "1.75 times");
        } else {
            add("two threads, 200k values and more", "1.75 times",
                text("%.2f; %.2f to %.2f", large.GeometricMean(), large.Least(), large.Most()),
                large.Least() >= 1.75);
        }
        // What two runs of the same frames differ by.
        constexpr double kNoise = 0.03;
        if (all.IsEmpty()) return addMissing("two threads, never slower than one", "1 (less noise: 0.97)");
        add("two threads, never slower than one", "1 (less noise: 0.97)", text("%.2f at least", all.Least()),
            all.Least() >= 1 - kNoise);
    }

    Measurements const& _measured;
    std::vector<GoalRow> _rows;
};

}  // namespace

std::vector<GoalRow> CompareWithGoals(Measurements const& measured) { return Comparison(measured).Rows(); }

}  // namespace perf
