#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "arm_policy/feel_check_record.h"
#include "arm_policy_home.h"
#include "bringup/doctor.h"
#include "support/mock/mock_haply_service.h"
#include "thimble/driver/device.h"
#include "thimble/scene/arm_file.h"
#include "thimble/scene/arm_policy.h"
#include "thimble/scene/arm_simulation.h"
#include "thimble/scene/real_arm.h"

namespace thimble::bringup {
namespace {

using driver::BoardKind;
using driver::Certainty;
using driver::FoundArm;
using support::HaplyGreeting;
using support::MockHaplyService;

/// A computer that runs Haply's service.
class LinkedArmTest : public ArmPolicyTest {
 protected:
  ~LinkedArmTest() override { unsetenv("THIMBLE_HAPLY_PORT"); }

  void serve(HaplyGreeting greeting = HaplyGreeting::kInverse3) {
    service_ = std::make_unique<MockHaplyService>(greeting);
    setenv("THIMBLE_HAPLY_PORT", std::to_string(service_->port()).c_str(), 1);
  }

  /// Returns the arms that are found behind services.
  static std::vector<FoundArm> linked() {
    auto arms = driver::find_arms();
    std::vector<FoundArm> found;
    if (!arms) return found;
    std::copy_if(arms->begin(), arms->end(), std::back_inserter(found),
                 [](const FoundArm& arm) { return arm.board == BoardKind::kHaplyService; });
    return found;
  }

  std::unique_ptr<MockHaplyService> service_;
};

TEST_F(LinkedArmTest, IsFoundChosenAndOpenedWithItsOwnFile) {
  serve();
  const auto arms = linked();
  ASSERT_EQ(arms.size(), 1u);
  const FoundArm& arm = arms.front();
  EXPECT_EQ(arm.name(), "049D");
  EXPECT_EQ(arm.certainty, Certainty::kProvesItself);
  EXPECT_EQ(service_->log().messages, 0) << "a search sends no messages";
  const auto chosen = scene::choose_arm(arms, "auto");
  ASSERT_TRUE(chosen && *chosen) << chosen.error().message;

  auto terms = scene::find_arm_policy(**chosen, {});
  ASSERT_TRUE(terms) << terms.error().message;
  EXPECT_EQ(terms->arm.path.filename(), "inverse3.yaml");
  EXPECT_EQ(terms->feel_check, scene::FeelCheckState::kNone);
  EXPECT_EQ(terms->max_force, scene::kFeelCheckForceMax);

  driver::WallClock clock(0);
  auto link = scene::open_link(**chosen, terms->arm.file, {}, clock);
  ASSERT_TRUE(link) << link.error().message;
  auto device = driver::Device::open(std::move(link).value(),
                                     scene::device_settings(terms->arm.file, 1000), clock.now_ns());
  ASSERT_TRUE(device) << device.error().message;
  // The mock's arm is at (0.01, -0.13, 0.17): 10 mm to the right of the world's origin.
  EXPECT_LT(((*device)->state().p_WT - Eigen::Vector3d(0, 0.01, 0)).norm(), 1e-3);
}

TEST_F(LinkedArmTest, TwoArmsMakeAutoAskWhich) {
  serve();
  auto arms = linked();
  ASSERT_EQ(arms.size(), 1u);
  FoundArm falcon = plug(driver::ArmKind::kFalcon, "F1");
  falcon.accessible = true;
  arms.push_back(falcon);
  const auto chosen = scene::choose_arm(arms, "auto");
  ASSERT_FALSE(chosen);
  EXPECT_TRUE(holds(chosen.error().message, "049D (Haply Inverse3), F1")) << chosen.error().message;
  EXPECT_TRUE(holds(chosen.error().message, "--device NAME"));
  EXPECT_EQ((*scene::choose_arm(arms, "049D"))->board, BoardKind::kHaplyService);
}

TEST_F(LinkedArmTest, RefusesFilesOfOtherArms) {
  serve();
  const FoundArm arm = linked().at(0);
  const auto falcon = scene::load_arm(kArms / "falcon.yaml");
  const auto own = scene::load_arm(kArms / "inverse3.yaml");
  ASSERT_TRUE(falcon && own);
  EXPECT_FALSE(scene::check_fits(*falcon, arm));
  EXPECT_TRUE(scene::check_fits(*own, arm));
  EXPECT_FALSE(scene::check_fits(*own, plug(driver::ArmKind::kFalcon, "F1")));
  EXPECT_FALSE(scene::ArmSimulation::make(*own, {}));
}

TEST_F(LinkedArmTest, KeepsAPassedFeelCheckOnlyForTheSameVersions) {
  serve();
  FoundArm arm = linked().at(0);
  const auto terms = scene::find_arm_policy(arm, {});
  ASSERT_TRUE(terms);
  ASSERT_TRUE(scene::save_feel_check(scene::describe_checked(arm, terms->arm, {})));
  EXPECT_EQ(scene::find_arm_policy(arm, {})->feel_check, scene::FeelCheckState::kPassed);
  arm.software = R"({"major_version":4})";
  EXPECT_EQ(scene::find_arm_policy(arm, {})->feel_check, scene::FeelCheckState::kNone);
  arm.software.clear();
  EXPECT_FALSE(scene::save_feel_check(scene::describe_checked(arm, terms->arm, {})));
}

TEST_F(LinkedArmTest, DoctorReportsServiceOrMissingParts) {
  const auto said = [](const std::string& words) {
    for (const Finding& found : examine(this_machine())) {
      if (holds(found.what, words)) return found;
    }
    return Finding{};
  };
  serve();
  EXPECT_TRUE(holds(said("Inverse3 049D").what, "major_version"));
  EXPECT_EQ(said("Inverse3 049D").health, Health::kGood);
  serve(HaplyGreeting::kUncalibrated);
  EXPECT_EQ(said("Inverse3 049D").health, Health::kProblem);
  EXPECT_TRUE(holds(said("Inverse3 049D").remedy, "Calibrate it"));
}

TEST_F(LinkedArmTest, FileOmitsWhatTheVendorSoftwareKnows) {
  const std::string text = text_of(kArms / "inverse3.yaml");
  const auto mistake = [&](const std::string& more) {
    write(home_ / "own.yaml", text + more);
    const auto read = scene::load_arm(home_ / "own.yaml");
    return read ? std::string() : read.error().message;
  };
  EXPECT_EQ(mistake(""), "");
  EXPECT_TRUE(
      holds(mistake("geometry: {height: 0.1, length_b: 0.1, length_c: 0.1}\n"), "geometry"));
  EXPECT_TRUE(holds(mistake("joints: {}\n"), "joints"));
  EXPECT_TRUE(holds(mistake("simulation: {}\n"), "simulation"));
  EXPECT_TRUE(holds(mistake("board: falcon_ftdi\n"), "does not use the protocol haply_service"));
}

}  // namespace
}  // namespace thimble::bringup
