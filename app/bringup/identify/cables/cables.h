#pragma once

#include <array>

#include "bringup/identify/arm_constants.h"
#include "bringup/identify/cables/two_mass_fit.h"
#include "thimble/driver/result.h"
#include "thimble/scene/arm_file.h"

namespace thimble::bringup {

/// Returns motors and cables out of what the lines show, with the gain of each motor: true torque
/// over that of the arm file.
std::array<CableConstants, 3> cable_constants(const CableFit& fit,
                                              const std::array<Estimate, 3>& gain);

/// Returns the motion of the links behind cables that stretch, as if they had a motor each that
/// does to them what the cables do: torques kHeldBack ticks late, nothing above 60 Hz, and half a
/// second less at either end. A fit to it shows a rigid arm's mass, friction and weight. The error
/// says that the links would have been out of reach.
inline constexpr int kHeldBack = 3;
driver::Result<ArmMotion> motion_of_links(const ArmMotion& motion, const CableFit& fit,
                                          const scene::ArmFile& file);

}  // namespace thimble::bringup
