// Cogging and ripple of the motors: their detection, their effect on the other constants, and no
// detection for an arm without them.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>

#include "bringup/identify/constants_table.h"
#include "bringup/identify/output/identified_file.h"
#include "bringup/identify/unidentified_parameters.h"
#include "support/identify/identified_arm.h"
#include "support/long_form.h"
#include "support/random.h"
#include "support/scratch.h"

namespace thimble::bringup {
namespace {

using support::hidden_arm;
using support::HiddenArm;
using support::identified;
using support::kKnownMass;
using support::long_form;
using support::Random;
using support::Score;
using support::wide_hidden_arm;

/// Periods per turn of motors: least common multiples of slots and poles, and twice the segments of
/// commutators.
constexpr std::array kPeriods = {7, 10, 12, 14, 18, 22, 24, 26, 36, 48, 72, 84};
// Cogging, N m: a hundredth of the continuous torque of a motor of the vintage arm (0.91 A, 0.0234
// N m/A) [chosen: a few per cent are usual, M Hanselman 2006]. Ripple, relative: between half of 1
// - cos(90 degrees / N) of a commutator with N segments (0.8 % for 9) and half of 1 - cos(30
// degrees) of block commutation (7 %).
constexpr double kCogging = 2e-4, kRipple = 0.02;

/// Gives an arm cogging or ripple, or both, with 1/3 to 3 times the usual amplitude and random
/// phases.
void give_waves(HiddenArm& arm, Random& random) {
  auto& train = arm.file.simulated.drive_train;
  const auto third_to_three = [&](double value) {
    return value * std::exp(random.uniform(-1, 1) * std::log(3.0));
  };
  train.periods_per_turn = kPeriods[random.bits() % kPeriods.size()];
  const std::uint64_t kind = random.bits() % 4;
  for (int i = 0; i < 3; ++i) {
    train.cogging[i] = kind == 0 ? 0 : third_to_three(kCogging);
    train.ripple[i] = kind == 1 ? 0 : third_to_three(kRipple);
    train.cogging_phase[i] = random.uniform(-1, 1) * std::numbers::pi;
    train.ripple_phase[i] = random.uniform(-1, 1) * std::numbers::pi;
  }
}

/// Statistics of the waves of one kind that were found.
struct Found {
  const char* name;
  int there = 0, seen = 0, invented = 0, held = 0, off = 0, phases_held = 0;
  double worst = 0;

