#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <utility>
#include <variant>
#include <vector>

#include "hand/hand_path.h"
#include "hand/tremor.h"
#include "plant/axis_dynamics.h"
#include "support/identify/motion_rig.h"
#include "support/random.h"
#include "thimble/driver/arm_link.h"
#include "thimble/driver/arm_model.h"
#include "thimble/driver/clock.h"
#include "thimble/driver/device.h"
#include "thimble/driver/wire_arm.h"

namespace thimble::support {

/// Fault of an arm.
enum class Trouble {
  kNone,
  kAllReversed,       ///< All motors reversed from the start.
  kOneReversed,       ///< One joint reversed from the start.
  kTouchReversed,     ///< All reversed from a moment in the middle of a touch.
  kTouchOneReversed,  ///< One joint reversed from such a moment.
  kDoubled,           ///< Doubled gain of the amplifiers.
  kStuck,             ///< One amplifier holds its current from such a moment.
  kOneSided,          ///< One amplifier gives no current of one sign.
  kLate,              ///< Reports are 5 ms late.
  kFrozen,            ///< One encoder stops from such a moment.
};

/// All data of an arm of any kind that a run of strokes needs.
struct StrokedArm {
  driver::ArmModel model;
  bool has_motors = true;  ///< False for an arm behind its vendor's library.
  Eigen::Matrix3d R_WB = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_WB{0, 0, 0};
  driver::GateLimits limits;
  driver::EnergyGuardSettings energy;
  driver::MotionWatchSettings watch;
  device_sim::PlantSettings plant;
  double velocity_corner_frequency = 100;
  double step = 1e-5;  ///< Resolution of a position without encoders, m.
};

/// A run of strokes, and its result.
struct StrokeRun {
  device_sim::HandSettings hand{.mass = 0.025,
                                .stiffness = 300,
                                .damping = 3,
                                .tremor_amplitude = 5e-5,
                                .tremor_frequency = 10};
  MotionScene scene;
  std::vector<std::pair<double, Eigen::Vector3d>> way;  ///< As in MotionRun.
  Trouble trouble = Trouble::kNone;
  int joint = 0;       ///< The faulty joint, if only one is.
  double begin = 0.7;  ///< A fault in a touch starts at the first force after this time, s.
  std::uint64_t seed = 1;
  /// Called in each tick, before its force is sent; returns whether to stop.
  std::function<bool(const driver::Device&, const Eigen::Matrix3d& J_BT)> look;

  driver::Fault fault = driver::Fault::kNone;
  std::uint64_t ticks = 0;
  double end = 0;         ///< s
  double shown_at = -1;   ///< Time at which the fault first has an effect of 0.3 N, s.
  double way_since = 0;   ///< Path of the true tip since then, m.
  double off_since = 0;   ///< Largest distance of the true tip from its position then, m.
  double speed = 0;       ///< Largest speed since then, m/s.
  double force_true = 0;  ///< Largest force of the motors, N.
  double force_sent = 0;  ///< Largest sent force, N.
  double unseen = 0;      ///< Largest motion of the tip by a frozen joint, m.
};

namespace stroke_rig {

/// Returns the force at the tip for joint torques.
inline Eigen::Vector3d force_of(const Eigen::Matrix3d& J, const Eigen::Vector3d& tau) {
  const Eigen::Vector3d a = J.col(0), b = J.col(1), c = J.col(2);
  return (tau[0] * b.cross(c) + tau[1] * c.cross(a) + tau[2] * a.cross(b)) / a.dot(b.cross(c));
}

/// The tip of an arm in a hand, and the link to it: a mass of three axes with the exact map of the
/// simulated arm, motors with a delay of one tick, and encoders.
class StrokedLink final : public driver::ArmLink {
 public:
  StrokedLink(const StrokedArm& arm, StrokeRun& run, driver::Clock& clock,
              const Eigen::Vector3d& begin_W, device_sim::HandPath path, device_sim::Tremor tremor)
      : arm_(arm),
        run_(run),
        clock_(clock),
        traits_{.has_joints = arm.has_motors, .has_counts = arm.has_motors},
        dynamics_(device_sim::AxisDynamics::make(arm.plant, run.hand).value()),
        path_(std::move(path)),
        tremor_(tremor) {
    if (arm.has_motors) traits_.motors = arm.model.drives;
    const Eigen::Vector3d p_B = arm.R_WB.transpose() * (begin_W - arm.p_WB);
    for (int i = 0; i < 3; ++i) axes_[static_cast<std::size_t>(i)] = {p_B[i], 0};
    anchor_ = wanted(0);
  }

