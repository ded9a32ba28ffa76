#include "imx_usb_model.h"

#include <algorithm>
#include <cstring>
#include <string>

namespace thimble::firmware_test {
namespace {

constexpr std::uint32_t kMemoryBase = 0x20200000;  // OCRAM2
// Words of a queue head, and of a transfer descriptor that is copied to its word 2.
constexpr std::uint32_t kHeadCurrent = 4, kHeadNext = 8, kHeadToken = 12, kHeadPages = 16;
constexpr std::uint32_t kHeadSetup = 40;
constexpr std::uint32_t kTokenActive = 1u << 7, kTokenInterrupt = 1u << 15;

}  // namespace

void ImxUsbModel::power_on() {
  pll_ = 1u << 16;  // bypassed, off
  phy_ctl_ = 3u << 30;
  phy_power_ = 0x001e1c00;
  visible_.assign(memory_.size(), 0xee);
  command_ = status_ = mode_ = list_ = port_ = address_register_ = 0;
  setup_status_ = priming_ = ready_ = complete_ = 0;
  control_ = {1u << 23 | 1u << 7, 0};
  suspended_ = was_reset_ = false;
}

std::uint32_t ImxUsbModel::bus_address(const volatile void* object) {
  const auto* at = static_cast<const volatile std::uint8_t*>(object);
  if (at < memory_.data() || at >= memory_.data() + memory_.size()) {
    misuse("memory that the controller does not reach");
    return 0;
  }
  return kMemoryBase + static_cast<std::uint32_t>(at - memory_.data());
}

std::uint32_t ImxUsbModel::word(std::uint32_t bus) const {
  std::uint32_t value = 0;
  const std::size_t at = bus - kMemoryBase;
  if (at + 4 <= visible_.size()) std::memcpy(&value, visible_.data() + at, 4);
  return value;
}

void ImxUsbModel::store(std::uint32_t bus, std::uint32_t value) {
  const std::size_t at = bus - kMemoryBase;
  if (at + 4 > visible_.size()) return misuse("a descriptor outside of the memory");
  std::memcpy(visible_.data() + at, &value, 4);
  std::memcpy(memory_.data() + at, &value, 4);
}

bool ImxUsbModel::attached() const {
  const std::uint32_t pll_on = 1u << 13 | 1u << 12 | 1u << 6;
  const bool clock = (pll_ & pll_on) == pll_on && (pll_ & 1u << 16) == 0;
  const bool transceiver = phy_ctl_ >> 30 == 0 && phy_power_ == 0 && (supply_ & 1) != 0;
  return clock && transceiver && (command_ & 1) != 0 && (mode_ & 3) == 2;
}

bool ImxUsbModel::listens(int address) const {
  return attached() && was_reset_ && !suspended_ && address == address_;
}

std::uint32_t ImxUsbModel::read(std::uintptr_t address) {
  switch (address) {
    case 0x400d8010:
      return pll_ | ((pll_ & 1u << 12) != 0 ? 1u << 31 : 0);
    case 0x402e0140:
      return command_;
    case 0x402e0144:
      return status_;
    case 0x402e0154:
      return address_register_;
    case 0x402e0158:
      return list_;
    case 0x402e0184:
      return port_ | (suspended_ ? 1u << 7 : 0);
    case 0x402e01a8:
      return mode_;
    case 0x402e01ac:
      return setup_status_;
    case 0x402e01b0: {
      // The controller takes some cycles to load a descriptor.
      const std::uint32_t before = priming_;
      prime(priming_);
      return before;
    }
    case 0x402e01b4:
      return 0;
    case 0x402e01b8:
      prime(priming_);
      return ready_;
    case 0x402e01bc:
      return complete_;
    case 0x402e01c0:
      return control_[0];
    case 0x402e01c4:
      return control_[1];
    default:
      misuse("no register to read at " + std::to_string(address));
      return 0;
  }
}

void ImxUsbModel::write(std::uintptr_t address, std::uint32_t value) {
  switch (address) {
    case 0x400d8014:
      pll_ |= value;
      return;
    case 0x400d8018:
      pll_ &= ~value;
      return;
    case 0x400d8124:
      supply_ |= value;
      return;
    case 0x400d9000:
      if (phy_ctl_ >> 30 != 0) return;  // in reset or without clock
      phy_power_ = value;
      return;
    case 0x400d9034:
      phy_ctl_ |= value;
      return;
    case 0x400d9038:
      phy_ctl_ &= ~value;
      return;
    case 0x402e0140:
      if ((value & 1u << 1) != 0) {
        command_ = mode_ = 0;
        return;
      }
      if ((value & 1) != 0 && list_ == 0) misuse("run without a list of queue heads");
      command_ = value & (1u | 1u << 13 | 1u << 14 | 0xffu << 16);
      return;
    case 0x402e0144:
      status_ &= ~value;
      return;
    case 0x402e0148:
      if (value != 0) misuse("interrupts were enabled without a handler");
      return;
    case 0x402e0154:
      address_register_ = value;
      if ((value & 1u << 24) == 0) address_ = static_cast<int>(value >> 25);
      return;
    case 0x402e0158:
      if (value % 2048 != 0) misuse("the list of queue heads is not aligned");
      list_ = value & ~2047u;
      return;
    case 0x402e01a8:
      if ((mode_ & 3) != 0) misuse("the mode was set twice without a reset");
      mode_ = value;
      return;
    case 0x402e01ac:
      setup_status_ &= ~value;
      return;
    case 0x402e01b0:
      priming_ |= value;
      return;
    case 0x402e01b4:
      if ((priming_ & value) != 0) misuse("flush while a descriptor is being loaded");
      ready_ &= ~value;
      return;
    case 0x402e01bc:
      complete_ &= ~value;
      return;
    case 0x402e01c0:
      // Always enabled, control type.
      control_[0] = (control_[0] & ~(1u << 16 | 1u)) | (value & (1u << 16 | 1u));
      return;
    case 0x402e01c4:
      if ((value & 1u << 22) != 0) toggle_[3] = 0;
      if ((value & 1u << 6) != 0) toggle_[2] = 0;
      control_[1] = value & ~(1u << 22 | 1u << 6);
      return;
    default:
      misuse("no register to write at " + std::to_string(address));
  }
}

void ImxUsbModel::prime(std::uint32_t bits) {
  priming_ &= ~bits;
  for (std::size_t queue = 0; queue < kQueues; ++queue) {
    if ((bits & bit(queue)) == 0) continue;
    // A setup packet that has not been taken prevents transfers of its endpoint.
    if (queue < 2 && (setup_status_ & 1) != 0) continue;
    if ((ready_ & bit(queue)) != 0) {
      misuse("a queue was primed that is active");
      continue;
    }
    if ((word(head(queue)) >> 16 & 0x7ff) != 64) misuse("packets of a queue are not of 64 bytes");
    load(queue);
  }
}

/// Copies the next transfer descriptor of a queue into its head, if there is one.
void ImxUsbModel::load(std::size_t queue) {
  const std::uint32_t next = word(head(queue) + kHeadNext);
  ready_ &= ~bit(queue);
  if ((next & 1) != 0) return;
  if (next % 32 != 0) misuse("a transfer descriptor is not aligned");
  const std::uint32_t token = word(next + 4);
  if ((token & kTokenActive) == 0) return misuse("a transfer descriptor is not active");
  store(head(queue) + kHeadCurrent, next);
  store(head(queue) + kHeadNext, word(next));
  store(head(queue) + kHeadToken, token);
  for (std::uint32_t i = 0; i < 5; ++i)
    store(head(queue) + kHeadPages + 4 * i, word(next + 8 + 4 * i));
  done_[queue] = 0;
  ready_ |= bit(queue);
}

/// Ends the transfer of a queue and begins the next one.
void ImxUsbModel::retire(std::size_t queue) {
  const std::uint32_t token = word(head(queue) + kHeadToken);
  store(word(head(queue) + kHeadCurrent) + 4, token & ~kTokenActive);
  complete_ |= bit(queue);
  if ((token & kTokenInterrupt) != 0) status_ |= 1;
  load(queue);
}

/// Bus address of a byte of a transfer.
std::uint32_t ImxUsbModel::data_address(std::size_t queue, std::uint32_t done) const {
  const std::uint32_t first = word(head(queue) + kHeadPages);
  const std::uint32_t offset = (first & 0xfff) + done;
  const std::uint32_t page = word(head(queue) + kHeadPages + 4 * (offset >> 12));
  return (page & ~0xfffu) + (offset & 0xfff);
}

void ImxUsbModel::begin_reset() {
  if (!attached()) return;
  was_reset_ = true;
  suspended_ = false;
  status_ = (status_ & ~(1u << 8)) | 1u << 6;
  port_ |= 1u << 8;
  address_ = 0;
  address_register_ = 0;
}

void ImxUsbModel::end_reset() {
  if (!attached()) return;
  if ((ready_ | priming_ | setup_status_ | complete_) != 0) misuse("a reset did not end transfers");
  port_ = full_speed_ ? 0 : 1u << 9 | 2u << 26;
  status_ |= 1u << 2;
}

void ImxUsbModel::suspend() {
  if (!attached()) return;
  suspended_ = true;
  status_ |= 1u << 8;
}

void ImxUsbModel::resume() {
  if (!suspended_) return;
  suspended_ = false;
  status_ = (status_ & ~(1u << 8)) | 1u << 2;
}

Handshake ImxUsbModel::setup(int address, const std::array<std::uint8_t, 8>& packet) {
  if (!listens(address)) return Handshake::kSilence;
  prime(priming_);
  for (std::uint32_t i = 0; i < 2; ++i) {
    std::uint32_t value;
    std::memcpy(&value, packet.data() + 4 * i, 4);
    store(head(0) + kHeadSetup + 4 * i, value);
  }
  setup_status_ |= 1;
  command_ &= ~(1u << 13);
  control_[0] &= ~(1u << 16 | 1u);
  address_register_ &= ~(1u << 24);
  toggle_[0] = toggle_[1] = 1;
  return Handshake::kAck;
}

InPacket ImxUsbModel::in(int address, unsigned endpoint) {
  InPacket packet;
  if (!listens(address)) return packet;
  const std::uint32_t control = control_[endpoint];
  if ((control & 1u << 23) == 0) return packet;
  if (endpoint != 0 && (control >> 18 & 3) != 3) misuse("endpoint 1 is no interrupt endpoint");
  packet.answer = Handshake::kStall;
  if ((control & 1u << 16) != 0) return packet;
  prime(priming_);
  const std::size_t queue = 2 * endpoint + 1;
  packet.answer = Handshake::kNak;
  if ((ready_ & bit(queue)) == 0) return packet;
  packet.answer = Handshake::kAck;
  packet.toggle = toggle_[queue];
  toggle_[queue] ^= 1;
  const std::uint32_t left = word(head(queue) + kHeadToken) >> 16 & 0x7fff;
  const std::uint32_t size = std::min(left, word(head(queue)) >> 16 & 0x7ff);
  for (std::uint32_t i = 0; i < size; ++i) {
    const std::size_t at = data_address(queue, done_[queue] + i) - kMemoryBase;
    packet.bytes.push_back(at < visible_.size() ? visible_[at] : 0);
  }
  done_[queue] += size;
  store(head(queue) + kHeadToken, word(head(queue) + kHeadToken) - (size << 16));
  const bool ends_empty = (word(head(queue)) & 1u << 29) == 0 && size == 64;
  if (left == size && !ends_empty) retire(queue);
  if (endpoint == 0 && (address_register_ & 1u << 24) != 0) {
    address_register_ &= ~(1u << 24);
    address_ = static_cast<int>(address_register_ >> 25);
  }
  return packet;
}

Handshake ImxUsbModel::out(int address, unsigned endpoint, int toggle, const Bytes& bytes) {
  if (!listens(address)) return Handshake::kSilence;
  const std::uint32_t control = control_[endpoint];
  if ((control & 1u << 7) == 0) return Handshake::kSilence;
  if (endpoint != 0 && (control >> 2 & 3) != 3) misuse("endpoint 1 is no interrupt endpoint");
  if ((control & 1) != 0) return Handshake::kStall;
  prime(priming_);
  const std::size_t queue = 2 * endpoint;
  if ((ready_ & bit(queue)) == 0) return Handshake::kNak;
  if (toggle != toggle_[queue]) return Handshake::kAck;  // a repetition
  const auto size = static_cast<std::uint32_t>(bytes.size());
  const std::uint32_t left = word(head(queue) + kHeadToken) >> 16 & 0x7fff;
  if (size > left) return Handshake::kSilence;  // an overflow; the host's mistake on endpoint 0
  toggle_[queue] ^= 1;
  for (std::uint32_t i = 0; i < size; ++i) {
    const std::size_t at = data_address(queue, done_[queue] + i) - kMemoryBase;
    if (at < memory_.size()) memory_[at] = bytes[i];
  }
  done_[queue] += size;
  store(head(queue) + kHeadToken, word(head(queue) + kHeadToken) - (size << 16));
  if (size < 64 || left == size) retire(queue);
  return Handshake::kAck;
}

}  // namespace thimble::firmware_test
