#include "bringup/identify/record_motion.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>

#include "bringup/identify/arm_constants.h"
#include "bringup/identify/excitation.h"

namespace thimble::app {
namespace {

constexpr double kTick = 1e-3;       // s, of BenchArm
constexpr double kPulse = 0.04;      // s
constexpr double kPulseShare = 0.4;  // of the most that is allowed, in a first pulse

/// Fills in what a tick showed: the tip, and how it hangs together with the joints.
MotionSample sample_of(const scene::ArmFile& file, const driver::DeviceState& state) {
  MotionSample sample;
  Eigen::Matrix3d J;
  std::visit([&](const auto& build) { build.forward(state.q, sample.p_BT, J); },
             file.model.geometry);
  sample.G = J.inverse();
  sample.q = state.q;
  sample.fresh = state.fresh;
  return sample;
}

class Recorder {
 public:
  Recorder(BenchArm& bench, const scene::ArmFile& file, const MotionOrder& order,
           const std::atomic<bool>& stop)
      : bench_(bench),
        file_(file),
        lead_(order.lead),
        pulse_(kPulseShare * order.force_most),
        stop_(stop) {}

  driver::Result<void> begin(bool bare) {
    const auto rest = [](const driver::DeviceState&) { return Eigen::Vector3d(0, 0, 0); };
    if (auto active = bench_.device().activate(); !active) return active.error();
    // Until the soft start is over; an arm with its bare tip stays where it is put.
    if (bare && !bench_.run(file_.limits.soft_start + 0.05, rest, stop_)) return why();
    p_WM_ = bench_.device().state().p_WT;
    if (file_.workspace.holds(p_WM_)) return {};
    return driver::Error{
        "The tip is outside the workspace of the arm file, so nothing was asked of the motors. Put "
        "it into the middle of the workspace, and run `thimble doctor` if it is there: the arm may "
        "not be calibrated."};
  }

  driver::Error why() const {
    const driver::Fault fault = bench_.device().fault();
    if (fault == driver::Fault::kNone) return driver::Error{"It was stopped; nothing was kept."};
    return driver::Error{std::string(driver::describe(fault)) +
                         " The motors are off; nothing was kept."};
  }

  /// Pushes each joint to and fro for an instant, before any force follows the motion: one that is
  /// turned round would drive the tip away. A pulse and its opposite leave the tip where it was.
  driver::Result<void> check_signs() {
    for (int joint = 0; joint < 3; ++joint) {
      double moved = 0;  // rad, in the direction of the torque
      double q0 = 0, begin = -1;
      const auto law = [&](const driver::DeviceState& state) -> Eigen::Vector3d {
        if (begin < 0) begin = bench_.now(), q0 = state.q[joint];
        const double t = bench_.now() - begin;
        left_ = left_ || !within(state.p_WT);
        if (left_) return {0, 0, 0};
        // +, -, -, +: while it is pushed to and stopped, the joint goes one way and comes back.
        const double phase = t / kPulse;
        const double sign = phase < 1 ? 1 : phase < 3 ? -1 : phase < 4 ? 1 : 0;
        const double away = state.q[joint] - q0;
        // Before a hand's spring, or the second pulse, can have turned it round.
        if (phase < 1.1) moved = std::abs(away) > std::abs(moved) ? away : moved;
        const MotionSample here = sample_of(file_, state);
        const Eigen::Vector3d push_B = here.G.row(joint).transpose().normalized();
        return file_.R_WB * (sign * pulse_ * push_B);
      };
      if (!bench_.run(5 * kPulse, law, stop_)) return why();
      if (left_) return went_away();
      const double counts = moved / file_.model.step(static_cast<std::size_t>(joint));
      constexpr double kNoticed = 3;  // counts
      if (counts < -kNoticed) {
        return driver::Error{fmt::format(
            "Motor {} pulls against its encoder: its joint went {:.0f} counts the wrong way. Run "
            "`thimble feel-check`, which names the wire, and mend it or its sign in the arm file.",
            joint + 1, -counts)};
      }
      if (counts < kNoticed) {
        return driver::Error{fmt::format(
            "Motor {} moved its joint by {:.0f} counts under {:g} N: the tip is held, the joint "
            "sticks, or the motor is dead. Let go of the grip, and run `thimble feel-check`.",
            joint + 1, counts, pulse_)};
      }
    }
    return {};
  }

