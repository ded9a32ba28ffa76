#pragma once

#include <string>
#include <vector>

#include "share/shared_reader.h"
#include "view/drawn_scene.h"
#include "view/playback/play_head.h"
#include "view/playback/plots.h"

namespace thimble::view {

struct Comparison;

/// The content of a window over time: live runs or a recording. Real-time: never from the servo
/// thread.
class TouchSource {
 public:
  virtual ~TouchSource() = default;

  /// Updates the moment after `dt` s of wall-clock time. Returns whether another touch was loaded,
  /// so that everything must be drawn again.
  virtual bool step(double dt) = 0;

  /// Returns the run, which may have ended; null if there is none, as in a recording.
  virtual session::SharedReader* reader() = 0;
  /// Returns the scene to draw. Precondition: `has_scene`; as for the moment.
  virtual const DrawnScene& scene() const = 0;
  virtual const DrawnMoment& moment() const = 0;
  virtual bool has_scene() const = 0;
  /// Returns whether there was a tick so far.
  virtual bool has_moment() const = 0;
  virtual const Plots& plots() const = 0;
  /// Returns why nothing moves; empty if something does.
  virtual const std::string& notice() const = 0;
  /// Returns the name used for its pictures.
  virtual std::string name() const = 0;

  /// Returns the position in time.
  virtual PlayHead& head() = 0;
  /// Returns the time (s) of the moment `steps` single steps after the shown one. A step is a tick
  /// of a recording, or a kept picture of a run.
  virtual double time_of_step(int steps) const = 0;
  /// Returns a sentence about the kept time.
  virtual std::string kept() const = 0;
  /// Returns sentences that describe a recording and what it lacks; empty for a run.
  virtual const std::vector<std::string>& about() const = 0;
  /// Returns the recordings and signals on one time line (compare/comparison.h); null if a run or
  /// one recording is shown.
  virtual Comparison* comparison() { return nullptr; }
};

}  // namespace thimble::view
