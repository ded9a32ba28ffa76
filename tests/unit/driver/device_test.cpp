#include "thimble/driver/device.h"

#include <gtest/gtest.h>

#include <cmath>

#include "arms/hfab/hfab_models.h"
#include "arms/hfab/hfab_report.h"
#include "arms/woody/woody_report.h"
#include "arms/woody/woody_wire.h"
#include "support/boards/scripted_transport.h"
#include "support/vintage_arm.h"
#include "thimble/driver/wire_link.h"

namespace thimble::driver {
namespace {

constexpr std::int64_t kPeriod_ns = 1'000'000;

std::vector<std::byte> report(std::int16_t a = 0, std::int16_t b = 0, std::int16_t c = 0) {
  hfab::InputReport input;
  input.counts = {a, b, c, 0, 0, 0};
  const auto bytes = hfab::encode_input(input);
  return {bytes.begin(), bytes.end()};
}

/// A device in its home pose on a scripted wire, with its own clock.
class DeviceTest : public ::testing::Test {
 protected:
  Result<std::unique_ptr<Device>> open() {
    return Device::open(
        std::make_unique<WireLink>(std::make_unique<support::ScriptedTransport>(wire_),
                                   std::make_unique<hfab::HfabArm>(support::vintage_model())),
        support::vintage_settings(), now_ns_);
  }

  void open_and_activate() {
    wire_.to_host.push_back(report());
    auto opened = open();
    ASSERT_TRUE(opened) << opened.error().message;
    device_ = std::move(opened).value();
    ASSERT_TRUE(device_->activate());
  }

  /// Runs one tick with a new report; returns the current of the first motor, mA.
  void tick(const Eigen::Vector3d& f_T_W) {
    now_ns_ += kPeriod_ns;
    device_->read(now_ns_, now_ns_);
    device_->write({.f_T_W = f_T_W, .touch = {}});
  }

  /// Runs ticks past the soft start.
  void settle(const Eigen::Vector3d& f_T_W = {0, 0.5, 0}) {
    for (int k = 0; k < 400; ++k) {
      wire_.to_host.push_back(report());
      tick(f_T_W);
    }
    ASSERT_EQ(device_->fault(), Fault::kNone);
    ASSERT_NE(last_currents(), (std::array<std::int16_t, 3>{}));
  }

  std::array<std::int16_t, 3> last_currents() const {
    return hfab::decode_output(wire_.to_arm.back())->current_mA;
  }

