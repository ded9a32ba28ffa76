#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <string>

#include "hil/soak.h"
#include "support/figure_value.h"
#include "support/long_form.h"

namespace thimble::hil {
namespace {

using support::figure_value;

constexpr double kRise = 80;  // K, final temperature rise of a winding at its continuous current
constexpr double kCurrent = 0.3;  // A

/// Returns a file with this continuous current (A) and thermal time constant (s, to 63 % of the
/// final heat); its simulated motors are the same.
scene::ArmFile warm_arm(double current, double time_constant) {
  scene::ArmFile file = scene::load_arm("vintage_phantom").value();
  file.heat.continuous_current.fill(current);
  file.heat.time_constant.fill(time_constant);
  auto& heat = file.simulated.drive_train.heat;
  heat.rise = kRise;
  heat.continuous_current.setConstant(current);
  heat.time_constant.setConstant(time_constant);
  heat.resistance = 0.0039;  // temperature coefficient of copper, 1/K
  return file;
}

HilResult soak_of(const scene::ArmFile& file, const scene::ArmFile& arm, double minutes) {
  const std::atomic<bool> never{false};
  return check_soak({.file = file,
                     .open = [&](TipHold hold) { return open_simulated(arm, {}, hold); },
                     .stop = never,
                     .prompt = {}},
                    minutes);
}

/// Returns the names of the figures that miss their goals.
std::string missed(const HilResult& result) {
  std::string names;
  for (const session::Figure& one : result.figures) {
    if (!one.met()) names += (names.empty() ? "" : " ") + one.name;
  }
  return names;
}

TEST(HilSoak, PassesMotorsThatWarmAsInTheirFile) {
  // The short form is three time constants of motors that warm quickly; the long one an hour.
  const scene::ArmFile file = support::long_form() ? warm_arm(kCurrent, 60) : warm_arm(kCurrent, 6);
  const HilResult soak = soak_of(file, file, support::long_form() ? 60 : 0.3);
  std::printf("%s\n", soak.text.c_str());
  EXPECT_EQ(soak.outcome, HilOutcome::kPassed) << soak.text;
  EXPECT_GT(figure_value(soak.figures, "motor_heat"), 0.2);
  EXPECT_NEAR(
      figure_value(soak.figures, "motor_heat") / figure_value(soak.figures, "heat_in_the_end"), 1,
      0.3);
  EXPECT_LT(figure_value(soak.figures, "heat_from_model"), 1e-6);
  // Cool copper has less resistance than at its limit, so it is never warmer than the driver's
  // estimate.
  EXPECT_LE(figure_value(soak.figures, "winding_of_thought"), 1);
  EXPECT_GT(figure_value(soak.figures, "winding_of_thought"), 0.7);
  EXPECT_NE(soak.text.find("never warmer than that"), std::string::npos) << soak.text;
}

TEST(HilSoak, FindsMotorsThatHeatMoreThanInTheirFile) {
  for (const double times : {1.2, 1.5, 2.0}) {
    scene::ArmFile file = warm_arm(kCurrent, 60);
    // Cold copper has a quarter less resistance than at its limit, which hides an error of a fifth.
    if (times < 1.5) file.simulated.drive_train.heat.resistance = 0;
    scene::ArmFile arm = file;
    arm.simulated.drive_train.heat.continuous_current /= std::sqrt(times);
    const HilResult soak = soak_of(file, arm, 0.2);
    EXPECT_EQ(soak.outcome, HilOutcome::kFailed) << times << soak.text;
    EXPECT_EQ(missed(soak), "winding_of_thought") << times;
    const double cold = 1 + file.simulated.drive_train.heat.resistance * kRise;
    EXPECT_NEAR(figure_value(soak.figures, "winding_of_thought") * cold, times, 0.1 * times);
  }
}

TEST(HilSoak, FindsMotorsThatWarmMoreQuickly) {
  const scene::ArmFile file = warm_arm(kCurrent, 60);
  scene::ArmFile arm = file;
  arm.simulated.drive_train.heat.time_constant[1] = 20;
  const HilResult soak = soak_of(file, arm, 0.2);
  EXPECT_EQ(missed(soak), "winding_of_thought");
  EXPECT_NE(soak.text.find("Motor 2"), std::string::npos) << soak.text;
  EXPECT_NE(soak.text.find("heats more than the arm file says"), std::string::npos) << soak.text;
}

TEST(HilSoak, FindsMotorsThatWereWarmBefore) {
  const scene::ArmFile file = warm_arm(kCurrent, 60);
  scene::ArmFile arm = file;
  arm.simulated.drive_train.heat.at_start.setConstant(30);
  EXPECT_EQ(missed(soak_of(file, arm, 0.1)), "winding_of_thought");
}

TEST(HilSoak, HeatReducesTheForceAndStaysWithinTheLimit) {
  // Motors that are far too weak for this motion.
  const scene::ArmFile file = warm_arm(0.06, 3);
  const HilResult soak = soak_of(file, file, 0.3);
  EXPECT_EQ(missed(soak), "") << soak.text;
  EXPECT_GT(figure_value(soak.figures, "ticks_lowered_by_heat"), 100);
  EXPECT_GT(figure_value(soak.figures, "motor_heat"), 0.85);
  EXPECT_LE(figure_value(soak.figures, "motor_heat"), 1);
  EXPECT_GT(figure_value(soak.figures, "current_of_allowed"), 0.95);
  EXPECT_LE(figure_value(soak.figures, "winding_heat"), 1);
  EXPECT_NE(soak.text.find("The force was reduced because of heat in"), std::string::npos)
      << soak.text;
}

TEST(HilSoak, ReportsWhatCannotBeDetermined) {
  scene::ArmFile file = scene::load_arm("vintage_phantom").value();
  const HilResult cold = soak_of(file, file, 0.1);
  EXPECT_EQ(cold.outcome, HilOutcome::kPassed) << cold.text;
  EXPECT_NE(cold.text.find("The simulation has no motor heat"), std::string::npos) << cold.text;
  file.heat = {};
  const HilResult unknown = soak_of(file, file, 0.1);
  EXPECT_EQ(unknown.outcome, HilOutcome::kPassed) << unknown.text;
  EXPECT_EQ(figure_value(unknown.figures, "motor_heat"), -1);
  EXPECT_NE(unknown.text.find("the arm file has no joints: continuous_current"), std::string::npos)
      << unknown.text;
}

}  // namespace
}  // namespace thimble::hil
