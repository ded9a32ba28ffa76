#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "thimble/device_sim/simulated_arm.h"
#include "thimble/device_sim/usb/usb_arm.h"

namespace thimble::device_sim::usb {

/// Is what the reports of a HID arm look like. All hold little-endian 16-bit words.
enum class HidLayout : std::uint8_t {
  kWoodenHaptics,  ///< 8 bytes: 3 counts and a counter in; 3 currents (mA) and an unused word out.
  kPolhem,         ///< 14 bytes, as thimble/driver/arms/hfab/hfab_report.h has them.
  kPolhemPadded,   ///< The same in 64 bytes, as boards built on the Teensy send them.
};

/// Is a simulated arm on a HID plug: descriptors, reports in the arm's own layout, and behind them
/// plant, hand and firmware of SimulatedArm. Reports go out on interrupt endpoint 0x81, messages
/// come in on 0x01, both every frame.
class HidArm final : public UsbArm {
 public:
  /// Throws as SimulatedArm does. Real-time: never from the servo thread.
  HidArm(HidLayout layout, UsbDescription description, const driver::hfab::HfabModel& model,
         const SimulatedArmSettings& settings, HandPath path, std::uint64_t seed = 0);
  /// Makes an arm with a linkage in the same way.
  HidArm(HidLayout layout, UsbDescription description,
         const driver::JointModel<driver::LinkageArm>& model, const SimulatedArmSettings& settings,
         HandPath path, std::uint64_t seed = 0);

  const UsbDescription& description() const noexcept override { return description_; }
  void advance_to(std::int64_t time_ns) noexcept override;
  PacketResult control(const SetupPacket& setup, std::span<std::byte> data) noexcept override;
  PacketResult in(std::uint8_t address, std::span<std::byte> packet) noexcept override;
  PacketResult out(std::uint8_t address, std::span<const std::byte> packet) noexcept override;
  ArmTruth truth() const noexcept override;

  /// Shows the arm behind the plug. Real-time: safe.
  const SimulatedArm& arm() const noexcept { return arm_; }
  /// Tells how many messages had a length that the board does not know. Real-time: safe.
  std::uint64_t malformed() const noexcept { return malformed_; }
  /// Tells the bytes of a report. Real-time: safe.
  std::size_t report_size() const noexcept;

 private:
  /// Holds where the encoders really stood when a report was sampled.
  struct Sample {
    std::int64_t time_ns = -1;
    Eigen::Vector3d exact_counts{0, 0, 0};
  };
  static constexpr std::size_t kSamples = 8;

  void keep_sample() noexcept;
  std::size_t lay_out(std::span<const std::byte> report, std::span<std::byte> packet) noexcept;
  bool message(std::span<const std::byte> bytes) noexcept;

  HidLayout layout_;
  UsbDescription description_;
  driver::hfab::HfabModel model_;  // motors and encoders of either build
  std::int64_t report_age_ns_;
  SimulatedArm arm_;
  ArmTruth truth_;
  std::array<Sample, kSamples> samples_;
  std::array<std::byte, UsbDevice::kPacketMax> last_report_{};
  std::uint64_t malformed_ = 0;
  std::uint16_t counter_ = 0;
  std::uint8_t idle_ = 0;
};

}  // namespace thimble::device_sim::usb
