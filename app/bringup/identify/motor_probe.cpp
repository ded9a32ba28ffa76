#include "bringup/identify/motor_probe.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace thimble::bringup {
namespace {

constexpr double kWeakest = 0.05;  // N, of the first push
constexpr double kPulse = 0.04;    // s, max. duration
constexpr double kReach = 0.002;   // m, at which a push reverses [chosen: a twentieth of the space]
constexpr double kStill = 0.02;    // s without a count, after which it is at rest
constexpr double kRestMax = 2;     // s, after which it moves by itself [chosen]
constexpr double kNoticed = 3, kClear = 10;  // counts
// Max. tip acceleration per requested N, 1/kg, for which HoldPlace is stable with a delay of 5 ms.
// At the frequency sqrt(60 N/m times this) its phase lead, atan(0.0206 w) - atan(0.0106 w), equals
// the phase lag of 5.5 ms.
constexpr double kAccelerationMax = 30;

/// Result of one push.
struct Pushed {
  double counts = 0;        ///< Max. motion of the joint, in the direction of the torque.
  double acceleration = 0;  ///< Acceleration of the tip along the push, m/s^2.
};

class Probe {
 public:
  Probe(BenchArm& bench, const scene::ArmFile& file, double max_force,
        const std::function<bool(const Eigen::Vector3d&)>& within, const std::atomic<bool>& stop)
      : bench_(bench), file_(file), max_force_(max_force), within_(within), stop_(stop) {}

  /// Returns the share of one motor, or the reason why there is none; an empty error if the run has
  /// ended.
  driver::Result<double> share_of(int joint) {
    Pushed before, now;
    double force = 0, force_before = 0;
    while (force < max_force_) {
      const bool moved = std::abs(now.counts) >= kClear;
      before = now, force_before = force;
      force = std::min(max_force_, force > 0 ? 2 * force : kWeakest);
      const auto pushed = push(joint, force);
      if (!pushed) return ended(joint, now.counts, force);
      now = *pushed;
      if (moved) break;
    }
    if (now.counts < -kNoticed) {
      // Another cause may have moved the tip at that time, but would not move it in both
      // directions.
      const auto again = push(joint, -force);
      if (!again) return ended(joint, now.counts, force);
      if (again->counts < -kNoticed) return against(joint, now.counts);
      return moves_by_itself(joint);
    }
    if (now.counts < kNoticed) return unmoved(joint, now.counts, force);
    // Dry friction reduces both equally.
    const double lively = (now.acceleration - before.acceleration) / (force - force_before);
    return std::min(1.0, kAccelerationMax / std::max(lively, 1e-9));
  }

 private:
  /// Lets the tip come to rest after a push, for up to kRestMax: an arm whose friction hardly
  /// carries its weight slides for long. Returns whether the run continues.
  bool rest() {
    const auto nothing = [](const driver::DeviceState&) { return Eigen::Vector3d(0, 0, 0); };
    for (double waited = 0; waited < kRestMax; waited += kStill) {
      const Eigen::Vector3d before = bench_.device().state().q;
      if (!bench_.run(kStill, nothing, stop_)) return false;
      if (!within_(bench_.device().state().p_WT)) return false;
      if (bench_.device().state().q == before) break;
    }
    return true;
  }

  std::optional<Pushed> push(int joint, double force) {
    if (!rest()) return {};
    const Eigen::Vector3d begin_W = bench_.device().state().p_WT;
    const double q0 = bench_.device().state().q[joint], begin = bench_.now();
    double turn = -1;  // time at which the push reversed, s
    Pushed seen;
    std::vector<std::pair<double, double>> way;  // s, m along the push, up to that time
    bool left = false;
    Phases phases;
    const auto law = [&](const driver::DeviceState& state) -> Eigen::Vector3d {
      const double t = bench_.now() - begin;
      left = left || !within_(state.p_WT);
      if (left) return {0, 0, 0};
      const Eigen::Vector3d push_W = direction(joint, state.q);
      const double gone = std::copysign(1.0, force) * push_W.dot(state.p_WT - begin_W);
      if (turn < 0) way.emplace_back(t, gone);
      if (turn < 0 && (t >= kPulse || std::abs(gone) >= kReach)) turn = t;
      // Before a hand's spring, or the next phase, can have reversed it.
      const double away = std::copysign(1.0, force) * (state.q[joint] - q0);
      if (turn < 0 || t < 1.1 * turn) {
        seen.counts = std::abs(away) > std::abs(seen.counts) ? away : seen.counts;
      }
      return sign_of(phases, t, turn, gone, std::copysign(1.0, force) * push_W.dot(state.v_WT)) *
             force * push_W;
    };
    if (!bench_.run(5 * kPulse, law, stop_) || left) return {};
    seen.counts /= file_.model.step(static_cast<std::size_t>(joint));
    seen.acceleration = acceleration_of(way);
    return seen;
  }

