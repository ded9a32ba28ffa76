#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>

#include "device_model.h"

namespace thimble::firmware_test {

/// A USB host with one device: control transfers and reports. It runs the board between tokens, and
/// counts answers that break the protocol (USB 2.0, chapter 8).
class UsbHost {
 public:
  UsbHost(DeviceModel& device, std::function<void()> run_board)
      : device_(device), run_board_(std::move(run_board)) {}

  /// Resets the bus. The device has address 0 and its endpoints of reports are closed.
  void reset();

  /// A control transfer with data to the host. Returns nothing if the device stalls.
  std::optional<Bytes> read(std::uint8_t type, std::uint8_t request, std::uint16_t value,
                            std::uint16_t length);
  /// A control transfer without data. Returns false if the device stalls.
  bool command(std::uint8_t type, std::uint8_t request, std::uint16_t value,
               std::uint16_t index = 0);
  /// Only the setup packet of a control transfer, which the host then abandons.
  Handshake begin(std::uint8_t type, std::uint8_t request, std::uint16_t value,
                  std::uint16_t length);

  std::optional<Bytes> descriptor(std::uint8_t kind, std::uint8_t index = 0,
                                  std::uint16_t length = 255) {
    return read(kind >= 0x20 ? 0x81 : 0x80, 6, static_cast<std::uint16_t>(kind << 8 | index),
                length);
  }
  std::string text(std::uint8_t index);

  /// Reads the descriptors, gives an address and selects the configuration, as an operating system
  /// does. Returns whether everything was answered.
  bool enumerate();

  /// Asks for a report once. Returns nothing if the device has none.
  std::optional<Bytes> report();
  /// Sends a message as a report of 64 bytes once.
  Handshake send(Bytes message);
  /// Returns the toggle of the next message.
  int toggle_out() const noexcept { return toggle_out_; }
  /// Ends a halt of both endpoints of reports: they begin with DATA0.
  bool clear_halts();

  /// Answers that break the protocol.
  const std::vector<std::string>& violations() const noexcept { return violations_; }

 private:
  // A board answers within this number of passes of its loop. [chosen]
  static constexpr int kPatience = 50;

  InPacket poll(unsigned endpoint);
  bool acknowledge_out();
  void expect(bool right, const char* text) {
    if (!right) violations_.emplace_back(text);
  }

  DeviceModel& device_;
  std::function<void()> run_board_;
  int address_ = 0, toggle_in_ = 0, toggle_out_ = 0;
  std::vector<std::string> violations_;
};

}  // namespace thimble::firmware_test
