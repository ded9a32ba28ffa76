// Valid forces pass unchanged through scene, gate, wire and arm, with the shipped gate of each arm.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "support/scratch.h"
#include "thimble/driver/servo_loop.h"
#include "thimble/scene/scene_file.h"
#include "thimble/scene/simulated_device.h"
#include "thimble/session/session.h"

namespace thimble {
namespace {

using Eigen::Vector3d;

Vector3d plain(const std::array<double, 3>& v) {
  return {v[0], v[1], v[2]};
}

/// Runs a scene and expects that every force after the soft start was sent as requested.
void expect_untouched(const std::filesystem::path& scene, std::size_t arms = 1,
                      const std::function<void(scene::Scene&)>& adjust = {}) {
  session::SessionOptions options;
  options.adjust = adjust;
  options.several_arms = true;
  auto opened = session::Session::open(scene, options);
  ASSERT_TRUE(opened) << opened.error().message;
  session::Session& session = **opened;
  session.run();
  for (std::size_t arm = 0; arm < arms; ++arm) {
    const session::RunFigures figures = session.figures({}, arm);
    EXPECT_EQ(figures.energy_stage, driver::EnergyStage::kPassivity);
    EXPECT_EQ(figures.gate.damped, 0U) << scene;
    EXPECT_EQ(figures.gate.power_limited, 0U);
    double squares = 0;
    int changed = 0;
    for (const driver::TickRecord& tick : session.ticks(arm)) {
      const Vector3d wanted = plain(tick.f_wanted_W), sent = plain(tick.f_sent_W);
      if (tick.time_ns < 500'000'000) continue;
      squares += sent.squaredNorm();
      changed += (sent - wanted).norm() <= 0.01 * wanted.norm() ? 0 : 1;
    }
    EXPECT_EQ(changed, 0) << scene;
    EXPECT_GT(squares, 0) << "no force: this test could not fail";
  }
}

std::filesystem::path shipped(const std::string& name) {
  return std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/scenes" / (name + ".yaml");
}

TEST(RightForces, AWeightIsFeltWhole) {
  const auto file = support::scratch_folder() / "weight.yaml";
  std::ofstream(file) << "name: weight\n"
                         "description: A weight of 0.2 kg that the hand carries about.\n"
                         "arm: "
                      << THIMBLE_SOURCE_DIR
                      << "/app/arms/vintage_phantom.yaml\n"
                         "duration: 30\nseed: 1\n"
                         "objects:\n  - {name: weight, field: gravity, mass: 0.2}\n"
                         "hand:\n  path:\n";
  std::ofstream out(file, std::ios::app);
  for (int i = 0; i <= 30; ++i) {
    out << "    - {t: " << i << ", at: [" << 0.02 * std::sin(i) << ", " << 0.02 * std::cos(2 * i)
        << ", " << (i % 2 == 0 ? 0.03 : -0.03) << "]}\n";
  }
  out.close();
  expect_untouched(file);
}

TEST(RightForces, ChargesAndSnapsAreFeltWhole) {
  expect_untouched(shipped("charges"));
}

TEST(RightForces, AHeldBlockIsFeltWhole) {
  expect_untouched(shipped("held_block"));
}

TEST(RightForces, ABeamBetweenTwoHandsIsFeltWhole) {
  expect_untouched(shipped("two_hands"), 2);
}

/// Repeats the route of a hand until the end of a run.
void repeat(std::vector<scene::HandWaypoint>& route, double seconds) {
  const std::vector<scene::HandWaypoint> once = route;
  const double length = once.back().time;
  for (double begin = length; begin < seconds; begin += length) {
    for (auto waypoint = once.begin() + 1; waypoint != once.end(); ++waypoint) {
      route.push_back(*waypoint);
      route.back().time += begin;
    }
  }
}

TEST(RightForces, ABeamIsFeltWholeForAMinute) {
  expect_untouched(shipped("two_hands"), 2, [](scene::Scene& scene) {
    scene.duration = 60;
    for (scene::SceneArm& arm : scene.arms) repeat(arm.hand, scene.duration);
  });
}

TEST(RightForces, APushedBlockIsFeltWhole) {
  expect_untouched(shipped("floating_block"));
}

// Forces of programs, as with `thimble exec` and the ROS topic: the program computes the whole
// force.

using ProgramLaw = std::function<Vector3d(const driver::DeviceState&)>;

/// Result of a program's forces.
struct Program {
  double error = 0;  // max. difference of sent and requested force after 0.5 s, N
  double most = 0;   // max. requested force, N
  double swing = 0;  // range of the true tip in the last 0.2 s, m
  driver::GateCounters gate;
};

/// Runs a program's law on a simulated arm whose hand follows a path.
Program run_program(const std::string& arm, const scene::HandRoute& route, double seconds,
                    const ProgramLaw& asked, double damping = -1) {
  auto file = scene::load_arm(arm);
  EXPECT_TRUE(file) << file.error().message;
  if (damping >= 0) file->simulated.hand.damping = damping;
  auto opened = scene::SimulatedDevice::open(*file, route);
  EXPECT_TRUE(opened) << opened.error().message;
  scene::SimulatedDevice& device = **opened;
  EXPECT_TRUE(device.device().activate());
  Program program;
  double low = 1, high = -1;
  auto law = [&](const driver::DeviceState& state) noexcept {
    driver::ForceCommand command;
    command.f_T_W = command.f_program_W = asked(state);
    return command;
  };
  auto sink = [&](const driver::TickRecord& tick) noexcept {
    if (tick.time_ns > 500'000'000) {
      const Vector3d wanted = plain(tick.f_wanted_W);
      program.error = std::max(program.error, (wanted - plain(tick.f_sent_W)).norm());
      program.most = std::max(program.most, wanted.norm());
    }
    if (1e-9 * static_cast<double>(tick.time_ns) < seconds - 0.2) return;
    low = std::min(low, tick.p_WT[0]);
    high = std::max(high, tick.p_WT[0]);
  };
  const std::atomic<bool> never{false};
  driver::run_servo(
      device.device(), device.clock(), driver::ForceLaw(law), driver::TickSink(sink),
      {.period_ns = device.period_ns(), .ticks = static_cast<std::uint64_t>(1e3 * seconds)}, never);
  program.swing = high - low;
  program.gate = device.device().gate_counters();
  EXPECT_EQ(device.device().fault(), driver::Fault::kNone);
  return program;
}

scene::HandRoute still() {
  return {{0, {0, 0, 0}}, {100, {0, 0, 0}}};
}

TEST(RightForces, AProgramsConstantForceArrives) {
  for (const char* arm : {"vintage_phantom", "woodenhaptics", "polhem", "falcon"}) {
    const Program run =
        run_program(arm, still(), 10, [](const driver::DeviceState&) { return Vector3d(0, 0, 3); });
    EXPECT_EQ(run.error, 0) << arm;
    EXPECT_EQ(run.gate.oscillations, 0U);
  }
}

TEST(RightForces, AProgramsVibrationArrives) {
  for (const double frequency : {10.0, 50.0, 200.0}) {
    const Program run =
        run_program("vintage_phantom", still(), 4, [=](const driver::DeviceState& s) {
          const double t = 1e-9 * static_cast<double>(s.time_ns);
          return Vector3d(1.05 * std::sin(2 * std::numbers::pi * frequency * t), 0, 0);
        });
    EXPECT_EQ(run.error, 0) << frequency;
  }
}

TEST(RightForces, AProgramsSphereArrives) {
  // As in the first example of OpenHaptics: strokes a sphere of 40 mm, 250 N/m.
  const scene::HandRoute route{{0, {0, 0, 0.06}},  {1, {0, 0, 0.031}},     {2, {0.02, 0, 0.024}},
                               {3, {0, 0, 0.031}}, {4, {-0.02, 0, 0.024}}, {5, {0, 0, 0.06}}};
  const Program run = run_program("vintage_phantom", route, 5, [](const driver::DeviceState& s) {
    const double r = s.p_WT.norm();
    return r < 0.04 && r > 0 ? Vector3d(250 * (0.04 - r) / r * s.p_WT) : Vector3d(0, 0, 0);
  });
  EXPECT_GT(run.most, 1);
  EXPECT_EQ(run.error, 0);
}

TEST(RightForces, AProgramsUnstableWallIsCalmed) {
  // Twice the stiffness that arm and hand stabilise: (b + B) / L with a latency of one and a half
  // ticks.
  for (const double damping : {1.0, 3.0}) {
    const double wall = 2 * (0.005 + damping) / 1.5e-3;
    const scene::HandRoute route{
        {0, {0.01, 0, 0}}, {0.6, {0.01, 0, 0}}, {0.7, {-0.003, 0, 0}}, {3, {-0.003, 0, 0}}};
    const Program run = run_program(
        "vintage_phantom", route, 3,
        [=](const driver::DeviceState& s) {
          return Vector3d(s.p_WT.x() < 0 ? -wall * s.p_WT.x() : 0, 0, 0);
        },
        damping);
    EXPECT_GE(run.gate.oscillations, 1U) << damping;
    EXPECT_LT(run.swing, 5e-4) << damping;
  }
}

}  // namespace
}  // namespace thimble
