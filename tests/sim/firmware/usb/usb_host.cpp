#include "usb_host.h"

namespace thimble::firmware_test {

void UsbHost::reset() {
  device_.begin_reset();
  run_board_();
  device_.end_reset();
  run_board_();
  address_ = toggle_in_ = toggle_out_ = 0;
}

Handshake UsbHost::begin(std::uint8_t type, std::uint8_t request, std::uint16_t value,
                         std::uint16_t length) {
  const Handshake answer = device_.setup(
      address_,
      {type, request, static_cast<std::uint8_t>(value), static_cast<std::uint8_t>(value >> 8), 0, 0,
       static_cast<std::uint8_t>(length), static_cast<std::uint8_t>(length >> 8)});
  expect(answer == Handshake::kAck, "a setup packet was not acknowledged");
  run_board_();
  return answer;
}

InPacket UsbHost::poll(unsigned endpoint) {
  InPacket packet;
  for (int i = 0; i < kPatience; ++i) {
    packet = device_.in(address_, endpoint);
    run_board_();
    if (packet.answer != Handshake::kNak) break;
  }
  return packet;
}

bool UsbHost::acknowledge_out() {
  for (int i = 0; i < kPatience; ++i) {
    const Handshake answer = device_.out(address_, 0, 1, {});
    run_board_();
    if (answer != Handshake::kNak) return answer == Handshake::kAck;
  }
  return false;
}

std::optional<Bytes> UsbHost::read(std::uint8_t type, std::uint8_t request, std::uint16_t value,
                                   std::uint16_t length) {
  if (begin(type, request, value, length) != Handshake::kAck) return {};
  Bytes bytes;
  int toggle = 1;
  while (bytes.size() < length) {
    const InPacket packet = poll(0);
    if (packet.answer == Handshake::kStall) return {};
    expect(packet.answer == Handshake::kAck, "a request was not answered");
    if (packet.answer != Handshake::kAck) return {};
    expect(packet.toggle == toggle, "an answer has the wrong toggle");
    toggle ^= 1;
    bytes.insert(bytes.end(), packet.bytes.begin(), packet.bytes.end());
    if (packet.bytes.size() < 64) break;
  }
  expect(bytes.size() <= length, "an answer is longer than the host asked for");
  expect(acknowledge_out(), "the host could not acknowledge an answer");
  return bytes;
}

bool UsbHost::command(std::uint8_t type, std::uint8_t request, std::uint16_t value,
                      std::uint16_t index) {
  const Handshake answer = device_.setup(
      address_,
      {type, request, static_cast<std::uint8_t>(value), static_cast<std::uint8_t>(value >> 8),
       static_cast<std::uint8_t>(index), static_cast<std::uint8_t>(index >> 8), 0, 0});
  expect(answer == Handshake::kAck, "a setup packet was not acknowledged");
  run_board_();
  const InPacket packet = poll(0);
  if (packet.answer == Handshake::kStall) return false;
  expect(packet.answer == Handshake::kAck, "a request was not acknowledged");
  if (packet.answer != Handshake::kAck) return false;
  expect(packet.toggle == 1 && packet.bytes.empty(), "an acknowledgement is no empty DATA1");
  return true;
}

std::string UsbHost::text(std::uint8_t index) {
  const auto bytes = descriptor(3, index);
  std::string text;
  if (!bytes) return text;
  for (std::size_t i = 2; i < bytes->size(); i += 2) text += static_cast<char>((*bytes)[i]);
  return text;
}

bool UsbHost::enumerate() {
  reset();
  if (!descriptor(1, 0, 8)) return false;
  reset();
  if (!command(0, 5, 17)) return false;
  address_ = 17;
  if (!descriptor(1) || !descriptor(2, 0, 9) || !descriptor(2) || !descriptor(3, 0)) return false;
  if (!command(0, 9, 1)) return false;
  toggle_in_ = toggle_out_ = 0;
  return command(0x21, 0x0a, 0) && descriptor(0x22).has_value();
}

std::optional<Bytes> UsbHost::report() {
  const InPacket packet = device_.in(address_, 1);
  if (packet.answer == Handshake::kNak) return {};
  expect(packet.answer == Handshake::kAck, "a report was refused");
  if (packet.answer != Handshake::kAck) return {};
  // A repetition.
  expect(packet.toggle == toggle_in_, "a report has the wrong toggle");
  toggle_in_ ^= 1;
  return packet.bytes;
}

Handshake UsbHost::send(Bytes message) {
  message.resize(64);
  const Handshake answer = device_.out(address_, 1, toggle_out_, message);
  if (answer == Handshake::kAck) toggle_out_ ^= 1;
  return answer;
}

bool UsbHost::clear_halts() {
  toggle_in_ = toggle_out_ = 0;
  return command(0x02, 1, 0, 0x81) && command(0x02, 1, 0, 0x01);
}

}  // namespace thimble::firmware_test
