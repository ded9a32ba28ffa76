#pragma once

#include <cstdint>

namespace thimble::bringup {

/// Runs the calling thread before all others (SCHED_FIFO, as the servo thread of a run) from its
/// construction to its destruction. Refusal is no error here: the command asks before it opens an
/// arm (session::check_real_time). Real-time: never from the servo thread.
class LoopPriority {
 public:
  /// Asks for the priority if `wanted`.
  explicit LoopPriority(bool wanted) noexcept;
  /// Gives the thread its former priority back.
  ~LoopPriority();
  LoopPriority(const LoopPriority&) = delete;
  LoopPriority& operator=(const LoopPriority&) = delete;

 private:
  bool raised_ = false;
  int policy_ = 0, priority_ = 0;  // before
};

/// How late the ticks of a loop began.
struct LateTicks {
  std::uint64_t ticks = 0;
  std::uint64_t late = 0;  ///< That began more than half a period after their time.
  double worst = 0;        ///< The latest one, s.

  /// Counts a tick that began `late` (s) after its time, in a loop of this period (s).
  void count(double behind, double period) noexcept;
  /// Adds the ticks of another loop.
  void add(const LateTicks& other) noexcept;
  /// Returns whether so many were late that motion and force no longer belong together: more than
  /// one in a thousand [chosen: 136 of 60,000 made the fit of a sound arm a bad one].
  bool many() const noexcept { return late * 1000 > ticks; }
};

}  // namespace thimble::bringup
