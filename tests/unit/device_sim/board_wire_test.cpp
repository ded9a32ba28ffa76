#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "arm_table.h"
#include "arms/hfab/hfab_line.h"
#include "arms/hfab/hfab_models.h"
#include "arms/woody/woody_report.h"
#include "board/sim_transport.h"
#include "simulated_arm.h"
#include "support/refuses.h"
#include "support/vintage_arm.h"
#include "thimble/driver/wire_link.h"
#include "vintage_simulation.h"

// The simulated arm uses the protocol of its kind of arm, and the driver decodes it.

namespace thimble::device_sim {
namespace {

using driver::ArmKind;
using support::refuses;

SimulatedArmSettings speaking(ArmKind kind) {
  SimulatedArmSettings settings = phantom_like();
  settings.firmware.protocol = kind;
  settings.firmware.line_model = 3;
  return settings;
}

BoardBytes newest(SimulatedArm& arm) {
  BoardBytes report{};
  std::uint32_t skipped = 0;
  report.size = arm.take_report(report.bytes, skipped);
  return report;
}

TEST(BoardWire, MatchesTheDecoderOfTheArm) {
  const auto woody = driver::hfab::woody_model();
  const Eigen::Vector3d home = woody.geometry.forward(woody.joint_angles({}));
  SimulatedArm eight =
      SimulatedArm::make(woody, speaking(ArmKind::kWoody), resting_at(home)).value();
  for (std::uint16_t number = 0; number < 5; ++number) {
    const auto report = driver::woody::decode_input(newest(eight));
    ASSERT_TRUE(report);
    EXPECT_EQ(report->counter, number) << "reports are numbered";
    eight.advance_to((number + 1) * 1'000'000);
  }
  eight.put_message(driver::woody::encode_output({.current_mA = {100, -200, 300}}));
  EXPECT_EQ(eight.firmware().currents(), Eigen::Vector3d(0.1, -0.2, 0.3));

  SimulatedArm lines =
      SimulatedArm::make(woody, speaking(ArmKind::kHfabLine), resting_at(home)).value();
  const auto line = driver::hfab::decode_arm_line(newest(lines));
  ASSERT_TRUE(line);
  EXPECT_EQ(line->model, 3);
  std::array<std::byte, driver::hfab::kLineCapacity> text{};
  const std::size_t size = driver::hfab::encode_host_line({.current_mA = {1, 2, 3}}, text);
  lines.put_message(std::span<const std::byte>(text).first(size));
  EXPECT_EQ(lines.firmware().currents(), Eigen::Vector3d(0.001, 0.002, 0.003));

  SimulatedArm fourteen =
      SimulatedArm::make(woody, speaking(ArmKind::kPolhem), resting_at(home)).value();
  EXPECT_EQ(newest(fourteen).size, driver::hfab::kReportSize);
}

TEST(BoardWire, RejectsMessagesOfOtherBoards) {
  const auto woody = driver::hfab::woody_model();
  const Eigen::Vector3d home = woody.geometry.forward(woody.joint_angles({}));
  for (const ArmKind kind : {ArmKind::kWoody, ArmKind::kHfabLine, ArmKind::kPolhem}) {
    SimulatedArm arm = SimulatedArm::make(woody, speaking(kind), resting_at(home)).value();
    if (kind != ArmKind::kWoody) {
      arm.put_message(driver::woody::encode_output({.current_mA = {100, 100, 100}}));
    }
    if (kind != ArmKind::kPolhem) {
      arm.put_message(driver::hfab::encode_output({.current_mA = {100, 100, 100}}));
    }
    EXPECT_GT(arm.firmware().counters().malformed, 0u);
    EXPECT_FALSE(arm.firmware().motors_on());
  }
}

TEST(BoardWire, CarriesTheSameCountsInEveryProtocol) {
  const auto model = support::vintage_model();
  const HandPath path =
      HandPath::make({{0, home_tip()}, {0.2, home_tip() + Eigen::Vector3d(0.02, -0.01, 0.03)}})
          .value();
  for (const ArmKind kind : {ArmKind::kWoody, ArmKind::kHfabLine}) {
    SimulatedArm reference = SimulatedArm::make(model, speaking(ArmKind::kPolhem), path).value();
    SimulatedArm other = SimulatedArm::make(model, speaking(kind), path).value();
    const auto a = driver::make_arm(ArmKind::kPolhem, arm_model(model));
    const auto b = driver::make_arm(kind, arm_model(model));
    for (int k = 1; k < 250; ++k) {
      reference.advance_to(k * 1'000'000);
      other.advance_to(k * 1'000'000);
      driver::ArmReading x, y;
      ASSERT_TRUE(a->decode(newest(reference), x));
      ASSERT_TRUE(b->decode(newest(other), y));
      ASSERT_EQ(x.counts, y.counts) << k;
    }
  }
}

TEST(BoardWire, RejectsTheProtocolOfAFalcon) {
  EXPECT_TRUE(refuses(SimulatedArm::make(support::vintage_model(), speaking(ArmKind::kFalcon),
                                         resting_at(home_tip())),
                      "14-byte reports"));
}

TEST(SimulatedGimbal, IsReadThroughTheBytesOfTheWire) {
  auto model = driver::hfab::polhem_model();
  model.gimbal = driver::Gimbal{
      .sign = {-1, -1, 1}, .counts_per_turn = {1024, 1024, 1024}, .home_counts = {0, 30, 0}};
  const Eigen::Vector3d middle(0.2045, 0, 0.0325);
  const double step = 2 * std::numbers::pi / 1024;
  for (const ArmKind kind : {ArmKind::kPolhem, ArmKind::kHfabLine}) {
    SimulatedArmSettings settings = speaking(kind);
    settings.gimbal = {.middle = {0.1, -0.2, 0.3}, .amplitude = {0.5, 0.6, 2.5}, .period = 0.7};
    SimulatedArm arm =
        SimulatedArm::make(
            model, settings,
            HandPath::make({{0, middle}, {0.5, middle + Eigen::Vector3d(0.03, 0.03, 0.02)}})
                .value())
            .value();
    driver::VirtualClock clock;
    driver::WireLink link(std::make_unique<SimTransport>(clock, arm),
                          driver::make_arm(kind, arm_model(model)));
    EXPECT_TRUE(link.traits().has_orientation);
    driver::ArmSample sample;
    double turned = 0;
    Eigen::Matrix3d first = Eigen::Matrix3d::Identity();
    for (int k = 0; k < 600; ++k) {
      clock.sleep_until_ns(k * 1'000'000);
      ASSERT_EQ(link.read(sample, clock.now_ns()).status, driver::LinkStatus::kOk);
      ASSERT_LE((sample.gimbal - arm.gimbal()).cwiseAbs().maxCoeff(), 0.5 * step + 1e-9) << k;
      const Eigen::Matrix3d R_true = model.geometry.last_link(arm.plant().q(), arm.plant().p_BT()) *
                                     model.gimbal->rotation(arm.gimbal());
      // Half a step for each of three axes, and the steps of the links.
      ASSERT_LT((sample.R_BT - R_true).norm(), 3 * step) << k;
      if (k == 0) first = sample.R_BT;
      turned = std::max(turned, (sample.R_BT - first).norm());
    }
    EXPECT_GT(turned, 1) << "a gimbal that does not turn proves nothing";
  }
}

TEST(SimulatedGimbal, PresetMatchesTheBoard) {
  auto model = support::vintage_model();
  model.gimbal = driver::Gimbal{.counts_per_turn = {2000, 2000, 2000}};
  Firmware firmware = Firmware::make(arm_model(model), {}).value();
  const Eigen::Vector3d q = support::vintage_home(), turned(0.1, 0.2, 0.3);
  firmware.preset(
      firmware
          .receive(driver::hfab::encode_output(
                       {.current_mA = {7, 8, 9}, .command = 1, .attributes = {1, 2, 3}}),
                   1)
          .value(),
      q, turned);
  const auto report = driver::hfab::decode_input(firmware.sample(q, turned)).value();
  EXPECT_EQ(report.counts, (std::array<std::int16_t, 6>{1, 2, 3, 7, 8, 9}));
}

}  // namespace
}  // namespace thimble::device_sim
