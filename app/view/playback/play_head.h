#pragma once

namespace thimble::view {

/// The position on a time line, s: the newest moment of a run, a kept one, or one of a recording.
/// Independent of drawing and of clocks. Real-time: never from the servo thread.
class PlayHead {
 public:
  static constexpr double kSlowest = 0.1;  ///< Slowest speed, as a multiple of the recorded time.
  static constexpr double kFastest = 4;    ///< Fastest speed, as above.

  /// Returns the head of a live run, at the newest moment.
  static PlayHead of_run() { return PlayHead(true); }
  /// Returns the head of a recording, at its begin, playing.
  static PlayHead of_recording() { return PlayHead(false); }

  /// Sets the time span with moments. The first span of a recording moves the head to its begin. If
  /// the moment at the head was discarded, the head moves to the oldest.
  void set_span(double begin, double end);
  /// Advances by `dt` s of wall-clock time. At the end, a recording stops and a run becomes live.
  void step(double dt);

  /// Moves to a time, clamped to the span. For a run, a time at or after the end means the newest
  /// moment from now on. A head that plays continues to play.
  void go(double time);
  /// Moves to a time and stops there.
  void stop_at(double time);
  /// Moves to the moment shown for the current time, without becoming live.
  void settle(double time) { time_ = time; }
  void to_start() { go(begin_); }
  void to_end() { go(end_); }
  /// Switches between playing and stopped. A recording at its end starts again; a live run stops at
  /// its newest moment.
  void toggle();
  void stop() { plays_ = false; }
  /// Sets the playback speed, within kSlowest and kFastest.
  void set_speed(double speed);

  double time() const { return live() ? end_ : time_; }
  double begin() const { return begin_; }
  double end() const { return end_; }
  double speed() const { return speed_; }
  bool plays() const { return plays_; }
  /// Returns whether the newest moment of a run is shown; never for a recording.
  bool live() const { return live_; }
  /// Returns whether this is the head of a run.
  bool of_a_run() const { return run_; }
  /// Returns the delay behind the newest moment, s.
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
