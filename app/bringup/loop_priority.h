#pragma once

#include <cstdint>

namespace thimble::bringup {

/// Runs the calling thread before all others (SCHED_FIFO, like the servo thread of a run) during
/// its lifetime. Refusal is not an error here: the command checks the priority before it opens an
/// arm (session::check_real_time). Real-time: never from the servo thread.
class LoopPriority {
 public:
  /// Requests the priority if `wanted`.
  explicit LoopPriority(bool wanted) noexcept;
  /// Restores the former priority of the thread.
  ~LoopPriority();
  LoopPriority(const LoopPriority&) = delete;
  LoopPriority& operator=(const LoopPriority&) = delete;

 private:
  bool raised_ = false;
  int policy_ = 0, priority_ = 0;  // previous values
};

/// Lateness of the ticks of a loop.
struct LateTicks {
  std::uint64_t ticks = 0;
  std::uint64_t late = 0;  ///< Ticks that began more than half a period late.
  double worst = 0;        ///< Max. lateness, s.

  /// Counts a tick that began `behind` (s) after its time, in a loop of this period (s).
  void count(double behind, double period) noexcept;
  /// Adds the ticks of another loop.
  void add(const LateTicks& other) noexcept;
  /// Returns whether too many ticks were late for motion and force to match: more than one in a
  /// thousand [chosen: 136 of 60,000 spoiled the fit of a sound arm].
  bool many() const noexcept { return late * 1000 > ticks; }
};

}  // namespace thimble::bringup
