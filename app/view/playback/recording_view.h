#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "share/shared_scene.h"
#include "thimble/driver/result.h"
#include "thimble/session/recording.h"
#include "view/drawn_scene.h"
#include "view/playback/plots.h"
#include "view/playback/shape_film.h"

namespace thimble::view {

/// A recording as it is drawn, at any of its ticks. The ticks are the recorded ones; where objects
/// were, how they were dented and shaped comes from a replay, since no recording tells it.
/// Real-time: never from the servo thread.
class RecordingView {
 public:
  /// Reads recordings, of a scene with several arms one of each, and lets their hands touch the
  /// scene again. The error says what a file is not, or what the scene lacks.
  static driver::Result<std::unique_ptr<RecordingView>> open(
      const std::vector<std::filesystem::path>& files);

  /// Returns what does not change.
  const DrawnScene& scene() const { return drawn_; }
  /// Returns the ticks of an arm of the scene, in its order. Not empty.
  std::span<const driver::TickRecord> ticks(std::size_t arm = 0) const { return arms_[arm].ticks; }
  std::size_t arms() const { return arms_.size(); }
  /// Returns when the first and the last tick were, s on the recorded loop's clock.
  TimeRange time() const;
  /// Returns when the tick was that is `steps` after the one of a time, s; the first or the last if
  /// there is none.
  double beside(double time, int steps) const;
  const Plots& plots() const { return plots_; }
  /// Returns what it is and what of it cannot be known, a sentence each.
  const std::vector<std::string>& about() const { return about_; }

  /// Brings `moment` to a time, s: to the last tick that is no later, or to the first. Objects are
  /// where they were then; between two pictures of the replay in proportion.
  void show(double time, DrawnMoment& moment) const;

 private:
  RecordingView() = default;
  driver::Result<void> touch_again();
  void tell(std::span<const session::Replay> replays);
  void show_bodies(std::int64_t time_ns, DrawnMoment& moment) const;
  void show_dent(std::int64_t time_ns, DrawnMoment& moment) const;

  std::vector<session::Recording> arms_;  // in the scene's order
  double rate_ = 1000;                    // Hz
  session::SharedScene shared_;
  DrawnScene drawn_;
  ShapeFilm film_;
  Plots plots_ = Plots::of_recording();
  std::vector<std::string> about_;
};

}  // namespace thimble::view
