// SPDX-License-Identifier: Apache-2.0
#include "report.h"

#include <opensubdiv/version.h>

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>

#include "memory.h"

namespace osd_shading::tool {

using Json = nlohmann::ordered_json;  // the keys in the order in which they are written here

namespace {

double TotalSeconds(RunSummary const& run) {
    double total = 0;
    for (auto const& [stage, seconds] : run.seconds) total += seconds;
    return total;
}

#if defined(__GNUC__)
__attribute__((format(printf, 1, 2)))
#endif
std::string
Format(char const* format, ...) {
    char text[512];
    std::va_list values;
    va_start(values, format);
    std::vsnprintf(text, sizeof text, format, values);
    va_end(values);
    return text;
}

std::string CountText(std::int64_t count) { return std::to_string(count); }

// "24 (16 of valence 3, 8 of valence 5)"
std::string ValenceText(std::map<int, std::int64_t> const& counts) {
    std::int64_t sum = 0;
    std::string text;
    for (auto const& [valence, count] : counts) {
        sum += count;
        text += (text.empty() ? "" : ", ") + CountText(count) + " of valence " + std::to_string(valence);
    }
    return sum == 0 ? "0" : CountText(sum) + " (" + text + ")";
}

class Table {
public:
    void Add(std::string label, std::string value) { _rows.emplace_back(std::move(label), std::move(value)); }

