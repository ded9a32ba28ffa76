#include <gtest/gtest.h>

#include <Eigen/Core>
#include <atomic>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "arm_table.h"
#include "open_arm.h"
#include "replug_watch.h"
#include "setup.h"
#include "share/shared_reader.h"
#include "share/shared_run.h"
#include "support/scratch.h"
#include "thimble/scene/arm_simulation.h"
#include "thimble/scene/scene_file.h"
#include "thimble/session/session.h"

// Several arms in one run, some of them real. A separate simulated arm represents each real one,
// behind a link that the session treats as a board. Virtual time makes the test independent of the
// machine's load.

namespace thimble {
namespace {

using Eigen::Vector3d;

const std::filesystem::path kSource(THIMBLE_SOURCE_DIR);
const std::atomic<bool> kNobodyStops{false};

/// A link to an arm whose cable can be pulled.
class PulledLink final : public driver::ArmLink {
 public:
  PulledLink(std::unique_ptr<driver::ArmLink> link, const bool& pulled)
      : link_(std::move(link)), pulled_(pulled) {}
  const driver::ArmTraits& traits() const noexcept override { return link_->traits(); }
  driver::LinkRead read(driver::ArmSample& sample, std::int64_t deadline_ns) noexcept override {
    if (pulled_) return {.status = driver::LinkStatus::kLost};
    return link_->read(sample, deadline_ns);
  }
  driver::LinkWrite write(const driver::GatedForce& force, const driver::ArmSample& sample,
                          const Eigen::Matrix3d& R_WB) noexcept override {
    if (pulled_) return {.status = driver::LinkStatus::kLost};
    return link_->write(force, sample, R_WB);
  }
  driver::MotorCurrents currents() const noexcept override { return link_->currents(); }
  void limit_currents(const std::array<driver::MotorDrive, 3>& limits) noexcept override {
    link_->limit_currents(limits);
  }

 private:
  std::unique_ptr<driver::ArmLink> link_;
  const bool& pulled_;
};

/// Two boards that are simulated outside of the session, with the messages to the user and the keys
/// pressed.
class MixedArms : public ::testing::Test {
 protected:
  MixedArms() {
    setenv("XDG_CONFIG_HOME", (support::scratch_folder() / "mixed").c_str(), 1);
    options_.several_arms = true;
    options_.clock = session::ClockKind::kWall;
    options_.own_clock = std::make_shared<driver::VirtualClock>();
    terminal_ = {.there = true,
                 .key = [this] { return std::exchange(key_, session::EnterKey::kNothing); },
                 .print_line = [this](const std::string& line) { told_ += line + "\n"; },
                 .ask = [this](const std::string& line) { told_ += line + "\n"; }};
  }

  /// Makes the arm `name` of the scene real: its tip rests at `away` (m) from its home pose.
  void make_real(const std::string& name, const Vector3d& away = Vector3d::Zero()) {
    session::RealArmUse use;
    use.arm.kind = driver::ArmKind::kPolhem;
    use.arm.serial = "board_of_" + name;
    use.terms.arm.path = kSource / "app/arms/vintage_phantom.yaml";
    use.terms.arm.file = scene::load_arm(use.terms.arm.path).value();
    use.terms.max_force = max_force_;
    const std::size_t board = boards_.size();
    boards_.emplace_back();
    use.open_link = [this, board, away](
                        const scene::ArmFile& file,
                        driver::Clock& clock) -> driver::Result<std::unique_ptr<driver::ArmLink>> {
      const Vector3d p_home =
          file.p_WB + file.R_WB * driver::make_arm(file.protocol, file.model)->pose({}).p_BT;
      auto made = scene::ArmSimulation::make(file, {{0.0, p_home + away}});
      if (!made) return made.error();
      boards_[board] = std::move(made).value();
      return std::unique_ptr<driver::ArmLink>(
          std::make_unique<PulledLink>(boards_[board]->link(clock), pulled_));
    };
    options_.real_arms[name] = std::move(use);
  }

  driver::Result<std::unique_ptr<session::Session>> prepared(
      scene::FaultRule rule = scene::FaultRule::kTogether) {
    options_.adjust = [rule](scene::Scene& scene) { scene.faults = rule; };
    return session::Session::prepare(kSource / "app/scenes/two_hands.yaml", options_);
  }

