#include "run_attendance.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "run_records.h"
#include "setup.h"
#include "support/scratch.h"
#include "thimble/session/session.h"

namespace thimble {
namespace {

namespace fs = std::filesystem;

/// Session with two arms whose black boxes are filled by the test.
class BlackBoxesTest : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::current_path(THIMBLE_SOURCE_DIR);
    const fs::path state = support::scratch_folder() / "black_boxes";
    fs::remove_all(state);
    setenv("XDG_STATE_HOME", state.c_str(), 1);
    faults_ = state / "thimble" / "faults";
    auto opened = session::Session::open("two_hands", {.several_arms = true});
    ASSERT_TRUE(opened) << opened.error().message;
    session_ = std::move(opened).value();
    ASSERT_EQ(session_->arms(), 2U);
    attendance_ = std::make_unique<session::RunAttendance>(*session_, nullptr, nullptr, false);
  }
  void TearDown() override { unsetenv("XDG_STATE_HOME"); }

  session::BlackBox& box(std::size_t arm) { return session_->records(arm).kept->black_box; }
  /// Fills the black box of an arm as its servo does, with `after` ticks from a fault on.
  void fail(std::size_t arm, int after) {
    driver::TickRecord tick;
    tick.fault = driver::Fault::kOverSpeed;
    for (int i = 0; i < after; ++i) {
      tick.tick = static_cast<std::uint64_t>(i);
      box(arm).take(tick);
    }
  }
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    std::error_code status;
    for (const auto& entry : fs::directory_iterator(faults_, status)) {
      names.push_back(entry.path().filename().string());
    }
    return names;
  }

  std::unique_ptr<session::Session> session_;
  std::unique_ptr<session::RunAttendance> attendance_;
  fs::path faults_;
};

constexpr int kFull = 100'000;  // ticks: more than a black box stores after a fault

TEST_F(BlackBoxesTest, LaterArmIsSavedDuringRun) {
  fail(1, kFull);
  ASSERT_TRUE(box(1).full());
  attendance_->step();
  ASSERT_EQ(files().size(), 1U);
  EXPECT_NE(files().front().find(session_->arm_name(1)), std::string::npos) << files().front();
}

TEST_F(BlackBoxesTest, BoxThatIsBeingFilledIsLeftToServo) {
  fail(0, kFull);
  fail(1, 10);
  ASSERT_FALSE(box(1).full());
  attendance_->step();
  EXPECT_EQ(files().size(), 1U);
  EXPECT_EQ(box(1).release().size(), 10U) << "its ticks are still there";
}

TEST_F(BlackBoxesTest, AllAreSavedAfterRun) {
  fail(0, 10);
  fail(1, 10);
  session::keep_black_boxes(*session_, true);
  EXPECT_EQ(files().size(), 2U);
}

TEST_F(BlackBoxesTest, ProgressOfAWholeRunIsShownIfAsked) {
  const std::atomic<bool> stop{false};
  session_->run(stop);
  scene::choose_progress(scene::ProgressChoice::kAlways);
  for (const bool shows : {true, false}) {
    testing::internal::CaptureStderr();
    session::RunAttendance attendance(*session_, nullptr, nullptr, shows);
    attendance.step();
    attendance.clear();
    const std::string shown = testing::internal::GetCapturedStderr();
    EXPECT_EQ(shown.find("run: 100 %") != std::string::npos, shows) << shown;
  }
  scene::choose_progress(scene::ProgressChoice::kNever);
}

TEST_F(BlackBoxesTest, LinesOfEachArmBeginWithItsName) {
  std::string printed;
  session::Terminal all;
  all.print_line = [&printed](const std::string& line) { printed += line + '|'; };
  const session::Terminal right = session::terminal_of(session_->setup(), 1, all);
  right.print_line("Press Enter.");
  right.print_line("\nForce is off.");
  EXPECT_EQ(printed, "right: Press Enter.|\nright: Force is off.|");
  EXPECT_FALSE(right.ask) << "there is nothing to prefix";
}

}  // namespace
}  // namespace thimble
