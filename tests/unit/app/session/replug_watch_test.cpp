#include "replug_watch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "arms/hfab/hfab_report.h"
#include "support/vintage_arm.h"
#include "thimble/driver/servo_loop.h"
#include "thimble/driver/wire_link.h"

namespace thimble::session {
namespace {

using driver::Fault;

/// Loop of an arm with a constant force, with a watch that checks ten times per second of the
/// loop's time.
class ReplugWatchTest : public ::testing::Test {
 protected:
  /// State of one link.
  struct Wire {
    std::array<std::int16_t, 6> counts{};
    bool lost = false;
    bool silent = false;
    bool open = false;
    int carried_to = -1;  // the hand moves the first counter there; below 0: no motion

    void carry() {
      constexpr int kStep = 30;  // counts per tick: 0.7 m/s
      if (carried_to < 0) return;
      counts[0] = static_cast<std::int16_t>(counts[0] +
                                            std::clamp(carried_to - int{counts[0]}, -kStep, kStep));
    }
  };

  class OnWire final : public driver::Transport {
   public:
    explicit OnWire(Wire& wire) : wire_(wire) { wire_.open = true; }
    ~OnWire() override { wire_.open = false; }
    driver::TransportRead read_latest(std::span<std::byte> buffer, std::int64_t) noexcept override {
      if (wire_.lost) return {.status = driver::TransportStatus::kLost};
      if (wire_.silent) return {};
      wire_.carry();
      const auto bytes = driver::hfab::encode_input({.counts = wire_.counts});
      std::copy(bytes.begin(), bytes.end(), buffer.begin());
      return {.status = driver::TransportStatus::kOk, .size = bytes.size(), .skipped = 0};
    }
    driver::TransportStatus write(std::span<const std::byte>) noexcept override {
      return wire_.lost ? driver::TransportStatus::kLost : driver::TransportStatus::kOk;
    }

   private:
    Wire& wire_;
  };

  void SetUp() override {
    auto opened =
        driver::Device::open(std::make_unique<driver::WireLink>(
                                 std::make_unique<OnWire>(first_),
                                 std::make_unique<driver::hfab::HfabArm>(support::vintage_model())),
                             support::vintage_settings(), 0);
    ASSERT_TRUE(opened) << opened.error().message;
    device_ = std::move(opened).value();
    ASSERT_TRUE(device_->activate());
    make_watch(Eigen::Vector3d(0, 0, 0));
  }

  void make_watch(const std::optional<Eigen::Vector3d>& p_WHome) {
    watch_.emplace(
        *device_, snapshot_,
        session::StartPose({.min_W = {-0.1, -0.1, -0.1}, .max_W = {0.1, 0.1, 0.1}}, p_WHome),
        driver::FoundArm{},
        session::ReplugWatch::Access{
            .find = [this](const driver::FoundArm& arm) -> std::optional<driver::FoundArm> {
              return plugged_ ? std::optional(arm) : std::nullopt;
            },
            .open = [this](const driver::FoundArm&)
                -> driver::Result<std::unique_ptr<driver::ArmLink>> {
              ++opened_;
              first_was_open_ = first_.open;
              second_.lost = false;
              return std::unique_ptr<driver::ArmLink>(std::make_unique<driver::WireLink>(
                  std::make_unique<OnWire>(second_),
                  std::make_unique<driver::hfab::HfabArm>(support::vintage_model())));
            }},
        session::Terminal{
            .there = true,
            .key =
                [this] {
                  const bool pressed = enter_;
                  enter_ = false;
                  return pressed ? session::EnterKey::kPressed : session::EnterKey::kNothing;
                },
            .print_line = [this](const std::string& line) { told_.push_back(line); }});
  }

  /// Runs 100 ticks of a millisecond, then one check of the watch; `times` times.
  void pass(int times) {
    struct Push {
      driver::ForceCommand operator()(const driver::DeviceState&) noexcept {
        return {.f_T_W = {0, 0.5, 0}, .touch = {}};
      }
    } push;
    struct Show {
      ReplugWatchTest& test;
      void operator()(const driver::TickRecord& record) noexcept {
        test.snapshot_.store(record);
        test.last_ = record;
      }
    } show{*this};
    const std::atomic<bool> stop{false};
    for (int i = 0; i < times; ++i) {
      driver::ServoLoop loop(*device_, clock_, driver::ForceLaw(push), driver::TickSink(show),
                             {.continue_after_faults = true});
      for (int tick = 0; tick < 100; ++tick) loop.tick(stop);
      watch_->step();
    }
  }

  double force() const { return Eigen::Map<const Eigen::Vector3d>(last_.f_sent_W.data()).norm(); }
  bool reported(const std::string& words) const {
    for (const std::string& line : told_) {
      if (line.find(words) != std::string::npos) return true;
    }
    return false;
  }

