#pragma once

#include <atomic>
#include <cstdint>

#include "compat/core/arm_channel.h"
#include "thimble/driver/device.h"
#include "thimble/driver/device_state.h"
#include "thimble/driver/force_law.h"
#include "thimble/driver/tick_record.h"

namespace thimble::compat {

/// The force of a program for another maker's arm, as a force law: the last requested force plus
/// the scene's force, before the gate. It runs on the servo thread; the program is another process,
/// for which no tick waits.
///
/// Rules: a force that is not renewed within the gate's `stall` counts as zero until it is. It then
/// returns as after a gap of the loop: within `reopen`, or `soft_start` if the gap was longer than
/// the arm's watchdog. No force is sent while the program has disabled the force; after it is
/// enabled, it rises within `soft_start`. The program's limits are at most the gate's.
class ClientForce {
 public:
  /// Takes the channel, the scene's law, and the device once it is open; all must outlive it.
  /// Real-time: never from the servo thread.
  /// `may_activate`: the program may end a fault by enabling the force. Only for a simulated arm: a
  /// real one needs the consent of a person.
  ClientForce(ArmChannel& channel, driver::ForceLaw scene, driver::Device& device,
              bool may_activate) noexcept;

  /// Returns the force of a tick. Real-time: safe.
  driver::ForceCommand operator()(const driver::DeviceState& state) noexcept;

  /// Returns the program's part of the newest tick, N in the world. Servo thread only.
  const Eigen::Vector3d& f_client_W() const noexcept { return f_client_W_; }
  /// Returns the number of the force taken by the newest tick. Servo thread only.
  std::uint64_t taken() const noexcept { return taken_; }
  /// Returns whether the program's force counts as zero because it was not renewed. Any thread.
  bool stalled() const noexcept { return stalled_.load(std::memory_order_relaxed); }
  /// Returns how often the program's force was not renewed. Any thread.
  std::uint64_t stalls() const noexcept { return stalls_.load(std::memory_order_relaxed); }
  /// Returns the number of ticks with a new request of the program. Any thread.
  std::uint64_t renewals() const noexcept { return renewals_.load(std::memory_order_relaxed); }

 private:
  void take(const driver::DeviceState& state) noexcept;
  Eigen::Vector3d own_part(const driver::DeviceState& state) noexcept;

  ArmChannel& channel_;
  driver::ForceLaw scene_;
  driver::Device& device_;
  driver::GateLimits limits_;
  bool may_activate_;
  Eigen::Vector3d f_asked_W_{0, 0, 0};
  Eigen::Vector3d f_client_W_{0, 0, 0};
  std::uint64_t taken_ = 0;
  std::int64_t renewed_ns_ = 0;  // time of the program's last request
  std::uint32_t enablings_;
  double opened_ = 0;       // opening of all force: 0 to 1
  double own_opened_ = 1;   // opening of the program's force: 0 to 1
  double own_opening_ = 0;  // duration of that opening, s
  std::atomic<bool> stalled_{false};
  std::atomic<std::uint64_t> stalls_{0};
  std::atomic<std::uint64_t> renewals_{0};
};

}  // namespace thimble::compat