  /// Phases of a push: there, back, and stop, with alternating signs.
  struct Phases {
    enum { kThere, kBack, kStop, kOver } now = kThere;
    double until = 0;  ///< s, end of the previous phase
    double peak = 0;   ///< m, max. distance along the push, with its sign
  };

  /// Returns the sign of the force at time `t` (s) in a push that reversed at `turn` (s, negative
  /// before that). The tip has moved `gone` (m) along it, with `rate` (m/s). With a weight the
  /// motions there and back differ, so each ends by position, at the latest after twice the time of
  /// the push.
  static double sign_of(Phases& phases, double t, double turn, double gone, double rate) {
    if (turn < 0) return 1;
    if (std::abs(gone) > std::abs(phases.peak)) phases.peak = gone;
    const double side = std::copysign(1.0, phases.peak);
    const bool late = t - phases.until >= 2 * turn;
    const auto next = [&](auto phase) {
      phases.now = phase;
      phases.until = t;
    };
    if (phases.now == Phases::kThere) {
      next(Phases::kBack);
    } else if (phases.now == Phases::kBack && (late || side * gone < 0.5 * side * phases.peak) &&
               side * rate < 0) {
      next(Phases::kStop);
    } else if (phases.now == Phases::kBack && late) {
      next(Phases::kOver);  // it does not return
    } else if (phases.now == Phases::kStop && (late || side * rate >= 0)) {
      next(Phases::kOver);
    }
    return phases.now == Phases::kBack ? -1 : phases.now == Phases::kStop ? 1 : 0;
  }

  /// Returns the unit force at the tip (W) of a single motor.
  Eigen::Vector3d direction(int joint, const Eigen::Vector3d& q) const {
    Eigen::Vector3d p_BT;
    Eigen::Matrix3d J;
    std::visit([&](const auto& build) { build.forward(q, p_BT, J); }, file_.model.geometry);
    return file_.R_WB * J.inverse().row(joint).transpose().normalized();
  }

  /// Returns the acceleration of a motion from rest that began at an unknown time. x = a (t - t0)^2
  /// / 2 moves from a quarter of its end to its end in half of its time.
  static double acceleration_of(const std::vector<std::pair<double, double>>& way) {
    if (way.empty() || way.back().second <= 0) return 0;
    const auto [end, far] = way.back();
    double quarter = 0;
    for (const auto& [t, gone] : way) {
      if (gone < 0.25 * far) quarter = t;
    }
    return 0.5 * far / ((end - quarter) * (end - quarter));
  }

  /// Returns the reason for the end of a push: the gate also detects a motor that moves nothing or
  /// in the wrong direction. Empty if there was another reason.
  driver::Error ended(int joint, double counts, double force) const {
    switch (bench_.device().fault()) {
      case driver::Fault::kEncoderFrozen:
        return unmoved(joint, counts, force);
      case driver::Fault::kMotorsReversed:
        return against(joint, counts);
      default:
        return {};
    }
  }

  static driver::Error against(int joint, double counts) {
    return {
        fmt::format("Motor {} pulls against its encoder: its joint moved {:.0f} counts in the "
                    "wrong direction. Run `thimble feel-check`, which names the wire; correct the "
                    "wire or its sign in the arm file.",
                    joint + 1, std::max(0.0, -counts))};
  }

  static driver::Error moves_by_itself(int joint) {
    return {fmt::format(
        "The joint of motor {} moved in the same direction for both directions of the push: "
        "something else moves the tip. Let go of the grip, and keep cables off the arm.",
        joint + 1)};
  }

  static driver::Error unmoved(int joint, double counts, double force) {
    return {fmt::format(
        "Motor {} moved its joint by only {:.0f} counts under {:g} N: the dry friction is higher "
        "(--max-force allows more force), the tip is held, the joint sticks, or the motor is "
        "dead. Let go of the grip and run `thimble feel-check`.",
        joint + 1, counts, force)};
  }

  BenchArm& bench_;
  const scene::ArmFile& file_;
  double max_force_;  // N
  const std::function<bool(const Eigen::Vector3d&)>& within_;
  const std::atomic<bool>& stop_;
};

}  // namespace

driver::Result<Eigen::Vector3d> probe_motors(
    BenchArm& bench, const scene::ArmFile& file, double max_force,
    const std::function<bool(const Eigen::Vector3d&)>& within, const std::atomic<bool>& stop) {
  Probe probe(bench, file, max_force, within, stop);
  Eigen::Vector3d shares(1, 1, 1);
  for (int joint = 0; joint < file.motors(); ++joint) {
    const auto share = probe.share_of(joint);
    if (!share) return share.error();
    shares[joint] = *share;
  }
  return shares;
}

}  // namespace thimble::bringup