  session::SessionOptions options_;
  session::Terminal terminal_;
  session::EnterKey key_ = session::EnterKey::kNothing;
  std::string told_;
  double max_force_ = 4;
  bool pulled_ = false;
  // They outlive the sessions of a test
  std::vector<std::unique_ptr<scene::ArmSimulation>> boards_;
};

TEST_F(MixedArms, SimulatedHandStartsWithTheForces) {
  make_real("right");
  auto made = prepared();
  ASSERT_TRUE(made) << made.error().message;
  session::Session& session = **made;
  EXPECT_TRUE(session.setup().any_real());
  EXPECT_EQ(session.setup().device_name(0), "sim");
  EXPECT_EQ(session.setup().device_name(1), "board_of_right");
  EXPECT_TRUE(session::agree_to_forces(session, true, terminal_, kNobodyStops));
  EXPECT_NE(told_.find("board_of_right is about to apply forces"), std::string::npos) << told_;
  ASSERT_TRUE(session.open_arm());
  EXPECT_EQ(session.device(0).stage(), driver::DeviceStage::kIdle);
  EXPECT_EQ(session.device(1).stage(), driver::DeviceStage::kIdle);
  // For five seconds the real arm is not yet at its start pose.
  driver::Clock& clock = session.setup().clock();
  for (int tick = 0; tick < 5000; ++tick) {
    clock.sleep_until_ns(clock.now_ns() + 1'000'000);
    for (std::size_t arm = 0; arm < 2; ++arm) {
      session.device(arm).idle(clock.now_ns(), clock.now_ns());
    }
  }
  const double waited_at = session.device(0).state().p_WT.z();
  ASSERT_TRUE(session.setup().check_start_pose());
  ASSERT_TRUE(session.activate());
  for (int tick = 0; tick < 1400; ++tick) ASSERT_FALSE(session.step(kNobodyStops)) << tick;
  EXPECT_EQ(session.device(0).fault(), driver::Fault::kNone);
  EXPECT_EQ(session.device(1).fault(), driver::Fault::kNone);
  EXPECT_NEAR(waited_at, -0.03, 0.004) << "the hand waited";
  EXPECT_GT(session.device(0).state().p_WT.z(), waited_at + 0.03) << "the hand lifts the beam now";
  EXPECT_GT(session.device(0).f_sent_W().norm(), 0.3);
}

TEST_F(MixedArms, EachRealArmMustBeAtItsStartPose) {
  make_real("left");
  make_real("right", {0, 0, 0.04});
  const auto refused = session::Session::open(kSource / "app/scenes/two_hands.yaml", options_);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message.find("The arm \"right\": "), 0u) << refused.error().message;
  EXPECT_NE(refused.error().message.find("away from its home pose"), std::string::npos);
}

TEST_F(MixedArms, RealArmStaysWithinItsLimits) {
  max_force_ = 0.5;
  make_real("right");
  auto made = prepared();
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ((*made)->setup().arm_file(1).limits.force_max, 0.5);
  EXPECT_GT((*made)->setup().arm_file(0).limits.force_max, 4);
  EXPECT_EQ((*made)->setup().feel_check(1), scene::FeelCheckState::kNone);
  EXPECT_EQ((*made)->setup().feel_check(0), scene::FeelCheckState::kSimulated);
  // Its base is where the scene puts it.
  EXPECT_NEAR((*made)->setup().arm_file(1).R_WB(0, 0),
              -scene::load_arm("vintage_phantom").value().R_WB(0, 0), 1e-12);
}

TEST_F(MixedArms, PulledCableStopsAllArmsOrOnlyItsOwn) {
  for (const auto rule : {scene::FaultRule::kTogether, scene::FaultRule::kApart}) {
    SCOPED_TRACE(rule == scene::FaultRule::kApart ? "apart" : "together");
    pulled_ = false;
    options_.real_arms.clear();
    boards_.clear();
    boards_.reserve(2);
    options_.own_clock = std::make_shared<driver::VirtualClock>();
    make_real("right");
    auto made = prepared(rule);
    ASSERT_TRUE(made) << made.error().message;
    session::Session& session = **made;
    ASSERT_TRUE(session.open_arm());
    ASSERT_TRUE(session.activate());
    session::ReplugWatches watches(session, terminal_);
    for (int tick = 0; tick < 1400; ++tick) ASSERT_FALSE(session.step(kNobodyStops)) << tick;
    watches.step();
    ASSERT_GT(session.device(0).f_sent_W().norm(), 0.3);
    told_.clear();
    pulled_ = true;
    for (int tick = 0; tick < 3; ++tick)
      ASSERT_FALSE(session.step(kNobodyStops)) << "a real arm may come back";
    watches.step();
    EXPECT_EQ(session.device(1).fault(), driver::Fault::kTransportLost);
    EXPECT_NE(told_.find("\nright: Force is off (transport_lost)"), std::string::npos) << told_;
    const bool together = rule == scene::FaultRule::kTogether;
    EXPECT_EQ(session.device(0).fault(),
              together ? driver::Fault::kOtherArm : driver::Fault::kNone);
    EXPECT_EQ(session.device(0).f_sent_W().isZero(0), together);
    EXPECT_EQ(told_.find("left: Force is off (other_arm)") != std::string::npos, together) << told_;
    if (!together) continue;
    // Enter requests it, and is refused while the other arm is disconnected.
    key_ = session::EnterKey::kPressed;
    watches.step();
    for (int tick = 0; tick < 3; ++tick) ASSERT_FALSE(session.step(kNobodyStops));
    EXPECT_EQ(session.device(0).fault(), driver::Fault::kOtherArm);
    EXPECT_TRUE(session.device(0).f_sent_W().isZero(0));
  }
}

TEST_F(MixedArms, EnterReactivatesAllArms) {
  make_real("left");
  make_real("right");
  auto made = prepared();
  ASSERT_TRUE(made) << made.error().message;
  session::Session& session = **made;
  ASSERT_TRUE(session.open_arm());
  ASSERT_TRUE(session.activate());
  session::ReplugWatches watches(session, terminal_);
  for (int tick = 0; tick < 500; ++tick) ASSERT_FALSE(session.step(kNobodyStops));
  watches.step();
  session.device(1).trip(driver::Fault::kOverSpeed);
  for (int tick = 0; tick < 3; ++tick) ASSERT_FALSE(session.step(kNobodyStops));
  watches.step();
  ASSERT_EQ(session.device(0).fault(), driver::Fault::kOtherArm);
  ASSERT_EQ(session.device(1).fault(), driver::Fault::kOverSpeed);
  for (int tick = 0; tick < 300; ++tick) ASSERT_FALSE(session.step(kNobodyStops));
  watches.step();
  EXPECT_EQ(session.device(0).fault(), driver::Fault::kOtherArm) << "Enter was not pressed";
  key_ = session::EnterKey::kPressed;
  watches.step();
  for (int tick = 0; tick < 3; ++tick) ASSERT_FALSE(session.step(kNobodyStops));
  EXPECT_EQ(session.device(0).fault(), driver::Fault::kNone) << told_;
  EXPECT_EQ(session.device(1).fault(), driver::Fault::kNone) << told_;
  EXPECT_EQ(session.device(0).stage(), driver::DeviceStage::kActive);
  EXPECT_EQ(session.device(1).stage(), driver::DeviceStage::kActive);
}

TEST_F(MixedArms, ViewerShowsAndPausesAllArms) {
  make_real("right");
  options_.share = true;
  auto made = prepared();
  ASSERT_TRUE(made) << made.error().message;
  session::Session& session = **made;
  auto reader = session::SharedReader::over(session.shared()->memory().again().value());
  ASSERT_TRUE(reader) << reader.error().message;
  const session::SharedScene& shown = (*reader)->scene();
  EXPECT_EQ(shown.arms.front().in_scene, "left");
  ASSERT_EQ(shown.arms.size(), 2u);
  EXPECT_EQ(shown.arms[1].in_scene, "right");
  EXPECT_EQ(shown.arms[1].device, "board_of_right");
  EXPECT_EQ(shown.arms[1].p_WB, session.setup().arm_file(1).p_WB);
  EXPECT_TRUE(shown.knobs.empty()) << "the knob would change only one arm";
  driver::TickRecord tick;
  EXPECT_FALSE((*reader)->newest_of(1, tick)) << "no tick yet";
  ASSERT_TRUE(session.open_arm());
  ASSERT_TRUE(session.activate());
  for (int i = 0; i < 1400; ++i) ASSERT_FALSE(session.step(kNobodyStops));
  ASSERT_TRUE((*reader)->newest_of(1, tick));
  EXPECT_EQ(tick.tick, session.ticks(1).back().tick);
  EXPECT_EQ(tick.p_WT, session.ticks(1).back().p_WT);
  EXPECT_NE(tick.p_WT, session.ticks(0).back().p_WT);
  EXPECT_FALSE((*reader)->newest_of(0, tick));
  EXPECT_FALSE((*reader)->newest_of(2, tick));
  ASSERT_GT(session.device(0).f_sent_W().norm(), 0.3);
  // In a pause the forces of all arms fade; afterwards they return.
  (*reader)->ask_pause(true);
  for (int i = 0; i < 400; ++i) ASSERT_FALSE(session.step(kNobodyStops));
  for (std::size_t arm = 0; arm < 2; ++arm) {
    EXPECT_LT(session.device(arm).f_sent_W().norm(), 1e-9) << arm;
    EXPECT_EQ(session.device(arm).fault(), driver::Fault::kNone) << arm;
  }
  (*reader)->ask_pause(false);
  for (int i = 0; i < 700; ++i) ASSERT_FALSE(session.step(kNobodyStops));
  EXPECT_GT(session.device(0).f_sent_W().norm(), 0.2);
}

TEST_F(MixedArms, NamesMustBeThoseOfTheScene) {
  make_real("middle");
  const auto unknown = prepared();
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().message.find("none is named \"middle\". Choose one of: left, right."),
            std::string::npos)
      << unknown.error().message;
  const auto one = session::Session::prepare(kSource / "app/scenes/box.yaml", options_);
  ASSERT_FALSE(one);
  EXPECT_NE(one.error().message.find("the scene has one arm; remove middle= from --device"),
            std::string::npos)
      << one.error().message;
}

}  // namespace
}  // namespace thimble
