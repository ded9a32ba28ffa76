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

/// A simulated Falcon inside the program: the arm of `thimble plug falcon` with a simulated host
/// bus instead of the kernel. Before the path of the hand begins, the arm is booted, gets its
/// firmware and is homed by its own hand. This uses the same bytes as for a real one.
class THIMBLE_EXPORT SimulatedFalcon {
 public:
  /// Builds the arm, with motors and encoders of `model`, and brings it up. Its hand then rests at
  /// the first point of `path`, with time 0 before it. If `settings` has a hand without a spring,
  /// which could not home the arm, another one homes it and lets go. Any firmware is accepted;
  /// without one it generates some bytes. Fails like FalconOnUsb::make, or if the arm does not come
  /// up. Real-time: never from the servo thread.
  static driver::Result<std::unique_ptr<SimulatedFalcon>> make(
      const driver::JointModel<driver::DeltaArm>& model, const SimulatedArmSettings& settings,
      HandPath path, std::vector<std::byte> firmware, std::uint64_t seed = 0);

  /// Makes the wire to the arm. Its frames of a millisecond pass with the clock from time 0. Does
  /// not own clock or arm. Real-time: never from the servo thread.
  std::unique_ptr<driver::Transport> wire(driver::Clock& clock);

  /// Advances to `time_ns` of the clock with no host on the bus. Real-time: safe.
  void advance_to(std::int64_t time_ns) noexcept { falcon_->advance_to(begin_ns_ + time_ns); }

  /// From now on, the hand homes the arm whenever a host requests it. Real-time: safe.
  void home_when_asked() noexcept { falcon_->home_when_asked(); }
  /// Returns the hand. The caller that advances time may lead or hold it. Real-time: safe.
  Hand& hand() noexcept { return falcon_->hand(); }
  /// Sets the guessed watchdog of the board, ns; 0: none (FalconBoard). Real-time: safe.
  void set_watchdog(std::int64_t time_ns) noexcept { falcon_->set_watchdog(time_ns); }
  /// Returns the arm, for a bus other than that of `wire`. Real-time: safe.
  UsbArm& on_bus() noexcept { return *falcon_; }
  /// Returns the arm's own time (ns) at which its hand begins. Real-time: safe.
  std::int64_t begin_ns() const noexcept { return begin_ns_; }
  const FalconOnUsb& arm() const noexcept { return *falcon_; }  ///< Returns the arm.

 private:
  explicit SimulatedFalcon(std::unique_ptr<FalconOnUsb> falcon) : falcon_(std::move(falcon)) {}
  driver::Result<void> bring_up(std::vector<std::byte> firmware, const Eigen::Vector3d& p_BH);

  std::unique_ptr<FalconOnUsb> falcon_;
  std::int64_t begin_ns_ = 0;  // in the arm's own time
};

}  // namespace thimble::device_sim::usb
