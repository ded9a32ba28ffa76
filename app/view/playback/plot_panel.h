#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "view/playback/plots.h"

namespace thimble::view {

/// When it is that plots are looked at.
struct PlotTime {
  std::optional<double> looked;  ///< The moment that is looked at, s; none: the newest of a run.
  bool recorded = false;         ///< All of a recording is there at once.
  std::int64_t period_ns = 1'000'000;  ///< Of the loop.
};

/// Plots under one another over the same time: what the mouse does to one it does to all.
///
/// Over a plot: the value at the mouse is told in all of them; wheel: closer and farther; left
/// drag: that part alone; right drag: along; double click: all of it again; click: that moment is
/// looked at. Real-time: never from the servo thread.
class PlotPanel {
 public:
  /// Draws what is chosen into the current ImGui window, `height` pixels high at most: where there
  /// is no room for all, the first. Returns the time that a click asks to be looked at, s.
  std::optional<double> draw(const Plots& plots, const PlotTime& time, float height);

  /// Shows a channel, or leaves it out.
  void show(Channel channel, bool shown) { shown_[static_cast<std::size_t>(channel)] = shown; }
  bool shows(Channel channel) const { return shown_[static_cast<std::size_t>(channel)]; }
  /// Returns what is shown of the time: what was zoomed to, else the newest of a run, or all.
  TimeRange range(const Plots& plots, const PlotTime& time) const;
  bool is_zoomed() const { return zoom_.has_value(); }

 private:
  void draw_choice();
  void draw_one(const Plots& plots, const PlotTime& time, const ScreenPart& part, Channel channel,
                bool last);
  void use_mouse(const ScreenPart& inner, const TimeRange& range, const TimeRange& all);

  std::array<bool, kChannels> shown_{true, true, true, false, false, false, false, false};
  bool periods_ = true;
  std::optional<TimeRange> zoom_;
  std::optional<double> cursor_, next_cursor_;  // s; of the picture before, and of this one
  std::optional<double> drag_from_;             // s: a part is being chosen
  std::optional<double> asked_;                 // s
};

}  // namespace thimble::view
