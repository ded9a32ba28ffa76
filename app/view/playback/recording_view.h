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
#include "view/playback/shape_animation.h"

namespace thimble::view {

/// Reads recordings. The error describes an invalid file, or one without ticks. Real-time: never
/// from the servo thread.
driver::Result<std::vector<session::Recording>> read_recordings(
    const std::vector<std::filesystem::path>& files);

/// A recording to draw, at any of its ticks. The ticks are the recorded ones. Poses, dents and
/// shapes of objects come from a replay, because recordings do not contain them. Real-time: never
/// from the servo thread.
class RecordingView {
 public:
  /// Reads recordings, one per arm of the scene, and replays their touches of the scene. The error
  /// describes an invalid file or what the scene lacks.
  static driver::Result<std::unique_ptr<RecordingView>> open(
      const std::vector<std::filesystem::path>& files);
  /// Takes recordings that were read; otherwise as `open`.
  static driver::Result<std::unique_ptr<RecordingView>> of(
      std::vector<session::Recording> recordings);

  /// Returns the constant part of the scene.
  const DrawnScene& scene() const { return drawn_; }
  /// Returns the ticks of an arm of the scene, in its order. Not empty.
  std::span<const driver::TickRecord> ticks(std::size_t arm = 0) const { return arms_[arm].ticks; }
  std::size_t arms() const { return arms_.size(); }
  /// Returns the times of the first and the last tick, s on the recorded loop's clock.
  TimeRange time() const;
  /// Returns the time (s) of the tick `steps` after the one at a time, clamped to the first and the
  /// last.
  double time_of_step(double time, int steps) const;
  /// Returns the tick of the first arm that `show` shows at a time, s.
  const driver::TickRecord& tick_at_time(double time) const;
  const Plots& plots() const { return plots_; }
  /// Returns a description of the recording and what it lacks, a sentence each.
  const std::vector<std::string>& about() const { return about_; }

  /// Sets `moment` to a time, s: to the last tick that is no later, or to the first. Poses of
  /// objects are interpolated between two pictures of the replay.
  void show(double time, DrawnMoment& moment) const;
  /// Appends the arms at a time, s, without the objects.
  void add_arms(double time, std::vector<DrawnArm>& arms) const;

 private:
  RecordingView() = default;
  driver::Result<void> touch_again();
  void describe(std::span<const session::Replay> replays);
  void show_bodies(std::int64_t time_ns, DrawnMoment& moment) const;
  void show_dent(std::int64_t time_ns, DrawnMoment& moment) const;
  DrawnArm arm_at(std::size_t arm, std::int64_t time_ns) const;

  std::vector<session::Recording> arms_;  // in the scene's order
  double rate_ = 1000;                    // Hz
  session::SharedScene shared_;
  DrawnScene drawn_;
  ShapeAnimation film_;
  Plots plots_ = Plots::of_recording();
  std::vector<std::string> about_;
};

}  // namespace thimble::view
