#include "view/text_style.h"

#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace thimble::app::view {
namespace {

constexpr const char* kFont =
    "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";  // fonts-dejavu-core
constexpr float kFontSize = 16;                         // pixels at scale 1

ImU32 packed(const Colour& colour, float cover = 1) {
  return ImGui::ColorConvertFloat4ToU32({colour[0], colour[1], colour[2], cover});
}

void write_rimmed(ImDrawList& list, const ImVec2& at, const Colour& colour, const char* text) {
  const float rim = std::max(1.0F, ImGui::GetFontSize() / 11);
  for (int k = 0; k < 8; ++k) {
    const float turn = static_cast<float>(k) * 0.785398F;
    list.AddText({at.x + rim * std::cos(turn), at.y + rim * std::sin(turn)},
                 packed(kSkyColour, 0.8F), text);
  }
  list.AddText(at, packed(colour), text);
}

}  // namespace

void set_text_style(float scale) {
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // leaves no files about
  const float size = std::round(kFontSize * scale);
  io.Fonts->Clear();
  if (std::filesystem::exists(kFont)) {
    io.Fonts->AddFontFromFileTTF(kFont, size);
  } else {
    ImFontConfig plain;
    plain.SizePixels = size;
    io.Fonts->AddFontDefault(&plain);
  }
  ImGuiStyle style;
  ImGui::StyleColorsLight(&style);
  style.WindowRounding = 0;
  style.WindowBorderSize = 0;
  style.FrameRounding = 4;
  style.GrabRounding = 4;
  style.WindowPadding = {14, 14};
  style.ItemSpacing = {8, 7};
  style.FramePadding = {8, 4};
  style.Colors[ImGuiCol_WindowBg] = {0.969F, 0.976F, 0.984F, 1};
  style.Colors[ImGuiCol_Text] = {kTextColour[0], kTextColour[1], kTextColour[2], 1};
  style.Colors[ImGuiCol_TextDisabled] = {kQuietTextColour[0], kQuietTextColour[1],
                                         kQuietTextColour[2], 1};
  style.Colors[ImGuiCol_FrameBg] = {0.89F, 0.91F, 0.93F, 1};
  style.Colors[ImGuiCol_FrameBgHovered] = {0.84F, 0.88F, 0.92F, 1};
  style.Colors[ImGuiCol_Button] = {0.85F, 0.89F, 0.93F, 1};
  style.Colors[ImGuiCol_ButtonHovered] = {0.74F, 0.83F, 0.91F, 1};
  style.Colors[ImGuiCol_SliderGrab] = {kDepthColour[0], kDepthColour[1], kDepthColour[2], 0.85F};
  style.Colors[ImGuiCol_SliderGrabActive] = {kDepthColour[0], kDepthColour[1], kDepthColour[2], 1};
  style.ScaleAllSizes(scale);
  ImGui::GetStyle() = style;
}

void write_labels(const std::vector<Label>& labels, const Camera& camera, const ScreenPart& part) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const float margin = 0.5F * ImGui::GetFontSize();
  for (const Label& label : labels) {
    if ((label.p_W - camera.p_WEye()).dot(camera.towards_eye()) >= 0) continue;
    const Eigen::Vector2f at = camera.pixel(label.p_W, part.width, part.height).cast<float>();
    // To the left or right, where the scene says there is room: above stands the arm.
    const double side = label.away_W.dot(camera.right());
    const Eigen::Vector2f away(side < -0.05 ? -1.0F : 1.0F, 0);
    const ImVec2 size = ImGui::CalcTextSize(label.text.c_str());
    const float x = std::clamp(at.x() + away.x() * (0.5F * size.x + 2.5F * margin) - 0.5F * size.x,
                               margin, part.width - size.x - margin);
    const float y = std::clamp(at.y() + away.y() * (0.5F * size.y + margin) - 0.5F * size.y, margin,
                               part.height - size.y - margin);
    write_rimmed(list, {std::round(part.x + x), std::round(part.y + y)}, label.colour,
                 label.text.c_str());
  }
}

void write_caption(const std::string& text, const ScreenPart& part) {
  const float margin = 0.7F * ImGui::GetFontSize();
  write_rimmed(*ImGui::GetBackgroundDrawList(),
               {part.x + margin, part.y + part.height - margin - ImGui::GetFontSize()},
               kQuietTextColour, text.c_str());
}

void fill_part(const ScreenPart& part, const Colour& colour) {
  ImGui::GetBackgroundDrawList()->AddRectFilled(
      {part.x, part.y}, {part.x + part.width, part.y + part.height}, packed(colour));
}

PictureText::PictureText(float scale) : context_(ImGui::CreateContext()) {
  ImGui::SetCurrentContext(context_);
  set_text_style(scale);
  ImGui_ImplOpenGL3_Init("#version 330 core");
}

PictureText::~PictureText() {
  ImGui::SetCurrentContext(context_);
  ImGui_ImplOpenGL3_Shutdown();
  ImGui::DestroyContext(context_);
}

void PictureText::begin(int width, int height) {
  ImGui::SetCurrentContext(context_);
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = {static_cast<float>(width), static_cast<float>(height)};
  io.DeltaTime = 1.0F / 60;
  ImGui_ImplOpenGL3_NewFrame();
  ImGui::NewFrame();
}

void PictureText::end() {
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

}  // namespace thimble::app::view
