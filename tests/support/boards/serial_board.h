#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "simulated_arm.h"
#include "thimble/device_sim/usb/usb_arm.h"
#include "usb/setup_packet.h"
#include "usb/usb_description.h"

namespace thimble::support {

/// A simulated arm on a board with USB serial: all but its messages.
class SerialBoard : public device_sim::usb::UsbArm {
 public:
  static constexpr std::uint8_t kIn = 0x81, kOut = 0x02;

  const device_sim::usb::UsbDescription& description() const noexcept final { return description_; }
  device_sim::usb::PacketResult control(const device_sim::usb::SetupPacket&,
                                        std::span<std::byte>) noexcept final {
    return {device_sim::usb::Answer::kDone, 0};
  }
  device_sim::usb::ArmTruth truth() const noexcept final {
    device_sim::usb::ArmTruth truth;
    truth.currents = arm_.plant().currents();
    truth.p_BT = arm_.plant().p_BT();
    truth.motors_on = arm_.firmware().motors_on();
    return truth;
  }
  void lead_hand(const Eigen::Vector3d& p_BH) noexcept final { arm_.hand().lead(p_BH); }
  void hold_tip(bool held) noexcept final { arm_.hold_tip(held); }
  void restart_board() noexcept final { arm_.restart_board(); }
  driver::Result<void> fix_mass(double mass, const Eigen::Vector3d& gravity_B) final {
    return arm_.fix_mass(mass, gravity_B);
  }

 protected:
  explicit SerialBoard(device_sim::SimulatedArm arm) : arm_(std::move(arm)) {}

  device_sim::usb::UsbDescription description_;
  device_sim::SimulatedArm arm_;
};

}  // namespace thimble::support
