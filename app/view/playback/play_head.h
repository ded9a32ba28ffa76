#pragma once

namespace thimble::view {

/// Where on a line of time one looks, s: at the newest moment of a run, at one of its last, or at
/// one of a recording. Knows no picture and no clock. Real-time: never from the servo thread.
class PlayHead {
 public:
  static constexpr double kSlowest = 0.1;  ///< Of the speeds, as shares of the time that was.
  static constexpr double kFastest = 4;    ///< As above.

  /// Looks along a run that goes on: first at what is newest.
  static PlayHead of_run() { return PlayHead(true); }
  /// Looks along a recording: first at its begin, and plays.
  static PlayHead of_recording() { return PlayHead(false); }

  /// Says from when until when there are moments. The first span of a recording takes the head to
  /// its begin; a head that moments have been lost from under goes to the oldest.
  void set_span(double begin, double end);
  /// Lets `dt` s of a person's time go by. At its end a recording stands still and a run is live.
  void step(double dt);

  /// Looks at a time, or as near as there is one. Of a run, one that is no less than the end is
  /// its newest moment, whatever comes. It goes on playing if it did.
  void go(double time);
  /// Looks at a time and stands still there.
  void stand_at(double time);
  /// Moves to the moment that is there for the time looked at, and stays behind what is newest.
  void settle(double time) { time_ = time; }
  void to_start() { go(begin_); }
  void to_end() { go(end_); }
  /// Plays if it stood still, and the other way round. A recording at its end begins anew; a run at
  /// its newest moment stands still there.
  void toggle();
  void stop() { plays_ = false; }
  /// Sets how fast it plays, within kSlowest and kFastest.
  void set_speed(double speed);

  double time() const { return live() ? end_ : time_; }
  double begin() const { return begin_; }
  double end() const { return end_; }
  double speed() const { return speed_; }
  bool plays() const { return plays_; }
  /// Returns whether what is newest of a run is looked at; never of a recording.
  bool live() const { return live_; }
  /// Returns whether this is of a run.
  bool of_a_run() const { return run_; }
  /// Returns how far behind what is newest one looks, s.
  double behind() const { return end_ - time(); }

 private:
  explicit PlayHead(bool run) : run_(run), live_(run), plays_(!run) {}

  bool run_;
  bool live_;
  bool plays_;
  bool spanned_ = false;
  double begin_ = 0, end_ = 0, time_ = 0;
  double speed_ = 1;
};

}  // namespace thimble::view
