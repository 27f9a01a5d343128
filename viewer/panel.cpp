// SPDX-License-Identifier: Apache-2.0
#include "panel.h"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "annotations.h"
#include "builtInModels.h"
#include "keys.h"

namespace osd_shading::viewer {

namespace {

constexpr float kWidth = 300;
constexpr int kMostSegments = 64;        // of an edge; the command line has more
constexpr double kProgressDelay = 0.15;  // seconds; shorter work needs no bar

/// A list of the words of `names`; true when another is chosen.
template <typename T, std::size_t N>
bool ChooseWord(char const* label, T& value, OptionNames<T, N> const& names) {
    bool hasChanged = false;
    if (ImGui::BeginCombo(label, std::string(tool::NameOf(names, value)).c_str())) {
        for (auto const& [name, choice] : names) {
            if (ImGui::Selectable(std::string(name).c_str(), choice == value)) {
                hasChanged = choice != value;
                value = choice;
            }
        }
        ImGui::EndCombo();
    }
    return hasChanged;
}

/// The same for an option that may be left out: `shown` is then what it amounts to.
template <typename T, std::size_t N>
bool ChooseWord(char const* label, std::optional<T>& given, T shown, OptionNames<T, N> const& names) {
    if (!ChooseWord(label, shown, names)) return false;
    given = shown;
    return true;
}

bool ChooseLevel(char const* label, std::optional<int>& given, int shown, int last) {
    if (!ImGui::SliderInt(label, &shown, 0, last)) return false;
    given = std::clamp(shown, 0, last);
    return true;
}

void DrawFiles(Workbench& bench, PanelState& state) {
    Document const* const document = bench.CurrentDocument();
    std::string const name = document ? document->Name() : "";
    if (ImGui::BeginCombo("model", name.c_str())) {
        for (BuiltInModel const& model : BuiltInModels()) {
            std::string const candidate(model.name);
            if (ImGui::Selectable(candidate.c_str(), candidate == name)) bench.Open(candidate);
        }
        if (ImGui::IsWindowAppearing()) state.filesBeside = FilesBeside(name);
        if (!state.filesBeside.empty()) ImGui::Separator();
        for (std::string const& file : state.filesBeside) {
            if (ImGui::Selectable(file.c_str(), file == name)) bench.Open(file);
        }
        ImGui::EndCombo();
    }
    bool const isEntered = ImGui::InputTextWithHint("##file", "OBJ file, or drop one", &state.openFile,
                                                    ImGuiInputTextFlags_EnterReturnsTrue);
    ImGui::SameLine();
    if ((ImGui::Button("Open") || isEntered) && !state.openFile.empty()) bench.Open(state.openFile);

    ImGui::InputText("##cage", &state.cageFile);
    ImGui::SameLine();
    if (ImGui::Button("Save cage")) bench.SaveCage(state.cageFile);
    ImGui::InputText("##result", &state.resultFile);
    ImGui::SameLine();
    if (ImGui::Button("Save result")) bench.SaveResult(state.resultFile);
    ImGui::InputText("##settings", &state.settingsFile);
    ImGui::SameLine();
    if (ImGui::Button("Save##settings")) bench.SaveSettings(state.settingsFile);
    ImGui::SameLine();
    if (ImGui::Button("Load##settings")) bench.LoadSettings(state.settingsFile);
}

// True where something that is computed depends on the change.
bool DrawMesh(Workbench& bench) {
    tool::MeshOptions& mesh = bench.settings.mesh;
    SubdivisionRules rules;
    if (Document const* const document = bench.CurrentDocument()) rules = mesh.Rules(*document->Model());
    bool hasChanged = ChooseWord("scheme", mesh.scheme, rules.scheme, tool::kSchemeNames);
    hasChanged |= ChooseWord("boundary", mesh.boundary, rules.boundary, tool::kBoundaryNames);
    hasChanged |= ChooseWord("creasing", mesh.creasing, rules.creasing, tool::kCreasingNames);
    hasChanged |= ChooseWord("triangles", mesh.triangles, rules.triangles, tool::kTriangleNames);
    return hasChanged;
}

// A uniform level or triangles of the limit surface, and how fine those are.
bool DrawTessellation(tool::TessellationChoice& given) {
    static constexpr std::array<std::pair<char const*, std::optional<TessellationKind>>, 4> kKinds = {
        {{"to a level", std::nullopt},
         {"evenly", TessellationKind::Uniform},
         {"by curvature", TessellationKind::Curvature},
         {"by size on screen", TessellationKind::Screen}}};
    auto const chosen =
        std::find_if(kKinds.begin(), kKinds.end(), [&](auto const& kind) { return kind.second == given.kind; });
    bool hasChanged = false;
    if (ImGui::BeginCombo("cut", chosen->first)) {
        for (auto const& [name, kind] : kKinds) {
            if (!ImGui::Selectable(name, kind == given.kind) || kind == given.kind) continue;
            given = {};
            given.kind = kind;
            if (kind == TessellationKind::Uniform) given.rate = TessellationOptions{}.rate;
            hasChanged = true;
        }
        ImGui::EndCombo();
    }
    if (!given.kind) return hasChanged;
    TessellationOptions const options = *given.Resolve();
    auto const slide = [&](char const* label, double shown, float low, float high, std::optional<double>& value) {
        auto number = static_cast<float>(shown);
        if (!ImGui::SliderFloat(label, &number, low, high, "%.3g", ImGuiSliderFlags_Logarithmic)) return;
        value = static_cast<double>(std::clamp(number, low, high));
        hasChanged = true;
    };
    switch (options.kind) {
        case TessellationKind::Uniform: {
            int rate = options.rate;
            if (ImGui::SliderInt("segments", &rate, 1, kMostSegments)) {
                given.rate = std::clamp(rate, 1, kMostSegments);
                hasChanged = true;
            }
            break;
        }
        case TessellationKind::Curvature:
            slide("degrees", options.maxAngle, 1, 90, given.maxAngle);
            break;
        case TessellationKind::Screen:
            slide("pixels", options.maxPixels, 1, 100, given.maxPixels);
            hasChanged |= ImGui::Button("Cut for this view");
            break;
    }
    return hasChanged;
}

bool DrawMethod(Workbench& bench) {
    tool::ShadingChoice& given = bench.settings.shading;
    ShadingOptions options = bench.settings.ResolveShading();
    options.level = bench.ChosenLevel();
    int level = options.level;
    bool hasChanged = DrawTessellation(bench.settings.tessellation);
    if (ImGui::SliderInt("level", &level, 0, kMaxViewerLevel)) {
        SetLevel(given, level);
        hasChanged = true;
    }
    bool preset = given.smoothPreset.value_or(false);
    if (ChooseWord("preset", preset, tool::kPresetNames)) {
        std::optional<int> const kept = given.level;
        given = {};
        given.level = kept;
        given.smoothPreset = preset;
        hasChanged = true;
    }
    int const normalsFrom = std::max(options.startNormals.level, options.level == 0 ? 0 : 1);
    hasChanged |=
        ChooseWord("start normals", given.startNormals, options.startNormals.kind, tool::kStartNormalNames);
    // Normals of the file stand on the control mesh.
    if (options.startNormals.kind == StartNormalKind::User) {
        given.normalsFrom.reset();
    } else {
        hasChanged |= ChooseLevel("normals from", given.normalsFrom,
                                  options.startNormals.level < 0 ? normalsFrom : options.startNormals.level, level);
    }
    if (given.startNormals == StartNormalKind::User) given.normalsFrom.reset();
    hasChanged |=
        ChooseWord("averaging", given.averaging, options.subdividedNormals.averaging, tool::kAveragingNames);
    if (options.subdividedNormals.averaging == NormalAveraging::Spherical) {
        int steps = options.subdividedNormals.sphericalSteps;
        if (ImGui::SliderInt("steps", &steps, 0, 20)) {
            given.sphericalSteps = std::clamp(steps, 0, 100);
            hasChanged = true;
        }
    }
    hasChanged |= ChooseWord("weights", given.weights, options.weights.scheme, tool::kWeightNames);
    hasChanged |= ChooseLevel("weights from", given.weightsFrom,
                              options.weights.level < 0 ? std::min(1, level) : options.weights.level, level);
    hasChanged |=
        ChooseWord("sharp vertices", given.sharpVertices, options.weights.sharpVertices, tool::kSharpVertexNames);
    hasChanged |= ChooseWord("darts", given.darts, options.weights.darts, tool::kDartNames);
    auto exponent = static_cast<float>(options.weights.exponent);
    if (ImGui::SliderFloat("exponent p", &exponent, 0.05F, 8, "%.3g", ImGuiSliderFlags_Logarithmic)) {
        given.exponent = static_cast<double>(std::clamp(exponent, 0.01F, 100.0F));
        hasChanged = true;
    }
    hasChanged |= ChooseWord("limit normals", given.limitNormals, options.limits.normals, tool::kLimitNormalNames);
    hasChanged |= ChooseWord("positions", given.positions, options.limits.positions, tool::kPositionNames);
    return hasChanged;
}

bool DrawView(Workbench& bench, PanelState& state) {
    ViewOptions& view = bench.settings.view;
    bool const hadSubdivided = view.Shows(NormalChoice::Subdivided);
    ChooseWord("shading", view.shading, kShadingNames);
    ChooseWord("split", view.split, kSplitNames);
    if (view.split == SplitKind::None && view.shading != ShadingMode::Difference) {
        ChooseWord("normals", view.normals, kNormalNames);
    } else {
        ChooseWord("left", view.left, kNormalNames);
        ChooseWord("right", view.right, kNormalNames);
    }
    if (view.split == SplitKind::Line) ImGui::SliderFloat("split line", &view.splitPosition, 0, 1, "%.2f");
    switch (view.shading) {
        case ShadingMode::Lit:
            ImGui::SliderFloat("roughness", &view.roughness, 0, 1, "%.2f");
            view.roughness = std::clamp(view.roughness, 0.0F, 1.0F);
            break;
        case ShadingMode::Highlight:
            ImGui::SliderFloat("direction", &view.lineAngle, -90, 90, "%.0f deg");
            view.lineAngle = std::clamp(view.lineAngle, -180.0F, 180.0F);
            [[fallthrough]];
        case ShadingMode::Isophotes:
        case ShadingMode::Zebra:
            ImGui::SliderInt("lines", &view.lineCount, 1, 100);
            view.lineCount = std::clamp(view.lineCount, 1, 500);
            break;
        case ShadingMode::Curvature:
        case ShadingMode::Difference: {
            bool isFixed = view.range.has_value();
            if (ImGui::Checkbox("fixed range", &isFixed)) {
                view.range = isFixed ? std::optional<float>(10.0F) : std::nullopt;
            }
            if (view.range) {
                ImGui::SliderFloat("range", &*view.range, 0.1F, 90, "%.3g", ImGuiSliderFlags_Logarithmic);
                view.range = std::max(*view.range, 1e-3F);
            }
            break;
        }
        default:
            break;
    }
    std::size_t column = 0;
    for (auto const& [name, overlay] : kOverlayNames) {
        if (column++ % 2 == 1) ImGui::SameLine(ImGui::GetWindowWidth() / 2);
        ImGui::CheckboxFlags(std::string(name).c_str(), &view.overlays, static_cast<unsigned>(overlay));
    }
    ImGui::Checkbox("figures (I)", &state.showsHud);
    ImGui::SameLine(ImGui::GetWindowWidth() / 2);
    ImGui::Checkbox("legend", &view.legend);
    ChooseWord("background", view.background, kBackgroundNames);
    return view.Shows(NormalChoice::Subdivided) && !hadSubdivided;
}

void DrawEditing(Workbench& bench, PanelState& state) {
    Document const* const document = bench.CurrentDocument();
    if (!document) return;
    ImGui::Text("selected: %d edges, %d vertices", static_cast<int>(bench.SelectedEdges().size()),
                static_cast<int>(bench.SelectedVertices().size()));
    std::optional<float> const common = bench.SelectedSharpness();
    float sharpness = common.value_or(0);
    bool const isInfinite = sharpness >= io::kInfiniteSharpness;
    static int gesture = 0;
    if (ImGui::SliderFloat("sharpness", &sharpness, 0, io::kInfiniteSharpness, isInfinite ? "infinite" : "%.2f")) {
        bench.SetSelectedSharpness(sharpness, gesture);
    }
    if (ImGui::IsItemActivated()) ++gesture;
    if (ImGui::Button("Infinite")) bench.SetSelectedSharpness(io::kInfiniteSharpness);
    ImGui::SameLine();
    if (ImGui::Button("Clear")) bench.SetSelectedSharpness(0);
    ImGui::SameLine();
    if (ImGui::Button("Clear all")) bench.ClearAllSharpness();
    if (ImGui::Button("Chain")) bench.ExtendToChains();
    ImGui::SameLine();
    if (ImGui::Button("All creases")) bench.SelectAllCreases();
    ImGui::SameLine();
    if (ImGui::Button("None")) bench.SelectNone();
    ImGui::SetNextItemWidth(ImGui::GetWindowWidth() * 0.35F);
    ImGui::SliderFloat("##angle", &state.creaseAngle, 0, 180, "%.0f deg");
    ImGui::SameLine();
    if (ImGui::Button("Crease by angle")) {
        bench.CreaseByAngle(static_cast<double>(std::clamp(state.creaseAngle, 0.0F, 180.0F)));
    }
    if (ImGui::Button("Undo") && document->CanUndo()) bench.Undo();
    ImGui::SameLine();
    if (ImGui::Button("Redo") && document->CanRedo()) bench.Redo();
    if (document->IsChanged()) {
        ImGui::SameLine();
        ImGui::TextUnformatted("not saved");
    }
}

bool DrawMotion(Workbench& bench, PanelState& state) {
    Deformation& deformation = bench.settings.deformation;
    bool hasChanged = ChooseWord("movement", deformation.kind, kDeformationNames);
    if (ImGui::Button(state.isPlaying ? "Stop" : "Play")) TogglePlay(bench, state);
    hasChanged |= ImGui::SliderFloat("time", &deformation.phase, 0, 1, "%.3f");
    hasChanged |= ImGui::SliderFloat("amount", &deformation.amount, 0, 2, "%.2f");
    deformation.phase = std::clamp(deformation.phase, 0.0F, 1.0F);
    deformation.amount = std::clamp(deformation.amount, 0.0F, 3.0F);
    auto const rate = [](double seconds) { return seconds > 0 ? 1 / seconds : 0; };
    ImGui::Text("update %.1f ms (%.0f/s), draw %.1f ms (%.0f/s)", state.updateSeconds * 1e3,
                rate(state.updateSeconds), state.drawSeconds * 1e3, rate(state.drawSeconds));
    return hasChanged;
}

void DrawCamera(Workbench& bench, PanelState& state) {
    CameraChoice& camera = bench.settings.camera;
    static constexpr std::array<char const*, 7> kViews = {"front", "back",   "left",  "right",
                                                          "top",   "bottom", "corner"};
    for (std::size_t i = 0; i < kViews.size(); ++i) {
        if (i % 4 != 0) ImGui::SameLine();
        if (ImGui::Button(kViews[i])) SetStandardView(bench, kViews[i]);
    }
    if (ImGui::Button("Frame (F)")) state.wantsFrame = true;
    ImGui::SameLine();
    if (ImGui::Button("Copy")) ImGui::SetClipboardText(camera.Text().c_str());
    ImGui::SameLine();
    if (ImGui::Button("Paste")) PasteCamera(bench, ImGui::GetClipboardText());
    ImGui::TextWrapped("%s", camera.Text().c_str());
    int& multiple = bench.settings.screenshotMultiple;
    ImGui::SliderInt("times the window", &multiple, 1, kMaxScreenshotMultiple);
    multiple = std::clamp(multiple, 1, kMaxScreenshotMultiple);
    if (ImGui::Button("Screenshot (P)")) state.wantsScreenshot = true;
}

void DrawHelp(PanelState& state, glm::vec2 size, float scale) {
    ImGui::SetNextWindowPos({size.x / 2, size.y / 2}, ImGuiCond_Always, {0.5F, 0.5F});
    ImGui::SetNextWindowSize({std::min(size.x, 560 * scale), std::min(size.y, 560 * scale)});
    if (ImGui::Begin("Keys", &state.showsHelp, ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoResize)) {
        for (KeyHelp const& key : KeyHelpLines()) {
            ImGui::TextUnformatted(key.key);
            ImGui::SameLine(190 * scale);
            ImGui::TextWrapped("%s", key.meaning);
        }
    }
    ImGui::End();
}

void DrawProgress(Workbench& bench, glm::vec2 size, float scale) {
    if (bench.BusySeconds() < kProgressDelay) return;
    ImGui::SetNextWindowPos({size.x / 2, size.y - 20 * scale}, ImGuiCond_Always, {0.5F, 1});
    ImGui::SetNextWindowSize({320 * scale, 0});
    ImGui::Begin("##progress", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav |
                     ImGuiWindowFlags_AlwaysAutoResize);
    ImGui::ProgressBar(static_cast<float>(bench.Progress()), {220 * scale, 0});
    ImGui::SameLine();
    if (ImGui::Button("Abandon")) bench.Abandon();
    ImGui::End();
}

void DrawMessage(Workbench& bench, glm::vec2 size, float scale, float left) {
    if (bench.Message().empty()) return;
    ImGui::SetNextWindowPos({left + 10 * scale, size.y - 10 * scale}, ImGuiCond_Always, {0, 1});
    ImGui::SetNextWindowSize({std::min(size.x - left - 20 * scale, 600 * scale), 0});
    ImGui::SetNextWindowBgAlpha(0.85F);
    bool isOpen = true;
    ImGui::Begin("Message", &isOpen,
                 ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                     ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav);
    ImGui::TextWrapped("%s", bench.Message().c_str());
    ImGui::End();
    if (!isOpen) bench.Say({});
}

}  // namespace

float PanelWidth(PanelState const& state, float scale) { return state.isVisible ? kWidth * scale : 0; }

void DrawPanels(Workbench& bench, PanelState& state, glm::vec2 size, float scale) {
    bool needsScene = false;
    float const width = std::min(PanelWidth(state, scale), size.x);
    if (state.isVisible) {
        ImGui::SetNextWindowPos({0, 0});
        ImGui::SetNextWindowSize({width, size.y});
        ImGui::Begin("##panel", nullptr,
                     ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                         ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoBringToFrontOnFocus);
        if (std::exchange(state.takesFocus, false)) ImGui::SetWindowFocus();
        ImGui::PushItemWidth(width * 0.55F);
        auto const section = [](char const* title, bool isOpen) {
            return ImGui::CollapsingHeader(title, isOpen ? ImGuiTreeNodeFlags_DefaultOpen : 0);
        };
        if (section("Model", true)) DrawFiles(bench, state);
        if (section("View", true)) needsScene |= DrawView(bench, state);
        if (section("Subdivision", true)) needsScene |= DrawMesh(bench);
        if (section("Method", true)) needsScene |= DrawMethod(bench);
        if (section("Creases", true)) DrawEditing(bench, state);
        if (section("Motion", false)) needsScene |= DrawMotion(bench, state);
        if (section("Camera and pictures", false)) DrawCamera(bench, state);
        ImGui::TextUnformatted("H: keys");
        ImGui::PopItemWidth();
        ImGui::End();
    }
    if (needsScene) bench.Apply();
    DrawMessage(bench, size, scale, width);
    DrawProgress(bench, size, scale);
    if (state.showsHelp) DrawHelp(state, size, scale);
}

}  // namespace osd_shading::viewer
