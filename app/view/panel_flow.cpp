#include "view/panel_flow.h"

namespace thimble::app::view {

ImVec4 shown_colour(const Colour& colour) {
  // Text is pale on the dark theme.
  const bool dark = ImGui::GetStyleColorVec4(ImGuiCol_Text).x > 0.5F;
  const Colour text = text_colour(colour, dark ? Theme::kDark : Theme::kLight);
  return {text[0], text[1], text[2], 1};
}

void Flow::next(float width) {
  const float end = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
  const float begin = ImGui::GetItemRectMax().x + ImGui::GetStyle().ItemSpacing.x;
  if (!first_ && begin + width <= end) ImGui::SameLine();
  first_ = false;
}

void Flow::value(const Colour& colour, const std::string& text, const char* widest) {
  const float width = ImGui::CalcTextSize(widest).x;
  next(width);
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + width - ImGui::CalcTextSize(text.c_str()).x);
  ImGui::TextColored(shown_colour(colour), "%s", text.c_str());
}

}  // namespace thimble::app::view
