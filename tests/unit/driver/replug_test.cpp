#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "arms/hfab/hfab_report.h"
#include "support/boards/scripted_transport.h"
#include "support/vintage_arm.h"
#include "thimble/driver/servo_loop.h"
#include "thimble/driver/wire_link.h"

namespace thimble::driver {
namespace {

std::vector<std::byte> sensor_report() {
  const auto bytes = hfab::encode_input({});
  return {bytes.begin(), bytes.end()};
}

/// An arm that answers each message, so that reports are always available while it is plugged in.
class AnsweringTransport final : public Transport {
 public:
  explicit AnsweringTransport(support::Wire& wire) : wire_(wire), inner_(wire) {}
  TransportRead read_latest(std::span<std::byte> buffer, std::int64_t until) noexcept override {
    wire_.to_host.push_back(sensor_report());
    return inner_.read_latest(buffer, until);
  }
  TransportStatus write(std::span<const std::byte> bytes) noexcept override {
    if (refuses && !wire_.lost) return TransportStatus::kRefused;
    return inner_.write(bytes);
  }
  bool refuses = false;

 private:
  support::Wire& wire_;
  support::ScriptedTransport inner_;
};

/// A loop in contact with a wall that always pushes; `at_tick` changes the wire.
class ReplugTest : public ::testing::Test {
 protected:
  void SetUp() override {
    auto transport = std::make_unique<AnsweringTransport>(wire_);
    transport_ = transport.get();
    auto opened = Device::open(
        std::make_unique<WireLink>(std::move(transport),
                                   std::make_unique<hfab::HfabArm>(support::vintage_model())),
        support::vintage_settings(), 0);
    ASSERT_TRUE(opened) << opened.error().message;
    device_ = std::move(opened).value();
    ASSERT_TRUE(device_->activate());
  }

  struct Sink {
    ReplugTest& test;
    void operator()(const TickRecord& record) noexcept {
      test.records_.push_back(record);
      if (test.at_tick_) test.at_tick_(record);
    }
  };
  struct Push {
    ForceCommand operator()(const DeviceState&) noexcept {
      return {.f_T_W = {0, 0.5, 0}, .touch = {}};
    }
  };

  ServoEnd run(std::uint64_t ticks) {
    Push push;
    Sink sink{*this};
    const std::atomic<bool> stop{false};
    return run_servo(*device_, clock_, ForceLaw(push), TickSink(sink),
                     {.ticks = ticks, .continue_after_faults = true}, stop);
  }

  void offer(support::Wire& wire) {
    EXPECT_TRUE(device_->offer(
        std::make_unique<WireLink>(std::make_unique<AnsweringTransport>(wire),
                                   std::make_unique<hfab::HfabArm>(support::vintage_model()))));
  }

  static double force(const TickRecord& record) {
    return Eigen::Map<const Eigen::Vector3d>(record.f_sent_W.data()).norm();
  }
  static bool is_zero(const std::vector<std::byte>& message) {
    return hfab::decode_output(message)->current_mA == std::array<std::int16_t, 3>{};
  }