  static constexpr std::array<std::int16_t, 3> kZero{};
  support::Wire wire_;
  std::int64_t now_ns_ = 0;
  std::unique_ptr<Device> device_;
};

TEST_F(DeviceTest, OpenErrorNamesTheReason) {
  EXPECT_NE(open().error().message.find("no report within 1000 ms"), std::string::npos);

  wire_.to_host.push_back({std::byte{1}, std::byte{2}});
  EXPECT_NE(open().error().message.find("unknown format"), std::string::npos);

  wire_.lost = true;
  EXPECT_NE(open().error().message.find("disconnected"), std::string::npos);
}

TEST_F(DeviceTest, RefusesLimitsThatAreNotPositiveNumbers) {
  DeviceSettings settings = support::vintage_settings();
  settings.limits.force_max = NAN;
  wire_.to_host.push_back(report());
  const auto opened = Device::open(
      std::make_unique<WireLink>(std::make_unique<support::ScriptedTransport>(wire_),
                                 std::make_unique<hfab::HfabArm>(support::vintage_model())),
      settings, 0);
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().message.find("force_max"), std::string::npos);
}

TEST_F(DeviceTest, RefusesASpeedFloorThatChangesDamping) {
  DeviceSettings settings = support::vintage_settings();
  settings.energy = {.stage = EnergyStage::kPassivity, .mass = 0.075, .reservoir = 0.02};
  for (const double floor : {-0.01, static_cast<double>(NAN), HUGE_VAL}) {
    settings.energy.speed_floor = floor;
    wire_.to_host.push_back(report());
    const auto opened = Device::open(
        std::make_unique<WireLink>(std::make_unique<support::ScriptedTransport>(wire_),
                                   std::make_unique<hfab::HfabArm>(support::vintage_model())),
        settings, 0);
    ASSERT_FALSE(opened) << floor;
    EXPECT_NE(opened.error().message.find("speed floor must be a finite number of zero or more"),
              std::string::npos);
  }
}

TEST_F(DeviceTest, SendsZeroWhenOpenedAndWhileIdle) {
  wire_.to_host.push_back(report());
  auto opened = open();
  ASSERT_TRUE(opened);
  device_ = std::move(opened).value();
  EXPECT_EQ(last_currents(), kZero);
  EXPECT_EQ(device_->stage(), DeviceStage::kIdle);
  tick({1, 1, 1});
  EXPECT_EQ(last_currents(), kZero);
}

TEST_F(DeviceTest, FindsTheTipInTheWorld) {
  open_and_activate();
  wire_.to_host.push_back(report());
  tick({0, 0, 0});
  EXPECT_LT(device_->state().p_WT.norm(), 1e-15);
  EXPECT_TRUE(device_->state().fresh);
  // One count of yaw at home: 0.138 m x 2 pi / 36000 to the left (sign -1).
  wire_.to_host.push_back(report(1));
  tick({0, 0, 0});
  EXPECT_NEAR(device_->state().p_WT.y(), -0.138 * 2 * M_PI / 36000, 1e-12);
  EXPECT_NEAR(device_->state().v_WT.y(), -0.138 * 2 * M_PI / 36000 / 1e-3, 1e-9);
  EXPECT_EQ(device_->state().tick, 1u);
  EXPECT_NEAR(device_->state().dt, 1e-3, 1e-15);
}

TEST_F(DeviceTest, SendsAndReportsTheGatedForce) {
  open_and_activate();
  settle({0, 0.5, 0});
  // 0.5 N at 0.138 m through 9:1 and 0.0234 N m/A, sign -1.
  EXPECT_EQ(last_currents()[0], std::lround(-0.5 * 0.138 / 9 / 0.0234 * 1e3));
  EXPECT_LT((device_->f_sent_W() - Eigen::Vector3d(0, 0.5, 0)).norm(), 1e-12);
}

TEST_F(DeviceTest, SilentArmIsAFault) {
  open_and_activate();
  settle();
  tick({0, 0.5, 0});
  EXPECT_FALSE(device_->state().fresh);
  EXPECT_EQ(device_->fault(), Fault::kNone);
  EXPECT_NE(last_currents(), kZero);
  int ticks = 1;
  while (device_->fault() == Fault::kNone && ticks < 100) {
    tick({0, 0.5, 0});
    ++ticks;
  }
  EXPECT_EQ(device_->fault(), Fault::kNoReports);
  EXPECT_EQ(ticks, 21);               // silence_limit_ns of 20 ms, then the next tick
  EXPECT_EQ(last_currents(), kZero);  // in that same tick
}

TEST_F(DeviceTest, CountsAndSurvivesUnknownReports) {
  open_and_activate();
  settle();
  wire_.to_host.push_back(std::vector<std::byte>(13));
  tick({0, 0.5, 0});
  EXPECT_EQ(device_->wire_counters().rejected, 1u);
  EXPECT_FALSE(device_->state().fresh);
  EXPECT_EQ(device_->fault(), Fault::kNone);
}

TEST_F(DeviceTest, TakesTheNewestReportAndCountsTheOthers) {
  open_and_activate();
  wire_.to_host = {report(1), report(2), report(3)};
  tick({0, 0, 0});
  EXPECT_EQ(device_->state().counts[0], 3);
  EXPECT_EQ(device_->wire_counters().skipped, 2u);
}

TEST_F(DeviceTest, TickNumbersNeverRepeatAfterActivation) {
  open_and_activate();
  for (std::uint64_t number = 0; number < 8; ++number) {
    if (number == 3) device_->trip(Fault::kOverSpeed);
    if (number == 5) device_->ask_to_activate();
    wire_.to_host.push_back(report());
    tick({0, 0, 0});
    EXPECT_EQ(device_->state().tick, number);
  }
}

TEST_F(DeviceTest, SendsZeroInTheTickOfAForceThatIsNotANumber) {
  open_and_activate();
  settle();
  wire_.to_host.push_back(report());
  tick({0, NAN, 0});
  EXPECT_EQ(last_currents(), kZero);
  EXPECT_EQ(device_->fault(), Fault::kForceNotFinite);
  EXPECT_EQ(device_->stage(), DeviceStage::kFault);
  EXPECT_EQ(device_->f_sent_W(), Eigen::Vector3d(0, 0, 0));
  // It stays off until the device is activated again.
  wire_.to_host.push_back(report());
  tick({0, 0.5, 0});
  EXPECT_EQ(last_currents(), kZero);
  ASSERT_TRUE(device_->activate());
  settle();
}

TEST_F(DeviceTest, DropsOneReportOfAnImpossibleJumpAndHoldsTheForce) {
  open_and_activate();
  settle();
  const auto before = last_currents();
  const Eigen::Vector3d p_WT = device_->state().p_WT;
  wire_.to_host.push_back(report(1000));  // 24 mm in one tick
  tick({0, 0.5, 0});
  EXPECT_EQ(last_currents(), before);
  EXPECT_EQ(device_->state().p_WT, p_WT);
  EXPECT_FALSE(device_->state().fresh);
  wire_.to_host.push_back(report());
  tick({0, 0.5, 0});
  EXPECT_EQ(device_->fault(), Fault::kNone);
  EXPECT_TRUE(device_->state().fresh);
  EXPECT_EQ(device_->wire_counters().jumped, 1u);
}

TEST_F(DeviceTest, SendsZeroInTheSecondTickOfAnImpossibleJump) {
  open_and_activate();
  settle();
  for (int k = 0; k < 2; ++k) {
    wire_.to_host.push_back(report(1000));
    tick({0, 0.5, 0});
  }
  EXPECT_EQ(last_currents(), kZero);
  EXPECT_EQ(device_->fault(), Fault::kCountsJumped);
}

TEST_F(DeviceTest, SendsZeroInTheSecondTickOfASmallerJump) {
  open_and_activate();
  settle();
  for (int k = 0; k < 2; ++k) {
    wire_.to_host.push_back(report(600));  // 14 mm: the largest allowed distance from the home pose
    tick({0, 0.5, 0});
  }
  EXPECT_EQ(last_currents(), kZero);
  EXPECT_EQ(device_->fault(), Fault::kOverSpeed);
  EXPECT_FALSE(device_->home_needed());
}

TEST_F(DeviceTest, RefusalBecomesAFaultAfterTheLimit) {
  open_and_activate();
  settle();
  const std::int64_t limit_ticks = support::vintage_settings().silence_limit_ns / kPeriod_ns;
  wire_.refusals = 1000;
  for (std::int64_t k = 0; k <= limit_ticks; ++k) {
    wire_.to_host.push_back(report());
    tick({0, 0.5, 0});
    EXPECT_EQ(device_->fault(), Fault::kNone) << k;
  }
  wire_.to_host.push_back(report());
  tick({0, 0.5, 0});
  EXPECT_EQ(device_->fault(), Fault::kRefused);
}

TEST_F(DeviceTest, NamesALostArmAndCannotBeActivatedAgain) {
  open_and_activate();
  settle();
  wire_.lost = true;
  tick({0, 0.5, 0});
  EXPECT_EQ(device_->fault(), Fault::kTransportLost);
  EXPECT_FALSE(device_->activate());
}

TEST_F(DeviceTest, SendsZeroWhenDeactivatedAndWhenDestroyed) {
  open_and_activate();
  settle();
  device_->deactivate();
  EXPECT_EQ(last_currents(), kZero);

  ASSERT_TRUE(device_->activate());
  settle();
  device_.reset();
  EXPECT_EQ(last_currents(), kZero);
}

TEST_F(DeviceTest, InsistsOnZeroForceOnce) {
  constexpr int kMany = 1'000'000;
  open_and_activate();
  settle();
  wire_.refusals = kMany;
  VirtualClock clock;
  clock.sleep_until_ns(now_ns_);
  device_->deactivate();
  EXPECT_FALSE(device_->insist_on_zero(clock));
  const int insisted = kMany - wire_.refusals;
  EXPECT_GT(insisted, 10);
  wire_.refusals = kMany;
  device_.reset();
  EXPECT_LT(kMany - wire_.refusals, 4);  // only the zero of the destructor
}

/// A WoodenHaptics arm, whose reports carry a number.
class NumberedReports : public ::testing::Test {
 protected:
  void SetUp() override {
    say(0);
    auto opened = Device::open(
        std::make_unique<WireLink>(std::make_unique<support::ScriptedTransport>(wire_),
                                   std::make_unique<woody::WoodyArm>(hfab::woody_model())),
        support::vintage_settings(), 0);
    ASSERT_TRUE(opened) << opened.error().message;
    device_ = std::move(opened).value();
    ASSERT_TRUE(device_->activate());
  }
  void say(int number) {
    const auto bytes =
        woody::encode_input({.counts = {7, 8, 9}, .counter = static_cast<std::uint16_t>(number)});
    wire_.to_host.emplace_back(bytes.begin(), bytes.end());
  }
  bool tick(int number) {
    say(number);
    now_ns_ += kPeriod_ns;
    device_->read(now_ns_, now_ns_);
    device_->write({.f_T_W = {0, 0, 0.5}, .touch = {}});
    return device_->state().fresh;
  }

