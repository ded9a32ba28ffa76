#include "thimble/scene/arm_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>

#include "energy_guard_settings.h"
#include "motion_watch_settings.h"
#include "support/number_limits.h"
#include "support/scratch.h"

namespace thimble::scene {
namespace {

const std::filesystem::path kArm =
    std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/arms/vintage_phantom.yaml";

std::string content() {
  std::ostringstream text;
  text << std::ifstream(kArm).rdbuf();
  return text.str();
}

// Reads the shipped arm with one piece of text replaced. Returns the mistakes.
std::string mistake_with(const std::string& piece, const std::string& by) {
  std::string text = content();
  const std::size_t at = text.find(piece);
  EXPECT_NE(at, std::string::npos) << piece;
  text.replace(at, piece.size(), by);
  const std::filesystem::path file = support::scratch_folder() / "thimble_arm_test.yaml";
  std::ofstream(file) << text;
  const auto arm = scene::load_arm(file);
  return arm ? "" : arm.error().message;
}

TEST(ArmFile, ReadsEveryConstantOfAShippedArm) {
  const auto read = scene::load_arm(kArm);
  ASSERT_TRUE(read.ok()) << read.error().message;
  const scene::ArmFile& arm = *read;
  EXPECT_EQ(arm.name, "vintage_phantom");
  const auto& geometry = std::get<driver::SerialArm>(arm.model.geometry);
  EXPECT_EQ(geometry.length_b, 0.138);
  EXPECT_EQ(geometry.length_c, 0.112);
  EXPECT_EQ(arm.model.drives[0].ratio, 9.0);
  EXPECT_EQ(arm.model.drives[1].sign, 1);
  EXPECT_EQ(arm.model.drives[2].torque_constant, 0.0234);
  EXPECT_EQ(arm.model.drives[2].current_max, 3);
  EXPECT_EQ(arm.model.encoders[1].home_counts, 7700);
  EXPECT_EQ(arm.model.encoders[2].sign, -1);
  EXPECT_FALSE(arm.simulated.firmware.ideal_encoders);
  EXPECT_EQ(arm.limits.force_max, 5);
  EXPECT_EQ(arm.limits.stall_ns, 20'000'000);
  EXPECT_EQ(arm.limits.watchdog_ns, 100'000'000);
  EXPECT_EQ(arm.declared.stiffness, 800);
  EXPECT_EQ(arm.velocity_corner_frequency, 100);
  EXPECT_EQ(arm.workspace.max_W.x(), 0.1);
  EXPECT_EQ(arm.simulated.plant.mass, 0.075);
  EXPECT_EQ(arm.simulated.hand.stiffness, 300);
  EXPECT_EQ(arm.simulated.hand.tremor_amplitude, 50e-6);
  EXPECT_EQ(arm.simulated.firmware.current_range_mA, 6000);
  EXPECT_EQ(arm.simulated.firmware.report_period_ns, 1'000'000);
  EXPECT_EQ(arm.simulated.wire.delay_in_ns, 0);
  EXPECT_EQ(arm.simulated.wire.delay_out_ns, 1'000'000);
}

TEST(ArmFile, DeclaresAContinuousForceWhereOneIsPublished) {
  const auto declared = [](const char* name) {
    const auto arm = scene::load_arm(name);
    return arm ? arm->declared.continuous_force : -1;
  };
  EXPECT_EQ(declared("vintage_phantom"), 1.4);
  EXPECT_EQ(declared("touch"), 0.88);
  EXPECT_EQ(declared("falcon"), 0) << "no published value";
  EXPECT_NE(mistake_with("continuous_force: 1.4", "continuous_force: 5.1")
                .find("continuous_force: expected at most the declared force"),
            std::string::npos);
}

TEST(ArmFile, HasItsHomeAtTheOriginOfTheWorld) {
  const auto arm = scene::load_arm(kArm);
  ASSERT_TRUE(arm.ok());
  const auto& geometry = std::get<driver::SerialArm>(arm->model.geometry);
  // Home: A = 0, B = 90 degrees, C = 0, by the drawing in serial_arm.h.
  const Eigen::Vector3d p_BT(geometry.length_b, 0, geometry.height - geometry.length_c);
  EXPECT_LT((arm->p_WB + arm->R_WB * p_BT).norm(), 1e-15);
}

TEST(ArmFile, CountsAQuarterTurnAsItsHomeCounts) {
  const auto arm = scene::load_arm(kArm);
  ASSERT_TRUE(arm.ok());
  EXPECT_EQ(arm->model.encoders[1].counts_per_motor_turn * arm->model.drives[1].ratio / 4,
            arm->model.encoders[1].home_counts);
}

TEST(ArmFile, EnergyStageDefaultsFollowFromTheArm) {
  const auto arm = scene::load_arm(kArm);
  ASSERT_TRUE(arm.ok());
  const auto own = scene::energy_settings(*arm, 1000, {});
  EXPECT_EQ(own.stage, driver::EnergyStage::kPassivity);
  EXPECT_EQ(own.mass, 0.075);
  EXPECT_EQ(own.delay_ticks, 1);
  EXPECT_DOUBLE_EQ(own.reservoir, 5.0 * 5 / (2 * 800));
  EXPECT_DOUBLE_EQ(own.slope, 0.005 / 0.0015);
  EXPECT_EQ(scene::energy_settings(*arm, 4000, {}).delay_ticks, 4);
  EXPECT_EQ(scene::energy_settings(*arm, 1000, driver::EnergyStage::kNone).stage,
            driver::EnergyStage::kNone);
  EXPECT_EQ(mistake_with("energy: passivity", "energy: none"), "");
  EXPECT_EQ(mistake_with("energy: passivity", "energy: bounding\n  energy_slope: 700"), "");
  EXPECT_NE(mistake_with("energy: passivity", "energy: all").find("none, passivity or bounding"),
            std::string::npos);
}

TEST(ArmFile, NamesTheBoardsThatTheArmMayHave) {
  using driver::BoardKind;
  const auto boards = [](const char* name) {
    const auto arm = scene::load_arm(std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/arms" / name);
    return arm ? arm->boards : std::vector<BoardKind>();
  };
  EXPECT_EQ(boards("woodenhaptics.yaml"), std::vector{BoardKind::kMbedHid8});
  EXPECT_EQ(boards("woodenhaptics_teensy.yaml"), std::vector{BoardKind::kTextLines});
  EXPECT_EQ(boards("falcon.yaml"), std::vector{BoardKind::kFalconFtdi});
  EXPECT_EQ(boards("polhem.yaml"), (std::vector{BoardKind::kMbedHid14, BoardKind::kTeensyRawHid64,
                                                BoardKind::kTextLines}));
  EXPECT_EQ(boards("vintage_phantom.yaml"), std::vector{BoardKind::kTextLines});
  EXPECT_EQ(mistake_with("board: text_lines", "board: [mbed_hid_14, text_lines]"), "");
  EXPECT_EQ(mistake_with("board: text_lines", ""), "");  // the usual board of the protocol
  EXPECT_NE(mistake_with("board: text_lines", "board: teensy").find("or a list of them"),
            std::string::npos);
  EXPECT_NE(mistake_with("board: text_lines", "board: [text_lines, teensy]").find("or a list"),
            std::string::npos);
  EXPECT_NE(mistake_with("board: text_lines", "board: []").find("or a list"), std::string::npos);
  EXPECT_NE(mistake_with("board: text_lines", "board: mbed_hid_8")
                .find("the board mbed_hid_8 does not use the protocol hfab_14_byte"),
            std::string::npos);
}

TEST(ArmFile, ReadsThermalLimitsOfTheMotorsOrNone) {
  const auto read = scene::load_arm(kArm);
  ASSERT_TRUE(read.ok()) << read.error().message;
  ASSERT_TRUE(read->heat.named());
  // The continuous force of the data sheet is 1.4 N at the tip in the home pose, through link and
  // capstan.
  const double arms[] = {0.138, 0.138, 0.112};  // m
  for (std::size_t i = 0; i < 3; ++i) {
    const driver::MotorDrive& drive = read->model.drives[i];
    EXPECT_NEAR(read->heat.continuous_current[i],
                1.4 * arms[i] / (drive.ratio * drive.torque_constant), 0.01);
    EXPECT_LT(read->heat.continuous_current[i], drive.current_max);
    EXPECT_EQ(read->heat.time_constant[i], 60);
  }
  EXPECT_NE(
      mistake_with("  continuous_current: [0.91, 1.07, 0.87]", "").find("needs continuous_current"),
      std::string::npos);
  EXPECT_NE(mistake_with("continuous_current: [0.91", "continuous_current: [-0.91")
                .find("continuous_current"),
            std::string::npos);
  const auto folder = std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/arms";
  for (const char* name : {"polhem", "woodenhaptics", "woodenhaptics_teensy"}) {
    const auto arm = scene::load_arm(folder / (std::string(name) + ".yaml"));
    ASSERT_TRUE(arm.ok()) << arm.error().message;
    EXPECT_TRUE(arm->heat.named()) << name;
  }
  const auto falcon = scene::load_arm(folder / "falcon.yaml");
  ASSERT_TRUE(falcon.ok());
  EXPECT_FALSE(falcon->heat.named());
}

TEST(ArmFile, ReadsHoldTimeAndTipMass) {
  scene::ArmFile arm = *scene::load_arm(kArm);
  EXPECT_EQ(scene::motion_settings(arm, 1000).max_hold, 10);
  EXPECT_EQ(scene::motion_settings(arm, 1000).mass, 0.075);
  EXPECT_EQ(scene::motion_settings(arm, 1000).delay_ticks, 1);
  EXPECT_EQ(scene::motion_settings(arm, 4000).delay_ticks, 4);
  arm.hold_unchanged = 2.5;
  arm.energy.mass = 0.06;
  EXPECT_EQ(scene::motion_settings(arm, 1000).max_hold, 2.5);
  EXPECT_EQ(scene::motion_settings(arm, 1000).mass, 0.06);
  EXPECT_NE(
      mistake_with("  stall: 0.02 ", "  hold_unchanged: 0\n  stall: 0.02 ").find("hold_unchanged"),
      std::string::npos);
}

TEST(ArmFile, ChoosesIdealEncoders) {
  EXPECT_EQ(mistake_with("encoders: quantised", "encoders: ideal"), "");
  EXPECT_NE(mistake_with("encoders: quantised", "encoders: perfect").find("quantised or ideal"),
            std::string::npos);
}

TEST(ArmFile, DescribesTheGimbalThatIsMounted) {
  EXPECT_FALSE(scene::load_arm(kArm)->model.gimbal.has_value());
  const auto polhem = scene::load_arm(kArm.parent_path() / "polhem.yaml");
  ASSERT_TRUE(polhem.ok()) << polhem.error().message;
  ASSERT_TRUE(polhem->model.gimbal.has_value());
  EXPECT_EQ(polhem->model.gimbal->axes[1], driver::FrameAxis::kY);
  EXPECT_EQ(polhem->model.gimbal->home_counts[1], 30);
  EXPECT_EQ(polhem->simulated.gimbal.period, 3);

  const std::string good =
      "gimbal:\n  axes: [z, y, x]\n  counts_per_turn: [2000, 2000, 2000]\n  sign: [-1, 1, 1]\n";
  const auto mistake = [&](const std::string& gimbal, const std::string& more = "") {
    return mistake_with("\nbase:", "\n" + gimbal + more + "\nbase:");
  };
  EXPECT_EQ(mistake(good), "");
  EXPECT_NE(mistake(good, "  home_counts: [0.5, 0, 0]\n")
                .find("home_counts: expected a whole number from -1000000"),
            std::string::npos);
  EXPECT_NE(mistake("gimbal:\n  axes: [x, y]\n  counts_per_turn: [9, 9, 9]\n  sign: [1, 1, 1]\n")
                .find("axes: expected three axes"),
            std::string::npos);
  EXPECT_NE(mistake("gimbal:\n  axes: [x, x, y]\n  counts_per_turn: [9, 9, 9]\n  sign: [1, 1, 1]\n")
                .find("expected different axes for neighbours"),
            std::string::npos);
  EXPECT_NE(mistake("gimbal:\n  counts_per_turn: [9, 9, 9]\n  sign: [1, 0, 1]\n")
                .find("sign: expected each to be 1 or -1"),
            std::string::npos);
  EXPECT_NE(mistake("gimbal:\n  sign: [1, 1, 1]\n").find("counts_per_turn"), std::string::npos);
  // 8-byte reports have no room for a gimbal, and a simulated hand can only rotate an existing one.
  EXPECT_NE(mistake_with("protocol: hfab_14_byte", "protocol: woody_8_byte\n" + good)
                .find("contain no gimbal encoders"),
            std::string::npos);
  EXPECT_NE(
      mistake_with("  encoders: quantised",
                   "  gimbal: {amplitude_degrees: [1, 1, 1], period: 2}\n  encoders: quantised")
          .find("needs a section 'gimbal' of the arm"),
      std::string::npos);
}

TEST(ArmFile, RefusesSignsOtherThanOne) {
  EXPECT_NE(mistake_with("motor_sign: [-1, 1, -1]", "motor_sign: [-1, 0.5, -1]")
                .find("motor_sign: expected each to be 1 or -1"),
            std::string::npos);
}

TEST(ArmFile, RefusesALengthInMillimetres) {
  EXPECT_NE(mistake_with("length_b: 0.138", "length_b: 138")
                .find("length_b: expected a number from 0.01 to 1 m, found \"138\""),
            std::string::npos);
}

TEST(ArmFile, RejectsAWorkspaceWithMinAboveMax) {
  EXPECT_NE(mistake_with("max: [0.1, 0.1, 0.1]", "max: [0.1, -0.2, 0.1]").find("max: expected"),
            std::string::npos);
}

TEST(ArmFile, RejectsUnsafeLimitsWithTheirLine) {
  struct Case {
    const char *piece, *by, *mistake;
  };
  const Case cases[] = {
      {"force_max: 5 ", "force_max: 100 ",
       ":46: force_max: expected at most the declared force of the arm, 5 N, found 100"},
      {"force_max: 5 ", "force_max: 5.01 ",
       ":46: force_max: expected at most the declared force of the arm"},
      {"soft_start: 0.3", "soft_start: 0", ":49: soft_start: expected a number from 0.05 to 10 s"},
      {"soft_start: 0.3", "soft_start: 1e-9", ":49: soft_start: expected a number from 0.05"},
      {"soft_start: 0.3", "soft_start: 0.049", ":49: soft_start: expected a number from 0.05"},
      {"watchdog: 0.1 ", "watchdog: 10 ", ":51: watchdog: expected a number from 0.001 to 1 s"},
      {"rise_max: 2000", "rise_max: 1e6", ":48: rise_max: expected a number from 1 to 100000 N/s"},
      {"stall: 0.02 ", "stall: 0.1 ", ":50: stall: expected a shorter time than watchdog"},
      {"force_max: 5 ", "force_max: .nan ", ":46: force_max: expected a number"},
  };
  for (const Case& wrong : cases) {
    EXPECT_NE(mistake_with(wrong.piece, wrong.by).find(wrong.mistake), std::string::npos)
        << wrong.by << " gave: " << mistake_with(wrong.piece, wrong.by);
  }
  // The bounds themselves are valid.
  EXPECT_EQ(mistake_with("soft_start: 0.3", "soft_start: 0.05"), "");
  EXPECT_EQ(mistake_with("watchdog: 0.1 ", "watchdog: 1 "), "");
  EXPECT_EQ(mistake_with("rise_max: 2000", "rise_max: 1e5"), "");
}

// Each key of one number or three, with its smallest and largest value. The text before the value
// and after it places it in the file. Other mistakes, such as a contradiction of two keys, are
// irrelevant here.
TEST(ArmFile, AcceptsEachNumberUpToItsLimitsOnly) {
  const support::NumberLimits all[] = {
      {"height: 0 ", "height: ", " ", -1, 1},
      {"length_b: 0.138", "length_b: ", "", 0.01, 1},
      {"length_c: 0.112", "length_c: ", "", 0.01, 1},
      {"ratio: [9.0, 7.7, 7.7]", "ratio: [9, ", ", 9]", 1, 1000},
      {"torque_constant: [0.0234, 0.0234, 0.0234]", "torque_constant: [1, 1, ", "]", 1e-4, 10},
      {"current_max: [3, 3, 3]", "current_max: [", ", 3, 3]", 0.01, 32},
      {"continuous_current: [0.91, 1.07, 0.87]", "continuous_current: [1, ", ", 1]", 0.01, 32},
      {"thermal_time_constant: [60, 60, 60]", "thermal_time_constant: [", ", 60, 60]", 1, 1e5},
      {"min: [-0.1, -0.1, -0.1]", "min: [", ", 0, 0]", -2, 2},
      {"max: [0.1, 0.1, 0.1]", "max: [0, ", ", 0]", -2, 2},
      {"force: 5 ", "force: ", " ", 0.01, 100},
      {"stiffness: 800", "stiffness: ", "", 1, 1e5},
      {"damping: 8 ", "damping: ", " ", 0, 1000},
      {"continuous_force: 1.4", "continuous_force: ", "", 0, 100},
      {"force_max: 5 ", "force_max: ", " ", 0.01, 100},
      {"speed_max: 3 ", "speed_max: ", " ", 0.01, 20},
      {"stall: 0.02", "stall: ", "", 0.001, 10},
      {"power_max: 1 ", "power_max: ", " ", 0.01, 20},
      {"power_time: 2 ", "power_time: ", " ", 0.1, 10},
      {"  power_max:", "  reopen: ", "\n  power_max:", 0.001, 10},
      {"  power_max:", "  hold_unchanged: ", "\n  power_max:", 0.05, 600},
      {"  power_max:", "  tip_mass: ", "\n  power_max:", 1e-3, 10},
      {"  power_max:", "  energy_allowance: ", "\n  power_max:", 0, 1},
      {"  power_max:", "  energy_reservoir: ", "\n  power_max:", 1e-6, 10},
      {"  power_max:", "  energy_slope: ", "\n  power_max:", 0.1, 1e6},
  };
  for (const support::NumberLimits& key : all) {
    support::expect_accepted_up_to_limits(
        key, [](const char* piece, const std::string& by) { return mistake_with(piece, by); });
  }
}

TEST(ArmFile, NamesAnUnknownKeyInEachSection) {
  for (const char* section : {"geometry", "joints", "base", "workspace", "declared", "gate"}) {
    const std::string head = std::string("\n") + section + ":";
    EXPECT_NE(mistake_with(head, "\nzone_of_" + head.substr(1)).find("zone_of_"), std::string::npos)
        << section;
    std::string text = content();
    const std::size_t line = text.find('\n', text.find(head) + 1);
    const std::size_t next = text.find('\n', line + 1);
    const std::string first = text.substr(line, next - line);
    EXPECT_NE(mistake_with(first, first + "\n  unknown_key: 1").find("unknown_key"),
              std::string::npos)
        << section;
  }
}

// An arm that reports every millisecond, in a loop of 800 Hz: its reports wait 0, 0.25, 0.5 and
// 0.75 ms for their ticks, in turn.
TEST(ArmFile, LoopDelayIncludesTheWaitOfReportsForTheirTicks) {
  const auto arm = scene::load_arm(kArm);
  ASSERT_TRUE(arm.ok());
  const LoopTimes times = loop_pace(*arm, 800);
  EXPECT_DOUBLE_EQ(times.delay, 0.001 + 0.000375);
  EXPECT_DOUBLE_EQ(times.period, 0.00125);
}

// A low-pass filter of corner frequency f multiplies a step of the velocity by 1 - exp(-2 pi f T).
TEST(ArmFile, SpeedFloorIsThatOfTheFilteredVelocity) {
  scene::ArmFile arm = *scene::load_arm(kArm);
  const double filtered = scene::energy_settings(arm, 1000, {}).speed_floor;
  arm.velocity_corner_frequency = 0;
  const double unfiltered = scene::energy_settings(arm, 1000, {}).speed_floor;
  EXPECT_NEAR(filtered / unfiltered, 1 - std::exp(-2 * std::numbers::pi * 100 * 0.001), 1e-14);
}

}  // namespace
}  // namespace thimble::scene
