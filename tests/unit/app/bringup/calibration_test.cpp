#include "arm/calibration.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <tuple>

#include "bringup/feel_check.h"
#include "support/boards/described_port.h"
#include "support/random.h"
#include "support/scratch.h"
#include "thimble/scene/real_arm.h"

namespace thimble::bringup {
namespace {

scene::ArmFile vintage() {
  auto file =
      scene::load_arm(std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/arms/vintage_phantom.yaml");
  EXPECT_TRUE(file) << file.error().message;
  return std::move(file).value();
}

class CalibrationTest : public ::testing::Test {
 protected:
  CalibrationTest() {
    setenv("XDG_CONFIG_HOME", (support::scratch_folder() / "config").c_str(), 1);
  }

  /// Returns the reading of an arm with the calibration `truth` and its tip at p_WT.
  static driver::ArmReading reading_at(const scene::ArmFile& truth, const Eigen::Vector3d& p_WT) {
    const auto q =
        driver::inverse(truth.model.geometry, truth.R_WB.transpose() * (p_WT - truth.p_WB));
    EXPECT_TRUE(q);
    const Eigen::Vector3d counts = truth.model.exact_counts(*q);
    driver::ArmReading reading;
    for (std::size_t i = 0; i < 3; ++i) {
      reading.counts[i] =
          static_cast<std::int32_t>(std::lround(counts[static_cast<Eigen::Index>(i)]));
    }
    return reading;
  }
};

TEST_F(CalibrationTest, FindsHomeAndSignsOfAnyArmFromThreeMovements) {
  const scene::ArmFile file = vintage();
  support::Random random(111);
  for (int i = 0; i < 200; ++i) {
    // An arm with random wiring of encoders and motors, switched on with random counters.
    scene::Calibration truth;
    for (std::size_t k = 0; k < 3; ++k) {
      const int flip = random.bits() % 2 == 0 ? 1 : -1;
      truth.encoder_sign[k] = flip * static_cast<int>(file.model.encoders[k].sign);
      truth.motor_sign[k] = flip * static_cast<int>(file.model.drives[k].sign);
      truth.home_counts[k] = static_cast<std::int32_t>(random.uniform(-9000, 9000));
    }
    scene::ArmFile true_file = file;
    scene::apply(truth, true_file);
    const Eigen::Vector3d home(0, 0, 0);  // the tip at home is the world's origin
    std::array<driver::ArmReading, 3> moved;
    for (int axis = 0; axis < 3; ++axis) {
      // A user moves neither exactly along an axis nor by exactly 5 cm.
      const Eigen::Vector3d step = random.uniform(0.035, 0.06) *
                                   (Eigen::Vector3d::Unit(axis) + random.in_box(0.25)).normalized();
      moved[static_cast<std::size_t>(axis)] = reading_at(true_file, home + step);
    }
    const auto found =
        scene::find_calibration(file, driver::ArmKind::kPolhem, reading_at(true_file, home), moved);
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_EQ(found->encoder_sign, truth.encoder_sign);
    EXPECT_EQ(found->motor_sign, truth.motor_sign);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(found->home_counts[k], truth.home_counts[k], 1);  // one count of rounding
    }
  }
}

/// Returns the vintage arm with a described wire.
scene::ArmFile described() {
  const auto file = support::scratch_folder() / "calibration_described.yaml";
  const std::string wire = support::text_of_file(std::filesystem::path(THIMBLE_SOURCE_DIR) /
                                                 "app/arms/wires/hfab_14_byte.yaml");
  std::ofstream(file) << support::phantom_with_wire("\nprotocol: described\n" + wire);
  auto arm = scene::load_arm(file);
  EXPECT_TRUE(arm) << arm.error().message;
  return arm ? std::move(arm).value() : scene::ArmFile{};
}

TEST_F(CalibrationTest, FindsTheSignsOfAnArmWithADescribedWire) {
  const scene::ArmFile file = described();
  ASSERT_TRUE(file.wire);
  scene::Calibration truth;
  for (std::size_t k = 0; k < 3; ++k) {
    truth.encoder_sign[k] = -static_cast<int>(file.model.encoders[k].sign);
    truth.motor_sign[k] = -static_cast<int>(file.model.drives[k].sign);
  }
  scene::ArmFile true_file = file;
  scene::apply(truth, true_file);
  std::array<driver::ArmReading, 3> moved;
  for (int axis = 0; axis < 3; ++axis) {
    moved[static_cast<std::size_t>(axis)] =
        reading_at(true_file, 0.04 * Eigen::Vector3d::Unit(axis));
  }
  const auto found = scene::find_calibration(file, driver::ArmKind::kDescribed,
                                             reading_at(true_file, {0, 0, 0}), moved);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found->encoder_sign, truth.encoder_sign);
}

TEST_F(CalibrationTest, AsksForAtMostFiveCentimetresInTheWorkspace) {
  scene::ArmFile file = vintage();
  EXPECT_EQ(scene::calibration_move(file, {0, 0, 0}, 1), 0.05);
  file.workspace = {.min_W = {-0.02, -0.02, -0.001}, .max_W = {0.02, 0.033, 0.001}};
  EXPECT_NEAR(scene::calibration_move(file, {0, 0, 0}, 0), 0.015, 1e-12);
  EXPECT_NEAR(scene::calibration_move(file, {0, 0, 0}, 1), 0.025, 1e-12);
  EXPECT_NEAR(scene::calibration_move(file, {0, 0, 0}, 2), 0.005, 1e-12);
  // At the edge of the box: nearly half of its width.
  EXPECT_NEAR(scene::calibration_move(file, {0.02, 0, 0}, 0), 0.015, 1e-12);
}

TEST_F(CalibrationTest, AcceptsTheSmallMovementsOfASmallArm) {
  scene::ArmFile file = vintage();
  std::array<driver::ArmReading, 3> moved;
  for (int axis = 0; axis < 3; ++axis) {
    moved[static_cast<std::size_t>(axis)] = reading_at(file, 0.013 * Eigen::Vector3d::Unit(axis));
  }
  const auto home = reading_at(file, {0, 0, 0});
  EXPECT_FALSE(scene::find_calibration(file, driver::ArmKind::kPolhem, home, moved));
  file.workspace = {.min_W = {-0.02, -0.02, -0.02}, .max_W = {0.02, 0.02, 0.02}};
  EXPECT_TRUE(scene::find_calibration(file, driver::ArmKind::kPolhem, home, moved));
}

TEST_F(CalibrationTest, RefusesAmbiguousMovements) {
  const scene::ArmFile file = vintage();
  const auto home = reading_at(file, {0, 0, 0});
  const auto still =
      scene::find_calibration(file, driver::ArmKind::kPolhem, home, {home, home, home});
  ASSERT_FALSE(still);
  EXPECT_NE(still.error().message.find("too little"), std::string::npos);
  const auto same = reading_at(file, {0.04, 0, 0});
  const auto unclear =
      scene::find_calibration(file, driver::ArmKind::kPolhem, home, {same, same, same});
  ASSERT_FALSE(unclear);
  EXPECT_NE(unclear.error().message.find("do not determine"), std::string::npos);
}

TEST_F(CalibrationTest, IsStoredPerArmAndReadUnchanged) {
  const scene::Calibration kept{
      .home_counts = {12, -7700, 0}, .encoder_sign = {-1, 1, -1}, .motor_sign = {1, -1, -1}};
  EXPECT_FALSE(scene::load_calibration("A/../B 1")->has_value());
  ASSERT_TRUE(scene::save_calibration("A/../B 1", kept));
  EXPECT_EQ(scene::calibration_file("A/../B 1").filename(), "A____B_1.yaml");
  EXPECT_EQ(scene::load_calibration("A/../B 1")->value(), kept);
  EXPECT_FALSE(scene::load_calibration("another")->has_value());
  std::ofstream(scene::calibration_file("A/../B 1")) << "home_counts: [1, 2]\n";
  const auto wrong = scene::load_calibration("A/../B 1");
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().message.find(":1"), std::string::npos);
}

