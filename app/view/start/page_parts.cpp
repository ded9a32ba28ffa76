#include "view/start/page_parts.h"

#include "view/gl/palette.h"
#include "view/text_style.h"

namespace thimble::view {

void begin_page(const char* name) {
  const ThemeColours colours = colours_of(shown_theme());
  ImGui::PushStyleColor(ImGuiCol_WindowBg,
                        ImVec4(colours.sky[0], colours.sky[1], colours.sky[2], 1));
  ImGui::Begin(name, nullptr, kPageFlags);
}

void end_page() {
  ImGui::End();
  ImGui::PopStyleColor();
}

void write_title(const char* text) {
  const auto& fonts = ImGui::GetIO().Fonts->Fonts;
  if (fonts.Size > 1) ImGui::PushFont(fonts[1]);
  ImGui::TextUnformatted(text);
  if (fonts.Size > 1) ImGui::PopFont();
}

float main_button_height() {
  return 2.1F * ImGui::GetFontSize();  // [chosen: twice a line, so that it is found first]
}

bool main_button(const char* label, float width) {
  const auto tinted = [](float share) {
    return ImVec4(kDepthColour[0], kDepthColour[1], kDepthColour[2], share);
  };
  ImGui::PushStyleColor(ImGuiCol_Button, tinted(1));
  ImGui::PushStyleColor(ImGuiCol_ButtonHovered, tinted(0.88F));
  ImGui::PushStyleColor(ImGuiCol_ButtonActive, tinted(0.76F));
  ImGui::PushStyleColor(ImGuiCol_Text, {1, 1, 1, 1});
  const bool pressed = ImGui::Button(label, {width, main_button_height()});
  ImGui::PopStyleColor(4);
  return pressed;
}

}  // namespace thimble::view
