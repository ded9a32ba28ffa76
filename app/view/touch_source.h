#pragma once

#include <string>
#include <vector>

#include "share/shared_reader.h"
#include "view/drawn_scene.h"
#include "view/playback/play_head.h"
#include "view/playback/plots.h"

namespace thimble::view {

/// What a window shows over time: runs that go on, or a recording. Real-time: never from the servo
/// thread.
class TouchSource {
 public:
  virtual ~TouchSource() = default;

  /// Brings the moment to what is to be shown after `dt` s of a person's time. Returns whether
  /// another touch was taken, so that all must be drawn anew.
  virtual bool step(double dt) = 0;

  /// Returns the run, which may have ended; null if there is none, as in a recording.
  virtual session::SharedReader* reader() = 0;
  /// Returns what is drawn. Precondition: `has_scene`; as for the moment.
  virtual const DrawnScene& scene() const = 0;
  virtual const DrawnMoment& moment() const = 0;
  virtual bool has_scene() const = 0;
  /// Returns whether there was a tick so far.
  virtual bool has_moment() const = 0;
  virtual const Plots& plots() const = 0;
  /// Returns why nothing moves; empty if it does.
  virtual const std::string& notice() const = 0;
  /// Returns what pictures of it are named by.
  virtual std::string name() const = 0;

  /// Returns where in time one looks.
  virtual PlayHead& head() = 0;
  /// Returns when the moment is that lies `steps` single steps after the one looked at, s: of a
  /// recording ticks, of a run pictures that are kept.
  virtual double beside(int steps) const = 0;
  /// Returns what of the time is kept, in a sentence.
  virtual std::string kept() const = 0;
  /// Returns what a recording is and what it does not know, a sentence each; none of a run.
  virtual const std::vector<std::string>& about() const = 0;
};

}  // namespace thimble::view
