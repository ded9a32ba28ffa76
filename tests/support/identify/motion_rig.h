#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "arms/hfab/hfab_models.h"
#include "arms/hfab/hfab_report.h"
#include "arms/hfab/hfab_wire.h"
#include "board/sim_transport.h"
#include "simulated_arm.h"
#include "support/random.h"
#include "thimble/driver/clock.h"
#include "thimble/driver/device.h"
#include "thimble/driver/wire_arm.h"
#include "thimble/driver/wire_link.h"

namespace thimble::support {

/// An arm that moves as its file describes, with its data in code.
enum class MotionArm { kVintage, kWoody, kPolhem };
inline constexpr std::array kMotionArms{MotionArm::kVintage, MotionArm::kWoody, MotionArm::kPolhem};
inline constexpr std::array<std::string_view, 3> kMotionArmNames{"vintage_phantom", "woodenhaptics",
                                                                 "polhem"};

/// The touched surface. Free space is z > 0.
struct MotionScene {
  enum class Kind { kWall, kMovingWall, kSnapping, kThin, kInGravity };
  Kind kind = Kind::kWall;
  double stiffness = 800;  ///< N/m
  double damping = 0;      ///< N s/m
  double friction = 0.3;   ///< Coefficient.
};

/// A run of an arm, a hand and a scene, and its result.
struct MotionRun {
  MotionArm arm = MotionArm::kVintage;
  device_sim::HandSettings hand{.mass = 0.025,
                                .stiffness = 300,
                                .damping = 3,
                                .tremor_amplitude = 5e-5,
                                .tremor_frequency = 10};
  double coulomb = 0.04;  ///< N
  device_sim::WiringSettings wiring;
  MotionScene scene;
  bool energy_stage = true;
  double max_hold = 10;  ///< s
  std::uint64_t seed = 1;
  /// Targets of the hand: times (s) and points of the world (m).
  std::vector<std::pair<double, Eigen::Vector3d>> way;
  /// Changes the received counts; gets the number of the read.
  std::function<void(int, std::array<std::int16_t, 6>&)> tamper;

  // Results.
  driver::Fault fault = driver::Fault::kNone;
  std::uint64_t ticks = 0;
  double depth = 0;      ///< Depth of the true tip at the end, m.
  double speed = 0;      ///< Speed at the end, m/s.
  double max_force = 0;  ///< N

  void run(double duration);
};

namespace motion_rig {

/// Changes the reports of a simulated arm.
class TamperedWire final : public driver::Transport {
 public:
  TamperedWire(driver::Clock& clock, device_sim::SimulatedArm& arm, const MotionRun& run)
      : wire_(clock, arm), run_(run) {}
  driver::TransportRead read_latest(std::span<std::byte> buffer,
                                    std::int64_t deadline_ns) noexcept override {
    const driver::TransportRead read = wire_.read_latest(buffer, deadline_ns);
    auto report = driver::hfab::decode_input(buffer.first(read.size));
    if (!report || !run_.tamper) return read;
    run_.tamper(reads_++, report->counts);
    const auto bytes = driver::hfab::encode_input(*report);
    std::copy(bytes.begin(), bytes.end(), buffer.begin());
    return read;
  }
  driver::TransportStatus write(std::span<const std::byte> report) noexcept override {
    return wire_.write(report);
  }

 private:
  device_sim::SimTransport wire_;
  const MotionRun& run_;
  int reads_ = 0;
};

/// The force of a scene, with dry friction as a spring that breaks.
class Law {
 public:
  explicit Law(const MotionScene& scene) : scene_(scene) {}