  const driver::ArmTraits& traits() const noexcept override { return traits_; }

  driver::LinkRead read(driver::ArmSample& sample, std::int64_t) noexcept override {
    advance_to(clock_.now_ns());
    driver::ArmSample fresh = measured();
    // Late reports come from a queue.
    constexpr std::size_t kLate = 5;
    for (std::size_t i = kLate; i > 0; --i) queue_[i] = queue_[i - 1];
    queue_[0] = fresh;
    if (reads_++ == 0) queue_.fill(fresh);
    sample = queue_[run_.trouble == Trouble::kLate ? kLate : 0];
    J_ = sample.pose.J_BT;
    return {driver::LinkStatus::kOk};
  }

  driver::LinkWrite write(const driver::GatedForce& force, const driver::ArmSample& sample,
                          const Eigen::Matrix3d& R_WB) noexcept override {
    advance_to(clock_.now_ns());
    double scale = 1;
    Eigen::Vector3d tau;
    const Eigen::Matrix3d& J = sample.pose.J_BT;
    if (arm_.has_motors) {
      currents_ = driver::MotorCurrents(force, R_WB, J, arm_.model.drives);
      scale = currents_.scale();
      const auto mA = driver::whole_mA(currents_);
      for (std::size_t i = 0; i < 3; ++i) {
        const driver::MotorDrive& drive = arm_.model.drives[i];
        tau[static_cast<int>(i)] = drive.sign * drive.ratio * drive.torque_constant * 1e-3 * mA[i];
      }
    } else {
      tau = R_WB.transpose() * force.f_T_W();
    }
    const Eigen::Vector3d sound = tau;
    spoil(tau, J);
    if (run_.shown_at < 0 && shows(sound, tau, J)) {
      run_.shown_at = time();
      shown_p_ = last_p_ = p_B();
    }
    tau_next_ = tau;
    return {driver::LinkStatus::kOk, scale};
  }
  driver::MotorCurrents currents() const noexcept override { return currents_; }
  bool numbers_reports() const noexcept override { return true; }

  Eigen::Vector3d p_B() const { return {axes_[0].x, axes_[1].x, axes_[2].x}; }
  Eigen::Vector3d v_B() const { return {axes_[0].v, axes_[1].v, axes_[2].v}; }
  const Eigen::Matrix3d& J() const { return J_; }

 private:
  double time() const { return 1e-9 * static_cast<double>(time_ns_); }
  Eigen::Vector3d wanted(std::int64_t time_ns) {
    return path_.at(1e-9 * static_cast<double>(time_ns)) + tremor_.at(time_ns);
  }
  bool in_touch_trouble() const {
    return run_.trouble == Trouble::kTouchReversed || run_.trouble == Trouble::kTouchOneReversed ||
           run_.trouble == Trouble::kStuck || run_.trouble == Trouble::kFrozen;
  }

  /// Returns whether the wrong part of the force is 0.3 N at the tip.
  bool shows(const Eigen::Vector3d& sound, const Eigen::Vector3d& tau,
             const Eigen::Matrix3d& J) const {
    if (run_.trouble == Trouble::kNone) return false;
    if (run_.trouble == Trouble::kLate || run_.trouble == Trouble::kFrozen) {
      return begun_ && force_of(J, sound).norm() >= 0.3;
    }
    const Eigen::Vector3d wrong = tau - sound;
    for (int i = 0; i < 3; ++i) {
      const double arm = J.col(i).norm();
      const double part = std::max(std::abs(wrong[i]) / 2, std::abs(sound[i])) / arm;
      if (wrong[i] != 0 && part >= 0.3) return true;
    }
    return false;
  }