  void add(const TorqueVariation& wave, const Estimate& amplitude, double truth, double phase) {
    invented += wave.seen && truth == 0 ? 1 : 0;
    there += truth != 0 ? 1 : 0;
    if (!wave.seen || truth == 0) return;
    ++seen;
    const double error = std::abs(amplitude.value / truth - 1);
    worst = std::max(worst, error);
    off += error > 0.1 && !amplitude.holds(truth) ? 1 : 0;
    held += amplitude.holds(truth) ? 1 : 0;
    const double turned = std::remainder(wave.phase.value - phase, 2 * std::numbers::pi);
    phases_held += std::abs(turned) <= wave.phase.plus_minus ? 1 : 0;
  }
  void tell() const {
    std::printf("%s: %d of %d seen, %d invented, worst %.3g, %d amplitudes and %d phases held\n",
                name, seen, there, invented, worst, held, phases_held);
  }
};

TEST(IdentifyCogging, FindsCoggingAndRippleOfHiddenArms) {
  // Polhems are only in the long form, because their linkage takes ten times as long to simulate.
  std::vector<std::uint64_t> seeds = {9000, 9001};
  for (std::uint64_t k = 0; long_form() && k < 60; ++k) {
    if (k == 0) seeds.clear();
    seeds.push_back(9000 + k);
  }
  Found cogging{"cogging"}, ripple{"ripple"};
  Score mass{"mass", 0.03}, coulomb{"Coulomb", 0.05}, delay{"delay", 1e-4};
  Score viscous{"viscous", 0.1};
  int reported = 0, right = 0, arms = 0, viscous_right = 0;
  for (const std::uint64_t seed : seeds) {
    SCOPED_TRACE(seed);
    // A third of them WoodenHaptics arms, a few Polhems.
    const bool wide = long_form() && (seed % 3 == 1 || seed % 15 == 2);
    HiddenArm arm = wide ? wide_hidden_arm(seed) : hidden_arm(seed);
    Random random(seed + 1'000'000);
    give_waves(arm, random);
    const auto found = identified(
        arm, {.seconds = long_form() ? 30.0 : 12.0, .known_mass = kKnownMass, .seed = seed});
    if (!found || !found->against.empty()) {
      std::printf("arm %d: %s\n", static_cast<int>(seed),
                  (found ? found->against.front() : found.error().message).c_str());
      continue;
    }
    ++arms;
    const auto& train = arm.file.simulated.drive_train;
    mass.add(found->constants.mass, arm.file.simulated.plant.mass);
    coulomb.add(found->constants.coulomb, arm.file.simulated.plant.coulomb);
    delay.add(found->constants.delay, arm.delay, false);
    const Estimate& rubs = found->constants.viscous;
    const double truth = arm.file.simulated.plant.viscous;
    viscous.add(rubs, truth);
    viscous_right += std::abs(rubs.value / truth - 1) < viscous.max || rubs.holds(truth) ? 1 : 0;
    const MotorCogging& waves = found->waves;
    if (!waves.is_reported()) continue;
    ++reported;
    right += waves.periods == train.periods_per_turn ? 1 : 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      cogging.add(waves.cogging[i], cogging_at_motor(waves, i, found->constants.gain[i]),
                  train.cogging[k], train.cogging_phase[k]);
      ripple.add(waves.ripple[i], waves.ripple[i].amplitude, train.ripple[k],
                 train.ripple_phase[k]);
    }
  }
  const int drawn = static_cast<int>(seeds.size());
  std::printf("%d of %d arms written, %d with waves, %d of these with the right number\n", arms,
              drawn, reported, right);
  for (const Found* one : {&cogging, &ripple}) one->tell();
  for (const Score* score : {&mass, &coulomb, &delay, &viscous}) {
    score->print();
    if (score != &viscous) {
      EXPECT_LT(score->worst, score->max) << score->name;
    }
  }
  EXPECT_GE(viscous_right, 0.95 * arms);
  EXPECT_GE(arms, 0.75 * drawn);
  EXPECT_GE(reported, 0.9 * arms);
  EXPECT_EQ(right, reported);
  for (const Found* one : {&cogging, &ripple}) {
    EXPECT_EQ(one->invented, 0) << one->name;
    EXPECT_GE(one->seen, 0.8 * one->there) << one->name;
    // Wrong by more than a tenth and outside of the interval; 5 % of the intervals may miss.
    EXPECT_LE(one->off, 0.05 * one->seen) << one->name;
    // In the short form there are few intervals, of which one may miss by chance.
    EXPECT_GE(one->held, std::min(0.9 * one->seen, one->seen - 1.0)) << one->name;
    EXPECT_GE(one->phases_held, std::min(0.9 * one->seen, one->seen - 1.0)) << one->name;
  }
}

TEST(IdentifyCogging, ComparesOnlyMotorsThatTurnedFarEnough) {
  // The second motor turns through 0.93 periods with 7 per turn, the correct number, and 1.06 with
  // 8.
  constexpr std::uint64_t kSeed = 9;
  HiddenArm arm = hidden_arm(kSeed);
  auto& train = arm.file.simulated.drive_train;
  train.cogging.setConstant(kCogging);
  train.periods_per_turn = 7;
  train.cogging_phase = {2.7, -0.6, 0.3};
  const auto found = identified(arm, {.seconds = 15, .known_mass = kKnownMass, .seed = kSeed});
  ASSERT_TRUE(found.ok()) << found.error().message;
  const MotorCogging& waves = found->waves;
  EXPECT_EQ(waves.periods, 7);
  EXPECT_TRUE(waves.is_reported());
  for (std::size_t i = 0; i < 3; ++i) {
    const Estimate cogging = cogging_at_motor(waves, i, found->constants.gain[i]);
    EXPECT_TRUE(cogging.holds(kCogging)) << "motor " << i + 1 << ": " << cogging.value;
    EXPECT_FALSE(waves.ripple[i].seen) << "motor " << i + 1;
  }
}

TEST(IdentifyCogging, ReportsItsDetectionLimit) {
  // No waves are reported for arms without any; amplitudes slightly above the reported detection
  // limit are found, for one motor at a time.
  int invented = 0, missed = 0;
  const int arms = long_form() ? 40 : 1;
  for (int k = 0; k < arms; ++k) {
    const auto seed = static_cast<std::uint64_t>(9500 + k);
    HiddenArm arm = hidden_arm(seed);
    const IdentifyOptions options{.seconds = long_form() ? 30.0 : 12.0, .seed = seed};
    const auto none = identified(arm, options);
    ASSERT_TRUE(none.ok()) << none.error().message;
    if (!none->against.empty()) continue;
    invented += none->waves.seen() ? 1 : 0;
    ASSERT_TRUE(none->waves.searched);
    std::string said;
    for (const std::string& sentence : unidentified_parameters(*none)) said += sentence + "\n";
    EXPECT_NE(said.find("Cogging of the motors: none detected; "), std::string::npos) << said;
    EXPECT_NE(said.find("Ripple of the motors: none detected; "), std::string::npos) << said;
    EXPECT_NE(said.find(" periods per turn would have been detected."), std::string::npos) << said;
    const auto motor = static_cast<std::size_t>(k % 3);
    auto& train = arm.file.simulated.drive_train;
    train.periods_per_turn = 14;
    const TorqueVariation& wave = none->waves.cogging[motor];
    ASSERT_GT(wave.below, 0);
    EXPECT_GE(wave.below_of_any, wave.below);
    const auto i = static_cast<Eigen::Index>(motor);
    train.cogging[i] = 1.2 * wave.below * arm.gain[motor] / none->waves.ratio[i];
    const auto some = identified(arm, options);
    ASSERT_TRUE(some.ok()) << some.error().message;
    // Identifying the number of periods per turn needs a larger amplitude.
    missed += some->waves.cogging[motor].seen ? 0 : 1;
  }
  std::printf("waves reported for %d of %d arms without any, %d above the limit missed\n", invented,
              arms, missed);
  EXPECT_EQ(invented, 0);
  EXPECT_LE(missed, 0.05 * arms);
}

TEST(IdentifyCogging, UsesThePeriodsOfTheFile) {
  HiddenArm arm = hidden_arm(9101);
  auto& train = arm.file.simulated.drive_train;
  train.cogging.setConstant(kCogging);
  // Not an integer, so no search would try it.
  train.periods_per_turn = 15.5;
  const OpenBench open = [&](bool) { return simulated_bench(arm.file, 0); };
  const std::atomic<bool> never{false};
  const auto found = identify(open, arm.file, {.seconds = 12, .seed = 9101}, never);
  ASSERT_TRUE(found.ok()) << found.error().message;
  EXPECT_TRUE(found->waves.is_reported());
  EXPECT_EQ(found->waves.periods, 15.5);
  EXPECT_EQ(found->waves.min_periods, found->waves.max_periods);
}

/// Returns an identified arm with waves of some motors, as after a measurement.
Identified with_waves() {
  Identified found;
  found.constants.mass = {0.08, 0.001};
  for (Estimate& gain : found.constants.gain) gain = {2, 0.01};
  found.constants.delay = {0.0002, 1e-5};
  MotorCogging& waves = found.waves;
  waves.searched = true;
  waves.ratio = {9, 7.7, 7.7};
  waves.min_periods = 6, waves.max_periods = 264, waves.periods = 14;
  waves.cogging[0] = {.seen = true, .amplitude = {0.0018, 9e-5}, .phase = {-1.5, 0.1}};
  waves.cogging[1].below_of_any = waves.cogging[2].below_of_any = 3.85e-5;
  waves.ripple[2] = {.seen = true, .amplitude = {0.03, 0.001}, .phase = {3, 0.1}};
  return found;
}

/// Returns the drive train of the file written for it, from the vintage arm's file with `train`
/// added.
device_sim::DriveTrainSettings written(const Identified& found, const std::string& train,
                                       std::string* text = nullptr) {
  const auto own = support::scratch_folder() / "thimble_waves_own.yaml";
  const auto file = support::scratch_folder() / "thimble_waves.yaml";
  std::ostringstream content;
  content << std::ifstream(THIMBLE_SOURCE_DIR "/app/arms/vintage_phantom.yaml").rdbuf();
  std::string whole = content.str();
  whole.insert(whole.find("  encoders: quantised"), train);
  std::ofstream(own) << whole;
  std::filesystem::remove(file);
  const auto done = write_identified(own, file, found, {.date = "2026-11-26", .arm = "A 1"});
  EXPECT_TRUE(done.ok()) << done.error().message;
  const auto read = scene::load_arm(file);
  EXPECT_TRUE(read.ok()) << read.error().message;
  std::ostringstream put;
  put << std::ifstream(file).rdbuf();
  if (text != nullptr) *text = put.str();
  return read.ok() ? read->simulated.drive_train : device_sim::DriveTrainSettings{};
}

TEST(IdentifyCogging, ReplaceAnyEarlierValues) {
  const Identified found = with_waves();
  for (const std::string own :
       {"", "  drive_train: {current_lag: 0.0003}\n",
        "  drive_train: {cogging: [0.1, 0.1, 0.1], periods_per_turn: 7}\n",
        "  drive_train:\n    cogging: [0.1, 0.1, 0.1]\n    periods_per_turn: 7\n"}) {
    SCOPED_TRACE(own);
    std::string text;
    const device_sim::DriveTrainSettings train = written(found, own, &text);
    EXPECT_EQ(train.periods_per_turn, 14);
    // 1.8 mN m at the joint with the file's constants; the motor gives twice as much.
    EXPECT_NEAR(train.cogging[0], 4e-4, 1e-8);
    EXPECT_EQ(train.cogging.tail<2>(), Eigen::Vector2d(0, 0));
    EXPECT_EQ(train.cogging_phase, Eigen::Vector3d(-1.5, 0, 0));
    EXPECT_EQ(train.ripple, Eigen::Vector3d(0, 0, 0.03));
    EXPECT_EQ(train.ripple_phase, Eigen::Vector3d(0, 0, 3));
    EXPECT_EQ(train.current_lag, own.find("current_lag") != std::string::npos ? 0.0003 : 0);
    EXPECT_NE(text.find("N m at the motor [I 2026-11-26, A 1, +- 2e-05, 1e-05, 1e-05]"),
              std::string::npos)
        << text;
  }
}

TEST(IdentifyCogging, UndetectedWavesAreZeroInTheNewFile) {
  Identified found = with_waves();
  found.waves.cogging[0].seen = found.waves.ripple[2].seen = false;
  const std::string named = "  drive_train: {cogging: [0.1, 0.1, 0.1], periods_per_turn: 7}\n";
  EXPECT_TRUE(written(found, named).cogging.isZero(0));
  EXPECT_FALSE(written(found, "").named());
  // Waves that were not searched for are unchanged, and so are those with an unknown number of
  // periods.
  found.waves.searched = false;
  EXPECT_EQ(written(found, named).cogging, Eigen::Vector3d::Constant(0.1));
  found = with_waves();
  found.waves.rivals = {13, 15};
  EXPECT_EQ(written(found, named).cogging, Eigen::Vector3d::Constant(0.1));
  EXPECT_FALSE(written(found, "").named());
  std::string said;
  for (const std::string& sentence : unidentified_parameters(found)) said += sentence;
  EXPECT_NE(said.find("14, 13, 15 fit about equally well"), std::string::npos) << said;
}

TEST(IdentifyCogging, TableListsEachMotor) {
  const auto file = scene::load_arm("vintage_phantom").value();
  const std::string table = constants_table(with_waves(), file);
  EXPECT_NE(table.find("periods of cogging, ripple         14 "), std::string::npos) << table;
  EXPECT_NE(table.find("cogging of motor 1              0.4 +- 0.02 "), std::string::npos) << table;
  EXPECT_NE(table.find("ripple of motor 3                 3 +- 0.1 "), std::string::npos) << table;
  EXPECT_NE(table.find("Cogging of the motors: none detected; 0.01 mN m (motor 2), 0.01 mN m "
                       "(motor 3) with 6 to 264 periods per turn would have been detected."),
            std::string::npos)
      << table;
}

}  // namespace
}  // namespace thimble::bringup
