#include "view/playback/curve_plot.h"

#include <fmt/core.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "view/playback/plot_parts.h"

namespace thimble::view {
namespace {

/// The unit of an axis, and how many of them one unit of the curve is.
struct AxisUnit {
  std::string name;
  double per_one = 1;
  std::string power{};  ///< Power of ten of an own signal's numbers: "e-6"; empty: none.
};

/// Returns a unit in which numbers up to `max` have at most four digits before the point, and one
/// that is not 0.
AxisUnit axis_unit(const CurveLook& look, double max) {
  if (look.quantity) {
    const ShownUnit unit = unit_for(*look.quantity, max);
    return {unit.name, unit.per_si};
  }
  if (max == 0 || (max >= 0.01 && max < 1e4)) return {look.unit, 1};
  const int power = 3 * static_cast<int>(std::floor(std::log10(max) / 3));
  return {fmt::format("1e{}{}{}", power, look.unit.empty() ? "" : " ", look.unit),
          std::pow(10.0, -power), fmt::format("e{}", power)};
}

std::string value_text(const CurveLook& look, const AxisUnit& unit, double value) {
  if (!look.quantity) {
    const double shown = value * unit.per_one;
    const int digits = std::abs(shown) < 100 ? 3 : 6;
    return fmt::format("{:.{}g}{}{}{}", shown, digits, unit.power, look.unit.empty() ? "" : " ",
                       look.unit);
  }
  return value == 0 ? fmt::format("0 {}", unit.name) : with_unit(*look.quantity, value);
}

Extent extent_of_all(std::span<const DrawnCurve> curves, const TimeRange& range) {
  Extent extent;
  for (const DrawnCurve& one : curves) extent.add(one.curve->extent(range));
  if (extent.empty()) extent = {0, 0};
  return extent;
}

/// Returns the range of values of the axis.
std::pair<double, double> shown_values(const CurveLook& look, const Extent& extent) {
  double min = look.from_zero ? 0 : static_cast<double>(extent.min);
  double max = std::max(static_cast<double>(extent.max), look.from_zero ? look.min_range : -1e39);
  if (look.from_zero && !(extent.max > 0)) max = 100 * look.min_range;  // no data yet
  double least = look.min_range;
  if (!look.quantity) {  // relative, because its size is unknown; single precision has 7 digits
    const double size = std::max(std::abs(min), std::abs(max));
    least = max > min ? 1e-5 * size : size > 0 ? 0.1 * size : 1;
  }
  if (max - min < least) {
    const double middle = 0.5 * (min + max);
    min = look.from_zero ? 0 : middle - 0.5 * least;
    max = min + least;
  }
  return {min, max};
}

/// A plot's area and axes, to draw lines into.
struct LinePlace {
  ScreenPart inner;
  TimeRange range;
  AxisTicks axis;
  double per_one;

