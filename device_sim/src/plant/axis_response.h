#pragma once

namespace thimble::device_sim {

/// The impulse response of y'' + damping y' + stiffness y = 0 at one time, and its integrals. The
/// exact motion of one axis between two events consists of these.
struct AxisResponse {
  double slope = 1;     ///< S'(t), no unit.
  double impulse = 0;   ///< S(t) with S(0) = 0, S'(0) = 1, s.
  double integral = 0;  ///< Integral of S from 0 to t, s^2.
  double second = 0;    ///< Integral of `integral` from 0 to t, s^3.

  /// Returns the response at time `t` (s, >= 0). `damping` (1/s) and `stiffness` (1/s^2) are per
  /// mass and >= 0.
  ///
  /// One power series serves every regime (underdamped, critical, overdamped, free, undamped), so
  /// no special cases are needed between them. Long times are reached by doubling. The relative
  /// error is about 2^-53 times max(1, 8 t max(damping, sqrt(stiffness))). Input that is not finite
  /// gives output that is not finite. Real-time: safe; bounded by the number of doublings (at most
  /// 1100).
  static AxisResponse at(double damping, double stiffness, double t) noexcept;
};

/// Motion of one axis while its dry friction keeps its sign: v'' + damping v' + stiffness v = jerk,
/// from v(0) and v'(0).
struct AxisMotion {
  double v = 0;          ///< Velocity at time 0, m/s.
  double a = 0;          ///< Acceleration at time 0, m/s^2.
  double jerk = 0;       ///< Constant input from the anchor's motion, m/s^3.
  double damping = 0;    ///< 1/s
  double stiffness = 0;  ///< 1/s^2

  /// Returns the displacement since time 0, m. Real-time: safe.
  double way(const AxisResponse& at) const noexcept {
    return v * (at.impulse + damping * at.integral) + a * at.integral + jerk * at.second;
  }
  /// Returns the velocity, m/s. Real-time: safe.
  double velocity(const AxisResponse& at) const noexcept {
    return v + a * at.impulse + (jerk - stiffness * v) * at.integral;
  }
  /// Returns the acceleration, m/s^2. Real-time: safe.
  double acceleration(const AxisResponse& at) const noexcept {
    return a * at.slope + (jerk - stiffness * v) * at.impulse;
  }
};

}  // namespace thimble::device_sim
