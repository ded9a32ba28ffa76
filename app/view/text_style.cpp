#include "view/text_style.h"

#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace thimble::view {
namespace {

constexpr const char* kFont =
    "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";  // fonts-dejavu-core
constexpr float kFontSize = 16;                         // pixels at scale 1
constexpr float kTitleScale = 1.5F;  // the second font, for titles of the start window

ImU32 packed(const Colour& colour, float cover = 1) {
  return ImGui::ColorConvertFloat4ToU32({colour[0], colour[1], colour[2], cover});
}

ImVec4 vec(const Colour& colour, float cover = 1) {
  return {colour[0], colour[1], colour[2], cover};
}

Colour mix(const Colour& a, const Colour& b, float share) {
  return {a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]), a[2] + share * (b[2] - a[2])};
}

}  // namespace

void write_rimmed(const ScreenPlace& at, Theme theme, const Colour& colour,
                  const std::string& text) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const float rim = std::max(1.0F, ImGui::GetFontSize() / 11);
  for (int k = 0; k < 8; ++k) {
    const float turn = static_cast<float>(k) * 0.785398F;
    list.AddText({at.x + rim * std::cos(turn), at.y + rim * std::sin(turn)},
                 packed(colours_of(theme).sky, 0.8F), text.c_str());
  }
  list.AddText({at.x, at.y}, packed(colour), text.c_str());
}

void set_text_style(float scale, Theme theme) {
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // writes no file
  const float size = std::round(kFontSize * scale);
  io.Fonts->Clear();
  if (std::filesystem::exists(kFont)) {
    io.Fonts->AddFontFromFileTTF(kFont, size);
    io.Fonts->AddFontFromFileTTF(kFont, std::round(kTitleScale * size));
  } else {
    ImFontConfig plain;
    plain.SizePixels = size;
    io.Fonts->AddFontDefault(&plain);
  }
  ImGuiStyle style;
  const ThemeColours colours = colours_of(theme);
  if (theme == Theme::kDark) {
    ImGui::StyleColorsDark(&style);
  } else {
    ImGui::StyleColorsLight(&style);
  }
  style.WindowRounding = 0;
  style.WindowBorderSize = 0;
  style.FrameRounding = 4;
  style.GrabRounding = 4;
  style.WindowPadding = {14, 14};
  style.ItemSpacing = {8, 7};
  style.FramePadding = {8, 4};
  // Steps from the window's background towards the text, tinted blue for movable parts.
  const Colour window = mix(colours.sky, colours.ground, 0.2F);
  const auto towards = [&](float text, float blue) {
    return vec(mix(mix(window, colours.text, text), kDepthColour, blue));
  };
  style.Colors[ImGuiCol_WindowBg] = vec(window);
  style.Colors[ImGuiCol_PopupBg] = vec(colours.sky);
  style.Colors[ImGuiCol_Text] = vec(colours.text);
  style.Colors[ImGuiCol_TextDisabled] = vec(colours.quiet_text);
  style.Colors[ImGuiCol_FrameBg] = towards(0.09F, 0);
  style.Colors[ImGuiCol_FrameBgHovered] = towards(0.11F, 0.06F);
  style.Colors[ImGuiCol_FrameBgActive] = towards(0.12F, 0.12F);
  style.Colors[ImGuiCol_Button] = towards(0.1F, 0.05F);
  style.Colors[ImGuiCol_ButtonHovered] = towards(0.1F, 0.2F);
  style.Colors[ImGuiCol_ButtonActive] = towards(0.1F, 0.35F);
  style.Colors[ImGuiCol_Tab] = style.Colors[ImGuiCol_Button];
  style.Colors[ImGuiCol_TabHovered] = style.Colors[ImGuiCol_ButtonHovered];
  style.Colors[ImGuiCol_TabActive] = style.Colors[ImGuiCol_ButtonActive];
  style.Colors[ImGuiCol_CheckMark] = vec(text_colour(kDepthColour, theme));
  style.Colors[ImGuiCol_SliderGrab] = vec(kDepthColour, 0.85F);
  style.Colors[ImGuiCol_SliderGrabActive] = vec(kDepthColour);
  style.ScaleAllSizes(scale);
  ImGui::GetStyle() = style;
}

Theme shown_theme() {
  // Text is pale in the dark theme.
  return ImGui::GetStyleColorVec4(ImGuiCol_Text).x > 0.5F ? Theme::kDark : Theme::kLight;
}

void write_labels(const std::vector<Label>& labels, const Camera& camera, Theme theme,
                  const ScreenPart& part) {
  const float margin = 0.5F * ImGui::GetFontSize();
  std::vector<ImVec4> written;  // left, top, right, bottom
  for (const Label& label : labels) {
    if ((label.p_W - camera.p_WEye()).dot(camera.towards_eye()) >= 0) continue;
    const Eigen::Vector2f at = camera.pixel(label.p_W, part.width, part.height).cast<float>();
    // To the left or right, where there is room: the arm is above.
    const double side = label.away_W.dot(camera.right());
    const Eigen::Vector2f away(side < -0.05 ? -1.0F : 1.0F, 0);
    const ImVec2 size = ImGui::CalcTextSize(label.text.c_str());
    const float x = std::clamp(at.x() + away.x() * (0.5F * size.x + 2.5F * margin) - 0.5F * size.x,
                               margin, part.width - size.x - margin);
    float y = std::clamp(at.y() + away.y() * (0.5F * size.y + margin) - 0.5F * size.y, margin,
                         part.height - size.y - margin);
    // Below the labels that it would cover: two arms may be at the same place.
    for (std::size_t i = 0; i < written.size(); ++i) {
      const auto covers = [&](const ImVec4& other) {
        return x < other.z && x + size.x > other.x && y < other.w && y + size.y > other.y;
      };
      const auto found = std::find_if(written.begin(), written.end(), covers);
      if (found == written.end()) break;
      y = found->w;
    }
    written.emplace_back(x, y, x + size.x, y + size.y);
    write_rimmed({std::round(part.x + x), std::round(part.y + y)}, theme,
                 text_colour(label.colour, theme), label.text);
  }
}

void write_caption(const std::string& text, Theme theme, const ScreenPart& part) {
  const float margin = 0.7F * ImGui::GetFontSize();
  write_rimmed({part.x + margin, part.y + part.height - margin - ImGui::GetFontSize()}, theme,
               colours_of(theme).quiet_text, text);
}

void fill_part(const ScreenPart& part, const Colour& colour) {
  ImGui::GetBackgroundDrawList()->AddRectFilled(
      {part.x, part.y}, {part.x + part.width, part.y + part.height}, packed(colour));
}

PictureText::PictureText(float scale, Theme theme) : context_(ImGui::CreateContext()) {
  ImGui::SetCurrentContext(context_);
  set_text_style(scale, theme);
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

}  // namespace thimble::view
