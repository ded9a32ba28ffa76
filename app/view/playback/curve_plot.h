#pragma once

#include <optional>
#include <span>
#include <string>

#include "view/gl/palette.h"
#include "view/playback/axis_ticks.h"
#include "view/playback/curve.h"
#include "view/text_style.h"

struct ImDrawList;

namespace thimble::view {

/// How the curves of one plot are drawn.
struct CurveLook {
  std::string name;
  std::optional<Quantity> quantity;  ///< None: an own signal, in `unit`.
  std::string unit;                  ///< Of an own signal; empty: none.
  bool from_zero = false;            ///< The axis begins at zero.
  double min_range = 0;              ///< Minimum upper end or length of the axis.
};

/// A curve of a plot, and its colour.
struct DrawnCurve {
  const Curve* curve = nullptr;
  Colour colour{};
};

/// Marks in a plot in addition to its lines.
struct PlotMarks {
  std::optional<double> cursor;  ///< Time of the mouse, s, whose value is shown.
  std::optional<double> looked;  ///< The moment that is shown, s.
  bool times = true;             ///< Whether the numbers of the time axis are drawn.
};

/// Returns the area of the lines in `part`: right of the numbers, below the title. `times` as in
/// PlotMarks.
ScreenPart lines_of(const ScreenPart& part, bool times);

/// Draws curves over each other over a range of time, on one axis, with numbers, and the value of
/// each at the cursor, or the newest value of the range. No peak of a single sample is lost. Call
/// between ImGui's NewFrame and Render. Real-time: never from the servo thread.
void draw_curves(ImDrawList& list, const ScreenPart& part, const CurveLook& look,
                 std::span<const DrawnCurve> curves, const TimeRange& range,
                 const PlotMarks& marks);

}  // namespace thimble::view
