#include "arm/simulation_section.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "support/number_limits.h"
#include "support/scratch.h"
#include "thimble/scene/arm_simulation.h"
#include "thimble/scene/simulated_device.h"

namespace thimble::scene {
namespace {

const std::string kTrain =
    "  drive_train: {current_lag: 0.0003, cogging: [0.001, 0.002, 0.003], ripple: [0.01, 0.02, "
    "0.03], periods_per_turn: 7, cogging_phase: [1, -2, 3], ripple_phase: [-3, 2, -1], inertia: "
    "[0.001, 0.002, 0.003], stiffness: [100, 200, 300], "
    "damping: [0.01, 0.02, 0.03], play: [0.001, 0.002, 0.003], viscous: [0.004, 0.005, 0.006], "
    "coulomb: [0.007, 0.008, 0.009], heat: {rise: 80, continuous_current: [0.9, 1.1, 0.8], "
    "time_constant: [60, 40, 20], torque: -0.0019, at_start: [1, 2, 3]}}\n";

using Change = std::pair<std::string, std::string>;

/// Reads a shipped arm with some parts of its text replaced.
driver::Result<scene::ArmFile> read_with(const std::vector<Change>& changes,
                                         const std::string& arm = "vintage_phantom") {
  std::ostringstream content;
  content << std::ifstream(std::string(THIMBLE_SOURCE_DIR) + "/app/arms/" + arm + ".yaml").rdbuf();
  std::string text = content.str();
  for (const auto& [piece, by] : changes) {
    const std::size_t at = text.find(piece);
    EXPECT_NE(at, std::string::npos) << piece;
    text.replace(at, piece.size(), by);
  }
  const auto file = support::scratch_folder() / "thimble_simulation_section_test.yaml";
  std::ofstream(file) << text;
  return scene::load_arm(file);
}

std::string mistake_with(const std::string& piece, const std::string& by,
                         const std::string& arm = "vintage_phantom") {
  const auto read = read_with({{piece, by}}, arm);
  return read ? "" : read.error().message;
}

TEST(SimulationSection, HasNoDriveTrainByDefault) {
  const auto arm = scene::load_arm("vintage_phantom");
  ASSERT_TRUE(arm.ok());
  EXPECT_FALSE(arm->simulated.drive_train.named());
  EXPECT_EQ(arm->simulated.weight_B, Eigen::Vector3d(0, 0, 0));
  EXPECT_TRUE(arm->simulated.wire.regular());
  EXPECT_EQ(arm->simulated.firmware.missed_edges, 0);
}

TEST(SimulationSection, ReadsEveryConstantOfADriveTrain) {
  const auto arm = read_with({{"  encoders: quantised", kTrain + "  encoders: quantised"}});
  ASSERT_TRUE(arm.ok()) << arm.error().message;
  const device_sim::DriveTrainSettings& train = arm->simulated.drive_train;
  EXPECT_EQ(train.current_lag, 0.0003);
  EXPECT_EQ(train.cogging, Eigen::Vector3d(0.001, 0.002, 0.003));
  EXPECT_EQ(train.ripple, Eigen::Vector3d(0.01, 0.02, 0.03));
  EXPECT_EQ(train.periods_per_turn, 7);
  EXPECT_EQ(train.cogging_phase, Eigen::Vector3d(1, -2, 3));
  EXPECT_EQ(train.ripple_phase, Eigen::Vector3d(-3, 2, -1));
  EXPECT_EQ(train.inertia, Eigen::Vector3d(0.001, 0.002, 0.003));
  EXPECT_EQ(train.stiffness, Eigen::Vector3d(100, 200, 300));
  EXPECT_EQ(train.damping, Eigen::Vector3d(0.01, 0.02, 0.03));
  EXPECT_EQ(train.play, Eigen::Vector3d(0.001, 0.002, 0.003));
  EXPECT_EQ(train.viscous, Eigen::Vector3d(0.004, 0.005, 0.006));
  EXPECT_EQ(train.coulomb, Eigen::Vector3d(0.007, 0.008, 0.009));
  EXPECT_EQ(train.heat.rise, 80);
  EXPECT_EQ(train.heat.continuous_current, Eigen::Vector3d(0.9, 1.1, 0.8));
  EXPECT_EQ(train.heat.time_constant, Eigen::Vector3d(60, 40, 20));
  EXPECT_EQ(train.heat.resistance, 0.00393);
  EXPECT_EQ(train.heat.torque, -0.0019);
  EXPECT_EQ(train.heat.at_start, Eigen::Vector3d(1, 2, 3));
  EXPECT_TRUE(scene::ArmSimulation::make(*arm, {{0, Eigen::Vector3d::Zero()}}).ok());
}

TEST(SimulationSection, TurnsTheWeightDownInTheWorldIntoTheBase) {
  const Change weight{"    coulomb: 0.04 ", "    weight: 0.2\n    coulomb: 0.04 "};
  const auto upright = read_with({weight});
  ASSERT_TRUE(upright.ok()) << upright.error().message;
  EXPECT_EQ(upright->simulated.weight_B, Eigen::Vector3d(0, 0, -0.2));
  // A rotation of 90 degrees about x makes the y axis of the base point up.
  const auto lying = read_with({weight, {"rotate_degrees: []", "rotate_degrees: [[x, 90]]"}});
  ASSERT_TRUE(lying.ok()) << lying.error().message;
  EXPECT_LT((lying->simulated.weight_B - Eigen::Vector3d(0, -0.2, 0)).norm(), 1e-15);
}

TEST(SimulationSection, ReadsFaultsOfWireAndEncoders) {
  const auto wire =
      read_with({{"    delay_in: 0 ", "    jitter: 0.0004\n    loss: 0.01\n    delay_in: 0 "}});
  ASSERT_TRUE(wire.ok()) << wire.error().message;
  EXPECT_EQ(wire->simulated.wire.jitter_ns, 400'000);
  EXPECT_EQ(wire->simulated.wire.loss, 0.01);
  const auto edges = read_with(
      {{"    report_period: 0.001", "    missed_edges: 0.001\n    report_period: 0.001"}});
  ASSERT_TRUE(edges.ok()) << edges.error().message;
  EXPECT_EQ(edges->simulated.firmware.missed_edges, 0.001);
}

TEST(SimulationSection, RejectsADelayByWhichNoReportArrives) {
  EXPECT_EQ(mistake_with("delay_in: 0 ", "delay_in: 0.25 "), "");
  for (const char* late : {"delay_in: 1 ", "delay_in: 0.256 ", "delay_in: 0.2, jitter: 0.1 "}) {
    std::string wire = late;
    if (const auto comma = wire.find(", "); comma != std::string::npos) {
      wire.replace(comma, 2, "\n    ");
    }
    const std::string mistake = mistake_with("delay_in: 0 ", wire);
    EXPECT_NE(mistake.find("delay_in: expected less than 0.256 s"), std::string::npos)
        << late << " -> " << mistake;
  }
}

TEST(SimulationSection, ArmWithALateWireOpens) {
  const auto arm =
      read_with({{"report_period: 0.001", "report_period: 0.1"}, {"delay_in: 0 ", "delay_in: 1 "}});
  ASSERT_TRUE(arm) << arm.error().message;
  const auto opened = SimulatedDevice::open(*arm, {{0.0, Eigen::Vector3d::Zero()}}, {});
  EXPECT_TRUE(opened) << opened.error().message;
}

TEST(SimulationSection, RejectsAnInconsistentDriveTrain) {
  const auto mistake = [](const std::string& train) {
    return mistake_with("  encoders: quantised",
                        "  drive_train: {" + train + "}\n  encoders: quantised");
  };
  const std::string inertia = "inertia: [0.001, 0.001, 0.001]";
  EXPECT_NE(mistake("stiffness: [100, 100, 100]").find("the same for inertia"), std::string::npos);
  EXPECT_NE(
      mistake("stiffness: [100, 0, 100], " + inertia).find("stiffness: expected values above zero"),
      std::string::npos);
  EXPECT_NE(mistake(inertia).find("damping and play need stiffness"), std::string::npos);
  EXPECT_NE(mistake("play: [0.001, 0, 0]").find("damping and play need stiffness"),
            std::string::npos);
  EXPECT_NE(mistake("cogging: [0.001, 0, 0]").find("need periods_per_turn"), std::string::npos);
  EXPECT_NE(mistake("current_lag: -1").find("current_lag: expected a number from 0 to 0.1 s"),
            std::string::npos);
  EXPECT_NE(mistake("heat: {rise: 80, time_constant: [60, 60, 60]}").find("continuous_current"),
            std::string::npos);
  EXPECT_NE(mistake("current_lagg: 0.1").find("did you mean \"current_lag\"?"), std::string::npos);
  EXPECT_EQ(mistake("stiffness: [100, 100, 100], " + inertia), "");
}

TEST(SimulationSection, ReadsLinksAndTurnsTheirGravityIntoTheBase) {
  const std::string links =
      "  links: {inertia: [0.001, 0.002, 0.003], yaw_b: 0.0021, yaw_c: 0.0031, coupling: 0.0004, "
      "moment_b: 0.005, moment_c: -0.006}\n  encoders: quantised";
  const auto arm = read_with(
      {{"  encoders: quantised", links}, {"rotate_degrees: []", "rotate_degrees: [[x, 90]]"}});
  ASSERT_TRUE(arm.ok()) << arm.error().message;
  const device_sim::LinkSettings& read = arm->simulated.links;
  EXPECT_EQ(read.inertia, Eigen::Vector3d(0.001, 0.002, 0.003));
  EXPECT_EQ(read.yaw_b, 0.0021);
  EXPECT_EQ(read.yaw_c, 0.0031);
  EXPECT_EQ(read.coupling, 0.0004);
  EXPECT_EQ(read.moment_b, 0.005);
  EXPECT_EQ(read.moment_c, -0.006);
  EXPECT_LT((read.gravity_B - Eigen::Vector3d(0, -9.80665, 0)).norm(), 1e-14);
  EXPECT_TRUE(scene::ArmSimulation::make(*arm, {{0, Eigen::Vector3d::Zero()}}).ok());
  EXPECT_FALSE(scene::load_arm("vintage_phantom")->simulated.links.named());
}

TEST(SimulationSection, RejectsImpossibleLinksAndThoseOfALinkage) {
  EXPECT_NE(
      mistake_with("  encoders: quantised", "  links: {coupling: 0.001}\n  encoders: quantised")
          .find("square of coupling"),
      std::string::npos);
  EXPECT_NE(mistake_with("  tip:\n", "  links: {yaw_b: 0.001}\n  tip:\n", "polhem")
                .find("links: needs shape: serial"),
            std::string::npos);
}

TEST(SimulationSection, RefusesADriveTrainOfTheFalcon) {
  EXPECT_NE(mistake_with("  tip:\n", "  drive_train: {current_lag: 0.001}\n  tip:\n", "falcon")
                .find("drive_train: cannot be used with shape: falcon"),
            std::string::npos);
}

TEST(SimulationSection, AcceptsEachNumberUpToItsLimitsOnly) {
  const support::NumberLimits all[] = {
      {"    mass: 0.075", "    mass: ", "", 1e-3, 10},
      {"viscous: 0.005", "viscous: ", "", 0, 100},
      {"    coulomb: 0.04", "    coulomb: ", "", 0, 10},
      {"    coulomb: 0.04", "    weight: ", "\n    coulomb: 0.04", 0, 10},
      {"current_max: 6 ", "current_max: ", " ", 0.01, 32},
      {"report_period: 0.001", "report_period: ", "", 1e-5, 0.1},
      {"    watchdog: 0.1", "    watchdog: ", "", 1e-3, 10},
      {"current_range: 6 ", "current_range: ", " ", 0.01, 32.767},
      {"delay_in: 0 ", "delay_in: ", " ", 0, 1},
      {"delay_out: 0.001", "delay_out: ", "", 0, 1},
      {"delay_in: 0 ", "jitter: ", "\n    delay_in: 0 ", 0, 1},
      {"delay_in: 0 ", "loss: ", "\n    delay_in: 0 ", 0, 0.99},
      {"    mass: 0.025", "    mass: ", "", 0, 10},
      {"    stiffness: 300", "    stiffness: ", "", 0, 1e5},
      {"    damping: 3 ", "    damping: ", " ", 0, 1000},
      {"tremor_amplitude: 0.00005", "tremor_amplitude: ", "", 0, 0.01},
      {"tremor_frequency: 10", "tremor_frequency: ", "", 0.1, 100},
  };
  for (const support::NumberLimits& key : all) {
    support::expect_accepted_up_to_limits(
        key, [](const char* piece, const std::string& by) { return mistake_with(piece, by); });
  }
}

TEST(SimulationSection, AcceptsPeriodsOfTheGimbalUpToItsLimits) {
  const auto mistake = [](const std::string& period) {
    return mistake_with("period: 3", "period: " + period, "polhem");
  };
  EXPECT_EQ(mistake("0.05"), "");
  EXPECT_EQ(mistake("100"), "");
  for (const char* beyond : {"0.0499", "100.1"}) {
    EXPECT_NE(mistake(beyond).find("period: expected a number from 0.05 to 100 s"),
              std::string::npos)
        << beyond;
  }
}

TEST(SimulationSection, NamesAnUnknownKeyInEachPart) {
  for (const char* part : {"tip", "motors", "firmware", "wire", "hand"}) {
    const std::string head = std::string("\n  ") + part + ":";
    std::ostringstream content;
    content << std::ifstream(std::string(THIMBLE_SOURCE_DIR) + "/app/arms/vintage_phantom.yaml")
                   .rdbuf();
    const std::string text = content.str();
    const std::size_t begin = text.find(head);
    const std::size_t line = text.find('\n', begin + 1);
    const std::string opening = text.substr(begin, line - begin);
    EXPECT_NE(mistake_with(opening, opening + "\n    unknown_key: 1").find("unknown_key"),
              std::string::npos)
        << part;
  }
}

TEST(SimulationSection, CountsTheJointsOfItsWiringFromOne) {
  const auto arm = read_with(
      {{"  encoders: quantised",
        "  wiring: {encoder_of: [3, 1, 2], motor_of: [2, 3, 1]}\n  encoders: quantised"}});
  ASSERT_TRUE(arm.ok()) << arm.error().message;
  const device_sim::WiringSettings& wiring = arm->simulated.firmware.wiring;
  EXPECT_EQ(wiring.encoder_of, (std::array<std::uint8_t, 3>{2, 0, 1}));
  EXPECT_EQ(wiring.motor_of, (std::array<std::uint8_t, 3>{1, 2, 0}));
}

}  // namespace
}  // namespace thimble::scene