  Eigen::Vector3d operator()(const driver::DeviceState& state) {
    using Kind = MotionScene::Kind;
    const double time = 1e-9 * static_cast<double>(state.time_ns);
    double surface = 0, v = state.v_WT.z();
    if (scene_.kind == Kind::kMovingWall) {
      const double turn = 2 * M_PI * 3 * time;
      surface = 0.004 * std::sin(turn);
      v -= 0.004 * 2 * M_PI * 3 * std::cos(turn);
    }
    const double depth = surface - state.p_WT.z();
    Eigen::Vector3d f(0, 0, scene_.kind == Kind::kInGravity ? -1.5 : 0);
    if (!(depth > 0)) {
      touching_ = false;
      return f;
    }
    double normal = std::max(0.0, scene_.stiffness * depth - scene_.damping * v);
    if (scene_.kind == Kind::kSnapping) normal = scene_.stiffness * std::fmod(depth, 0.006);
    if (scene_.kind == Kind::kThin && depth > 0.006) normal = 0;
    if (!touching_) stuck_at_ = state.p_WT;
    touching_ = true;
    const double grip = std::min(scene_.stiffness, 500.0);
    Eigen::Vector3d drag = grip * (stuck_at_ - state.p_WT);
    drag.z() = 0;
    const double max = scene_.friction * normal;
    if (drag.norm() > max) {
      drag *= max / drag.norm();
      stuck_at_ = state.p_WT + drag / grip;
    }
    return f + drag + Eigen::Vector3d(0, 0, normal);
  }

