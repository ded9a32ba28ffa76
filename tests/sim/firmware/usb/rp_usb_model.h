#pragma once

#include "device_model.h"

namespace thimble::firmware_test {

/// USB controller of the RP2040 as a device [M RP2040 datasheet, 4.1]: its memory with buffer
/// controls, which have another clock, and its registers.
class RpUsbModel final : public DeviceModel {
 public:
  std::uint32_t read(std::uintptr_t address) override;
  void write(std::uintptr_t address, std::uint32_t value) override;
  void begin_reset() override;
  void end_reset() override {}
  void suspend() override;
  void resume() override;
  Handshake setup(int address, const std::array<std::uint8_t, 8>& packet) override;
  InPacket in(int address, unsigned endpoint) override;
  Handshake out(int address, unsigned endpoint, int toggle, const Bytes& bytes) override;

  /// Lets the clock of the controller see the last writes.
  void wait_cycles() { settled_ = ram_; }

 private:
  static constexpr std::size_t kWords = 1024;

  bool attached() const;
  bool listens(int address) const;
  bool open(unsigned endpoint, bool in);
  std::size_t data_word(unsigned endpoint, bool in) const;
  void end_buffer(unsigned endpoint, bool in);
  bool stalls(unsigned endpoint, bool in) const;
  static std::size_t control_word(unsigned endpoint, bool in) {
    return 0x20 + 2 * endpoint + (in ? 0 : 1);
  }

  std::array<std::uint32_t, kWords> ram_{}, settled_{};
  std::uint32_t address_ = 0, main_ = 0, sie_ = 0, status_ = 0, done_ = 0, stall_ = 0;
  std::uint32_t muxing_ = 0, power_ = 0;
  bool suspended_ = false, was_reset_ = false;
};

}  // namespace thimble::firmware_test
