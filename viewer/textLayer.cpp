// SPDX-License-Identifier: Apache-2.0
#include "textLayer.h"

#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include "glObjects.h"

namespace osd_shading::viewer {

namespace {

constexpr float kLetterSize = 13;  // of the font that Dear ImGui has with it

}  // namespace

TextLayer::TextLayer(float scale) : _context(nullptr), _scale(scale) {
    ImGuiContext* const outer = ImGui::GetCurrentContext();
    _context = ImGui::CreateContext();
    ImGui::SetCurrentContext(_context);
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    ImFontConfig font;
    font.SizePixels = kLetterSize * scale;
    io.Fonts->AddFontDefault(&font);
    bool const isReady = ImGui_ImplOpenGL3_Init("#version 330 core");
    ImGui::SetCurrentContext(outer);
    if (!isReady) throw GraphicsError("the text of pictures can't be set up");
}

TextLayer::~TextLayer() {
    ImGuiContext* const outer = ImGui::GetCurrentContext();
    ImGui::SetCurrentContext(_context);
    ImGui_ImplOpenGL3_Shutdown();
    ImGui::DestroyContext(_context);
    ImGui::SetCurrentContext(outer == _context ? nullptr : outer);
}

ImDrawList& TextLayer::Begin(glm::ivec2 size) {
    _outer = ImGui::GetCurrentContext();
    ImGui::SetCurrentContext(_context);
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = {static_cast<float>(size.x), static_cast<float>(size.y)};
    io.DeltaTime = 1.0F / 60;
    ImGui_ImplOpenGL3_NewFrame();
    ImGui::NewFrame();
    return *ImGui::GetBackgroundDrawList();
}

void TextLayer::End() {
    ImGui::Render();
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    ImGui::SetCurrentContext(_outer);
}

}  // namespace osd_shading::viewer
