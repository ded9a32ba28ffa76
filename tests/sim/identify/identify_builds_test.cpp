// Arms of other builds than the serial ones: a Falcon behind its converter, the Polhem's linkage,
// and arms with one or two motors.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "arm_table.h"
#include "arms/falcon/falcon_arm.h"
#include "bringup/identify/output/identified_file.h"
#include "read_scene.h"
#include "support/identify/identified_arm.h"
#include "support/long_form.h"
#include "support/random.h"
#include "thimble/driver/device.h"
#include "thimble/driver/wire_link.h"
#include "thimble/scene/arm_file.h"
#include "thimble/scene/arm_simulation.h"
#include "usb/simulated_falcon.h"
#include "yaml/yaml_reader.h"

namespace thimble::bringup {
namespace {

using support::HiddenArm;
using support::identified;
using support::kKnownMass;
using support::long_form;
using support::Score;

/// Draws a hidden arm from a shipped file like hidden_arm, except for the delays, which are those
/// of a Falcon's bus.
HiddenArm hidden_arm_of(const char* name, std::uint64_t seed) {
  support::Random random(seed);
  HiddenArm arm{.file = scene::load_arm(name).value()};
  const auto third_to_three = [&](double value) {
    return value * std::exp(random.uniform(-1, 1) * std::log(3.0));
  };
  auto& simulated = arm.file.simulated;
  simulated.plant.mass = third_to_three(simulated.plant.mass);
  simulated.plant.viscous = third_to_three(simulated.plant.viscous);
  simulated.plant.coulomb = third_to_three(simulated.plant.coulomb);
  for (std::size_t i = 0; i < 3; ++i) {
    arm.gain[i] = random.uniform(0.6, 1.6);
    simulated.firmware.wiring.motor_gain[static_cast<Eigen::Index>(i)] = arm.gain[i];
  }
  // A linkage with weight is simulated in steps of 25 us, which takes ten times as long.
  const bool weighs = long_form() || arm.file.is<driver::DeltaArm>();
  arm.weight = weighs ? random.uniform(0, 0.8) * simulated.plant.coulomb : 0;
  simulated.weight_B = arm.file.R_WB.transpose() * Eigen::Vector3d(0, 0, -arm.weight);
  return arm;
}

/// Returns the delay of a Falcon's bus from force to motion, s. It is the number of ticks between
/// the one whose message the board answers and the one that sees the answer. The board samples when
/// a message is complete, which is when its force begins. The tip moves by several counts per tick.
double delay_of_bus(const scene::ArmFile& file) {
  namespace falcon = driver::falcon;
  const Eigen::Vector3d p_BM = falcon::falcon_geometry().p_BM;
  const Eigen::Vector3d way(0, 0.02, 0.02);
  device_sim::SimulatedArmSettings settings = file.simulated;
  settings.hand = {.mass = 0.025, .stiffness = 1000, .damping = 5};
  auto arm = device_sim::usb::SimulatedFalcon::make(
      falcon::falcon_model(), settings,
      device_sim::HandPath::make({{0, p_BM}, {0.1, p_BM}, {0.2, p_BM + way}}).value(), {});
  EXPECT_TRUE(arm.ok());
  driver::VirtualClock clock;
  auto device =
      driver::Device::open(std::make_unique<driver::WireLink>(
                               (*arm)->wire(clock), driver::make_arm(file.protocol, file.model)),
                           scene::device_settings(file, 1000), clock.now_ns());
  EXPECT_TRUE(device.ok());
  std::vector<std::array<std::int32_t, 3>> answered;  // answer to the message of each tick
  int delay = 0;
  for (int k = 0; k < 180; ++k) {
    clock.sleep_until_ns(clock.now_ns() + 1'000'000);
    const auto seen = (*device)->read(clock.now_ns(), clock.now_ns()).counts;
    answered.push_back((*arm)->arm().truth().counts);  // answer to the message of the previous tick
    (*device)->write({});
    if (k < 150) continue;
    const auto found = std::find(answered.rbegin(), answered.rend(), seen);
    EXPECT_NE(found, answered.rend());
    const int ticks = static_cast<int>(found - answered.rbegin()) + 1;
    EXPECT_TRUE(delay == 0 || delay == ticks) << "the delay must be the same in each tick";
    delay = ticks;
  }
  return 1e-3 * delay;
}

/// Number of intervals that contain the true value, and errors of the estimates.
struct Scores {
  Score mass{"mass", 0.03}, coulomb{"Coulomb", 0.05}, gain{"gain", 0.02}, delay{"delay", 1e-4};
  int held_weights = 0, held_viscous = 0;

  void add(const HiddenArm& arm, const Identified& found, double true_delay) {
    const auto& plant = arm.file.simulated.plant;
    const ArmConstants& constants = found.constants;
    mass.add(constants.mass, plant.mass);
    coulomb.add(constants.coulomb, plant.coulomb);
    delay.add(constants.delay, true_delay, false);
    for (std::size_t i = 0; i < static_cast<std::size_t>(arm.file.motors()); ++i) {
      gain.add(constants.gain[i], arm.gain[i]);
    }
    held_weights += constants.weight.holds(arm.weight) ? 1 : 0;
    held_viscous += constants.viscous.holds(plant.viscous) ? 1 : 0;
  }

