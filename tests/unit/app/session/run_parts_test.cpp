// Parts of `thimble run` outside of the run: choice of the arm, opening of a viewer, messages to
// the user, and exit code.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "cli/exit_code.h"
#include "run_arm.h"
#include "run_attendance.h"
#include "share/viewer_request_handler.h"
#include "support/scripted_run.h"

namespace thimble {
namespace {

using session::ViewerChoice;

TEST(ChooseRunArm, SimulatedArmNeedsNoBoardSearch) {
  int looks = 0;
  const auto find = [&] {
    ++looks;
    return driver::Result<std::vector<driver::FoundArm>>(std::vector<driver::FoundArm>());
  };
  const auto simulated = session::choose_run_arm("sim", {}, find);
  ASSERT_TRUE(simulated);
  EXPECT_FALSE(simulated->real);
  EXPECT_TRUE(simulated->warnings.empty());
  EXPECT_EQ(looks, 0);
}

TEST(ChooseRunArm, ReportsSimulationAndUnknownNames) {
  const auto none = [] {
    return driver::Result<std::vector<driver::FoundArm>>(std::vector<driver::FoundArm>());
  };
  const auto cannot_look = [] {
    return driver::Result<std::vector<driver::FoundArm>>(driver::Error{"no such folder"});
  };
  for (const session::FindArms& find : {session::FindArms(none), session::FindArms(cannot_look)}) {
    const auto automatic = session::choose_run_arm("auto", {}, find);
    ASSERT_TRUE(automatic) << automatic.error().message;
    EXPECT_FALSE(automatic->real || automatic->terms);
    ASSERT_EQ(automatic->warnings.size(), 1u);
    EXPECT_EQ(automatic->warnings[0], "No arm is connected: the simulated arm is used.");
    EXPECT_FALSE(session::choose_run_arm("S1", {}, find));
  }
}

TEST(ChooseRunArms, GivesEachArmOfASceneItsOwnBoard) {
  const auto find = [] {
    driver::FoundArm one, other;
    one.kind = other.kind = driver::ArmKind::kPolhem;
    one.arm = other.arm = "polhem";
    one.accessible = other.accessible = true;
    one.board = other.board = driver::BoardKind::kMbedHid14;
    one.serial = "S1";
    other.serial = "S2";
    return driver::Result<std::vector<driver::FoundArm>>(std::vector<driver::FoundArm>{one, other});
  };
  scene::ArmPolicyRequest request;
  request.arm_file = std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/arms/polhem.yaml";
  const auto two = session::choose_run_arms({"left=S1", "right=S2"}, request, find);
  ASSERT_TRUE(two) << two.error().message;
  EXPECT_TRUE(two->real());
  EXPECT_FALSE(two->one.real);
  ASSERT_EQ(two->several.size(), 2u);
  EXPECT_EQ(two->several.at("left")->arm.serial, "S1");
  EXPECT_EQ(two->several.at("right")->arm.serial, "S2");
  EXPECT_EQ(two->warnings.at(0).find("The arm \"left\": "), 0u) << two->warnings.at(0);
  const auto mixed = session::choose_run_arms({"right=S2", "left=sim"}, request, find);
  ASSERT_TRUE(mixed) << mixed.error().message;
  EXPECT_TRUE(mixed->real());
  EXPECT_FALSE(mixed->several.at("left")) << "simulated, and its name is looked at";
  const auto one = session::choose_run_arms({"S1"}, request, find);
  ASSERT_TRUE(one) << one.error().message;
  EXPECT_TRUE(one->one.real && one->several.empty());

  const auto refused = [&](const std::vector<std::string>& devices) {
    const auto arms = session::choose_run_arms(devices, request, find);
    return arms ? std::string("taken") : arms.error().message;
  };
  EXPECT_NE(refused({"left=S1", "right=S1"}).find("\"left\" and \"right\" are both assigned to S1"),
            std::string::npos);
  EXPECT_NE(refused({"left=S1", "S2"}).find("NAME=S2"), std::string::npos);
  EXPECT_NE(refused({"left=S1", "left=S2"}).find("\"left\" twice"), std::string::npos);
  EXPECT_NE(refused({"left=auto"}).find("The arm \"left\": "), std::string::npos) << "which of two";
}

TEST(OpensViewer, OnRequestOrForARealTimeRunAtATerminal) {
  EXPECT_TRUE(session::opens_viewer(ViewerChoice::kAsked, false, true, false));
  EXPECT_FALSE(session::opens_viewer(ViewerChoice::kAsked, true, false, true)) << "no screen";
  EXPECT_TRUE(session::opens_viewer(ViewerChoice::kIfWatched, true, true, true));
  EXPECT_FALSE(session::opens_viewer(ViewerChoice::kIfWatched, false, true, true));
  EXPECT_FALSE(session::opens_viewer(ViewerChoice::kIfWatched, true, true, false)) << "a script";
  EXPECT_FALSE(session::opens_viewer(ViewerChoice::kNever, true, true, true));
}

TEST(RunState, HasTimeContactForceAndDepth) {
  const auto run = support::scripted_run(1000, 100, 300);
  EXPECT_EQ(session::run_state(run[200], 20),
            "0.2 of 20.0 s   touching  force  0.80 N   depth  1.00 mm");
  EXPECT_EQ(session::run_state(run[50], 0), "0.1 s   free      force  0.00 N   depth  0.00 mm");
}

TEST(HeatWarning, IsGivenOnceAtTheFirstTickAboveTheLimit) {
  auto run = support::scripted_run(10, 0, 10);
  for (std::size_t i = 0; i < run.size(); ++i) run[i].heat = {0, 0.1 * static_cast<double>(i), 0};
  session::HeatWarning warning;
  std::vector<std::string> given;
  for (const auto& tick : run) {
    if (const std::string text = warning.check(tick); !text.empty()) given.push_back(text);
  }
  ASSERT_EQ(given.size(), 1u);
  EXPECT_EQ(given[0].find("A motor is at 80 % of its heat limit;"), 0u) << given[0];
  EXPECT_TRUE(warning.check(run.back()).empty());
}

TEST(ExitCode, DependsOnTheEndOfTheRun) {
  using driver::Fault;
  using driver::ServoEnd;
  EXPECT_EQ(cli::exit_code_of(ServoEnd::kDone, Fault::kNone, false), cli::kExitDone);
  EXPECT_EQ(cli::exit_code_of(ServoEnd::kDone, Fault::kTransportLost, false), cli::kExitFault)
      << "a loop with a real arm outlives its faults";
  EXPECT_EQ(cli::exit_code_of(ServoEnd::kStopped, Fault::kNone, false), cli::kExitInterrupted);
  EXPECT_EQ(cli::exit_code_of(ServoEnd::kStopped, Fault::kNone, true), cli::kExitDone);
  EXPECT_EQ(cli::exit_code_of(ServoEnd::kFault, Fault::kOverSpeed, true), cli::kExitFault);
}

TEST(ExitCode, DoesNotDependOnTheOrderOfArms) {
  const auto both = [](cli::ExitCode one, cli::ExitCode other) {
    EXPECT_EQ(cli::more_serious(one, other), cli::more_serious(other, one));
    return cli::more_serious(one, other);
  };
  EXPECT_EQ(both(cli::kExitFault, cli::kExitInterrupted), cli::kExitFault);
  EXPECT_EQ(both(cli::kExitFault, cli::kExitDone), cli::kExitFault);
  EXPECT_EQ(both(cli::kExitInterrupted, cli::kExitDone), cli::kExitInterrupted);
  EXPECT_EQ(both(cli::kExitDone, cli::kExitDone), cli::kExitDone);
}

}  // namespace
}  // namespace thimble
