#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "math/elementary.h"

namespace thimble::render {

/// Rotation of a free rigid body in time: order 4, with constant angular momentum for any step.
///
/// The energy of rotation is split as L^2 / 2 I_1 + sum over k = 0, 2 of (1 / I_k - 1 / I_1) L_k^2
/// / 2, where axis 1 has the middle inertia. Each part by itself turns the body at a constant rate.
/// The first turns it about the angular momentum, and commutes with all others; the others turn it
/// about their own axis [Touma]. Five of the latter in a palindrome are of order 2, three
/// palindromes of order 4 [Yoshida]. The rotation of a body with two equal inertias, a cube or a
/// ball is exact.
class FreeTurn {
 public:
  /// Takes the principal inertias, kg m^2, > 0. They may be in any order; in ascending order errors
  /// are least.
  explicit FreeTurn(const Eigen::Vector3d& inertia)
      : rate_1_(1 / inertia[1]),
        rate_2_(1 / inertia[2] - 1 / inertia[1]),
        rate_0_(1 / inertia[0] - 1 / inertia[1]) {}

  /// Turns the frame B of the principal axes, given by the unit quaternion `q_WB`, for `time` s
  /// under the angular momentum `angular_W` (kg m^2/s), which is constant. Real-time: safe.
  void turn(double time, const Eigen::Vector3d& angular_W,
            Eigen::Quaterniond& q_WB) const noexcept {
    State now{q_WB.conjugate() * angular_W, q_WB};
    about_2(kOuter / 2 * time, now);
    about_0(kOuter * time, now);
    about_2((kOuter + kInner) / 2 * time, now);
    about_0(kInner * time, now);
    about_2((kOuter + kInner) / 2 * time, now);
    about_0(kOuter * time, now);
    about_2(kOuter / 2 * time, now);
    const double half = rate_1_ * time / 2;
    const HalfTurn whole = half_turn(half * half * angular_W.squaredNorm());
    const Eigen::Vector3d axis = whole.sine_over_angle * half * angular_W;
    q_WB = Eigen::Quaterniond(whole.cosine, axis.x(), axis.y(), axis.z()) * now.q;
    // One step of Newton's method towards length 1, enough for rounding errors.
    q_WB.coeffs() *= 1.5 - 0.5 * q_WB.squaredNorm();
  }

 private:
  static constexpr double kOuter = 1.3512071919596578;  // 1 / (2 - cube root of 2) [Yoshida]
  static constexpr double kInner = 1 - 2 * kOuter;

  struct State {
    Eigen::Vector3d L;  // angular momentum in B
    Eigen::Quaterniond q;
  };
  struct HalfTurn {
    double cosine, sine_over_angle;
  };

  // Returns cos x and sin(x) / x of half an angle x from its square. Below a quarter of a radian
  // Taylor's series are exact to the last digit: the next terms are below 1e-18.
  static HalfTurn half_turn(double x2) noexcept {
    if (!(x2 <= 0.0625)) {
      const double x = std::sqrt(x2);
      const auto [sine, cosine] = math::sin_cos(x);
      return {cosine, sine / x};
    }
    const double x4 = x2 * x2;
    const double cosine =
        (1 - x2 / 2) +
        x4 * ((1.0 / 24 - x2 / 720) + x4 * ((1.0 / 40320 - x2 / 3628800) + x4 / 479001600));
    const double ratio =
        (1 - x2 / 6) + x4 * ((1.0 / 120 - x2 / 5040) + x4 * (1.0 / 362880 - x2 / 39916800));
    return {cosine, ratio};
  }

  // Turn B about one of its own axes, at the rate of this axis' part of the energy.
  void about_0(double time, State& now) const noexcept {
    const double half = rate_0_ * now.L[0] * time / 2;
    const HalfTurn by = half_turn(half * half);
    const double c = by.cosine, s = half * by.sine_over_angle;
    turn_plane(c, s, now.L[1], now.L[2]);
    const Eigen::Quaterniond q = now.q;
    now.q = Eigen::Quaterniond(c * q.w() - s * q.x(), c * q.x() + s * q.w(), c * q.y() + s * q.z(),
                               c * q.z() - s * q.y());
  }
  void about_2(double time, State& now) const noexcept {
    const double half = rate_2_ * now.L[2] * time / 2;
    const HalfTurn by = half_turn(half * half);
    const double c = by.cosine, s = half * by.sine_over_angle;
    turn_plane(c, s, now.L[0], now.L[1]);
    const Eigen::Quaterniond q = now.q;
    now.q = Eigen::Quaterniond(c * q.w() - s * q.z(), c * q.x() + s * q.y(), c * q.y() - s * q.x(),
                               c * q.z() + s * q.w());
  }
  // Turns the two other components back by the whole angle; c and s are those of half the angle.
  static void turn_plane(double c, double s, double& first, double& second) noexcept {
    const double cosine = 1 - 2 * s * s, sine = 2 * s * c;
    const double was = first;
    first = cosine * was + sine * second;
    second = cosine * second - sine * was;
  }

  double rate_1_, rate_2_, rate_0_;  // rate of each part, 1 / (kg m^2)
};

}  // namespace thimble::render
