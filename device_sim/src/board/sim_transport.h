#pragma once

#include "simulated_arm.h"
#include "thimble/driver/clock.h"
#include "thimble/driver/export.h"
#include "thimble/driver/transport.h"

namespace thimble::device_sim {

/// The wire to a simulated arm: moves the arm's time to the clock's time at each exchange. Keeps
/// neither the clock nor the arm alive.
class THIMBLE_EXPORT SimTransport final : public driver::Transport {
 public:
  SimTransport(driver::Clock& clock, SimulatedArm& arm) noexcept : clock_(clock), arm_(arm) {}

  driver::TransportRead read_latest(std::span<std::byte> buffer,
                                    std::int64_t deadline_ns) noexcept override;
  driver::TransportStatus write(std::span<const std::byte> report) noexcept override;

  /// Pulls the cable: every later exchange says kLost, and the firmware is on its own.
  void unplug() noexcept { plugged_ = false; }

 private:
  driver::Clock& clock_;
  SimulatedArm& arm_;
  bool plugged_ = true;
};

}  // namespace thimble::device_sim
