#include "wall_trial.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "arm_simulation.h"
#include "thimble/driver/clock.h"
#include "thimble/driver/device.h"
#include "thimble/driver/servo_loop.h"

namespace thimble::app {
namespace {

constexpr double kAway = 0.003;   // m; where the hand waits before it goes in
constexpr double kBegin = 0.35;   // s; the soft start is over
constexpr double kEnd = 1.55;     // s
constexpr double kWatched = 0.2;  // s, the last of it

/// Is the wall as a force law.
class FlatWall {
 public:
  explicit FlatWall(const WallTrial& trial) : trial_(trial) {}

  driver::ForceCommand operator()(const driver::DeviceState& state) const noexcept {
    driver::ForceCommand command;
    const double depth = (trial_.p_W - state.p_WT).dot(trial_.n_W);
    if (!(depth > 0)) return command;
    const double force = trial_.stiffness * depth - trial_.damping * state.v_WT.dot(trial_.n_W);
    if (force > 0) command.f_T_W = force * trial_.n_W;
    return command;
  }

 private:
  const WallTrial& trial_;
};

/// Watches the true tip.
class Watch {
 public:
  Watch(const ArmSimulation& simulation, const ArmFile& arm, const WallTrial& trial)
      : simulation_(simulation), arm_(arm), trial_(trial) {}

  void operator()(const driver::TickRecord& record) noexcept {
    const Eigen::Vector3d p_WT = arm_.p_WB + arm_.R_WB * simulation_.board_arm()->plant().p_BT();
    const double force = Eigen::Map<const Eigen::Vector3d>(record.f_sent_W.data()).norm();
    touch.force_max = std::max(touch.force_max, force);
    if (begun_) energy_ += simulation_.f_T_W().dot(p_WT - p_WT_);
    touch.energy_given = std::max(touch.energy_given, energy_);
    begun_ = true;
    p_WT_ = p_WT;
    const double time = static_cast<double>(record.time_ns) * 1e-9;
    if (time < kEnd - kWatched) return;
    const double x = (p_WT - trial_.p_W).dot(trial_.n_W);
    least_ = std::min(least_, x);
    most_ = std::max(most_, x);
    touch.swing = most_ - least_;
    ++seen_;
    sum_ += force;
    squares_ += force * force;
    const double mean = sum_ / seen_;
    touch.force_rms = std::sqrt(std::max(0.0, squares_ / seen_ - mean * mean));
  }

  WallTouch touch;

 private:
  const ArmSimulation& simulation_;
  const ArmFile& arm_;
  const WallTrial& trial_;
  Eigen::Vector3d p_WT_{0, 0, 0};
  double energy_ = 0, least_ = 1e9, most_ = -1e9, sum_ = 0, squares_ = 0;
  int seen_ = 0;
  bool begun_ = false;
};

}  // namespace

driver::Result<WallTouch> press_on_wall(const ArmFile& arm, const WallTrial& trial) {
  // The hand's spring presses with `press` when it wants to be that far inside.
  const double deep = trial.press / std::max(1.0, arm.simulated.hand.stiffness);
  const Eigen::Vector3d away_W = trial.p_W + kAway * trial.n_W;
  const Eigen::Vector3d inside_W = trial.p_W - deep * trial.n_W;
  if (!joint_angles_at(arm, away_W) || !joint_angles_at(arm, inside_W)) {
    return driver::Error{"The wall stands out of the arm's reach."};
  }
  const double there = kBegin + (kAway + deep) / trial.speed;
  const std::vector<std::pair<double, Eigen::Vector3d>> way{
      {0, away_W}, {kBegin, away_W}, {there, inside_W}};
  auto simulation = ArmSimulation::make(arm, way);
  if (!simulation) return simulation.error();
  if ((*simulation)->board_arm() == nullptr) {
    return driver::Error{"The simulation of this arm has no board to try a wall with."};
  }
  driver::VirtualClock clock;
  auto device = driver::Device::open((*simulation)->wire(clock), (*simulation)->protocol(),
                                     {.R_WB = arm.R_WB,
                                      .p_WB = arm.p_WB,
                                      .limits = arm.limits,
                                      .energy = trial.energy,
                                      .velocity_corner_frequency = arm.velocity_corner_frequency},
                                     clock.now_ns());
  if (!device) return device.error();
  if (auto activated = (*device)->activate(); !activated) return activated.error();
  FlatWall law(trial);
  Watch watch(**simulation, arm, trial);
  const std::atomic<bool> stop{false};
  const auto period_ns = static_cast<std::int64_t>(std::llround(1e9 / trial.rate));
  const auto end = driver::run_servo(
      **device, clock, driver::ForceLaw(law), driver::TickSink(watch),
      {.period_ns = period_ns,
       .ticks = static_cast<std::uint64_t>(kEnd * 1e9 / static_cast<double>(period_ns))},
      stop);
  watch.touch.fault = end == driver::ServoEnd::kFault;
  watch.touch.gate = (*device)->gate_counters();
  return watch.touch;
}

driver::Result<double> simulated_edge(const ArmFile& arm, WallTrial trial, double guess,
                                      double quiet) {
  double low = guess / 10, high = guess * 10;
  while (high > 1.01 * low) {
    trial.stiffness = std::sqrt(low * high);
    const auto touch = press_on_wall(arm, trial);
    if (!touch) return touch.error();
    // Written so that NaN is not quiet.
    const bool rests = !touch->fault && touch->swing <= quiet;
    (rests ? low : high) = trial.stiffness;
  }
  return low;
}

}  // namespace thimble::app
