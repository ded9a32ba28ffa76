#pragma once

#include <cstdint>
#include <memory>

#include "thimble/driver/arm.h"
#include "thimble/driver/export.h"
#include "thimble/driver/joint_model.h"
#include "thimble/driver/linkage_arm.h"
#include "thimble/driver/serial_arm.h"

namespace thimble::driver::hfab {

// The arms that Haptikfabriken boards drive, with the constants of their host library [S
// forsslund/hfabapi hfab_math.h, hfab_api.cpp]. The number in each text line identifies the arm.
// All counters are zero in the home pose.

/// Returns the data of the Polhem (its third edition, "polhem_v3").
THIMBLE_EXPORT JointModel<LinkageArm> polhem_model() noexcept;

/// Returns the data of the vintage PHANTOM refit ("vintage").
JointModel<SerialArm> vintage_model() noexcept;

/// A generation of the WoodenHaptics' board. The generations count joint A in opposite directions
/// and differ in current.
enum class WoodyBoard : std::uint8_t {
  kMbed,       ///< 8-byte HID reports, 3 A [S woody-experimental main.cpp].
  kTextLines,  ///< Text lines from a Teensy, 6 A [S hfabapi, woodenhaptics_v2015].
};

/// Returns the data of the WoodenHaptics on one of its boards.
///
/// Joint A of the mbed board is minus its encoder, and its motor is positive. Both published
/// clients of the 8-byte reports agree on that [S CHAI3D CWoodenDevice.cpp, haptikfabrikenapi
/// fsusbhapticdevicethread.cpp and kinematics.cpp]. On text lines both are positive [S hfabapi].
/// Encoders B and C are reversed everywhere. Motors B and C are reversed as in CHAI3D and hfabapi.
/// haptikfabrikenapi drives them positive on the mbed board, so the sources contradict each other
/// there and only `thimble feel-check` can decide. Real-time: safe.
THIMBLE_EXPORT JointModel<SerialArm> woody_model(WoodyBoard board = WoodyBoard::kMbed) noexcept;

/// Makes the arm of a text line's model number; null for an unknown number. Real-time: never from
/// the servo thread.
std::unique_ptr<const Arm> make_line_arm(std::int32_t model_number);

}  // namespace thimble::driver::hfab
