#pragma once

#include <string>

namespace thimble::driver {

/// Says what the kernel granted to the servo thread, and how to get what it refused.
struct RealTimeGrant {
  bool fifo = false;           ///< SCHED_FIFO was granted.
  bool memory_locked = false;  ///< Pages stay in memory (mlockall).
  std::string advice;          ///< What to do about what was refused; empty if nothing was.
};

/// Asks the kernel to run the calling thread before all others (SCHED_FIFO at `priority`, 1 to 99)
/// and to keep the process in memory. Refusal is no error: the loop runs, with more jitter, and
/// says so. Real-time: never once the loop runs; call it first on the servo thread.
RealTimeGrant enter_real_time(int priority = 80);

}  // namespace thimble::driver
