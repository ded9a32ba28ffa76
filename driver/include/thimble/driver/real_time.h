#pragma once

#include <filesystem>
#include <string>

#include "thimble/driver/export.h"

namespace thimble::driver {

/// What the kernel granted to the servo thread, and how to get what it refused.
struct RealTimeGrant {
  bool fifo = false;           ///< SCHED_FIFO was granted.
  bool memory_locked = false;  ///< Pages stay in memory (mlockall).
  bool cpu_awake = false;      ///< The processors are kept from deep sleep (CpuLatencyRequest).
  std::string advice;          ///< What to do about what was refused; empty if nothing was.
};

/// Asks the kernel to run the calling thread before all others (SCHED_FIFO at `priority`, 1 to 99)
/// and to keep the process in memory. Refusal is no error: the loop runs, with more jitter, and
/// says so. Real-time: never once the loop runs; call it first on the servo thread.
THIMBLE_EXPORT RealTimeGrant enter_real_time(int priority = 80);

/// A request to the kernel that no processor falls into a sleep from which it wakes late, for as
/// long as the request lives (/dev/cpu_dma_latency, 0 us; the kernel forgets it when the file is
/// closed [S kernel documentation, power/pm_qos_interface]). Without it a processor that rests
/// between two ticks may take 100 us and more to come back. Real-time: never from the servo thread.
class THIMBLE_EXPORT CpuLatencyRequest {
 public:
  /// Asks, below the folder `root`. Refusal is no error: `advice` says what to do.
  explicit CpuLatencyRequest(const std::filesystem::path& root = "/");
  /// Ends the request.
  ~CpuLatencyRequest();
  CpuLatencyRequest(const CpuLatencyRequest&) = delete;
  CpuLatencyRequest& operator=(const CpuLatencyRequest&) = delete;

  /// Returns whether the kernel took it.
  bool granted() const noexcept { return file_ >= 0; }
  /// Returns what to do about a refusal, a sentence; empty if it was granted.
  const std::string& advice() const noexcept { return advice_; }

 private:
  int file_ = -1;
  std::string advice_;
};

}  // namespace thimble::driver