  void spoil(Eigen::Vector3d& tau, const Eigen::Matrix3d& J) {
    if (!begun_) {
      const double f = std::abs(tau[run_.joint]) / J.col(run_.joint).norm();
      begun_ = !in_touch_trouble() ||
               (time() >= run_.begin && (run_.trouble == Trouble::kTouchReversed
                                             ? force_of(J, tau).norm() >= 1
                                             : run_.trouble == Trouble::kFrozen || f >= 0.5));
      if (begun_) stuck_ = tau;
    }
    if (!begun_) return;
    const int i = run_.joint;
    switch (run_.trouble) {
      case Trouble::kAllReversed:
      case Trouble::kTouchReversed:
        tau = -tau;
        break;
      case Trouble::kOneReversed:
      case Trouble::kTouchOneReversed:
        tau[i] = -tau[i];
        break;
      case Trouble::kDoubled:
        tau *= 2;
        break;
      case Trouble::kStuck:
        tau[i] = stuck_[i];
        break;
      case Trouble::kOneSided:
        tau[i] = run_.seed % 2 == 0 ? std::max(tau[i], 0.0) : std::min(tau[i], 0.0);
        break;
      default:
        break;
    }
  }

  driver::ArmSample measured() {
    driver::ArmSample sample;
    if (!arm_.has_motors) {
      for (int i = 0; i < 3; ++i) {
        const double x = axes_[static_cast<std::size_t>(i)].x;
        if (!(begun_ && run_.trouble == Trouble::kFrozen && i == run_.joint) || reads_ == 0) {
          held_p_[i] = std::round(x / arm_.step) * arm_.step;
        }
      }
      sample.pose.p_BT = held_p_;
      return sample;
    }
    const auto q = driver::inverse(arm_.model.geometry, p_B());
    if (q) {
      const Eigen::Vector3d counts = arm_.model.exact_counts(*q);
      for (int i = 0; i < 3; ++i) {
        if (begun_ && run_.trouble == Trouble::kFrozen && i == run_.joint) continue;
        counts_[static_cast<std::size_t>(i)] = static_cast<std::int32_t>(std::lround(counts[i]));
      }
      if (begun_ && run_.trouble == Trouble::kFrozen) {
        const auto k = static_cast<std::size_t>(run_.joint);
        const double off = (counts[run_.joint] - counts_[k]) * arm_.model.step(k);
        run_.unseen = std::max(run_.unseen, std::abs(off) * J_.col(run_.joint).norm());
      }
    }
    sample.counts = counts_;
    sample.pose.q = arm_.model.joint_angles({.counts = counts_});
    std::visit(
        [&](const auto& build) {
          build.forward(sample.pose.q, sample.pose.p_BT, sample.pose.J_BT);
        },
        arm_.model.geometry);
    return sample;
  }

  void advance_to(std::int64_t now_ns) {
    while (time_ns_ < now_ns) {
      const Eigen::Vector3d anchor = wanted(time_ns_ + kTick_ns);
      const Eigen::Vector3d speed = (anchor - anchor_) * 1e3;
      Eigen::Vector3d f_B = tau_;
      if (arm_.has_motors) {
        f_B = force_of(J_true(), tau_);
      }
      run_.force_true = std::max(run_.force_true, f_B.norm());
      for (int i = 0; i < 3; ++i) {
        dynamics_.step(axes_[static_cast<std::size_t>(i)],
                       {.force = f_B[i], .anchor = anchor_[i], .anchor_speed = speed[i]}, kTick_ns);
      }
      anchor_ = anchor;
      time_ns_ += kTick_ns;
      tau_ = tau_next_;
      if (run_.shown_at >= 0) {
        run_.way_since += (p_B() - last_p_).norm();
        last_p_ = p_B();
        run_.off_since = std::max(run_.off_since, (p_B() - shown_p_).norm());
        run_.speed = std::max(run_.speed, v_B().norm());
      }
    }
  }

