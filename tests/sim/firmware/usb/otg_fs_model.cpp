#include "otg_fs_model.h"

#include <algorithm>
#include <cstring>
#include <string>

namespace thimble::firmware_test {
namespace {

constexpr std::uintptr_t kOtgBase = 0x50000000;
// Bits of GINTSTS that are cleared by writing one: MMIS, SOF, ESUSP, USBSUSP, USBRST, ENUMDNE,
// ISOODRP, EOPF, and the upper ones.
constexpr std::uint32_t kClearedByOne = 0xf030fc0a;
constexpr std::uint32_t kNak = 1u << 17, kOtgStall = 1u << 21, kOtgActive = 1u << 15;
constexpr std::uint32_t kOtgEnable = 1u << 31, kStored = 0x7ff | 3u << 18 | 15u << 22;

std::string hex(std::uintptr_t value) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (; value != 0; value >>= 4) text.insert(text.begin(), kDigits[value & 15]);
  return "0x" + text;
}

}  // namespace

void OtgFsModel::power_on() {
  in_ = {};
  out_ = {};
  in_[0].ctl = out_[0].ctl = kOtgActive;
  for (auto& fifo : tx_) fifo.clear();
  tx_size_.fill(0x02000200);
  received_.clear();
  popped_.clear();
  usb_config_ = 0x00001440;
  rx_size_ = 0x200;
  device_config_ = 0x02200000;
  status_ = core_config_ = ahb_config_ = device_ctl_ = clock_gating_ = speed_ = 0;
  address_ = 0;
  suspended_ = setup_stage_ = was_reset_ = false;
}

bool OtgFsModel::attached() const {
  const bool forced = (usb_config_ & 1u << 30) != 0, turnaround = (usb_config_ >> 10 & 15) == 6;
  const bool powered = (core_config_ & 1u << 16) != 0 && (core_config_ & 1u << 21) != 0;
  return forced && turnaround && powered && (device_config_ & 3) == 3 &&
         (device_ctl_ & 1u << 1) == 0 && (clock_gating_ & 3) == 0;
}

bool OtgFsModel::listens(int address) const {
  return attached() && was_reset_ && !suspended_ && address == address_;
}

std::uint32_t OtgFsModel::status() {
  // A forced mode takes effect later.
  if ((usb_config_ & 1u << 30) != 0 && mode_delay_ > 0) --mode_delay_;
  const bool host = (usb_config_ & 1u << 30) == 0 || mode_delay_ > 0;
  return status_ | (host ? 1 : 0) | (received_.empty() ? 0 : 1u << 4) | 1u << 5;
}

std::uint32_t OtgFsModel::read(std::uintptr_t address) {
  const std::uintptr_t at = address - kOtgBase;
  switch (at) {
    case 0x008:
      return ahb_config_;
    case 0x00c:
      return usb_config_;
    case 0x010:
      return 1u << 31;
    case 0x014:
      return status();
    case 0x020:
      return pop_status();
    case 0x038:
      return core_config_;
    case 0x800:
      return device_config_;
    case 0x804:
      return device_ctl_;
    case 0x808:
      return speed_ | (suspended_ ? 1 : 0);
    default:
      break;
  }
  if (at >= 0x900 && at < 0xd00) {
    const auto& endpoints = at < 0xb00 ? in_ : out_;
    const std::size_t number = (at - (at < 0xb00 ? 0x900 : 0xb00)) / 0x20;
    if (number < kEndpoints) {
      switch (at % 0x20) {
        case 0x00:
          return endpoints[number].ctl;
        case 0x08:
          return endpoints[number].events;
        case 0x10:
          return endpoints[number].size;
        case 0x18:
          return (tx_size_[number] >> 16) - static_cast<std::uint32_t>(tx_[number].size());
        default:
          break;
      }
    }
  }
  if (at >= 0x1000 && at < 0x5000) return pop_word();
  misuse("no register to read at " + hex(at));
  return 0;
}

