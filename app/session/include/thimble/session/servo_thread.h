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

/// The thread on which a run's servo loop runs. It asks for real-time priority when it is made, so
/// that what the kernel grants is known before an arm is opened, and waits for the run.
/// Real-time: never from the servo thread, all of it.
class THIMBLE_EXPORT ServoThread {
 public:
  /// Starts the thread and waits until it has asked. Without `real_time` it asks for nothing.
  explicit ServoThread(bool real_time);
  /// Ends the thread; a run that was begun is waited for.
  ~ServoThread();
  ServoThread(const ServoThread&) = delete;
  ServoThread& operator=(const ServoThread&) = delete;

  /// Returns what the kernel granted.
  const driver::RealTimeGrant& grant() const noexcept { return grant_; }
  /// Begins to run the session until its end or until `stop` is set; both must outlive the thread.
  /// Once.
  void begin(Session& session, const std::atomic<bool>& stop);
  /// Returns whether the run that was begun is over.
  bool ended() const noexcept { return ended_.load(); }
  /// Waits for the end of the run that was begun and returns why it ended.
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

/// Returns the error that a run with a real arm must end with before the arm is opened: without
/// real-time priority any other program can hold the loop up while a motor pulls. `allowed`: the
/// user said --no-real-time.
THIMBLE_EXPORT driver::Result<void> check_real_time(const driver::RealTimeGrant& grant,
                                                    bool allowed);

}  // namespace thimble::session
