#include "view/knob_panel.h"

#include <fmt/core.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "view/number_text.h"

namespace thimble::view {
namespace {

/// The display unit of a knob: one for all its values, so that it does not change during a drag.
ReadUnit unit_of(const session::SharedScene::Knob& knob) {
  ReadUnit unit = read_unit(knob.unit, std::max(std::abs(knob.min), std::abs(knob.max)));
  if (unit.name == nullptr) unit.name = knob.unit.c_str();
  return unit;
}

}  // namespace

bool knob_slider(const session::SharedScene::Knob& knob, double& value) {
  const ReadUnit unit = unit_of(knob);
  const double least = knob.min / unit.size;
  const double most = knob.max / unit.size;
  // A range of more than two powers of ten gets a logarithmic slider. ImGui rounds values below the
  // last digit of the format to zero, so the format has enough digits for the smallest.
  const bool wide = least > 0 && most > 100 * least;
  const int digits = wide ? std::max(4, static_cast<int>(std::ceil(1 - std::log10(least)))) : 4;
  const std::string format = "%." + std::to_string(digits) + "g";
  double shown = value / unit.size;
  // The value is above the slider. In the slider it is shown only while it is typed.
  const bool typed = ImGui::TempInputIsActive(ImGui::GetID("##value"));
  if (!typed) ImGui::PushStyleColor(ImGuiCol_Text, 0);
  const bool turned = ImGui::SliderScalar(
      "##value", ImGuiDataType_Double, &shown, &least, &most, format.c_str(),
      ImGuiSliderFlags_AlwaysClamp | (wide ? ImGuiSliderFlags_Logarithmic : ImGuiSliderFlags_None));
  if (!typed) ImGui::PopStyleColor();
  if (!typed && ImGui::IsItemHovered() && !ImGui::IsItemActive()) {
    ImGui::SetTooltip("%.4g to %.4g %s; ctrl-click to type", least, most, unit.name);
  }
  if (turned) value = std::clamp(shown * unit.size, knob.min, knob.max);
  return turned;
}

std::string knob_text(const session::SharedScene::Knob& knob, double value) {
  const ReadUnit unit = unit_of(knob);
  return fmt::format("{:.4g}{}{}", value / unit.size, *unit.name == 0 ? "" : " ", unit.name);
}

void draw_knobs(session::SharedReader& reader) {
  const auto& knobs = reader.scene().knobs;
  if (knobs.empty()) {
    ImGui::TextDisabled("This run has no knobs.");
    return;
  }
  for (std::size_t i = 0; i < knobs.size(); ++i) {
    const session::SharedScene::Knob& knob = knobs[i];
    ImGui::PushID(static_cast<int>(i));
    double value = reader.knob_wanted(i);
    const std::string text = knob_text(knob, value);
    const float width = ImGui::GetContentRegionAvail().x;
    const float text_width = ImGui::CalcTextSize(text.c_str()).x;
    const float name_width = ImGui::CalcTextSize(knob.name.c_str(), nullptr, false, width).x;
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(knob.name.c_str());
    ImGui::PopTextWrapPos();
    // At the right end, where changing digits move nothing; below a name that is too long.
    const float end = ImGui::GetCursorPosX() + width;
    if (name_width + text_width + ImGui::GetFontSize() < width) ImGui::SameLine();
    ImGui::SetCursorPosX(end - text_width);
    ImGui::TextUnformatted(text.c_str());
    const float reset = ImGui::CalcTextSize("reset").x + 2 * ImGui::GetStyle().FramePadding.x;
    ImGui::SetNextItemWidth(-reset - ImGui::GetStyle().ItemSpacing.x);
    if (knob_slider(knob, value)) reader.turn_knob(i, value);
    ImGui::SameLine();
    if (ImGui::Button("reset")) reader.turn_knob(i, knob.initial);
    ImGui::PopID();
  }
}

}  // namespace thimble::view