 private:
  MotionScene scene_;
  bool touching_ = false;
  Eigen::Vector3d stuck_at_{0, 0, 0};
};

}  // namespace motion_rig

inline void MotionRun::run(double duration) {
  driver::DeviceSettings settings;
  settings.limits = {.force_max = 5,
                     .speed_max = 3,
                     .rise_max = 2000,
                     .soft_start = 0.3,
                     .stall_ns = 20'000'000,
                     .watchdog_ns = 100'000'000};
  settings.velocity_corner_frequency = 100;
  constexpr std::array<double, 3> kMasses{0.075, 0.15, 0.1};  // kg, of the arm files
  const double mass = kMasses[static_cast<std::size_t>(arm)];
  const std::array<Eigen::Vector3d, 3> bases{Eigen::Vector3d(-0.138, 0, 0.112),
                                             Eigen::Vector3d(-0.22, 0, -0.08),
                                             Eigen::Vector3d(-0.2045, 0, -0.0325)};
  settings.p_WB = bases[static_cast<std::size_t>(arm)];
  settings.motion = {.mass = mass, .delay_ticks = 1, .max_hold = max_hold};
  if (energy_stage) {
    settings.energy = {.stage = driver::EnergyStage::kPassivity,
                       .mass = mass,
                       .allowance = 0.002,
                       .reservoir = 0.015,
                       .onset = 0.002,
                       .speed_floor = 0.02,
                       .delay_ticks = 1};
  }
  device_sim::SimulatedArmSettings arm_settings;
  arm_settings.plant = {.mass = mass, .viscous = 0.005, .coulomb = coulomb};
  arm_settings.hand = hand;
  arm_settings.motors.current_max = 6;
  arm_settings.firmware.wiring = wiring;
  arm_settings.wire.delay_out_ns = 1'000'000;
  std::vector<device_sim::HandPath::Point> points;
  for (const auto& [time, p_WH] : way) points.push_back({time, p_WH - settings.p_WB});
  const device_sim::HandPath path = device_sim::HandPath::make(points).value();

  std::unique_ptr<device_sim::SimulatedArm> simulated;
  std::unique_ptr<const driver::Arm> protocol;
  if (arm == MotionArm::kPolhem) {
    const auto model = driver::hfab::polhem_model();
    simulated = std::make_unique<device_sim::SimulatedArm>(
        device_sim::SimulatedArm::make(model, arm_settings, path, seed).value());
    protocol =
        std::make_unique<driver::WireArm<driver::hfab::ReportWire, driver::LinkageArm>>(model);
  } else {
    const auto built =
        arm == MotionArm::kVintage ? driver::hfab::vintage_model() : driver::hfab::woody_model();
    simulated = std::make_unique<device_sim::SimulatedArm>(
        device_sim::SimulatedArm::make(built, arm_settings, path, seed).value());
    protocol = std::make_unique<driver::hfab::HfabArm>(built);
  }
  driver::VirtualClock clock;
  auto opened =
      driver::Device::open(std::make_unique<driver::WireLink>(
                               std::make_unique<motion_rig::TamperedWire>(clock, *simulated, *this),
                               std::move(protocol)),
                           settings, clock.now_ns());
  if (!opened) throw std::runtime_error(opened.error().message);
  driver::Device& device = **opened;
  if (!device.activate()) throw std::runtime_error("not active");
  motion_rig::Law law(scene);
  for (std::int64_t tick = 0; tick < std::llround(duration * 1e3); ++tick) {
    clock.sleep_until_ns(tick * 1'000'000);
    const driver::DeviceState& state = device.read(clock.now_ns(), clock.now_ns());
    device.write({.f_T_W = law(state), .touch = {}});
    max_force = std::max(max_force, device.f_sent_W().norm());
    ++ticks;
    fault = device.fault();
    if (fault != driver::Fault::kNone) break;
  }
  depth = -(simulated->plant().p_BT().z() + settings.p_WB.z());
  speed = simulated->plant().v_BT().norm();
}

/// Draws random motion of a hand in a random scene: 100 to 1000 N/m, 0.05 to 1.5 m/s, taps,
/// presses, and strokes into and through a wall. The paths are straight lines with corners, or as
/// smooth as a person's (60 m/s^2).
inline MotionRun any_hand(std::uint64_t seed, double duration) {
  Random random(seed);
  const auto spread = [&](double low, double high) {
    return low * std::pow(high / low, random.uniform(0, 1));
  };
  MotionRun run;
  run.seed = seed;
  run.arm = kMotionArms[random.bits() % 3];
  run.hand = {.mass = spread(0.01, 0.1),
              .stiffness = spread(100, 1000),
              .damping = spread(1, 10),
              .tremor_amplitude = random.bits() % 2 == 0 ? 5e-5 : 0,
              .tremor_frequency = 10};
  run.coulomb = random.uniform(0, 0.1);
  run.scene.kind = static_cast<MotionScene::Kind>(random.bits() % 5);
  run.scene.stiffness = spread(100, 1500);
  run.scene.damping = random.bits() % 2 == 0 ? 0 : random.uniform(0, 5);
  run.scene.friction = random.bits() % 2 == 0 ? 0 : random.uniform(0, 1);
  run.energy_stage = random.bits() % 4 != 0;
  const bool smooth = random.bits() % 2 == 0;
  const double speed = spread(0.05, 1.5);
  const auto habit = random.bits() % 6;

  double time = 0;
  Eigen::Vector3d p(0, 0, 0.01);
  const auto wait = [&](double seconds) { run.way.emplace_back(time += seconds, p); };
  const auto go = [&](const Eigen::Vector3d& to, double at_speed) {
    const double length = (to - p).norm();
    double lasts = std::max(length / at_speed, 0.004);
    if (smooth) lasts = std::max(lasts, std::sqrt(5.77 * length / 60));
    const int parts = smooth ? std::max(2, static_cast<int>(lasts / 0.004)) : 1;
    for (int i = 1; i <= parts; ++i) {
      const double s = static_cast<double>(i) / parts;
      const double share = smooth ? s * s * s * (10 + s * (-15 + 6 * s)) : s;
      run.way.emplace_back(time + lasts * s, p + share * (to - p));
    }
    time += lasts;
    p = to;
  };
  run.way.emplace_back(0, p);
  wait(0.35);
  while (time < duration) {
    const double deep = random.uniform(0.002, 0.03);
    const double x = random.uniform(-0.03, 0.03), y = random.uniform(-0.03, 0.03);
    if (habit == 0) {  // taps
      go({p.x(), p.y(), -deep}, speed);
      go({p.x(), p.y(), 0.01}, speed);
    } else if (habit == 1) {  // presses of any depth
      go({p.x(), p.y(), -deep}, speed);
      wait(random.uniform(0.001, 0.2));
    } else if (habit == 2) {  // strokes into it
      go({x, y, -deep}, speed);
    } else if (habit == 3) {  // strokes along it
      go({p.x(), p.y(), -0.003 - 0.2 * deep}, 0.3);
      go({x, y, p.z()}, speed);
      go({x, y, 0.01}, speed);
    } else if (habit == 4) {  // rests on it, then pushes
      go({p.x(), p.y(), -0.002}, 0.2);
      wait(random.uniform(0.02, 0.1));
      go({p.x(), p.y(), -deep}, speed);
      wait(random.uniform(0.001, 0.1));
      go({p.x(), p.y(), -0.002}, speed);
    } else {  // anywhere
      go({x, y, random.uniform(-0.04, 0.02)}, speed);
    }
  }
  return run;
}

}  // namespace thimble::support
