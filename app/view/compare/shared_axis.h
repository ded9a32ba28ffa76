#pragma once

#include <cstddef>
#include <vector>

#include "view/playback/curve.h"

namespace thimble::view {

/// One time axis of several recordings, s. Its zero is the first tick of each of them; it ends with
/// the longest recording or signal. Pure: independent of drawing and files.
class SharedAxis {
 public:
  /// Adds a recording by the times of its first and its last tick on the clock of its loop.
  void add_run(const TimeRange& on_its_clock);
  /// Adds a signal by the time of its last value on this axis.
  void add_signal(double end);

  std::size_t runs() const { return runs_.size(); }
  /// Returns the whole axis, from 0.
  TimeRange span() const { return {0, end_}; }
  /// Returns the time of a recording's last tick on this axis.
  double end_of(std::size_t run) const { return runs_[run].width(); }
  /// Returns whether a recording has ended at a time: the time is later than its last tick by more
  /// than a nanosecond, the resolution of the ticks.
  bool has_ended(std::size_t run, double time) const;
  /// Returns the time on the clock of a recording: that of its last tick if it has ended.
  double time_in(std::size_t run, double time) const;
  /// Returns the time on this axis of a time on the clock of a recording.
  double time_of(std::size_t run, double on_its_clock) const {
    return on_its_clock - runs_[run].begin;
  }
  /// Returns by how much a recording's clock is later than this axis, s.
  double offset_of(std::size_t run) const { return runs_[run].begin; }
  /// Returns the recording with the latest last tick; the first of several. Precondition: one was
  /// added.
  std::size_t longest() const;

 private:
  std::vector<TimeRange> runs_;
  double end_ = 0;
};

}  // namespace thimble::view
