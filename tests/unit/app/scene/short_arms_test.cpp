#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <utility>

#include "support/scratch.h"
#include "thimble/scene/arm_file.h"
#include "thimble/scene/shipped_files.h"
#include "thimble/scene/simulated_device.h"

// Arms with one or two motors, from their files to the force on the simulated hand.
namespace thimble::scene {
namespace {

using driver::DeviceState;
using driver::ForceCommand;
using driver::TickRecord;
using Eigen::Vector3d;

const std::vector<std::string> kPlanar{"five_bar", "haply_2diy_1", "haply_2diy_2", "haply_2diy_3"};

/// A wall that pushes up (z), and across the plane or line of the arm (x).
struct LeaningWall {
  double height = 0;
  ForceCommand operator()(const DeviceState& state) noexcept {
    ForceCommand command;
    if (state.p_WT.z() < height) {
      const double f = 300 * (height - state.p_WT.z());
      command.f_T_W = {0.5 * f, 0, f};
      command.touch.depth = height - state.p_WT.z();
    }
    return command;
  }
  void operator()(const TickRecord& record) noexcept {
    farthest = std::max(farthest, std::abs(record.p_WT[0]));
    across = std::max(across, std::abs(record.f_sent_W[0]));
    last = record;
  }
  double farthest = 0, across = 0;
  TickRecord last;
};

/// A hand that begins 1 cm above the middle of the workspace and presses 1 cm below it.
std::unique_ptr<SimulatedDevice> pressed(const ArmFile& arm) {
  const Vector3d middle = arm.workspace.middle();
  auto opened = SimulatedDevice::open(arm, {{0.0, middle + Vector3d(0, 0, 0.01)},
                                            {1.0, middle - Vector3d(0, 0, 0.01)},
                                            {2.0, middle - Vector3d(0, 0, 0.01)}});
  EXPECT_TRUE(opened) << opened.error().message;
  return opened ? std::move(opened).value() : nullptr;
}

ArmFile loaded(const std::string& name) {
  auto arm = load_arm(name);
  EXPECT_TRUE(arm) << arm.error().message;
  return arm ? std::move(arm).value() : ArmFile();
}

void expect_felt_in_its_axes(const std::string& name) {
  const ArmFile arm = loaded(name);
  const auto device = pressed(arm);
  ASSERT_NE(device, nullptr);
  ASSERT_TRUE(device->device().activate());
  LeaningWall wall;
  wall.height = arm.workspace.middle().z();
  EXPECT_EQ(device->run(2, wall, wall), driver::ServoEnd::kDone);
  EXPECT_EQ(wall.last.fault, driver::Fault::kNone) << name;
  // Springs of the hand (300 N/m) and the wall (300 N/m) in series: half of 1 cm each, 1.5 N.
  EXPECT_NEAR(wall.last.f_sent_W[2], 1.5, 0.3) << name;
  EXPECT_LT(std::abs(wall.last.f_sent_W[0]), 1e-12) << name;
  EXPECT_EQ(wall.farthest, 0) << name;
  // What could not be given is half of what was.
  const driver::MissingForce& missing = device->device().missing_force();
  EXPECT_GT(missing.ticks, 100U) << name;
  EXPECT_NEAR(missing.f_W.x(), 0.5 * wall.last.f_sent_W[2], 0.01) << name;
  EXPECT_NEAR(missing.f_W.z(), 0, 1e-12) << name;
}

TEST(ShortArms, FiveBarsPressInTheirPlane) {
  for (const std::string& name : kPlanar) expect_felt_in_its_axes(name);
}

TEST(ShortArms, PaddlePressesAlongItsLine) {
  expect_felt_in_its_axes("hapkit");
}

TEST(ShortArms, ThreeMotorsGiveTheWholeForce) {
  const ArmFile arm = loaded("vintage_phantom");
  const auto device = pressed(arm);
  ASSERT_NE(device, nullptr);
  ASSERT_TRUE(device->device().activate());
  LeaningWall wall;
  device->run(2, wall, wall);
  EXPECT_GT(wall.across, 0.3);
  EXPECT_EQ(device->device().missing_force().ticks, 0U);
}

// --- arm files

std::string text_of(const std::string& name) {
  std::ostringstream text;
  text << std::ifstream(*find_arm_file(name)).rdbuf();
  return text.str();
}

driver::Result<ArmFile> read_with(const std::string& name, const std::string& piece,
                                  const std::string& by) {
  std::string text = text_of(name);
  const std::size_t at = text.find(piece);
  EXPECT_NE(at, std::string::npos) << piece;
  if (at != std::string::npos) text.replace(at, piece.size(), by);
  const auto file = support::scratch_folder() / "thimble_short_arm.yaml";
  std::ofstream(file) << text;
  return load_arm(file);
}

std::string mistake_with(const std::string& name, const std::string& piece, const std::string& by) {
  const auto arm = read_with(name, piece, by);
  return arm ? "" : arm.error().message;
}

TEST(ShortArms, ListsHaveOneEntryPerMotor) {
  const std::string mistake = mistake_with("five_bar", "ratio: [10, 10]", "ratio: [10, 10, 10]");
  EXPECT_NE(mistake.find("two numbers"), std::string::npos) << mistake;
  EXPECT_NE(mistake.find("one per motor"), std::string::npos) << mistake;
  EXPECT_NE(mistake_with("hapkit", "ratio: [14.8]", "ratio: 14.8"), "");
}

TEST(ShortArms, MotorsThatAreMissingTakeNoCurrent) {
  const ArmFile arm = loaded("hapkit");
  EXPECT_EQ(arm.motors(), 1);
  EXPECT_EQ(arm.model.drives[1], driver::absent_motor());
  EXPECT_EQ(arm.model.drives[2], driver::absent_motor());
  EXPECT_EQ(loaded("five_bar").model.drives[2], driver::absent_motor());
}

TEST(ShortArms, AtPlacesTheAxesOfTheArm) {
  const ArmFile upright = loaded("five_bar");
  EXPECT_EQ(upright.R_WB.col(0), Vector3d::UnitY());
  EXPECT_EQ(upright.R_WB.col(1), Vector3d::UnitZ());
  EXPECT_EQ(upright.R_WB.col(2), Vector3d::UnitX());
  // The workspace is narrowed to the plane.
  const auto other = read_with("five_bar", "along: [y, z]", "along: [-x, z]");
  ASSERT_TRUE(other) << other.error().message;
  EXPECT_EQ(other->R_WB.col(0), -Vector3d::UnitX());
  EXPECT_EQ(other->workspace.min_W.y(), other->p_WB.y());
  EXPECT_EQ(other->workspace.max_W.y(), other->p_WB.y());
}

TEST(ShortArms, AtRefusesAxesThatAreNotPerpendicular) {
  EXPECT_NE(mistake_with("five_bar", "along: [y, z]", "along: [y, -y]").find("right angles"),
            std::string::npos);
  EXPECT_NE(mistake_with("five_bar", "along: [y, z]", "along: [y]").find("two directions"),
            std::string::npos);
  EXPECT_NE(mistake_with("hapkit", "along: [z]", "along: [z, x]").find("one direction"),
            std::string::npos);
}

TEST(ShortArms, AtIsForArmsWithOneOrTwoMotors) {
  const std::string mistake =
      mistake_with("vintage_phantom", "workspace:", "at: {position: [0, 0, 0]}\nworkspace:");
  EXPECT_NE(mistake.find("one or two motors"), std::string::npos) << mistake;
}

TEST(ShortArms, WorkspaceContainsThePlaneOfTheTip) {
  const std::string mistake = mistake_with("five_bar", "min: [0, -0.05", "min: [-0.01, -0.05");
  EXPECT_EQ(mistake, "");
  const std::string beside = mistake_with("five_bar", "position: [0, 0", "position: [0.1, 0");
  EXPECT_NE(beside.find("line or plane"), std::string::npos) << beside;
}

TEST(ShortArms, HandsAreKeptOnTheAxes) {
  const ArmFile arm = loaded("five_bar");
  EXPECT_EQ(arm.on_axes({0.3, 0.01, 0.02}), Vector3d(0, 0.01, 0.02));
  // A point on the edge of the workspace stays in it.
  ArmFile moved = arm;
  moved.p_WB.x() = moved.workspace.min_W.x() = moved.workspace.max_W.x() = 0.1;
  EXPECT_TRUE(moved.workspace.holds(moved.on_axes({0.3, 0.05, 0.04})));
  EXPECT_EQ(loaded("vintage_phantom").on_axes({0.3, 0.01, 0.02}), Vector3d(0.3, 0.01, 0.02));
}

TEST(ShortArms, HomeIsReadWithItsCheck) {
  const ArmFile arm = loaded("haply_2diy_3");
  EXPECT_EQ(arm.home.how, HomeMethod::kStop);
  ASSERT_TRUE(arm.home.check_p_WT);
  EXPECT_EQ(loaded("vintage_phantom").home.how, HomeMethod::kUnknown);
  const std::string mistake = mistake_with("haply_2diy_3", "how: stop", "how: guess");
  EXPECT_NE(mistake.find("stop, jig, index, absolute or button"), std::string::npos) << mistake;
}

TEST(ShortArms, HomeChecksAPointThatTheTipReaches) {
  const std::string mistake = mistake_with("haply_2diy_3", "check: [0, 0", "check: [0.01, 0");
  EXPECT_NE(mistake.find("tip can reach"), std::string::npos) << mistake;
}

}  // namespace
}  // namespace thimble::scene