/// Returns the feel check of a simulated arm whose driver uses the file `believed`.
std::vector<CheckResult> check_with(const scene::ArmFile& believed, bool& prompted_all) {
  auto bench = BenchArm::open(believed, std::nullopt, "", feel_check_hand({0, 0, 0}),
                              scene::kFeelCheckForceMax);
  EXPECT_TRUE(bench) << bench.error().message;
  int prompts = 0;
  const std::atomic<bool> stop{false};
  const auto results = feel_check(
      **bench, believed, [&](const std::string&) { return ++prompts > 0; }, stop);
  prompted_all = prompts == 8;
  EXPECT_EQ((*bench)->device().f_sent_W().norm(), 0);
  return results;
}

TEST_F(CalibrationTest, FeelCheckPassesAGoodArmAndTimesItsWatchdog) {
  bool prompted_all = false;
  const auto results = check_with(vintage(), prompted_all);
  EXPECT_TRUE(prompted_all);
  ASSERT_EQ(results.size(), 8u);
  for (const CheckResult& result : results) {
    EXPECT_TRUE(result.passed) << result.name << ": " << result.text;
  }
}

TEST_F(CalibrationTest, FeelCheckEndsAtASkippedStep) {
  auto bench = BenchArm::open(vintage(), std::nullopt, "", feel_check_hand({0, 0, 0}),
                              scene::kFeelCheckForceMax);
  ASSERT_TRUE(bench);
  const std::atomic<bool> stop{false};
  int prompts = 0;
  const auto results = feel_check(
      **bench, vintage(), [&](const std::string&) { return ++prompts < 3; }, stop);
  EXPECT_EQ(results.size(), 2u);
}