  support::Wire wire_, second_wire_;
  AnsweringTransport* transport_ = nullptr;
  VirtualClock clock_;
  std::unique_ptr<Device> device_;
  std::vector<TickRecord> records_;
  std::function<void(const TickRecord&)> at_tick_;
};

TEST_F(ReplugTest, UnplugInContactLatchesZeroForce) {
  at_tick_ = [&](const TickRecord&) { wire_.lost = records_.size() >= 500; };
  EXPECT_EQ(run(1000), ServoEnd::kDone);
  ASSERT_EQ(records_.size(), 1000u);
  EXPECT_NEAR(force(records_[499]), 0.5, 1e-9);
  for (std::size_t i = 500; i < 1000; ++i) {
    EXPECT_EQ(force(records_[i]), 0) << i;
    EXPECT_EQ(records_[i].fault, Fault::kTransportLost);
    EXPECT_EQ(records_[i].stage, DeviceStage::kFault);
  }
}

TEST_F(ReplugTest, ReplugKeepsForceOffUntilActivated) {
  at_tick_ = [&](const TickRecord&) {
    const std::size_t tick = records_.size();
    if (tick == 500) wire_.lost = true;
    if (tick == 550) device_->ask_to_activate();  // too early: the arm is not plugged in
    if (tick == 600) offer(second_wire_);
    if (tick == 700)
      device_->ask_to_activate();  // its counters restarted: the home pose is required
    if (tick == 800) device_->ask_to_activate(HomeCheck::kPassed);
  };
  EXPECT_EQ(run(1500), ServoEnd::kDone);
  ASSERT_EQ(records_.size(), 1500u);
  EXPECT_FALSE(records_[599].fresh);
  EXPECT_TRUE(records_[601].fresh);  // positions are available again at once
  EXPECT_EQ(device_->wire_counters().replugged, 1u);
  for (std::size_t i = 500; i < 800; ++i) {
    EXPECT_EQ(force(records_[i]), 0) << i;
    EXPECT_EQ(records_[i].fault, Fault::kTransportLost) << i;
    EXPECT_EQ(records_[i].link, i < 600 ? LinkState::kLost : LinkState::kConnected) << i;
    EXPECT_EQ(records_[i].home_needed, i >= 600) << i;
  }
  EXPECT_FALSE(records_[801].home_needed);
  EXPECT_EQ(records_[801].stage, DeviceStage::kActive);
  EXPECT_LT(force(records_[802]), 0.05);  // soft start
  EXPECT_NEAR(force(records_[1499]), 0.5, 1e-9);
  // All messages on the new wire before the user's activation, and after the end, are zero.
  ASSERT_GT(second_wire_.to_arm.size(), 800u);
  for (std::size_t i = 0; i < 200; ++i) EXPECT_TRUE(is_zero(second_wire_.to_arm[i])) << i;
  EXPECT_TRUE(is_zero(second_wire_.to_arm.back()));
}

TEST_F(ReplugTest, LossAfterAnotherFaultIsSeenAndReplugged) {
  for (const Fault before : {Fault::kOverSpeed, Fault::kOtherArm, Fault::kNoReports}) {
    device_.reset();
    wire_ = second_wire_ = {};
    records_.clear();
    at_tick_ = nullptr;
    SetUp();
    at_tick_ = [&](const TickRecord&) {
      const std::size_t tick = records_.size();
      if (tick == 100) device_->trip(before);
      if (tick == 200) wire_.lost = true;
      if (tick == 300) offer(second_wire_);
      if (tick == 400) device_->ask_to_activate(HomeCheck::kPassed);
    };
    EXPECT_EQ(run(800), ServoEnd::kDone);
    EXPECT_EQ(records_[150].link, LinkState::kConnected);
    EXPECT_EQ(records_[250].link, LinkState::kLost);
    EXPECT_EQ(records_[250].fault, before) << "the first fault is kept";
    EXPECT_EQ(records_[350].link, LinkState::kConnected);
    EXPECT_EQ(records_[350].fault, before);
    EXPECT_EQ(force(records_[350]), 0);
    EXPECT_EQ(records_[799].fault, Fault::kNone);
    EXPECT_NEAR(force(records_[799]), 0.5, 1e-9);
  }
}

TEST_F(ReplugTest, LostLinkIsClosedBeforeItsSuccessorIsOpened) {
  // A transport that records when it is closed.
  struct Closing final : Transport {
    explicit Closing(bool& open) : open_(open) { open_ = true; }
    ~Closing() override { open_ = false; }
    TransportRead read_latest(std::span<std::byte> buffer, std::int64_t) noexcept override {
      if (lost) return {.status = TransportStatus::kLost};
      const auto report = sensor_report();
      std::copy(report.begin(), report.end(), buffer.begin());
      return {.status = TransportStatus::kOk, .size = report.size(), .skipped = 0};
    }
    TransportStatus write(std::span<const std::byte>) noexcept override {
      return lost ? TransportStatus::kLost : TransportStatus::kOk;
    }
    bool lost = false;

   private:
    bool& open_;
  };
  bool first_open = false, untaken_open = false, last_open = false;
  const auto link = [](bool& open, Closing*& closing) {
    auto transport = std::make_unique<Closing>(open);
    closing = transport.get();
    return std::make_unique<WireLink>(std::move(transport),
                                      std::make_unique<hfab::HfabArm>(support::vintage_model()));
  };
  Closing *first = nullptr, *untaken = nullptr, *last = nullptr;
  auto opened = Device::open(link(first_open, first), support::vintage_settings(), 0);
  ASSERT_TRUE(opened);
  Device& device = **opened;
  device.read(1'000'000, 0);
  first->lost = true;
  device.read(2'000'000, 0);
  ASSERT_TRUE(device.lost());
  EXPECT_TRUE(first_open) << "the servo thread closes nothing";
  device.close_lost_link();
  EXPECT_FALSE(first_open);
  ASSERT_TRUE(device.offer(link(untaken_open, untaken)));
  device.close_lost_link();
  EXPECT_FALSE(untaken_open) << "an offer that was not accepted would also keep the arm open";
  ASSERT_TRUE(device.offer(link(last_open, last)));
  device.read(3'000'000, 0);
  EXPECT_EQ(device.link_state(), LinkState::kConnected);
  EXPECT_TRUE(last_open);
}

TEST_F(ReplugTest, SurvivesManyPullsWithoutLosingAWire) {
  std::vector<support::Wire> wires(20);
  std::size_t next = 0;
  at_tick_ = [&](const TickRecord&) {
    if (records_.size() % 50 == 10) {
      wire_.lost = true;
      for (auto& wire : wires) wire.lost = true;
    }
    if (records_.size() % 50 == 20 && next < wires.size()) {
      wires[next].lost = false;
      offer(wires[next]);
      ++next;
    }
    if (records_.size() % 50 == 30) device_->ask_to_activate();
  };
  EXPECT_EQ(run(1010), ServoEnd::kDone);
  EXPECT_EQ(device_->wire_counters().replugged, 20u);
}

TEST_F(ReplugTest, NamesAnArmThatTakesNoMessages) {
  at_tick_ = [&](const TickRecord&) { transport_->refuses = records_.size() >= 500; };
  EXPECT_EQ(run(600), ServoEnd::kDone);
  EXPECT_EQ(records_[510].fault, Fault::kNone);  // a short refusal is no fault
  EXPECT_EQ(records_[530].fault, Fault::kRefused);
  // The last force that the arm accepted acts until its own watchdog switches it off.
  EXPECT_EQ(force(records_[530]), force(records_[499]));
  EXPECT_GT(force(records_[530]), 0);
  EXPECT_FALSE(device_->zero_assured());
  EXPECT_GE(device_->wire_counters().refused, 100u);
}

}  // namespace
}  // namespace thimble::driver
