// The start of a session with a real arm over a link of the test. All slow steps come before the
// arm is opened, and no force is sent before its pose was checked.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "arm_table.h"
#include "arms/hfab/hfab_report.h"
#include "open_arm.h"
#include "run_records.h"
#include "setup.h"
#include "share/shared_run.h"
#include "support/scratch.h"
#include "thimble/driver/wire_link.h"
#include "thimble/session/servo_thread.h"
#include "thimble/session/session.h"

namespace thimble::session {
namespace {

class SessionStart : public ::testing::Test {
 protected:
  class Answering final : public driver::Transport {
   public:
    explicit Answering(SessionStart& test) : test_(test) {}
    driver::TransportRead read_latest(std::span<std::byte> buffer, std::int64_t) noexcept override {
      const auto bytes = driver::hfab::encode_input({.counts = test_.counts_});
      std::copy(bytes.begin(), bytes.end(), buffer.begin());
      return {.status = driver::TransportStatus::kOk, .size = bytes.size(), .skipped = 0};
    }
    driver::TransportStatus write(std::span<const std::byte> report) noexcept override {
      const auto message = driver::hfab::decode_output(report);
      test_.forced_ += !message || message->current_mA != std::array<std::int16_t, 3>{};
      return driver::TransportStatus::kOk;
    }

   private:
    SessionStart& test_;
  };

  SessionStart() {
    setenv("XDG_CONFIG_HOME", (support::scratch_folder() / "start").c_str(), 1);
    options_.real_arm = driver::FoundArm{};
    options_.real_arm->kind = driver::ArmKind::kPolhem;
    options_.real_arm->serial = "S1";
    const std::filesystem::path file =
        std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/arms/vintage_phantom.yaml";
    options_.terms = scene::ArmPolicy{};
    options_.terms->arm.path = file;
    options_.terms->arm.file = *scene::load_arm(file);
    options_.record = support::scratch_folder() / "start.h5";
    options_.overwrite = true;  // from the previous test
    options_.share = true;
    options_.open_link = [this](
                             const scene::ArmFile&,
                             driver::Clock&) -> driver::Result<std::unique_ptr<driver::ArmLink>> {
      ++opened_;
      ready_ = session_ != nullptr && session_->setup().objects().triangles() > 0 &&
               session_->shared() != nullptr && session_->records().recording.on() &&
               session_->setup().objects().mesh_W().triangles.size() > 0;
      return std::unique_ptr<driver::ArmLink>(std::make_unique<driver::WireLink>(
          std::make_unique<Answering>(*this),
          driver::make_arm(options_.real_arm->kind, options_.terms->arm.file.model)));
    };
  }

  std::filesystem::path scene() const {
    return std::filesystem::path(THIMBLE_SOURCE_DIR) / "tests/data/scenes/two_boxes.yaml";
  }

