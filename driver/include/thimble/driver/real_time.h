#pragma once

#include <filesystem>
#include <string>

#include "thimble/driver/export.h"

namespace thimble::driver {

/// Real-time properties that the kernel granted to the servo thread, and advice on those that it
/// refused.
struct RealTimeGrant {
  bool fifo = false;           ///< True if SCHED_FIFO was granted.
  bool memory_locked = false;  ///< True if memory is locked (mlockall).
  /// True if the processors are kept from deep sleep (CpuLatencyRequest).
  bool cpu_awake = false;
  std::string advice;  ///< Remedies for refused requests; empty if none was refused.
};

/// Requests that the kernel run the calling thread before all others (SCHED_FIFO at `priority`, 1
/// to 99) and keep the process in memory. A refusal is not an error: the loop runs with more
/// jitter, and `advice` reports it. Real-time: never once the loop runs; call it first on the servo
/// thread.
THIMBLE_EXPORT RealTimeGrant enter_real_time(int priority = 80);

/// Requests, during its lifetime, that no processor enters a sleep from which it wakes late
/// (/dev/cpu_dma_latency, 0 us; the kernel drops the request when the file is closed [S kernel
/// documentation, power/pm_qos_interface]). Without it a processor that idles between two ticks may
/// take 100 us or more to wake up. Real-time: never from the servo thread.
class THIMBLE_EXPORT CpuLatencyRequest {
 public:
  /// Makes the request, below the folder `root`. A refusal is not an error; `advice` states the
  /// remedy.
  explicit CpuLatencyRequest(const std::filesystem::path& root = "/");
  /// Ends the request.
  ~CpuLatencyRequest();
  CpuLatencyRequest(const CpuLatencyRequest&) = delete;
  CpuLatencyRequest& operator=(const CpuLatencyRequest&) = delete;

  /// Returns whether the kernel granted the request.
  bool granted() const noexcept { return file_ >= 0; }
  /// Returns the remedy for a refusal as a sentence; empty if the request was granted.
  const std::string& advice() const noexcept { return advice_; }

 private:
  int file_ = -1;
  std::string advice_;
};

}  // namespace thimble::driver
