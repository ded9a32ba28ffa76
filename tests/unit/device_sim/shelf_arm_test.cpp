// A plugged arm with constants other than the default ones, and commands to the hand on it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "arms/falcon/falcon_arm.h"
#include "arms/hfab/hfab_models.h"
#include "support/refuses.h"
#include "thimble/device_sim/usb/arm_shelf.h"
#include "usb/hid_arm.h"

namespace thimble::device_sim::usb {
namespace {

using driver::arm_model;
using support::refuses;

/// An arm without friction, whose motors are `gain` times as strong as its driver assumes.
ShelfArm shelf_arm(driver::ArmModel model, double gain) {
  for (driver::MotorDrive& drive : model.drives) drive.torque_constant *= gain;
  SimulatedArmSettings settings;
  settings.plant.mass = 0.2;
  settings.hand = {.mass = 0.02, .stiffness = 300, .damping = 5};
  settings.motors.current_max = 3;
  return {.model = std::move(model), .settings = settings};
}

std::unique_ptr<UsbArm> plugged(const char* name, ShelfArm arm, HandMotion motion) {
  auto made =
      make_usb_arm(name, {.motion = motion, .serial = {}, .firmware = {}, .arm = std::move(arm)});
  EXPECT_TRUE(made.ok());
  return std::move(made).value();
}

/// Returns the distance (m) by which 0.1 A in the first motor move a free tip in 50 ms.
double driven(UsbArm& arm) {
  const auto& hid = dynamic_cast<const HidArm&>(arm);
  std::vector<std::byte> message(hid.report_size());
  message[0] = std::byte{100};  // mA
  const Eigen::Vector3d begin = arm.truth().p_BT;
  for (int frame = 1; frame <= 50; ++frame) {
    arm.advance_to(frame * UsbDevice::kFrame_ns);
    std::vector<std::byte> report(UsbDevice::kPacketMax);
    arm.in(hid.board().in, report);
    EXPECT_EQ(arm.out(hid.board().out, message).answer, Answer::kDone);
  }
  return (arm.truth().p_BT - begin).norm();
}

TEST(ShelfArm, UsesTheConstantsOfItsFile) {
  const std::vector<std::pair<const char*, driver::ArmModel>> boards{
      {"woodenhaptics", arm_model(driver::hfab::woody_model())},
      {"polhem", arm_model(driver::hfab::polhem_model())},
      {"polhem-64", arm_model(driver::hfab::polhem_model())}};
  for (const auto& [name, model] : boards) {
    const double whole = driven(*plugged(name, shelf_arm(model, 1), HandMotion::kNone));
    const double half = driven(*plugged(name, shelf_arm(model, 0.5), HandMotion::kNone));
    EXPECT_GT(whole, 0.001) << name;
    EXPECT_NEAR(half / whole, 0.5, 0.01) << name;
    // A hand resists it.
    EXPECT_LT(driven(*plugged(name, shelf_arm(model, 1), HandMotion::kRest)), 0.9 * whole) << name;
  }
}

/// The third generation of the Haply 2DIY, in its home pose.
driver::ArmModel five_bar() {
  driver::ArmModel model;
  model.geometry = driver::FiveBarArm{
      .base = 0.038, .crank_1 = 0.07, .crank_2 = 0.07, .distal_1 = 0.09, .distal_2 = 0.09};
  const driver::MotorDrive drive{.ratio = 1, .torque_constant = 0.123, .current_max = 1};
  model.drives = {drive, drive, driver::absent_motor()};
  model.encoders = {driver::JointEncoder{.counts_per_motor_turn = 4880, .home_counts = 2277},
                    driver::JointEncoder{.counts_per_motor_turn = 4880, .home_counts = 163},
                    driver::absent_encoder()};
  return model;
}

/// A Hapkit, in its home pose.
driver::ArmModel paddle() {
  driver::ArmModel model;
  model.geometry = driver::PaddleArm{.handle = 0.09};
  model.drives = {driver::MotorDrive{.ratio = 14.8, .torque_constant = 0.03, .current_max = 1},
                  driver::absent_motor(), driver::absent_motor()};
  model.encoders = {driver::JointEncoder{.counts_per_motor_turn = 4096}, driver::absent_encoder(),
                    driver::absent_encoder()};
  return model;
}

TEST(ShelfArm, FiveBarAndPaddleMoveByTheirMotorsOnAHidBoard) {
  for (const driver::ArmModel& model : {five_bar(), paddle()}) {
    for (const char* board : {"polhem", "polhem-64"}) {
      const double whole = driven(*plugged(board, shelf_arm(model, 1), HandMotion::kNone));
      const double half = driven(*plugged(board, shelf_arm(model, 0.5), HandMotion::kNone));
      EXPECT_GT(whole, 0.001) << board;
      EXPECT_NEAR(half / whole, 0.5, 0.03) << board;
    }
  }
}

TEST(ShelfArm, HandOfAFiveBarStrokesInItsPlane) {
  const auto arm = plugged("polhem", shelf_arm(five_bar(), 1), HandMotion::kStroke);
  const Eigen::Vector3d begin = arm->truth().p_BT;
  double farthest = 0;
  for (int ms = 1; ms <= 3000; ++ms) {
    arm->advance_to(ms * std::int64_t{1'000'000});
    EXPECT_EQ(arm->truth().p_BT.z(), 0);
    farthest = std::max(farthest, (arm->truth().p_BT - begin).norm());
  }
  EXPECT_GT(farthest, 0.01);
}

TEST(ShelfArm, IsRefusedOnABoardOfAnotherGeometry) {
  const auto of = [](const char* name, const driver::ArmModel& model) {
    return make_usb_arm(name, {.serial = {}, .firmware = {}, .arm = shelf_arm(model, 1)});
  };
  const auto woody = arm_model(driver::hfab::woody_model());
  EXPECT_TRUE(refuses(of("polhem", woody), "does not match the geometry"));
  EXPECT_TRUE(refuses(of("polhem-64", woody), "does not match the geometry"));
  EXPECT_TRUE(refuses(of("falcon", woody), "does not match the geometry"));
  EXPECT_TRUE(refuses(of("woodenhaptics", five_bar()), "does not match the geometry"));
  EXPECT_TRUE(refuses(of("woodenhaptics", arm_model(driver::falcon::falcon_model())),
                      "does not match the geometry"));
}

TEST(ShelfArm, FollowsAHandThatIsLedUntilItLetsGo) {
  for (const char* name : {"woodenhaptics", "falcon"}) {
    const auto model = std::string(name) == "falcon" ? arm_model(driver::falcon::falcon_model())
                                                     : arm_model(driver::hfab::woody_model());
    const auto arm = plugged(name, shelf_arm(model, 1), HandMotion::kRest);
    const Eigen::Vector3d begin = arm->truth().p_BT, away(0, 0.02, 0);
    arm->lead_hand(begin + away);
    arm->advance_to(1'000'000'000);
    EXPECT_LT((arm->truth().p_BT - begin - away).norm(), 0.001) << name;
    arm->hold_tip(false);
    arm->lead_hand(begin);
    arm->advance_to(2'000'000'000);
    EXPECT_LT((arm->truth().p_BT - begin - away).norm(), 0.002) << name << ": no hand holds it";
    arm->hold_tip(true);
    arm->advance_to(3'000'000'000);
    EXPECT_LT((arm->truth().p_BT - begin).norm(), 0.001) << name;
  }
}

TEST(ShelfArm, CarriesAMassThatIsFixedToItsTip) {
  const Eigen::Vector3d gravity_B(0, -6, -8);
  const auto woody = arm_model(driver::hfab::woody_model());
  const std::vector<std::pair<const char*, driver::ArmModel>> boards{
      {"woodenhaptics", woody},
      {"polhem", arm_model(driver::hfab::polhem_model())},
      {"falcon", arm_model(driver::falcon::falcon_model())}};
  for (const auto& [name, model] : boards) {
    for (const double weight :
         {0.0, 0.3}) {  // of the arm itself, which selects another type of plant
      ShelfArm own = shelf_arm(model, 1);
      own.settings.weight_B = Eigen::Vector3d(0, 0, weight);
      const auto arm = plugged(name, own, HandMotion::kNone);
      auto fallen = [&arm, at_ns = std::int64_t{0}](std::int64_t for_ns) mutable {
        const Eigen::Vector3d begin = arm->truth().p_BT;
        arm->advance_to(at_ns += for_ns);
        return Eigen::Vector3d(arm->truth().p_BT - begin);
      };
      ASSERT_TRUE(arm->fix_mass(0.05, gravity_B)) << name;
      const Eigen::Vector3d a = (own.settings.weight_B + 0.05 * gravity_B) / 0.25;
      EXPECT_LT((fallen(50'000'000) - 0.5 * 0.0025 * a).norm(), 1e-5) << name << weight;
      // After the mass is removed, the arm continues with its velocity.
      ASSERT_TRUE(arm->fix_mass(0, gravity_B)) << name;
      const Eigen::Vector3d b = own.settings.weight_B / 0.2;
      EXPECT_LT((fallen(50'000'000) - 0.0025 * a - 0.5 * 0.0025 * b).norm(), 1e-5) << name;
      EXPECT_TRUE(refuses(arm->fix_mass(-0.01, gravity_B), "at least 0 kg"));
      EXPECT_TRUE(refuses(arm->fix_mass(NAN, gravity_B), "at least 0 kg"));
    }
  }
  // A hand that holds the tip also carries the mass, by its spring of 300 N/m.
  const auto held = plugged("woodenhaptics", shelf_arm(woody, 1), HandMotion::kRest);
  const Eigen::Vector3d begin = held->truth().p_BT;
  ASSERT_TRUE(held->fix_mass(0.05, gravity_B));
  held->advance_to(3'000'000'000);
  EXPECT_LT((held->truth().p_BT - begin - 0.05 * gravity_B / 300).norm(), 1e-5);
}

}  // namespace
}  // namespace thimble::device_sim::usb
