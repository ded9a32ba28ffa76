#pragma once

#include <stddef.h>
#include <stdint.h>

namespace thimble {
namespace firmware {

/// Answer to a control request.
struct UsbReply {
  enum Kind : uint8_t {
    kStall,        ///< The request is not supported.
    kSend,         ///< Send the data; then the host acknowledges.
    kAcknowledge,  ///< No data; acknowledge.
    kSetAddress,   ///< As kAcknowledge; afterwards use `address`.
    /// As kAcknowledge; afterwards the endpoints of reports are open and begin with DATA0.
    kOpenEndpoints,
  };
  Kind kind = kStall;
  const uint8_t* data = nullptr;
  uint16_t size = 0;
  bool ends_empty = false;  ///< An empty packet follows, because the host asked for more.
  uint8_t address = 0;
};

/// A USB device with one HID interface: reports of 64 bytes on endpoint 1 in both directions, and
/// the self-description of the arm as its feature report. It answers control requests and leaves
/// packets to the driver of the chip. Independent of the chip.
class HidDevice {
 public:
  static constexpr uint8_t kEndpoint = 1;      ///< Number of the endpoints for reports.
  static constexpr uint16_t kPacketSize = 64;  ///< Bytes of a packet, also on endpoint 0.
  static constexpr uint8_t kInterval_ms = 1;   ///< Polling interval, the shortest at full speed.
  /// Polling interval at high speed: 2^(n - 1) microframes of 125 us, here 4 kHz.
  static constexpr uint8_t kHighSpeedInterval = 2;

  /// `product` is the product string, ASCII, at most kTextMax characters; `serial` has 8 bytes.
  HidDevice(const char* product, const uint8_t* serial) noexcept;

  /// Answers a control request: the 8 bytes of a setup packet. Accepts any bytes. The data of the
  /// reply are valid until the next call.
  UsbReply setup(const uint8_t* packet) noexcept;

  /// Takes a bus reset.
  void reset() noexcept { configured_ = suspended_ = false; }

  /// Takes the beginning and the end of a suspension: an idle bus, or an unplugged cable.
  void suspend() noexcept { suspended_ = true; }
  void resume() noexcept { suspended_ = false; }
  bool suspended() const noexcept { return suspended_; }

  /// Declares that the controller supports high speed. Call it before the bus is connected.
  void offer_high_speed() noexcept { offers_high_speed_ = true; }
  /// Sets the speed of the bus after a reset; full speed is the default.
  void set_high_speed(bool high_speed) noexcept { high_speed_ = high_speed; }

  /// Returns whether the host has selected the configuration.
  bool configured() const noexcept { return configured_; }
  /// Returns whether reports can be exchanged.
  bool connected() const noexcept { return configured_ && !suspended_; }

  /// Sets the feature report, kPacketSize bytes.
  void set_feature(const uint8_t* report) noexcept;

  /// Longest text of a string descriptor, characters.
  static constexpr size_t kTextMax = 40;

 private:
  UsbReply descriptor(uint8_t type, uint8_t index) noexcept;
  UsbReply text(const char* text) noexcept;
  UsbReply configuration(uint8_t type, bool high_speed) noexcept;

  const char* product_;
  char serial_[17];
  uint8_t feature_[kPacketSize] = {};
  uint8_t answer_[2 + 2 * kTextMax];
  bool configured_ = false, suspended_ = false;
  bool offers_high_speed_ = false, high_speed_ = false;
};

}  // namespace firmware
}  // namespace thimble
