#include "real_arm.h"

#include <gtest/gtest.h>

#include "support/fake_usb.h"
#include "thimble/driver/arms/falcon/falcon_arm.h"

namespace thimble::app {
namespace {

using driver::ArmKind;

ArmFile file_of(const std::string& name) {
  auto file = read_arm_file(std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/arms" / name);
  EXPECT_TRUE(file) << file.error().message;
  return file ? std::move(file).value() : ArmFile{};
}

driver::FoundArm found(ArmKind kind, const std::string& serial) {
  driver::FoundArm arm;
  arm.kind = kind;
  arm.arm = "arm";
  arm.serial = serial;
  arm.accessible = true;
  return arm;
}

TEST(RealArm, IsChosenByNameOrAsTheOnlyOne) {
  const std::vector<driver::FoundArm> arms = {found(ArmKind::kWoody, "W1"),
                                              found(ArmKind::kUnsupported, "T1"),
                                              found(ArmKind::kFalcon, "F1")};
  EXPECT_FALSE(choose_arm(arms, "sim")->has_value());
  EXPECT_EQ((*choose_arm(arms, "F1"))->serial, "F1");
  const auto two = choose_arm(arms, "auto");
  ASSERT_FALSE(two);
  EXPECT_NE(two.error().message.find("W1, F1"), std::string::npos);
  EXPECT_EQ((*choose_arm({arms[0], arms[1]}, "auto"))->serial, "W1");
  EXPECT_FALSE(choose_arm({}, "auto")->has_value());
  EXPECT_NE(choose_arm({}, "W1").error().message.find("None is plugged in"), std::string::npos);
  EXPECT_NE(choose_arm(arms, "T1").error().message.find("No arm is called"), std::string::npos);
}

TEST(RealArm, MustBeAccessible) {
  driver::FoundArm arm = found(ArmKind::kWoody, "W1");
  arm.accessible = false;
  const auto chosen = choose_arm({arm}, "auto");
  ASSERT_FALSE(chosen);
  EXPECT_NE(chosen.error().message.find("70-thimble.rules"), std::string::npos);
}

TEST(RealArm, IsFoundAgainBySerialNumberInAnySocketElseBySocket) {
  const support::FakeUsb usb("find_again");
  usb.plug("1-1", "0403", "cb48", "F1", 1, 2);
  const auto before = driver::find_arms(usb.root())->front();
  usb.unplug("1-1");
  EXPECT_FALSE(find_again(*driver::find_arms(usb.root()), before));
  usb.plug("1-3", "0403", "cb48", "F2", 1, 7);
  EXPECT_FALSE(find_again(*driver::find_arms(usb.root()), before));
  usb.plug("1-4", "0403", "cb48", "F1", 1, 8);
  const auto again = find_again(*driver::find_arms(usb.root()), before);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->usb.device, 8);

  driver::FoundArm nameless = before;
  nameless.serial.clear();
  EXPECT_FALSE(find_again(*driver::find_arms(usb.root()), nameless));  // its socket is empty
  usb.plug("1-1", "0403", "cb48", "", 1, 9);
  EXPECT_EQ(find_again(*driver::find_arms(usb.root()), nameless)->usb.device, 9);
}

TEST(RealArm, TakesOnlyItsOwnFile) {
  const ArmFile vintage = file_of("vintage_phantom.yaml");
  const ArmFile woody = file_of("woodenhaptics.yaml");
  const ArmFile falcon = file_of("falcon.yaml");
  const ArmFile polhem = file_of("polhem.yaml");
  EXPECT_TRUE(check_fits(woody, found(ArmKind::kWoody, "")));
  EXPECT_FALSE(check_fits(vintage, found(ArmKind::kWoody, "")));
  EXPECT_FALSE(check_fits(woody, found(ArmKind::kPolhem, "")));
  EXPECT_TRUE(check_fits(polhem, found(ArmKind::kPolhem, "")));
  EXPECT_TRUE(check_fits(woody, found(ArmKind::kHfabLine, "")));
  EXPECT_TRUE(check_fits(falcon, found(ArmKind::kFalcon, "")));
  EXPECT_FALSE(check_fits(falcon, found(ArmKind::kHfabLine, "")));
  EXPECT_FALSE(check_fits(woody, found(ArmKind::kFalcon, "")));
}

TEST(RealArm, StandsInTheMiddleOfItsWorldAsItsFileSays) {
  const ArmFile falcon = file_of("falcon.yaml");
  const auto arm = make_arm(falcon, ArmKind::kFalcon);
  // Push the grip to the middle of the workspace: all legs at the angle of p_BM.
  const auto q = driver::falcon::falcon_geometry().inverse(driver::falcon::falcon_geometry().p_BM);
  driver::ArmReading reading;
  const Eigen::Vector3d counts = driver::falcon::falcon_model().exact_counts(*q);
  for (std::size_t i = 0; i < 3; ++i) {
    reading.counts[i] =
        static_cast<std::int32_t>(std::lround(counts[static_cast<Eigen::Index>(i)]));
  }
  const Eigen::Vector3d p_WT = falcon.p_WB + falcon.R_WB * arm->pose(reading).p_BT;
  EXPECT_LT(p_WT.norm(), 1e-4);
  // The arm's z, out towards the user, is the world's x; its y is up.
  EXPECT_LT((falcon.R_WB * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitX()).norm(), 1e-9);
  EXPECT_LT((falcon.R_WB * Eigen::Vector3d::UnitY() - Eigen::Vector3d::UnitZ()).norm(), 1e-9);
  EXPECT_LT((falcon.R_WB * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 1e-9);
}

TEST(RealArm, SpeaksTheWireOfItsKind) {
  std::array<std::byte, driver::kReportCapacity> bytes{};
  const ArmFile woody = file_of("woodenhaptics.yaml");
  EXPECT_EQ(make_arm(woody, ArmKind::kWoody)->encode({}, bytes), 8u);
  EXPECT_EQ(make_arm(woody, ArmKind::kHfabLine)->encode({}, bytes), 8u);  // "[0,0,0]\n"
  EXPECT_EQ(bytes[0], std::byte{'['});
  EXPECT_EQ(make_arm(file_of("polhem.yaml"), ArmKind::kPolhem)->encode({}, bytes), 14u);
  EXPECT_EQ(make_arm(file_of("falcon.yaml"), ArmKind::kFalcon)->encode({}, bytes), 16u);
  EXPECT_EQ(bytes[0], std::byte{'<'});
}

}  // namespace
}  // namespace thimble::app
