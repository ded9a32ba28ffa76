#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "hand/hand.h"
#include "hand/hand_path.h"
#include "hand/tremor.h"
#include "plant/axis_dynamics.h"
#include "plant/inverse_plant.h"
#include "plant/loaded_tip.h"
#include "thimble/device_sim/usb/usb_arm.h"
#include "thimble/driver/export.h"
#include "usb/falcon_board.h"
#include "usb/ftdi_chip.h"
#include "usb/homing_hand.h"
#include "usb/setup_packet.h"
#include "usb/usb_description.h"

namespace thimble::device_sim::usb {

/// A simulated Novint Falcon with a USB plug: FTDI converter, board, delta mechanics and a hand.
/// Bytes of the host reach the board at the line's rate. The board samples the encoders when a
/// packet is complete. Its answer goes to the host when the latency timer of 1 ms has expired.
class THIMBLE_EXPORT FalconOnUsb final : public UsbArm {
 public:
  /// Makes the arm at rest at the path's first point, with motors and encoders of `model`. Of the
  /// settings it uses plant, hand, weight and wiring; board and bus are its own. `image` is the
  /// firmware that it can run; empty: any. Fails like DeltaPlant::make. Real-time: never from the
  /// servo thread.
  static driver::Result<std::unique_ptr<FalconOnUsb>> make(
      UsbDescription description, const driver::JointModel<driver::DeltaArm>& model,
      const SimulatedArmSettings& settings, HandPath path, std::vector<std::byte> image,
      std::uint64_t seed = 0);

  /// Sets another path of the hand, whose time 0 is now. Real-time: never from the servo thread.
  void lead(HandPath path);
  /// From now on, the hand homes the arm whenever a host requests it; its own path waits meanwhile.
  /// A hand that has let go takes the tip for that time. Real-time: safe.
  void home_when_asked() noexcept { homes_ = true; }
  /// Returns the hand. The caller that advances time may lead or hold it. Real-time: safe.
  Hand& hand() noexcept { return hand_; }
  /// Replaces the hand on the tip by one with other constants, which no longer homes the arm. Fails
  /// if they are out of range. Real-time: never from the servo thread.
  driver::Result<void> take_hand(const HandSettings& hand);
  void lead_hand(const Eigen::Vector3d& p_BH) noexcept override { hand_.lead(p_BH); }
  void hold_tip(bool held) noexcept override;
  void restart_board() noexcept override { board_.restart(); }
  driver::Result<void> fix_mass(double mass, const Eigen::Vector3d& gravity_B) override;
  /// Sets the guessed watchdog of the board, ns; 0: none (FalconBoard). Real-time: safe.
  void set_watchdog(std::int64_t time_ns) noexcept { board_.set_watchdog(time_ns); }

  const UsbDescription& description() const noexcept override { return description_; }
  void advance_to(std::int64_t time_ns) noexcept override;
  PacketResult control(const SetupPacket& setup, std::span<std::byte> data) noexcept override;
  PacketResult in(std::uint8_t address, std::span<std::byte> packet) noexcept override;
  PacketResult out(std::uint8_t address, std::span<const std::byte> packet) noexcept override;
  ArmTruth truth() const noexcept override;

  // For tests. Real-time: safe.
  const FalconBoard& board() const noexcept { return board_; }  ///< Returns the board.
  const FtdiChip& chip() const noexcept { return chip_; }       ///< Returns the converter.
  const DeltaPlant& plant() const noexcept { return plant_; }

 private:
  FalconOnUsb(UsbDescription description, const SimulatedArmSettings& settings,
              const Tremor& tremor, HandPath path, const DeltaPlant& plant, const LoadedTip& tip,
              std::vector<std::byte> image);
  void put_tip() noexcept;
  void move_to(std::int64_t time_ns) noexcept;
  void hear_line(std::int64_t dt_ns) noexcept;

  UsbDescription description_;
  Tremor tremor_;
  Hand hand_;
  HomingHand homing_hand_;
  bool homes_ = false;
  LoadedTip tip_;
  bool wanted_held_ = true, held_ = true;  // as requested; homing takes the tip as well
  WiringSettings wiring_;
  DeltaPlant plant_;
  FalconBoard board_;
  FtdiChip chip_;
  ArmTruth truth_;
  std::int64_t time_ns_ = 0;
  std::uint64_t packets_ = 0;
};

}  // namespace thimble::device_sim::usb