TEST_F(CalibrationTest, FeelCheckFindsALateWatchdog) {
  scene::ArmFile slow = vintage();
  slow.simulated.firmware.watchdog_ns = 700'000'000;
  bool prompted_all = false;
  const auto results = check_with(slow, prompted_all);
  ASSERT_EQ(results.size(), 8u);
  EXPECT_EQ(results.back().name, "watchdog");
  EXPECT_FALSE(results.back().passed) << results.back().text;
}

/// A wiring fault of an arm, and the sentence that reports it.
struct Miswired {
  const char* name;
  void (*break_it)(device_sim::FirmwareSettings&);
  const char* sentence;
};
void PrintTo(const Miswired& mistake, std::ostream* out) {
  *out << mistake.name;
}

const Miswired kMiswired[] = {
    {"EncoderBackwards", [](auto& f) { f.wiring.encoder_gain[1] = -1; },
     "Encoder 2 counts backwards."},
    {"TwoEncodersBackwards", [](auto& f) { f.wiring.encoder_gain = Eigen::Vector3d(-1, 1, -1); },
     "Encoder 1 counts backwards. Encoder 3 counts backwards."},
    {"EncoderDead", [](auto& f) { f.wiring.encoder_gain[2] = 0; }, "Encoder 3 does not count."},
    {"EncodersSwapped",
     [](auto& f) {
       f.wiring.encoder_of = {0, 2, 1};
     },
     "Encoder 2 responds as 3 should. They are swapped."},
    {"MotorBackwards", [](auto& f) { f.wiring.motor_gain[0] = -1; }, "Motor 1 pulls backwards."},
    {"SecondMotorBackwards", [](auto& f) { f.wiring.motor_gain[1] = -1; },
     "Motor 2 pulls backwards."},
    {"ThirdMotorBackwards", [](auto& f) { f.wiring.motor_gain[2] = -1; },
     "Motor 3 pulls backwards."},
    {"MotorDead", [](auto& f) { f.wiring.motor_gain[1] = 0; }, "Motor 2 does not pull."},
    {"MotorsSwapped",
     [](auto& f) {
       f.wiring.motor_of = {1, 0, 2};
     },
     "Motor 1 responds as 2 should. They are swapped."},
    {"MotorsSwappedAndOneBackwards",
     [](auto& f) {
       f.wiring.motor_of = {0, 2, 1};
       f.wiring.motor_gain[2] = -1;
     },
     "They are swapped"},
};
const char* const kArmFiles[] = {"vintage_phantom", "woodenhaptics", "woodenhaptics_teensy",
                                 "polhem", "falcon"};

