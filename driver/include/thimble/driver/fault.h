#pragma once

#include <cstdint>
#include <string_view>

#include "thimble/driver/export.h"

namespace thimble::driver {

/// Names the reason why an arm's force is off and stays off until somebody activates it again.
enum class Fault : std::uint8_t {
  kNone = 0,
  kTransportLost,   ///< The wire reported that the arm is gone.
  kNoReports,       ///< The arm stayed silent longer than `DeviceSettings::silence_limit_ns`.
  kForceNotFinite,  ///< The force law answered with NaN or infinity.
  kStateNotFinite,  ///< Position or velocity came out as NaN or infinity.
  kOverSpeed,       ///< The tip moved faster than `GateLimits::speed_max`.
  kLoopStalled,     ///< The loop stood still longer than the arm's own watchdog waits.
  kRefused,         ///< The arm took no message for longer than `DeviceSettings::silence_limit_ns`.
  kTimeNotMonotonic,  ///< The loop's clock stepped back, or the time of a tick is no number.
  kMotorsReversed,    ///< The tip gained speed against the force that was sent (motion_watch.h).
  kEncoderFrozen,     ///< A joint did not move under a changing force while others did.
  kCountsUnchanged,   ///< No encoder counted while a force was held (motion_watch.h).
  kOtherArm,          ///< Another arm of the same run came to a fault.
  kCountsJumped,      ///< The position jumped while no report came (Device::home_needed).
  kSuspended,         ///< The computer slept (Clock::asleep_ns).
  kOutsideWorkspace,  ///< The tip passed the walls of its workspace (WallSettings).
};

/// The last of the faults: what is beyond it in a file or in shared memory is damaged.
inline constexpr Fault kLastFault = Fault::kOutsideWorkspace;

/// Returns what a fault means and what to do, in one or two sentences for the user.
/// Real-time: safe.
THIMBLE_EXPORT std::string_view describe(Fault fault) noexcept;

/// Returns the short name of a fault as it stands in reports ("transport_lost").
/// Real-time: safe.
THIMBLE_EXPORT std::string_view name(Fault fault) noexcept;

}  // namespace thimble::driver
