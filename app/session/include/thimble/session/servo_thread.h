#pragma once

#include <atomic>
#include <memory>
#include <thread>

#include "thimble/driver/export.h"
#include "thimble/driver/real_time.h"
#include "thimble/driver/result.h"
#include "thimble/driver/servo_loop.h"

namespace thimble::session {

class Session;

/// Thread of the servo loop of a run. It requests real-time priority when it is constructed, so
/// that the result is known before an arm is opened. Then it waits for the run. Real-time: none of
/// its functions may be called from the servo thread.
class THIMBLE_EXPORT ServoThread {
 public:
  /// Starts the thread and waits until it has requested real-time priority. If `real_time` is
  /// false, nothing is requested.
  explicit ServoThread(bool real_time);
  /// Waits for the end of a started run, then ends the thread.
  ~ServoThread();
  ServoThread(const ServoThread&) = delete;
  ServoThread& operator=(const ServoThread&) = delete;

  /// Returns the real-time properties that the kernel granted.
  const driver::RealTimeGrant& grant() const noexcept { return grant_; }
  /// Starts running the session until its end or until `stop` is set. Both must outlive the thread.
  /// May be called once.
  void begin(Session& session, const std::atomic<bool>& stop);
  /// Returns whether the started run has ended.
  bool ended() const noexcept { return ended_.load(); }
  /// Waits for the end of the started run and returns its reason.
  driver::ServoEnd join();

 private:
  enum class Order : int { kNone, kRun, kLeave };

  std::unique_ptr<driver::CpuLatencyRequest> awake_;
  driver::RealTimeGrant grant_;
  std::atomic<bool> asked_{false};
  std::atomic<Order> order_{Order::kNone};
  std::atomic<bool> ended_{false};
  Session* session_ = nullptr;
  const std::atomic<bool>* stop_ = nullptr;
  driver::ServoEnd end_ = driver::ServoEnd::kDone;
  std::thread thread_;
};

/// Fails if a real arm must not be opened because real-time priority was refused. Without it, any
/// other program could delay the loop while a motor pulls. `allowed` is true if the user passed
/// --no-real-time.
THIMBLE_EXPORT driver::Result<void> check_real_time(const driver::RealTimeGrant& grant,
                                                    bool allowed);

}  // namespace thimble::session
