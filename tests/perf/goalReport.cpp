// SPDX-License-Identifier: Apache-2.0
#include "goalReport.h"

#include <array>
#include <cstddef>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <utility>

namespace perf {

namespace {

char const* verdictName(Verdict verdict) {
    switch (verdict) {
        case Verdict::Met:
            return "met";
        case Verdict::Missed:
            return "MISSED";
        case Verdict::NotMeasured:
            return "not measured";
    }
    return "";
}

using Fields = std::vector<std::pair<char const*, double>>;

Fields fieldsOf(CaseFigures const& figures) {
    return {{"level", figures.level},
            {"values", static_cast<double>(figures.table.values)},
            {"openSubdivVertices", static_cast<double>(figures.openSubdivVertices)},
            {"openSubdivFusedThree", figures.openSubdivLimits[0]},
            {"openSubdivFusedFour", figures.openSubdivLimits[1]},
            {"openSubdivThreeCalls", figures.openSubdivLimits[2]},
            {"openSubdivWithNormals", figures.OpenSubdivWithNormals()},
            {"openSubdivTwice", figures.OpenSubdivTwice()},
            {"openSubdivBytesPerVertex", figures.openSubdivBytes},
            {"openSubdivBuild", figures.openSubdivBuild},
            {"build", figures.build},
            {"bytesPerValue", figures.BytesPerValue()},
            {"supportShare", figures.SupportShare()},
            {"tiles", static_cast<double>(figures.table.tiles)},
            {"regularTiles", static_cast<double>(figures.table.regularTiles)},
            {"blendedTiles", static_cast<double>(figures.table.blendedTiles)},
            {"classes", static_cast<double>(figures.table.classes)},
            {"shaded", figures.shaded},
            {"shadedAvx2", figures.shadedAvx2},
            {"shadedSse2", figures.shadedSse2},
            {"limitNormals", figures.limitNormals},
            {"smooth", figures.smooth},
            {"memset", figures.memsetOutput},
            {"wallOneThread", figures.wallOneThread},
            {"wallTwoThreads", figures.wallTwoThreads},
            {"wallMemset", figures.memsetOneWall},
            {"wallMemsetTwoThreads", figures.memsetTwoThreads}};
}

Fields fieldsOf(ScalingFigures const& figures) {
    return {{"level", figures.level},
            {"values", figures.values},
            {"openSubdiv", figures.openSubdiv},
            {"limitNormals", figures.limitNormals},
            {"shaded", figures.shaded},
            {"shadedTwoThreads", figures.shadedTwoThreads},
            {"tableBytesPerValue", figures.tableBytes},
            {"otherBytesPerValue", figures.otherBytes}};
}

/// Writes JSON; names and texts are ours and need no escapes.
class JsonFile {
public:
    explicit JsonFile(std::string const& name) : _name(name), _file(name) { _file.precision(6); }

