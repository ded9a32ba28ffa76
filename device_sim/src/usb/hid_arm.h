#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "arms/hfab/hfab_report.h"
#include "simulated_arm.h"
#include "thimble/device_sim/usb/usb_arm.h"
#include "usb/hid_board.h"
#include "usb/setup_packet.h"
#include "usb/usb_description.h"
#include "wires/wire_table.h"

namespace thimble::device_sim::usb {

/// A simulated arm with a HID plug: descriptors, reports as its board sends them, and behind them
/// plant, hand and firmware of SimulatedArm. Each endpoint moves at most one packet per frame.
class HidArm final : public UsbArm {
 public:
  /// Makes the arm; fails like SimulatedArm::make. Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<HidArm>> make(
      const HidBoard& board, UsbDescription description,
      const driver::JointModel<driver::SerialArm>& model, const SimulatedArmSettings& settings,
      HandPath path, std::uint64_t seed = 0);
  /// As above, for an arm with a linkage.
  static driver::Result<std::unique_ptr<HidArm>> make(
      const HidBoard& board, UsbDescription description,
      const driver::JointModel<driver::LinkageArm>& model, const SimulatedArmSettings& settings,
      HandPath path, std::uint64_t seed = 0);
  /// As above, for an arm of any geometry that SimulatedArm makes.
  static driver::Result<std::unique_ptr<HidArm>> make(const HidBoard& board,
                                                      UsbDescription description,
                                                      const driver::ArmModel& model,
                                                      const SimulatedArmSettings& settings,
                                                      HandPath path, std::uint64_t seed = 0);

  const UsbDescription& description() const noexcept override { return description_; }
  void advance_to(std::int64_t time_ns) noexcept override;
  PacketResult control(const SetupPacket& setup, std::span<std::byte> data) noexcept override;
  PacketResult in(std::uint8_t address, std::span<std::byte> packet) noexcept override;
  PacketResult out(std::uint8_t address, std::span<const std::byte> packet) noexcept override;
  ArmTruth truth() const noexcept override;
  void lead_hand(const Eigen::Vector3d& p_BH) noexcept override { arm_.hand().lead(p_BH); }
  void hold_tip(bool held) noexcept override { arm_.hold_tip(held); }
  void restart_board() noexcept override;
  driver::Result<void> fix_mass(double mass, const Eigen::Vector3d& gravity_B) override {
    return arm_.fix_mass(mass, gravity_B);
  }

  /// Returns the arm behind the plug. Real-time: safe.
  const SimulatedArm& arm() const noexcept { return arm_; }
  /// Returns the number of messages with a length unknown to the board. Real-time: safe.
  std::uint64_t malformed() const noexcept { return malformed_; }
  /// Returns the kind of board. Real-time: safe.
  const HidBoard& board() const noexcept { return board_; }
  /// Returns the size of a report, bytes. Real-time: safe.
  std::size_t report_size() const noexcept {
    return wire_ ? wire_->report.padded : board_.report_size();
  }

 private:
  /// True encoder positions when a report was sampled.
  struct Sample {
    std::int64_t time_ns = -1;
    Eigen::Vector3d exact_counts{0, 0, 0};
  };
  static constexpr std::size_t kSamples = 8;

  HidArm(const HidBoard& board, UsbDescription description, const driver::ArmModel& model,
         const SimulatedArmSettings& settings, SimulatedArm arm) noexcept;
  Sample sample_now() const noexcept;
  void keep_sample() noexcept;
  bool newest(BoardBytes& report) noexcept;
  bool offered(BoardBytes& report) noexcept;
  void offer() noexcept;
  void use_message(std::span<const std::byte> bytes) noexcept;
  void note_counts(std::span<const std::byte> report) noexcept;
  std::size_t lay_out(std::span<const std::byte> report, std::span<std::byte> packet) noexcept;

  std::size_t message_size() const noexcept {
    return wire_ ? wire_->command.padded : board_.report_size();
  }

  HidBoard board_;
  std::shared_ptr<const driver::WireTable> wire_;  // null unless it is described
  UsbDescription description_;
  driver::ArmModel model_;
  std::int64_t report_age_ns_;
  SimulatedArm arm_;
  ArmTruth truth_;
  std::array<Sample, kSamples> samples_;
  // For a board that only answers: the report that waits for the host, and a message that arrived
  // meanwhile.
  BoardBytes report_{};
  Sample report_sample_;
  bool offers_ = false;
  std::array<std::byte, UsbDevice::kPacketMax> message_{};
  std::size_t message_size_ = 0;
  bool message_waits_ = false;
  std::uint64_t malformed_ = 0;
  std::uint16_t counter_ = 0;
};

}  // namespace thimble::device_sim::usb
