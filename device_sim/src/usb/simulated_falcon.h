#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "thimble/driver/clock.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/driver/transport.h"
#include "usb/falcon_on_usb.h"

namespace thimble::device_sim::usb {

/// A simulated Falcon inside the program: the arm of `thimble plug falcon` with a host's bus in
/// place of the kernel. It is booted, takes firmware and is homed by its own hand through the very
/// bytes of a real one, before the path of the hand begins.
class THIMBLE_EXPORT SimulatedFalcon {
 public:
  /// Builds the arm, with motors and encoders of `model`, and brings it up; its hand then rests at
  /// the first point of `path`, with time 0 before it. Where `settings` has a hand without a
  /// spring, which could not home the arm, another one homes it and lets go. Any firmware will do;
  /// without one it takes some bytes of its own. Fails as FalconOnUsb::make does, or if the arm
  /// does not come up. Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<SimulatedFalcon>> make(
      const driver::JointModel<driver::DeltaArm>& model, const SimulatedArmSettings& settings,
      HandPath path, std::vector<std::byte> firmware, std::uint64_t seed = 0);

  /// Makes the wire to it, whose frames of a millisecond pass as the clock does from time 0. Keeps
  /// neither clock nor arm alive. Real-time: never from the servo thread.
  std::unique_ptr<driver::Transport> wire(driver::Clock& clock);

  /// Lets time pass up to `time_ns` of the clock with nobody on the bus. Real-time: safe.
  void advance_to(std::int64_t time_ns) noexcept { falcon_->advance_to(begin_ns_ + time_ns); }

  /// Lets the hand home the arm from now on whenever a host asks for it. Real-time: safe.
  void home_when_asked() noexcept { falcon_->home_when_asked(); }
  /// Returns the hand, to be led or held by whoever lets time pass. Real-time: safe.
  Hand& hand() noexcept { return falcon_->hand(); }
  /// Sets the guessed watchdog of the board, ns; 0: none (FalconBoard). Real-time: safe.
  void set_watchdog(std::int64_t time_ns) noexcept { falcon_->set_watchdog(time_ns); }
  /// Returns the arm, for another bus than `wire` makes. Real-time: safe.
  UsbArm& on_bus() noexcept { return *falcon_; }
  /// Returns the arm's own time (ns) at which its hand begins. Real-time: safe.
  std::int64_t begin_ns() const noexcept { return begin_ns_; }
  const FalconOnUsb& arm() const noexcept { return *falcon_; }  ///< Shows the arm.

 private:
  explicit SimulatedFalcon(std::unique_ptr<FalconOnUsb> falcon) : falcon_(std::move(falcon)) {}
  driver::Result<void> bring_up(std::vector<std::byte> firmware, const Eigen::Vector3d& p_BH);

  std::unique_ptr<FalconOnUsb> falcon_;
  std::int64_t begin_ns_ = 0;  // on the arm's own time
};

}  // namespace thimble::device_sim::usb