    void Text(std::string const& text) { _file << text; }
    void Members(Fields const& fields) {
        char const* separator = "";
        for (auto const& [name, value] : fields) {
            _file << separator << '"' << name << "\": " << value;
            separator = ", ";
        }
    }
    template <typename Items, typename Write>
    void Array(char const* name, Items const& items, Write const& write) {
        _file << "  \"" << name << "\": [";
        char const* separator = "\n";
        for (auto const& item : items) {
            _file << separator << "    {";
            write(item);
            _file << "}";
            separator = ",\n";
        }
        _file << "\n  ]";
    }
    void Close() {
        _file.close();
        if (!_file) throw std::runtime_error(_name + " can't be written");
    }

private:
    std::string _name;
    std::ofstream _file;
};

}  // namespace

void PrintCases(std::vector<CaseFigures> const& cases) {
    if (cases.empty()) return;
    std::printf("\nOne thread, thread time, nanoseconds per vertex (OpenSubdiv) and per value (ours)\n");
    std::printf("%-22s %9s | %6s %6s %6s %6s %6s %8s | %6s %6s %6s %6s %6s | %6s %6s %8s | %5s %5s\n",
                "mesh, level", "vertices", "OSD 3", "OSD 4", "OSD 3x", "twice", "bytes", "build ms", "shaded",
                "AVX2", "SSE2", "P+N_L", "D", "bytes", "b > 0", "build ms", "x OSD", "x 2 th");
    for (CaseFigures const& figures : cases) {
        double const vertex = 1e9 / static_cast<double>(figures.openSubdivVertices);
        double const value = 1e9 / static_cast<double>(figures.table.values);
        std::printf(
            "%-22s %9zu | %6.1f %6.1f %6.1f %6.1f %6.1f %8.1f | %6.2f %6.2f %6.2f %6.2f %6.2f | "
            "%6.2f %5.1f%% %8.2f | %5.1f %5.2f\n",
            figures.Name().c_str(), figures.openSubdivVertices, vertex * figures.openSubdivLimits[0],
            vertex * figures.openSubdivLimits[1], vertex * figures.openSubdivLimits[2],
            vertex * figures.OpenSubdivTwice(), figures.openSubdivBytes, 1e3 * figures.openSubdivBuild,
            value * figures.shaded, value * figures.shadedAvx2, value * figures.shadedSse2,
            value * figures.limitNormals, value * figures.smooth, figures.BytesPerValue(),
            100 * figures.SupportShare(), 1e3 * figures.build, figures.OpenSubdiv() / figures.shaded,
            figures.wallTwoThreads > 0 ? figures.wallOneThread / figures.wallTwoThreads : 0.0);
    }
}

void PrintScaling(std::vector<ScalingFigures> const& series) {
    if (series.empty()) return;
    std::printf("\nScaling, nanoseconds per value; bytes per value besides the outputs: largest resident size\n");
    std::printf("%11s %5s | %9s %7s %7s %9s | %7s %7s\n", "values", "level", "OSD", "P+N_L", "shaded", "2 threads",
                "table", "bytes");
    for (ScalingFigures const& figures : series) {
        double const value = 1e9 / figures.values;
        std::printf("%11.0f %5d | %9.1f %7.2f %7.2f %9.2f | %7.2f %7.2f\n", figures.values, figures.level,
                    value * figures.openSubdiv, value * figures.limitNormals, value * figures.shaded,
                    value * figures.shadedTwoThreads, figures.tableBytes, figures.otherBytes);
    }
}

void PrintGoals(std::vector<GoalRow> const& rows) {
    std::printf("\n%-55s %-32s %-12s %s\n", "goal", "", "verdict", "have");
    for (GoalRow const& row : rows) {
        std::printf("%-55s %-32s %-12s %s\n", row.what.c_str(), row.goal.c_str(), verdictName(row.verdict),
                    row.have.c_str());
    }
}

void WriteJson(std::string const& file, Measurements const& measured, std::vector<GoalRow> const& rows) {
    JsonFile json(file);
    json.Text("{\n");
    json.Array("goals", rows, [&](GoalRow const& row) {
        json.Text("\"what\": \"" + row.what + "\", \"goal\": \"" + row.goal + "\", \"have\": \"" + row.have +
                  "\", \"verdict\": \"" + verdictName(row.verdict) + "\"");
    });
    json.Text(",\n");
    json.Array("cases", measured.cases, [&](CaseFigures const& figures) {
        json.Text("\"mesh\": \"" + figures.mesh + "\", \"scheme\": \"" + (figures.isLoop ? "loop" : "catmark") +
                  "\", ");
        json.Members(fieldsOf(figures));
    });
    for (auto const& [name, series] : {std::pair("scalingSeries", &measured.scalingSeries),
                                       std::pair("scalingByLevel", &measured.scalingByLevel)}) {
        json.Text(",\n");
        json.Array(name, *series, [&](ScalingFigures const& figures) { json.Members(fieldsOf(figures)); });
    }
    json.Text(",\n");
    json.Array("instructions", measured.instructions, [&](auto const& entry) {
        json.Text("\"what\": \"" + entry.first + "\", ");
        json.Members({{"perValue", entry.second}});
    });
    json.Text("\n}\n");
    json.Close();
}

}  // namespace perf
