#pragma once

#include <span>

#include "device_model.h"

namespace thimble::firmware_test {

/// Controller USB1 of the i.MX RT1062 as a device, with its PLL and transceiver [M NXP IMXRT1060RM
/// revision 3, chapters 42, 43 and 14.8]. It reads queue heads, transfer descriptors and data from
/// memory as they were at the last completion of writes, as a bus master may.
class ImxUsbModel final : public DeviceModel {
 public:
  /// `memory` is all that the controller can reach; it begins at a multiple of 4096 bytes.
  explicit ImxUsbModel(std::span<std::uint8_t> memory) : memory_(memory) { power_on(); }

  std::uint32_t read(std::uintptr_t address) override;
  void write(std::uintptr_t address, std::uint32_t value) override;
  void begin_reset() override;
  void end_reset() override;
  void suspend() override;
  void resume() override;
  Handshake setup(int address, const std::array<std::uint8_t, 8>& packet) override;
  InPacket in(int address, unsigned endpoint) override;
  Handshake out(int address, unsigned endpoint, int toggle, const Bytes& bytes) override;

  std::uint32_t bus_address(const volatile void* object);
  void complete_writes() { visible_.assign(memory_.begin(), memory_.end()); }
  /// The next bus is one of full speed, such as behind an old hub.
  void connect_to_full_speed() noexcept { full_speed_ = true; }

 private:
  static constexpr std::size_t kQueues = 4;  // OUT and IN of two endpoints

  void power_on();
  bool attached() const;
  bool listens(int address) const;
  void prime(std::uint32_t bits);
  void load(std::size_t queue);
  void retire(std::size_t queue);
  std::uint32_t word(std::uint32_t bus) const;
  void store(std::uint32_t bus, std::uint32_t value);
  std::uint32_t data_address(std::size_t queue, std::uint32_t done) const;
  static std::uint32_t bit(std::size_t queue) { return 1u << (queue / 2 + queue % 2 * 16); }
  std::uint32_t head(std::size_t queue) const {
    return list_ + 64 * static_cast<std::uint32_t>(queue);
  }

  std::span<std::uint8_t> memory_;
  Bytes visible_;
  std::uint32_t pll_ = 0, supply_ = 0, phy_ctl_ = 0, phy_power_ = 0;
  std::uint32_t command_ = 0, status_ = 0, mode_ = 0, list_ = 0, port_ = 0, address_register_ = 0;
  std::uint32_t setup_status_ = 0, priming_ = 0, ready_ = 0, complete_ = 0;
  std::array<std::uint32_t, 2> control_{};
  std::array<int, kQueues> toggle_{};
  std::array<std::uint32_t, kQueues> done_{};  // bytes of the transfer
  int address_ = 0;
  bool suspended_ = false, was_reset_ = false, full_speed_ = false;
};

}  // namespace thimble::firmware_test
