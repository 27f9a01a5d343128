// SPDX-License-Identifier: Apache-2.0
#include "figures.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <system_error>
#include <utility>

#include "builtInModels.h"
#include "image.h"
#include "modelInput.h"
#include "offscreen.h"
#include "osd_shading/io/errors.h"
#include "sceneBuilder.h"

namespace osd_shading::viewer {

namespace {

constexpr int kLevel = 4;
// The model stands a little smaller and higher than it could: the caption is below.
constexpr float kAway = 1.1F;
constexpr glm::vec2 kUpwards(0, -0.03F);

/// One picture of a sheet.
struct Panel {
    std::string model;
    tool::MeshOptions mesh;
    ShadingOptions options;
    ViewOptions view;
    CameraChoice camera;
    std::optional<float> sharpness;  // in place of that of all creases
    std::optional<VertexKind>
        vertex;          // looks at the first control vertex of this kind, extraordinary if there is one
    float zoom = 1;      // share of the model that is seen
    glm::vec3 focus{0};  // without `vertex`: what is looked at, in radii of the model from its middle
};

/// A sheet: panels row by row.
struct Sheet {
    std::string name;
    std::size_t columns;
    glm::ivec2 panelSize;
    std::vector<Panel> panels;
};

Panel MakePanel(std::string const& model, ShadingMode shading, NormalChoice normals, std::string const& caption) {
    Panel panel;
    panel.model = model;
    panel.options = PaperPreset(kLevel);
    panel.view.shading = shading;
    panel.view.normals = normals;
    panel.view.legend = false;
    panel.view.caption = caption;
    return panel;
}

CameraChoice Direction(float yaw, float pitch) {
    CameraChoice choice;
    choice.camera.yaw = yaw;
    choice.camera.pitch = pitch;
    return choice;
}

std::string Words(float number) {
    std::string text = std::to_string(number);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text;
}

int FindVertex(Scene const& scene, VertexKind kind) {
    SurfaceTopology const& topology = *scene.topology;
    int best = -1;
    for (int vertex = 0; vertex < topology.numControlVertices; ++vertex) {
        VertexTag const& tag = topology.vertexTags[static_cast<std::size_t>(vertex)];
        if (tag.kind != kind || topology.IsIsolated(vertex)) continue;
        if (tag.isExtraordinary && !tag.isBoundary) return vertex;
        if (best < 0) best = vertex;
    }
    return best;
}

// Looks along the mean of the vertex's normals, a little from the side.
CameraChoice CameraAt(Scene const& scene, int vertex, float share) {
    SurfaceTopology const& topology = *scene.topology;
    glm::vec3 normal(0);
    for (int value = topology.FirstValue(vertex); value < topology.FirstValue(vertex + 1); ++value) {
        normal += scene.vertices[static_cast<std::size_t>(value)].blendedNormal;
    }
    if (glm::length(normal) > 0) normal = glm::normalize(normal);
    constexpr float kAside = 20;
    CameraChoice choice = Direction(glm::degrees(std::atan2(normal.x, normal.z)) + kAside,
                                    std::clamp(glm::degrees(std::asin(normal.y)) + kAside / 2, -80.0F, 80.0F));
    choice.camera.Frame({scene.Position(topology.FirstValue(vertex)), scene.bounds.radius * share}, 1);
    choice.isFramed = true;
    return choice;
}

Sheet SharpnessSheet() {
    Sheet sheet{"figure1", 5, {300, 300}, {}};
    for (Sdc::SchemeType scheme : {Sdc::SCHEME_CATMARK, Sdc::SCHEME_LOOP}) {
        bool const isLoop = scheme == Sdc::SCHEME_LOOP;
        for (float sharpness : {0.0F, 1.0F, 2.0F, 4.0F, 6.0F}) {
            Panel panel =
                MakePanel(isLoop ? "cross_triangles" : "cross_quads", ShadingMode::Highlight, NormalChoice::Blended,
                          std::string(isLoop ? "Loop" : "Catmull-Clark") + ", sharpness " + Words(sharpness));
            panel.mesh.scheme = scheme;
            panel.sharpness = sharpness;
            // A crease is followed to the level where it is released.
            panel.options.level = std::max(kLevel, static_cast<int>(sharpness));
            sheet.panels.push_back(panel);
        }
    }
    return sheet;
}

Sheet ArtefactSheet() {
    Sheet sheet{"figure2", 2, {480, 480}, {}};
    for (ShadingMode mode : {ShadingMode::Highlight, ShadingMode::Isophotes}) {
        for (NormalChoice normals : {NormalChoice::Limit, NormalChoice::Blended}) {
            Panel panel =
                MakePanel("tetrahedron", mode, normals,
                          normals == NormalChoice::Limit ? "N_L, in the middle a vertex of valence 3, Loop"
                                                         : "N_B, in the middle a vertex of valence 3, Loop");
            panel.mesh.scheme = Sdc::SCHEME_LOOP;
            panel.options.level = 6;
            panel.vertex = VertexKind::Smooth;
            panel.zoom = 1.0F;
            sheet.panels.push_back(panel);
        }
    }
    return sheet;
}

/// Adds, for each of `cases`, its weights in the upper and its highlight lines in the lower row.
Sheet WeightSheet(std::string const& name, std::string const& model, CameraChoice const& camera,
                  std::vector<std::pair<std::string, ShadingOptions>> const& cases) {
    Sheet sheet{name, cases.size(), {360, 360}, {}};
    for (ShadingMode mode : {ShadingMode::Weight, ShadingMode::Highlight}) {
        for (auto const& [caption, options] : cases) {
            Panel panel = MakePanel(model, mode, NormalChoice::Blended, caption);
            panel.options = options;
            panel.camera = camera;
            panel.view.legend = mode == ShadingMode::Weight && sheet.panels.empty();
            sheet.panels.push_back(panel);
        }
    }
    return sheet;
}

Sheet VariantSheet() {
    ShadingOptions a = PaperPreset(kLevel), b = a, c = a;
    a.weights.sharpVertices = SharpVertexWeight::Smooth;
    c.weights.sharpVertices = SharpVertexWeight::PerRegion;
    return WeightSheet("figure3", "letter_a", Direction(30, 15),
                       {{"variant A", a}, {"variant B", b}, {"variant C", c}, {"variant D", SmoothPreset(kLevel)}});
}

Sheet LevelSheet() {
    std::vector<std::pair<std::string, ShadingOptions>> cases;
    for (int level : {1, 2, 3, 4}) {
        ShadingOptions options = PaperPreset(kLevel);
        options.weights.level = level;
        cases.emplace_back("weights from level " + std::to_string(level), options);
    }
    return WeightSheet("figure4", "mug", Direction(60, 15), cases);
}

Sheet DartSheet() {
    ShadingOptions smooth = PaperPreset(kLevel), sharp = smooth, sharpA = smooth;
    sharp.weights.darts = DartWeight::LikeSharp;
    sharpA.weights.sharpVertices = SharpVertexWeight::Smooth;
    return WeightSheet("figure5", "cube_dart", Direction(35, 35),
                       {{"darts like smooth vertices (B)", smooth},
                        {"darts like sharp vertices (B)", sharp},
                        {"variant A", sharpA}});
}

Sheet RegionSheet() {
    Sheet sheet{"figure6", 4, {360, 360}, {}};
    struct Case {
        char const* model;
        VertexKind kind;
        float zoom;
        char const* caption;
    };
    for (Case const& one : {Case{"cross_quads", VertexKind::Smooth, 0.7F, "smooth: one region"},
                            Case{"cube_dart", VertexKind::Dart, 1.1F, "dart: one region"},
                            Case{"letter_a", VertexKind::Crease, 0.6F, "crease: two regions"},
                            Case{"ring", VertexKind::Corner, 0.75F, "corner: a region between each two edges"}}) {
        Panel panel = MakePanel(one.model, ShadingMode::Lit, NormalChoice::Blended, one.caption);
        panel.vertex = one.kind;
        panel.zoom = one.zoom;
        panel.view.legend = sheet.panels.size() == 3;  // where there is room; it is the same for all
        panel.view.overlays = kRegions | kCreases;
        panel.options.level = 3;
        sheet.panels.push_back(panel);
    }
    return sheet;
}

/// Rows of models, columns of N_L, N_S and N_B.
Sheet NormalsSheet(std::string const& name, std::vector<std::pair<std::string, CameraChoice>> const& models,
                   Sdc::SchemeType scheme) {
    Sheet sheet{name, 3, {400, 400}, {}};
    for (auto const& [model, camera] : models) {
        for (NormalChoice normals : {NormalChoice::Limit, NormalChoice::Subdivided, NormalChoice::Blended}) {
            std::string const label = normals == NormalChoice::Limit        ? "N_L"
                                      : normals == NormalChoice::Subdivided ? "N_S"
                                                                            : "N_B";
            Panel panel = MakePanel(model, ShadingMode::Highlight, normals,
                                    std::filesystem::path(model).stem().string() + ", " + label);
            panel.mesh.scheme = scheme;
            panel.camera = camera;
            sheet.panels.push_back(panel);
        }
    }
    return sheet;
}

Sheet SideBySideSheet() {
    Panel panel = MakePanel("mug", ShadingMode::Highlight, NormalChoice::Blended, "");
    panel.view.split = SplitKind::SideBySide;
    panel.camera = Direction(60, 15);
    return {"side_by_side", 1, {1000, 480}, {panel}};
}

std::vector<Sheet> MakeSheets(std::string const& extraModels) {
    std::vector<Sheet> sheets = {SideBySideSheet(), SharpnessSheet(), ArtefactSheet(), VariantSheet(),
                                 LevelSheet(),      DartSheet(),      RegionSheet()};
    constexpr Sdc::SchemeType kCatmark = Sdc::SCHEME_CATMARK, kLoop = Sdc::SCHEME_LOOP;
    struct Extra {
        char const *name = "", *file = "";
        CameraChoice camera;
    };
    for (Extra const& extra :
         {Extra{"figure8", "robot.obj", Direction(20, 10)}, Extra{"figure9", "spot.obj", Direction(215, 15)}}) {
        std::string const file = (std::filesystem::path(extraModels) / "zbk" / extra.file).string();
        std::error_code ignored;
        if (!extraModels.empty() && std::filesystem::exists(file, ignored)) {
            sheets.push_back(NormalsSheet(extra.name, {{file, extra.camera}}, kCatmark));
        }
    }
    sheets.push_back(
        NormalsSheet("figure10", {{"letter_a", Direction(30, 15)}, {"axe", Direction(60, 15)}}, kCatmark));
    // The axe's head, where its extraordinary vertices are: as a whole it is long and thin.
    for (std::size_t i = 3; i < 6; ++i) {
        sheets.back().panels[i].focus = {0, 0.5F, 0};
        sheets.back().panels[i].zoom = 0.55F;
    }
    sheets.push_back(NormalsSheet(
        "figure11", {{"cross_triangles", Direction(35, 22)}, {"tetrahedron", Direction(35, 22)}}, kLoop));
    sheets.push_back(NormalsSheet("figure12", {{"hat", Direction(20, 25)}}, kLoop));
    sheets.back().panels = [&] {
        std::vector<Panel> panels = sheets.back().panels;
        Sheet const open = NormalsSheet("", {{"open_box", Direction(35, 30)}}, kCatmark);
        panels.insert(panels.end(), open.panels.begin(), open.panels.end());
        return panels;
    }();
    sheets.push_back(NormalsSheet(
        "figure13", {{"letter_a_dart", Direction(30, 15)}, {"cube_dart", Direction(35, 35)}}, kCatmark));
    return sheets;
}

Image DrawPanel(Panel const& panel, glm::ivec2 size, PictureMaker& maker, SceneBuilder& builder) {
    auto model = std::make_shared<io::Model>(LoadModel(panel.model));
    tool::ApplyMeshOptions(panel.mesh, *model);
    if (panel.sharpness) {
        std::fill(model->creaseSharpness.begin(), model->creaseSharpness.end(), *panel.sharpness);
    }
    SceneRequest request;
    request.model = model;
    request.file = panel.model;
    request.rules = panel.mesh.Rules(*model);
    request.options = panel.options;
    request.allSubdivided = panel.view.Shows(NormalChoice::Subdivided);
    std::shared_ptr<Scene const> const scene = builder.Build(request, [](double) { return true; });

    CameraChoice camera = panel.camera;
    ViewOptions view = panel.view;
    if (panel.vertex) {
        int const vertex = FindVertex(*scene, *panel.vertex);
        if (vertex >= 0) {
            view.vertex = vertex;
            camera = CameraAt(*scene, vertex, panel.zoom);
        }
    } else {
        Sphere const& bounds = scene->bounds;
        glm::ivec2 const viewSize = ViewportsOf(view, size)[0].size;
        camera.camera.Frame({bounds.center + panel.focus * bounds.radius, bounds.radius * panel.zoom * kAway},
                            static_cast<float>(viewSize.x) / static_cast<float>(viewSize.y));
        camera.isFramed = true;
    }
    if (!view.caption.empty()) camera.camera.Pan(kUpwards);
    return maker.Make(scene, camera, view, size);
}

Image DrawSheet(Sheet const& sheet, PictureMaker& maker, float scale) {
    SceneBuilder builder;
    auto const columns = static_cast<int>(sheet.columns);
    int const rows = (static_cast<int>(sheet.panels.size()) + columns - 1) / columns;
    glm::ivec2 const size = glm::ivec2(glm::vec2(sheet.panelSize) * scale);
    Image image(size * glm::ivec2(columns, rows), glm::vec3(1));
    for (int i = 0; i < static_cast<int>(sheet.panels.size()); ++i) {
        image.Paste(DrawPanel(sheet.panels[static_cast<std::size_t>(i)], size, maker, builder),
                    size * glm::ivec2(i % columns, i / columns));
    }
    return image;
}

}  // namespace

std::vector<std::string> WriteFigures(std::string const& folder, std::string const& extraModels, float scale) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw io::WriteError(folder, error.message());
    PictureMaker maker(scale);
    std::vector<std::string> files;
    for (Sheet const& sheet : MakeSheets(extraModels)) {
        std::string const file = (std::filesystem::path(folder) / (sheet.name + ".png")).string();
        WritePng(file, DrawSheet(sheet, maker, scale));
        files.push_back(file);
    }
    return files;
}

}  // namespace osd_shading::viewer
