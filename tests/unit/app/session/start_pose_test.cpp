#include "start_pose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <limits>

#include "arm/calibration.h"
#include "arm_table.h"
#include "arms/hfab/hfab_report.h"
#include "support/boards/described_port.h"
#include "support/boards/scripted_transport.h"
#include "support/scratch.h"
#include "support/vintage_arm.h"
#include "thimble/driver/wire_link.h"
#include "thimble/scene/real_arm.h"

namespace thimble::session {
namespace {

using driver::ArmKind;

scene::ArmFile file_of(const std::string& name) {
  auto file =
      scene::load_arm(std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/arms" / (name + ".yaml"));
  EXPECT_TRUE(file) << file.error().message;
  return file ? std::move(file).value() : scene::ArmFile{};
}

bool has(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

TEST(StartPose, OfEveryShippedArmIsAtItsHomePose) {
  struct Case {
    const char* name;
    ArmKind kind;
  };
  for (const Case& arm :
       {Case{"vintage_phantom", ArmKind::kPolhem}, Case{"vintage_phantom", ArmKind::kHfabLine},
        Case{"woodenhaptics", ArmKind::kWoody}, Case{"woodenhaptics", ArmKind::kHfabLine},
        Case{"polhem", ArmKind::kPolhem}, Case{"polhem", ArmKind::kHfabLine}}) {
    const scene::ArmFile file = file_of(arm.name);
    const session::StartPose place = session::StartPose::of(file, arm.kind);
    EXPECT_TRUE(place.has_home()) << arm.name;
    const Eigen::Vector3d p_WHome =
        file.p_WB + file.R_WB * driver::make_arm(arm.kind, file.model)->pose({}).p_BT;
    EXPECT_EQ(place.problem(p_WHome, true), "") << arm.name;
    EXPECT_EQ(place.problem(p_WHome, false), "") << arm.name << " is parked outside of its box";
    EXPECT_NE(place.problem(p_WHome + Eigen::Vector3d(0, 0.021, 0), true), "") << arm.name;
    const Eigen::Vector3d p_WMiddle = 0.5 * (file.workspace.min_W + file.workspace.max_W);
    EXPECT_EQ(place.problem(p_WMiddle, false), "") << arm.name;
  }
  EXPECT_FALSE(session::StartPose::of(file_of("falcon"), ArmKind::kFalcon).has_home());
}

TEST(StartPose, DescribedArmHasAHomeUnlessItIsAbsolute) {
  const auto path = support::scratch_folder() / "start_pose_described.yaml";
  const std::string wire = support::text_of_file(std::filesystem::path(THIMBLE_SOURCE_DIR) /
                                                 "app/arms/wires/hfab_14_byte.yaml");
  std::ofstream(path) << support::phantom_with_wire("\nprotocol: described\n" + wire);
  auto file = scene::load_arm(path);
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_TRUE(session::StartPose::of(*file, ArmKind::kDescribed).has_home());
  file->home.how = scene::HomeMethod::kAbsolute;
  EXPECT_FALSE(session::StartPose::of(*file, ArmKind::kDescribed).has_home());
}

TEST(StartPose, OfADescribedBoardIsAtItsHomePose) {
  const scene::ArmFile file = file_of("reference_five_bar");
  const session::StartPose place = session::StartPose::of(file, ArmKind::kDescribed);
  ASSERT_TRUE(place.has_home());
  const Eigen::Vector3d p_WHome =
      file.p_WB +
      file.R_WB * driver::make_arm(ArmKind::kDescribed, file.model, file.wire.get())->pose({}).p_BT;
  EXPECT_EQ(place.problem(p_WHome, true), "");
  EXPECT_NE(place.problem(p_WHome + Eigen::Vector3d(0, 0.021, 0), true), "");
}

TEST(StartPose, ReportsDistancesFromHomeAndWorkspace) {
  const session::StartPose place({.min_W = {-0.1, -0.1, -0.1}, .max_W = {0.1, 0.1, 0.1}},
                                 Eigen::Vector3d(0.05, 0, 0));
  EXPECT_EQ(place.problem({0.05, 0.0199, 0}, true), "");
  const std::string far_off = place.problem({0.05, 0.03, 0.04}, true);
  EXPECT_TRUE(has(far_off, "50 mm away from its home pose")) << far_off;
  EXPECT_TRUE(has(far_off, "counters are wrong")) << far_off;
  EXPECT_EQ(place.problem({0.05, 0.03, 0.04}, false), "");
  EXPECT_EQ(place.problem({-0.119, 0, 0}, false), "");
  const std::string outside = place.problem({-0.13, 0, 0.14}, false);
  EXPECT_TRUE(has(outside, "50 mm outside of the workspace")) << outside;

  const session::StartPose homeless({.min_W = {-0.1, -0.1, -0.1}, .max_W = {0.1, 0.1, 0.1}},
                                    std::nullopt);
  EXPECT_EQ(homeless.problem({0.09, 0.09, 0.09}, true), "");
  EXPECT_NE(homeless.problem({0.2, 0, 0}, true), "");
}

TEST(StartPose, RejectsPositionsThatAreNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const session::StartPose place({.min_W = {-1, -1, -1}, .max_W = {1, 1, 1}},
                                 Eigen::Vector3d(0, 0, 0));
  for (const Eigen::Vector3d& p_WT :
       {Eigen::Vector3d(nan, 0, 0), Eigen::Vector3d(0, nan, 0), Eigen::Vector3d(0, 0, HUGE_VAL)}) {
    EXPECT_NE(place.problem(p_WT, true), "");
    EXPECT_NE(place.problem(p_WT, false), "");
  }
}

/// Arm and user that follow the script of the test.
class WaitForStartPose : public ::testing::Test {
 protected:
  /// Link of an arm that reports in every tick.
  class Answering final : public driver::Transport {
   public:
    explicit Answering(WaitForStartPose& test) : test_(test) {}
    driver::TransportRead read_latest(std::span<std::byte> buffer, std::int64_t) noexcept override {
      if (test_.lost_) return {.status = driver::TransportStatus::kLost};
      if (test_.silent_) return {};
      const auto bytes = driver::hfab::encode_input({.counts = test_.counts_});
      std::copy(bytes.begin(), bytes.end(), buffer.begin());
      return {.status = driver::TransportStatus::kOk, .size = bytes.size(), .skipped = 0};
    }
    driver::TransportStatus write(std::span<const std::byte> report) noexcept override {
      const auto message = driver::hfab::decode_output(report);
      test_.zeros_ += message && message->current_mA == std::array<std::int16_t, 3>{};
      ++test_.messages_;
      return driver::TransportStatus::kOk;
    }

   private:
    WaitForStartPose& test_;
  };

  void open() {
    auto opened =
        driver::Device::open(std::make_unique<driver::WireLink>(
                                 std::make_unique<Answering>(*this),
                                 std::make_unique<driver::hfab::HfabArm>(support::vintage_model())),
                             support::vintage_settings(), 0);
    ASSERT_TRUE(opened) << opened.error().message;
    device_ = std::move(opened).value();
  }

  driver::Result<bool> wait(bool at_home = true) {
    return session::wait_for_start_pose(*device_, clock_, place_, at_home, terminal_, stop_);
  }

  std::array<std::int16_t, 6> counts_{};
  bool lost_ = false, silent_ = false;
  int zeros_ = 0, messages_ = 0;
  driver::VirtualClock clock_;
  std::unique_ptr<driver::Device> device_;
  session::StartPose place_{{.min_W = {-0.1, -0.1, -0.1}, .max_W = {0.1, 0.1, 0.1}},
                            Eigen::Vector3d(0, 0, 0)};
  std::atomic<bool> stop_{false};
  std::vector<std::string> told_;
  int looks_ = 0;
  std::function<session::EnterKey(int look)> user_ = [](int) {
    return session::EnterKey::kNothing;
  };
  session::Terminal terminal_{
      .there = true,
      .key = [this] { return user_(++looks_); },
      .print_line = [this](const std::string& line) { told_.push_back(line); }};
};

TEST_F(WaitForStartPose, ReturnsAtOnceIfTheTipIsThere) {
  open();
  const int before = messages_;
  EXPECT_TRUE(*wait());
  EXPECT_EQ(messages_, before);
  EXPECT_TRUE(told_.empty());
}

TEST_F(WaitForStartPose, SendsZeroForceWhileWaiting) {
  counts_ = {2000, 0, 0, 0, 0, 0};  // a yaw of 0.35 rad
  open();
  user_ = [this](int look) {
    if (look == 60) counts_ = {100, 0, 0, 0, 0, 0};
    return look == 50 || look == 70 ? session::EnterKey::kPressed : session::EnterKey::kNothing;
  };
  EXPECT_TRUE(*wait());
  EXPECT_EQ(looks_, 70);
  ASSERT_EQ(told_.size(), 2u);  // at the start, and after the Enter that came too early
  EXPECT_TRUE(has(told_[0], "mm away from its home pose")) << told_[0];
  EXPECT_EQ(zeros_, messages_);
  EXPECT_EQ(messages_,
            1 + 70 * 20);  // one per millisecond, so that no watchdog expires and no pause occurs
  EXPECT_EQ(device_->stage(), driver::DeviceStage::kIdle);
  // The run that follows starts with its first tick.
  ASSERT_TRUE(device_->activate());
  EXPECT_EQ(device_->read(clock_.now_ns(), clock_.now_ns()).tick, 0u);
}

TEST_F(WaitForStartPose, RestartMeanwhileNeedsHomePoseEvenIfHomed) {
  counts_ = {12000, 0, 0, 0, 0, 0};  // outside of the workspace
  open();
  user_ = [this](int look) {
    silent_ = look >= 10 && look < 13;  // 60 ms
    if (look == 12)
      counts_ = {2000, 0, 0, 0, 0, 0};  // its counters are wrong; the reported tip is inside
    if (look == 40) counts_ = {50, 0, 0, 0, 0, 0};  // at home
    return look == 30 || look == 50 ? session::EnterKey::kPressed : session::EnterKey::kNothing;
  };
  EXPECT_TRUE(*wait(false));
  EXPECT_EQ(looks_, 50);
  ASSERT_EQ(told_.size(), 2u);
  EXPECT_TRUE(has(told_[1], "mm away from its home pose")) << told_[1];
  EXPECT_FALSE(device_->home_needed());
  EXPECT_TRUE(device_->activate());
}

TEST_F(WaitForStartPose, FailsWithoutATerminal) {
  counts_ = {2000, 0, 0, 0, 0, 0};
  open();
  terminal_.there = false;
  auto waited = wait();
  ASSERT_FALSE(waited);
  EXPECT_TRUE(has(waited.error().message, "home pose"));
  EXPECT_TRUE(*wait(false)) << "inside of the workspace";
  terminal_.there = true;
  user_ = [](int) { return session::EnterKey::kClosed; };
  EXPECT_FALSE(wait());
}

TEST_F(WaitForStartPose, EndsOnStopAndWhenTheArmIsLost) {
  counts_ = {2000, 0, 0, 0, 0, 0};
  open();
  user_ = [this](int look) {
    stop_ = look == 5;
    return session::EnterKey::kNothing;
  };
  const auto stopped = wait();
  ASSERT_TRUE(stopped);
  EXPECT_FALSE(*stopped);
  stop_ = false;
  user_ = [this](int look) {
    lost_ = look == 10;
    return session::EnterKey::kNothing;
  };
  const auto lost = wait();
  ASSERT_FALSE(lost);
  EXPECT_TRUE(has(lost.error().message, "disconnected"));
}

}  // namespace
}  // namespace thimble::session