  float x(double time) const {
    return inner.x + inner.width * static_cast<float>((time - range.begin) / range.width());
  }
  float y(double value) const {
    const double reach = axis.last() - axis.first;
    const double share = std::clamp((value * per_one - axis.first) / reach, 0.0, 1.0);
    return inner.y + inner.height * static_cast<float>(1 - share);
  }
};

/// Draws a line in several strokes: one that turned back sharply, as noise does in each column,
/// would have joints that are longer than its segments.
void draw_strokes(ImDrawList& list, const std::vector<ImVec2>& line, ImU32 colour, float width) {
  std::size_t begin = 0;
  for (std::size_t i = 1; i < line.size(); ++i) {
    const bool is_last = i + 1 == line.size();
    if (!is_last) {
      const ImVec2 in{line[i].x - line[i - 1].x, line[i].y - line[i - 1].y};
      const ImVec2 out{line[i + 1].x - line[i].x, line[i + 1].y - line[i].y};
      if (in.x * out.x + in.y * out.y >= 0) continue;
    }
    list.AddPolyline(&line[begin], static_cast<int>(i - begin + 1), colour, 0, width);
    begin = i;
  }
}

void draw_curve_line(ImDrawList& list, const LinePlace& place, const DrawnCurve& drawn,
                     bool filled) {
  const Curve& curve = *drawn.curve;
  const ScreenPart& inner = place.inner;
  const Colour colour = colour_in_theme(drawn.colour);
  const auto columns = static_cast<std::size_t>(std::max(1.0F, inner.width));
  // One more sample at each side, so that the line reaches the border.
  const std::size_t first = curve.first_at(place.range.begin);
  const std::size_t last = curve.first_at(place.range.end);
  std::vector<ImVec2> line;
  if (last - first < columns) {
    for (std::size_t i = first - std::min<std::size_t>(first, 1);
         i < std::min(last + 1, curve.size()); ++i) {
      line.push_back({place.x(curve.time(i)), place.y(static_cast<double>(curve.value(i)))});
    }
  } else {
    // From the minimum to the maximum within each column of pixels, so that no spike is lost.
    std::size_t from = first;
    for (std::size_t i = 0; i < columns; ++i) {
      const double end = place.range.begin + place.range.width() * static_cast<double>(i + 1) /
                                                 static_cast<double>(columns);
      const std::size_t to = curve.first_at(end);
      const Extent spans = curve.extent(from, to);
      from = to;
      if (spans.empty()) continue;
      const float x = inner.x + static_cast<float>(i) + 0.5F;
      const float top = place.y(static_cast<double>(spans.max));
      const float bottom = place.y(static_cast<double>(spans.min));
      // First the end that is nearer to the line, so that it turns back as seldom as possible.
      const bool from_top =
          !line.empty() && std::abs(line.back().y - top) < std::abs(line.back().y - bottom);
      line.push_back({x, from_top ? top : bottom});
      if (spans.max > spans.min) line.push_back({x, from_top ? bottom : top});
      if (filled) list.AddLine({x, inner.y + inner.height}, {x, top}, plot_colour(colour, 0.10F));
    }
  }
  list.PushClipRect({inner.x, inner.y - 2}, {inner.x + inner.width, inner.y + inner.height + 2},
                    true);
  const float width = std::max(1.5F, ImGui::GetFontSize() / 9);
  draw_strokes(list, line, plot_colour(colour), width);
  if (last - first < columns / 8) {
    for (const ImVec2& at : line) list.AddCircleFilled(at, 1.4F * width, plot_colour(colour));
  }
  list.PopClipRect();
}

}  // namespace

ScreenPart lines_of(const ScreenPart& part, bool times) {
  const float title = 1.35F * ImGui::GetFontSize();
  const float left = 3.1F * small_text_size();
  const float below = (times ? 1.35F : 0.35F) * small_text_size();
  return {part.x + left, part.y + title, std::max(1.0F, part.width - left),
          std::max(1.0F, part.height - title - below)};
}

void draw_curves(ImDrawList& list, const ScreenPart& part, const CurveLook& look,
                 std::span<const DrawnCurve> curves, const TimeRange& range,
                 const PlotMarks& marks) {
  const ScreenPart inner = lines_of(part, marks.times);
  const auto [min, max] = shown_values(look, extent_of_all(curves, range));
  const AxisUnit unit = axis_unit(look, std::max(std::abs(min), std::abs(max)));
  const auto room =
      static_cast<std::size_t>(std::clamp(inner.height / (1.5F * small_text_size()), 3.0F, 6.0F));
  const AxisTicks axis = ticks_around(min * unit.per_one, max * unit.per_one, room);
  draw_plot_frame(list, inner);
  draw_left_axis(list, inner, axis, part.x);
  draw_time_axis(list, inner, range, marks.times);
  if (axis.count > 1) {
    const LinePlace place{inner, range, axis, unit.per_one};
    for (const DrawnCurve& one : curves) {
      draw_curve_line(list, place, one, look.from_zero && curves.size() == 1);
    }
  }
  if (marks.looked) draw_upright(list, inner, range, *marks.looked, kProxyColour, 2);
  if (marks.cursor) draw_upright(list, inner, range, *marks.cursor, plot_ink(), 1);
  std::vector<TitleValue> values;
  for (const DrawnCurve& one : curves) {
    const std::size_t count = one.curve->size();
    const double newest = count == 0 ? range.end : one.curve->time(count - 1);
    const double time = marks.cursor.value_or(marks.looked.value_or(std::min(range.end, newest)));
    if (const auto value = one.curve->value_at(time)) {
      values.push_back({value_text(look, unit, *value), colour_in_theme(one.colour)});
    }
  }
  const std::string title =
      unit.name.empty() ? look.name : fmt::format("{}, {}", look.name, unit.name);
  write_plot_title(list, part, title, values);
}

}  // namespace thimble::view
