#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "thimble/driver/result.h"
#include "view/compare/comparison.h"
#include "view/compare/shared_axis.h"
#include "view/drawn_scene.h"
#include "view/playback/recording_view.h"

namespace thimble::view {

/// Files to show on one time line.
struct ComparedFiles {
  std::vector<std::filesystem::path> recordings;  ///< At least one.
  std::vector<std::filesystem::path> signals;
  std::filesystem::path scene_of;  ///< The recording whose scene is drawn; empty: the first.
};

/// Several recordings and own signals on one time line, as moments to draw. In the picture are the
/// objects of one recording, and the arms of all recordings whose scenes have the same objects.
/// Memory: that of each recording alone, together. Real-time: never from the servo thread.
class RecordedRuns {
 public:
  /// Reads the files and replays the recordings. Recordings of several arms of a scene are one run.
  /// The error names the file, the problem and the remedy.
  static driver::Result<std::unique_ptr<RecordedRuns>> open(const ComparedFiles& files);

  std::size_t size() const { return views_.size(); }
  const RecordingView& run(std::size_t i) const { return *views_[i]; }
  const SharedAxis& axis() const { return axis_; }
  /// Returns the scene that is drawn.
  const DrawnScene& scene() const { return views_[comparison_.drawn]->scene(); }
  /// Returns the content of the time line; its moment is that of the last `show`.
  Comparison& comparison() { return comparison_; }
  const Comparison& comparison() const { return comparison_; }
  /// Returns sentences about the drawn recording and the others.
  const std::vector<std::string>& about() const { return about_; }
  /// Returns sentences about recordings whose arms are not drawn, for the terminal; may be empty.
  const std::vector<std::string>& warnings() const { return warnings_; }

  /// Draws the scene of another run from now on.
  void draw_scene_of(std::size_t run);
  /// Sets `moment` to a time of the time line, s, and updates the comparison. A run that has ended
  /// stands at its last tick, without force.
  void show(double time, DrawnMoment& moment);
  /// Returns the time (s) of the tick `steps` after the one at a time: a tick of the drawn run
  /// while it lasts, then of the longest one, then a period.
  double time_of_step(double time, int steps) const;

 private:
  RecordedRuns() = default;
  driver::Result<void> open_runs(const std::vector<std::filesystem::path>& files,
                                 std::vector<session::Recording> recordings,
                                 const std::vector<std::vector<std::size_t>>& runs);
  driver::Result<void> take_signals(std::vector<OwnSignals> files);

  std::vector<std::unique_ptr<RecordingView>> views_;
  SharedAxis axis_;
  Comparison comparison_;
  std::vector<std::string> about_, warnings_, signal_notes_;
};

}  // namespace thimble::view
