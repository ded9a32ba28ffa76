// Tip position from the bytes of a board, compared with the published host programs.
#include "usb/board_vectors.h"

#include <gtest/gtest.h>

#include <memory>

#include "thimble/device_sim/usb/arm_shelf.h"
#include "usb/hid_arm.h"
#include "usb/virtual_arm.h"

namespace thimble {
namespace {

class BoardVectors : public testing::TestWithParam<usb_test::BoardVector> {};

TEST_P(BoardVectors, TipMatchesThePublishedProgram) {
  usb_test::VirtualArm arm;
  arm.name = GetParam().board;
  const auto protocol = arm.protocol();
  driver::ArmReading reading;
  ASSERT_TRUE(protocol->decode(GetParam().report(), reading));
  const Eigen::Vector3d p_BT = protocol->pose(reading).p_BT;
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(p_BT[i], GetParam().tip[static_cast<std::size_t>(i)], 1e-8) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Boards, BoardVectors, testing::ValuesIn(usb_test::kBoardVectors));

// The simulated board has the signs of the published one: towards +y, encoder a counts down.
TEST(SimulatedBoards, MbedEncoderACountsAgainstYaw) {
  namespace usb = device_sim::usb;
  usb::ShelfOptions options;
  options.motion = usb::HandMotion::kStroke;
  auto arm = usb::make_usb_arm("woodenhaptics", options);
  ASSERT_TRUE(arm.ok());
  int seen = 0;
  for (std::int64_t ms = 1; ms < 4000; ++ms) {
    (*arm)->advance_to(ms * 1'000'000);
    std::array<std::byte, usb::UsbDevice::kPacketMax> packet{};
    ASSERT_EQ((*arm)->in(0x81, packet).answer, usb::Answer::kDone);
    const usb::ArmTruth truth = (*arm)->truth();
    if (std::abs(truth.p_BT.y()) < 0.005) continue;
    ++seen;
    ASSERT_EQ(truth.counts[0] > 0, truth.p_BT.y() < 0) << truth.p_BT.transpose();
  }
  EXPECT_GT(seen, 1000);
}

}  // namespace
}  // namespace thimble
