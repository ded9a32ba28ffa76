#pragma once

#include <Eigen/Core>
#include <atomic>
#include <cstdint>

#include "ros2/ros_peer.h"
#include "thimble/driver/device_state.h"
#include "thimble/driver/force_law.h"
#include "thimble/driver/safety_gate.h"
#include "thimble/session/histogram.h"

namespace thimble::ros2 {

/// The force received by a topic, as a force law before the gate, added to the scene's or instead
/// of it. It runs on the servo thread, which never waits.
///
/// A force is limited and counts for `stale_ns` after its arrival. It then becomes zero at once,
/// until a new one arrives. The new one rises within the gate's `reopen`, or `soft_start` if the
/// pause was longer than the arm's watchdog. The first rises within `soft_start`.
class WrenchLaw {
 public:
  /// Takes the channel and the scene's law, which must outlive it, and the limits of the arm's
  /// gate. Real-time: never from the servo thread.
  WrenchLaw(const RosChannel& channel, driver::ForceLaw scene, const RosOptions& options,
            const driver::GateLimits& limits) noexcept;

  /// Returns the force of a tick. Real-time: safe.
  driver::ForceCommand operator()(const driver::DeviceState& state) noexcept;

  /// Prepares the scene's law (driver::ForceLaw::prepare). Real-time: safe.
  void prepare(const driver::DeviceState& expected) const noexcept { scene_.prepare(expected); }

  /// Returns how often a force exceeded its maximum age. Any thread.
  std::uint64_t stalls() const noexcept { return stalls_.load(std::memory_order_relaxed); }
  /// Returns how many forces were limited. Any thread.
  std::uint64_t cut() const noexcept { return cut_.load(std::memory_order_relaxed); }
  /// Returns the ages of the positions, by the stamps of the forces, when the arm first got each
  /// force. After the run.
  const session::Histogram& ages() const noexcept { return ages_; }

 private:
  void take(std::int64_t time_ns) noexcept;

  const RosChannel& channel_;
  driver::ForceLaw scene_;
  driver::GateLimits limits_;
  bool replace_;
  double force_limit_;
  std::int64_t stale_ns_;
  Eigen::Vector3d f_asked_W_{0, 0, 0};
  std::uint64_t taken_ = 0;
  std::int64_t taken_ns_ = 0;
  bool stale_ = true;
  double opened_ = 0;   // 0 to 1
  double opening_ = 0;  // duration of the opening, s
  std::atomic<std::uint64_t> stalls_{0};
  std::atomic<std::uint64_t> cut_{0};
  session::Histogram ages_;
};

}  // namespace thimble::ros2