  void expect_kept(int arms) const {
    int held = held_weights + held_viscous, all = 2 * arms;
    for (const Score* score : {&mass, &coulomb, &gain, &delay}) {
      score->print();
      EXPECT_LT(score->worst, score->max) << score->name;
      held += score->held;
      all += score->all;
    }
    std::printf("weight %d, viscous friction %d of %d intervals\n", held_weights, held_viscous,
                arms);
    // One of the 8 intervals in the short form may miss by chance.
    EXPECT_GE(held, long_form() ? 0.9 * all : all - 1);
  }
};

/// `max_force`: of the motion, N; empty: that of the command.
void find_hidden_arms(const char* name, double seconds, double max_force = kIdentifyForceMax) {
  Scores scores;
  const int arms = long_form() ? 20 : 1;
  for (int k = 0; k < arms; ++k) {
    const auto seed = static_cast<std::uint64_t>(7000 + k);
    const HiddenArm arm = hidden_arm_of(name, seed);
    const auto& wire = arm.file.simulated.wire;
    const double delay = arm.file.is<driver::DeltaArm>()
                             ? delay_of_bus(arm.file)
                             : 1e-9 * static_cast<double>(wire.delay_in_ns + wire.delay_out_ns);
    const auto found = identified(
        arm, {.seconds = seconds, .known_mass = kKnownMass, .max_force = max_force, .seed = seed});
    ASSERT_TRUE(found.ok()) << name << ' ' << seed << ": " << found.error().message;
    EXPECT_TRUE(found->against.empty()) << name << ' ' << seed << ": " << found->against.front();
    EXPECT_FALSE(found->constants.cables);
    scores.add(arm, *found, delay);
  }
  scores.expect_kept(arms);
}

TEST(IdentifyBuilds, FindsTheConstantsOfHiddenFalcons) {
  find_hidden_arms("falcon", long_form() ? 30 : 10);
}

TEST(IdentifyBuilds, FindsTheConstantsOfHiddenPolhems) {
  find_hidden_arms("polhem", long_form() ? 30 : 10);
}

TEST(IdentifyBuilds, FindsTheConstantsOfHiddenFiveBars) {
  find_hidden_arms("five_bar", long_form() ? 30 : 10);
}

TEST(IdentifyBuilds, FindsTheConstantsOfHiddenPaddles) {
  // A paddle has more friction at the tip than the command's force moves well.
  find_hidden_arms("hapkit", long_form() ? 30 : 10, 2);
}

void expect_wrong_motor_named(const char* name, int motors) {
  for (int motor = 0; motor < motors; ++motor) {
    for (const double gain : {-1.0, 0.0}) {
      HiddenArm arm = hidden_arm_of(name, 7);
      arm.file.simulated.firmware.wiring.motor_gain[motor] = gain;
      const auto found = identified(arm, {.seconds = 10});
      ASSERT_FALSE(found.ok());
      const std::string which = "Motor " + std::to_string(motor + 1);
      EXPECT_EQ(found.error().message.find(
                    which + (gain < 0 ? " pulls against its encoder" : " moved its joint by")),
                0U)
          << found.error().message;
    }
  }
}

TEST(IdentifyBuilds, NamesAReversedOrDeadMotorOfAFiveBar) {
  expect_wrong_motor_named("five_bar", 2);
}

TEST(IdentifyBuilds, NamesAReversedOrDeadMotorOfAFalcon) {
  expect_wrong_motor_named("falcon", 3);
}

TEST(IdentifyBuilds, WritesAFileThatMakesTheHiddenArm) {
  for (const char* name : {"falcon", "polhem", "five_bar", "hapkit"}) {
    ArmConstants found;
    found.mass = {0.2, 0.001};
    found.viscous = {0.01, 0.001};
    found.coulomb = {0.05, 0.001};
    found.weight = {0.02, 0.001};
    found.gain = {Estimate{0.7, 0.001}, {1.1, 0.001}, {1.5, 0.001}};
    found.delay = {0.00234, 1e-5};
    std::ostringstream text;
    text << std::ifstream(std::string(THIMBLE_SOURCE_DIR) + "/app/arms/" + name + ".yaml").rdbuf();
    const auto before = scene::load_arm(name);
    std::string written = text.str();
    // An existing constant is replaced.
    for (int round = 0; round < 2; ++round) {
      const auto made = identified_text(written, found, {.date = "2026-11-25", .arm = "A 1"});
      ASSERT_TRUE(made.ok()) << made.error().message;
      auto yaml = scene::YamlFile::parse(*made, "arm file");
      const auto after = scene::read_arm(*yaml);
      ASSERT_TRUE(after.ok()) << after.error().message << *made;
      EXPECT_EQ(after->simulated.plant.mass, 0.2);
      EXPECT_NEAR(after->simulated.weight_B.norm(), 0.02, 1e-9);
      EXPECT_EQ(after->heat.named(), before->heat.named());
      for (std::size_t i = 0; i < static_cast<std::size_t>(before->motors()); ++i) {
        const double gain = found.gain[i].value * (round == 0 ? 1 : found.gain[i].value);
        EXPECT_NEAR(after->model.drives[i].torque_constant,
                    gain * before->model.drives[i].torque_constant, 1e-6);
      }
      EXPECT_NE(made->find("[I 2026-11-25, A 1"), std::string::npos);
      written = *made;
    }
    auto yaml = scene::YamlFile::parse(written, "arm file");
    const auto file = scene::read_arm(*yaml);
    ASSERT_TRUE(file.ok());
    EXPECT_TRUE(scene::ArmSimulation::make(*file, {{0, file->workspace.middle()}}, {}).ok());
  }
}

}  // namespace
}  // namespace thimble::bringup
