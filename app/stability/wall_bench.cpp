#include "stability/wall_bench.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "arm/report_timeout.h"
#include "simulated_arm.h"
#include "thimble/driver/clock.h"
#include "thimble/driver/device.h"
#include "thimble/scene/arm_simulation.h"

namespace thimble::stability {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Range of a report [DEVICES 1]: no limit acts below it.
constexpr double kCurrentMax = 32;  // A

constexpr int kKickTicks = 4;  // so that no kick exceeds the motors' current

constexpr double kCurrentStep = 1e-3;  // A, of the messages [DEVICES 1]

/// The tip at home, and the effect of one count of each encoder and of one step of each current.
struct HomeSteps {
  Vector3d p_WT;
  Matrix3d ways_W;      // columns: jumps by one count of each joint, m in the world
  Matrix3d currents_W;  // columns: currents for a force of 1 N along each axis of the world, A
  Matrix3d R_WB;
};

driver::Result<HomeSteps> home_steps(const scene::ArmFile& arm) {
  const Vector3d q = arm.model.joint_angles({});
  Vector3d p_BT;
  Matrix3d J_BT;
  if (arm.is<driver::DeltaArm>()) {
    return driver::Error{
        arm.name +
        ": the study needs an arm whose board sends reports on its own. Use another "
        "arm file, for example vintage_phantom.yaml."};
  }
  std::visit([&](const auto& build) { build.forward(q, p_BT, J_BT); }, arm.model.geometry);
  HomeSteps steps{.p_WT = arm.p_WB + arm.R_WB * p_BT,
                  .ways_W = arm.R_WB * J_BT,
                  .currents_W = {},
                  .R_WB = arm.R_WB};
  steps.currents_W = steps.ways_W.transpose();
  for (int i = 0; i < 3; ++i) {
    const auto joint = static_cast<std::size_t>(i);
    steps.ways_W.col(i) *= arm.model.step(joint);
    const driver::MotorDrive& drive = arm.model.drives[joint];
    steps.currents_W.row(i) /= drive.ratio * drive.torque_constant;
  }
  return steps;
}

ArmDirection along(const Vector3d& way_W, const HomeSteps& home) {
  const Vector3d n_W = way_W.normalized();
  const Vector3d steps = (home.ways_W.transpose() * n_W).cwiseAbs();
  return {.n_W = n_W,
          .p_WT = home.p_WT,
          .step = steps.sum(),
          .largest_step = steps.maxCoeff(),
          .friction_share = (home.R_WB.transpose() * n_W).lpNorm<1>(),
          .force_step = kCurrentStep / (home.currents_W * n_W).cwiseAbs().maxCoeff()};
}

/// Makes the arm of the case from that of the file.
scene::ArmFile arm_of(const scene::ArmFile& file, const WallCase& wall) {
  scene::ArmFile arm = file;
  arm.velocity_corner_frequency = wall.velocity_corner;
  arm.simulated.plant = wall.tip;
  arm.simulated.hand = wall.hand;
  arm.simulated.hand.tremor_amplitude = 0;
  if (!wall.own_wire) {
    arm.simulated.firmware.report_period_ns = wall.report_ns > 0 ? wall.report_ns : wall.period_ns;
    arm.simulated.wire = {.delay_in_ns = 0, .delay_out_ns = wall.delay_ns};
  }
  if (!wall.own_step && wall.step > 0) {
    const double finer = wall.direction.step / wall.step;
    for (auto& encoder : arm.model.encoders) {
      // The home pose stays in the middle of a step, as with the arm's own encoders. The position
      // of a wall between two steps determines whether it can rest.
      const auto own = static_cast<double>(encoder.home_counts);
      const double home = std::round(own * finer);
      encoder.counts_per_motor_turn *= home != 0 ? home / own : finer;
      encoder.home_counts = static_cast<std::int64_t>(home);
    }
  }
  if (!wall.own_step && !(wall.step > 0)) arm.simulated.firmware.ideal_encoders = true;
  if (!wall.own_limits) {
    // No limit acts: the soft start allows 20 N after a microsecond.
    arm.limits = {.force_max = 1e6,
                  .speed_max = 1e4,
                  .rise_max = 1e9,
                  .soft_start = 0.05,
                  .stall_ns = 1'000'000'000,
                  .watchdog_ns = 1'000'000'000};
    arm.simulated.motors.current_max = kCurrentMax;
    arm.simulated.firmware.current_range_mA = 32767;
    for (auto& drive : arm.model.drives) drive.current_max = kCurrentMax;
  }
  return arm;
}

}  // namespace

bool ArmDirection::is_one_dimensional() const {
  constexpr double kWithin = 0.01;  // the laws themselves hold to some percent
  return largest_step >= (1 - kWithin) * step && friction_share <= 1 + kWithin;
}

driver::Result<ArmDirection> worst_direction_at_home(const scene::ArmFile& arm) {
  const auto home = home_steps(arm);
  if (!home) return home.error();
  ArmDirection worst;
  for (int axis = 0; axis < 3; ++axis) {
    const ArmDirection one = along(arm.R_WB.col(axis), *home);
    if (one.step > worst.step) worst = one;
  }
  return worst;
}

driver::Result<ArmDirection> diagonal_direction_at_home(const scene::ArmFile& arm) {
  const auto home = home_steps(arm);
  if (!home) return home.error();
  const Matrix3d& ways = home->ways_W;
  // The sum of |n . way_i| is largest along the longest of the sums of the ways with any signs.
  Vector3d longest = Vector3d::Zero();
  for (int signs = 0; signs < 4; ++signs) {
    const Vector3d sum =
        ways.col(0) + (signs & 1 ? -1 : 1) * ways.col(1) + (signs & 2 ? -1 : 1) * ways.col(2);
    if (sum.norm() > longest.norm()) longest = sum;
  }
  return along(longest, *home);
}

driver::Result<ArmDirection> direction_at_home(const scene::ArmFile& arm, const Vector3d& way_W) {
  if (!(way_W.norm() > 0)) return driver::Error{"The direction must not be the zero vector."};
  const auto home = home_steps(arm);
  if (!home) return home.error();
  return along(way_W, *home);
}

double moved_mass(const scene::ArmFile& arm, const Vector3d& n_W) {
  Vector3d p_BT;
  Matrix3d J_BT;
  const Vector3d q = arm.model.joint_angles({});
  std::visit([&](const auto& build) { build.forward(q, p_BT, J_BT); }, arm.model.geometry);
  const Vector3d turned = J_BT.inverse() * (arm.R_WB.transpose() * n_W);
  return arm.simulated.plant.mass + turned.cwiseAbs2().dot(arm.simulated.drive_train.inertia);
}

driver::Result<WallRun> run_wall(const scene::ArmFile& file, const WallCase& wall) {
  const scene::ArmFile arm = arm_of(file, wall);
  const Vector3d n_W = wall.direction.n_W;
  const Vector3d home_W = wall.direction.p_WT;
  const auto hand_at = [&](double offset) { return Vector3d(home_W + offset * n_W); };
  std::vector<std::pair<double, Vector3d>> way{{0.0, hand_at(wall.hand_from)}};
  if (wall.hand_end > wall.hand_start) {
    way.emplace_back(std::max(wall.hand_start, 1e-6), hand_at(wall.hand_from));
    way.emplace_back(wall.hand_end, hand_at(wall.hand_to));
  }
  auto simulation = scene::ArmSimulation::make(arm, way);
  if (!simulation) return simulation.error();
  const device_sim::SimulatedArm* const board = (*simulation)->board_arm();
  if (board == nullptr) {
    return driver::Error{
        arm.name +
        ": walls can only be measured with an arm whose board sends reports on its "
        "own. Use another arm file, for example vintage_phantom.yaml."};
  }
  driver::VirtualClock clock;
  auto opened = driver::Device::open((*simulation)->link(clock),
                                     {.R_WB = arm.R_WB,
                                      .p_WB = arm.p_WB,
                                      .limits = arm.limits,
                                      .energy = wall.energy,
                                      // Disabled, because trials contain walls at rest.
                                      .motion = {.max_hold = 1e9},
                                      .velocity_corner_frequency = arm.velocity_corner_frequency,
                                      .silence_limit_ns = 1'000'000'000,
                                      .no_motors = true},
                                     clock.now_ns(), scene::report_timeout_ns(arm));
  if (!opened) return opened.error();
  driver::Device& device = **opened;
  if (auto active = device.activate(); !active) return active.error();

  WallRun run;
  const double mass = wall.tip.mass + wall.hand.mass;
  const double period = static_cast<double>(wall.period_ns) * 1e-9;
  const auto end_ns = static_cast<std::int64_t>(wall.duration * 1e9);
  const auto kick_ns = static_cast<std::int64_t>(wall.kick_start * 1e9);
  const auto pull_ns = static_cast<std::int64_t>(wall.pull_start * 1e9);
  int kick_ticks = 0;
  std::size_t gap = 0;
  // On a late wire the first report has taken its time.
  std::int64_t tick_ns = clock.now_ns();
  Vector3d p_last_W = arm.p_WB + arm.R_WB * board->plant().p_BT();
  double work = 0;
  for (std::size_t tick = 0; tick_ns < end_ns; ++tick) {
    clock.sleep_until_ns(tick_ns);
    const driver::DeviceState& state = device.read(tick_ns, tick_ns);
    const double depth = n_W.dot(state.p_WT - home_W) - wall.offset;
    double force = -wall.stiffness * depth - wall.damping * n_W.dot(state.v_WT);
    // A wall pushes outwards, along the direction, and never pulls.
    if (wall.one_sided) force = depth < 0 ? std::max(force, 0.0) : 0;
    if (wall.kick != 0 && kick_ticks < kKickTicks) {
      // The gate opens within the first tick, so the kick begins with the second.
      const bool kicks = tick > 0 && tick_ns >= kick_ns;
      force = kicks ? -wall.kick * mass / (kKickTicks * period) : 0;
      if (kicks) ++kick_ticks;
    }
    if (wall.pull != 0 && tick_ns >= pull_ns) force -= wall.pull;
    device.write({.f_T_W = force * n_W, .touch = {}});
    const Vector3d p_WT = arm.p_WB + arm.R_WB * board->plant().p_BT();
    run.time.push_back(static_cast<double>(tick_ns) * 1e-9);
    run.x.push_back(n_W.dot(p_WT - home_W));
    run.v.push_back(n_W.dot(arm.R_WB * board->plant().v_BT()));
    run.f.push_back(device.f_sent_W().norm());
    run.push.push_back(n_W.dot(device.f_sent_W()));
    work += (*simulation)->f_T_W().dot(p_WT - p_last_W);
    p_last_W = p_WT;
    run.work.push_back(work);
    run.fault = device.fault() != driver::Fault::kNone;
    run.gave_up = run.fault || !(std::abs(run.x.back() - wall.offset) < wall.give_up);
    if (run.gave_up) break;
    tick_ns += wall.gaps_ns.empty() ? wall.period_ns : wall.gaps_ns[gap];
    if (++gap >= wall.gaps_ns.size()) gap = 0;
  }
  run.gate = device.gate_counters();
  return run;
}

}  // namespace thimble::stability
