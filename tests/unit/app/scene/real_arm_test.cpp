#include "thimble/scene/real_arm.h"
#include "arm_table.h"

#include <gtest/gtest.h>

#include "arms/falcon/falcon_arm.h"
#include "arms/hfab/hfab_models.h"
#include "support/mock/fake_usb.h"

namespace thimble::scene {
namespace {

using driver::ArmKind;
using driver::BoardKind;
using driver::Certainty;

scene::ArmFile file_of(const std::string& name) {
  auto file = scene::load_arm(std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/arms" / name);
  EXPECT_TRUE(file) << file.error().message;
  return file ? std::move(file).value() : scene::ArmFile{};
}

driver::FoundArm found(ArmKind kind, const std::string& serial) {
  driver::FoundArm arm;
  arm.kind = kind;
  arm.arm = "arm";
  arm.serial = serial;
  arm.accessible = true;
  switch (kind) {
    case ArmKind::kWoody:
      arm.board = BoardKind::kMbedHid8;
      arm.certainty = Certainty::kProvesItself;
      break;
    case ArmKind::kPolhem:
      arm.board = BoardKind::kMbedHid14;
      arm.certainty = Certainty::kUnknown;
      break;
    case ArmKind::kHfabLine:
      arm.board = BoardKind::kTextLines;
      arm.certainty = Certainty::kUnknown;
      break;
    case ArmKind::kFalcon:
      arm.board = BoardKind::kFalconFtdi;
      break;
    case ArmKind::kHaply:
      arm.board = BoardKind::kHaplyService;
      arm.certainty = Certainty::kProvesItself;
      break;
    case ArmKind::kDhd:
      arm.board = BoardKind::kDhdLibrary;
      break;
    case ArmKind::kHd:
      arm.board = BoardKind::kHdLibrary;
      break;
    case ArmKind::kDescribed:
      arm.board = BoardKind::kDescribed;
      break;
    case ArmKind::kUnsupported:
      arm.certainty = Certainty::kUnsupported;
      break;
  }
  return arm;
}

TEST(RealArm, IsChosenByNameOrAsTheOnlyOne) {
  const std::vector<driver::FoundArm> arms = {found(ArmKind::kWoody, "W1"),
                                              found(ArmKind::kUnsupported, "T1"),
                                              found(ArmKind::kFalcon, "F1")};
  EXPECT_FALSE(scene::choose_arm(arms, "sim")->has_value());
  EXPECT_EQ((*scene::choose_arm(arms, "F1"))->serial, "F1");
  const auto two = scene::choose_arm(arms, "auto");
  ASSERT_FALSE(two);
  EXPECT_NE(two.error().message.find("W1 (arm), F1 (arm)"), std::string::npos);
  EXPECT_EQ((*scene::choose_arm({arms[0], arms[1]}, "auto"))->serial, "W1");
  EXPECT_FALSE(scene::choose_arm({}, "auto")->has_value());
  EXPECT_NE(scene::choose_arm({}, "W1").error().message.find(
                "No arm that Thimble can drive is plugged in"),
            std::string::npos);
  EXPECT_NE(scene::choose_arm(arms, "T1").error().message.find("not public"), std::string::npos);
}

TEST(RealArm, SeveralArmsAreListedWithTheirKinds) {
  std::vector<driver::FoundArm> arms = {found(ArmKind::kWoody, "W1"), found(ArmKind::kFalcon, "F1"),
                                        found(ArmKind::kHaply, "H1")};
  arms[0].arm = "WoodenHaptics";
  arms[1].arm = "Falcon";
  arms[2].arm = "Haply Inverse3";
  const auto chosen = scene::choose_arm(arms, "auto");
  ASSERT_FALSE(chosen);
  EXPECT_NE(
      chosen.error().message.find("W1 (WoodenHaptics), F1 (Falcon), H1 (Haply Inverse3). Name one"),
      std::string::npos)
      << chosen.error().message;
}

TEST(RealArm, OfUnknownKindIsUsedOnlyByNameAndReported) {
  const std::vector<driver::FoundArm> arms = {found(ArmKind::kPolhem, "P1"),
                                              found(ArmKind::kHfabLine, "L1")};
  EXPECT_FALSE(scene::choose_arm(arms, "auto")->has_value());
  EXPECT_EQ((*scene::choose_arm(arms, "L1"))->serial, "L1");
  const std::string listed = scene::boards_left_out(arms);
  EXPECT_NE(listed.find("P1: arm, L1: arm"), std::string::npos) << listed;
  EXPECT_EQ(scene::boards_left_out({found(ArmKind::kFalcon, "F1")}), "");
  // If an arm is plugged in too, "auto" does not select it.
  EXPECT_EQ((*scene::choose_arm({arms[0], arms[1], found(ArmKind::kFalcon, "F1")}, "auto"))->serial,
            "F1");
  driver::FoundArm closed = arms[1];
  closed.accessible = false;
  EXPECT_NE(scene::choose_arm({closed}, "L1").error().message.find("line to add"),
            std::string::npos);
}

TEST(RealArm, WithUnknownReportsIsNeverChosen) {
  driver::FoundArm odd = found(ArmKind::kUnsupported, "O1");
  odd.certainty = Certainty::kUnknown;
  EXPECT_FALSE(scene::choose_arm({odd}, "auto")->has_value());
  EXPECT_NE(scene::choose_arm({odd}, "O1").error().message.find("does not open it"),
            std::string::npos);
}

TEST(RealArm, MustBeAccessible) {
  driver::FoundArm arm = found(ArmKind::kWoody, "W1");
  arm.accessible = false;
  const auto chosen = scene::choose_arm({arm}, "auto");
  ASSERT_FALSE(chosen);
  EXPECT_NE(chosen.error().message.find("70-thimble.rules"), std::string::npos);
}

TEST(RealArm, IsFoundAgainBySerialNumberOrSocket) {
  const support::FakeUsb usb("find_again");
  usb.plug("1-1", "0403", "cb48", "F1", 1, 2);
  const auto before = driver::find_arms(usb.root())->front();
  usb.unplug("1-1");
  EXPECT_FALSE(scene::find_again(*driver::find_arms(usb.root()), before));
  usb.plug("1-3", "0403", "cb48", "F2", 1, 7);
  EXPECT_FALSE(scene::find_again(*driver::find_arms(usb.root()), before));
  usb.plug("1-4", "0403", "cb48", "F1", 1, 8);
  const auto again = scene::find_again(*driver::find_arms(usb.root()), before);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->usb.device, 8);

  usb.plug("1-5", "0403", "cb48", "F1", 1, 9);  // a second one of that name is ambiguous
  EXPECT_FALSE(scene::find_again(*driver::find_arms(usb.root()), before));
}

TEST(RealArm, UnnamedArmIsFoundOnlyInItsSocket) {
  const support::FakeUsb usb("find_again_socket");
  const auto plug = [&usb](const std::string& port, unsigned char bytes, int device) {
    usb.plug(port, "1234", "0006", "0123456789", 1, device);
    usb.add_hidraw(port, 0, "hidraw3", bytes);
  };
  plug("1-1.4", 8, 2);
  const auto before = driver::find_arms(usb.root())->front();
  EXPECT_EQ(before.name(), "usb-1-1.4");
  usb.unplug("1-1.4");
  plug("1-3", 8, 3);  // in another socket it may be another arm
  EXPECT_FALSE(scene::find_again(*driver::find_arms(usb.root()), before));
  plug("1-1.4", 14, 4);  // same socket, but other firmware
  EXPECT_FALSE(scene::find_again(*driver::find_arms(usb.root()), before));
  usb.unplug("1-1.4");
  plug("1-1.4", 8, 5);
  const auto again = scene::find_again(*driver::find_arms(usb.root()), before);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->usb.device, 5);
  EXPECT_EQ(again->name(), before.name());
}

TEST(RealArm, AcceptsOnlyItsOwnFile) {
  const scene::ArmFile vintage = file_of("vintage_phantom.yaml");
  const scene::ArmFile woody = file_of("woodenhaptics.yaml");
  const scene::ArmFile falcon = file_of("falcon.yaml");
  const scene::ArmFile polhem = file_of("polhem.yaml");
  EXPECT_TRUE(scene::check_fits(woody, found(ArmKind::kWoody, "")));
  EXPECT_FALSE(scene::check_fits(vintage, found(ArmKind::kWoody, "")));
  EXPECT_FALSE(scene::check_fits(woody, found(ArmKind::kPolhem, "")));
  EXPECT_TRUE(scene::check_fits(polhem, found(ArmKind::kPolhem, "")));
  // The same arm on another board counts joint A the other way.
  EXPECT_FALSE(scene::check_fits(woody, found(ArmKind::kHfabLine, "")));
  EXPECT_TRUE(
      scene::check_fits(file_of("woodenhaptics_teensy.yaml"), found(ArmKind::kHfabLine, "")));
  EXPECT_FALSE(scene::check_fits(file_of("woodenhaptics_teensy.yaml"), found(ArmKind::kWoody, "")));
  EXPECT_TRUE(scene::check_fits(vintage, found(ArmKind::kHfabLine, "")));
  EXPECT_FALSE(scene::check_fits(vintage, found(ArmKind::kPolhem, "")));
  EXPECT_TRUE(scene::check_fits(falcon, found(ArmKind::kFalcon, "")));
  EXPECT_FALSE(scene::check_fits(falcon, found(ArmKind::kHfabLine, "")));
  EXPECT_FALSE(scene::check_fits(woody, found(ArmKind::kFalcon, "")));
}

// The counts of encoder a increase. Both published clients of the mbed board move the tip against
// them [S CHAI3D CWoodenDevice.cpp, haptikfabrikenapi]; with text lines the tip moves with them [S
// hfabapi].
TEST(RealArm, HasTheSignsOfItsBoard) {
  driver::ArmReading reading;
  reading.counts = {1000, 0, 0};
  const scene::ArmFile mbed = file_of("woodenhaptics.yaml");
  const scene::ArmFile teensy = file_of("woodenhaptics_teensy.yaml");
  EXPECT_LT(driver::make_arm(ArmKind::kWoody, mbed.model)->pose(reading).p_BT.y(), -0.01);
  EXPECT_GT(driver::make_arm(ArmKind::kHfabLine, teensy.model)->pose(reading).p_BT.y(), 0.01);
  for (const scene::ArmFile& file : {mbed, teensy}) EXPECT_EQ(file.model.drives[0].sign, 1);
  // The arm files agree with the built-in data of the driver.
  const auto same = [](const scene::ArmFile& file, const auto& model) {
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(file.model.drives[i].sign, model.drives[i].sign);
      EXPECT_EQ(file.model.encoders[i].sign, model.encoders[i].sign);
      EXPECT_EQ(file.model.drives[i].current_max, model.drives[i].current_max);
    }
  };
  same(mbed, driver::hfab::woody_model(driver::hfab::WoodyBoard::kMbed));
  same(teensy, driver::hfab::woody_model(driver::hfab::WoodyBoard::kTextLines));
}

