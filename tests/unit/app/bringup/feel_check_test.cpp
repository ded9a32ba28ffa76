#include "bringup/feel_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <optional>
#include <string>

#include "thimble/scene/arm_file.h"

namespace thimble::bringup {
namespace {

scene::ArmFile shipped(const std::string& name) {
  auto file = scene::load_arm(std::string(THIMBLE_SOURCE_DIR) + "/app/arms/" + name + ".yaml");
  EXPECT_TRUE(file) << file.error().message;
  return std::move(file).value();
}

/// Results of a feel check, and its largest force.
struct Checked {
  std::vector<CheckResult> results;
  double force_max = 0;  // N, true force at the tip
  int asked = 0;         // number of questions

  bool passed() const {
    return results.size() == kFeelChecks &&
           std::all_of(results.begin(), results.end(),
                       [](const CheckResult& result) { return result.passed; });
  }
  std::string text() const {
    std::string all;
    for (const CheckResult& result : results) all += result.name + ": " + result.text + "\n";
    return all;
  }
};

/// Runs the feel check of a file's simulated arm, with a hand that follows the prompts and answers
/// correctly.
Checked check(const scene::ArmFile& file, bool answers = true) {
  Checked found;
  auto bench =
      BenchArm::open(file, std::nullopt, "", feel_check_hand({0, 0, 0}), scene::kFeelCheckForceMax);
  EXPECT_TRUE(bench) << bench.error().message;
  if (!bench) return found;
  const std::atomic<bool> stop{false};
  const Question question = [&](const std::string&) -> std::optional<bool> {
    ++found.asked;
    if (!answers) return {};
    return (*bench)->true_force() < 0.1;
  };
  found.results = feel_check(
      **bench, file, [](const std::string&) { return true; }, stop, question);
  found.force_max = (*bench)->true_force_max();
  EXPECT_EQ((*bench)->device().f_sent_W().norm(), 0);
  return found;
}

/// Board of a shipped arm file, and the time of its watchdog, s.
struct Board {
  const char* file;
  double watchdog;
};
void PrintTo(const Board& board, std::ostream* out) {
  *out << board.file;
}

class FeelCheckOfAShippedFile : public testing::TestWithParam<Board> {};

TEST_P(FeelCheckOfAShippedFile, PassesItsOwnBoard) {
  scene::ArmFile file = shipped(GetParam().file);
  file.simulated.firmware.watchdog_ns = static_cast<std::int64_t>(1e9 * GetParam().watchdog);
  const Checked found = check(file);
  EXPECT_TRUE(found.passed()) << found.text();
  EXPECT_LE(found.force_max, scene::kFeelCheckForceMax);
}

TEST_P(FeelCheckOfAShippedFile, DetectsABoardWithoutWatchdog) {
  scene::ArmFile file = shipped(GetParam().file);
  file.simulated.firmware.watchdog_ns = INT64_MAX / 4;
  const Checked found = check(file);
  ASSERT_EQ(found.results.size(), kFeelChecks);
  EXPECT_FALSE(found.results.back().passed) << found.text();
  EXPECT_NE(found.results.back().text.find("did not go off"), std::string::npos) << found.text();
}

// mbed boards 0.5 s [S woody-experimental main.cpp, haptikfabrikenapi firmware/main.cpp], boards
// with text lines 0.1 s [S woodenhaptics firmware]; for the Falcon the assumption of its
// simulation.
INSTANTIATE_TEST_SUITE_P(Boards, FeelCheckOfAShippedFile,
                         testing::Values(Board{"woodenhaptics", 0.5}, Board{"polhem", 0.5},
                                         Board{"woodenhaptics_teensy", 0.1},
                                         Board{"vintage_phantom", 0.1}, Board{"falcon", 0.1}),
                         [](const auto& instance) { return std::string(instance.param.file); });

TEST(FeelCheck, ReadsAnArmThatOnlyAnswersAfterTheSilence) {
  const Checked found = check(shipped("falcon"), false);
  ASSERT_EQ(found.results.size(), kFeelChecks);
  EXPECT_TRUE(found.results.back().passed);
  EXPECT_NE(found.results.back().text.find("motors were off"), std::string::npos) << found.text();
}

/// A shipped arm with dry friction at the tip, N per axis.
scene::ArmFile rubbing(const char* name, double coulomb) {
  scene::ArmFile file = shipped(name);
  file.simulated.plant.coulomb = coulomb;
  return file;
}

TEST(FeelCheck, PassesArmsOfHighDryFriction) {
  for (const char* name : {"vintage_phantom", "woodenhaptics", "polhem", "falcon"}) {
    for (const double coulomb : {0.2, 0.26, 0.3}) {
      const Checked found = check(rubbing(name, coulomb));
      EXPECT_TRUE(found.passed()) << name << " " << coulomb << "\n" << found.text();
      EXPECT_LE(found.force_max, scene::kFeelCheckForceMax) << name << " " << coulomb;
    }
  }
}

// 0.49 N minus 0.35 N of friction moves a tip in a hand by a few encoder steps.
TEST(FeelCheck, ReportsFrictionNearItsStrongestPush) {
  for (const char* name : {"vintage_phantom", "woodenhaptics", "polhem", "falcon"}) {
    const Checked found = check(rubbing(name, 0.35));
    EXPECT_TRUE(found.passed() || found.text().find("dry friction") != std::string::npos)
        << name << "\n"
        << found.text();
    EXPECT_LE(found.force_max, scene::kFeelCheckForceMax) << name;
  }
}

TEST(FeelCheck, ReportsFrictionIfNothingMoves) {
  const Checked found = check(rubbing("vintage_phantom", 0.7));
  EXPECT_FALSE(found.passed());
  EXPECT_NE(found.text().find("dry friction"), std::string::npos) << found.text();
  EXPECT_EQ(found.text().find("does not pull"), std::string::npos) << found.text();
}

TEST(FeelCheck, AsksIfFrictionHidesTheWatchdog) {
  const Checked found = check(rubbing("vintage_phantom", 0.35));
  EXPECT_EQ(found.asked, 1);
  EXPECT_NE(found.results.back().text.find("You answered that the arm stopped"), std::string::npos)
      << found.text();
}

TEST(FeelCheck, FailsWithoutAnAnswer) {
  const Checked found = check(rubbing("vintage_phantom", 0.35), false);
  ASSERT_EQ(found.results.size(), kFeelChecks);
  EXPECT_FALSE(found.results.back().passed) << found.text();
}

TEST(FeelCheck, NamesADeadMotorBehindHighFriction) {
  scene::ArmFile file = rubbing("vintage_phantom", 0.2);
  file.simulated.firmware.wiring.motor_gain[1] = 0;
  const Checked found = check(file);
  EXPECT_FALSE(found.passed());
  EXPECT_NE(found.text().find("Motor 2 does not pull"), std::string::npos) << found.text();
}

TEST(FeelCheck, DetectsAMissingWatchdogBehindHighFriction) {
  scene::ArmFile file = rubbing("woodenhaptics", 0.3);
  file.simulated.firmware.watchdog_ns = INT64_MAX / 4;
  const Checked found = check(file);
  EXPECT_FALSE(found.passed()) << found.text();
}

}  // namespace
}  // namespace thimble::bringup