void OtgFsModel::write(std::uintptr_t address, std::uint32_t value) {
  const std::uintptr_t at = address - kOtgBase;
  switch (at) {
    case 0x008:
      ahb_config_ = value;
      return;
    case 0x00c:
      if ((value & ~usb_config_ & 1u << 30) != 0) mode_delay_ = 5;
      usb_config_ = value;
      return;
    case 0x010:
      return reset_core(value);
    case 0x014:
      status_ &= ~(value & kClearedByOne);
      return;
    case 0x024:
      rx_size_ = value & 0xffff;
      return;
    case 0x028:
      tx_size_[0] = value;
      return;
    case 0x104:
    case 0x108:
    case 0x10c:
      tx_size_[(at - 0x100) / 4] = value;
      return;
    case 0x038:
      core_config_ = value;
      return;
    case 0x800:
      device_config_ = value;
      // Another address is used after the acknowledgement of the request that set it.
      if ((value >> 4 & 0x7f) == 0) address_ = 0;
      return;
    case 0x804:
      device_ctl_ = value & 0x2;
      return;
    case 0xe00:
      clock_gating_ = value;
      return;
    default:
      break;
  }
  if (at >= 0x900 && at < 0xd00) {
    const bool in = at < 0xb00;
    const std::size_t number = (at - (at < 0xb00 ? 0x900 : 0xb00)) / 0x20;
    if (number < kEndpoints) {
      switch (at % 0x20) {
        case 0x00:
          return write_ctl(number, in, value);
        case 0x08:
          (in ? in_ : out_)[number].events &= ~value;
          return;
        case 0x10:
          return write_size(number, in, value);
        default:
          break;
      }
    }
  }
  if (at >= 0x1000 && at < 0x5000) return write_fifo((at - 0x1000) / 0x1000, value);
  misuse("no register to write at " + hex(at));
}

void OtgFsModel::reset_core(std::uint32_t value) {
  if ((value & 1) != 0) power_on();
  if ((value & 1u << 4) != 0) received_.clear();
  if ((value & 1u << 5) == 0) return;
  const std::size_t number = value >> 6 & 31;
  for (std::size_t i = 0; i < kEndpoints; ++i) {
    if (number != 16 && number != i) continue;
    const bool busy = std::ranges::any_of(in_, [&](const Endpoint& endpoint) {
      return (endpoint.ctl & kOtgEnable) != 0 && (endpoint.ctl >> 22 & 15) == i;
    });
    if (busy) misuse("flush of the FIFO of an enabled endpoint");
    tx_[i].clear();
  }
}

void OtgFsModel::write_ctl(std::size_t number, bool in, std::uint32_t value) {
  Endpoint& endpoint = (in ? in_ : out_)[number];
  std::uint32_t& ctl = endpoint.ctl;
  const bool was_nak = (ctl & kNak) != 0;
  ctl = (ctl & ~kStored) | (value & kStored);
  if (number == 0) {
    ctl |= value & kOtgStall;  // cleared by the core
  } else {
    ctl = (ctl & ~(kOtgStall | kOtgActive)) | (value & (kOtgStall | kOtgActive));
    if ((value & 1u << 28) != 0) endpoint.toggle = 0;
    if ((value & 1u << 29) != 0) endpoint.toggle = 1;
  }
  if ((value & 1u << 26) != 0) ctl &= ~kNak;
  if ((value & 1u << 27) != 0) {
    ctl |= kNak;
    if (in) endpoint.events |= 1u << 6;
  }
  if ((value & 1u << 30) != 0) {
    if (!in) misuse("an OUT endpoint was disabled without global NAK");
    if (!was_nak) misuse("an IN endpoint was disabled before its NAK was effective");
    if ((ctl & kOtgEnable) == 0) misuse("an endpoint was disabled that was not enabled");
    ctl &= ~kOtgEnable;
    endpoint.events |= 1u << 1;
  } else if ((value & kOtgEnable) != 0) {
    if (endpoint.packets() == 0) misuse("an endpoint was enabled for no packet");
    ctl |= kOtgEnable;
  }
}