TEST(RealArm, StandsInTheMiddleOfItsWorldAsItsFileSays) {
  const scene::ArmFile falcon = file_of("falcon.yaml");
  const auto arm = driver::make_arm(ArmKind::kFalcon, falcon.model);
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
  // The z axis of the arm, towards the user, is x of the world; its y axis points up.
  EXPECT_LT((falcon.R_WB * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitX()).norm(), 1e-9);
  EXPECT_LT((falcon.R_WB * Eigen::Vector3d::UnitY() - Eigen::Vector3d::UnitZ()).norm(), 1e-9);
  EXPECT_LT((falcon.R_WB * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 1e-9);
}

TEST(RealArm, UsesTheProtocolOfItsKind) {
  std::array<std::byte, driver::kReportCapacity> bytes{};
  const scene::ArmFile woody = file_of("woodenhaptics.yaml");
  EXPECT_EQ(driver::make_arm(ArmKind::kWoody, woody.model)->encode({}, bytes), 8u);
  EXPECT_EQ(driver::make_arm(ArmKind::kHfabLine, woody.model)->encode({}, bytes),
            8u);  // "[0,0,0]\n"
  EXPECT_EQ(bytes[0], std::byte{'['});
  EXPECT_EQ(driver::make_arm(ArmKind::kPolhem, file_of("polhem.yaml").model)->encode({}, bytes),
            14u);
  EXPECT_EQ(driver::make_arm(ArmKind::kFalcon, file_of("falcon.yaml").model)->encode({}, bytes),
            16u);
  EXPECT_EQ(bytes[0], std::byte{'<'});
}

}  // namespace
}  // namespace thimble::scene