  session::SessionOptions options_;
  std::unique_ptr<session::Session> session_;
  std::array<std::int16_t, 6> counts_{};
  int opened_ = 0, forced_ = 0;
  bool ready_ = false;
};

TEST_F(SessionStart, OpensTheArmLastAndLeavesItIdle) {
  auto prepared = session::Session::prepare(scene(), options_);
  ASSERT_TRUE(prepared) << prepared.error().message;
  session_ = std::move(prepared).value();
  EXPECT_EQ(opened_, 0);
  ASSERT_TRUE(session_->open_arm());
  EXPECT_EQ(opened_, 1);
  EXPECT_TRUE(ready_) << "something was not there yet when the arm was opened";
  EXPECT_EQ(session_->device().stage(), driver::DeviceStage::kIdle);
  // A run without `activate` sends no force.
  std::atomic<bool> stop{false};
  for (int tick = 0; tick < 20; ++tick) session_->step(stop);
  EXPECT_EQ(forced_, 0);
  EXPECT_EQ(session_->device().stage(), driver::DeviceStage::kIdle);
}

TEST_F(SessionStart, NonInteractiveStartRequiresTheHomePose) {
  counts_ = {2000, 0, 0, 0, 0, 0};
  const auto refused = session::Session::open(scene(), options_);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("away from its home pose"), std::string::npos);
  options_.homed = true;
  EXPECT_TRUE(session::Session::open(scene(), options_)) << "its counters are known to be right";
  counts_ = {12000, 0, 0, 0, 0, 0};
  const auto outside = session::Session::open(scene(), options_);
  ASSERT_FALSE(outside);
  EXPECT_NE(outside.error().message.find("outside of the workspace"), std::string::npos);
  options_.homed = false;
  counts_ = {};
  EXPECT_TRUE(session::Session::open(scene(), options_));
  EXPECT_EQ(forced_, 0);
}

TEST_F(SessionStart, RealArmKeepsTheRateOfItsScene) {
  options_.rate_factor = 4;
  const auto prepared = session::Session::prepare(scene(), options_);
  ASSERT_TRUE(prepared) << prepared.error().message;
  EXPECT_EQ((*prepared)->scene().rate, 1000);
}

TEST_F(SessionStart, ReportsObjectsInWhichARealTipStarts) {
  const std::filesystem::path file = support::scratch_folder() / "around_the_arm.yaml";
  std::ofstream(file) << "name: around\narm: vintage_phantom\nduration: 1\nobjects:\n"
                         "  - {name: ball, sphere: {radius: 1}, stiffness: 500}\n"
                         "hand:\n  path:\n    - {t: 0, at: [0, 0, 0]}\n";
  options_.record.clear();
  const auto prepared = session::Session::prepare(file, options_);
  ASSERT_TRUE(prepared) << prepared.error().message;
  EXPECT_TRUE((*prepared)->setup().inside_at_start().empty())
      << "its place is not known before it is opened";
  const auto opened = session::Session::open(file, options_);
  ASSERT_TRUE(opened) << opened.error().message;
  EXPECT_EQ((*opened)->setup().inside_at_start(), std::vector<std::string>{"ball"});
}

TEST_F(SessionStart, AsksBeforeARealArmGetsForces) {
  auto prepared = session::Session::prepare(scene(), options_);
  ASSERT_TRUE(prepared) << prepared.error().message;
  std::vector<std::string> reported;
  std::atomic<bool> stop{false};
  session::EnterKey answer = session::EnterKey::kPressed;
  int looks = 0;
  session::Terminal terminal{
      .there = true,
      .key = [&] { return ++looks % 3 == 0 ? answer : session::EnterKey::kNothing; },
      .print_line = [&](const std::string& line) { reported.push_back(line); },
      .ask = [&](const std::string& line) { reported.push_back(line); }};
  EXPECT_TRUE(session::agree_to_forces(**prepared, false, terminal, stop));
  ASSERT_EQ(reported.size(), 2u);
  EXPECT_NE(reported[0].find("S1 is about to apply forces."), std::string::npos) << reported[0];
  EXPECT_NE(reported[0].find("in the home pose"), std::string::npos) << reported[0];
  EXPECT_EQ(looks, 3) << "it waits for the answer";
  answer = session::EnterKey::kClosed;
  EXPECT_FALSE(session::agree_to_forces(**prepared, false, terminal, stop));
  stop.store(true);
  EXPECT_FALSE(session::agree_to_forces(**prepared, false, terminal, stop));
  stop.store(false);
  looks = 0;
  EXPECT_TRUE(session::agree_to_forces(**prepared, true, terminal, stop)) << "--yes";
  terminal.there = false;
  EXPECT_FALSE(session::agree_to_forces(**prepared, false, terminal, stop));
  EXPECT_NE(reported.back().find("--yes"), std::string::npos);
  EXPECT_EQ(looks, 0) << "no question is printed";
  EXPECT_EQ(opened_, 0);
}

TEST_F(SessionStart, EnablesForcesOnlyAtTheHomePose) {
  const session::Terminal nobody{.there = false,
                                 .key = [] { return session::EnterKey::kClosed; },
                                 .print_line = [](const auto&) {}};
  const std::atomic<bool> stop{false};
  counts_ = {2000, 0, 0, 0, 0, 0};
  auto away = session::Session::prepare(scene(), options_);
  ASSERT_TRUE(away) << away.error().message;
  const auto refused = session::open_arm(**away, nobody, stop);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("away from its home pose"), std::string::npos);
  EXPECT_EQ((*away)->device().stage(), driver::DeviceStage::kIdle);
  away->reset();
  counts_ = {};
  auto home = session::Session::prepare(scene(), options_);
  ASSERT_TRUE(home) << home.error().message;
  const auto opened = session::open_arm(**home, nobody, stop);
  ASSERT_TRUE(opened) << opened.error().message;
  EXPECT_TRUE(*opened);
  EXPECT_EQ((*home)->device().stage(), driver::DeviceStage::kActive);
  EXPECT_EQ(forced_, 0);
}

TEST(ServoThread, KnowsItsPriorityBeforeItRuns) {
  {
    const session::ServoThread unused(true);
    EXPECT_EQ(unused.grant().fifo && unused.grant().memory_locked && unused.grant().cpu_awake,
              unused.grant().advice.empty());
    EXPECT_FALSE(unused.ended());
  }
  session::SessionOptions options;
  options.duration = 0.5;
  auto session = session::Session::open(
      std::filesystem::path(THIMBLE_SOURCE_DIR) / "tests/data/scenes/two_boxes.yaml", options);
  ASSERT_TRUE(session) << session.error().message;
  const std::atomic<bool> stop{false};
  session::ServoThread servo(false);
  servo.begin(**session, stop);
  EXPECT_EQ(servo.join(), driver::ServoEnd::kDone);
  EXPECT_TRUE(servo.ended());
  EXPECT_EQ((*session)->ticks().size(), 500u);
}

TEST(CheckRealTime, RealArmNeedsPriorityOrConsent) {
  driver::RealTimeGrant grant;
  grant.advice = "Add your user to a group.";
  const auto refused = session::check_real_time(grant, false);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("--no-real-time"), std::string::npos);
  EXPECT_NE(refused.error().message.find("Add your user"), std::string::npos);
  EXPECT_TRUE(session::check_real_time(grant, true));
  grant.fifo = true;
  EXPECT_TRUE(session::check_real_time(grant, false));
}

}  // namespace
}  // namespace thimble::session
