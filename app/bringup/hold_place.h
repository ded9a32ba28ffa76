#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>

#include "math/elementary.h"

namespace thimble::bringup {

/// A weak spring and damper that keep a free tip near a point of the world, so that no hand is
/// needed. All functions are Real-time: safe.
class HoldPlace {
 public:
  // A spring on which a mass of 25 to 250 g oscillates at 2 to 8 Hz, and a damper below that of a
  // hand: weak compared with the measured effects [chosen].
  static constexpr double kStiffness = 60;  ///< N/m
  static constexpr double kDamping = 0.6;   ///< N s/m

  /// Takes the point (m), and a force that carries the load of the tip (N).
  explicit HoldPlace(const Eigen::Vector3d& p_WM,
                     const Eigen::Vector3d& f_carried_W = Eigen::Vector3d::Zero()) noexcept
      : p_WM_(p_WM), f_carried_W_(f_carried_W) {}

  /// Returns the force (N) on a tip at p_WT (m) with v_WT (m/s), `dt` (s) after the last call.
  Eigen::Vector3d force(double dt, const Eigen::Vector3d& p_WT,
                        const Eigen::Vector3d& v_WT) noexcept {
    v_slow_ += (v_WT - v_slow_) * -math::expm1(-kCorner * dt);
    return f_carried_W_ + kStiffness * (p_WM_ - p_WT) - kDamping * v_slow_;
  }

  /// Moves the point.
  void go_to(const Eigen::Vector3d& p_WM) noexcept { p_WM_ = p_WM; }
  const Eigen::Vector3d& place() const noexcept { return p_WM_; }

 private:
  // Low-pass corner: the force's response to encoder noise would reappear in the motion.
  static constexpr double kCorner = 2 * std::numbers::pi * 15;  // rad/s

  Eigen::Vector3d p_WM_;
  Eigen::Vector3d f_carried_W_;
  Eigen::Vector3d v_slow_{0, 0, 0};  // filtered of the encoders' quantization noise, m/s
};

}  // namespace thimble::bringup
