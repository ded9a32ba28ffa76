#pragma once

#include <Eigen/Core>
#include <atomic>

namespace thimble::driver {

/// The next force for an arm, from the servo thread to the thread that exchanges data with the arm.
/// A waiting force is not replaced by another, so that the loop knows which force was accepted.
/// Only zero force overtakes it. Neither side ever waits. Real-time: safe, both ways.
class ForceBox {
 public:
  /// Stores a force (N). Returns false if the previous one still waits; that one is then sent. If
  /// the new force is zero, zero is sent instead of the waiting one. Called by the servo thread.
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

  /// Takes the waiting force (N); false if there is none. Called by the thread that exchanges data
  /// with the arm.
  bool take(Eigen::Vector3d& f) noexcept {
    if (!full_.load(std::memory_order_acquire)) return false;
    f = f_;
    if (zero_.exchange(false, std::memory_order_acq_rel)) f.setZero();
    zero_taken_.store(f.isZero(0), std::memory_order_release);
    full_.store(false, std::memory_order_release);
    return true;
  }

  /// Returns whether the last zero force has been taken by the other thread: nothing waits, or only
  /// one more zero. Called by the servo thread.
  bool zero_settled() const noexcept {
    return !full_.load(std::memory_order_acquire) || zero_taken_.load(std::memory_order_acquire);
  }

 private:
  Eigen::Vector3d f_{0, 0, 0};
  std::atomic<bool> full_{false}, zero_{false};
  std::atomic<bool> zero_taken_{false};  // the force taken last was zero
};

}  // namespace thimble::driver
