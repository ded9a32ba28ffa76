#include "rp_usb_model.h"

#include <algorithm>
#include <cstring>
#include <string>

namespace thimble::firmware_test {
namespace {

constexpr std::uintptr_t kRpRam = 0x50100000, kRpRegisters = 0x50110000;
constexpr std::uint32_t kRpFull = 1u << 15, kRpData1 = 1u << 13, kRpStall = 1u << 11;
constexpr std::uint32_t kRpAvailable = 1u << 10, kRpLength = 0x3ff;
// Bits of SIE_STATUS that are cleared by writing one.
constexpr std::uint32_t kRpClearedByOne = 1u << 19 | 1u << 17 | 1u << 11;

}  // namespace

bool RpUsbModel::attached() const {
  const bool transceiver = (muxing_ & 9) == 9, voltage = (power_ & 12) == 12;
  return transceiver && voltage && (main_ & 3) == 1 && (sie_ & 1u << 16) != 0;
}

bool RpUsbModel::listens(int address) const {
  return attached() && was_reset_ && !suspended_ && address == static_cast<int>(address_);
}

std::uint32_t RpUsbModel::read(std::uintptr_t address) {
  if (address >= kRpRam && address < kRpRam + 4 * kWords) return ram_[(address - kRpRam) / 4];
  switch (address - kRpRegisters) {
    case 0x00:
      return address_;
    case 0x50:
      return status_ | (suspended_ ? 1u << 4 : 0);
    case 0x58:
      return done_;
    default:
      misuse("no register to read at " + std::to_string(address));
      return 0;
  }
}

void RpUsbModel::write(std::uintptr_t address, std::uint32_t value) {
  if (address >= kRpRam && address < kRpRam + 4 * kWords) {
    const std::size_t word = (address - kRpRam) / 4;
    const bool is_control = word >= 0x20 && word < 0x40;
    const std::uint32_t others = ~kRpAvailable;
    if (is_control && (value & kRpAvailable) != 0 &&
        (settled_[word] & others) != (value & others)) {
      misuse("a buffer was made available before its controller saw the other bits");
    }
    const bool is_data = word >= 0x40;
    if (is_data) {
      for (unsigned endpoint = 0; endpoint < 2; ++endpoint) {
        const bool given = (ram_[control_word(endpoint, true)] & kRpAvailable) != 0;
        const std::size_t first = data_word(endpoint, true);
        if (given && endpoint != 0 && word >= first && word < first + 16) {
          misuse("data of a buffer that the controller has were changed");
        }
      }
    }
    ram_[word] = value;
    return;
  }
  switch (address - kRpRegisters) {
    case 0x00:
      address_ = value & 0x7f;
      return;
    case 0x40:
      main_ = value;
      return;
    case 0x4c:
      sie_ = value;
      return;
    case 0x50:
      status_ &= ~(value & kRpClearedByOne);
      return;
    case 0x58:
      done_ &= ~value;
      return;
    case 0x68:
      stall_ = value & 3;
      return;
    case 0x74:
      muxing_ = value;
      return;
    case 0x78:
      power_ = value;
      return;
    default:
      misuse("no register to write at " + std::to_string(address));
  }
}

bool RpUsbModel::open(unsigned endpoint, bool in) {
  if (endpoint == 0) return true;
  const std::uint32_t control = ram_[2 * endpoint + (in ? 0 : 1)];
  if ((control & 1u << 31) != 0 && (control >> 26 & 3) != 3) {
    misuse("endpoint 1 is no interrupt endpoint");
  }
  return (control & 1u << 31) != 0;
}

/// First word of the data of an endpoint; both directions of endpoint 0 have one buffer.
std::size_t RpUsbModel::data_word(unsigned endpoint, bool in) const {
  return endpoint == 0 ? 0x40 : (ram_[2 * endpoint + (in ? 0 : 1)] & 0xffc0) / 4;
}

/// The buffer returns to the processor.
void RpUsbModel::end_buffer(unsigned endpoint, bool in) {
  std::uint32_t& control = ram_[control_word(endpoint, in)];
  control &= ~kRpAvailable;
  control = in ? control & ~kRpFull : control | kRpFull;
  const std::uint32_t settings = endpoint == 0 ? sie_ : ram_[2 * endpoint + (in ? 0 : 1)];
  if ((settings & 1u << 29) != 0) done_ |= 1u << (2 * endpoint + (in ? 0 : 1));
}

bool RpUsbModel::stalls(unsigned endpoint, bool in) const {
  if ((ram_[control_word(endpoint, in)] & kRpStall) == 0) return false;
  return endpoint != 0 || (stall_ & (in ? 1u : 2u)) != 0;
}

void RpUsbModel::begin_reset() {
  if (!attached()) return;
  was_reset_ = true;
  suspended_ = false;
  status_ |= 1u << 19;
}

void RpUsbModel::suspend() {
  suspended_ = attached();
}

void RpUsbModel::resume() {
  if (!suspended_) return;
  suspended_ = false;
  status_ |= 1u << 11;
}

Handshake RpUsbModel::setup(int address, const std::array<std::uint8_t, 8>& packet) {
  if (!listens(address)) return Handshake::kSilence;
  std::memcpy(ram_.data(), packet.data(), packet.size());
  status_ |= 1u << 17;
  stall_ = 0;
  return Handshake::kAck;
}

InPacket RpUsbModel::in(int address, unsigned endpoint) {
  InPacket packet;
  if (!listens(address) || !open(endpoint, true)) return packet;
  packet.answer = Handshake::kStall;
  if (stalls(endpoint, true)) return packet;
  packet.answer = Handshake::kNak;
  const std::uint32_t control = ram_[control_word(endpoint, true)];
  if ((control & kRpAvailable) == 0 || (control & kRpFull) == 0) return packet;
  packet.answer = Handshake::kAck;
  packet.toggle = (control & kRpData1) != 0;
  const auto* data = reinterpret_cast<const std::uint8_t*>(ram_.data() + data_word(endpoint, true));
  packet.bytes.assign(data, data + std::min<std::uint32_t>(control & kRpLength, 64));
  end_buffer(endpoint, true);
  return packet;
}

Handshake RpUsbModel::out(int address, unsigned endpoint, int toggle, const Bytes& bytes) {
  if (!listens(address) || !open(endpoint, false)) return Handshake::kSilence;
  if (stalls(endpoint, false)) return Handshake::kStall;
  std::uint32_t& control = ram_[control_word(endpoint, false)];
  if ((control & kRpAvailable) == 0) return Handshake::kNak;
  if (toggle != static_cast<int>((control & kRpData1) != 0))
    return Handshake::kAck;                                              // a repetition
  if (bytes.size() > (control & kRpLength)) return Handshake::kSilence;  // an overflow
  if (!bytes.empty()) {
    std::memcpy(ram_.data() + data_word(endpoint, false), bytes.data(), bytes.size());
  }
  control = (control & ~kRpLength) | static_cast<std::uint32_t>(bytes.size());
  end_buffer(endpoint, false);
  return Handshake::kAck;
}

}  // namespace thimble::firmware_test
