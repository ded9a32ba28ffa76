#include "view/compare/run_list.h"

#include <fmt/core.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "view/compare/run_colours.h"
#include "view/number_text.h"
#include "view/playback/plot_parts.h"

namespace thimble::view {
namespace {

/// Returns a name with at most `max` characters: its end, which differs most often.
std::string shortened(const std::string& name, std::size_t max) {
  if (name.size() <= max) return name;
  return "..." + name.substr(name.size() - (max - 3));
}

std::string state_of(const ComparedRun& run) {
  if (run.ended) return fmt::format("ended at {:.3g} s", run.end);
  const auto& f = run.tick.f_sent_W;
  return force_text(std::hypot(f[0], f[1], f[2])) + "   " +
         length_text(run.tick.in_contact ? run.tick.depth : 0);
}

/// `below`: by how much the text of the row is lower than its top, pixels.
void draw_swatch(const Colour& colour, float below) {
  const float size = ImGui::GetFontSize();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float y = at.y + below;
  ImGui::GetWindowDrawList()->AddRectFilled(
      {at.x, y + 0.15F * size}, {at.x + 0.8F * size, y + 0.95F * size}, plot_colour(colour));
  ImGui::Dummy({0.8F * size, size});
  ImGui::SameLine(0, 0.4F * size);
}

}  // namespace

std::vector<Legend::Line> run_lines(const Comparison& comparison) {
  constexpr std::size_t kMax = 40;  // letters, of a picture's half. [chosen]
  std::vector<Legend::Line> lines;
  if (!comparison.several()) return lines;
  for (const ComparedRun& run : comparison.runs) {
    if (!run.in_picture) continue;
    lines.push_back({run.ended ? ended_colour(run.colour) : run.colour,
                     shortened(run.name, kMax) + (run.ended ? ", ended" : "")});
  }
  return lines;
}

void draw_run_list(Comparison& comparison) {
  const bool choose = comparison.scenes_differ();
  for (std::size_t i = 0; i < comparison.runs.size(); ++i) {
    const ComparedRun& run = comparison.runs[i];
    ImGui::PushID(static_cast<int>(i));
    if (choose) {
      if (ImGui::RadioButton("##scene", i == comparison.drawn)) comparison.wanted = i;
      if (ImGui::IsItemHovered()) ImGui::SetTooltip("Draws the scene of this recording");
      ImGui::SameLine(0, 0.4F * ImGui::GetFontSize());
    }
    // The colour of its curves, also after its end.
    draw_swatch(run.colour, choose ? ImGui::GetStyle().FramePadding.y : 0);
    if (choose) ImGui::AlignTextToFramePadding();
    const std::string state = state_of(run);
    const float right = ImGui::GetContentRegionMax().x - ImGui::CalcTextSize(state.c_str()).x;
    const float letter = ImGui::CalcTextSize("n").x;
    const float room = right - ImGui::GetCursorPosX() - ImGui::GetFontSize();
    const auto letters = static_cast<std::size_t>(std::max(6.0F, room / letter));
    ImGui::TextUnformatted(shortened(run.name, letters).c_str());
    if (ImGui::IsItemHovered() && run.name.size() > letters) {
      ImGui::SetTooltip("%s", run.name.c_str());
    }
    ImGui::SameLine();
    ImGui::SetCursorPosX(std::max(right, ImGui::GetCursorPosX()));
    ImGui::TextDisabled("%s", state.c_str());
    ImGui::PopID();
  }
  if (choose) ImGui::TextDisabled("The scenes differ: choose the one to draw.");
}

}  // namespace thimble::view
