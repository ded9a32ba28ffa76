#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <utility>

#include "support/identify/cabled_arm.h"
#include "support/identify/identified_arm.h"
#include "support/identify/recorded_motion.h"
#include "support/long_form.h"
#include "twin/compare_twin.h"
#include "twin/replay.h"
#include "twin/twin_files.h"
#include "twin/twin_forces.h"
#include "twin/twin_motion.h"

namespace thimble::twin {
namespace {

using support::cabled_arm;
using support::HiddenArm;
using support::long_form;
using support::recorded_motion;

TwinResult both_ways(const session::Recording& recording, const scene::ArmFile& file) {
  auto result = compare_twin(recording, file, {});
  if (!result) {
    ADD_FAILURE() << result.error().message;
    return {};
  }
  return std::move(result).value();
}

/// Returns the error of a recording replayed on the arm of a file, relative to the error from
/// encoder steps.
double left_by(const TwinMotion& motion, const scene::ArmFile& file) {
  auto relive = Replay::make(motion, 0.2);
  if (!relive) {
    ADD_FAILURE() << relive.error().message;
    return HUGE_VAL;
  }
  const auto relived = (*relive)(file);
  EXPECT_TRUE(relived.ok());
  return relived.ok() ? relived->rms() / motion.step_error : HUGE_VAL;
}

TEST(TwinCables, SameConstantsReproduceTheMotion) {
  const std::uint64_t arms = long_form() ? 20 : 1;
  double worst = 0, apart = 0;
  for (std::uint64_t seed = 1; seed <= arms; ++seed) {
    HiddenArm arm = cabled_arm(seed);
    // In every third arm the currents lag as well.
    if (seed % 3 == 0) arm.file.simulated.drive_train.current_lag = 5e-4;
    const auto motion =
        twin_motion(recorded_motion(arm.file, "vintage_phantom", seed, 2.5), arm.file);
    ASSERT_TRUE(motion.ok()) << motion.error().message;
    const double left = left_by(*motion, arm.file);
    worst = std::max(worst, left);
    EXPECT_LT(left, 1.2) << "arm " << seed;
    scene::ArmFile other = arm.file;
    other.simulated.drive_train.stiffness *= 0.7;
    EXPECT_GT(left_by(*motion, other), 1.5 * left) << "arm " << seed;
    other.simulated.drive_train = {};
    EXPECT_GT(left_by(*motion, other), 3 * left) << "arm " << seed;
    const TwinForces forces = twin_forces(*motion, arm.file);
    EXPECT_FALSE(forces.other_acted()) << "arm " << seed << "\n" << force_table(forces);
    for (const TwinForceAxis& axis : forces.axes) {
      apart = std::max(apart, std::abs(axis.needed_rms / axis.motors_rms - 1));
      EXPECT_NEAR(axis.needed_rms / axis.motors_rms, 1, 0.05) << "arm " << seed << axis.name;
    }
    EXPECT_TRUE(twin_forces(*motion, other).other_acted()) << "arm " << seed;
  }
  std::printf("%d arms: error at most %.3f of the encoders' steps, forces %.2f %% apart\n",
              static_cast<int>(arms), worst, 100 * apart);
}

TEST(TwinCables, NameTheConstantThatIsWrong) {
  if (!long_form()) GTEST_SKIP() << "18 constants, each tested: only in the long form";
  using Train = device_sim::DriveTrainSettings;
  struct Mistake {
    const char* key;
    std::function<void(Train&)> make;
  };
  const Mistake mistakes[] = {
      {"simulation.drive_train.stiffness[2]", [](Train& train) { train.stiffness[1] *= 0.7; }},
      {"simulation.drive_train.inertia[1]", [](Train& train) { train.inertia[0] *= 1.4; }},
      {"simulation.drive_train.stiffness[3]", [](Train& train) { train.stiffness[2] *= 1.4; }},
      {"simulation.drive_train.inertia[3]", [](Train& train) { train.inertia[2] *= 0.7; }},
  };
  for (std::uint64_t seed = 31; seed <= 34; ++seed) {
    const HiddenArm arm = cabled_arm(seed);
    const auto recording = recorded_motion(arm.file, "vintage_phantom", seed, 2.5);
    for (std::size_t m = 0; m < std::size(mistakes); ++m) {
      if (m != seed % std::size(mistakes)) continue;
      scene::ArmFile wrong = arm.file;
      mistakes[m].make(wrong.simulated.drive_train);
      const TwinComparison found = both_ways(recording, wrong).comparison;
      ASSERT_TRUE(found.has_remedy()) << twin_table(found);
      EXPECT_EQ(found.remedies.front().key, mistakes[m].key) << "arm " << seed << "\n"
                                                             << twin_table(found);
    }
  }
}

}  // namespace
}  // namespace thimble::twin
