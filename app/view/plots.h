#pragma once

#include <cstdint>
#include <deque>

#include "thimble/driver/tick_record.h"
#include "thimble/session/histogram.h"
#include "view/text_style.h"

struct ImDrawList;

namespace thimble::app::view {

/// Keeps the last seconds of a run and draws them over time, into a part of the screen.
/// Real-time: never from the servo thread.
class Plots {
 public:
  static constexpr double kSeconds = 8;  ///< What is kept and shown.

  /// Takes one tick; one that is older than the last begins anew.
  void add(const driver::TickRecord& tick);
  void clear();

  // To be called between ImGui's NewFrame and Render.

  /// Draws the force on the hand (N), up to its limit if it comes near.
  void draw_force(ImDrawList& list, const ScreenPart& part, double force_limit) const;
  /// Draws how deep the tip is (mm).
  void draw_depth(ImDrawList& list, const ScreenPart& part) const;
  /// Draws how long ticks computed (us): nothing where time is virtual.
  void draw_work(ImDrawList& list, const ScreenPart& part) const;
  /// Draws how often periods lasted how long about the wanted one (ns).
  void draw_periods(ImDrawList& list, const ScreenPart& part, std::int64_t period_ns) const;

 private:
  struct Sample {
    double time;   // s
    float force;   // N
    float depth;   // mm
    float work;    // us
    float period;  // us
  };
  struct Look;
  void draw_line(ImDrawList& list, const ScreenPart& part, const Look& look,
                 float Sample::*value) const;

  std::deque<Sample> samples_;
};

}  // namespace thimble::app::view
