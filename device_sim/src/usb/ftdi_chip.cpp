#include "usb/ftdi_chip.h"
#include "usb/setup_packet.h"

#include <algorithm>
#include <cmath>

namespace thimble::device_sim::usb {
namespace {

// Vendor requests [S Linux ftdi_sio.h].
enum FtdiRequest : std::uint8_t {
  kReset = 0,
  kModemControl = 1,
  kFlowControl = 2,
  kBaudRate = 3,
  kData = 4,
  kModemStatus = 5,
  kEventCharacter = 6,
  kErrorCharacter = 7,
  kSetLatency = 9,
  kGetLatency = 10,
  kReadEeprom = 0x90,
};
constexpr std::uint16_t kResetAll = 0, kPurgeReceived = 1, kPurgeSent = 2;

// The first status byte's low nibble is 1 on this chip; CTS and DSR are wired up. The second
// reports an empty transmitter [S Linux ftdi_sio.h].
constexpr std::byte kModemByte{0x31};
constexpr std::byte kLineByte{0x60};

constexpr double kBitsPerByte = 10;  // 8N1
constexpr double kClock = 3e6;       // Hz; a divisor of one is 3 MBaud
constexpr double kLineRateTolerance = 0.03;

PacketResult done(std::size_t size = 0) noexcept {
  return {Answer::kDone, size};
}

}  // namespace

double FtdiChip::rate() const noexcept {
  // The low 14 bits divide; the upper bits add eighths in an irregular order [S ftdi_sio.c].
  constexpr std::array<double, 8> kEighths{0, 4, 2, 1, 3, 5, 6, 7};
  const std::uint32_t whole = divisor_ & 0x3fffU;
  if (divisor_ == 0) return kClock;
  if (divisor_ == 1) return kClock * 2 / 3;
  return kClock / (whole + kEighths[(divisor_ >> 14U) & 7U] / 8);
}

PacketResult FtdiChip::control(const SetupPacket& setup, std::span<std::byte> data) noexcept {
  if ((setup.request_type & kKindMask) != kKindVendor) return {Answer::kStall, 0};
  const auto low = static_cast<std::uint8_t>(setup.value & 0xffU);
  switch (setup.request) {
    case kReset:
      if (setup.value > kPurgeSent) return {Answer::kStall, 0};
      if (setup.value != kPurgeSent) {  // towards the host
        to_host_.clear();
        from_board_.clear();
      }
      if (setup.value != kPurgeReceived) to_board_.clear();
      if (setup.value == kResetAll) latency_ms_ = kLatencyDefault_ms;
      return done();
    case kModemControl: {
      // The high byte selects the wire that the low byte sets.
      const unsigned mask = setup.value >> 8U;
      if ((mask & 1U) != 0) dtr_ = (low & 1U) != 0;
      if ((mask & 2U) != 0) rts_ = (low & 2U) != 0;
      board_.wires(dtr_, rts_);
      return done();
    }
    case kBaudRate:
      divisor_ = setup.value | (static_cast<std::uint32_t>(setup.index & 1U) << 16U);
      return done();
    case kFlowControl:
    case kData:
    case kEventCharacter:
    case kErrorCharacter:
      return done();
    case kModemStatus:
      if (data.size() < kStatusBytes) return {Answer::kStall, 0};
      data[0] = kModemByte;
      data[1] = kLineByte;
      return done(kStatusBytes);
    case kSetLatency:
      if (low == 0) return {Answer::kStall, 0};
      latency_ms_ = low;
      return done();
    case kGetLatency:
      if (data.empty()) return {Answer::kStall, 0};
      data[0] = std::byte{latency_ms_};
      return done(1);
    case kReadEeprom:  // empty
      if (data.size() < 2) return {Answer::kStall, 0};
      data[0] = data[1] = std::byte{0xff};
      return done(2);
    default:
      return {Answer::kStall, 0};
  }
}

PacketResult FtdiChip::in(std::int64_t time_ns, std::span<std::byte> packet) noexcept {
  constexpr std::size_t kDataMax = UsbDevice::kPacketMax - kStatusBytes;
  const bool full = to_host_.size() >= kDataMax;
  const bool due = time_ns - last_packet_ns_ >= std::int64_t{latency_ms_} * 1'000'000;
  if (!full && !due) return {Answer::kNak, 0};
  last_packet_ns_ = time_ns;
  packet[0] = kModemByte;
  packet[1] = kLineByte;
  std::size_t size = kStatusBytes;
  while (size < UsbDevice::kPacketMax && to_host_.size() > 0) packet[size++] = to_host_.pop();
  return done(size);
}

PacketResult FtdiChip::out(std::span<const std::byte> packet) noexcept {
  constexpr std::size_t kTransmitBuffer = 128;  // bytes [S FTDI data sheet FT232BM]
  if (to_board_.size() + packet.size() > kTransmitBuffer) return {Answer::kNak, 0};
  for (const std::byte byte : packet) to_board_.push(byte);
  return done(packet.size());
}

std::int64_t FtdiChip::line_time_ns(std::int64_t dt_ns) const noexcept {
  const double time = static_cast<double>(to_board_.size()) * kBitsPerByte / rate();
  return std::min(static_cast<std::int64_t>(time * 1e9), dt_ns);
}

void FtdiChip::deliver(std::int64_t dt_ns) noexcept {
  const double more = rate() / kBitsPerByte * static_cast<double>(dt_ns) * 1e-9;
  const auto move = [&](ByteQueue& from, double& credit, auto&& give) {
    credit = from.size() == 0 ? 0 : credit + more;
    for (; credit >= 1 && from.size() > 0; --credit) give(from.pop());
  };
  move(to_board_, to_board_credit_, [&](std::byte byte) {
    const bool heard = std::abs(rate() / board_.rate() - 1) < kLineRateTolerance;
    if (heard) {
      board_.hear(byte, from_board_);
    } else {
      ++garbled_;
    }
  });
  move(from_board_, to_host_credit_, [&](std::byte byte) { to_host_.push(byte); });
}

}  // namespace thimble::device_sim::usb