  Wire first_, second_;
  bool plugged_ = false, enter_ = false, first_was_open_ = false;
  int opened_ = 0;
  driver::VirtualClock clock_;
  std::unique_ptr<driver::Device> device_;
  driver::Snapshot<driver::TickRecord> snapshot_;
  driver::TickRecord last_;
  std::optional<session::ReplugWatch> watch_;
  std::vector<std::string> told_;
};

TEST_F(ReplugWatchTest, EnablesForcesOnlyAtTheHomePose) {
  pass(5);
  EXPECT_GT(force(), 0.4);
  first_.lost = true;
  pass(2);
  EXPECT_TRUE(reported("Force is off (transport_lost)"));
  EXPECT_EQ(force(), 0);
  second_.counts = {1500, 0, 0, 0, 0, 0};  // connected away from its home pose, then moved there
  plugged_ = true;
  pass(12);
  EXPECT_EQ(opened_, 1);
  EXPECT_TRUE(reported("Move it to its home pose and press Enter"));
  EXPECT_FALSE(reported("as before"));
  enter_ = true;
  pass(3);
  EXPECT_TRUE(reported("mm away from its home pose"));
  EXPECT_EQ(force(), 0) << "its counters say that it is not at home";
  EXPECT_EQ(last_.fault, Fault::kTransportLost);
  second_.counts = {50, 0, 0, 0, 0, 0};
  pass(3);
  EXPECT_EQ(force(), 0) << "Enter was not pressed";
  enter_ = true;
  pass(6);
  EXPECT_GT(force(), 0.4);
  EXPECT_EQ(last_.fault, Fault::kNone);
}

TEST_F(ReplugWatchTest, SelfHomingArmNeedsOnlyTheWorkspace) {
  make_watch(std::nullopt);
  pass(5);
  first_.lost = true;
  plugged_ = true;
  second_.counts = {1500, 0, 0, 0, 0, 0};
  pass(12);
  EXPECT_TRUE(reported("has found its zero"));
  enter_ = true;
  pass(6);
  EXPECT_GT(force(), 0.4);
}

TEST_F(ReplugWatchTest, ChecksTheWorkspaceAfterAnyFault) {
  pass(5);
  device_->trip(Fault::kOverSpeed);
  first_.carried_to = 12000;  // far to the side
  pass(6);
  enter_ = true;
  pass(3);
  EXPECT_TRUE(reported("outside of the workspace"));
  EXPECT_EQ(force(), 0);
  first_.carried_to = 1500;  // inside, and not at home: its counters did not restart
  pass(6);
  enter_ = true;
  pass(6);
  EXPECT_GT(force(), 0.4);
}

TEST_F(ReplugWatchTest, FindsAnArmDisconnectedAfterAnotherFault) {
  pass(5);
  device_->trip(Fault::kOverSpeed);
  pass(2);
  EXPECT_TRUE(reported("Force is off (over_speed)"));
  first_.lost = true;
  pass(2);
  EXPECT_TRUE(reported("The arm was disconnected."));
  enter_ = true;
  pass(1);
  EXPECT_EQ(force(), 0);
  plugged_ = true;
  pass(12);
  EXPECT_EQ(opened_, 1);
  EXPECT_EQ(last_.fault, Fault::kOverSpeed);
  EXPECT_EQ(last_.link, driver::LinkState::kConnected);
  EXPECT_TRUE(reported("Move it to its home pose and press Enter"));
  EXPECT_EQ(force(), 0) << "Enter was not pressed";
  enter_ = true;
  pass(6);
  EXPECT_GT(force(), 0.4);
}

TEST_F(ReplugWatchTest, FindsAnArmWhoseLossTheKernelReportsLate) {
  pass(5);
  first_.silent = true;
  pass(1);
  EXPECT_TRUE(reported("Force is off (no_reports)"));
  enter_ = true;
  pass(1);
  EXPECT_TRUE(reported("The arm is silent"));
  first_.lost = true;
  plugged_ = true;
  pass(12);
  EXPECT_EQ(opened_, 1);
  EXPECT_EQ(last_.fault, Fault::kNoReports);
  enter_ = true;
  pass(6);
  EXPECT_GT(force(), 0.4);
}

TEST_F(ReplugWatchTest, BoardRestartRequiresTheHomePose) {
  first_.counts = {1500, 800, 0, 0, 0, 0};
  pass(5);
  EXPECT_GT(force(), 0.4);
  first_.silent = true;
  pass(5);
  first_.counts = {0, 0, 0, 0, 0, 0};  // in its pose, 42 mm away from its home pose
  first_.silent = false;
  pass(1);
  EXPECT_TRUE(reported("Move it to its home pose and press Enter"));
  first_.counts = {1500, 800, 0, 0, 0, 0};  // the user moves it
  pass(2);
  enter_ = true;
  pass(6);
  EXPECT_TRUE(reported("mm away from its home pose"));
  EXPECT_EQ(force(), 0) << "its tip and its Jacobian are wrong";
  first_.counts = {};  // moved to its home pose and switched on there
  pass(2);
  enter_ = true;
  pass(6);
  EXPECT_GT(force(), 0.4);
}

TEST_F(ReplugWatchTest, FindsAnArmDisconnectedTwice) {
  pass(5);
  first_.lost = true;
  plugged_ = true;
  pass(12);
  EXPECT_EQ(opened_, 1);
  second_.lost = true;
  plugged_ = false;
  pass(15);
  EXPECT_TRUE(reported("disconnected again"));
  enter_ = true;
  pass(3);
  EXPECT_EQ(force(), 0);
  plugged_ = true;
  pass(20);
  EXPECT_EQ(opened_, 2);
  enter_ = true;
  pass(6);
  EXPECT_GT(force(), 0.4);
}

TEST_F(ReplugWatchTest, ClosesTheLostLinkBeforeItOpensTheNext) {
  pass(5);
  ASSERT_TRUE(first_.open);
  first_.lost = true;
  plugged_ = true;
  pass(12);
  ASSERT_EQ(opened_, 1);
  EXPECT_FALSE(first_was_open_);
  EXPECT_TRUE(second_.open);
}

TEST_F(ReplugWatchTest, SaysHowForcesAreEnabledAfterAFault) {
  pass(5);
  device_->trip(Fault::kOverSpeed);
  pass(2);
  EXPECT_TRUE(reported("Press Enter to enable forces again."));
}

}  // namespace
}  // namespace thimble::session
