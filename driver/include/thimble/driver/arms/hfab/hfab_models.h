#pragma once

#include <memory>

#include "thimble/driver/arm.h"
#include "thimble/driver/joint_model.h"
#include "thimble/driver/linkage_arm.h"
#include "thimble/driver/serial_arm.h"

namespace thimble::driver::hfab {

// The arms that Haptikfabriken boards drive, as their host library has them [S forsslund/hfabapi
// hfab_math.h, hfab_api.cpp]: the number in each text line says which it is. All counters are zero
// in the home pose.

/// Gives the data of the Polhem (its third edition, "polhem_v3").
JointModel<LinkageArm> polhem_model() noexcept;

/// Gives the data of the vintage PHANTOM refit ("vintage").
JointModel<SerialArm> vintage_model() noexcept;

/// Gives the data of the WoodenHaptics ("woodenhaptics_v2015"); the same arm on its older mbed
/// board has 3 A instead of 6 [S woody-experimental].
JointModel<SerialArm> woody_model(double current_max = 3) noexcept;

/// Makes the arm of a text line's model number, or nothing for a number that nobody knows.
/// Real-time: never from the servo thread.
std::unique_ptr<const Arm> make_line_arm(std::int32_t model_number);

}  // namespace thimble::driver::hfab