  Eigen::Matrix3d J_true() const {
    // One tick out of date; for a frozen joint, the intact geometry.
    if (run_.trouble != Trouble::kFrozen) return J_;
    const auto q = driver::inverse(arm_.model.geometry, p_B());
    if (!q) return J_;
    Eigen::Vector3d p;
    Eigen::Matrix3d J;
    std::visit([&](const auto& build) { build.forward(*q, p, J); }, arm_.model.geometry);
    return J;
  }

  static constexpr std::int64_t kTick_ns = 1'000'000;
  const StrokedArm& arm_;
  StrokeRun& run_;
  driver::Clock& clock_;
  driver::ArmTraits traits_;
  device_sim::AxisDynamics dynamics_;
  device_sim::HandPath path_;
  device_sim::Tremor tremor_;
  std::array<device_sim::AxisState, 3> axes_;
  std::array<driver::ArmSample, 6> queue_;
  driver::MotorCurrents currents_;
  std::array<std::int32_t, 3> counts_{};
  Eigen::Vector3d held_p_{0, 0, 0};
  Eigen::Vector3d anchor_{0, 0, 0}, tau_{0, 0, 0}, tau_next_{0, 0, 0}, stuck_{0, 0, 0};
  Eigen::Vector3d shown_p_{0, 0, 0}, last_p_{0, 0, 0};
  Eigen::Matrix3d J_ = Eigen::Matrix3d::Identity();
  std::int64_t time_ns_ = 0;
  int reads_ = 0;
  bool begun_ = false;
};

}  // namespace stroke_rig

/// Runs the strokes for `duration` (s), or until a fault.
inline void run_strokes(const StrokedArm& arm, StrokeRun& run, double duration) {
  std::vector<device_sim::HandPath::Point> points;
  for (const auto& [time, p_WH] : run.way) {
    points.push_back({time, arm.R_WB.transpose() * (p_WH - arm.p_WB)});
  }
  driver::VirtualClock clock;
  auto link = std::make_unique<stroke_rig::StrokedLink>(
      arm, run, clock, run.way.front().second, device_sim::HandPath::make(points).value(),
      device_sim::Tremor::make(run.hand, run.seed).value());
  const stroke_rig::StrokedLink& tip = *link;
  driver::DeviceSettings settings{.R_WB = arm.R_WB,
                                  .p_WB = arm.p_WB,
                                  .limits = arm.limits,
                                  .energy = arm.energy,
                                  .motion = arm.watch,
                                  .velocity_corner_frequency = arm.velocity_corner_frequency};
  auto opened = driver::Device::open(std::move(link), settings, clock.now_ns());
  if (!opened) throw std::runtime_error(opened.error().message);
  driver::Device& device = **opened;
  if (!device.activate()) throw std::runtime_error("not active");
  motion_rig::Law law(run.scene);
  for (std::int64_t tick = 0; tick < std::llround(duration * 1e3); ++tick) {
    clock.sleep_until_ns(tick * 1'000'000);
    const driver::DeviceState& state = device.read(clock.now_ns(), clock.now_ns());
    const driver::ForceCommand command{.f_T_W = law(state), .touch = {}};
    if (run.look && run.look(device, tip.J())) break;
    device.write(command);
    run.force_sent = std::max(run.force_sent, device.f_sent_W().norm());
    ++run.ticks;
    run.fault = device.fault();
    if (run.fault != driver::Fault::kNone) break;
  }
  run.end = 1e-3 * static_cast<double>(run.ticks);
}

/// Draws strokes of a person: straight lines at 0.05 to 0.6 m/s between points around a wall.
/// Returns their number.
inline int draw_strokes(StrokeRun& run, std::uint64_t seed, double duration, double reach = 0.02) {
  Random random(seed);
  run.seed = seed;
  const double speed = 0.05 * std::pow(12, random.uniform(0, 1));
  Eigen::Vector3d p(0, 0, 0.01);
  double time = 0.5;
  run.way = {{0, p}, {time, p}};
  int strokes = 0;
  while (time < duration) {
    const Eigen::Vector3d to{random.uniform(-reach, reach), random.uniform(-reach, reach),
                             random.uniform(-reach, reach / 5)};
    time += std::max((to - p).norm() / speed, 0.01);
    run.way.emplace_back(time, to);
    p = to;
    ++strokes;
  }
  return strokes;
}

/// Returns an arm with its data in code, as in MotionRun.
inline StrokedArm stroked_arm(MotionArm kind) {
  StrokedArm arm;
  double mass = 0.1;
  switch (kind) {
    case MotionArm::kVintage:
      arm.model = driver::arm_model(driver::hfab::vintage_model());
      arm.p_WB = {-0.138, 0, 0.112};
      mass = 0.075;
      break;
    case MotionArm::kWoody:
      arm.model = driver::arm_model(driver::hfab::woody_model());
      arm.p_WB = {-0.22, 0, -0.08};
      mass = 0.15;
      break;
    case MotionArm::kPolhem:
      arm.model = driver::arm_model(driver::hfab::polhem_model());
      arm.p_WB = {-0.2045, 0, -0.0325};
      break;
  }
  arm.limits = {.force_max = 5,
                .speed_max = 3,
                .rise_max = 2000,
                .soft_start = 0.3,
                .stall_ns = 20'000'000,
                .watchdog_ns = 100'000'000};
  arm.energy = {.stage = driver::EnergyStage::kPassivity,
                .mass = mass,
                .allowance = 0.002,
                .reservoir = 0.015,
                .onset = 0.002,
                .speed_floor = 0.02,
                .delay_ticks = 1};
  arm.watch = {.mass = mass, .delay_ticks = 1, .max_hold = 10};
  arm.plant = {.mass = mass, .viscous = 0.005, .coulomb = 0.04};
  return arm;
}

/// Draws strokes of any hand at a wall of any stiffness and friction. The arm is turned at random
/// about its tip, with dry friction up to 0.3 N and a force limit of 3 to 9 N.
inline void draw_turned(StrokeRun& run, StrokedArm& arm, std::uint64_t seed, double duration) {
  Random random(seed + 4242);
  const auto spread = [&](double low) { return low * std::pow(10, random.uniform(0, 1)); };
  Eigen::Vector4d turn;
  for (Eigen::Index i = 0; i < 4; ++i) turn[i] = random.uniform(-1, 1);
  arm.R_WB = Eigen::Quaterniond(turn[3], turn[2], turn[1], turn[0]).normalized().toRotationMatrix();
  arm.p_WB = arm.R_WB * arm.p_WB;
  arm.plant.coulomb = random.uniform(0, 0.3);
  arm.limits.force_max = random.uniform(3, 9);
  draw_strokes(run, seed, duration, random.uniform(0.01, 0.03));
  run.hand.stiffness = spread(100);
  run.hand.damping = spread(1);
  run.hand.mass = spread(0.01);
  if (random.bits() % 2 != 0) run.hand.tremor_amplitude = 0;
  run.scene.stiffness = spread(200);
  run.scene.friction = random.bits() % 2 != 0 ? 0 : random.uniform(0, 1);
}

/// Draws random motion of a hand in a random scene, like `any_hand`. Returns the number of strokes.
inline int draw_any(StrokeRun& run, StrokedArm& arm, std::uint64_t seed, double duration) {
  const MotionRun any = any_hand(seed, duration);
  run.seed = seed;
  run.hand = any.hand;
  run.scene = any.scene;
  run.way = any.way;
  arm.plant.coulomb = any.coulomb;
  if (!any.energy_stage) arm.energy = {};
  int strokes = 0;
  for (std::size_t i = 2; i < run.way.size(); ++i) {
    const Eigen::Vector3d before = run.way[i - 1].second - run.way[i - 2].second;
    const Eigen::Vector3d after = run.way[i].second - run.way[i - 1].second;
    strokes += after.norm() > 0 && before.dot(after) < 0.9 * before.norm() * after.norm() ? 1 : 0;
  }
  return strokes;
}

}  // namespace thimble::support
