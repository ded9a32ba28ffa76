#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <string>

#include "view/compare/comparison.h"
#include "view/playback/plots.h"

namespace thimble::view {

/// The time that plots show.
struct PlotTime {
  std::optional<double> looked;        ///< The moment that is shown, s; none: the newest of a run.
  bool recorded = false;               ///< The data are a complete recording.
  std::int64_t period_ns = 1'000'000;  ///< Period of the loop.
  double duration = 0;                 ///< Planned duration of the run, s; 0: unknown.
  /// Several recordings and own signals, drawn instead of the plots of one run; null: none.
  const Comparison* compared = nullptr;
};

/// Plots below each other over the same time: mouse actions apply to all of them.
///
/// Over a plot: the value at the mouse is shown in all plots; wheel: zoom; left drag: zoom to that
/// part; right drag: move; double click: show all; click: go to that moment. Real-time: never from
/// the servo thread.
class PlotPanel {
 public:
  /// Draws the chosen plots into the current ImGui window, at most `height` pixels high; without
  /// room for all, only the first. Returns the time that was clicked, s.
  std::optional<double> draw(const Plots& plots, const PlotTime& time, float height);

  /// Shows or hides a channel.
  void show(Channel channel, bool shown) { shown_[static_cast<std::size_t>(channel)] = shown; }
  bool shows(Channel channel) const { return shown_[static_cast<std::size_t>(channel)]; }
  /// Returns the visible range of time: the zoomed part; otherwise the whole duration of a run or
  /// recording. Of a run that is longer than the plots keep, it is the newest part.
  TimeRange range(const Plots& plots, const PlotTime& time) const;
  bool is_zoomed() const { return zoom_.has_value(); }

 private:
  /// One plot: a channel, or an own signal.
  struct Row {
    Channel channel = Channel::kForce;
    const ComparedSignal* signal = nullptr;  // null: the channel
  };
  std::vector<Row> rows(const PlotTime& time) const;
  bool shows_periods(const PlotTime& time) const;
  void draw_choice(const PlotTime& time);
  void draw_row(const Plots& plots, const PlotTime& time, const ScreenPart& part, const Row& row,
                int id, bool last);
  void use_mouse(const ScreenPart& inner, const TimeRange& range, const TimeRange& all);

  std::array<bool, kChannels> shown_{true, true, true, false, false, false, false, false};
  std::set<std::string> hidden_;  // names of own signals
  bool periods_ = true;
  std::optional<TimeRange> zoom_;
  std::optional<double> cursor_, next_cursor_;  // s; cursor of the last picture and of this one
  std::optional<double> drag_from_;             // s: start of a drag that selects a part
  std::optional<double> asked_;                 // time that was clicked, s
};

}  // namespace thimble::view
