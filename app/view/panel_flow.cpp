#include "view/panel_flow.h"

#include "view/text_style.h"

namespace thimble::view {

ImVec4 shown_colour(const Colour& colour) {
  const Colour text = text_colour(colour, shown_theme());
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

}  // namespace thimble::view