  support::Wire wire_;
  std::int64_t now_ns_ = 0;
  std::unique_ptr<Device> device_;
};

TEST_F(NumberedReports, RepeatedNumbersStopTheForce) {
  for (int k = 65500; k < 65600; ++k) ASSERT_TRUE(tick(k));  // the number wraps
  ASSERT_GT(device_->f_sent_W().norm(), 0);
  int ticks = 0;
  while (device_->f_sent_W().norm() > 0 && ticks < 100) {
    EXPECT_FALSE(tick(65599));
    ++ticks;
  }
  EXPECT_EQ(ticks, 21);  // 20 ms, and the tick that notices
  EXPECT_EQ(device_->fault(), Fault::kNoReports);
  EXPECT_EQ(device_->wire_counters().repeated, 21u);
}

TEST_F(NumberedReports, DuplicatesAreDroppedWithoutAFault) {
  for (int k = 0; k < 200; ++k) EXPECT_EQ(tick(1 + k / 2), k % 2 == 0);
  EXPECT_EQ(device_->fault(), Fault::kNone);
  EXPECT_EQ(device_->wire_counters().repeated, 100u);
}

TEST_F(NumberedReports, BoardWithConstantNumberIsAccepted) {
  for (int k = 0; k < 100; ++k) EXPECT_TRUE(tick(0));
  EXPECT_EQ(device_->fault(), Fault::kNone);
}

}  // namespace
}  // namespace thimble::driver
