// Drawing of plots; their data are in plots.cpp.
#include <fmt/core.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "view/playback/plots.h"

namespace thimble::view {
namespace {

// Presentation of a channel.
struct ChannelLook {
  const char* name;
  Quantity quantity;
  const Colour& colour;
  bool from_zero;    // its axis begins at zero
  double min_range;  // minimum upper end of its axis, SI; chosen
};

const ChannelLook& look_of(Channel channel) {
  static const std::array<ChannelLook, kChannels> looks = {{
      {"force", Quantity::kForce, kForceColour, true, 1e-3},
      {"depth", Quantity::kLength, kDepthColour, true, 1e-6},
      {"time a tick computes", Quantity::kTime, kEdgePlaneColour, true, 10e-6},
      {"period", Quantity::kTime, kDepthColour, false, 20e-6},
      {"speed", Quantity::kSpeed, kEdgePlaneColour, true, 1e-4},
      {"x", Quantity::kLength, kTipColour, false, 1e-5},
      {"y", Quantity::kLength, kTipColour, false, 1e-5},
      {"z", Quantity::kLength, kTipColour, false, 1e-5},
  }};
  return looks[static_cast<std::size_t>(channel)];
}

ImU32 packed(const Colour& colour, float cover = 1) {
  return ImGui::ColorConvertFloat4ToU32({colour[0], colour[1], colour[2], cover});
}

// Returns a channel's colour in the current theme.
Colour shown(const Colour& colour) {
  return text_colour(colour, shown_theme());
}

// Returns the colour of text in the current theme.
Colour text_ink() {
  const ImVec4& ink = ImGui::GetStyleColorVec4(ImGuiCol_Text);
  return {ink.x, ink.y, ink.z};
}

float small_size() {
  return std::round(0.78F * ImGui::GetFontSize());
}

// Draws text in the size of axis numbers; `align` is the fraction of the text left of `x`.
void write_small(ImDrawList& list, float x, float y, float align, const std::string& text) {
  const float size = small_size();
  const float width = ImGui::GetFont()->CalcTextSizeA(size, 1e9F, 0, text.c_str()).x;
  list.AddText(ImGui::GetFont(), size, {std::round(x - align * width), std::round(y)},
               ImGui::GetColorU32(ImGuiCol_TextDisabled), text.c_str());
}

// Draws the title and, at the right, a value.
void write_title(ImDrawList& list, const ScreenPart& part, const std::string& title,
                 const std::string& value, const Colour& colour) {
  const float y = part.y + 0.1F * ImGui::GetFontSize();
  list.AddText({part.x, y}, ImGui::GetColorU32(ImGuiCol_Text), title.c_str());
  const float width = ImGui::CalcTextSize(value.c_str()).x;
  list.AddText({part.x + part.width - width, y}, packed(colour), value.c_str());
}

void draw_frame(ImDrawList& list, const ScreenPart& inner) {
  list.AddRectFilled({inner.x, inner.y}, {inner.x + inner.width, inner.y + inner.height},
                     ImGui::GetColorU32(ImGuiCol_PopupBg));
  list.AddLine({inner.x, inner.y + inner.height}, {inner.x + inner.width, inner.y + inner.height},
               packed(kGridColour));
  list.AddLine({inner.x, inner.y}, {inner.x, inner.y + inner.height}, packed(kGridColour));
}

// Draws the numbers of the left axis that fit; their unit is in the title.
void draw_left_axis(ImDrawList& list, const ScreenPart& inner, const AxisTicks& axis) {
  const float small = small_size();
  for (std::size_t i = 0; i < axis.count; ++i) {
    const auto share = static_cast<float>((axis.at(i) - axis.first) / (axis.last() - axis.first));
    const float y = inner.y + inner.height * (1 - share);
    if (i > 0) list.AddLine({inner.x, y}, {inner.x + inner.width, y}, packed(kGridColour, 0.25F));
    write_small(list, inner.x - 0.3F * small, y - 0.55F * small, 1, axis.text(i));
  }
}

void draw_time_axis(ImDrawList& list, const ScreenPart& inner, const TimeRange& range,
                    bool numbers) {
  const float small = small_size();
  const auto room = static_cast<std::size_t>(std::clamp(inner.width / (5.2F * small), 2.0F, 12.0F));
  const AxisTicks axis = ticks_within(range.begin, range.end, room);
  for (std::size_t i = 0; i < axis.count; ++i) {
    const auto share = static_cast<float>((axis.at(i) - range.begin) / range.width());
    const float x = inner.x + share * inner.width;
    list.AddLine({x, inner.y}, {x, inner.y + inner.height}, packed(kGridColour, 0.25F));
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
  list.AddLine({x, inner.y}, {x, inner.y + inner.height}, packed(colour), width);
}

}  // namespace

const char* name_of(Channel channel) noexcept {
  return look_of(channel).name;
}

ScreenPart Plots::lines_of(const ScreenPart& part, bool times) {
  const float title = 1.35F * ImGui::GetFontSize();
  const float left = 3.1F * small_size();
  const float below = (times ? 1.35F : 0.35F) * small_size();
  return {part.x + left, part.y + title, std::max(1.0F, part.width - left),
          std::max(1.0F, part.height - title - below)};
}

void Plots::draw_line(ImDrawList& list, const ScreenPart& inner, Channel channel,
                      const TimeRange& range, const AxisTicks& axis, double per_si) const {
  const double reach = axis.last() - axis.first;
  const auto y = [&](double value) {
    const double share = std::clamp((value * per_si - axis.first) / reach, 0.0, 1.0);
    return inner.y + inner.height * static_cast<float>(1 - share);
  };
  const ChannelLook& look = look_of(channel);
  const auto columns = static_cast<std::size_t>(std::max(1.0F, inner.width));
  // One more sample at each side, so that the line reaches the border.
  const std::size_t first = first_at(range.begin);
  const std::size_t last = first_at(range.end);
  std::vector<ImVec2> line;
  if (last - first < columns) {
    for (std::size_t i = first - std::min<std::size_t>(first, 1);
         i < std::min(last + 1, samples_.size()); ++i) {
      const double share = (samples_[i].time - range.begin) / range.width();
      line.push_back({inner.x + inner.width * static_cast<float>(share),
                      y(samples_[i].value[static_cast<std::size_t>(channel)])});
    }
  } else {
    // From the minimum to the maximum within each column of pixels, so that no spike is lost.
    std::size_t from = first;
    for (std::size_t i = 0; i < columns; ++i) {
      const double end =
          range.begin + range.width() * static_cast<double>(i + 1) / static_cast<double>(columns);
      const std::size_t to = first_at(end);
      const Extent spans = extent(channel, from, to);
      from = to;
      if (spans.empty()) continue;
      const float x = inner.x + static_cast<float>(i) + 0.5F;
      line.push_back({x, y(spans.min)});
      if (spans.max > spans.min) line.push_back({x, y(spans.max)});
      if (look.from_zero) {
        list.AddLine({x, inner.y + inner.height}, {x, y(spans.max)},
                     packed(shown(look.colour), 0.10F));
      }
    }
  }
  list.PushClipRect({inner.x, inner.y - 2}, {inner.x + inner.width, inner.y + inner.height + 2},
                    true);
  const float width = std::max(1.5F, ImGui::GetFontSize() / 9);
  list.AddPolyline(line.data(), static_cast<int>(line.size()), packed(shown(look.colour)), 0,
                   width);
  if (last - first < columns / 8) {
    for (const ImVec2& at : line)
      list.AddCircleFilled(at, 1.4F * width, packed(shown(look.colour)));
  }
  list.PopClipRect();
}

void Plots::draw(ImDrawList& list, const ScreenPart& part, Channel channel, const TimeRange& range,
                 const Marks& marks) const {
  const ChannelLook& look = look_of(channel);
  const ScreenPart inner = lines_of(part, marks.times);
  Extent extent = this->extent(channel, range);
  if (extent.empty()) extent = {0, 0};
  double min = look.from_zero ? 0 : static_cast<double>(extent.min);
  double max = std::max(static_cast<double>(extent.max), look.from_zero ? look.min_range : -1e9);
  if (look.from_zero && !(extent.max > 0)) max = 100 * look.min_range;  // no data yet
  if (max - min < look.min_range) {
    const double middle = 0.5 * (min + max);
    min = look.from_zero ? 0 : middle - 0.5 * look.min_range;
    max = min + look.min_range;
  }
  const ShownUnit unit = unit_for(look.quantity, std::max(std::abs(min), std::abs(max)));
  const auto room =
      static_cast<std::size_t>(std::clamp(inner.height / (1.5F * small_size()), 3.0F, 6.0F));
  const AxisTicks axis = ticks_around(min * unit.per_si, max * unit.per_si, room);
  draw_frame(list, inner);
  draw_left_axis(list, inner, axis);
  draw_time_axis(list, inner, range, marks.times);
  if (axis.count > 1) draw_line(list, inner, channel, range, axis, unit.per_si);
  if (marks.looked) draw_upright(list, inner, range, *marks.looked, kProxyColour, 2);
  const double shown_time =
      marks.cursor.value_or(marks.looked.value_or(std::min(range.end, kept().end)));
  if (marks.cursor) draw_upright(list, inner, range, *marks.cursor, text_ink(), 1);
  const auto value = value_at(channel, shown_time);
  std::string words;
  if (value)
    words = *value == 0 ? fmt::format("0 {}", unit.name) : with_unit(look.quantity, *value);
  write_title(list, part, fmt::format("{}, {}", look.name, unit.name), words, shown(look.colour));
}

void Plots::draw_periods(ImDrawList& list, const ScreenPart& part, const TimeRange& range,
                         std::int64_t period_ns) const {
  const double wanted = static_cast<double>(period_ns) * 1e-9;
  constexpr std::size_t kBins = 61;
  std::array<int, kBins> count{};
  const std::size_t from = first_at(range.begin);
  const std::size_t to = first_at(range.end);
  const auto period = [&](std::size_t i) {
    return static_cast<double>(samples_[i].value[static_cast<std::size_t>(Channel::kPeriod)]);
  };
  double reach = 0.02 * wanted;
  for (std::size_t i = from; i < to; ++i) {
    if (period(i) > 0) reach = std::max(reach, std::abs(period(i) - wanted));
  }
  reach = std::min(reach, wanted);
  for (std::size_t i = from; i < to; ++i) {
    if (!(period(i) > 0)) continue;
    const double share = 0.5 + 0.5 * (period(i) - wanted) / reach;
    const double last = kBins - 1;
    ++count[static_cast<std::size_t>(std::lround(std::clamp(share * last, 0.0, last)))];
  }
  const ScreenPart inner = lines_of(part, true);
  draw_frame(list, inner);
  write_title(list, part, "how often which period, us", "", text_ink());
  const AxisTicks axis = ticks_within(1e6 * (wanted - reach), 1e6 * (wanted + reach), 5);
  for (std::size_t i = 0; i < axis.count; ++i) {
    const auto share = static_cast<float>(0.5 + 0.5 * (1e-6 * axis.at(i) - wanted) / reach);
    write_small(list, inner.x + share * inner.width, inner.y + inner.height + 0.15F * small_size(),
                share < 0.04F   ? 0
                : share > 0.94F ? 1
                                : 0.5F,
                axis.text(i));
  }
  const int max = std::max(1, *std::max_element(count.begin(), count.end()));
  for (std::size_t i = 0; i < kBins; ++i) {
    if (count[i] == 0) continue;
    // Logarithmic: one late tick in ten thousand must be visible.
    const double share = (std::log(count[i]) + 1) / (std::log(max) + 1);
    const float width = inner.width / kBins;
    const float x = inner.x + width * static_cast<float>(i);
    const float top = inner.y + inner.height * static_cast<float>(1 - share);
    list.AddRectFilled({x, top}, {x + std::max(1.0F, width - 1), inner.y + inner.height},
                       packed(shown(kDepthColour), 0.8F));
  }
}

}  // namespace thimble::view
