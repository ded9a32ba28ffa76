#include "view/playback/plot_parts.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace thimble::view {

unsigned plot_colour(const Colour& colour, float cover) {
  return ImGui::ColorConvertFloat4ToU32({colour[0], colour[1], colour[2], cover});
}

Colour colour_in_theme(const Colour& colour) {
  return text_colour(colour, shown_theme());
}

Colour plot_ink() {
  const ImVec4& ink = ImGui::GetStyleColorVec4(ImGuiCol_Text);
  return {ink.x, ink.y, ink.z};
}

float small_text_size() {
  return std::round(0.78F * ImGui::GetFontSize());
}

void write_small(ImDrawList& list, float x, float y, float align, const std::string& text,
                 float x_min) {
  const float size = small_text_size();
  const float width = ImGui::GetFont()->CalcTextSizeA(size, 1e9F, 0, text.c_str()).x;
  list.AddText(ImGui::GetFont(), size,
               {std::round(std::max(x_min, x - align * width)), std::round(y)},
               ImGui::GetColorU32(ImGuiCol_TextDisabled), text.c_str());
}

void write_plot_title(ImDrawList& list, const ScreenPart& part, const std::string& title,
                      std::span<const TitleValue> values) {
  const float y = part.y + 0.1F * ImGui::GetFontSize();
  list.AddText({part.x, y}, ImGui::GetColorU32(ImGuiCol_Text), title.c_str());
  const float gap = ImGui::GetFontSize();
  const float left = part.x + ImGui::CalcTextSize(title.c_str()).x + 0.5F * gap;
  float all = -gap;
  std::size_t fit = 0;
  for (; fit < values.size(); ++fit) {
    const float width = gap + ImGui::CalcTextSize(values[fit].text.c_str()).x;
    if (fit > 0 && left + all + width > part.x + part.width) break;
    all += width;
  }
  float x = part.x + part.width - all;
  for (const TitleValue& value : values.first(fit)) {
    list.AddText({x, y}, plot_colour(value.colour), value.text.c_str());
    x += gap + ImGui::CalcTextSize(value.text.c_str()).x;
  }
}

void draw_plot_frame(ImDrawList& list, const ScreenPart& inner) {
  list.AddRectFilled({inner.x, inner.y}, {inner.x + inner.width, inner.y + inner.height},
                     ImGui::GetColorU32(ImGuiCol_PopupBg));
  list.AddLine({inner.x, inner.y + inner.height}, {inner.x + inner.width, inner.y + inner.height},
               plot_colour(kGridColour));
  list.AddLine({inner.x, inner.y}, {inner.x, inner.y + inner.height}, plot_colour(kGridColour));
}

void draw_left_axis(ImDrawList& list, const ScreenPart& inner, const AxisTicks& axis, float x_min) {
  const float small = small_text_size();
  for (std::size_t i = 0; i < axis.count; ++i) {
    const auto share = static_cast<float>((axis.at(i) - axis.first) / (axis.last() - axis.first));
    const float y = inner.y + inner.height * (1 - share);
    if (i > 0)
      list.AddLine({inner.x, y}, {inner.x + inner.width, y}, plot_colour(kGridColour, 0.25F));
    write_small(list, inner.x - 0.3F * small, y - 0.55F * small, 1, axis.text(i), x_min);
  }
}

void draw_time_axis(ImDrawList& list, const ScreenPart& inner, const TimeRange& range,
                    bool numbers) {
  const float small = small_text_size();
  const auto room = static_cast<std::size_t>(std::clamp(inner.width / (5.2F * small), 2.0F, 12.0F));
  const AxisTicks axis = ticks_within(range.begin, range.end, room);
  for (std::size_t i = 0; i < axis.count; ++i) {
    const auto share = static_cast<float>((axis.at(i) - range.begin) / range.width());
    const float x = inner.x + share * inner.width;
    list.AddLine({x, inner.y}, {x, inner.y + inner.height}, plot_colour(kGridColour, 0.25F));
    if (!numbers) continue;
    // The last number has the unit, and none extends beyond the plot.
    const std::string text = axis.text(i) + (i + 1 == axis.count ? " s" : "");
    const float align = share < 0.04F ? 0 : share > 0.94F ? 1 : 0.5F;
    write_small(list, x, inner.y + inner.height + 0.15F * small, align, text);
  }
}

void draw_upright(ImDrawList& list, const ScreenPart& inner, const TimeRange& range, double time,
                  const Colour& colour, float width) {
  if (!(time >= range.begin && time <= range.end)) return;
  const float x = inner.x + inner.width * static_cast<float>((time - range.begin) / range.width());
  list.AddLine({x, inner.y}, {x, inner.y + inner.height}, plot_colour(colour), width);
}

}  // namespace thimble::view