    std::string Text() const {
        std::size_t width = 0;
        for (auto const& [label, value] : _rows) width = std::max(width, label.size());
        std::string text;
        for (auto const& [label, value] : _rows) {
            text.append("  ").append(label).append(width - label.size() + 2, ' ').append(value).append("\n");
        }
        return text;
    }

private:
    std::vector<std::pair<std::string, std::string>> _rows;
};

std::string AngleText(RunSummary const& run) {
    std::string text = Format("mean %.3g, largest %.3g degrees", run.shading.meanAngle, run.shading.maxAngle);
    if (run.maxAngleVertex >= 0 && run.shading.maxAngle > 0) {
        Vec3<double> const& p = run.maxAnglePosition;
        text += Format(" at vertex %d (%.4g, %.4g, %.4g)", run.maxAngleVertex, p.x, p.y, p.z);
    }
    return text;
}

std::string ComparisonText(GeometryComparison const& comparison) {
    std::string text = Format("%.2g", comparison.largest);
    if (comparison.name == "limit_normals") text += " radians";
    if (comparison.level >= 0 && comparison.vertex >= 0) {
        text += Format(" at level %d vertex %d", comparison.level, comparison.vertex);
    }
    return text + Format(", %lld of %lld vertices", static_cast<long long>(comparison.compared),
                         static_cast<long long>(comparison.total));
}

Json CheckJson(GeometryCheck const& check, double tolerance) {
    Json comparisons = Json::object();
    for (GeometryComparison const& comparison : check.comparisons) {
        comparisons[comparison.name] = {{"total", comparison.total},
                                        {"compared", comparison.compared},
                                        {"largest", comparison.largest},
                                        {"level", comparison.level},
                                        {"vertex", comparison.vertex}};
    }
    return {{"passed", check.Passes(tolerance)},
            {"tolerance", tolerance},
            {"model_size", check.modelSize},
            {"comparisons", comparisons}};
}

Json OptionsJson(CommandLine const& line, RunSummary const& run) {
    ShadingOptions const& options = run.options;
    return {{"normals_from", options.startNormals.level},
            {"weights_from", options.weights.level},
            {"sharp_vertices", NameOf(kSharpVertexNames, options.weights.sharpVertices)},
            {"darts", NameOf(kDartNames, options.weights.darts)},
            {"weights", NameOf(kWeightNames, options.weights.scheme)},
            {"exponent", options.weights.exponent},
            {"start_normals", NameOf(kStartNormalNames, options.startNormals.kind)},
            {"averaging", NameOf(kAveragingNames, options.subdividedNormals.averaging)},
            {"spherical_steps", options.subdividedNormals.sphericalSteps},
            {"limit_normals", NameOf(kLimitNormalNames, options.limits.normals)},
            {"positions", NameOf(kPositionNames, options.limits.positions)},
            {"boundary", NameOf(kBoundaryNames, run.rules.boundary)},
            {"creasing", NameOf(kCreasingNames, run.rules.creasing)},
            {"triangles", NameOf(kTriangleNames, run.rules.triangles)},
            {"precision", NameOf(kPrecisionNames, line.precision)}};
}

Json TableJson(ShadingTableStats const& stats) {
    return {{"values", stats.values},
            {"faces", stats.faces},
            {"tiles", stats.tiles},
            {"regular_tiles", stats.regularTiles},
            {"blended_tiles", stats.blendedTiles},
            {"blended_values", stats.blendedValues},
            {"classes", stats.classes},
            {"dense_matrices", stats.denseMatrices},
            {"start_normals", stats.startNormals},
            {"bytes", stats.bytes},
            {"dictionary_bytes", stats.dictionaryBytes},
            {"build_seconds", stats.buildSeconds}};
}

double NanosecondsPerValue(RunSummary const& run, double seconds) {
    return 1e9 * seconds / static_cast<double>(std::max<std::int64_t>(run.table->values, 1));
}

Json FramesJson(RunSummary const& run) {
    FrameTimes const& frames = *run.frames;
    return {{"count", frames.numFrames},
            {"deform", NameOf(kDeformationNames, frames.deformation)},
            {"threads", frames.numThreads},
            {"instruction_set", frames.instructionSet},
            {"ms_median", 1e3 * frames.medianSeconds},
            {"ms_min", 1e3 * frames.leastSeconds},
            {"ns_per_value_median", NanosecondsPerValue(run, frames.medianSeconds)},
            {"ns_per_value_min", NanosecondsPerValue(run, frames.leastSeconds)},
            {"fallback_normals", frames.worst.fallbackNormals},
            {"zero_start_normals", frames.worst.zeroStartNormals}};
}

void AddTableRows(RunSummary const& run, Table& table) {
    ShadingTableStats const& stats = *run.table;
    double const values = static_cast<double>(std::max<std::int64_t>(stats.values, 1));
    table.Add("table",
              BytesText(stats.bytes) + Format(", %.3g bytes a value, built in %.4f s",
                                              static_cast<double>(stats.bytes) / values, stats.buildSeconds));
    table.Add("  tiles", CountText(stats.tiles) + " (" + CountText(stats.regularTiles) + " regular, " +
                             CountText(stats.blendedTiles) + " blended)");
    table.Add("  classes", CountText(stats.classes) + ", " + CountText(stats.denseMatrices) + " matrices, " +
                               BytesText(stats.dictionaryBytes));
    table.Add("  support", CountText(stats.blendedValues) +
                               Format(" values, %.1f %%", 100 * static_cast<double>(stats.blendedValues) / values));
    table.Add("  start normals", CountText(stats.startNormals));
}

void AddFrameRows(RunSummary const& run, Table& table) {
    FrameTimes const& frames = *run.frames;
    table.Add("frames", std::to_string(frames.numFrames) + ", " +
                            std::string(NameOf(kDeformationNames, frames.deformation)) + ", " +
                            std::to_string(frames.numThreads) +
                            (frames.numThreads == 1 ? " thread, " : " threads, ") + frames.instructionSet);
    auto const row = [&](double seconds) {
        return Format("%.4g ms, %.3g ns a value", 1e3 * seconds, NanosecondsPerValue(run, seconds));
    };
    table.Add("  median", row(frames.medianSeconds));
    table.Add("  least", row(frames.leastSeconds));
    if (frames.worst.fallbackNormals > 0) {
        table.Add("  fallback normals", "up to " + CountText(frames.worst.fallbackNormals));
    }
}

// A stage's name as a key: "blend weights" is blend_weights.
std::string StageKey(std::string const& stage) {
    std::string key;
    for (char c : stage) {
        bool const isLetter = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
        if (isLetter) key += c;
        if (c >= 'A' && c <= 'Z') key += static_cast<char>(c - 'A' + 'a');
        if ((c == ' ' || c == '_') && !key.empty() && key.back() != '_') key += '_';
    }
    return key;
}

// JSON's keys are text: {"3": 8, "5": 8}.
Json ValenceJson(std::map<int, std::int64_t> const& counts) {
    Json json = Json::object();
    for (auto const& [valence, count] : counts) json[std::to_string(valence)] = count;
    return json;
}

}  // namespace

std::string TableText(CommandLine const& line, RunSummary const& run) {
    ShadingReport const& report = run.shading;
    Table table;
    table.Add("vertices", CountText(report.vertices));
    table.Add("faces", CountText(report.faces));
    table.Add("values", CountText(report.values));
    table.Add("extraordinary", ValenceText(report.extraordinary));
    if (report.boundaryVertices > 0) {
        table.Add("boundary vertices", CountText(report.boundaryVertices));
        table.Add("boundary extraordinary", ValenceText(report.boundaryExtraordinary));
    }
    if (report.nonManifoldEdges + report.nonManifoldVertices > 0) {
        table.Add("non-manifold", CountText(report.nonManifoldVertices) + " vertices, " +
                                      CountText(report.nonManifoldEdges) + " edges");
    }
    table.Add("sharp vertices", CountText(report.sharpVertices));
    table.Add("darts", CountText(report.darts));
    table.Add("vertices with weight", CountText(report.verticesWithWeight));
    table.Add("angle N_L to N_B", AngleText(run));
    table.Add("zero normals", CountText(report.zeroNormals));
    if (report.zeroStartNormals > 0) table.Add("zero start normals", CountText(report.zeroStartNormals));
    // Triangles of the limit surface do not say.
    bool const isMesh = !line.tessellation;
    if (isMesh) {
        table.Add("fallback normals", CountText(report.fallbackNormals));
        table.Add("averaged normals", CountText(report.averagedNormals));
    }
    table.Add("opposed normals", CountText(report.opposedNormals));
    if (isMesh) {
        table.Add("smallest |N_S|",
                  report.minSubdividedLength < 0 ? "none" : Format("%.4g", report.minSubdividedLength));
    }

    if (run.check) {
        table.Add("check", (run.check->Passes(line.tolerance) ? "passed" : "FAILED") +
                               Format(" at tolerance %.3g", line.tolerance));
        for (GeometryComparison const& comparison : run.check->comparisons) {
            table.Add("  " + comparison.name, ComparisonText(comparison));
        }
    }

    if (run.table) AddTableRows(run, table);
    if (run.frames) AddFrameRows(run, table);
    table.Add("seconds", Format("%.3f", TotalSeconds(run)));
    for (auto const& [stage, seconds] : run.seconds) table.Add("  " + stage, Format("%.3f", seconds));
    table.Add("peak memory", run.peakBytes == 0 ? "unknown" : BytesText(run.peakBytes));

    std::string title = line.modelFile + ": " + std::string(NameOf(kSchemeNames, run.rules.scheme)) + ", level " +
                        std::to_string(run.options.level) + ", " +
                        std::string(NameOf(kPrecisionNames, line.precision));
    if (!line.outputFile.empty()) title += ", written to " + line.outputFile;
    return title + "\n" + table.Text();
}

std::string JsonText(CommandLine const& line, RunSummary const& run) {
    ShadingReport const& report = run.shading;
    Json json;
    json["model"] = line.modelFile;
    json["output"] = line.outputFile.empty() ? Json() : Json(line.outputFile);
    json["version"] = OSD_SHADING_VERSION;
    json["scheme"] = NameOf(kSchemeNames, run.rules.scheme);
    json["level"] = run.options.level;
    json["options"] = OptionsJson(line, run);

    json["vertices"] = report.vertices;
    json["faces"] = report.faces;
    json["values"] = report.values;
    // Triangles of the limit surface do not say.
    auto const ofMesh = [&](Json const& value) { return line.tessellation ? Json() : value; };
    json["extraordinary"] = ValenceJson(report.extraordinary);
    json["boundary_extraordinary"] = ValenceJson(report.boundaryExtraordinary);
    json["sharp_vertices"] = report.sharpVertices;
    json["darts"] = report.darts;
    json["boundary_vertices"] = report.boundaryVertices;
    json["non_manifold_vertices"] = report.nonManifoldVertices;
    json["non_manifold_edges"] = report.nonManifoldEdges;
    json["vertices_with_weight"] = report.verticesWithWeight;
    json["subdivided_values"] = report.subdividedValues;
    json["zero_start_normals"] = ofMesh(report.zeroStartNormals);
    json["zero_normals"] = report.zeroNormals;
    json["fallback_normals"] = ofMesh(report.fallbackNormals);
    json["averaged_normals"] = ofMesh(report.averagedNormals);
    json["opposed_normals"] = report.opposedNormals;
    json["min_subdivided_length"] = report.minSubdividedLength < 0 ? Json() : Json(report.minSubdividedLength);
    json["mean_angle_deg"] = report.meanAngle;
    json["max_angle_deg"] = report.maxAngle;
    json["max_angle_vertex"] = run.maxAngleVertex < 0 ? Json() : Json(run.maxAngleVertex);
    json["max_angle_position"] =
        run.maxAngleVertex < 0 ? Json()
                               : Json({run.maxAnglePosition.x, run.maxAnglePosition.y, run.maxAnglePosition.z});

    json["check"] = run.check ? CheckJson(*run.check, line.tolerance) : Json();
    json["table"] = run.table ? TableJson(*run.table) : Json();
    json["frames"] = run.frames ? FramesJson(run) : Json();
    json["seconds"] = Json::object();
    for (auto const& [stage, seconds] : run.seconds) json["seconds"][StageKey(stage)] = seconds;
    json["seconds"]["total"] = TotalSeconds(run);
    json["peak_bytes"] = run.peakBytes;

    // Names of files need not be UTF-8, JSON must be.
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace osd_shading::tool
