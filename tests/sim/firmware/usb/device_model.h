#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace thimble::firmware_test {

using Bytes = std::vector<std::uint8_t>;

/// Answer of a USB device to a token.
enum class Handshake { kAck, kNak, kStall, kSilence };

/// Answer of a USB device to an IN token.
struct InPacket {
  Handshake answer = Handshake::kSilence;  ///< kAck: there are data.
  int toggle = 0;                          ///< 0: DATA0, 1: DATA1.
  Bytes bytes;
};

/// Model of a USB device controller: its registers on one side, the bus on the other. It is written
/// from the manual of the chip and shares nothing with the driver.
class DeviceModel {
 public:
  DeviceModel() = default;
  DeviceModel(const DeviceModel&) = delete;
  DeviceModel& operator=(const DeviceModel&) = delete;
  virtual ~DeviceModel() = default;

  virtual std::uint32_t read(std::uintptr_t address) = 0;
  virtual void write(std::uintptr_t address, std::uint32_t value) = 0;

  /// A reset of the bus. Between both calls the board runs.
  virtual void begin_reset() = 0;
  virtual void end_reset() = 0;
  virtual void suspend() = 0;
  virtual void resume() = 0;
  /// A transaction on the bus. The host acknowledges each packet.
  virtual Handshake setup(int address, const std::array<std::uint8_t, 8>& packet) = 0;
  virtual InPacket in(int address, unsigned endpoint) = 0;
  virtual Handshake out(int address, unsigned endpoint, int toggle, const Bytes& bytes) = 0;

  /// Uses of the registers that the manual forbids, as text. Empty after a correct program.
  const std::vector<std::string>& misuses() const noexcept { return misuses_; }

 protected:
  void misuse(std::string text) {
    if (misuses_.size() < 20) misuses_.push_back(std::move(text));
  }

 private:
  std::vector<std::string> misuses_;
};

}  // namespace thimble::firmware_test