void OtgFsModel::write_size(std::size_t number, bool in, std::uint32_t value) {
  Endpoint& endpoint = (in ? in_ : out_)[number];
  const bool counts_setups = !in && number == 0;
  if ((endpoint.ctl & kOtgEnable) != 0 && !counts_setups) misuse("size of an enabled endpoint");
  // Endpoint 0 has 7 bits of size, and 2 or 1 of packets.
  const std::uint32_t mask = number != 0 ? 0x7fffffff
                             : in        ? 3u << 19 | 0x7f
                                         : 3u << 29 | 1u << 19 | 0x7f;
  if ((value & ~mask) != 0) misuse("reserved bits of a size were written");
  endpoint.size = value & mask;
}

void OtgFsModel::write_fifo(std::size_t number, std::uint32_t word) {
  const bool enabled = std::ranges::any_of(in_, [&](const Endpoint& endpoint) {
    return (endpoint.ctl & kOtgEnable) != 0 && (endpoint.ctl >> 22 & 15) == number;
  });
  if (!enabled) misuse("data for an endpoint that is not enabled");
  if (tx_[number].size() >= tx_size_[number] >> 16) return misuse("a FIFO overflows");
  tx_[number].push_back(word);
}

std::uint32_t OtgFsModel::pop_status() {
  if (!popped_.empty()) misuse("the next packet was taken before the data of the last one");
  if (received_.empty()) {
    misuse("a packet was taken from an empty FIFO");
    return 0;
  }
  const Entry entry = received_.front();
  received_.pop_front();
  popped_ = entry.words;
  Endpoint& endpoint = out_[entry.status & 15];
  const std::uint32_t kind = entry.status >> 17 & 15;
  if (kind == 3) endpoint.events |= 1;
  if (kind == 4) {
    endpoint.events |= 1u << 3;
    endpoint.ctl &= ~kOtgEnable;
  }
  return entry.status;
}

std::uint32_t OtgFsModel::pop_word() {
  if (popped_.empty()) {
    misuse("data were taken that no packet has");
    return 0;
  }
  const std::uint32_t word = popped_.front();
  popped_.pop_front();
  return word;
}

unsigned OtgFsModel::room() const {
  std::size_t used = popped_.size();
  for (const Entry& entry : received_) used += 1 + entry.words.size();
  return used < rx_size_ ? rx_size_ - static_cast<unsigned>(used) : 0;
}

void OtgFsModel::check_fifos() {
  std::uint32_t end = rx_size_;
  for (std::size_t i = 0; i < 2; ++i) {
    if ((tx_size_[i] & 0xffff) < end) misuse("FIFOs overlap");
    if (tx_size_[i] >> 16 < 16) misuse("a FIFO has fewer than 16 words");
    end = (tx_size_[i] & 0xffff) + (tx_size_[i] >> 16);
  }
  if (end > 320) misuse("the FIFOs need more than 320 words");
}

void OtgFsModel::begin_reset() {
  if (!attached()) return;
  check_fifos();
  was_reset_ = true;
  suspended_ = setup_stage_ = false;
  status_ |= 1u << 12;
  for (std::size_t i = 1; i < kEndpoints; ++i) {
    in_[i].ctl &= ~kOtgActive;
    out_[i].ctl &= ~kOtgActive;
  }
}

void OtgFsModel::end_reset() {
  if (!attached()) return;
  status_ |= 1u << 13;
  speed_ = 3u << 1;
}

void OtgFsModel::suspend() {
  if (!attached()) return;
  suspended_ = true;
  status_ |= 1u << 10 | 1u << 11;
}

void OtgFsModel::resume() {
  if (!suspended_) return;
  suspended_ = false;
  status_ |= 1u << 31;
}

void OtgFsModel::end_setup_stage() {
  if (!setup_stage_) return;
  setup_stage_ = false;
  received_.push_back({4u << 17, {}});
}

