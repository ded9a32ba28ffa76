#pragma once

#include "arms/falcon/falcon_packet.h"
#include "thimble/driver/delta_arm.h"
#include "thimble/driver/export.h"
#include "thimble/driver/wire_arm.h"

namespace thimble::driver::falcon {

/// Wire format of the Falcon: counts and buttons in, motor values out, lights green. Every message
/// has the homing bit; without it the arm does not report whether it is homed [S libnifalcon
/// FalconFirmwareNovintSDK.h]. An answer in which a leg is not homed is rejected. Real-time: safe.
struct PacketWire {
  static constexpr bool kFindsZero = true;
  static bool decode(std::span<const std::byte> bytes, ArmReading& reading) noexcept;
  static std::size_t encode(const std::array<std::int16_t, 3>& motors,
                            std::span<std::byte, kReportCapacity> bytes) noexcept;
};

/// A Novint Falcon. Its packets carry motor values of an unknown unit, about 10,000 per N m at the
/// leg and reversed in sign [S libnifalcon FalconKinematicStamper.cpp]. The driver uses amperes:
/// 1000 motor values count as 1 A, and the torque constant contains the remaining factor.
using FalconArm = WireArm<PacketWire, DeltaArm>;

/// Returns the geometry of the Falcon [S libnifalcon FalconGeometry.h]. Frame B as there: x to the
/// user's right, y up, z out of the arm towards the user.
THIMBLE_EXPORT DeltaArm falcon_geometry() noexcept;

/// Returns the Falcon's data: geometry, encoders (1280 counts per motor turn through 110 : 14.25,
/// zero near 35 degrees [S]) and drives (limit 4096 motor values, the value to which programs based
/// on libnifalcon clamp [S]).
THIMBLE_EXPORT JointModel<DeltaArm> falcon_model() noexcept;

/// The radius of the ball around `falcon_geometry().p_BM` in which the arm works, m. The published
/// workspace is about 4 inches wide [M]. All legs reach all of this ball, far from any singular
/// pose (condition of the Jacobian below 4) [C]. The corners of a cube of that size are out of
/// reach.
inline constexpr double kWorkspaceRadius = 0.050;

}  // namespace thimble::driver::falcon
