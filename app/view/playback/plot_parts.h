#pragma once

#include <span>
#include <string>

#include "view/gl/palette.h"
#include "view/playback/axis_ticks.h"
#include "view/playback/curve.h"
#include "view/text_style.h"

struct ImDrawList;

namespace thimble::view {

// The parts of which plots consist. Call between ImGui's NewFrame and Render. Real-time: never from
// the servo thread.

/// Returns a colour as ImGui stores it; `cover`: opacity.
unsigned plot_colour(const Colour& colour, float cover = 1);
/// Returns the colour of a line or text in the theme of the current context.
Colour colour_in_theme(const Colour& colour);
/// Returns the colour of text in the current theme.
Colour plot_ink();

/// Returns the size of the numbers at axes, pixels.
float small_text_size();
/// Draws text in that size; `align` is the fraction of the text left of `x`. It does not begin
/// before `x_min`.
void write_small(ImDrawList& list, float x, float y, float align, const std::string& text,
                 float x_min = 0);

/// A value in the title of a plot.
struct TitleValue {
  std::string text;
  Colour colour{};
};

/// Draws the title and, at the right, values, of which only those have a place that fit.
void write_plot_title(ImDrawList& list, const ScreenPart& part, const std::string& title,
                      std::span<const TitleValue> values);

/// Draws ground, lower and left border of the area of the lines.
void draw_plot_frame(ImDrawList& list, const ScreenPart& inner);
/// Draws the numbers of the left axis; their unit is in the title. `x_min`: left border.
void draw_left_axis(ImDrawList& list, const ScreenPart& inner, const AxisTicks& axis, float x_min);
/// Draws the lines of the time axis, and its numbers if wanted.
void draw_time_axis(ImDrawList& list, const ScreenPart& inner, const TimeRange& range,
                    bool numbers);
/// Draws an upright line at a time, if it is within the range.
void draw_upright(ImDrawList& list, const ScreenPart& inner, const TimeRange& range, double time,
                  const Colour& colour, float width);

}  // namespace thimble::view
