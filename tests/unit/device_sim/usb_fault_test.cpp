#include "thimble/device_sim/usb/usb_fault.h"
#include "usb/setup_packet.h"
#include "usb/usb_description.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <vector>

namespace thimble::device_sim::usb {
namespace {

using Packet = std::vector<std::byte>;

/// A device whose n-th packet is eight bytes of value n, and which stores received packets.
class Numbered final : public UsbDevice {
 public:
  const UsbDescription& description() const noexcept override { return description_; }
  void advance_to(std::int64_t) noexcept override {}
  PacketResult control(const SetupPacket&, std::span<std::byte>) noexcept override {
    return {Answer::kDone, 0};
  }
  PacketResult in(std::uint8_t, std::span<std::byte> packet) noexcept override {
    std::fill_n(packet.begin(), 8, static_cast<std::byte>(++number));
    return {Answer::kDone, 8};
  }
  PacketResult out(std::uint8_t, std::span<const std::byte> packet) noexcept override {
    taken.emplace_back(packet.begin(), packet.end());
    return {Answer::kDone, packet.size()};
  }
  unsigned number = 0;
  std::vector<Packet> taken;

 private:
  UsbDescription description_;
};

class Faulty : public testing::Test {
 protected:
  /// Starts the next frame and polls endpoint 0x81.
  PacketResult poll() {
    device_.advance_to(++frame_ * 1'000'000);
    packet_.assign(UsbDevice::kPacketMax, std::byte{0xee});
    const PacketResult result = device_.in(0x81, packet_);
    packet_.resize(std::min(result.size, packet_.size()));
    return result;
  }
  PacketResult tell(int value) {
    device_.advance_to(++frame_ * 1'000'000);
    return device_.out(0x01, Packet(8, static_cast<std::byte>(value)));
  }
  void order(const char* line) {
    const auto fault = parse_fault(line);
    ASSERT_TRUE(fault.ok()) << fault.error().message;
    device_.order(*fault);
  }
  static Packet of(int value) { return Packet(8, static_cast<std::byte>(value)); }

