#pragma once

#include <array>

#include "bringup/identify/arm_constants.h"
#include "bringup/identify/cables/two_mass_fit.h"
#include "thimble/driver/result.h"
#include "thimble/scene/arm_file.h"

namespace thimble::bringup {

/// Returns the constants of motors and cables from the lines and the gain of each motor: true
/// torque over that of the arm file.
std::array<CableConstants, 3> cable_constants(const CableFit& fit,
                                              const std::array<Estimate, 3>& gain);

/// Returns the motion of the links behind elastic cables, as if each link had a motor with the
/// cable's torque. Torques are kDelayTicks ticks late, nothing is above 60 Hz, and half a second is
/// missing at either end. A fit to it gives a rigid arm's mass, friction and weight. The error
/// states that the links would have been out of reach.
inline constexpr int kDelayTicks = 3;
driver::Result<ArmMotion> motion_of_links(const ArmMotion& motion, const CableFit& fit,
                                          const scene::ArmFile& file);

}  // namespace thimble::bringup
