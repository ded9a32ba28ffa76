#pragma once

#include <deque>

#include "device_model.h"

namespace thimble::firmware_test {

/// OTG_FS core of the STM32F405 as a device, without DMA [M ST RM0090 revision 19, 34.16 and
/// 34.17]. The pins of bus voltage and ID are not connected: without the bits that replace them,
/// the core is a host.
class OtgFsModel final : public DeviceModel {
 public:
  OtgFsModel() { power_on(); }

  std::uint32_t read(std::uintptr_t address) override;
  void write(std::uintptr_t address, std::uint32_t value) override;
  void begin_reset() override;
  void end_reset() override;
  void suspend() override;
  void resume() override;
  Handshake setup(int address, const std::array<std::uint8_t, 8>& packet) override;
  InPacket in(int address, unsigned endpoint) override;
  Handshake out(int address, unsigned endpoint, int toggle, const Bytes& bytes) override;

 private:
  static constexpr std::size_t kEndpoints = 4;
  struct Endpoint {
    std::uint32_t ctl = 0, events = 0, size = 0;
    int toggle = 0;
    unsigned packets() const noexcept { return size >> 19 & 0x3ff; }
    unsigned bytes() const noexcept { return size & 0x7ffff; }
  };
  struct Entry {
    std::uint32_t status;
    std::deque<std::uint32_t> words;
  };

  void power_on();
  void reset_core(std::uint32_t value);
  void write_ctl(std::size_t number, bool in, std::uint32_t value);
  void write_size(std::size_t number, bool in, std::uint32_t value);
  void write_fifo(std::size_t number, std::uint32_t word);
  std::uint32_t pop_status();
  std::uint32_t pop_word();
  std::uint32_t status();
  bool attached() const;
  bool listens(int address) const;
  void check_fifos();
  unsigned room() const;
  void end_setup_stage();
  unsigned packet_size(const Endpoint& endpoint, std::size_t number) const;

  std::array<Endpoint, kEndpoints> in_, out_;
  std::array<std::deque<std::uint32_t>, kEndpoints> tx_;
  std::array<std::uint32_t, kEndpoints> tx_size_{};
  std::deque<Entry> received_;
  std::deque<std::uint32_t> popped_;
  std::uint32_t usb_config_ = 0, core_config_ = 0, status_ = 0, rx_size_ = 0, ahb_config_ = 0;
  std::uint32_t device_config_ = 0, device_ctl_ = 0, clock_gating_ = 0, speed_ = 0;
  int address_ = 0, mode_delay_ = 0;
  bool suspended_ = false, setup_stage_ = false, was_reset_ = false;
};

}  // namespace thimble::firmware_test