  Numbered inner_;
  FaultyDevice device_{inner_};
  Packet packet_;
  std::int64_t frame_ = 0;
};

TEST_F(Faulty, ChangesNothingWithoutAFault) {
  for (int i = 1; i <= 10; ++i) {
    EXPECT_EQ(poll().answer, Answer::kDone);
    EXPECT_EQ(packet_, of(i));
    tell(i);
    EXPECT_EQ(inner_.taken.back(), of(i));
  }
  for (std::size_t kind = 0; kind < kFaultKinds; ++kind) {
    EXPECT_EQ(device_.hits(static_cast<FaultKind>(kind)), 0U);
  }
}

TEST_F(Faulty, BeginsAndEndsInTheFramesOfTheOrder) {
  order("silence in after=3 for=2");
  std::vector<bool> silent;
  for (int i = 0; i < 6; ++i) silent.push_back(poll().answer == Answer::kNak);
  EXPECT_EQ(silent, (std::vector<bool>{false, false, true, true, false, false}));
  EXPECT_EQ(device_.hits(FaultKind::kSilence), 2U);
}

TEST_F(Faulty, HitsOnlyTheDirectionOfTheOrder) {
  order("stall out");
  EXPECT_EQ(poll().answer, Answer::kDone);
  EXPECT_EQ(tell(1).answer, Answer::kStall);
  EXPECT_TRUE(inner_.taken.empty());
}

TEST_F(Faulty, MakesPacketsShortAndLong) {
  order("short in");
  EXPECT_EQ(poll().size, 4U);
  device_.heal();
  order("long in");
  EXPECT_EQ(poll().size, 16U);
  EXPECT_EQ(Packet(packet_.begin(), packet_.begin() + 8), of(2));
  EXPECT_EQ(packet_[8], std::byte{0});
  order("short out");
  EXPECT_EQ(tell(7).size, 8U);  // the host does not notice
  EXPECT_EQ(inner_.taken.back().size(), 4U);
  order("long out");
  tell(7);
  EXPECT_EQ(inner_.taken.back().size(), 16U);
}

TEST_F(Faulty, TearsAPacketBetweenTwo) {
  poll();
  order("torn in");
  poll();
  EXPECT_EQ(Packet(packet_.begin(), packet_.begin() + 4), Packet(4, std::byte{2}));
  EXPECT_EQ(Packet(packet_.begin() + 4, packet_.end()), Packet(4, std::byte{1}));
}

TEST_F(Faulty, RepeatsTheLastGoodPacketWhenStale) {
  poll();
  poll();
  order("stale in for=4");
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(poll().answer, Answer::kDone);
    EXPECT_EQ(packet_, of(2));
  }
  poll();
  EXPECT_EQ(packet_, of(6));  // afterwards the newest packet, not the missed ones
}

TEST_F(Faulty, SendsEveryPacketTwiceWhenDuplicating) {
  order("duplicate in");
  std::vector<Packet> got;
  for (int i = 0; i < 6; ++i) {
    poll();
    got.push_back(packet_);
  }
  EXPECT_EQ(got, (std::vector<Packet>{of(1), of(1), of(2), of(2), of(3), of(3)}));
  order("duplicate out");
  tell(9);
  EXPECT_EQ(inner_.taken, (std::vector<Packet>{of(9), of(9)}));
}

TEST_F(Faulty, LosesAcceptedPackets) {
  order("lost in for=3");
  EXPECT_EQ(poll().answer, Answer::kNak);
  EXPECT_EQ(poll().answer, Answer::kNak);
  EXPECT_EQ(poll().answer, Answer::kDone);
  EXPECT_EQ(packet_, of(3));  // the first two were dropped
  order("lost out");
  EXPECT_EQ(tell(5).answer, Answer::kDone);  // the host does not notice
  EXPECT_EQ(tell(6).size, 8U);
  EXPECT_TRUE(inner_.taken.empty());
  EXPECT_EQ(device_.hits(FaultKind::kLost), 4U);
}

TEST_F(Faulty, FlipsBitsAtTheGivenRate) {
  order("bit_errors in rate=0.1");
  int flipped = 0;
  const int packets = 2000;
  for (int i = 0; i < packets; ++i) {
    poll();
    const auto good = static_cast<unsigned char>(inner_.number);
    for (const std::byte byte : packet_) {
      flipped += std::popcount(static_cast<unsigned char>(std::to_integer<unsigned>(byte) ^ good));
    }
  }
  // 128,000 bits at 0.1: the standard deviation is 107, the band is five of them.
  EXPECT_NEAR(flipped, packets * 64 / 10, 540);
}

TEST_F(Faulty, LeavesTheBusWhenUnpluggedAndComesBack) {
  order("unplug for=3");
  EXPECT_FALSE(device_.plugged());
  EXPECT_EQ(poll().answer, Answer::kGone);
  EXPECT_EQ(tell(1).answer, Answer::kGone);
  EXPECT_EQ(device_.control({}, {}).answer, Answer::kGone);
  poll();
  EXPECT_TRUE(device_.plugged());
  order("unplug");
  EXPECT_FALSE(device_.plugged());
  device_.heal();
  EXPECT_TRUE(device_.plugged());
}

TEST_F(Faulty, KeepsTheLatestOrdersWhenThereAreTooMany) {
  for (std::size_t i = 0; i < 3 * FaultyDevice::kOrders; ++i) order("short in");
  order("silence in for=2");
  EXPECT_EQ(poll().answer, Answer::kNak);
  EXPECT_EQ(poll().size, 4U);
}

TEST(FaultScript, ReadsTheDocumentedSyntax) {
  const auto order = parse_fault("  bit_errors out after=10 for=20 rate=0.25 ");
  ASSERT_TRUE(order.ok());
  EXPECT_EQ(order->kind, FaultKind::kBitErrors);
  EXPECT_FALSE(order->to_host);
  EXPECT_EQ(order->after, 10);
  EXPECT_EQ(order->frames, 20);
  EXPECT_EQ(order->rate, 0.25);
  for (std::size_t kind = 0; kind < kFaultKinds; ++kind) {
    const auto fault = static_cast<FaultKind>(kind);
    ASSERT_TRUE(parse_fault(name(fault)).ok());
    EXPECT_EQ(parse_fault(name(fault))->kind, fault);
  }
}

TEST(FaultScript, NamesAnUnknownWord) {
  for (const char* line : {"", "quake", "stall for=0", "stall for=x", "stall after=-1",
                           "bit_errors rate=2", "bit_errors rate=nan", "stall sideways"}) {
    const auto order = parse_fault(line);
    ASSERT_FALSE(order.ok()) << line;
    const std::string_view text(line);
    const std::string_view word = text.substr(text.find(' ') + 1);
    EXPECT_NE(order.error().message.find(word), std::string::npos) << line;
  }
}

}  // namespace
}  // namespace thimble::device_sim::usb
