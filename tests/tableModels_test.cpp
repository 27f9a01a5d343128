// SPDX-License-Identifier: Apache-2.0

// Shading tables on models as they come: every frame beside the one-shot path in double.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "osd_shading/io/objReader.h"
#include "tests/ioFiles.h"
#include "tests/sampleSize.h"
#include "tests/tableAgreement.h"

namespace osd_shading::tests {
namespace {

struct Case {
    io::Model model;
    std::vector<float> points;
    SubdivisionRules rules;
    int firstLevel = 0;  // 1 where there are faces of another size: they have no limits at level 0

    ControlMesh Mesh() const { return model.Mesh(rules); }
    std::string Name() const { return model.name + (rules.scheme == Sdc::SCHEME_LOOP ? ", loop" : ", catmark"); }
};

/// Says which model is left out, and in what words the library refused it.
void SayRefused(std::string const& file, Error const& error) {
    std::printf("left out: %s: %s\n", std::filesystem::path(file).filename().string().c_str(), error.what());
}

/// A model in each scheme that takes it; none where the library refuses it (a face that names a vertex twice).
std::vector<Case> CasesOf(std::string const& file) {
    std::vector<Case> cases;
    io::Model model;
    try {
        model = io::ReadObj(file);
    } catch (Error const& error) {
        SayRefused(file, error);
        return cases;
    }
    for (Sdc::SchemeType const scheme : {Sdc::SCHEME_CATMARK, Sdc::SCHEME_LOOP}) {
        SubdivisionRules rules;
        rules.scheme = scheme;
        rules = model.Rules(rules);
        int const regular = scheme == Sdc::SCHEME_LOOP ? 3 : 4;
        bool const isRegular =
            std::all_of(model.faceSizes.begin(), model.faceSizes.end(), [&](int size) { return size == regular; });
        if (scheme == Sdc::SCHEME_LOOP && !isRegular) continue;
        try {
            ValidateControlMesh(model.Mesh(rules));
        } catch (InvalidControlMesh const& error) {
            SayRefused(file, error);
            continue;
        }
        cases.push_back({model, {model.positions.begin(), model.positions.end()}, rules, isRegular ? 0 : 1});
    }
    return cases;
}

/// Rounding of float coordinates, some units in the last place, of the model's size; and of normals.
constexpr double kPositions = 2e-7, kNormals = 1e-5;

/// The bounds above are those of sums of some twenty products. A pole's are longer, and their rounding grows with
/// the root of that: at valence 360 a thin tile's normal is 5e-5 off.
double RoundingAtPoles(io::Model const& model) {
    std::vector<int> valences(model.positions.size() / 3, 0);
    for (int const v : model.faceVertices) ++valences[static_cast<std::size_t>(v)];
    constexpr double kOrdinary = 8;
    return std::sqrt(std::max(1.0, *std::max_element(valences.begin(), valences.end()) / kOrdinary));
}

/// The figures of one comparison, which a full run prints.
void ExpectAgreement(Case const& c, ShadingOptions const& options, std::string const& what) {
    ShadingTable const table(c.Mesh(), options);
    TableFrame const frame = EvaluateAll(table, {c.points.data(), c.points.size() / 3});
    Reference const reference = ReferenceOf(c.Mesh(), c.points, options);
    Agreement const agreement = Compare(frame, table.ResultValues(), reference);
    std::string const name = c.Name() + ", level " + std::to_string(options.level) + ", " + what;
    EXPECT_TRUE(agreement.isNumbered) << name;
    double const rounding = RoundingAtPoles(c.model);
    EXPECT_LE(agreement.position, rounding * kPositions) << name;
    EXPECT_LE(agreement.normal, rounding * kNormals) << name << ": " << agreement.worst;
    EXPECT_EQ(agreement.supportDiffers, 0) << name;
    EXPECT_LE(agreement.weight, 1e-6) << name;
    if (IsFullRun()) {
        std::printf("%s: positions %.2g, normals %.2g (%s), %lld fallbacks of %d\n", name.c_str(),
                    agreement.position, agreement.normal, agreement.worst.c_str(),
                    static_cast<long long>(frame.report.fallbackNormals), table.NumValues());
    }
}

void ExpectAgreementOnAllLevels(std::vector<Case> const& cases) {
    for (Case const& c : cases) {
        for (int level = c.firstLevel; level <= LastLevelOf(c.model.faceVertices.size(), 5); ++level) {
            ExpectAgreement(c, PaperPreset(level), "paper");
            if (level == 3) ExpectAgreement(c, SmoothPreset(level), "smooth");
        }
    }
}

TEST(TableModels, OursAgreeWithTheOneShotPath) {
    for (std::string const& file : ioFiles::OwnModels()) {
        std::vector<Case> const cases = CasesOf(file);
        EXPECT_FALSE(cases.empty()) << file;
        ExpectAgreementOnAllLevels(cases);
    }
}

TEST(TableModels, SharedOnesAgreeWithTheOneShotPath) {
    std::vector<std::string> const files = ioFiles::SharedModels();
    if (files.empty()) GTEST_SKIP() << ioFiles::kNoSharedModels;
    for (std::string const& file : files) ExpectAgreementOnAllLevels(CasesOf(file));
}

}  // namespace
}  // namespace osd_shading::tests
