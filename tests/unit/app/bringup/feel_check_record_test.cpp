// Force limit of a real arm before and after its feel check, and validity of the record of that
// check.
#include "arm_policy/feel_check_record.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <functional>

#include "arm/calibration.h"
#include "arm_policy/limits_policy.h"
#include "arm_policy_home.h"
#include "support/boards/described_port.h"
#include "thimble/scene/scene_file.h"
#include "user_folders.h"

namespace thimble::bringup {
namespace {

using driver::ArmKind;
using driver::FoundArm;

TEST_F(ArmPolicyTest, UncheckedArmStaysBelowHalfANewton) {
  const FoundArm arm = plug(ArmKind::kWoody, "W1");
  const fs::path file = home_ / "scene" / "ball.yaml";
  write(file, ball((kArms / "vintage_phantom.yaml").string(), ""));
  const auto force_of = [&](const scene::ArmPolicy& terms) {
    auto scene = scene::load_scene(file, {.arm = terms.arm.path});
    EXPECT_TRUE(scene && scene::apply_arm_policy(*scene, file, terms));
    return scene->arms.front().arm.limits.force_max;
  };
  const auto none = scene::find_arm_policy(arm, {});
  ASSERT_TRUE(none);
  EXPECT_EQ(none->feel_check, scene::FeelCheckState::kNone);
  EXPECT_EQ(force_of(*none), 0.5);
  EXPECT_TRUE(holds(all_of(none->warnings), "at most 0.5 N")) << all_of(none->warnings);
  EXPECT_TRUE(holds(all_of(none->warnings), "thimble feel-check --device W1\n"))
      << all_of(none->warnings);
  EXPECT_TRUE(holds(all_of(none->warnings), "Arm file: ")) << all_of(none->warnings);

  const auto unchecked =
      scene::find_arm_policy(arm, {.arm_file = {}, .firmware = {}, .unchecked = true});
  ASSERT_TRUE(unchecked);
  EXPECT_EQ(unchecked->feel_check, scene::FeelCheckState::kUnchecked);
  EXPECT_EQ(force_of(*unchecked), 5);
  EXPECT_TRUE(holds(all_of(unchecked->warnings), "UNCHECKED: W1 gets up to 5 N"));

  ASSERT_TRUE(scene::save_feel_check(scene::describe_checked(arm, none->arm, {})));
  const auto passed = scene::find_arm_policy(arm, {});
  ASSERT_TRUE(passed);
  EXPECT_EQ(passed->feel_check, scene::FeelCheckState::kPassed);
  EXPECT_EQ(force_of(*passed), 5);
  EXPECT_FALSE(holds(all_of(passed->warnings), "feel-check"));

  ASSERT_TRUE(scene::remove_feel_check("W1"));
  EXPECT_EQ(scene::find_arm_policy(arm, {})->feel_check, scene::FeelCheckState::kNone);
}

TEST_F(ArmPolicyTest, CalibrationOfADescribedBoardIsPartOfTheRecord) {
  const FoundArm arm = plug(ArmKind::kDescribed, "D1");
  scene::RealArmFile file;
  file.path = kArms / "reference_five_bar.yaml";
  file.file = scene::load_arm(file.path).value();
  const std::string before = scene::describe_checked(arm, file, {}).data;
  file.file.model.encoders[0].home_counts += 100;
  EXPECT_NE(scene::describe_checked(arm, file, {}).data, before);
}

/// Checks whether a passed feel check is still valid after a change.
class FeelCheckRecordTest : public ArmPolicyTest {
 protected:
  FeelCheckRecordTest() {
    write(scene::own_arm_folder() / "woodenhaptics.yaml", text_of(kArms / "woodenhaptics.yaml"));
    EXPECT_TRUE(scene::save_calibration("W1", calibration_));
    const auto file = scene::find_real_arm_file(arm_);
    EXPECT_TRUE(file && scene::save_feel_check(scene::describe_checked(arm_, *file, {})));
  }

  static bool passed(const FoundArm& arm) {
    const auto terms = scene::find_arm_policy(arm, {});
    EXPECT_TRUE(terms) << terms.error().message;
    return terms && terms->feel_check == scene::FeelCheckState::kPassed;
  }