/// Each arm with each wiring fault.
class FeelCheckOfAMiswiredArm : public testing::TestWithParam<std::tuple<const char*, Miswired>> {};

TEST_P(FeelCheckOfAMiswiredArm, NamesTheWireAndPushesNoHarder) {
  const auto& [arm, mistake] = GetParam();
  auto read = scene::load_arm(std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/arms" /
                              (std::string(arm) + ".yaml"));
  ASSERT_TRUE(read) << read.error().message;
  scene::ArmFile file = std::move(read).value();
  mistake.break_it(file.simulated.firmware);
  auto bench =
      BenchArm::open(file, std::nullopt, "", feel_check_hand({0, 0, 0}), scene::kFeelCheckForceMax);
  ASSERT_TRUE(bench) << bench.error().message;
  const std::atomic<bool> stop{false};
  const auto results = feel_check(
      **bench, file, [](const std::string&) { return true; }, stop);
  std::string said;
  bool passed = true;
  for (const CheckResult& result : results) {
    said += result.name + ": " + result.text + "\n";
    passed = passed && result.passed;
  }
  EXPECT_FALSE(passed);
  EXPECT_NE(said.find(mistake.sentence), std::string::npos) << said;
  EXPECT_LE((*bench)->true_force_max(), scene::kFeelCheckForceMax) << said;
  EXPECT_EQ((*bench)->device().f_sent_W().norm(), 0);
}

INSTANTIATE_TEST_SUITE_P(Arms, FeelCheckOfAMiswiredArm,
                         testing::Combine(testing::ValuesIn(kArmFiles),
                                          testing::ValuesIn(kMiswired)),
                         [](const auto& instance) {
                           return std::string(std::get<0>(instance.param)) +
                                  std::get<1>(instance.param).name;
                         });

TEST_F(CalibrationTest, FeelCheckPassesGoodArmsWithinItsLimit) {
  for (const char* arm : kArmFiles) {
    SCOPED_TRACE(arm);
    const auto file = scene::load_arm(std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/arms" /
                                      (std::string(arm) + ".yaml"));
    ASSERT_TRUE(file);
    auto bench = BenchArm::open(*file, std::nullopt, "", feel_check_hand({0, 0, 0}),
                                scene::kFeelCheckForceMax);
    ASSERT_TRUE(bench) << bench.error().message;
    const std::atomic<bool> stop{false};
    for (const CheckResult& result : feel_check(
             **bench, *file, [](const std::string&) { return true; }, stop)) {
      EXPECT_TRUE(result.passed) << result.name << ": " << result.text;
    }
    EXPECT_LE((*bench)->true_force_max(), scene::kFeelCheckForceMax);
    EXPECT_GT((*bench)->true_force_max(), 0.3);
  }
}

TEST_F(CalibrationTest, FeelCheckReportsAMissingWatchdog) {
  scene::ArmFile careless = vintage();
  careless.simulated.firmware.watchdog_ns = INT64_MAX / 4;
  bool prompted_all = false;
  const auto results = check_with(careless, prompted_all);
  ASSERT_EQ(results.size(), 8u);
  EXPECT_FALSE(results.back().passed);
  EXPECT_NE(results.back().text.find("did not go off"), std::string::npos) << results.back().text;
}

}  // namespace
}  // namespace thimble::bringup