  driver::Result<ArmMotion> record(const MotionOrder& order) {
    ArmMotion motion;
    motion.dt = kTick;
    motion.added_mass = order.added_mass;
    motion.down_B = file_.R_WB.transpose() * Eigen::Vector3d(0, 0, -1);
    for (std::size_t i = 0; i < 3; ++i) {
      motion.step[static_cast<Eigen::Index>(i)] = file_.model.step(i);
    }
    motion.samples.reserve(static_cast<std::size_t>(order.seconds / kTick) + 1);
    Excitation excitation(p_WM_, {0, 0, kStandardGravity * order.added_mass}, order.seed,
                          Excitation::Lines::kWith, order.force_most);
    const double begin = bench_.now();
    const auto law = [&](const driver::DeviceState& state) -> Eigen::Vector3d {
      const double t = bench_.now() - begin;
      // What was sent in the tick before stands until now.
      if (!motion.samples.empty()) motion.samples.back().tau = sent_torque(motion.samples.back());
      if (t >= lead_) motion.samples.push_back(sample_of(file_, state));
      left_ = left_ || !within(state.p_WT);
      if (left_) return {0, 0, 0};
      return excitation.force(t, kTick, state.p_WT, state.v_WT);
    };
    const bool whole = bench_.run(lead_ + order.seconds, law, stop_);
    if (left_) return went_away();
    if (!whole) return why();
    if (!motion.samples.empty()) motion.samples.back().tau = sent_torque(motion.samples.back());
    return motion;
  }

 private:
  /// Returns whether the tip is where it may be pushed: near where it began, in the workspace.
  bool within(const Eigen::Vector3d& p_WT) const {
    return (p_WT - p_WM_).norm() < Excitation::kFar && file_.workspace.holds(p_WT);
  }

  static driver::Error went_away() {
    return driver::Error{
        "The tip left the space that it may move in, 4 cm about where it began and inside the "
        "workspace of the arm file, so the motors went off and nothing was kept: something pulls "
        "at "
        "it, or its motors are far stronger than the arm file says. "
        "Begin in the middle of the workspace, without a hand on the grip."};
  }

  /// Returns the torques of the force that stands, in the pose that it was sent for.
  Eigen::Vector3d sent_torque(const MotionSample& then) const {
    const Eigen::Vector3d f_T_B = file_.R_WB.transpose() * bench_.device().f_sent_W();
    return then.G.transpose().inverse() * f_T_B;
  }

  BenchArm& bench_;
  const scene::ArmFile& file_;
  double lead_;                    // s
  double pulse_;                   // N
  Eigen::Vector3d p_WM_{0, 0, 0};  // where it began, m
  bool left_ = false;              // that space, for good
  const std::atomic<bool>& stop_;
};

}  // namespace

driver::Result<ArmMotion> record_motion(BenchArm& bench, const scene::ArmFile& file,
                                        const MotionOrder& order, const std::atomic<bool>& stop) {
  Recorder recorder(bench, file, order, stop);
  const bool bare = order.added_mass == 0;
  if (auto begun = recorder.begin(bare); !begun) {
    bench.device().deactivate();
    return begun.error();
  }
  auto signs = bare ? recorder.check_signs() : driver::Result<void>();
  auto motion = signs ? recorder.record(order) : driver::Result<ArmMotion>(signs.error());
  bench.device().deactivate();
  return motion;
}

}  // namespace thimble::app