  const FoundArm arm_ = plug(ArmKind::kWoody, "W1");
  const scene::Calibration calibration_{{3, 0, -6000}, {1, -1, -1}, {1, -1, -1}, "woodenhaptics"};
  const fs::path record_ = scene::feel_check_file("W1");
};

TEST_F(FeelCheckRecordTest, IsValidUntilSomethingChanges) {
  EXPECT_TRUE(passed(arm_));
  EXPECT_TRUE(passed(plug(ArmKind::kWoody, "W1")));
}

TEST_F(FeelCheckRecordTest, OfADescribedArmDependsOnItsCalibration) {
  const fs::path path = home_ / "described.yaml";
  write(path, support::phantom_with_wire("\nprotocol: described\n" +
                                         text_of(kArms / "wires/hfab_14_byte.yaml")));
  const auto file = scene::load_arm(path);
  ASSERT_TRUE(file) << file.error().message;
  const FoundArm arm = plug(ArmKind::kDescribed, "D1");
  scene::RealArmFile real;
  real.file = *file;
  real.path = path;
  const std::string before = scene::describe_checked(arm, real, {}).data;
  real.file.model.drives[0].sign *= -1;
  EXPECT_NE(scene::describe_checked(arm, real, {}).data, before);
}

TEST_F(FeelCheckRecordTest, IsInvalidAfterAnyChange) {
  const std::string record = text_of(record_), file = text_of(kArms / "woodenhaptics.yaml");
  const fs::path installed = scene::own_arm_folder() / "woodenhaptics.yaml";
  const auto change = [&](const std::string& piece, const std::string& by) {
    return [=] { write(installed, with(file, piece, by)); };
  };
  const auto calibrate = [](const scene::Calibration& calibration) {
    return [=] { EXPECT_TRUE(scene::save_calibration("W1", calibration)); };
  };
  scene::Calibration motor = calibration_, encoder = calibration_, home = calibration_;
  FoundArm plugged = arm_;
  motor.motor_sign[0] = -1;
  encoder.encoder_sign[2] = 1;
  home.home_counts[1] = 1;
  const struct {
    const char* what;
    std::function<void()> act;
  } cases[] = {
      {"a limit of the arm file", change("force_max: 5 ", "force_max: 4 ")},
      {"a constant of the arm file", change("length_b: 0.205", "length_b: 0.206")},
      {"the name in the arm file", change("name: woodenhaptics", "name: mine")},
      {"a motor's sign", calibrate(motor)},
      {"an encoder's sign", calibrate(encoder)},
      {"the home pose", calibrate(home)},
      {"no calibration", [] { fs::remove(scene::calibration_file("W1")); }},
      {"the firmware's number", [&] { plugged.release = 0x0101; }},
      {"the board's own name", [&] { plugged.product = "another"; }},
      {"a firmware without a number", [&] { plugged.release = 0; }},
      {"a record that was cut off", [&] { write(record_, record.substr(0, record.size() / 2)); }},
      {"an empty record", [this] { write(record_, ""); }},
      {"a record with a byte more", [&] { write(record_, record + ' '); }},
      {"a record of another arm", [&] { write(record_, with(record, "arm: W1", "arm: W2")); }},
      {"a record with write access for all users",
       [this] { EXPECT_EQ(chmod(record_.c_str(), 0666), 0); }},
      {"a folder instead of the record",
       [this] {
         fs::remove(record_);
         fs::create_directories(record_);
       }},
  };
  for (const auto& one : cases) {
    ASSERT_TRUE(passed(plugged)) << "before " << one.what;
    one.act();
    EXPECT_FALSE(passed(plugged)) << one.what;
    // The original state again.
    plugged = arm_;
    fs::remove_all(record_);
    write(record_, record);
    chmod(record_.c_str(), 0644);
    write(installed, file);
    ASSERT_TRUE(scene::save_calibration("W1", calibration_));
  }
  EXPECT_FALSE(passed(plug(ArmKind::kWoody, "W3"))) << "another arm of the kind";
}

TEST_F(FeelCheckRecordTest, FalconRecordIsValidForItsFirmwareImage) {
  const FoundArm falcon = plug(ArmKind::kFalcon, "F1");
  const fs::path image = home_ / "image", other = home_ / "other";
  write(image, "one");
  write(other, "two");
  const auto file = scene::find_real_arm_file(falcon);
  ASSERT_TRUE(file) << file.error().message;
  const auto unknown = scene::save_feel_check(scene::describe_checked(falcon, *file, {}));
  ASSERT_FALSE(unknown);
  EXPECT_TRUE(holds(unknown.error().message, "--firmware")) << unknown.error().message;
  ASSERT_TRUE(scene::save_feel_check(scene::describe_checked(falcon, *file, image)));
  EXPECT_TRUE(scene::has_passed(scene::describe_checked(falcon, *file, image)));
  EXPECT_FALSE(scene::has_passed(scene::describe_checked(falcon, *file, other)));
  EXPECT_FALSE(scene::has_passed(scene::describe_checked(falcon, *file, {})));
}

}  // namespace
}  // namespace thimble::bringup
