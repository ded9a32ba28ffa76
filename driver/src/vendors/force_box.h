#pragma once

#include <Eigen/Core>
#include <atomic>

namespace thimble::driver {

/// The next force for an arm, from the servo thread to the one that speaks with the arm. A force
/// that waits is not replaced by another, so that what was taken is what the loop believes; only
/// zero force overtakes it. Neither side ever waits. Real-time: safe, both ways.
class ForceBox {
 public:
  /// Puts a force (N); false if the one before still waits, which then goes out, unless this one is
  /// zero: then zero goes out in its place. By the servo thread.
  bool put(const Eigen::Vector3d& f) noexcept {
    if (full_.load(std::memory_order_acquire)) {
      if (f.isZero(0)) zero_.store(true, std::memory_order_release);
      return false;
    }
    zero_.store(false, std::memory_order_relaxed);
    f_ = f;
    full_.store(true, std::memory_order_release);
    return true;
  }

  /// Takes the force that waits (N); false if none does. By the thread that speaks with the arm.
  bool take(Eigen::Vector3d& f) noexcept {
    if (!full_.load(std::memory_order_acquire)) return false;
    f = f_;
    if (zero_.exchange(false, std::memory_order_acq_rel)) f.setZero();
    zero_taken_.store(f.isZero(0), std::memory_order_release);
    full_.store(false, std::memory_order_release);
    return true;
  }

  /// Returns whether a zero that was put last is with the other thread: nothing waits, or nothing
  /// but one more zero. By the servo thread.
  bool zero_settled() const noexcept {
    return !full_.load(std::memory_order_acquire) || zero_taken_.load(std::memory_order_acquire);
  }

 private:
  Eigen::Vector3d f_{0, 0, 0};
  std::atomic<bool> full_{false}, zero_{false};
  std::atomic<bool> zero_taken_{false};  // the force that was taken last was zero
};

}  // namespace thimble::driver