Handshake OtgFsModel::setup(int address, const std::array<std::uint8_t, 8>& packet) {
  if (!listens(address) || room() < 4) return Handshake::kSilence;
  if (out_[0].size >> 29 == 0)
    misuse("a setup packet that was not expected");
  else
    out_[0].size -= 1u << 29;
  Entry entry{8u << 4 | 6u << 17, {0, 0}};
  for (std::size_t i = 0; i < 2; ++i) std::memcpy(&entry.words[i], packet.data() + 4 * i, 4);
  received_.push_back(entry);
  setup_stage_ = true;
  for (Endpoint* endpoint : {&in_[0], &out_[0]}) {
    endpoint->ctl = (endpoint->ctl & ~kOtgStall) | kNak;
    endpoint->toggle = 1;
  }
  return Handshake::kAck;
}

unsigned OtgFsModel::packet_size(const Endpoint& endpoint, std::size_t number) const {
  return number == 0 ? 64u >> (endpoint.ctl & 3) : endpoint.ctl & 0x7ff;
}

InPacket OtgFsModel::in(int address, unsigned number) {
  InPacket packet;
  if (!listens(address)) return packet;
  Endpoint& endpoint = in_[number];
  if (number == 0) end_setup_stage();
  if ((endpoint.ctl & kOtgActive) == 0) return packet;
  if (number != 0 && (endpoint.ctl >> 18 & 3) != 3) misuse("endpoint 1 is no interrupt endpoint");
  packet.answer = Handshake::kStall;
  if ((endpoint.ctl & kOtgStall) != 0) return packet;
  packet.answer = Handshake::kNak;
  if ((endpoint.ctl & kNak) != 0 || (endpoint.ctl & kOtgEnable) == 0) return packet;
  auto& fifo = tx_[endpoint.ctl >> 22 & 15];
  const unsigned size = std::min(endpoint.bytes(), packet_size(endpoint, number));
  if (fifo.size() < (size + 3) / 4) return packet;
  packet.answer = Handshake::kAck;
  packet.toggle = endpoint.toggle;
  for (unsigned i = 0; i < size; ++i) {
    packet.bytes.push_back(static_cast<std::uint8_t>(fifo.front() >> 8 * (i % 4)));
    if (i % 4 == 3 || i + 1 == size) fifo.pop_front();
  }
  endpoint.toggle ^= 1;
  endpoint.size -= (1u << 19) + size;
  if (endpoint.packets() > 0) return packet;
  if (!fifo.empty()) misuse("more data than the size of the transfer");
  endpoint.ctl &= ~kOtgEnable;
  endpoint.events |= 1;
  if (number == 0) address_ = static_cast<int>(device_config_ >> 4 & 0x7f);
  return packet;
}

Handshake OtgFsModel::out(int address, unsigned number, int toggle, const Bytes& bytes) {
  if (!listens(address)) return Handshake::kSilence;
  Endpoint& endpoint = out_[number];
  if (number == 0) end_setup_stage();
  if ((endpoint.ctl & kOtgActive) == 0) return Handshake::kSilence;
  if ((endpoint.ctl & kOtgStall) != 0) return Handshake::kStall;
  if ((endpoint.ctl & kNak) != 0 || (endpoint.ctl & kOtgEnable) == 0) return Handshake::kNak;
  const unsigned size = static_cast<unsigned>(bytes.size());
  if (size > endpoint.bytes() || room() < 2 + (size + 3) / 4) return Handshake::kNak;
  if (toggle != endpoint.toggle) return Handshake::kAck;  // a repetition
  Entry entry{number | size << 4 | (toggle != 0 ? 2u << 15 : 0) | 2u << 17, {}};
  entry.words.resize((size + 3) / 4);
  for (unsigned i = 0; i < size; ++i) {
    entry.words[i / 4] |= static_cast<std::uint32_t>(bytes[i]) << 8 * (i % 4);
  }
  received_.push_back(entry);
  endpoint.toggle ^= 1;
  endpoint.size -= (1u << 19) + size;
  if (endpoint.packets() > 0 && size == packet_size(endpoint, number)) return Handshake::kAck;
  received_.push_back({number | 3u << 17, {}});
  endpoint.ctl = (endpoint.ctl & ~kOtgEnable) | kNak;
  return Handshake::kAck;
}

}  // namespace thimble::firmware_test
