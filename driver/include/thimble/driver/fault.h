#pragma once

#include <cstdint>
#include <string_view>

#include "thimble/driver/export.h"

namespace thimble::driver {

/// Detected problem that switches the force of an arm off. The force stays off until the arm is
/// activated again.
enum class Fault : std::uint8_t {
  kNone = 0,
  kTransportLost,  ///< The transport reported that the arm is disconnected.
  /// The arm sent no report for longer than `DeviceSettings::silence_limit_ns`.
  kNoReports,
  kForceNotFinite,  ///< The force law returned NaN or infinity.
  kStateNotFinite,  ///< Position or velocity was NaN or infinite.
  kOverSpeed,       ///< The tip moved faster than `GateLimits::speed_max`.
  kLoopStalled,     ///< The loop stopped for longer than the timeout of the arm's own watchdog.
  /// The arm accepted no message for longer than `DeviceSettings::silence_limit_ns`.
  kRefused,
  kTimeNotMonotonic,  ///< The loop's clock stepped back, or a tick's time was not finite.
  kMotorsReversed,    ///< The tip gained speed against the force that was sent (motion_watch.h).
  kEncoderFrozen,     ///< A joint did not move under a changing force while others did.
  kCountsUnchanged,   ///< No encoder count changed while a force was held (motion_watch.h).
  kOtherArm,          ///< Another arm of the same run had a fault.
  kCountsJumped,      ///< The position jumped while no report arrived (Device::home_needed).
  kSuspended,         ///< The computer was suspended (Clock::asleep_ns).
  kOutsideWorkspace,  ///< The tip was deeper in a wall than `WallSettings::beyond`.
};

/// Largest valid value. A larger value in a file or in shared memory means that the data is
/// damaged.
inline constexpr Fault kLastFault = Fault::kOutsideWorkspace;

/// Returns the meaning of a fault and its remedy, in a few sentences. Real-time: safe.
THIMBLE_EXPORT std::string_view describe(Fault fault) noexcept;

/// Returns the short name of a fault for reports ("transport_lost"). Real-time: safe.
THIMBLE_EXPORT std::string_view name(Fault fault) noexcept;

}  // namespace thimble::driver
