#pragma once

#include "simulated_arm.h"
#include "thimble/driver/clock.h"
#include "thimble/driver/export.h"
#include "thimble/driver/transport.h"

namespace thimble::device_sim {

/// The wire to a simulated arm. Each exchange advances the arm's time to the clock's time. Does not
/// own the clock or the arm.
class THIMBLE_EXPORT SimTransport final : public driver::Transport {
 public:
  SimTransport(driver::Clock& clock, SimulatedArm& arm) noexcept : clock_(clock), arm_(arm) {}

  driver::TransportRead read_latest(std::span<std::byte> buffer,
                                    std::int64_t deadline_ns) noexcept override;
  driver::TransportStatus write(std::span<const std::byte> report) noexcept override;

  /// Unplugs the cable: every later exchange returns kLost, and the firmware gets no more messages.
  void unplug() noexcept { plugged_ = false; }

 private:
  driver::Clock& clock_;
  SimulatedArm& arm_;
  bool plugged_ = true;
};

}  // namespace thimble::device_sim
